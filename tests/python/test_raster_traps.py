# SPDX-License-Identifier: GPL-3.0-or-later
"""Files as people have them: each gives the right heights and the right viewshed, or an error that says what to do.

`ask` runs the whole way, from the file to the verdict, and compares with the same ground given as a plain array."""
import numpy as np
import pyproj
import pytest
import rasters
import sightbound as sb
import terrains

SHAPE = (24, 28)
UTM, UTM_GT = "EPSG:32633", (612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0)
Z = np.round(terrains.fractal(SHAPE, 151, 90.0)) + 5
FOOT, US_FOOT = 0.3048, 1200 / 3937


def wkt(crs):
    return None if crs is None else pyproj.CRS.from_user_input(crs).to_wkt()


def ask(path, heights, gt=UTM_GT, crs=UTM, notes=(), **how):
    """The file's heights, georeference and viewshed are those of the array; every note asked for is there."""
    dem, plain = sb.read_dem(path, **how), sb.Dem(np.float32(heights), gt, wkt(crs))
    assert dem.shape == plain.shape and dem.geotransform == pytest.approx(plain.geotransform, rel=1e-12)
    np.testing.assert_allclose(dem.heights, plain.heights, rtol=3e-7, atol=1e-6, equal_nan=True)
    row, col = next((r, c) for r in range(10, 14) for c in range(10, 14) if np.isfinite(heights[r, c]))
    eye = [(gt[0] + gt[1] * (col + 0.5) + gt[2] * (row + 0.5), gt[3] + gt[4] * (col + 0.5) + gt[5] * (row + 0.5))]
    options = dict(observer_height=4.0, error_model=sb.ErrorModel(vertical_rmse=1.0, geologic_variation=0))
    result, expected = sb.viewshed(dem, eye, **options), sb.viewshed(plain, eye, **options)
    np.testing.assert_allclose(result.confidence, expected.confidence, atol=1e-4, equal_nan=True)
    assert np.mean(result.verdict == expected.verdict) > 0.999
    assert np.array_equal(result.verdict == 255, np.isnan(heights))
    for note in notes:
        assert any(note in text for text in result.report["warnings"]), f"{note!r} is not in {result.report['warnings']}"
    return dem, result


def holed(value=np.nan, dtype=np.float32):
    stored = Z.astype(dtype)
    stored[3, 5:9] = stored[17, 20] = value
    true = Z.astype(np.float32)
    true[3, 5:9] = true[17, 20] = np.nan
    return stored, true


# ---- where it lies -----------------------------------------------------------------------------------------------------


def test_south_up(tmp_path):
    gt = (UTM_GT[0], 10.0, 0.0, UTM_GT[3] - 10.0 * SHAPE[0], 0.0, 10.0)
    _, result = ask(rasters.geotiff(tmp_path / "a.tif", Z[::-1], gt, UTM), Z[::-1], gt)
    north = sb.viewshed(sb.Dem(Z, UTM_GT, wkt(UTM)), [(612445.0, 5537995.0)], error_model=sb.ErrorModel(1.0, 0, 0))
    south = sb.viewshed(sb.read_dem(tmp_path / "a.tif"), [(612445.0, 5537995.0)], error_model=sb.ErrorModel(1.0, 0, 0))
    assert np.array_equal(north.verdict, south.verdict[::-1]) and np.array_equal(north.confidence, south.confidence[::-1])


@pytest.mark.parametrize("gt", [(612340.0, 8.66, 5.0, 5538120.0, 5.0, -8.66), (612340.0, 0.0, 10.0, 5538120.0, -10.0, 0.0),
                                (612340.0, -10.0, 0.0, 5538120.0, 0.0, -10.0), (612340.0, 6.0, 2.0, 5538120.0, 3.0, -9.0)],
                         ids=["turned", "quarter", "mirrored", "sheared"])
def test_rotated(tmp_path, gt):
    ask(rasters.geotiff(tmp_path / "a.tif", Z, gt, UTM), Z, gt)


def test_oblong_cells(tmp_path):
    gt = (612340.0, 5.0, 0.0, 5538120.0, 0.0, -20.0)
    ask(rasters.geotiff(tmp_path / "a.tif", Z, gt, UTM), Z, gt)


def test_no_crs(tmp_path):
    ask(rasters.geotiff(tmp_path / "a.tif", Z, UTM_GT), Z, crs=None, notes=["no CRS"])


def test_no_crs_but_degrees(tmp_path):
    path = rasters.geotiff(tmp_path / "a.tif", Z, (10.0, 0.001, 0, 46.0, 0, -0.001))
    with pytest.raises(ValueError, match="(?s)look like degrees.*Assign its CRS"):
        sb.read_dem(path)


def test_no_georeference(tmp_path):
    with pytest.raises(ValueError, match="(?i)georeference|geotransform"):
        sb.read_dem(rasters.geotiff(tmp_path / "a.tif", Z))


def test_metres_declared_as_degrees(tmp_path):
    """A valid but wrong CRS: eastings cannot be longitudes."""
    path = rasters.geotiff(tmp_path / "a.tif", Z, UTM_GT, "EPSG:4326")
    with pytest.raises(ValueError, match="(?i)CRS"):
        sb.viewshed(sb.read_dem(path), [(612445.0, 5537995.0)])


def test_degrees_declared_as_metres(tmp_path):
    """A valid but wrong CRS: cells of a millimetre."""
    path = rasters.geotiff(tmp_path / "a.tif", Z, (10.0, 0.001, 0, 46.0, 0, -0.001), UTM)
    with pytest.raises(ValueError, match="(?i)CRS|degrees"):
        sb.viewshed(sb.read_dem(path), [(10.0105, 45.9895)])


def test_unknown_crs(tmp_path):
    """What GDAL cannot name, but can be understood by its parameters."""
    crs = "+proj=tmerc +lat_0=10 +lon_0=12.3 +k=1 +x_0=600000 +y_0=0 +ellps=bessel +units=m"
    gt = (612340.0, 10.0, 0.0, 4438120.0, 0.0, -10.0)
    ask(rasters.geotiff(tmp_path / "a.tif", Z, gt, crs), Z, gt, crs)


def test_geographic_at_77_north(tmp_path):
    gt = (15.0, 1 / 600, 0.0, 77.5, 0.0, -1 / 3600)
    ask(rasters.geotiff(tmp_path / "a.tif", Z, gt, "EPSG:4326"), Z, gt, "EPSG:4326")


def test_compound_crs(tmp_path):
    _, result = ask(rasters.geotiff(tmp_path / "a.tif", Z, UTM_GT, "EPSG:32633+5773"), Z)
    assert "UTM zone 33N" in result.crs_wkt


# ---- units -------------------------------------------------------------------------------------------------------------

FEET_GT = (6.0e6, 33.0, 0.0, 2.1e6, 0.0, -33.0)


def test_feet_in_x_y_and_z(tmp_path):
    path = rasters.geotiff(tmp_path / "a.tif", Z, FEET_GT, "EPSG:2227+6360")
    ask(path, Z * US_FOOT, FEET_GT, "EPSG:2227", notes=["0.304800609"])


def test_feet_in_x_and_y_metres_in_z(tmp_path):
    path = rasters.geotiff(tmp_path / "a.tif", Z, FEET_GT, "EPSG:2227+5703")
    ask(path, Z, FEET_GT, "EPSG:2227")


def test_feet_in_x_and_y_nothing_said_of_z(tmp_path):
    path = rasters.geotiff(tmp_path / "a.tif", Z, FEET_GT, "EPSG:2227")
    ask(path, Z, FEET_GT, "EPSG:2227", notes=["heights are taken as metres"])
    ask(path, Z * US_FOOT, FEET_GT, "EPSG:2227", vertical_unit="us-foot")
    ask(path, Z * FOOT, FEET_GT, "EPSG:2227", vertical_unit="foot")


@pytest.mark.parametrize("unit, metres", [("ft", FOOT), ("US survey foot", US_FOOT), ("m", 1.0), ("cm", 0.01), ("metre", 1.0)])
def test_unit_of_the_band(tmp_path, unit, metres):
    ask(rasters.geotiff(tmp_path / "a.tif", Z, UTM_GT, UTM, unit=unit), Z * metres)


def test_unsigned_centimetres(tmp_path):
    stored = np.uint16(Z * 100)
    ask(rasters.geotiff(tmp_path / "a.tif", stored, UTM_GT, UTM, scale=0.01), Z)
    ask(rasters.geotiff(tmp_path / "b.tif", stored, UTM_GT, UTM, unit="cm"), Z)


def test_scale_and_offset(tmp_path):
    stored = np.int16((Z - 40) * 4)
    stored[3, 5] = -32768
    true = Z.astype(np.float32)
    true[3, 5] = np.nan
    ask(rasters.geotiff(tmp_path / "a.tif", stored, UTM_GT, UTM, nodata=-32768, scale=0.25, offset=40), true)


# ---- holes -------------------------------------------------------------------------------------------------------------


def test_positive_nodata(tmp_path):
    stored, true = holed(999)
    stored[5, 5] = true[5, 5] = 998
    ask(rasters.geotiff(tmp_path / "a.tif", stored, UTM_GT, UTM, nodata=999), true)


@pytest.mark.parametrize("nodata", [-3.4028234663852886e38, 3.4028234663852886e38, -3.4e38, 1e9, -32767.0, np.nan])
def test_huge_nodata(tmp_path, nodata):
    stored, true = holed(np.float32(nodata))
    ask(rasters.geotiff(tmp_path / "a.tif", stored, UTM_GT, UTM, nodata=nodata), true)


def test_nodata_that_float_rounds(tmp_path):
    stored, true = holed(np.float32(-9999.9))
    ask(rasters.geotiff(tmp_path / "a.tif", stored, UTM_GT, UTM, nodata=-9999.9), true)


def test_byte_with_negative_nodata(tmp_path):
    """The declared value cannot occur: nothing is nodata."""
    ask(rasters.geotiff(tmp_path / "a.tif", np.uint8(Z), UTM_GT, UTM, nodata=-9999), Z)


def test_int16_with_float_nodata(tmp_path):
    ask(rasters.geotiff(tmp_path / "a.tif", np.int16(Z), UTM_GT, UTM, nodata=-3.4e38), Z)


def test_nan_without_declaration(tmp_path):
    stored, true = holed(np.nan)
    ask(rasters.geotiff(tmp_path / "a.tif", stored, UTM_GT, UTM), true)


def test_infinity(tmp_path):
    stored, true = holed(-np.inf)
    ask(rasters.geotiff(tmp_path / "a.tif", stored, UTM_GT, UTM), true)


def test_no_nodata_declared(tmp_path):
    stored, _ = holed(-9999)
    ask(rasters.geotiff(tmp_path / "a.tif", stored, UTM_GT, UTM), stored, notes=["-9999"])


def test_sea_coded_zero(tmp_path):
    """The sea is a height, and seen; declared as nodata it is a hole."""
    sea = np.where(Z < 40, 0, Z).astype(np.float32)
    ask(rasters.geotiff(tmp_path / "a.tif", sea, UTM_GT, UTM), sea)
    ask(rasters.geotiff(tmp_path / "b.tif", sea, UTM_GT, UTM, nodata=0), np.where(sea == 0, np.nan, sea))


def test_spikes_beside_a_declared_nodata(tmp_path):
    stored, true = holed(-9999)
    stored[8, 21] = 1e9
    true[8, 21] = np.nan
    ask(rasters.geotiff(tmp_path / "a.tif", stored, UTM_GT, UTM, nodata=-9999), true, notes=["taken as holes"])


def test_mask_band(tmp_path):
    _, true = holed()
    ask(rasters.with_mask(tmp_path / "a.tif", Z, UTM_GT, UTM, np.isfinite(true)), true)


def test_all_holes(tmp_path):
    path = rasters.geotiff(tmp_path / "a.tif", np.full(SHAPE, -9999, np.float32), UTM_GT, UTM, nodata=-9999)
    with pytest.raises(ValueError, match="(?i)nodata"):
        sb.viewshed(sb.read_dem(path), [(612445.0, 5537995.0)], error_model=sb.ErrorModel(1.0, 0, 0))
    with pytest.raises(ValueError, match="(?i)nodata|no height|vertical_rmse"):
        sb.viewshed(sb.read_dem(path), [(612445.0, 5537995.0)])


# ---- formats -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("dtype", ["uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"])
def test_every_type(tmp_path, dtype):
    ask(rasters.geotiff(tmp_path / "a.tif", Z.astype(dtype), UTM_GT, UTM), Z)


@pytest.mark.parametrize("options", [["TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"], ["COMPRESS=DEFLATE", "PREDICTOR=3"], ["COMPRESS=ZSTD"],
                                     ["COMPRESS=LERC"], ["BIGTIFF=YES"], ["ENDIANNESS=BIG"]], ids=lambda o: o[0])
def test_every_layout(tmp_path, options):
    ask(rasters.geotiff(tmp_path / "a.tif", Z.astype(np.float32), UTM_GT, UTM, options=options), Z)


def test_another_band(tmp_path):
    path = rasters.geotiff(tmp_path / "a.tif", Z.astype(np.float32), UTM_GT, UTM, bands=3)
    ask(path, Z, band=3)
    assert np.all(sb.read_dem(path).heights == 0)


def test_ascii_grid(tmp_path):
    stored, true = holed(-9999)
    path = rasters.ascii_grid(tmp_path / "a.asc", stored + 0.25, UTM_GT[0], UTM_GT[3] - 10 * SHAPE[0], 10, nodata=-9998.75, prj=UTM)
    ask(path, true + np.float32(0.25))


def test_ascii_grid_of_whole_numbers(tmp_path):
    stored, true = holed(-9999)
    ask(rasters.ascii_grid(tmp_path / "a.asc", stored, UTM_GT[0], UTM_GT[3] - 10 * SHAPE[0], 10), true, crs=None, notes=["no CRS"])


def test_bil(tmp_path):
    stored, true = holed(-9999, np.int16)
    ask(rasters.bil(tmp_path / "a.bil", stored, UTM_GT[0] + 5, UTM_GT[3] - 5, 10, prj=UTM), true)


def test_dted(tmp_path):
    values = np.round(terrains.fractal((121, 121), 152, 900.0)) - 100
    values[40, 50] = -32767
    true = values.astype(np.float32)
    true[40, 50] = np.nan
    step = 1 / 120
    ask(rasters.dted(tmp_path / "a.dt0", values, 10, 46), true, (10 - step / 2, step, 0, 47 + step / 2, 0, -step), "EPSG:4326")


def test_hgt_in_a_zip(tmp_path):
    values = np.full((1201, 1201), 200, np.int16)
    values[500:540, 500:540] = np.int16(terrains.fractal((40, 40), 153, 200.0))
    values[510, 520] = -32768
    path = rasters.zipped_hgt(tmp_path, 46, 10, values)
    for name in (path, str(tmp_path / "N46E010.hgt.zip")):
        dem = sb.read_dem(name)
        heights = dem.heights
        assert dem.shape == (1201, 1201) and np.isnan(heights[510, 520]) and np.nansum(heights != np.where(values == -32768, np.nan, values)) == 1
        result = sb.viewshed(dem, [(10 + 515 / 1200, 47 - 515 / 1200)], max_distance=1500, error_model=sb.ErrorModel(3.0, 0, 0))
        assert np.nanmax(result.confidence) == 1 and (result.verdict == 0).any()


def test_usgs_dem(tmp_path):
    values = np.int16(Z)
    path = rasters.copy(tmp_path / "a.dem", "USGSDEM", values, (500000, 30, 0, 5000000, 0, -30), "EPSG:26910")
    dem = sb.read_dem(path)
    heights = dem.heights
    whole = ~np.isnan(heights).all(axis=1)      # the format pads a row
    np.testing.assert_array_equal(heights[whole], values)
    assert "UTM zone 10N" in dem.crs_wkt
    gt, row = dem.geotransform, int(np.argmax(whole)) + 12
    eye = [(gt[0] + gt[1] * 12.5, gt[3] + gt[5] * (row + 0.5))]
    assert (sb.viewshed(dem, eye, error_model=sb.ErrorModel(1.0, 0, 0)).verdict == 2).any()


def test_truncated_geotiff(tmp_path):
    z = np.tile(Z.astype(np.float32), (20, 20))
    path = rasters.truncated(rasters.geotiff(tmp_path / "cut.tif", z, UTM_GT, UTM), 0.4)
    with pytest.raises(OSError, match="cut.tif"):
        sb.viewshed(sb.read_dem(path), [(613445.0, 5535995.0)])
    path = rasters.truncated(rasters.geotiff(tmp_path / "stub.tif", z, UTM_GT, UTM), 0.0001)
    with pytest.raises(OSError, match="stub.tif"):
        sb.read_dem(path)


def test_a_file_that_vanishes(tmp_path):
    path = rasters.copy(tmp_path / "a.bil", "EHdr", np.int16(Z), UTM_GT, UTM)
    with pytest.raises(OSError, match="a.bil"):
        (tmp_path / "a.bil").unlink()
        sb.read_dem(path)


def test_unusual_names(tmp_path):
    folder = tmp_path / "Höhen & Täler (1)"
    folder.mkdir()
    ask(rasters.geotiff(folder / "d e m'.tif", Z, UTM_GT, UTM), Z)
