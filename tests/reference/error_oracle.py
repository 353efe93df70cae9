# SPDX-License-Identifier: GPL-3.0-or-later
"""The error model in plain Python: Koppe, geologic variation, and what a DEM says about its own between-sample error.

    sigma_s = sigma_v + sigma_h tan(slope)
    sigma_g(d) = (Delta / z95) (1 - P(d))
    between samples: see by how much each sample misses the mean of its neighbours, 1 and 2 samples away (s2, s4):
    H = log2(s4 / s2), and half of how that changes goes on; sd half a spacing from a sample = s2 2^-H
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
        t, h = 2 * d / cell, np.minimum(exponent, 1.0)
        share = np.where(t < 1, (np.minimum(t, 1) * (2 - np.minimum(t, 1))) ** h, np.clip(t, 1, math.sqrt(2)) ** (h / 2) * np.maximum(t / math.sqrt(2), 1) ** exponent)
    else:
        share = 1 - math.exp(-0.5 * (delta * d if range_m is None else d / range_m) ** 2)
    return delta / Z95 * share


def residuals(z, q, anti=False):
    """By how much each sample misses the mean of its neighbours q away: along its row, its column, and the NW-SE diagonal.
    Nan where a neighbour is missing."""
    padded = np.pad(np.asarray(z, float), q, constant_values=np.nan)
    middle = padded[q:-q, q:-q]
    rows, cols = middle.shape

    def shifted(dr, dc):
        return padded[q + dr:q + dr + rows, q + dc:q + dc + cols]

    along_row = middle - 0.5 * (shifted(0, -q) + shifted(0, q))
    along_col = middle - 0.5 * (shifted(-q, 0) + shifted(q, 0))
    corner = -q if anti else q
    diagonal = middle - 0.5 * (shifted(-q, -corner) + shifted(q, corner))
    return along_row, along_col, diagonal


def growth(z):
    """(H, sd half a spacing from a sample): rows and columns, the same places for both spacings; H by tiles of 32 x 32,
    averaged over their places."""
    near, far = residuals(z, 1)[:2], residuals(z, 2)[:2]
    both = np.isfinite(far[0]) & np.isfinite(far[1]) & np.isfinite(near[0]) & np.isfinite(near[1])
    s2, s4 = (math.sqrt(np.mean([np.mean(e[both] ** 2) for e in pair])) for pair in (near, far))
    exponents, counts = [], []
    for r in range(0, both.shape[0], 32):
        for c in range(0, both.shape[1], 32):
            tile = np.s_[r:r + 32, c:c + 32]
            if both[tile].any():
                squares = [np.mean([np.mean(e[tile][both[tile]] ** 2) for e in pair]) for pair in (near, far)]
                exponents.append(0.5 * math.log2(squares[1] / squares[0]))
                counts.append(both[tile].sum())
    exponent = float(np.average(exponents, weights=counts)) + continued(z)
    return exponent, s2 * 2 ** -exponent


def continued(z):
    """What is added to H below the cell: half of its change from spacings of 4 and 8 samples to 2 and 4, at most 0.2."""
    around = 8
    inside = np.s_[around:-around, around:-around]
    squares = [np.mean([e[inside] ** 2 for e in residuals(z, q)[:2]], axis=0) for q in (1, 2, 4)]
    exponents, counts = [], []
    for r in range(0, squares[0].shape[0], 32):
        for c in range(0, squares[0].shape[1], 32):
            means = [np.mean(s[r:r + 32, c:c + 32]) for s in squares]
            exponents.append([0.5 * math.log2(means[i + 1] / means[i]) for i in (0, 1)])
            counts.append(squares[0][r:r + 32, c:c + 32].size)
    first, second = np.average(exponents, axis=0, weights=counts)
    return float(np.clip(0.5 * (first - second), -0.2, 0.2))


def local_variation(z, exponent, anti=False):
    """sd half a spacing from each sample: 2^-H times the rms of the residuals of the nine samples around, the diagonal ones (sqrt2
    times as far) counting as e / sqrt2^H. Nan where the 5 x 5 samples are not all there."""
    row, col, diagonal = residuals(z, 1, anti)
    squares = row ** 2 + col ** 2 + 2 ** -exponent * diagonal ** 2
    padded = np.pad(squares, 1, constant_values=np.nan)
    total = sum(padded[1 + dr:padded.shape[0] - 1 + dr, 1 + dc:padded.shape[1] - 1 + dc] for dr in (-1, 0, 1) for dc in (-1, 0, 1))
    return 2 ** -exponent * np.sqrt(total / 27)
