# SPDX-License-Identifier: GPL-3.0-or-later
"""The error model: conversions, JSON, rasters and polygons, error surfaces, and the estimate from the DEM alone."""
import json

import error_oracle
import numpy as np
import pytest
import rasters
import sightbound as sb
import terrains
from osgeo import ogr
from sight_oracle import Errors, Oracle

UTM, UTM_GT = "EPSG:32633", (612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0)
SHAPE = (40, 50)
Z = terrains.fractal(SHAPE, 181, 80.0)


@pytest.fixture
def dem():
    return sb.Dem(Z, UTM_GT, rasters.wkt_of(UTM))


# ---- what is said ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["rmse", "le90", "le95"])
def test_vertical_accuracies(name):
    assert sb.ErrorModel.from_accuracy(**{name: 3.0}).vertical_rmse == pytest.approx(3.0 * error_oracle.VERTICAL[name], rel=1e-9)
    array = sb.ErrorModel.from_accuracy(**{name: np.full(SHAPE, 3.0)}).vertical_rmse
    assert array == pytest.approx(np.full(SHAPE, 3.0 * error_oracle.VERTICAL[name]), rel=1e-6)


@pytest.mark.parametrize("name", ["ce90", "ce95"])
def test_horizontal_accuracies_are_radial(name):
    model = sb.ErrorModel.from_accuracy(le90=1.0, **{name: 5.0}, geologic_variation=0.5)
    assert model.horizontal_rmse == pytest.approx(5.0 * error_oracle.HORIZONTAL[name], rel=1e-9) and model.geologic_variation == 0.5


def test_nothing_said_and_zero_said():
    assert sb.ErrorModel().vertical_rmse is None and sb.ErrorModel().geologic_variation is None
    assert sb.ErrorModel(vertical_rmse=0).vertical_rmse == 0 and sb.ErrorModel(geologic_variation=0).geologic_variation == 0


@pytest.mark.parametrize("model", [
    sb.ErrorModel(), sb.ErrorModel(1.5, 0.5, 2.0), sb.ErrorModel(0.0, 0.0, 0.0), sb.ErrorModel(1.0, 0.0, 2.0, 7.5),
    sb.ErrorModel(1.0, 0.0, 2.0, 7.5, "step"), sb.ErrorModel(1.0, 0.0, 2.0, geologic_model="growth", growth_exponent=1.2),
    sb.ErrorModel("sigma.tif", 0.0, "delta.tif"),
    sb.ErrorModel(1.0, tails="student", correlation_length=12.5, shared_bias=-0.3, samples_or_means="means", ridge_gain=0.1,
                  level_variance=0.4, step_variance=2.5, level_tail=1.2, step_tail=0.1),
    sb.ErrorModel(1.0, 0.0, 0.5, terrain_types="types.gpkg", terrain_field="class", terrain_table={"a": 1.5, "b": 3.0}),
], ids=repr)
def test_json_round_trip(model, tmp_path):
    text = model.to_json()
    json.loads(text)
    (tmp_path / "model.json").write_text(text)
    for back in (sb.ErrorModel.from_json(text), sb.ErrorModel.from_json(tmp_path / "model.json")):
        for field in ("vertical_rmse", "horizontal_rmse", "geologic_variation", "geologic_range", "geologic_model", "growth_exponent",
                      "terrain_types", "terrain_field", "terrain_table", "tails", "correlation_length", "shared_bias",
                      "samples_or_means", "ridge_gain", "level_variance", "step_variance", "level_tail", "step_tail"):
            assert getattr(back, field) == getattr(model, field), field
        assert back.to_json() == text


def test_the_nature_of_errors():
    model = sb.ErrorModel()
    assert (model.tails, model.correlation_length, model.shared_bias, model.samples_or_means, model.ridge_gain) == (None, 0, 0, None, None)
    assert sb.ErrorModel(samples_or_means="auto").samples_or_means is None
    for wrong in (dict(tails="cauchy"), dict(correlation_length=-1), dict(shared_bias=1e5), dict(samples_or_means="both"), dict(ridge_gain=3),
                  dict(level_variance=-1), dict(step_variance=11), dict(level_tail=1.6, step_tail=0), dict(step_tail=-0.1, level_tail=0), dict(level_tail=0.5)):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            sb.ErrorModel(**wrong)


def test_json_cannot_hold_arrays():
    with pytest.raises(ValueError, match="vertical_rmse is an array"):
        sb.ErrorModel(vertical_rmse=np.ones(SHAPE)).to_json()


# ---- rasters and polygons ----------------------------------------------------------------------------------------------


def confidence(dem, model):
    return sb.viewshed(dem, [(612595.0, 5537915.0)], observer_height=5.0, error_model=model).confidence


@pytest.mark.parametrize("field", ["vertical_rmse", "geologic_variation"])
def test_number_array_and_raster_say_the_same(dem, tmp_path, field):
    other = {"vertical_rmse": dict(geologic_variation=0), "geologic_variation": dict(vertical_rmse=0.3, geologic_range=5.0)}[field]
    values = terrains.noise(SHAPE, 182, 3.0)
    path = rasters.geotiff(tmp_path / "e.tif", values, UTM_GT, UTM)
    as_array, as_path = (confidence(dem, sb.ErrorModel(**{field: v}, **other)) for v in (values, path))
    assert np.array_equal(as_array, as_path, equal_nan=True)
    flat = np.full(SHAPE, 1.25, np.float32)
    as_number, as_array = (confidence(dem, sb.ErrorModel(**{field: v}, **other)) for v in (1.25, flat))
    np.testing.assert_allclose(as_number, as_array, atol=1e-6)


def test_raster_on_another_grid_and_crs(dem, tmp_path):
    """sigma rises linearly with the easting: any grid and CRS that covers the DEM says the same."""
    gt = (612140.0, 25.0, 0.0, 5538320.0, 0.0, -25.0)
    shape = (40, 50)

    def sigma(x):
        return (x - 612000.0) / 400.0

    oracle = Oracle(Z, UTM_GT, UTM)
    cols = np.arange(SHAPE[1])
    exact = np.tile(sigma(oracle.frame.xy(cols, 0)[0]), (SHAPE[0], 1)).astype(np.float32)
    coarse_x = gt[0] + gt[1] * (np.arange(shape[1]) + 0.5)
    coarse = rasters.geotiff(tmp_path / "coarse.tif", np.tile(sigma(coarse_x), (shape[0], 1)).astype(np.float32), gt, UTM)
    np.testing.assert_allclose(confidence(dem, sb.ErrorModel(coarse, 0, 0)), confidence(dem, sb.ErrorModel(exact, 0, 0)), atol=1e-4)
    west, north = oracle.frame.lonlat(612100.0, 5538350.0)
    dgt = (float(west), 2e-4, 0.0, float(north), 0.0, -2e-4)
    lon = dgt[0] + dgt[1] * (np.arange(60) + 0.5)
    lat = dgt[3] + dgt[5] * (np.arange(60) + 0.5)
    x, _ = oracle.frame.from_lonlat.transform(*np.meshgrid(lon, lat))
    geographic = rasters.geotiff(tmp_path / "degrees.tif", sigma(x).astype(np.float32), dgt, "EPSG:4326")
    np.testing.assert_allclose(confidence(dem, sb.ErrorModel(geographic, 0, 0)), confidence(dem, sb.ErrorModel(exact, 0, 0)), atol=2e-3)


def test_raster_that_does_not_cover_the_dem(dem, tmp_path):
    """Where the error is unknown the ground counts as unknown, and the report says for how many cells."""
    half = rasters.geotiff(tmp_path / "half.tif", np.ones((40, 30), np.float32), UTM_GT, UTM)
    result = sb.viewshed(dem, [(612455.0, 5537915.0)], error_model=sb.ErrorModel(half, 0, 0))
    assert np.isnan(result.confidence[:, 31:]).all() and not np.isnan(result.confidence[:, :29]).any()
    assert any(str(int(np.isnan(result.confidence).sum())) in text for text in result.report["warnings"])
    elsewhere = rasters.geotiff(tmp_path / "far.tif", np.ones((4, 4), np.float32), (1e5, 10, 0, 5e6, 0, -10), UTM)
    with pytest.raises(ValueError, match="far.tif.*no value anywhere"):
        sb.viewshed(dem, [(612455.0, 5537915.0)], error_model=sb.ErrorModel(elsewhere, 0, 0))


def polygons(path, classes, field="class", crs="EPSG:32633"):
    """Rectangles (x0, y0, x1, y1, value) as GeoPackage."""
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    from osgeo import osr
    reference = osr.SpatialReference()
    reference.SetFromUserInput(crs)
    layer = source.CreateLayer("types", reference, ogr.wkbPolygon)
    text = isinstance(classes[0][4], str)
    layer.CreateField(ogr.FieldDefn(field, ogr.OFTString if text else ogr.OFTReal))
    for x0, y0, x1, y1, value in classes:
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(f"POLYGON(({x0} {y0},{x1} {y0},{x1} {y1},{x0} {y1},{x0} {y0}))"))
        if value is not None:
            feature.SetField(field, value)
        layer.CreateFeature(feature)
    feature = layer = source = None
    return str(path)


WEST, EAST = (612000, 5537000, 612590, 5539000), (612590, 5537000, 614000, 5539000)


def sigma_of(dem, model):
    return sb.error_surfaces(dem, model).sigma


def test_terrain_types(dem, tmp_path):
    """Metres, classes of the default table, and an own table; the largest value on overlap."""
    table = sb.terrain_table()
    assert table["grassland"] == 0.5 and max(table.values()) == 4.0
    craggy = next(name for name, metres in table.items() if metres == 4.0)
    common = dict(vertical_rmse=0.2, geologic_range=5.0)
    expected = np.where(np.arange(SHAPE[1]) * 10 + 612345 < 612590, 0.5, 4.0)
    expected = sigma_of(dem, sb.ErrorModel(geologic_variation=np.tile(expected, (SHAPE[0], 1)), **common))
    by_class = polygons(tmp_path / "a.gpkg", [(*WEST, "grassland"), (*EAST, craggy)])
    by_metres = polygons(tmp_path / "b.gpkg", [(*WEST, 0.5), (*EAST, 4.0), (*EAST, 1.0)], "delta")
    own = polygons(tmp_path / "c.gpkg", [(*WEST, "low"), (*EAST, "high")])
    for types, field, given in ((by_class, "class", None), (by_metres, "delta", None), (own, "class", {"low": 0.5, "high": 4})):
        model = sb.ErrorModel(geologic_variation=9.0, terrain_types=types, terrain_field=field, terrain_table=given, **common)
        np.testing.assert_allclose(sigma_of(dem, model), expected, rtol=1e-6)
    (tmp_path / "t.csv").write_text("class,metres\nlow,0.5\nhigh,4\n")
    (tmp_path / "t.json").write_text('{"low": 0.5, "high": 4}')
    for file in ("t.csv", "t.json"):
        model = sb.ErrorModel(geologic_variation=9.0, terrain_types=own, terrain_field="class", terrain_table=tmp_path / file, **common)
        np.testing.assert_allclose(sigma_of(dem, model), expected, rtol=1e-6)


def test_outside_the_polygons_the_number_holds(dem, tmp_path):
    path = polygons(tmp_path / "a.gpkg", [(*WEST, 3.0)], "delta")
    sigma = sigma_of(dem, sb.ErrorModel(0.2, 0.0, 1.0, 5.0, terrain_types=path, terrain_field="delta"))
    ones = sigma_of(dem, sb.ErrorModel(0.2, 0.0, 1.0, 5.0))
    assert np.all(sigma[:, 27:] == ones[:, 27:]) and np.all(sigma[:, :23] > ones[:, :23])


def test_unknown_classes_are_listed(dem, tmp_path):
    path = polygons(tmp_path / "a.gpkg", [(*WEST, "swamp"), (*EAST, "moon")])
    model = sb.ErrorModel(0.2, 0, 0, terrain_types=path, terrain_field="class")
    with pytest.raises(ValueError, match="(?s)moon.*swamp.*grassland|swamp.*moon.*grassland"):
        sigma_of(dem, model)
    with pytest.raises(ValueError, match="klass"):
        sigma_of(dem, sb.ErrorModel(0.2, 0, 0, terrain_types=path, terrain_field="klass"))
    with pytest.raises(OSError, match="none.gpkg"):
        sigma_of(dem, sb.ErrorModel(0.2, 0, 0, terrain_types=tmp_path / "none.gpkg", terrain_field="class"))


# ---- error surfaces ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("model, errors", [
    (sb.ErrorModel(0.5, 0, 0), Errors(0.5)), (sb.ErrorModel(0.0, 0, 0), Errors(0.0)), (sb.ErrorModel(0.5, 0.8, 2.0, 5.0), Errors(0.5, 0.8, 2.0, 5.0)),
    (sb.ErrorModel(0.1, 0.0, 0.3), Errors(0.1, 0.0, 0.3)), (sb.ErrorModel(0.1, 0, 2.0, 6.0, "step"), Errors(0.1, 0, 2.0, 6.0, "step")),
    (sb.ErrorModel(0, 0, 2.0, geologic_model="growth", growth_exponent=0.7), Errors(0, 0, 2.0, None, "growth", 0.7)),
], ids=["sigma_v", "none", "all", "paper's", "step", "growth"])
@pytest.mark.parametrize("earth", ["UTM", "degrees", "south-up"])
def test_sigma_of_a_cell_is_its_largest(model, errors, earth):
    gt, crs = {"UTM": (UTM_GT, UTM), "degrees": ((10.0, 2e-4, 0, 60.0, 0, -1e-4), "EPSG:4326"), "south-up": ((612340.0, 10.0, 0, 5538120.0, 0, 10.0), UTM)}[earth]
    surfaces = sb.error_surfaces(sb.Dem(Z, gt, rasters.wkt_of(crs)), model, confidence=0.9)
    oracle = Oracle(Z, gt, crs, errors)
    half_diagonal = 0.5 * np.hypot(*oracle.steps.T)[:, None]
    grown = np.vectorize(lambda d: error_oracle.geologic(d, errors.delta, errors.model, errors.range, errors.exponent, oracle.cell))(half_diagonal)
    expected = np.maximum(oracle.sigma_s + grown, 0.001)
    np.testing.assert_allclose(surfaces.sigma, expected, rtol=2e-3)
    z90 = 1.6448536
    # Rounded outward: never narrower than the definition.
    assert np.all(surfaces.upper.astype(float) >= Z + z90 * surfaces.sigma.astype(float) - 1e-6)
    np.testing.assert_allclose(surfaces.upper, Z + z90 * surfaces.sigma, rtol=1e-5, atol=2e-5)
    np.testing.assert_allclose(surfaces.lower, Z - z90 * surfaces.sigma, rtol=1e-5, atol=2e-5)


def test_surfaces_of_an_extent_and_of_holes(dem):
    model = sb.ErrorModel(0.5, 0.8, 2.0, 5.0)
    whole, part = sb.error_surfaces(dem, model), sb.error_surfaces(dem, model, extent=(612440, 5537900, 612640, 5538000))
    assert part.shape == (10, 20) and part.geotransform[0] == 612440 and part.geotransform[3] == 5538000
    assert np.array_equal(part.sigma, whole.sigma[12:22, 10:30])
    holed = terrains.with_holes(Z, 183, 0.05)
    surfaces = sb.error_surfaces(sb.Dem(holed, UTM_GT, rasters.wkt_of(UTM)), model)
    for array in (surfaces.sigma, surfaces.lower, surfaces.upper):
        assert np.array_equal(np.isnan(array), np.isnan(holed))


def test_slope_uses_the_faces_that_are_whole():
    """Beside a hole the steepest of the remaining triangles counts; nothing raises sigma out of nothing."""
    holed = terrains.with_holes(Z, 184, 0.1)
    oracle = Oracle(holed, UTM_GT, UTM, Errors(0.0, 1.0))
    sigma = sb.error_surfaces(sb.Dem(holed, UTM_GT, rasters.wkt_of(UTM)), sb.ErrorModel(0.0, 1.0, 0.0)).sigma
    known = ~np.isnan(holed)
    np.testing.assert_allclose(sigma[known], np.maximum(oracle.sigma_s, 0.001)[known], rtol=1e-4)


# ---- the estimate ------------------------------------------------------------------------------------------------------


def smooth_and_rough(side=200):
    z = terrains.fractal((side, side), 185, 120.0, roughness=2.0).astype(float)
    z[:, side // 2:] += terrains.fractal((side, side // 2), 186, 12.0, roughness=1.2)
    return z.astype(np.float32)


def test_growth_and_size_are_the_definition_s():
    z = smooth_and_rough()
    found = sb.estimate_error(sb.Dem(z, UTM_GT, rasters.wkt_of(UTM)), samples_or_means="samples")
    exponent, sd = error_oracle.growth(z)
    assert found.report["growth_exponent"] == pytest.approx(exponent, abs=0.01)
    assert found.report["typical_sigma"] == pytest.approx(sd * found.report["local_scale"], rel=0.1)
    assert found.growth_exponent is None or found.growth_exponent == found.report["growth_exponent"]


@pytest.mark.parametrize("south_up", [False, True])
def test_local_map(south_up):
    """Measured through the error surfaces: sigma at a cell's corner, t = sqrt2 (square cells), is the map times
    t^(min(H, 1) / 2)."""
    z = smooth_and_rough(120)
    gt = (612340.0, 10.0, 0.0, 5538120.0, 0.0, 10.0 if south_up else -10.0)
    dem = sb.Dem(z, gt, rasters.wkt_of(UTM))
    model = sb.estimate_error(dem, samples_or_means="samples")
    exponent = model.report["growth_exponent"]
    expected = error_oracle.local_variation(z, exponent, anti=south_up) * 2 ** (min(exponent, 1) / 4) * model.report["local_scale"]
    sigma = sb.error_surfaces(dem, model).sigma
    inside = np.isfinite(expected)
    # Cells are square to the projection's distortion only.
    np.testing.assert_allclose(sigma[inside] - (model.vertical_rmse or 0), np.maximum(expected[inside], 0.001), rtol=2e-3, atol=1e-3)


def test_none_is_the_estimate():
    dem = sb.Dem(smooth_and_rough(120), UTM_GT, rasters.wkt_of(UTM))
    eye = [(612945.0, 5537515.0)]
    learnt = sb.estimate_error(dem)
    results = [sb.viewshed(dem, eye, error_model=m) for m in (None, sb.ErrorModel(), learnt, sb.ErrorModel.from_json(learnt.to_json()))]
    for other in results[1:]:
        assert results[0].confidence.tobytes() == other.confidence.tobytes()
    assert results[0].report["error_model"] == results[3].report["error_model"]
    half = sb.viewshed(dem, eye, error_model=sb.ErrorModel(vertical_rmse=4.0))
    assert np.nanmean(half.verdict == 1) > np.nanmean(results[0].verdict == 1)


def test_it_predicts_what_was_left_out():
    """A fine terrain thinned by 4: of what lies half-way between the kept samples, 1.96 sigma holds most; and the sd is right
    within a factor."""
    fine = terrains.fractal((800, 800), 187, 400.0, roughness=2.0)
    kept = np.ascontiguousarray(fine[::4, ::4])
    model = sb.estimate_error(sb.Dem(kept, (0, 40, 0, 8000, 0, -40)))
    half_way = fine[::4, 2::4][:, :-1]
    missed = half_way - 0.5 * (kept[:, :-1] + kept[:, 1:])
    assert 0.6 < np.std(missed) / model.report["typical_sigma"] < 1.2
    assert np.mean(np.abs(missed) < 1.96 * model.report["typical_sigma"]) > 0.9


def test_whole_metres_are_recognised():
    z = terrains.fractal((200, 200), 188, 400.0)
    found = sb.estimate_error(sb.Dem(np.round(z), UTM_GT, rasters.wkt_of(UTM)))
    assert found.report["rounding"] == pytest.approx(1 / 12 ** 0.5, rel=1e-3) and found.vertical_rmse == pytest.approx(1 / 12 ** 0.5, rel=1e-3)
    assert sb.estimate_error(sb.Dem(z, UTM_GT, rasters.wkt_of(UTM))).report["rounding"] == 0


def test_an_oversampled_dem_is_told():
    """Resampled to a fifth of its cell size it is smooth: H near 2, and a warning."""
    from scipy.ndimage import zoom
    smooth = zoom(terrains.fractal((60, 60), 189, 300.0, roughness=1.5).astype(float), 5, order=3).astype(np.float32)
    report = sb.estimate_error(sb.Dem(smooth, UTM_GT, rasters.wkt_of(UTM))).report
    assert report["growth_exponent"] > 1.7 and any("resol" in w or "sampled" in w for w in report["warnings"])


def test_what_is_known_stays():
    dem = sb.Dem(smooth_and_rough(120), UTM_GT, rasters.wkt_of(UTM))
    model = sb.estimate_error(dem, sb.ErrorModel(vertical_rmse=0.7, horizontal_rmse=0.2))
    assert model.vertical_rmse == 0.7 and model.horizontal_rmse == 0.2
    said = sb.estimate_error(dem, sb.ErrorModel(vertical_rmse=0.7, geologic_variation=1.5, geologic_range=4.0))
    assert said.geologic_variation == 1.5 and said.geologic_range == 4.0


@pytest.mark.parametrize("z", [np.full((50, 50), 7.0), np.add.outer(np.arange(50.0), np.arange(50.0)), np.zeros((4, 4)), np.zeros((2, 2))],
                         ids=["flat", "plane", "4 x 4", "2 x 2"])
def test_nothing_to_learn_is_told(z):
    result = sb.viewshed(sb.Dem(np.float32(z), (0, 10, 0, 500, 0, -10)), [(11, 489)])
    assert np.isfinite(result.confidence).all()
    assert any("vertical_rmse" in w for w in result.report["warnings"])
