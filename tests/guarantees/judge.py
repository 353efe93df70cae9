# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene told once, asked of both sides: the product (`sightbound`) and the oracle.

The straight line of the grid may stand in for the geodesic where it deviates by less than 0.01 cell (docs/guarantees.md).
`agreement` therefore judges a cell by the geodesic, and, only where the oracle itself measures so small a deviation, accepts
the answer of the straight line as well.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
import pyproj
import sightbound as sb
from sight_oracle import END_ZONE, Errors, Oracle, probability, verdict, z_two_sided

P_TOLERANCE = 0.005      # of p, against the definition
TIE = 1e-6               # of k: where a verdict may fall either way
ZONE_TIE = 1e-5          # cells: a place this near to an end zone's border may count as inside or outside
STRAIGHT_CELLS = 0.01    # deviation up to which the straight grid line may stand in
HEIGHT_TOLERANCE = 0.1   # metres, of the lowest visible heights

NORTH_UP = (500.0, 10.0, 0.0, 900.0, 0.0, -10.0)


@dataclass(frozen=True)
class Scene:
    name: str
    z: np.ndarray
    gt: tuple = NORTH_UP
    crs: object = None
    errors: Errors = field(default_factory=Errors)
    observer: tuple = (5.0, 5.0)          # column, row: sample coordinates
    observer_height: float = 1.7
    target_height: float = 0.0
    confidence: float = 0.95
    how: dict = field(default_factory=dict)       # refraction, curvature, stand, height_reference, see_across
    limits: dict = field(default_factory=dict)    # min_distance, max_distance, azimuth, vertical_angle
    sample: int | None = None                     # judge only so many cells, drawn with seed 0
    ground: np.ndarray | None = None

    def but(self, **changes):
        return replace(self, **changes)

    @property
    def wkt(self):
        return None if self.crs is None else pyproj.CRS.from_user_input(self.crs).to_wkt()

    @property
    def dem(self):
        return sb.Dem(np.asarray(self.z, np.float32), self.gt, self.wkt)

    @property
    def model(self):
        e = self.errors
        delta = e.delta
        return sb.ErrorModel(vertical_rmse=e.vertical, horizontal_rmse=e.horizontal, geologic_variation=delta, geologic_range=e.range,
                             geologic_model=e.model, tails=e.tails, **({} if e.exponent is None else {"growth_exponent": e.exponent}))

    @property
    def z_two_sided(self):
        return z_two_sided(self.confidence, self.errors.tails)

    def oracle(self):
        return Oracle(np.asarray(self.z, np.float32), self.gt, self.crs, self.errors, ground=self.ground)

    def xy(self, oracle):
        return tuple(float(v) for v in oracle.frame.xy(*self.observer))

    def viewshed(self, oracle=None, **more):
        oracle = oracle or self.oracle()
        how = dict(self.how)
        if "see_across" in how:
            how["see_across_nodata"] = how.pop("see_across")
        if self.ground is not None:
            how["ground"] = sb.Dem(np.asarray(self.ground, np.float32), self.gt, self.wkt)
        arguments = dict(observer_height=self.observer_height, target_height=self.target_height, error_model=self.model,
                         confidence=self.confidence, **how, **self.limits)
        return sb.viewshed(self.dem, [self.xy(oracle)], **{**arguments, **more})


def placed(result, array, scene):
    """An output array on the whole DEM's grid; cells outside the output's window are not asked."""
    col, row = (int(round(float(v) + 0.5)) for v in
                Oracle(np.zeros(scene.z.shape), scene.gt).frame.colrow(result.geotransform[0], result.geotransform[3]))
    nothing = {np.float32: np.nan, np.uint8: 255, np.uint32: 4294967295}[array.dtype.type]
    whole = np.full(scene.z.shape, nothing, array.dtype)
    whole[row:row + array.shape[0], col:col + array.shape[1]] = array
    return whole


def cells_of(scene):
    if scene.sample is None:
        return list(np.ndindex(scene.z.shape))
    chosen = np.random.default_rng(0).choice(scene.z.size, scene.sample, replace=False)
    return [tuple(int(v) for v in np.unravel_index(i, scene.z.shape)) for i in chosen]


def fits(p, claimed, k, confidence, tails="normal"):
    """Do the product's p and verdict follow from this k?"""
    z = z_two_sided(confidence, tails)
    tie = min(abs(k - z), abs(k + z)) <= TIE
    return abs(p - probability(k, confidence, tails)) <= P_TOLERANCE and (claimed == verdict(k, confidence, tails) or tie)


def agreement(scene, result=None, heights=False):
    """All cells that do not follow from the definition, as text; an empty list is agreement."""
    oracle = scene.oracle()
    result = result or scene.viewshed(oracle, heights=heights)
    p, claimed = placed(result, result.confidence, scene), placed(result, result.verdict, scene)
    certain = likely = None
    if heights:
        certain, likely = placed(result, result.lowest_visible_height, scene), placed(result, result.likely_visible_height, scene)
    tails, z = scene.errors.tails, scene.z_two_sided
    xy = scene.xy(oracle)
    wrong = []

    def complain(cell, text):
        wrong.append(f"{scene.name}: cell {cell}: {text}")

    for cell, sight in oracle.viewshed(xy, scene.observer_height, scene.target_height, cells=cells_of(scene), **scene.how,
                                       **scene.limits).items():
        if sight is None:
            if not (math.isnan(p[cell]) and claimed[cell] == 255):
                complain(cell, f"not asked, yet p {p[cell]}, verdict {claimed[cell]}")
            continue
        candidates = [sight]
        if not _cell_fits(sight, cell, p, claimed, certain, likely, scene):
            candidates.extend(admissible(oracle, scene, xy, cell))
        if not any(_cell_fits(s, cell, p, claimed, certain, likely, scene) for s in candidates):
            text = f"p {p[cell]:.5f} verdict {claimed[cell]}, definition k {[f'{s.k:.7f}' for s in candidates]} " \
                   f"p {probability(sight.k, scene.confidence, tails):.5f} verdict {verdict(sight.k, scene.confidence, tails)} " \
                   f"at {sight.distance:.1f} m"
            if heights:
                text += f"; certain {certain[cell]} likely {likely[cell]}, definition {sight.needed_height(z)} {sight.needed_height(0)}"
            complain(cell, text)
    return wrong


def admissible(oracle, scene, xy, cell):
    """The other readings of the definition: the straight line where it may stand in, and places on the very border of an end
    zone taken in or left out."""
    t_xy = tuple(float(v) for v in oracle.frame.xy(cell[1], cell[0]))
    straight = ["grid"] if 0 < oracle.deviation(xy, t_xy) < STRAIGHT_CELLS else []
    for path in ["geodesic", *straight]:
        for zone in (END_ZONE, END_ZONE - ZONE_TIE, END_ZONE + ZONE_TIE):
            yield oracle.sight(xy, t_xy, scene.observer_height, scene.target_height, path=path, end_zone=zone, **scene.how)


def _cell_fits(sight, cell, p, claimed, certain, likely, scene):
    if not fits(p[cell], claimed[cell], sight.k, scene.confidence, scene.errors.tails):
        return False
    return certain is None or (_height_fits(certain[cell], sight.needed_height(scene.z_two_sided)) and _height_fits(likely[cell], sight.needed_height(0.0)))


def _height_fits(given, definition):
    if not math.isfinite(definition):
        return not math.isfinite(given)
    return abs(given - definition) <= HEIGHT_TOLERANCE + 1e-6 * abs(definition)


def check(scene, **how):
    wrong = agreement(scene, **how)
    assert not wrong, f"{len(wrong)} cells differ from the definition:\n" + "\n".join(wrong[:12])
