# SPDX-License-Identifier: GPL-3.0-or-later
"""What a guarantee is worth: triangles against the true largest deviation. See simplify.sh, which calls this.

Each program gets a tolerance and says that it keeps it: Sightbound everywhere, greedy insertion at the samples, meshoptimizer in its
own measure (a quadric's, as an estimate). The true largest deviation is that of the overlay with all triangles of the DEM, certified by
sb.verify, which shares no code with the simplifier.
"""

import argparse
import ctypes
import resource
import statistics
import time
from pathlib import Path

import numpy as np
import sightbound as sb


def by_sightbound(dem, full, tolerance):
    return sb.dem_to_tin(dem, tolerance=tolerance)


def by_greedy_insertion(dem, full, tolerance):
    """Garland and Heckbert's, as pydelatin has it."""
    from pydelatin import Delatin

    rows, cols = dem.shape
    mesh = Delatin(np.asarray(dem.heights, np.float32).ravel(), height=rows, width=cols, max_error=tolerance)
    x0, dx, _, y0, _, dy = dem.geotransform
    col, row, height = mesh.vertices.reshape(-1, 3).T
    places = np.column_stack([x0 + (col + 0.5) * dx, y0 + (rows - 1 - row + 0.5) * dy, height])  # it counts rows from below
    return sb.Tin(places, mesh.triangles.reshape(-1, 3).astype(np.int32), crs=full.crs_wkt)


def by_meshoptimizer(dem, full, tolerance):
    library = ctypes.CDLL("libmeshoptimizer.so")
    library.meshopt_simplify.restype = ctypes.c_size_t
    library.meshopt_simplifyScale.restype = ctypes.c_float
    points = np.ascontiguousarray(full.local_vertices, np.float32)
    faces = np.ascontiguousarray(full.faces, np.uint32).ravel()
    scale = library.meshopt_simplifyScale(points.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(len(points)), ctypes.c_size_t(12))
    kept = np.empty_like(faces)
    lock_border = 1
    count = library.meshopt_simplify(
        kept.ctypes.data_as(ctypes.c_void_p), faces.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(len(faces)),
        points.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(len(points)), ctypes.c_size_t(12), ctypes.c_size_t(0),
        ctypes.c_float(tolerance / scale), ctypes.c_uint(lock_border), None)
    left = kept[:count].reshape(-1, 3)
    used, numbers = np.unique(left, return_inverse=True)
    return sb.Tin(full.vertices[used], numbers.reshape(-1, 3).astype(np.int32), crs=full.crs_wkt)


def is_there(name):
    try:
        if name == "greedy insertion":
            import pydelatin  # noqa: F401
        if name == "meshoptimizer":
            ctypes.CDLL("libmeshoptimizer.so")
    except (ImportError, OSError):
        return False
    return True


PROGRAMS = {
    "Sightbound": by_sightbound,
    "greedy insertion": by_greedy_insertion,
    "meshoptimizer": by_meshoptimizer,
}


def row(name, dem, full, tolerance, rounds):
    seconds = []
    for _ in range(rounds if name == "Sightbound" else 1):
        begin = time.perf_counter()
        tin = PROGRAMS[name](dem, full, tolerance)
        seconds.append(time.perf_counter() - begin)
    found = sb.verify(full, tin, tolerance=tolerance).report
    largest = found["largest_deviation"]["bound"]
    print(f"| {name} | {tolerance:g} m | {len(tin.faces):,} | {largest:.2f} m | {found['rms_deviation']:.2f} m | "
          f"{found['flipped']['count'] + found['folded']['count']} | {statistics.median(seconds):.1f} s |", flush=True)
    return {"program": name, "tolerance": tolerance, "faces": len(tin.faces), "largest": largest}


def draw(rows, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4.5), dpi=120)
    for (name, colour), marker in zip((("Sightbound", "#1b6ca8"), ("greedy insertion", "#d9822b"), ("meshoptimizer", "#7a5195")), "os^"):
        mine = [one for one in rows if one["program"] == name]
        if not mine:
            continue
        axes.plot([one["largest"] for one in mine], [one["faces"] for one in mine], marker + "-", color=colour, label=name)
        for one in mine:
            axes.annotate(f"{one['tolerance']:g} m", (one["largest"], one["faces"]), xytext=(5, 4), textcoords="offset points",
                          fontsize=8, color=colour)
    axes.set(xscale="log", yscale="log", xlabel="true largest deviation, metres (labels: tolerance asked for)", ylabel="triangles")
    axes.grid(which="both", alpha=0.25)
    axes.legend()
    figure.tight_layout()
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("dem")
    parser.add_argument("--tolerances", type=float, nargs="+", default=[1.0, 2.0, 5.0, 10.0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--programs", nargs="+", default=list(PROGRAMS), choices=list(PROGRAMS))
    parser.add_argument("--picture", type=Path)
    asked = parser.parse_args()
    dem = sb.read_dem(asked.dem)
    full = sb.Tin.from_dem(dem)
    print(f"{asked.dem}: {len(full.faces):,} triangles\n")
    print("| program | tolerance asked | triangles | true largest deviation | rms at samples | flips, folds | time |")
    print("|---|---|---|---|---|---|---|")
    there = [name for name in asked.programs if is_there(name)]
    rows = [row(name, dem, full, tolerance, asked.rounds) for name in there for tolerance in asked.tolerances]
    print(f"\npeak memory of all this: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")
    if asked.picture:
        draw(rows, asked.picture)


if __name__ == "__main__":
    main()
