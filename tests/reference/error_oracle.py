# SPDX-License-Identifier: GPL-3.0-or-later
"""The error model in plain Python: Koppe, geologic variation, and what a DEM says about its own between-sample error.

    sigma_s = sigma_v + sigma_h tan(slope)
    sigma_g(d) = (Delta / z95) (1 - P(d))
    between samples: leave out every other sample, see by how much the rest misses them; again at twice the spacing:
    H = log2(s4 / s2), sd at the DEM's own spacing = s2 2^-H
"""
from __future__ import annotations

import math

import numpy as np

Z95 = 1.959963984540054
# People's accuracies -> one standard deviation (along one axis for the horizontal, radial ones).
VERTICAL = {"rmse": 1.0, "le90": 1 / 1.6448536269514722, "le95": 1 / Z95}
HORIZONTAL = {"rmse": 1.0, "ce90": 1 / math.sqrt(-2 * math.log(0.10)), "ce95": 1 / math.sqrt(-2 * math.log(0.05))}


def koppe(sigma_v, sigma_h, tan_slope):
    return sigma_v + sigma_h * tan_slope


def geologic(d, delta, model="gaussian", range_m=None, exponent=None, cell=None):
    if model == "step":
        share = 0.0 if d < range_m else 1.0
    elif model == "growth":
        share = (2 * d / cell) ** exponent
    else:
        share = 1 - math.exp(-0.5 * (delta * d if range_m is None else d / range_m) ** 2)
    return delta / Z95 * share


def decimation_residuals(z, step, anti=False):
    """True minus interpolated at the samples that a grid of twice `step` leaves out; z already thinned to `step`.
    All four ways to keep every other sample are taken together: each sample is missed along its row, its column, and
    at the middle of a square (whose surface there is the mean along the NW-SE diagonal)."""
    z = z[::step, ::step]
    along_row = z[:, 1:-1] - 0.5 * (z[:, :-2] + z[:, 2:])
    along_col = z[1:-1, :] - 0.5 * (z[:-2, :] + z[2:, :])
    ends = (z[2:, :-2] + z[:-2, 2:]) if anti else (z[:-2, :-2] + z[2:, 2:])
    middle = z[1:-1, 1:-1] - 0.5 * ends
    return along_row, along_col, middle


def decimation_sd(z, step, anti=False):
    squares = np.concatenate([r[np.isfinite(r)] ** 2 for r in decimation_residuals(z, step, anti)])
    return math.sqrt(squares.mean())


def growth(z, anti=False):
    """(H, sd between the samples at the DEM's own spacing)."""
    s2, s4 = decimation_sd(z, 1, anti), decimation_sd(z, 2, anti)
    exponent = math.log2(s4 / s2)
    return exponent, s2 * 2 ** -exponent
