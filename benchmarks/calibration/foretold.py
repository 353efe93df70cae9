#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the error that a DEM foretells of itself against a finer DEM: foretold.py --help.

Every n-th sample of a fine DEM is kept, the error between those is estimated from them alone, and the fine DEM tells how
large it is. Prints the table of docs/concepts/error_model.md, "How good it is".
"""

import argparse

import numpy as np
import sightbound as sb
from calibrate import truths
from truths import decimate


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dem", nargs="*", help="fine DEMs; name=path[,feet][,sea=0]")
    parser.add_argument("--fractal", type=float, action="append", default=[], metavar="H", help="a fractal truth as well")
    parser.add_argument("--factor", type=int, nargs="+", default=[4, 8], help="even numbers: half-way is a sample then")
    options = parser.parse_args()
    if any(factor % 2 for factor in options.factor):
        parser.error("--factor wants even numbers")
    return options


def between(samples, factor, shape):
    """Bilinear, at the places of the fine DEM; NaN beyond the last sample."""
    rows, cols = (np.arange(n) / factor for n in shape)
    r, c = (np.minimum(x.astype(int), n - 2) for x, n in zip((rows, cols), samples.shape))
    f, g = (rows - r)[:, None], (cols - c)[None, :]
    corner = [samples[np.ix_(r + i, c + j)] for i in (0, 1) for j in (0, 1)]
    found = (1 - f) * ((1 - g) * corner[0] + g * corner[1]) + f * ((1 - g) * corner[2] + g * corner[3])
    found[rows > samples.shape[0] - 1] = np.nan
    found[:, cols > samples.shape[1] - 1] = np.nan
    return found


def distance(factor, shape):
    """To the nearest sample, in units of half a spacing."""
    row, col = (np.minimum(np.arange(n) % factor, -np.arange(n) % factor) for n in shape)
    return np.hypot(row[:, None], col[None, :]) / (factor / 2)


def growth(t, exponent):
    """The `growth` profile of docs/concepts/error_model.md."""
    h = min(exponent, 1)
    return np.where(t < 1, np.maximum(t * (2 - t), 0) ** h, np.maximum(t, 1) ** (h / 2))


def foretell(truth, factor):
    """H, and arrays over the fine DEM: what is missed, sigma, and the distance to the samples."""
    coarse = decimate(truth, factor, means=False)
    dem = sb.Dem(coarse.heights, coarse.geotransform, coarse.crs)
    model = sb.estimate_error(dem, samples_or_means="samples")
    exponent = model.growth_exponent
    sigma = np.asarray(sb.error_surfaces(dem, error_model=model).sigma, float)  # at the corners of cells
    half_way = sigma / growth(np.sqrt(2.0), exponent)
    shape = truth.heights.shape
    missed = truth.heights - between(coarse.heights.astype(float), factor, shape)
    t = distance(factor, shape)
    return model, missed, between(half_way, factor, shape) * growth(t, exponent), t


def main():
    options = arguments()
    print("| terrain | spacing | H | estimated sd | true/estimated | 95 % holds: half-way | anywhere |\n|---|---|---|---|---|---|---|")
    for truth in truths(options):
        for factor in options.factor:
            if min(truth.heights.shape) // factor < 40:
                continue
            model, missed, sigma, t = foretell(truth, factor)
            known = np.isfinite(missed) & np.isfinite(sigma) & (sigma > 0)
            edge = known & (t == 1) & ((np.arange(t.shape[0]) % factor == 0)[:, None] | (np.arange(t.shape[1]) % factor == 0)[None, :])
            z = sb.two_sided_quantile(0.95, model.tails)
            rms = [float(np.sqrt((x[edge] ** 2).mean())) for x in (missed, sigma)]
            holds = [float((np.abs(missed[of]) <= z * sigma[of]).mean()) for of in (edge, known & (t > 0))]
            print(f"| {truth.name} | {factor * truth.geotransform[1]:.3g} m | {model.growth_exponent:.2f} | {rms[1]:.2g} m | {rms[0] / rms[1]:.2f} | "
                  f"{100 * holds[0]:.0f} % | {100 * holds[1]:.0f} % |")


if __name__ == "__main__":
    main()
