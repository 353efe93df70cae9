# SPDX-License-Identifier: GPL-3.0-or-later
"""Time probable viewsheds against gdal_viewshed on perturbed copies of the DEM: see probable.sh, which calls this."""

import argparse
import statistics
import subprocess
import sys
from pathlib import Path

from compare_viewsheds import CELL, HERE, LEFT, TOP, Contestant, run

REALISATIONS = 1000
OURS = (
    ("Sightbound, as it comes", ()),
    ("  without fine ground", ("--refinement", "0")),
    ("  all 1000 for every cell", ("--precision", "0")),
)


def compare(cells, options):
    folder = options.folder / f"{cells}"
    folder.mkdir(parents=True, exist_ok=True)
    dem, copy = folder / "dem.tif", folder / "copy.tif"
    if not dem.exists():
        subprocess.run([sys.executable, HERE / "make_fractal_dem.py", str(cells), dem], check=True)
    script = HERE / "run_probable.py"
    ours = [
        Contestant(name, [sys.executable, script, "ours", dem, folder / "probability.tif", *more]) for name, more in OURS
    ]
    noise = Contestant("a perturbed copy", [sys.executable, script, "noise", dem, copy])
    x, y = LEFT + (cells // 2 + 0.5) * CELL, TOP - (cells // 2 + 0.5) * CELL
    look = Contestant("gdal_viewshed on it", ["gdal_viewshed", "-q", "-ox", f"{x}", "-oy", f"{y}", "-oz", "1.7", "-tz", "1.7",
                                              copy, folder / "gdal.tif"])
    for _ in range(options.runs):
        for contestant in ours:
            run(contestant)
        for _ in range(options.copies):
            run(noise)
            run(look)
    report(cells, ours, noise, look, options)


def report(cells, ours, noise, look, options):
    """Medians; gdal's are of one copy, and times 1000 in the ratios."""
    print(f"\n{cells} x {cells} cells, {options.runs} rounds, {options.copies} copies a round")
    print(f"  {'program':<28}{'wall s':>9}{'(min-max)':>18}{'peak MiB':>10}")
    for one in (*ours, noise, look):
        spread = f"({min(one.seconds):.2f}-{max(one.seconds):.2f})"
        print(f"  {one.name:<28}{statistics.median(one.seconds):>9.2f}{spread:>18}{max(one.peak_mib):>10.0f}")
    views, both = (REALISATIONS * statistics.median(times) for times in (
        look.seconds, [a + b for a, b in zip(noise.seconds, look.seconds)]))
    print(f"  1000 viewsheds of gdal, from {len(look.seconds)}: {views:.0f} s; with the copies: {both:.0f} s")
    for one in ours:
        mine = statistics.median(one.seconds)
        print(f"  {one.name.strip()}: {mine / views:.4f} of the viewsheds alone, {mine / both:.4f} with the copies", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sizes", nargs="*", type=int, default=[1000, 4000], help="cells a side")
    parser.add_argument("--runs", type=int, default=3, help="rounds; each runs every program")
    parser.add_argument("--copies", type=int, default=5, help="perturbed copies a round")
    parser.add_argument("--folder", type=Path, required=True, help="where DEMs and results lie (kept)")
    options = parser.parse_args()
    for cells in options.sizes:
        compare(cells, options)


if __name__ == "__main__":
    main()
