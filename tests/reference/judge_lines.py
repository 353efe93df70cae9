# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of places for tests of single lines."""
from __future__ import annotations

import numpy as np


def lines_between(oracle, count, seed):
    """Pairs of (x, y) at least three cells apart, on and off the samples."""
    rng = np.random.default_rng(seed)
    rows, cols = oracle.z.shape
    pairs = []
    while len(pairs) < count:
        ends = rng.uniform(0, 1, (2, 2)) * (cols - 1, rows - 1)
        if len(pairs) % 3 == 0:
            ends = np.round(ends)
        if np.hypot(*(ends[1] - ends[0])) >= 3:
            pairs.append(tuple(tuple(float(v) for v in oracle.frame.xy(*end)) for end in ends))
    return pairs
