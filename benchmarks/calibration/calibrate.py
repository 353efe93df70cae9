#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks claims of sight against terrain that is known: calibrate.py --help.

A fine DEM is the truth. A coarser one is made of it, its error model is estimated from the coarse DEM alone, and what
Sightbound then says of the coarse one is held against exact sight on the fine one:

  ordinary   visible or hidden on the coarse DEM as if it were the ground
  pointwise  confidence of viewshed(), both ends moving with the ground
  probable   probability of probable_viewshed()
"""

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np
import sightbound as sb
from scores import Scores
from truths import decimate, fractal, read

EXACT = sb.ErrorModel(vertical_rmse=0, geologic_variation=0)
METHODS = ("ordinary", "pointwise", "probable")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dem", nargs="*", help="fine DEMs; name=path[,feet][,sea=0]")
    parser.add_argument("--fractal", type=float, action="append", default=[], metavar="H", help="a fractal truth as well")
    parser.add_argument("--factor", type=int, nargs="+", default=[4, 8])
    parser.add_argument("--cells", nargs="+", default=["samples", "means"], choices=["samples", "means"])
    parser.add_argument("--told", action="store_true", help="tell the estimate what the cells are (else: auto)")
    parser.add_argument("--noise", type=float, default=0.0, help="error added to the coarse DEM, metres; the model is told")
    parser.add_argument("--observers", type=int, default=50)
    parser.add_argument("--height", type=float, default=1.7, help="of eyes and targets, metres")
    parser.add_argument("--reach", type=float, default=None, help="max_distance, metres (default: all)")
    parser.add_argument("--realisations", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("calibration.json"), help="results are added to what it holds")
    return parser.parse_args()


def truths(options):
    for text in options.dem:
        where, *flags = text.split(",")
        name, _, path = where.rpartition("=")
        sea = next((float(flag[4:]) for flag in flags if flag.startswith("sea=")), None)
        yield read(path, name or None, feet="feet" in flags, sea=sea)
    for exponent in options.fractal:
        yield fractal(exponent)


def observers(coarse, count, seed):
    """Places anywhere between samples, where the ground around is known."""
    random = np.random.default_rng(seed)
    rows, cols = coarse.heights.shape
    left, dx, _, top, _, dy = coarse.geotransform
    found = 0
    for _ in range(100 * count):
        r, c = random.uniform(3, rows - 4), random.uniform(3, cols - 4)
        if np.isnan(coarse.heights[int(r):int(r) + 2, int(c):int(c) + 2]).any():
            continue
        yield left + dx * (c + 0.5), top + dy * (r + 0.5)
        found += 1
        if found == count:
            return


def views(coarse_dem, fine_dem, coarse, place, model, options):
    """What each method says of the coarse cells, and what is true of them."""
    look = {"observer_height": options.height, "target_height": options.height}
    if options.reach:
        look["max_distance"] = options.reach
    place = [place]
    p = {
        "ordinary": sb.viewshed(coarse_dem, place, error_model=EXACT, **look).confidence,
        "pointwise": sb.viewshed(coarse_dem, place, error_model=model, stand="ground", **look).confidence,
    }
    began = time.perf_counter()
    p["probable"] = sb.probable_viewshed(coarse_dem, place, error_model=model, realisations=options.realisations,
                                         seed=options.seed, **look).probability
    seconds = time.perf_counter() - began
    truth = sb.viewshed(fine_dem, place, error_model=EXACT, **look).confidence[np.ix_(coarse.rows, coarse.cols)]
    # Behind ground that is unknown in the truth itself its confidence is 0.5: nothing is known to compare with.
    asked = np.abs(truth - 0.5) > 1e-3
    for values in p.values():
        asked &= np.isfinite(values)
    return {name: values[asked] for name, values in p.items()}, truth[asked] > 0.5, seconds


def calibrate(truth, factor, cells, options):
    coarse = decimate(truth, factor, cells == "means", options.noise, options.seed)
    coarse_dem = sb.Dem(coarse.heights, coarse.geotransform, coarse.crs)
    fine_dem = sb.Dem(truth.heights, truth.geotransform, truth.crs)
    told = cells if options.told else "auto"
    given = sb.ErrorModel(vertical_rmse=options.noise) if options.noise else None
    model = sb.estimate_error(coarse_dem, error_model=given, samples_or_means=told)
    scores, seconds = {name: Scores() for name in METHODS}, []
    for place in observers(coarse, options.observers, options.seed):
        p, seen, took = views(coarse_dem, fine_dem, coarse, place, model, options)
        for name in METHODS:
            scores[name].add(np.round(p[name]) if name == "ordinary" else p[name], seen)
        seconds.append(took)
    return {
        "terrain": truth.name, "factor": factor, "cells": cells, "told": options.told, "noise_m": options.noise,
        "cell_m": float(coarse.geotransform[1]), "realisations": options.realisations,
        "seconds": float(np.median(seconds)),
        "learnt": {key: value for key, value in model.report.items() if key != "warnings"},
        "methods": {name: one.summary() for name, one in scores.items()},
    }


def say(case):
    print(f"{case['terrain']:16} k={case['factor']} {case['cells']:8} H {case['learnt']['growth_exponent']:.2f} "
          f"{case['learnt']['samples_or_means']} {case['learnt']['tails']} seen {case['methods']['probable']['seen']:.3f}")
    for name, one in case["methods"].items():
        claims = "; ".join(
            f"{level}: {c['visible']['right']:.4f}±{c['visible']['se']:.4f} (of {c['visible']['share']:.3f}) "
            f"hidden {c['hidden']['right']:.4f} unc {c['uncertain']:.4f}" for level, c in one["claims"].items() if level != "0.9")
        print(f"   {name:10} Brier {one['brier']:.5f}  {claims}")
        if name == "probable":
            print("      " + " ".join(f"{b['p']:.2f}>{b['seen']:.2f}±{b['se']:.2f}" for b in one["bins"]))
    sys.stdout.flush()


def main():
    options = arguments()
    kept = json.loads(options.out.read_text()) if options.out.exists() else []
    for truth in truths(options):
        for factor in options.factor:
            for cells in options.cells:
                if min(truth.heights.shape) // factor < 60:
                    continue
                case = calibrate(truth, factor, cells, options)
                say(case)
                key = ("terrain", "factor", "cells", "told", "noise_m")
                kept = [other for other in kept if any(other[k] != case[k] for k in key)] + [case]
                options.out.write_text(json.dumps(kept, indent=1))


if __name__ == "__main__":
    main()
