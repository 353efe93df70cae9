# SPDX-License-Identifier: GPL-3.0-or-later
"""The ordinary viewshed on the TIN in exact arithmetic (Fractions): flat earth, observer and targets on samples.

Rows run south; the diagonal of each square runs from (r, c) to (r + 1, c + 1)."""
from __future__ import annotations

import math
from fractions import Fraction

END_PLACES = (1 / 16, 1 / 8, 1 / 4, 1 / 2, 3 / 4)   # cells from either end


def least_clearance(z, observer, target, eye_height, target_height):
    """Exact least height of the line over the TIN at all crossings strictly between two samples (row, col), and at the places
    close to both ends (whose shares of the way are rounded to the nearest double; square cells)."""
    (r0, c0), (r1, c1) = observer, target
    dr, dc = r1 - r0, c1 - c0
    shares = set()
    for along in (dc, dr, dc - dr):
        shares.update(Fraction(i, abs(along)) for i in range(1, abs(along)))
    for f in END_PLACES:
        share = Fraction(f / math.hypot(dr, dc))
        shares.update(s for s in (share, 1 - share) if 0 < s < 1)
    z0 = Fraction(float(z[r0][c0])) + Fraction(eye_height)
    z1 = Fraction(float(z[r1][c1])) + Fraction(target_height)
    return min((1 - t) * z0 + t * z1 - surface(z, r0 + t * dr, c0 + t * dc) for t in shares)


def surface(z, row, col):
    r, c = min(math.floor(row), len(z) - 2), min(math.floor(col), len(z[0]) - 2)
    fy, fx = row - r, col - c
    nw, ne, sw, se = (Fraction(float(z[r + i][c + j])) for i in (0, 1) for j in (0, 1))
    return nw + fx * (ne - nw) + fy * (se - ne) if fx >= fy else nw + fy * (sw - nw) + fx * (se - sw)
