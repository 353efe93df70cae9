# SPDX-License-Identifier: GPL-3.0-or-later
"""Time whole viewshed programs against each other, in turn: see viewshed.sh, which calls this."""

import argparse
import os
import shutil
import statistics
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
CELL, LEFT, TOP = 10.0, 500000.0, 5000000.0


@dataclass
class Contestant:
    name: str
    command: list
    environment: dict = field(default_factory=dict)
    rounds: int = 1
    seconds: list = field(default_factory=list)
    peak_mib: list = field(default_factory=list)


def run(contestant):
    """One whole process: wall time and peak resident memory."""
    begin = time.perf_counter()
    process = subprocess.Popen(
        contestant.command, env={**os.environ, **contestant.environment},
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    complaint = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    contestant.seconds.append(time.perf_counter() - begin)
    contestant.peak_mib.append(usage.ru_maxrss / 1024.0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"{contestant.name} failed: {' '.join(map(str, contestant.command))}\n{complaint.decode()}")


def sightbound(name, dem, folder, rounds, *options):
    return Contestant(name, [sys.executable, HERE / "run_viewshed.py", dem, folder / "confidence.tif",
                             folder / "verdict.tif", *options], rounds=rounds)


def gdal_viewshed(dem, folder, middle, rounds):
    x, y = middle
    return Contestant("gdal_viewshed", ["gdal_viewshed", "-q", "-ox", f"{x}", "-oy", f"{y}", "-oz", "2", "-tz", "0",
                                        dem, folder / "gdal.tif"], rounds=rounds)


def r_viewshed(dem, folder, middle, rounds):
    """GRASS reads its own format: the DEM is imported before the clock runs."""
    database = folder / "grass"
    shutil.rmtree(database, ignore_errors=True)
    database.mkdir()
    base = subprocess.run(["grass", "--config", "path"], check=True, capture_output=True, text=True).stdout.strip()
    settings = folder / "grassrc"
    settings.write_text(f"GISDBASE: {database}\nLOCATION_NAME: dem\nMAPSET: PERMANENT\nGUI: text\n", encoding="utf-8")
    environment = {
        "GISBASE": base,
        "GISRC": str(settings),
        "PATH": f"{base}/bin:{base}/scripts:{os.environ['PATH']}",
        "LD_LIBRARY_PATH": f"{base}/lib",
    }
    everything = {**os.environ, **environment}
    quiet = {"check": True, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run(["grass", "-c", dem, "-e", database / "dem"], **quiet)
    subprocess.run([f"{base}/bin/r.in.gdal", f"input={dem}", "output=dem"], env=everything, **quiet)
    subprocess.run([f"{base}/bin/g.region", "raster=dem"], env=everything, **quiet)
    x, y = middle
    return Contestant("r.viewshed -b", [f"{base}/bin/r.viewshed", "-b", "input=dem", "output=seen", f"coordinates={x},{y}",
                                        "observer_elevation=2", "memory=16000", "--overwrite", "--quiet"],
                      environment, rounds)


def compare(cells, options):
    folder = options.folder / f"{cells}"
    folder.mkdir(parents=True, exist_ok=True)
    dem = folder / "dem.tif"
    if not dem.exists():
        subprocess.run([sys.executable, HERE / "make_fractal_dem.py", str(cells), dem], check=True)
    middle = (LEFT + (cells // 2 + 0.5) * CELL, TOP - (cells // 2 + 0.5) * CELL)
    ours = sightbound("Sightbound, error given", dem, folder, options.runs)
    contestants = [
        ours,
        gdal_viewshed(dem, folder, middle, options.runs),
        sightbound("Sightbound, error estimated", dem, folder, options.runs, "--estimate"),
    ]
    if cells <= options.grass_up_to and shutil.which("grass"):
        contestants.append(r_viewshed(dem, folder, middle, min(options.runs, options.grass_runs)))
    for number in range(options.runs):
        for contestant in contestants:
            if number < contestant.rounds:
                run(contestant)
    report(cells, contestants, ours)


def report(cells, contestants, ours):
    """Medians, and the median over the rounds of each contestant's time relative to ours in the same round."""
    print(f"\n{cells} x {cells} cells")
    print(f"  {'program':<30}{'runs':>5}{'wall s':>9}{'(min-max)':>18}{'peak MiB':>10}{'ours / it':>11}")
    for one in contestants:
        ratio = statistics.median(a / b for a, b in zip(ours.seconds, one.seconds))
        spread = f"({min(one.seconds):.2f}-{max(one.seconds):.2f})"
        print(f"  {one.name:<30}{len(one.seconds):>5}{statistics.median(one.seconds):>9.2f}{spread:>18}"
              f"{max(one.peak_mib):>10.0f}{ratio:>11.3f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sizes", nargs="*", type=int, default=[1000, 4000, 10000], help="cells a side")
    parser.add_argument("--runs", type=int, default=5, help="rounds; each runs every program once")
    parser.add_argument("--folder", type=Path, required=True, help="where DEMs and results lie (kept)")
    parser.add_argument("--grass-up-to", type=int, default=4000, help="largest size for r.viewshed; 0 leaves it out")
    parser.add_argument("--grass-runs", type=int, default=2, help="rounds of r.viewshed, which takes long")
    options = parser.parse_args()
    for cells in options.sizes:
        compare(cells, options)


if __name__ == "__main__":
    main()
