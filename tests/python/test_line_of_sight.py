# SPDX-License-Identifier: GPL-3.0-or-later
"""line_of_sight: the judged places are the definition's, and where the line is decided is where the least of them is."""
import numpy as np
import pytest
import sightbound as sb
import terrains
from judge_lines import lines_between
from sight_oracle import Errors, Oracle

UTM, UTM_GT = "EPSG:32633", (612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0)
EARTHS = {"plane": ((500.0, 10.0, 0.0, 900.0, 0.0, -10.0), None, 60.0), "UTM": (UTM_GT, UTM, 60.0),
          "degrees": ((10.0, 1e-3, 0.0, 66.0, 0.0, -1e-3), "EPSG:4326", 400.0), "south-up": ((612340.0, 10.0, 0.0, 5538120.0, 0.0, 10.0), UTM, 60.0)}


@pytest.mark.parametrize("earth", EARTHS)
@pytest.mark.parametrize("stand", ["model", "ground"])
def test_profile(earth, stand):
    gt, crs, relief = EARTHS[earth]
    z = terrains.fractal((30, 34), 191, relief)
    oracle = Oracle(z, gt, crs, Errors(0.4, 0.3, 2.0, 6.0))
    dem = sb.Dem(z, gt, None if crs is None else oracle.frame.crs.to_wkt())
    model = sb.ErrorModel(0.4, 0.3, 2.0, 6.0)
    for a, b in lines_between(oracle, 12, seed=192):
        line = sb.line_of_sight(dem, a, b, observer_height=3.0, target_height=2.0, error_model=model, stand=stand)
        sight = oracle.sight(a, b, 3.0, 2.0, stand=stand)
        profile, places = line.profile, sight.places
        assert set(profile) == {"distance", "x", "y", "ground", "sigma", "line", "clearance"}
        assert len(profile["distance"]) == len(places["s"]) and np.all(np.diff(profile["distance"]) >= 0)
        cell = oracle.cell
        np.testing.assert_allclose(profile["distance"], places["s"], atol=1e-4 * cell)
        np.testing.assert_allclose(profile["ground"], places["terrain"], atol=1e-3)
        np.testing.assert_allclose(profile["line"], places["line"], atol=1e-3)
        np.testing.assert_allclose(profile["sigma"], places["sigma"], atol=1e-3)
        col, row = oracle.frame.colrow(profile["x"], profile["y"])
        np.testing.assert_allclose(col, places["col"], atol=1e-4)
        np.testing.assert_allclose(row, places["row"], atol=1e-4)
        np.testing.assert_allclose(profile["clearance"], (profile["line"] - profile["ground"]) / profile["sigma"], rtol=1e-9)
        least = int(np.argmin(profile["clearance"]))
        if abs(sight.k) < 3.2:
            assert line.k == pytest.approx(sight.k, rel=2e-3, abs=2e-3) and line.k == pytest.approx(profile["clearance"][least], abs=1e-6)
        assert line.critical_distance == pytest.approx(profile["distance"][least])
        assert line.critical == pytest.approx((profile["x"][least], profile["y"][least]))
        assert line.required_height == pytest.approx(sight.needed_height(1.959964), abs=0.1)
        assert line.distance == pytest.approx(sight.distance, rel=1e-7) and line.azimuth == pytest.approx(sight.azimuth, abs=1e-3)


def test_to_oneself():
    dem = sb.Dem(terrains.fractal((30, 34), 193), UTM_GT, Oracle(np.zeros((2, 2)), UTM_GT, UTM).frame.crs.to_wkt())
    line = sb.line_of_sight(dem, (612445.0, 5537995.0), (612445.0, 5537995.0), error_model=sb.ErrorModel(1.0, 0, 0))
    assert line.p == 1 and line.verdict == 2 and line.distance == 0 and len(line.profile["distance"]) == 0


def test_across_a_hole():
    z = terrains.fractal((30, 34), 194)
    z[:, 15:17] = np.nan
    dem, model = sb.Dem(z, (0, 10, 0, 300, 0, -10)), sb.ErrorModel(1.0, 0, 0)
    how = dict(observer_height=90.0, target_height=90.0, error_model=model)
    line = sb.line_of_sight(dem, (55, 155), (285, 145), **how)
    assert line.p == 0.5 and line.verdict == 1 and line.k == 0 and not np.isfinite(line.required_height)
    assert np.isnan(line.profile["ground"]).any()
    assert sb.line_of_sight(dem, (55, 155), (285, 145), see_across_nodata=True, **how).verdict == 2


def test_many_are_one_by_one():
    dem, model = sb.Dem(terrains.fractal((60, 60), 195, 80.0), (0, 10, 0, 600, 0, -10)), sb.ErrorModel(0.5, 0, 0)
    rng = np.random.default_rng(196)
    eyes, targets = rng.uniform(10, 590, (2, 20, 2))
    heights = list(rng.uniform(1, 20, 20))
    many = sb.lines_of_sight(dem, eyes, targets, observer_height=heights, error_model=model)
    for line, eye, target, height in zip(many, eyes, targets, heights):
        one = sb.line_of_sight(dem, tuple(eye), tuple(target), observer_height=height, error_model=model)
        assert (line.p, line.k, line.verdict, line.distance) == (one.p, one.k, one.verdict, one.distance)


def test_report():
    dem = sb.Dem(np.full((5, 9), 100.0, np.float32), (0, 10, 0, 50, 0, -10))
    line = sb.line_of_sight(dem, (5, 25), (85, 25), observer_height=2.0, target_height=3.0, error_model=sb.ErrorModel(1.0, 0, 0))
    report = line.report
    assert (report["observer_ground"], report["eye_height"], report["target_ground"], report["target_top"]) == (100, 102, 100, 103)
    assert line.azimuth == pytest.approx(90) and line.distance == pytest.approx(80) and "vertical_rmse" in report["error_model"]
