# SPDX-License-Identifier: GPL-3.0-or-later
"""S6: on a TIN within visibility_tolerance() of the DEM, observers see what they are sure to see from the DEM, and nothing that is
surely hidden. Oracle: every line against every edge it crosses, of the TIN that dem_to_tin() makes, and of the worst surfaces that
the tolerance allows."""
import numpy as np
import pytest
import terrains
from view_oracle import Ground, regular

import sightbound as sb

CELL = 10.0
GT = (0.0, CELL, 0.0, 0.0, 0.0, -CELL)
AT_END = CELL / 16  # places nearer to an end are not judged
HIDDEN, VISIBLE = 0, 2


def place(row, col):
    return (col + 0.5) * CELL, -(row + 0.5) * CELL


def slit(shape, observer, across, along, height=100.0, hill=20.0):
    """A wall `along` columns from the observer with a notch `across` rows off, and a hill behind it in the same direction: some
    places between samples are seen, the samples around them are not."""
    (row, col), z = observer, np.random.default_rng(across).uniform(0.0, 0.3, shape)
    z[:, col + along] = height
    z[row + across, col + along] = 0.0
    z[row + 4 * across, col + 4 * along] = hill
    return z


def notched(shape, observer, seed):
    """Walls around the observer, with notches."""
    rng = np.random.default_rng(seed)
    row, col = np.indices(shape)
    ring = np.maximum(abs(row - observer[0]), abs(col - observer[1]))
    z = rng.uniform(0.0, 1.0, shape)
    for distance, height in ((1, 4.0), (3, 12.0)):
        z[ring == distance] = height
        notches = (ring == distance) & (rng.random(shape) < 0.2)
        z[notches] = height * rng.uniform(0.0, 0.7, notches.sum())
    return z


def wrong_claims(ground, ends, sure, observer, observer_height, target_height):
    """Of claims, those that are not so above `ground`, the eye and the targets standing on `ends`."""
    rows, cols = np.nonzero((sure == HIDDEN) | (sure == VISIBLE))
    x, y = place(rows, cols)
    eye = np.array([*observer, ends.heights(*np.array(observer)[:, None])[0] + observer_height])
    targets = np.stack([x, y, ends.heights(x, y) + target_height], axis=1)
    clear = ground.clearances(eye, targets, AT_END)
    right = np.where(sure[rows, cols] == VISIBLE, clear > 0, (clear < 0) | np.isinf(clear))  # infinite: right before the eye
    return int((~right).sum())


class Case:
    def __init__(self, name, z, observers, sigma, tolerance, target_height=0.0, observer_height=2.0, confidence=0.95):
        self.name, self.observers, self.tolerance = name, observers, tolerance
        self.z = np.float32(z)
        self.dem, self.heights = sb.Dem(self.z, GT), (observer_height, target_height)
        self.how = dict(observer_height=observer_height, target_height=target_height, confidence=confidence, curvature=False,
                        error_model=sb.ErrorModel(vertical_rmse=sigma, geologic_variation=0.0))

    def limit(self):
        return sb.visibility_tolerance(self.dem, self.observers, self.tolerance, **self.how)

    def sure(self, observer):
        return sb.viewshed(self.dem, [observer], stand="ground", **self.how).verdict

    def wrong(self, ground):
        return sum(wrong_claims(ground, ground, self.sure(o), o, *self.heights) for o in self.observers)

    def wrong_at_worst(self, limit):
        """Were all ground as high and both ends as low as they may be, would what is visible stay so? And the other way round?"""
        low, high = regular(self.z - limit.astype(float), CELL), regular(self.z + limit.astype(float), CELL)
        wrong = 0
        for observer in self.observers:
            sure = self.sure(observer)
            wrong += wrong_claims(high, low, np.where(sure == VISIBLE, sure, 1), observer, *self.heights)
            wrong += wrong_claims(low, high, np.where(sure == HIDDEN, sure, 1), observer, *self.heights)
        return wrong


TWO = [(121.7, -118.2), (35.0, -165.0)]
ERRORS = np.float32(np.exp(np.random.default_rng(5).normal(0.0, 1.0, (20, 22))) * 0.05)
CASES = [
    Case("fractal", terrains.fractal((20, 22), 3), TWO, 0.2, 6.0, 1.0),
    Case("tall targets", terrains.fractal((20, 24), 12, relief=80.0), TWO, 0.3, 8.0, 4.0),
    Case("targets taller than the tolerance", terrains.fractal((20, 24), 12, relief=160.0), [(121.7, -118.2)], 0.1, 8.0, 8.0),
    Case("rough", terrains.fractal((20, 22), 4, relief=200.0, roughness=1.2), TWO, 0.3, 4.0),
    Case("errors differ", terrains.fractal((20, 22), 21, relief=120.0), [(104.0, -97.0)], ERRORS, 3.0),
    Case("walls", terrains.ridges((20, 20), height=30.0) + terrains.noise((20, 20), 6, relief=6.0), [(94.0, -107.0)], 0.3, 4.0),
    Case("low confidence", terrains.ridges((20, 22), height=15.0, period=5) + terrains.noise((20, 22), 4, relief=8.0),
         [(121.0, -77.0)], 0.3, 3.0, confidence=0.6),
    Case("slit", slit((17, 26), (4, 2), 1, 5), [place(4, 2)], 0.01, 10.0),
    Case("steeper slit", slit((17, 26), (4, 2), 2, 5), [place(4, 2)], 0.01, 10.0),
    Case("notches", notched((19, 21), (9, 10), 1), [place(9, 10)], 0.01, 2.0),
    Case("notches, beside a sample", notched((19, 21), (9, 10), 2), [place(9.3, 9.8)], 0.1, 2.0),
    Case("plateaus", terrains.plateaus((20, 20), 7, step=15.0), [place(8, 9), place(0, 19)], 0.1, 2.0),
    Case("spikes", terrains.fractal((20, 20), 9, relief=60.0) + terrains.spikes((20, 20), 9), [place(10, 11)], 0.05, 3.0),
    Case("holes", terrains.with_holes(terrains.fractal((20, 20), 17, relief=120.0), 3, keep=(9, 12)), [place(12.4, 9.6)], 0.1, 4.0),
]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_s6_views_stay(case):
    limit, report = case.limit()
    assert 0.02 < report["free_share"] < 1 and limit.max() == pytest.approx(case.tolerance)
    for observer in case.observers:
        assert (case.sure(observer) == VISIBLE).sum() > 5 and (case.sure(observer) == HIDDEN).sum() > 8
    assert case.wrong_at_worst(limit) == 0
    assert case.wrong_at_worst(np.full_like(limit, case.tolerance)) > 0  # is it too large for the views?
    tin = sb.dem_to_tin(case.dem, tolerance=limit)
    assert case.wrong(Ground(tin.vertices, tin.faces)) == 0
    rng = np.random.default_rng(6)
    for moved in (rng.uniform(-1.0, 1.0, limit.shape), rng.choice([-1.0, 1.0], limit.shape)):
        assert case.wrong(regular(case.z + moved * limit, CELL)) == 0


def test_without_error_what_is_in_view_stays_exactly():
    case = Case("exact", terrains.fractal((24, 24), 8), [(125.0, -125.0)], 0.0, 5.0)
    limit, _ = case.limit()
    assert (limit[case.sure((125.0, -125.0)) != HIDDEN] == 0).all() and (limit == 5).any()


def test_what_is_in_view_keeps_to_the_least_error_of_all():
    z, sigma = np.zeros((15, 24), np.float32), np.full((15, 24), 0.01, np.float32)
    z[:, 3], z[7, 3], sigma[7, 3] = 1.9, 0.0, 5.0  # a gate in a wall, badly known, right before the eye
    case = Case("gate", z, [(25.0, -75.0)], sigma, 6.0, 0.5, 1.0)
    limit, _ = case.limit()
    sure = case.sure((25.0, -75.0))
    assert (sure == VISIBLE).sum() > 100 and limit[sure == VISIBLE].max() <= 0.5 * 1.96 * 0.01
    tin = sb.dem_to_tin(case.dem, tolerance=limit)
    assert case.wrong(Ground(tin.vertices, tin.faces)) == 0


def test_bad_input_is_named():
    dem = sb.Dem(np.float32(terrains.fractal((12, 12), 8)), GT)
    with pytest.raises(ValueError, match="target_height"):
        sb.visibility_tolerance(dem, [(55.0, -55.0)], 5.0, target_height=-1.0)
    for arguments, word in ((([(500.0, 500.0)], 5.0), "outside"), (([(55.0, -55.0)], -1.0), "tolerance"),
                            (([(55.0, -55.0)], float("nan")), "tolerance"), (([], 5.0), "observers")):
        with pytest.raises(ValueError, match=word):
            sb.visibility_tolerance(dem, *arguments)
    degrees = sb.Dem(np.zeros((12, 12), np.float32), (11.0, 0.001, 0.0, 47.0, 0.0, -0.001), crs_wkt="EPSG:4326")
    with pytest.raises(ValueError, match="degrees"):
        sb.visibility_tolerance(degrees, [(11.005, 46.995)], 5.0)
