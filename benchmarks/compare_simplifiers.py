# SPDX-License-Identifier: GPL-3.0-or-later
"""What a guarantee is worth: triangles against the true largest deviation. See simplify.sh, which calls this.

Each program gets a tolerance and says that it keeps it: Sightbound everywhere, greedy insertion at the samples, meshoptimizer in its
own measure (a quadric's, as an estimate). The true largest deviation is that of the overlay with all triangles of the DEM, certified by
sb.verify, which shares no code with the simplifier.
"""

import argparse
import ctypes
import ctypes.util
import resource
import statistics
import time
from pathlib import Path

import numpy as np
import sightbound as sb


def by_sightbound(dem, full, tolerance):
    return sb.dem_to_tin(dem, tolerance=tolerance)


def by_greedy_insertion(dem, full, tolerance):
    """Garland and Heckbert's, in rounds: the worst sample of every triangle goes in, until no sample is off by more.
    One sample at a time takes longer and needs about 30 % fewer triangles."""
    from scipy.spatial import Delaunay

    points = full.local_vertices
    plan, heights = points[:, :2], points[:, 2]
    low, high = plan.min(axis=0), plan.max(axis=0)
    chosen = [int(np.argmin(np.abs(plan - corner).sum(axis=1))) for corner in (low, (low[0], high[1]), (high[0], low[1]), high)]
    while True:
        mesh = Delaunay(plan[chosen])
        inside = mesh.find_simplex(plan, tol=1e-9)
        weights = np.einsum("nij,nj->ni", mesh.transform[inside, :2], plan - mesh.transform[inside, 2])
        weights = np.column_stack([weights, 1 - weights.sum(axis=1)])
        off = np.abs((weights * heights[np.asarray(chosen)[mesh.simplices[inside]]]).sum(axis=1) - heights)
        order = np.lexsort((-off, inside))
        first = order[np.r_[True, np.diff(inside[order]) > 0]]
        worst = first[off[first] > tolerance]
        if not len(worst):
            return sb.Tin(full.vertices[chosen], mesh.simplices, crs=full.crs_wkt)
        chosen.extend(worst.tolist())


def by_meshoptimizer(dem, full, tolerance):
    library = ctypes.CDLL(ctypes.util.find_library("meshoptimizer"))
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
    rows = [row(name, dem, full, tolerance, asked.rounds) for name in asked.programs for tolerance in asked.tolerances]
    print(f"\npeak memory of all this: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MiB")
    if asked.picture:
        draw(rows, asked.picture)


if __name__ == "__main__":
    main()
