# SPDX-License-Identifier: GPL-3.0-or-later
"""TINs that are no height fields, by seed: (vertices [n, 3], faces [m, 3]). Metres, about 40 across."""
from __future__ import annotations

import numpy as np


def sheet(rows, cols, place):
    """A sheet over the unit square: place(u, v) -> (x, y, z)."""
    u, v = np.meshgrid(np.linspace(0, 1, cols + 1), np.linspace(0, 1, rows + 1))
    vertices = np.stack([np.broadcast_to(c, u.shape) for c in place(u, v)], -1).reshape(-1, 3).astype(float)
    first = (np.arange(rows)[:, None] * (cols + 1) + np.arange(cols)).ravel()
    east, north, both = first + 1, first + cols + 1, first + cols + 2
    return vertices, np.concatenate([np.stack([first, east, both], 1), np.stack([first, both, north], 1)])


def together(*tins):
    starts = np.cumsum([0] + [len(v) for v, _ in tins])
    return np.concatenate([v for v, _ in tins]), np.concatenate([f + s for (_, f), s in zip(tins, starts)])


def _bumps(rng, height):
    a, b, c, d = rng.uniform(0, 6, 4)
    return lambda u, v: height * (np.sin(7 * u + a) * np.cos(6 * v + b) + 0.5 * np.sin(13 * v + c) * np.cos(11 * u + d))


def ground(rng, height=1.0, side=40.0, cells=20):
    z = _bumps(rng, height)
    return sheet(cells, cells, lambda u, v: (side * u, side * v, z(u, v)))


def arch(rng):
    """A tunnel's worth of half pipe on the ground, open at both ends."""
    radius = rng.uniform(5, 8)
    start, depth = rng.uniform(5, 12), rng.uniform(8, 20)
    angle = rng.uniform(-0.3, 0.1)
    turn = lambda u: angle + (np.pi - 2 * angle) * u
    return together(ground(rng), sheet(7, 12, lambda u, v: (20 - radius * np.cos(turn(u)), start + depth * v,
                                                            2 + radius * np.sin(turn(u)))))


def cave(rng):
    """A hill as one sheet that folds over itself: floor, back wall, roof, and the slope above."""
    bumps, mouth = _bumps(rng, 0.4), rng.uniform(10, 16)
    x = np.array([0, 5, 10, mouth, 20, 26, 32, 33, 33, 32, 26, 20, mouth, mouth - 1, mouth + 1, 20, 26, 33, 40])
    z = np.array([0, 0, 0, 0, 0, 0, 0, 1, 5, 6, 6, 6, 6, 7, 9, 11, 13, 14, 14])
    along = np.linspace(0, 1, len(x))
    return sheet(14, len(x) - 1, lambda u, v: (np.interp(u, along, x), 40 * v, np.interp(u, along, z) + bumps(v, v)))


def bridge(rng):
    """A deck over a valley."""
    depth, height = rng.uniform(6, 10), rng.uniform(0, 2)
    south = rng.uniform(12, 22)
    valley = sheet(20, 20, lambda u, v: (40 * u, 40 * v, -depth * np.sin(np.pi * u) ** 2 + 0.3 * np.sin(9 * v)))
    deck = sheet(2, 16, lambda u, v: (3 + 34 * u, south + 6 * v, height + 0.5 * np.sin(3 * u) + 0.2 * v))
    return together(valley, deck)


def quarry(rng):
    """A wall that leans over its foot."""
    lean, top = rng.uniform(1, 6), rng.uniform(8, 14)
    bumps = _bumps(rng, 0.3)
    x = np.array([0, 6, 12, 18, 20, 20 - lean / 2, 20 - lean, 20 - lean, 22, 28, 34, 40])
    z = np.array([0, 0, 0, 0, 0.5, top / 2, top - 1, top, top, top, top, top])
    along = np.linspace(0, 1, len(x))
    return sheet(14, len(x) - 1, lambda u, v: (np.interp(u, along, x) + bumps(v, 2 * v), 40 * v, np.interp(u, along, z) + bumps(u, v)))


def block(low, high, cells=4):
    """A closed box, its sides divided."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    sides = []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for end in (0, 1):
            def place(u, v, axis=axis, a=a, b=b, end=end):
                xyz = [None] * 3
                xyz[axis], xyz[a], xyz[b] = np.full(u.shape, (low, high)[end][axis]), u, v
                xyz[a], xyz[b] = low[a] + u * (high - low)[a], low[b] + v * (high - low)[b]
                return xyz
            vertices, faces = sheet(cells, cells, place)
            sides.append((vertices, faces if end else faces[:, ::-1]))
    return together(*sides)


def building(rng):
    """A block on the ground, its foot a little below it."""
    x, y = rng.uniform(10, 20, 2)
    return together(ground(rng, 0.5), block((x, y, -2), (x + rng.uniform(5, 12), y + rng.uniform(5, 12), rng.uniform(6, 12))))


def bodies(rng):
    """Closed: a slab, and above it a block and a ball with dents."""
    ball, faces = block((-1, -1, -1), (1, 1, 1), 5)
    ball = ball / np.linalg.norm(ball, axis=1)[:, None]
    ball = ball * (4.5 + 0.8 * np.sin(3 * ball[:, :1] + rng.uniform(0, 6)) * np.cos(4 * ball[:, 1:2])) + (12, 26, 8)
    x = rng.uniform(20, 26)
    return together(block((0, 0, -4), (40, 40, 0), 10), block((x, 8, 2), (x + 8, 18, rng.uniform(6, 12))), (ball, faces))


def two_sheets(rng):
    """One above the other, nearest in the middle, both looking up: between them the near side changes without a face."""
    gap, wide = rng.uniform(0.5, 1.2), rng.uniform(1.0, 5.0)
    bumps = _bumps(rng, rng.uniform(0.0, 0.1))
    apart = lambda u: gap + wide * (2 * u - 1) ** 2
    return together(sheet(16, 20, lambda u, v: (40 * u, 40 * v, 10 + bumps(u, v))),
                    sheet(16, 20, lambda u, v: (40 * u, 40 * v, 10 + bumps(u, v) + apart(u))))


def leaning(rng):
    """Sheets turned any way, which may cut through one another."""
    tins = [ground(rng)]
    for _ in range(4):
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        vertices, faces = sheet(4, 5, lambda u, v: (10 * u - 5, 8 * v - 4, 0.4 * np.sin(5 * u + 4 * v)))
        tins.append((vertices @ turn.T + np.append(rng.uniform(8, 32, 2), rng.uniform(3, 10)), faces))
    return together(*tins)


ALL = {"arch": arch, "cave": cave, "bridge": bridge, "quarry": quarry, "building": building, "bodies": bodies,
       "two sheets": two_sheets, "leaning": leaning}
