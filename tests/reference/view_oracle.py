# SPDX-License-Identifier: GPL-3.0-or-later
"""What is seen over a TIN on a flat Earth: every line is held against every edge it crosses."""
from __future__ import annotations

import numpy as np


class Ground:
    def __init__(self, vertices, faces):
        self.vertices, self.faces = np.asarray(vertices, float), np.asarray(faces)
        sides = np.sort(np.concatenate([self.faces[:, [0, 1]], self.faces[:, [1, 2]], self.faces[:, [2, 0]]]), axis=1)
        self.edges = np.unique(sides, axis=0)

    def heights(self, x, y):
        """NaN beside the TIN."""
        a, b, c = (self.vertices[self.faces[:, i]][:, :, None] for i in range(3))
        twice = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        u = ((x - a[:, 0]) * (c[:, 1] - a[:, 1]) - (y - a[:, 1]) * (c[:, 0] - a[:, 0])) / twice
        v = ((b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (b[:, 1] - a[:, 1]) * (x - a[:, 0])) / twice
        inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9)
        face, n = inside.argmax(axis=0), np.arange(len(x))
        u, v = u[face, n], v[face, n]
        at = (1 - u - v) * a[face, 2, 0] + u * b[face, 2, 0] + v * c[face, 2, 0]
        return np.where(inside.any(axis=0), at, np.nan)

    def clearances(self, eye, targets, at_end):
        """Of the lines from `eye` to each of `targets` [n, 3]: the least height above the TIN, all along but for the last `at_end`
        metres at both ends. Line and ground are linear between crossings, so it is found there or where the ends begin."""
        span = targets[:, :2] - eye[:2]
        far = np.hypot(span[:, 0], span[:, 1])
        least = np.full(len(targets), np.inf)
        for metres in (at_end, far - at_end):
            share = np.divide(metres, far, out=np.full(len(far), 0.5), where=far > 0)
            x, y = (eye[:2] + share[:, None] * span).T
            above = eye[2] + share * (targets[:, 2] - eye[2]) - self.heights(x, y)
            judged = (far > 2 * at_end) & ~np.isnan(above)
            least[judged] = np.minimum(least, above)[judged]
        a, b = self.vertices[self.edges[:, 0]], self.vertices[self.edges[:, 1]]
        for n in np.flatnonzero(far > 2 * at_end):
            side_a = span[n, 0] * (a[:, 1] - eye[1]) - span[n, 1] * (a[:, 0] - eye[0])
            side_b = span[n, 0] * (b[:, 1] - eye[1]) - span[n, 1] * (b[:, 0] - eye[0])
            met = ((np.minimum(side_a, side_b) <= 1e-9 * far[n]) & (np.maximum(side_a, side_b) >= -1e-9 * far[n])
                   & (np.abs(side_a - side_b) > 1e-9 * far[n]))  # edges along the line end where others cross it
            u = np.clip(side_a[met] / (side_a[met] - side_b[met]), 0.0, 1.0)
            at = a[met] + u[:, None] * (b[met] - a[met])
            share = ((at[:, 0] - eye[0]) * span[n, 0] + (at[:, 1] - eye[1]) * span[n, 1]) / far[n] ** 2
            above = eye[2] + share * (targets[n, 2] - eye[2]) - at[:, 2]
            judged = (share * far[n] >= at_end) & ((1 - share) * far[n] >= at_end)
            least[n] = min(least[n], above[judged].min(initial=np.inf))
        return least


def regular(z, cell):
    """The terrain of a DEM whose first cell's north-western corner is the origin."""
    rows, cols = z.shape
    r, c = np.mgrid[:rows, :cols]
    vertices = np.stack([(c.ravel() + 0.5) * cell, -(r.ravel() + 0.5) * cell, z.ravel().astype(float)], axis=1)
    corner = (r[:-1, :-1] * cols + c[:-1, :-1]).ravel()
    faces = np.concatenate([np.stack([corner, corner + cols + 1, corner + 1], axis=1),
                            np.stack([corner, corner + cols, corner + cols + 1], axis=1)])
    return Ground(vertices, faces[~np.isnan(vertices[faces, 2]).any(axis=1)])
