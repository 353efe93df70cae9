# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a TIN is from the surface of a DEM, in rational numbers: no rounding anywhere. For a few hundred faces."""

from fractions import Fraction


def _cross(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])


def _height(triangle, p):
    a, b, c = triangle
    whole = _cross(a, b, c)
    at_b, at_c = _cross(a, p, c) / whole, _cross(a, b, p) / whole
    return [u + at_b * (v - u) + at_c * (w - u) for u, v, w in zip(a[2:], b[2:], c[2:])]


def _common(one, other):
    """The polygon that two counterclockwise triangles share."""
    piece = [p[:2] for p in one]
    for i in range(3):
        a, b = other[i], other[(i + 1) % 3]
        kept = []
        for p, q in zip(piece, piece[1:] + piece[:1]):
            inside, after = _cross(a, b, p), _cross(a, b, q)
            if inside >= 0:
                kept.append(p)
            if inside * after < 0:
                t = inside / (inside - after)
                kept.append((p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])))
        piece = kept
        if not piece:
            break
    return piece


def _counterclockwise(a, b, c):
    return (a, b, c) if _cross(a, b, c) > 0 else (a, c, b)


def _box(triangle):
    return [f(p[i] for p in triangle) for f in (min, max) for i in (0, 1)]


def dem_triangles(heights, transform, tolerance):
    """Corners (x, y, height, tolerance): squares of samples, cut from NW to SE on the ground."""
    g = [Fraction(v) for v in transform]
    half = Fraction(1, 2)

    def sample(r, c):
        x = g[0] + (c + half) * g[1] + (r + half) * g[2]
        y = g[3] + (c + half) * g[4] + (r + half) * g[5]
        return (x, y, Fraction(float(heights[r, c])), Fraction(float(tolerance[r, c])))

    for r in range(heights.shape[0] - 1):
        for c in range(heights.shape[1] - 1):
            up, down = (r + 1, r) if transform[5] > 0 else (r, r + 1)
            nw, ne, sw, se = ((up, c), (up, c + 1), (down, c), (down, c + 1))
            for corners in ((nw, sw, se), (nw, se, ne)):
                if all(heights[s] == heights[s] for s in corners):
                    yield _counterclockwise(*(sample(*s) for s in corners))


def exact_deviation(heights, transform, tolerance, vertices, faces):
    """The largest |TIN - DEM|, and of that over the tolerance (where this is more than 0), and what it is above it at most."""
    places = [tuple(Fraction(float(v)) for v in vertex) for vertex in vertices]
    new = [_counterclockwise(*(places[n] for n in face)) for face in faces]
    boxes = [_box(t) for t in new]
    deviation = ratio = Fraction(0)
    excess = None
    for old in dem_triangles(heights, transform, tolerance):
        west, south, east, north = _box(old)
        for triangle, box in zip(new, boxes):
            if box[0] > east or box[2] < west or box[1] > north or box[3] < south:
                continue
            for p in _common(old, triangle):
                height, allowed = _height(old, p)
                off = abs(_height(triangle, p)[0] - height)
                deviation = max(deviation, off)
                excess = off - allowed if excess is None else max(excess, off - allowed)
                if allowed > 0:
                    ratio = max(ratio, off / allowed)
    return deviation, ratio, excess
