# SPDX-License-Identifier: GPL-3.0-or-later
"""intervisibility: each pair once, the same as line_of_sight() says, and points that cannot be judged are told, not refused."""

import numpy as np
import pytest

import sightbound as sb
import terrains
from sight_oracle import Oracle

UTM_GT = (612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0)
SIDE = 60
MODEL = sb.ErrorModel(0.5, 0, 1.0, 5.0)


def dem(z=None):
    z = terrains.fractal((SIDE, SIDE), 401, 60.0) if z is None else z
    return sb.Dem(z, UTM_GT, Oracle(np.zeros((2, 2)), UTM_GT, "EPSG:32633").frame.crs.to_wkt())


def points(count, seed):
    inside = np.random.default_rng(seed).uniform(15, 10 * SIDE - 15, (count, 2))
    return np.array([UTM_GT[0], UTM_GT[3]]) + inside * (1, -1)


def test_each_two_once_as_line_of_sight_says():
    where, heights = points(9, 402), np.linspace(1, 30, 9)
    network = sb.intervisibility(dem(), where, height_a=heights, error_model=MODEL, probability=True, realisations=100, frequency=900)
    assert list(zip(network["a"], network["b"])) == [(a, b) for a in range(9) for b in range(a + 1, 9)] and len(network) == 36
    assert len(set(network["verdict"])) > 1
    for i, (a, b) in enumerate(zip(network["a"], network["b"])):
        line = sb.line_of_sight(dem(), tuple(where[a]), tuple(where[b]), heights[a], heights[b], MODEL, probability=True, realisations=100, frequency=900)
        assert network["status"][i] == "ok" and network["verdict"][i] == line.verdict
        for name in ("p", "k", "distance", "azimuth", "critical_distance", "critical_clearance", "probability"):
            assert network[name][i] == pytest.approx(getattr(line, name), abs=1e-4), name
        assert (network["critical_x"][i], network["critical_y"][i]) == pytest.approx(line.critical)
        whole, zone = line.whole_line, line.fresnel
        assert network["standard_error"][i] == pytest.approx(whole.standard_error) and network["blocked_bound"][i] == pytest.approx(whole.blocked_bound, abs=1e-4)
        assert network["fresnel_probability"][i] == whole.fresnel_probability
        assert (network["fresnel_clear"][i], network["fresnel_p"][i], network["fresnel_distance"][i]) == pytest.approx((zone.clear, zone.p, zone.worst_distance), abs=1e-4)


def test_two_lists_and_the_way_back():
    a, b = points(5, 411), points(7, 412)
    there = sb.intervisibility(dem(), a, b, 10, 3, error_model=MODEL)
    back = sb.intervisibility(dem(), b, a, 3, 10, error_model=MODEL)
    assert len(there) == len(back) == 35 and there.matrix().shape == (5, 7)
    assert np.array_equal(there.matrix(), back.matrix().T)
    np.testing.assert_allclose(there.matrix("p"), back.matrix("p").T, atol=1e-5)
    assert np.isnan(there["probability"]).all() and np.isnan(there["fresnel_clear"]).all()
    within = sb.intervisibility(dem(), a, height_a=10, error_model=MODEL).matrix("distance")
    assert np.array_equal(within, within.T, equal_nan=True) and np.isnan(np.diag(within)).all()


def test_any_number_of_threads():
    where = points(40, 421)
    how = dict(height_a=8, error_model=MODEL, probability=True, realisations=48, frequency=2400)
    one, two = (sb.intervisibility(dem(), where, threads=threads, **how).columns for threads in (1, 2))
    for name in one:
        np.testing.assert_array_equal(one[name], two[name])


def test_only_so_far():
    where = points(30, 431)
    every, near = (sb.intervisibility(dem(), where, error_model=MODEL, max_distance=reach) for reach in (None, 150.0))
    kept = every["distance"] <= 150
    assert 0 < kept.sum() == len(near) and near.report["too_far"] == len(every) - len(near)
    for name in ("a", "b", "p", "distance"):
        np.testing.assert_array_equal(near[name], every[name][kept])
    assert len(sb.intervisibility(dem(), where, error_model=MODEL, max_distance=1e-3)) == 0


def test_points_that_cannot_be_judged():
    z = terrains.fractal((SIDE, SIDE), 441, 60.0)
    z[20:30, 20:30] = np.nan
    middle = (UTM_GT[0] + 255, UTM_GT[3] - 255)
    where = [*map(tuple, points(2, 443)), middle, (0.0, 0.0), tuple(points(2, 443)[0])]
    network = sb.intervisibility(dem(z), where, height_a=60, error_model=MODEL, probability=True, realisations=16)
    told = {(a, b): status for a, b, status in zip(network["a"], network["b"], network["status"])}
    assert told == {(0, 1): "ok", (0, 2): "nodata", (0, 3): "outside", (1, 2): "nodata", (1, 3): "outside", (1, 4): "ok", (2, 3): "outside", (2, 4): "nodata", (3, 4): "outside"}
    for i, status in enumerate(network["status"]):
        assert (network["verdict"][i] == 255) == np.isnan(network["p"][i]) == (status != "ok")
    nowhere = sb.intervisibility(dem(z), [(0.0, 0.0), (1.0, 1.0)], error_model=MODEL)
    assert nowhere["status"] == ["outside"]
    near = sb.intervisibility(dem(z), where, height_a=60, error_model=MODEL, max_distance=1e4)
    assert near["status"] == network["status"]


def test_feet_and_degrees():
    z = terrains.fractal((SIDE, SIDE), 451, 60.0)
    gt, place = (10.0, 1e-3, 0.0, 46.0, 0.0, -1e-3), [(10.01, 45.99), (10.05, 45.95), (10.03, 45.945)]
    wkt = Oracle(np.zeros((2, 2)), gt, "EPSG:4326").frame.crs.to_wkt()
    metres = sb.intervisibility(sb.Dem(z, gt, wkt), place, height_a=30, error_model=MODEL)
    feet = sb.intervisibility(sb.Dem(z / np.float32(0.3048), gt, wkt, vertical_unit="foot"), place, height_a=30, error_model=MODEL)
    assert 3000 < metres["distance"][0] < 6000
    np.testing.assert_allclose(metres["k"], feet["k"], atol=1e-2)


def test_it_can_be_cancelled():
    with pytest.raises(sb.Cancelled):
        sb.intervisibility(dem(), points(50, 461), error_model=MODEL, progress=lambda fraction: False)


@pytest.mark.parametrize("arguments, message", [
    ({"points_a": []}, "points_a is empty"),
    ({"points_b": []}, "points_b is empty"),
    ({"points_a": (1.0, 2.0)}, "points_a"),
    ({"height_a": [1, 2, 3, 4]}, "height_a has 4 values"),
    ({"height_b": 3}, "height_b is given without points_b"),
    ({"max_distance": 0}, "max_distance is 0"),
    ({"frequency": 0}, "frequency is 0"),
    ({"probability": True, "realisations": 0}, "realisations is 0"),
    ({"threads": 0}, "threads"),
    ({"memory_budget": 1000}, "memory"),
])
def test_wrong_arguments_are_named(arguments, message):
    with pytest.raises((ValueError, MemoryError), match=message):
        sb.intervisibility(**{"dem": dem(), "points_a": points(3, 471), "error_model": MODEL, **arguments})
