# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes with answers in closed form: plane, ridge, cone, step, sphere."""
import math

import numpy as np
import pytest
import sightbound as sb

CELL = 10.0
NOTHING = dict(vertical_rmse=0, geologic_variation=0)


def scene(z, sigma=0.0):
    z = np.float32(z)
    return sb.Dem(z, (0, CELL, 0, CELL * z.shape[0], 0, -CELL)), sb.ErrorModel(vertical_rmse=sigma, geologic_variation=0)


def centre(z, col, row):
    return CELL * (col + 0.5), CELL * (len(z) - row - 0.5)


def look(z, col, row, sigma=0.0, **how):
    dem, model = scene(z, sigma)
    return sb.viewshed(dem, [centre(z, col, row)], error_model=model, **{"curvature": False, **how})


def test_plane_is_seen_whole():
    rows, cols = np.indices((60, 80))
    for slope in ((0, 0), (0.3, 0), (-0.2, 0.4)):
        result = look(500 + CELL * (slope[0] * cols + slope[1] * rows), 31, 27, observer_height=20, heights=True)
        assert np.all(result.verdict == 2) and np.all(result.confidence == 1)
        assert np.all(result.likely_visible_height == 0)


def test_confidence_over_a_plane():
    """The line to a ground target is nowhere nearer the plane than right before the target's end zone, where sigma counts
    last: s = D - 1.5 cells (the last sample at least so far away): k = h (D - s) / D / sigma."""
    z = np.zeros((3, 40))
    result = look(z, 0, 1, sigma=0.5, observer_height=10)
    for col in range(4, 40):
        k = 10 * 2 / col / 0.5      # the last column at least 1.5 cells off is 2 cells before the target
        assert result.confidence[1, col] == pytest.approx(0.5 * (1 + math.erf(k / math.sqrt(2))) if k < 3.29 else 1, abs=1e-5)


def test_ridge_hides_by_similar_triangles():
    """Eye h at distance a from a ridge of height H: behind it, at distance b, visible is what is higher than
    H + (H - h) b / a."""
    h, top, a = 2.0, 30.0, 20
    z = np.zeros((3, 80))
    z[:, a] = top
    result = look(z, 0, 1, observer_height=h, heights=True)
    b = np.arange(2, 80 - a)
    expected = top + (top - h) * b / a
    assert result.likely_visible_height[1, a + 2:] == pytest.approx(expected, abs=0.1)
    assert np.all(result.verdict[1, :a + 1] == 2) and np.all(result.verdict[1, a + 1:] == 0)


@pytest.mark.parametrize("sigma", [0.5, 2.0])
def test_ridge_with_error(sigma):
    h, top, a = 2.0, 30.0, 20
    z = np.zeros((3, 80))
    z[:, a] = top
    result = look(z, 0, 1, sigma=sigma, observer_height=h, heights=True)
    b = np.arange(2, 80 - a)
    raised = top + 1.959964 * sigma
    assert result.lowest_visible_height[1, a + 2:] == pytest.approx(raised + (raised - h) * b / a, abs=0.1 + 1e-4 * raised)


def test_step_hides_the_foot_of_the_cliff():
    """Eye h above a cliff of height H, a cells behind its edge: below, the ground is seen again from a H / h behind the edge."""
    h, cliff, a = 4.0, 24.0, 5
    z = np.zeros((3, 80))
    z[:, :a + 1] = cliff
    verdict = look(z, 0, 1, observer_height=h).verdict[1]
    first = a + math.ceil(a * cliff / h)        # column 35, where the line just touches the edge: a grazing line is in doubt
    assert np.all(verdict[:a + 1] == 2) and np.all(verdict[a + 1:first] == 0) and verdict[first] == 1 and np.all(verdict[first + 1:] == 2)


def test_cone_seen_from_its_top_and_from_outside():
    rows, cols = np.indices((81, 81))
    radius = np.hypot(rows - 40, cols - 40)
    z = np.maximum(0, 40 - 2 * radius)
    assert np.all(look(z, 40, 40, observer_height=45.0).verdict == 2)
    # From column 0, 50 m up: the line over the top comes down at b = a H / (h - H) = 160 cells behind: all of it hidden.
    assert np.all(look(z, 0, 40, observer_height=50).verdict[40, 41:] == 0)
    # From 100 m: at 40 * 40 / 60 = 26.67 cells behind the top.
    verdict = look(z, 0, 40, observer_height=100).verdict[40]
    assert np.all(verdict[41 + 20:67] == 0) and np.all(verdict[67:] == 2)


def test_sphere():
    """On a dome of radius R, from an eye h above its top, the ground is seen to where the tangent touches: cos(angle) = R / (R + h)."""
    radius, h = 4000.0, 60.0
    rows, cols = np.indices((161, 161)) - 80
    distance = CELL * np.hypot(rows, cols)
    z = np.sqrt(radius ** 2 - distance ** 2)
    verdict = look(z, 80, 80, observer_height=h).verdict
    horizon = radius * math.sin(math.acos(radius / (radius + h)))
    assert np.all(verdict[distance < horizon - 8 * CELL] == 2)
    assert np.all(verdict[distance > horizon + 3 * CELL] == 0)


def test_sea_horizon():
    """The Earth itself as the sphere: on the open sea an eye of 20 m sees the water to sqrt(2 R h / (1 - k))."""
    z = np.zeros((5, 400))
    dem = sb.Dem(np.float32(z), (0, 100, 0, 500, 0, -100))
    for refraction in (0.0, 0.13):
        p = sb.viewshed(dem, [(50, 250)], observer_height=20, refraction=refraction, error_model=sb.ErrorModel(0, 0, 0)).confidence[2]
        horizon = math.sqrt(2 * 6371008.8 * 20 / (1 - refraction)) / 100
        assert abs(np.argmax(p < 0.5) - horizon) < 2 and p[int(horizon * 0.8)] == 1 and p[int(horizon * 1.1)] == 0


def test_areas_of_the_report():
    """On a plane of 60 x 80 cells of 100 m2, all seen."""
    report = look(np.zeros((60, 80)), 31, 27, observer_height=20).report
    assert report["visible_m2"] == pytest.approx(60 * 80 * 100) and report["hidden_m2"] == 0 and report["uncertain_m2"] == 0
    assert report["visible_share"] == 1 and report["observers"][0]["visible_m2"] == pytest.approx(60 * 80 * 100)
    assert report["observers"][0]["status"] == "ok" and any("CRS" in w for w in report["warnings"])
