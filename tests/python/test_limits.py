# SPDX-License-Identifier: GPL-3.0-or-later
"""Distance, azimuth and vertical angle: a cell is asked exactly when the definition says so, and limits change no answer."""
import numpy as np
import pytest
import sightbound as sb
import terrains
from sight_oracle import Errors, Oracle, asked

SHAPE = (26, 30)
EARTHS = {"plane": ((500.0, 10.0, 0.0, 900.0, 0.0, -10.0), None), "UTM": ((312340.0, 10.0, 0.0, 6838120.0, 0.0, -10.0), "EPSG:32633"),
          "degrees": ((10.0, 1e-3, 0.0, 66.0, 0.0, -5e-4), "EPSG:4326"), "polar": ((-1.9e5, 50.0, 0.0, -1.1e6, 0.0, -50.0), "EPSG:3413"),
          "south-up": ((312340.0, 10.0, 0.0, 6838120.0, 0.0, 10.0), "EPSG:32633")}
LIMITS = [dict(max_distance=4.4), dict(min_distance=3.3), dict(min_distance=2.0, max_distance=9.7), dict(azimuth=(30, 100)),
          dict(azimuth=(350, 10)), dict(azimuth=(200, 560)), dict(azimuth=(-90, 90)), dict(azimuth=(170, 170.5)), dict(azimuth=(90, 30)),
          dict(vertical_angle=(-5, 3)), dict(vertical_angle=(-90, -2)), dict(vertical_angle=(0, 90)),
          dict(min_distance=2.0, max_distance=12.0, azimuth=(300, 80), vertical_angle=(-20, 20))]
MARGIN = 1e-6   # a cell this near (relative) to a limit may fall either way


def build(earth, relief=40.0):
    gt, crs = EARTHS[earth]
    z = terrains.fractal(SHAPE, 131, relief)
    oracle = Oracle(z, gt, crs, Errors(0.5))
    return z, oracle, sb.Dem(z, gt, None if crs is None else oracle.frame.crs.to_wkt())


@pytest.mark.parametrize("limits", LIMITS, ids=str)
@pytest.mark.parametrize("earth", EARTHS)
def test_exactly_the_cells_within(earth, limits):
    z, oracle, dem = build(earth)
    xy = tuple(float(v) for v in oracle.frame.xy(13.3, 11.8))
    limits = {k: v * oracle.cell if "distance" in k else v for k, v in limits.items()}
    model = sb.ErrorModel(vertical_rmse=0.5, geologic_variation=0)
    free = sb.viewshed(dem, [xy], observer_height=5.0, error_model=model)
    part = sb.viewshed(dem, [xy], observer_height=5.0, error_model=model, **limits)
    offset_col, offset_row = (int(round(float(v) + 0.5)) for v in oracle.frame.colrow(part.geotransform[0], part.geotransform[3]))
    for row, col in np.ndindex(SHAPE):
        r, c = row - offset_row, col - offset_col
        inside = 0 <= r < part.shape[0] and 0 <= c < part.shape[1]
        sight = ends_only(oracle, xy, row, col)
        wanted = asked(sight, **limits)
        if asked(sight, **widened(limits, 1)) != asked(sight, **widened(limits, -1)):
            continue
        assert wanted == (inside and not np.isnan(part.confidence[r, c])), f"cell {row, col}: {sight.distance} m, {sight.azimuth}, {sight.angle}"
        if wanted:
            assert part.verdict[r, c] == free.verdict[row, col] and part.confidence[r, c] == pytest.approx(free.confidence[row, col], abs=1e-5)
        elif inside:
            assert part.verdict[r, c] == 255 and part.count[r, c] == 4294967295


class Ends:
    pass


def ends_only(oracle, xy, row, col):
    """Distance, azimuth and angle of the line, without its judged places."""
    ends, target = Ends(), tuple(float(v) for v in oracle.frame.xy(col, row))
    ends.distance, ends.azimuth = oracle.frame.inverse_geodesic(xy, target)
    if ends.distance:
        radius = oracle.frame.euler_radius(xy, ends.azimuth, ends.distance)
        eye = oracle.at(oracle.z, *oracle.frame.colrow(*xy)) + 5.0
        ends.angle = np.degrees(np.arctan2(oracle.z[row, col] - 0.87 * ends.distance ** 2 / (2 * radius) - eye, ends.distance))
    return ends


def widened(limits, by):
    """The limits, wider or narrower by the margin."""
    wide = dict(limits)
    if "min_distance" in wide:
        wide["min_distance"] *= 1 - by * MARGIN
    if "max_distance" in wide:
        wide["max_distance"] *= 1 + by * MARGIN
    for name in ("azimuth", "vertical_angle"):
        if name in wide:
            wide[name] = (wide[name][0] - by * 1e-4, wide[name][1] + by * 1e-4)
    return wide


def test_limits_are_inclusive():
    dem = sb.Dem(np.zeros((3, 9), np.float32), (0, 10, 0, 30, 0, -10))
    model = sb.ErrorModel(0.1, 0, 0)
    seen = ~np.isnan(sb.viewshed(dem, [(5, 15)], min_distance=20, max_distance=50, error_model=model).confidence[1])
    assert seen.tolist()[:6] == [False, False, True, True, True, True] and not any(seen[6:])
    assert not np.isnan(sb.viewshed(dem, [(5, 15)], azimuth=(90, 90), error_model=model).confidence[1, 1:]).any()


def test_each_observer_has_its_own_limits():
    z, oracle, dem = build("UTM")
    eyes = [tuple(float(v) for v in oracle.frame.xy(*p)) for p in ((5, 5), (22, 18))]
    each = dict(observer_height=[3.0, 12.0], target_height=[0.0, 2.0], min_distance=[0.0, 30.0], max_distance=[80.0, 110.0],
                azimuth=[(0, 360), (180, 20)], vertical_angle=[(-90, 90), (-30, 10)])
    model = sb.ErrorModel(0.5, 0, 0)
    both = sb.viewshed(dem, eyes, error_model=model, **each)
    one_by_one = list(sb.viewsheds(dem, eyes, error_model=model, **each))
    assert len(one_by_one) == 2
    best = np.full(SHAPE, -1.0)
    for i, result in enumerate(one_by_one):
        single = sb.viewshed(dem, [eyes[i]], error_model=model, **{k: v[i] for k, v in each.items()})
        assert result.confidence.tobytes() == single.confidence.tobytes() and result.geotransform == single.geotransform
        col, row = (int(round(float(v) + 0.5)) for v in oracle.frame.colrow(result.geotransform[0], result.geotransform[3]))
        window = best[row:row + result.shape[0], col:col + result.shape[1]]
        np.fmax(window, result.confidence, out=window)
    col, row = (int(round(float(v) + 0.5)) for v in oracle.frame.colrow(both.geotransform[0], both.geotransform[3]))
    best = best[row:row + both.shape[0], col:col + both.shape[1]]
    assert np.array_equal(np.where(best < 0, np.nan, best).astype(np.float32), both.confidence, equal_nan=True)


def test_the_window_is_the_reach():
    dem = sb.Dem(np.zeros((101, 121), np.float32), (0, 10, 0, 1010, 0, -10))
    result = sb.viewshed(dem, [(605, 505)], max_distance=100, error_model=sb.ErrorModel(0, 0, 0))
    assert all(21 <= side <= 1.1 * 21 + 8 for side in result.shape)     # the reach, a tenth and a few cells to be sure
    asked_cols = np.flatnonzero(~np.isnan(result.confidence).all(axis=0))
    assert result.geotransform[0] + 10 * asked_cols[0] == 500 and asked_cols.size == 21
