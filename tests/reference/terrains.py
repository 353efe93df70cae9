# SPDX-License-Identifier: GPL-3.0-or-later
"""Small terrains by seed, and scenes whose answers are known in closed form."""
from __future__ import annotations

import numpy as np


def fractal(shape, seed, relief=50.0, roughness=1.9):
    """Spectral fractal: amplitude ~ frequency^-roughness, heights scaled to `relief` metres from lowest to highest."""
    rng = np.random.default_rng(seed)
    rows, cols = shape
    frequency = np.hypot(np.fft.fftfreq(rows)[:, None], np.fft.fftfreq(cols)[None, :])
    frequency[0, 0] = 1.0
    spectrum = np.fft.fft2(rng.normal(size=shape)) * frequency ** -roughness
    spectrum[0, 0] = 0.0
    z = np.fft.ifft2(spectrum).real
    return np.ascontiguousarray((z - z.min()) / (z.max() - z.min()) * relief, np.float32)


def noise(shape, seed, relief=10.0):
    return np.float32(np.random.default_rng(seed).uniform(0.0, relief, shape))


def plateaus(shape, seed, step=5.0):
    """Level terraces with cliffs: many exact ties."""
    return np.float32(np.floor(fractal(shape, seed, 6 * step) / step) * step)


def spikes(shape, seed, count=12, height=40.0):
    rng = np.random.default_rng(seed)
    z = np.zeros(shape, np.float32)
    z[rng.integers(0, shape[0], count), rng.integers(0, shape[1], count)] = height
    return z


def ridges(shape, height=20.0, period=7):
    """Walls along the rows, `period` rows apart."""
    z = np.zeros(shape, np.float32)
    z[::period, :] = height
    return z


def bowl(shape, depth=30.0):
    r, c = np.indices(shape, dtype=float)
    middle = (np.array(shape) - 1) / 2
    return np.float32(depth * (((r - middle[0]) / shape[0]) ** 2 + ((c - middle[1]) / shape[1]) ** 2) * 4)


def plane(shape, by_col=0.0, by_row=0.0, base=100.0):
    r, c = np.indices(shape, dtype=float)
    return np.float32(base + by_col * c + by_row * r)


def with_holes(z, seed, share=0.03, keep=None):
    """`keep` = (column, row) of a place whose four samples stay."""
    holed = z.copy()
    holed[np.random.default_rng(seed).random(z.shape) < share] = np.nan
    if keep is not None:
        around = np.s_[int(keep[1]):int(keep[1]) + 2, int(keep[0]):int(keep[0]) + 2]
        holed[around] = z[around]
    return holed
