# SPDX-License-Identifier: GPL-3.0-or-later
"""Brute-force line of sight: the definition of docs/guarantees.md, written to be read, not to be fast.

Shares no code with the product: numpy for arithmetic, pyproj (Geod, Transformer) for the earth.

Notation (all lengths in metres)
    O, T      eye and target: x, y in the DEM's CRS; zO, zT their heights
    s, D      distance along the geodesic from O, its whole length;  t = s/D
    col,row   sample coordinates of the file: integers are cell centres
    J         judged places: crossings of the geodesic with column, row and diagonal lines, and the places f*L from each end
    L         the larger side of a cell at the middle row of the DEM
    A         geologic amplitude, Delta / z(0.95)
    k*        min over J of (line - terrain) / sigma

The terrain is the TIN through the cell centres, each square split along the diagonal that runs NW-SE on the ground. The file's
own row order is kept throughout: `diagonal` says which of a square's two diagonals that is.
"""
from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field
from statistics import NormalDist

import numpy as np
import pyproj

NORMAL = NormalDist()
Z95 = NORMAL.inv_cdf(0.975)
END_FRACTIONS = (1 / 16, 1 / 8, 1 / 4, 1 / 2, 3 / 4)
FLOOR = 0.001           # smallest sigma, metres
END_ZONE = 1.5          # cells from an end where sigma_g alone counts
PLANE_RADIUS = 6371008.8
CERTAIN_K = 3.29        # beyond, p is 0 or 1; other tails than the normal: at the same p
SAMPLES_PER_CELL = 6    # dense sampling of the path before root finding
SNAP = 2e-8             # a sample coordinate this near to an integer is that integer (UTM northings carry 1e-9 m)
ROOT = 1e-8             # crossings are found to this many cells
RIM = 0.01              # cells: a place this far outside the samples follows their rim
SLIVER = 1e-4           # a nodata sample of this weight or less makes no hole
AT_END = 1e-4           # a place this many cells from an end is the end itself, and not judged


# Densities of variance 1; Student's has 5 degrees of freedom.
DENSITIES = {
    "laplace": lambda k: np.exp(-math.sqrt(2) * np.abs(k)) / math.sqrt(2),
    "student": lambda k: 8 / (3 * math.sqrt(3) * math.pi) * (1 + k * k / 3) ** -3.0,
}
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(60)


def cdf(k, tails="normal"):
    """F(k), by integrating the density from 0."""
    if tails == "normal":
        return NORMAL.cdf(k)
    return 0.5 + float(np.sum(_WEIGHTS * DENSITIES[tails]((_NODES + 1) * k / 2))) * k / 2


def quantile(p, tails):
    """The k with F(k) = p >= 1/2, by bisection."""
    low, high = 0.0, 100.0
    while high - low > 1e-13 * high:
        middle = (low + high) / 2
        low, high = (middle, high) if cdf(middle, tails) < p else (low, middle)
    return low


@functools.lru_cache
def z_two_sided(confidence, tails="normal"):
    """z(c): 0.95 -> 1.960."""
    p = 0.5 + confidence / 2
    return NORMAL.inv_cdf(p) if tails == "normal" else quantile(p, tails)


@functools.lru_cache
def certain_k(tails="normal"):
    return CERTAIN_K if tails == "normal" else quantile(NORMAL.cdf(CERTAIN_K), tails)


def probability(k, confidence, tails="normal"):
    """p of the critical clearance ratio, exactly 0 or 1 beyond max(certain_k(), z(c))."""
    limit = max(certain_k(tails), z_two_sided(confidence, tails))
    if k >= limit:
        return 1.0
    if k <= -limit:
        return 0.0
    return cdf(k, tails)


def verdict(k, confidence, tails="normal"):
    """2 visible, 1 uncertain, 0 hidden."""
    z = z_two_sided(confidence, tails)
    return 2 if k >= z else 0 if k <= -z else 1


class Frame:
    """Sample coordinates <-> CRS <-> ground. `crs` is anything pyproj takes, or None for a plane in metres."""

    def __init__(self, shape, geotransform, crs=None):
        self.rows, self.cols = shape
        self.gt = tuple(float(v) for v in geotransform)
        _, a, b, _, d, e = self.gt
        self.inverse = np.linalg.inv(np.array([[a, b], [d, e]]))
        self.crs = None if crs is None else _horizontal(pyproj.CRS.from_user_input(crs))
        if self.crs is not None:
            ellipsoid = self.crs.ellipsoid
            self.geod = pyproj.Geod(a=ellipsoid.semi_major_metre, b=ellipsoid.semi_minor_metre)
            if not self.crs.is_geographic:
                base = self.crs.geodetic_crs
                self.to_lonlat = pyproj.Transformer.from_crs(self.crs, base, always_xy=True)
                self.from_lonlat = pyproj.Transformer.from_crs(base, self.crs, always_xy=True)

    def xy(self, col, row):
        g = self.gt
        c, r = np.asarray(col, float) + 0.5, np.asarray(row, float) + 0.5
        return g[0] + g[1] * c + g[2] * r, g[3] + g[4] * c + g[5] * r

    def colrow(self, x, y):
        dx, dy = np.asarray(x, float) - self.gt[0], np.asarray(y, float) - self.gt[3]
        m = self.inverse
        return m[0, 0] * dx + m[0, 1] * dy - 0.5, m[1, 0] * dx + m[1, 1] * dy - 0.5

    def lonlat(self, x, y):
        if self.crs.is_geographic:
            return np.asarray(x, float), np.asarray(y, float)
        return self.to_lonlat.transform(x, y, errcheck=True)

    def from_ll(self, lon, lat):
        if not self.crs.is_geographic:
            return self.from_lonlat.transform(lon, lat, errcheck=True)
        middle, _ = self.xy((self.cols - 1) / 2, (self.rows - 1) / 2)
        return lon + 360.0 * np.round((middle - lon) / 360.0), lat

    def inverse_geodesic(self, a_xy, b_xy):
        """(distance, azimuth at a) on the ground."""
        if self.crs is None:
            dx, dy = b_xy[0] - a_xy[0], b_xy[1] - a_xy[1]
            return math.hypot(dx, dy), math.degrees(math.atan2(dx, dy)) % 360.0
        (lon1, lat1), (lon2, lat2) = self.lonlat(*a_xy), self.lonlat(*b_xy)
        azimuth, _, distance = self.geod.inv(lon1, lat1, lon2, lat2)
        return distance, azimuth % 360.0

    def path(self, a_xy, azimuth, s):
        """Sample coordinates of the ground points at distances s from a."""
        s = np.asarray(s, float)
        if self.crs is None:
            angle = math.radians(azimuth)
            return self.colrow(a_xy[0] + s * math.sin(angle), a_xy[1] + s * math.cos(angle))
        lon, lat = self.lonlat(*a_xy)
        n = np.ones(s.shape)
        lons, lats, _ = self.geod.fwd(lon * n, lat * n, azimuth * n, s)
        return self.colrow(*self.from_ll(np.asarray(lons), np.asarray(lats)))

    def euler_radius(self, a_xy, azimuth, distance):
        """Radius of the ellipsoid's normal section at the geodesic's midpoint, in its azimuth there."""
        if self.crs is None:
            return PLANE_RADIUS
        lon, lat = self.lonlat(*a_xy)
        _, lat_mid, back = self.geod.fwd(lon, lat, azimuth, distance / 2)
        az = math.radians(back + 180.0)
        e2, sin2 = self.geod.es, math.sin(math.radians(lat_mid)) ** 2
        prime = self.geod.a / math.sqrt(1 - e2 * sin2)
        meridian = self.geod.a * (1 - e2) / (1 - e2 * sin2) ** 1.5
        return 1 / (math.cos(az) ** 2 / meridian + math.sin(az) ** 2 / prime)

    def step_lengths(self, row):
        """(col_m, row_m): ground length of one step along each axis, centred on (row, middle column)."""
        col = (self.cols - 1) / 2
        ends = [((col - 0.5, row), (col + 0.5, row)), ((col, row - 0.5), (col, row + 0.5))]
        return tuple(self.inverse_geodesic(self.xy(*p), self.xy(*q))[0] for p, q in ends)

    @property
    def diagonal(self):
        """'main' when the step (+col, +row) is nearer to NW-SE on the ground than (+col, -row), else 'anti'."""
        _, a, b, _, d, e = self.gt
        southeast = np.array([1.0, -1.0]) / math.sqrt(2)

        def closeness(v):
            return abs(v @ southeast) / np.linalg.norm(v)

        e1, e2 = np.array([a, d]), np.array([b, e])
        return "anti" if closeness(e1 - e2) > closeness(e1 + e2) + 1e-12 else "main"


def _horizontal(crs):
    if crs.is_bound:
        crs = crs.source_crs
    return crs.sub_crs_list[0] if crs.is_compound else crs


@dataclass
class Errors:
    """sigma_v, amplitude: number or array; delta is amplitude * z(0.95). model: gaussian | step | growth."""
    vertical: object = 1.0
    horizontal: float = 0.0
    delta: object = 0.0
    range: float | None = None
    model: str = "gaussian"
    exponent: float | None = None
    tails: str = "normal"


@dataclass
class Sight:
    """One judged line. `places`: arrays s, col, row, terrain, sigma, line, known."""
    k: float
    distance: float
    azimuth: float
    angle: float
    places: dict
    target_ground: float
    _needed: object = field(repr=False, default=None)

    def needed_height(self, z):
        """Smallest height >= 0 above the target's ground with k* >= z; inf when no height does it, nan over unknown ground."""
        return self._needed(z)


class Oracle:
    def __init__(self, heights, geotransform, crs=None, errors=None, ground=None):
        self.z = np.asarray(heights, np.float64)
        self.ground = self.z if ground is None else np.asarray(ground, np.float64)
        self.frame = Frame(self.z.shape, geotransform, crs)
        self.errors = errors or Errors()
        self.anti = self.frame.diagonal == "anti"
        rows, cols = self.z.shape
        self.steps = np.array([self.frame.step_lengths(r) for r in range(rows)])
        # The middle row, the upper of two, in the order in which the diagonal is the main one.
        self.cell = max(self.steps[rows // 2 if self.anti else (rows - 1) // 2])
        self.amplitude = np.broadcast_to(np.asarray(self.errors.delta, float) / Z95, self.z.shape)
        self.sigma_s = (np.broadcast_to(np.asarray(self.errors.vertical, float), self.z.shape)
                        + self.errors.horizontal * self.slope())

    # ---- terrain -------------------------------------------------------------------------------------------------

    def slope(self):
        """tan of the steepest triangle around each sample (cell size of the sample's row); 0 where none is whole."""
        rows, cols = self.z.shape
        steepest = np.zeros((rows, cols))
        a, b, c, d = ([np.s_[i:rows - 1 + i], np.s_[j:cols - 1 + j]] for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)))
        # Each triangle has one right-angled corner: its legs run along the row and along the column.
        legs = (((a, b), (a, c), (a, b, c)), ((c, d), (b, d), (b, c, d))) if self.anti else \
               (((a, b), (b, d), (a, b, d)), ((c, d), (a, c), (a, c, d)))
        for (c0, c1), (r0, r1), corners in legs:
            by_col, by_row = self.z[tuple(c1)] - self.z[tuple(c0)], self.z[tuple(r1)] - self.z[tuple(r0)]
            for corner in corners:
                col_m, row_m = self.steps[corner[0]].T
                tan = np.hypot(by_col / col_m[:, None], by_row / row_m[:, None])
                steepest[tuple(corner)] = np.fmax(steepest[tuple(corner)], tan)
        return steepest

    def corners(self, col, row):
        """(rows, cols, weights), each [3, places]: the samples a place is interpolated from. Outside the samples' hull the
        weights are nan. Weights below SNAP count as zero: a place on an edge has two corners, on a sample one."""
        rows, cols = self.z.shape
        col, row = _snap(col), _snap(row)
        outside = (col < -RIM) | (col > cols - 1 + RIM) | (row < -RIM) | (row > rows - 1 + RIM)
        col, row = np.clip(col, 0, cols - 1), np.clip(row, 0, rows - 1)
        c = np.clip(np.floor(col), 0, max(cols - 2, 0)).astype(int)
        r = np.clip(np.floor(row), 0, max(rows - 2, 0)).astype(int)
        fx, fy = col - c, row - r
        c1, r1 = np.minimum(c + 1, cols - 1), np.minimum(r + 1, rows - 1)
        if self.anti:
            first = fx + fy <= 1
            upper, lower = ((r, c, 1 - fx - fy), (r, c1, fx), (r1, c, fy)), ((r1, c1, fx + fy - 1), (r, c1, 1 - fy), (r1, c, 1 - fx))
        else:
            first = fx >= fy
            upper, lower = ((r, c, 1 - fx), (r, c1, fx - fy), (r1, c1, fy)), ((r, c, 1 - fy), (r1, c, fy - fx), (r1, c1, fx))
        corner_rows, corner_cols, weights = (np.stack([np.where(first, u[i], l[i]) for u, l in zip(upper, lower)]) for i in range(3))
        weights = np.where(weights > SNAP, weights, 0.0)
        return corner_rows, corner_cols, np.where(outside, np.nan, weights)

    def at(self, values, col, row):
        """TIN interpolation; nan outside or when a corner that counts is a hole of the DEM."""
        r, c, w = self.corners(col, row)
        w = np.where(np.isnan(self.z[r, c]) & (w <= SLIVER), 0.0, w)
        w = w / np.sum(w, axis=0)
        return np.sum(np.where(w == 0, 0.0, w * values[r, c]), axis=0)

    def ground_distance(self, col, row):
        """Distance to the nearest sample. The cell size is that of the square's first row in the NW-SE order."""
        rows, cols = self.z.shape
        col, row = np.clip(_snap(col), 0, cols - 1), np.clip(_snap(row), 0, rows - 1)
        size_row = np.ceil(row) if self.anti else np.floor(row)
        col_m, row_m = self.steps[np.clip(size_row, 0, len(self.steps) - 1).astype(int)].T
        fx, fy = col - np.floor(col), row - np.floor(row)
        return np.hypot(np.minimum(fx, 1 - fx) * col_m, np.minimum(fy, 1 - fy) * row_m)

    def sigma_g(self, col, row):
        amplitude = self.at(self.amplitude, col, row)
        d = self.ground_distance(col, row)
        e = self.errors
        if e.model == "gaussian":
            q = 1 - np.exp(-0.5 * (amplitude * Z95 * d if e.range is None else d / e.range) ** 2)
        elif e.model == "step":
            q = np.where(d < e.range, 0.0, 1.0)
        elif e.model == "growth":
            t, h, root2 = 2 * d / self.cell, min(e.exponent, 1.0), np.sqrt(2)
            q = np.where(t < 1, (np.minimum(t, 1) * (2 - np.minimum(t, 1))) ** h,
                         np.clip(t, 1, root2) ** (h / 2) * np.maximum(t / root2, 1) ** e.exponent)
        else:
            raise ValueError(e.model)
        return amplitude * q

    # ---- the line ------------------------------------------------------------------------------------------------

    def judged_places(self, o_xy, azimuth, distance, t_xy, path="geodesic"):
        """Sorted distances s of J and their sample coordinates. path='grid' walks the straight line of the raster instead."""
        if path == "grid":
            (c0, r0), (c1, r1) = self.frame.colrow(*o_xy), self.frame.colrow(*t_xy)

            def coordinates(s):
                t = np.asarray(s, float) / distance
                return c0 + t * (c1 - c0), r0 + t * (r1 - r0)
        else:
            def coordinates(s):
                return self.frame.path(o_xy, azimuth, s)

        (c0, r0), (c1, r1) = coordinates(0.0), coordinates(distance)
        s = np.linspace(0.0, distance, 2 + int(SAMPLES_PER_CELL * max(abs(c1 - c0), abs(r1 - r0), 2)))
        found = [f * self.cell for f in END_FRACTIONS] + [distance - f * self.cell for f in END_FRACTIONS]
        found.extend(_line_crossings(coordinates, self.anti, s))
        margin = AT_END * self.cell
        places = np.array(sorted(v for v in found if margin < v < distance - margin))
        if places.size == 0:
            return places, places, places
        col, row = coordinates(places)
        return places, col, row

    def sight(self, o_xy, t_xy, observer_height=1.7, target_height=0.0, *, refraction=0.13, curvature=True, stand="model",
              height_reference="ground", see_across=False, path="geodesic", end_zone=END_ZONE):
        frame = self.frame
        (oc, orow), (tc, trow) = frame.colrow(*o_xy), frame.colrow(*t_xy)
        ground_o, ground_t = self.at(self.ground, oc, orow), self.at(self.ground, tc, trow)
        absolute = height_reference == "absolute"
        zo = observer_height if absolute else ground_o + observer_height
        zt = target_height if absolute else ground_t + target_height
        distance, azimuth = frame.inverse_geodesic(o_xy, t_xy)
        if distance == 0.0:
            return Sight(math.inf, 0.0, azimuth, math.nan, {}, ground_t, lambda z: 0.0)
        radius = frame.euler_radius(o_xy, azimuth, distance)
        bend = (1 - refraction) / (2 * radius) if curvature else 0.0
        angle = math.degrees(math.atan2(zt - bend * distance ** 2 - zo, distance))

        s, col, row = self.judged_places(o_xy, azimuth, distance, t_xy, path)
        sway = [self.at(self.sigma_s, oc, orow), self.at(self.sigma_s, tc, trow)] if stand == "ground" else [0.0, 0.0]
        t = s / distance
        terrain = self.at(self.z, col, row)
        line = (1 - t) * zo + t * zt - bend * t * (1 - t) * distance ** 2
        near_end = (s < end_zone * self.cell) | (distance - s < end_zone * self.cell)
        sampling = np.where(near_end, 0.0, self.at(self.sigma_s, col, row))
        sigma = np.maximum(sampling + self.sigma_g(col, row), FLOOR) + (1 - t) * sway[0] + t * sway[1]
        known = ~np.isnan(terrain)
        k = float(np.min((line - terrain)[known] / sigma[known])) if known.any() else math.inf
        hole = bool((~known).any()) and not see_across
        if hole:
            k = min(k, 0.0)

        def needed(z):
            if math.isnan(ground_t):
                return math.nan     # nothing to count from
            if hole and z > 0:
                return math.inf
            eye = (1 - t) * zo - bend * t * (1 - t) * distance ** 2
            lowest = (terrain + z * sigma - eye) / t - ground_t
            return max(0.0, float(np.max(lowest[known], initial=0.0)))

        places = dict(s=s, col=col, row=row, terrain=terrain, sigma=sigma, line=line, known=known)
        return Sight(k, distance, azimuth, angle, places, ground_t, needed)

    # ---- viewshed ------------------------------------------------------------------------------------------------

    def viewshed(self, o_xy, observer_height=1.7, target_height=0.0, *, cells=None, min_distance=0.0, max_distance=None,
                 azimuth=(0.0, 360.0), vertical_angle=(-90.0, 90.0), **how):
        """{(row, col): Sight}, or None for a cell that is nodata or not asked."""
        rows, cols = self.z.shape
        result = {}
        for row, col in cells if cells is not None else np.ndindex(rows, cols):
            result[row, col] = None
            if math.isnan(self.z[row, col]) or (how.get("height_reference") != "absolute" and math.isnan(self.ground[row, col])):
                continue
            t_xy = tuple(float(v) for v in self.frame.xy(col, row))
            sight = self.sight(o_xy, t_xy, observer_height, target_height, **how)
            if asked(sight, min_distance, max_distance, azimuth, vertical_angle):
                result[row, col] = sight
        return result

    def deviation(self, o_xy, t_xy):
        """Largest distance, in cells, between the geodesic and the straight grid line at equal fractions of the way."""
        distance, azimuth = self.frame.inverse_geodesic(o_xy, t_xy)
        if distance == 0.0 or self.frame.crs is None:
            return 0.0
        t = np.linspace(0, 1, 65)
        col, row = self.frame.path(o_xy, azimuth, t * distance)
        (c0, r0), (c1, r1) = self.frame.colrow(*o_xy), self.frame.colrow(*t_xy)
        return float(np.max(np.hypot(col - (c0 + t * (c1 - c0)), row - (r0 + t * (r1 - r0)))))


def asked(sight, min_distance=0.0, max_distance=None, azimuth=(0.0, 360.0), vertical_angle=(-90.0, 90.0)):
    if sight.distance < min_distance or (max_distance is not None and sight.distance > max_distance):
        return False
    if sight.distance == 0.0:
        return True
    start, end = azimuth
    if end - start < 360.0 and (sight.azimuth - start) % 360.0 > (end - start) % 360.0:
        return False
    return vertical_angle[0] <= sight.angle <= vertical_angle[1]


def _snap(value):
    value = np.asarray(value, float)
    nearest = np.round(value)
    return np.where(np.abs(value - nearest) < SNAP, nearest, value)


def _lines(col, row, anti):
    """The three coordinates whose integers are the TIN's lines: column, row, diagonal."""
    return np.stack([col, row, col + row if anti else col - row])


def _line_crossings(coordinates, anti, s):
    """All s where the path crosses (or touches) a line of the TIN; a path that runs along a line does not cross it."""
    values = _lines(*coordinates(s), anti)
    while np.abs(np.diff(values)).max() >= 1:
        s = np.linspace(s[0], s[-1], 2 * s.size)
        values = _lines(*coordinates(s), anti)
    for which in range(3):
        s, values = _with_extrema(coordinates, anti, which, s, values)
    # Neighbouring nodes are less than a cell apart, so at most one line of a kind lies between them.
    on = np.abs(values - np.round(values)) < SNAP
    beside = np.pad(on, ((0, 0), (1, 1)))
    found = list(np.broadcast_to(s, values.shape)[on & ~beside[:, :-2] & ~beside[:, 2:]])
    below = np.floor(values)
    kind, low = np.nonzero(~on[:, :-1] & ~on[:, 1:] & (below[:, :-1] != below[:, 1:]))
    if low.size == 0:
        return found
    high, lanes = low + 1, np.arange(low.size)
    n = np.maximum(below[kind, low], below[kind, high])

    def f(where):
        return _lines(*coordinates(where), anti)[kind, lanes] - n

    return found + list(_ridders(f, s[low], s[high], values[kind, low] - n, values[kind, high] - n))


def _with_extrema(coordinates, anti, which, s, values):
    """Adds the places where a coordinate turns to the nodes, so that no two crossings hide between neighbours."""
    v = values[which]
    before, after = v[1:-1] - v[:-2], v[2:] - v[1:-1]
    bend = np.maximum(np.abs(before), np.abs(after))    # the turn lies within this of the node's value
    for i in np.flatnonzero((before * after < 0) & (bend > SNAP) & (np.abs(v - np.round(v))[1:-1] <= bend)) + 1:
        sign = 1.0 if v[i] > v[i - 1] else -1.0
        low, high = s[i - 1], s[i + 1]
        for _ in range(40):
            a, b = low + (high - low) / 3, high - (high - low) / 3
            va, vb = sign * _lines(*coordinates(np.array([a, b])), anti)[which]
            low, high = (a, high) if va < vb else (low, b)
        s = np.append(s, (low + high) / 2)
    order = np.argsort(s)
    return (s, values) if order.size == values.shape[1] else (s[order], _lines(*coordinates(s[order]), anti))


def _ridders(f, a, b, fa, fb):
    """Roots of f, one in each bracket [a, b], all refined together (Ridders 1979)."""
    root = 0.5 * (a + b)
    for _ in range(60):
        m = 0.5 * (a + b)
        fm = f(m)
        root = m + (m - a) * np.sign(fa) * fm / np.sqrt(fm * fm - fa * fb)
        fr = f(root)
        if np.all(np.abs(fr) < ROOT):
            break
        # Of the points a, m, root, b in order keep the two neighbours between which the sign changes.
        points, signs = np.stack([a, m, root, b]), np.stack([fa, fm, fr, fb])
        order = np.argsort(points, axis=0, kind="stable")
        points, signs = np.take_along_axis(points, order, 0), np.take_along_axis(signs, order, 0)
        first, lanes = np.argmax(np.sign(signs[:-1]) != np.sign(signs[1:]), axis=0), np.arange(len(a))
        met = np.abs(fr) < ROOT
        a, b = np.where(met, root, points[first, lanes]), np.where(met, root, points[first + 1, lanes])
        fa, fb = np.where(met, 1.0, signs[first, lanes]), np.where(met, -1.0, signs[first + 1, lanes])
    return root
