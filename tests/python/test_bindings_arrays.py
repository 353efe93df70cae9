# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays across the boundary: borrowed where the layout allows, kept alive, never in the wrong row order."""
import gc
import sys
import threading
import weakref

import numpy as np
import pytest
import sightbound as sb

NORTH_UP = (500.0, 10.0, 0.0, 900.0, 0.0, -10.0)
SOUTH_UP = (500.0, 10.0, 0.0, 600.0, 0.0, 10.0)
EYE = [(655.0, 755.0)]
EXACT = sb.ErrorModel(0.5, 0, 0)


def slope(rows=30, cols=40):
    """Heights that differ in every cell."""
    return (np.arange(rows * cols, dtype=np.float32).reshape(rows, cols) * 0.01).astype(np.float32)


class Memory(bytearray):
    """The memory of an array, whose end can be watched."""


def watched(values):
    memory = Memory(values.tobytes())
    return np.frombuffer(memory, values.dtype).reshape(values.shape), weakref.ref(memory)


def test_float32_is_borrowed():
    z = slope()
    dem = sb.Dem(z, NORTH_UP)
    z[3, 5] = 77.0
    assert dem.heights[3, 5] == 77.0
    assert not np.shares_memory(dem.heights, z)


@pytest.mark.parametrize("z", [slope().astype(float), np.asfortranarray(slope()), slope().astype(">f4"), slope()[:, ::-1][:, ::-1][::1, ::1],
                               slope(60, 80)[::2, ::2], slope().tolist()], ids=["float64", "fortran", "big-endian", "reversed twice", "strided", "list"])
def test_any_layout_gives_the_same_heights(z):
    assert np.array_equal(sb.Dem(z, NORTH_UP).heights, np.asarray(z, np.float32))


@pytest.mark.parametrize("dtype", [np.int16, np.uint8, np.int32, np.float16, np.float64])
def test_any_real_type(dtype):
    z = np.arange(12).reshape(3, 4).astype(dtype)
    assert np.array_equal(sb.Dem(z, NORTH_UP).heights, z.astype(np.float32))


def test_masked_infinite_and_nodata_are_holes():
    z = np.ma.masked_array(slope(3, 4), mask=np.eye(3, 4, dtype=bool))
    assert np.array_equal(np.isnan(sb.Dem(z, NORTH_UP).heights), z.mask)
    z = slope(3, 4)
    z[1, 2], z[0, 1], z[2, 3] = np.inf, np.nan, -9999
    assert np.isnan(sb.Dem(z, NORTH_UP, nodata=-9999).heights).sum() == 3


def test_the_array_outlives_its_name():
    z, alive = watched(slope())
    dem = sb.Dem(z, NORTH_UP)
    del z
    gc.collect()
    assert alive() is not None and dem.heights[0, 1] == np.float32(0.01)
    del dem
    gc.collect()
    assert alive() is None


def test_the_last_hold_on_an_array_may_be_dropped_by_another_thread():
    z, alive = watched(slope())
    held = [sb.Dem(z, NORTH_UP)]
    del z
    thread = threading.Thread(target=held.clear)
    thread.start()
    thread.join()
    gc.collect()
    assert alive() is None


def test_results_share_the_core_memory():
    result = sb.viewshed(sb.Dem(slope(), NORTH_UP), EYE, error_model=EXACT, heights=True)
    for name in ("confidence", "verdict", "count", "lowest_visible_height", "likely_visible_height"):
        one, again = getattr(result, name), getattr(result, name)
        assert np.shares_memory(one, again) and one.shape == result.shape and one.flags.c_contiguous
        assert not one.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            one[0, 0] = 1


def test_an_array_outlives_its_result():
    confidence = sb.viewshed(sb.Dem(slope(), NORTH_UP), EYE, error_model=EXACT).confidence
    kept = confidence.copy()
    gc.collect()
    np.full((200, 200), 7.0)
    assert np.array_equal(confidence, kept, equal_nan=True)


def test_profile_arrays_outlive_their_line():
    profile = sb.line_of_sight(sb.Dem(slope(), NORTH_UP), EYE[0], (855.0, 805.0), error_model=EXACT).profile
    gc.collect()
    assert {len(values) for values in profile.values()} == {len(profile["distance"])}
    assert np.all(np.diff(profile["distance"]) >= 0) and not profile["ground"].flags.writeable


def test_count_of_a_single_observer():
    z = slope()
    z[4, 4] = np.nan
    result = sb.viewshed(sb.Dem(z, NORTH_UP), EYE, error_model=EXACT, max_distance=120)
    expected = np.where(result.verdict == 255, 4294967295, result.verdict == 2)
    assert result.count.dtype == np.uint32 and np.array_equal(result.count, expected)


def test_heights_are_none_unless_asked():
    result = sb.viewshed(sb.Dem(slope(), NORTH_UP), EYE, error_model=EXACT)
    assert result.lowest_visible_height is None and result.likely_visible_height is None


def test_an_error_array_lies_in_the_users_row_order():
    """The same ground given twice, once from the south up: the errors of the upper half stay in the upper half."""
    z = np.zeros((30, 40), np.float32)
    errors = np.full(z.shape, 0.25, np.float32)
    errors[:10] = 2.0
    north = sb.error_surfaces(sb.Dem(z, NORTH_UP), sb.ErrorModel(errors, 0, 0)).sigma
    south = sb.error_surfaces(sb.Dem(z, SOUTH_UP), sb.ErrorModel(errors[::-1], 0, 0)).sigma
    assert np.allclose(north[:9], 2.0) and np.allclose(north[11:], 0.25)
    assert np.array_equal(north, south[::-1])


def test_an_error_array_and_the_number_it_holds_agree():
    dem = sb.Dem(slope() * 3, NORTH_UP)
    array = sb.ErrorModel(np.full(dem.shape, 0.7), 0, np.full(dem.shape, 1.5), geologic_range=4)
    number = sb.ErrorModel(0.7, 0, 1.5, geologic_range=4)
    one, other = (sb.viewshed(dem, EYE, error_model=model).confidence for model in (array, number))
    assert np.array_equal(one, other, equal_nan=True)


def test_an_error_array_must_fit_the_dem():
    model = sb.ErrorModel(np.ones((3, 3)), 0, 0)
    with pytest.raises(ValueError, match=r"vertical_rmse has shape \(3, 3\), the DEM has \(30, 40\)"):
        sb.viewshed(sb.Dem(slope(), NORTH_UP), EYE, error_model=model)
    with pytest.raises(ValueError, match=r"geologic_variation has shape \(3,\)"):
        sb.ErrorModel(1, 0, np.ones(3))


def test_a_model_with_an_array_is_no_json():
    model = sb.ErrorModel(np.ones((3, 3)), 0, 0)
    assert model.vertical_rmse.shape == (3, 3) and "array" in repr(model)
    with pytest.raises(ValueError, match="vertical_rmse is an array"):
        model.to_json()


def test_accuracy_of_an_array():
    model = sb.ErrorModel.from_accuracy(le90=np.full((3, 3), 1.6448536))
    assert np.allclose(model.vertical_rmse, 1.0)


def test_an_estimate_leaves_arrays_alone():
    dem = sb.Dem(slope(), NORTH_UP)
    errors = np.full(dem.shape, 0.7, np.float32)
    model = sb.estimate_error(dem, sb.ErrorModel(errors))
    assert model.vertical_rmse is errors or np.array_equal(model.vertical_rmse, errors)
    assert {"growth_exponent", "typical_sigma", "rounding", "warnings"} <= set(model.report)


def test_observers_as_an_array():
    dem = sb.Dem(slope(), NORTH_UP)
    places = np.array([[655, 755], [605, 705]])
    one = sb.viewshed(dem, places, observer_height=np.array([2, 3], np.float32), error_model=EXACT)
    other = sb.viewshed(dem, [(655.0, 755.0), (605.0, 705.0)], observer_height=[2.0, 3.0], error_model=EXACT)
    assert np.array_equal(one.confidence, other.confidence, equal_nan=True) and one.count.max() <= 2


@pytest.mark.parametrize("azimuth", [(10, 80), [10, 80], np.array([10, 80]), [(10, 80)], np.array([[10.0, 80.0]])], ids=str)
def test_a_range_is_one_pair_or_one_for_each(azimuth):
    dem = sb.Dem(slope(), NORTH_UP)
    asked = sb.viewshed(dem, EYE, azimuth=azimuth, error_model=EXACT).verdict != 255
    assert np.array_equal(asked, sb.viewshed(dem, EYE, azimuth=(10, 80), error_model=EXACT).verdict != 255)


def test_no_limit_among_limits():
    dem = sb.Dem(slope(), NORTH_UP)
    result = sb.viewshed(dem, EYE * 2, max_distance=[None, 50], error_model=EXACT)
    assert result.shape == dem.shape and np.isfinite(result.confidence).all()


def test_geotransforms_are_tuples():
    dem = sb.Dem(slope(), SOUTH_UP)
    result = sb.viewshed(dem, EYE, error_model=EXACT)
    assert dem.geotransform == result.geotransform == sb.error_surfaces(dem, EXACT).geotransform == SOUTH_UP


def test_references_are_not_lost():
    """A job takes and returns what it holds: the counts of what it was given do not grow."""
    dem, model = sb.Dem(slope(), NORTH_UP), sb.ErrorModel(np.ones((30, 40), np.float32), 0, 0)

    def progress(fraction):
        return None

    def held():
        gc.collect()
        return sys.getrefcount(dem), sys.getrefcount(model), sys.getrefcount(progress), sys.getrefcount(model.vertical_rmse)

    before = held()
    for _ in range(5):
        sb.viewshed(dem, EYE, error_model=model, progress=progress)
        sb.error_surfaces(dem, model, progress=progress)
    assert held() == before
