# SPDX-License-Identifier: GPL-3.0-or-later
"""What a cell needs to be judged, and what its answer must not depend on."""
import numpy as np
import pytest
import sightbound as sb
from osgeo import osr

GEOTRANSFORM = (500000, 10, 0, 5000000, 0, -10)
OBSERVER = [(500605, 4999395)]
MODEL = sb.ErrorModel(vertical_rmse=0.5, geologic_variation=0.0)


def rough(size=120, seed=3):
    rng = np.random.default_rng(seed)
    z = np.cumsum(rng.normal(0, 2, (size, size)), 0) + np.cumsum(rng.normal(0, 2, (size, size)), 1)
    return (z - z.min()).astype("f4")


def wkt(code, version):
    srs = osr.SpatialReference()
    srs.ImportFromEPSG(code)
    return srs.ExportToWkt([f"FORMAT={version}"])


def test_lowest_visible_heights_do_not_depend_on_the_target_height():
    dem = sb.Dem(rough(), GEOTRANSFORM)
    low, high = (sb.viewshed(dem, OBSERVER, target_height=h, heights=True, error_model=MODEL) for h in (0, 200))
    assert (np.nan_to_num(low.lowest_visible_height) > 1).any()
    np.testing.assert_allclose(low.lowest_visible_height, high.lowest_visible_height, atol=1e-3)
    np.testing.assert_allclose(low.likely_visible_height, high.likely_visible_height, atol=1e-3)


@pytest.mark.parametrize("case", ["absolute heights", "ground raster"])
def test_a_hole_stays_nodata_whatever_the_target_stands_on(case):
    whole, holed = rough(), rough()
    holed[10:20, 10:20] = np.nan
    how = {"height_reference": "absolute", "observer_height": float(whole.max()) + 5, "target_height": 10.0}
    if case == "ground raster":
        how = {"ground": sb.Dem(whole, GEOTRANSFORM)}
    result = sb.viewshed(sb.Dem(holed, GEOTRANSFORM), OBSERVER, error_model=MODEL, **how)
    assert (result.verdict[10:20, 10:20] == 255).all()
    assert np.isnan(result.confidence[10:20, 10:20]).all()
    assert (result.verdict != 255).sum() == 120 * 120 - 100


def test_one_observer_twice_sees_the_same_area_on_a_sheared_raster():
    dem = sb.Dem(rough(), (500000, 10, 5, 5000000, 0, -10))
    once, twice = (sb.viewshed(dem, [(500905, 4999395)] * n, error_model=MODEL).report for n in (1, 2))
    for name in ("visible_m2", "uncertain_m2", "hidden_m2"):
        assert twice[name] == pytest.approx(once[name])


def test_the_cell_one_stands_on_has_no_direction():
    result = sb.viewshed(sb.Dem(rough(), GEOTRANSFORM), OBSERVER, azimuth=(90, 180), vertical_angle=(-5, 5), error_model=MODEL)
    assert result.verdict[60, 60] == 2


def test_a_ground_raster_may_word_its_crs_differently_and_be_finer():
    z = rough()
    dem = sb.Dem(z, GEOTRANSFORM, crs_wkt=wkt(32633, "WKT1_GDAL"))
    fine = sb.Dem(np.repeat(np.repeat(z, 2, 0), 2, 1), (500000, 5, 0, 5000000, 0, -5), crs_wkt=wkt(32633, "WKT2_2019"))
    result = sb.viewshed(dem, OBSERVER, ground=fine, error_model=MODEL)
    assert (result.verdict != 255).all()
    with pytest.raises(ValueError, match="another coordinate system"):
        other = sb.Dem(z, GEOTRANSFORM, crs_wkt=wkt(32632, "WKT2_2019"))
        sb.viewshed(dem, OBSERVER, ground=other, error_model=MODEL)
