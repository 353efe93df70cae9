# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrong arguments: the right class, and a message that names the argument, its value, what is allowed or what to do."""
import numpy as np
import pytest
import rasters
import sightbound as sb

GT = (0.0, 10.0, 0.0, 200.0, 0.0, -10.0)
NAN, INF = float("nan"), float("inf")


@pytest.fixture
def dem():
    z = np.zeros((20, 20), np.float32)
    z[4, 4] = np.nan
    return sb.Dem(z, GT)


EYE = [(105.0, 105.0)]


@pytest.mark.parametrize("how, message", [
    (dict(confidence=0), r"confidence.* 0.*\b1\b"), (dict(confidence=1), "confidence"), (dict(confidence=1.5), "confidence.*1.5"),
    (dict(confidence=NAN), "confidence.*nan"), (dict(confidence="high"), "confidence.*'high'.*number"),
    (dict(observer_height=NAN), "observer_height.*nan"), (dict(observer_height=INF), "observer_height.*inf"),
    (dict(observer_height=1e9), r"observer_height.*1000000000.*1e8"), (dict(target_height=-1e9), r"target_height.*-1000000000.*1e8"),
    (dict(observer_height=[1, 2]), "observer_height has 2 values for 1 observer"),
    (dict(target_height="tall"), "target_height.*'tall'"),
    (dict(min_distance=-5), "min_distance.*-5"), (dict(max_distance=-5), "max_distance.*-5"), (dict(max_distance=0), "max_distance.*0"),
    (dict(min_distance=50, max_distance=20), "min_distance.*max_distance|max_distance.*min_distance"),
    (dict(azimuth=(0,)), "azimuth.*pair"), (dict(azimuth=(0, NAN)), "azimuth.*nan"), (dict(azimuth=90), "azimuth.*pair"),
    (dict(vertical_angle=(10, -10)), "vertical_angle|angle"), (dict(vertical_angle=(-91, 90)), "angle.*-91"),
    (dict(refraction=NAN), "refraction.*nan"), (dict(refraction=5), "refraction.*5"), (dict(refraction=-2), "refraction.*-2"),
    (dict(stand="air"), "stand.*'air'.*'model'.*'ground'"), (dict(combine="mean"), "combine.*'mean'.*'best'.*'worst'"),
    (dict(height_reference="sea"), "height_reference.*'sea'.*'ground'.*'absolute'"),
    (dict(extent=(0, 0, 100)), "extent.*x_min"), (dict(extent=(100, 0, 0, 100)), "extent.*empty"),
    (dict(extent=(1e6, 0, 2e6, 100)), "extent.*outside the DEM"), (dict(extent=(0, 0, NAN, 100)), "extent"),
    (dict(threads=0), "threads.*0.*1"), (dict(threads=-3), "threads.*-3"), (dict(threads=2.5), "threads.*2.5"),
    (dict(memory_budget=0), "memory_budget.*0"), (dict(memory_budget="much"), "memory_budget.*'much'"),
])
def test_viewshed_arguments(dem, how, message):
    with pytest.raises(ValueError, match=message):
        sb.viewshed(dem, EYE, **how)


@pytest.mark.parametrize("observers, message", [
    ([], "observers.*empty"), ((5, 5), r"observers.*\[\(x, y\)\]"), ([(5,)], "observer.*1.*pair"), ([(5, NAN)], "observer 1.*nan"),
    ([(105, 105), (-500, 5)], r"(?i)observer.*2.*outside"), ([(45, 155)], r"(?i)observer.*nodata"), (None, "observers"), ("here", "observers"),
])
def test_observers(dem, observers, message):
    with pytest.raises(ValueError, match=message):
        sb.viewshed(dem, observers)


def test_observers_are_named(dem):
    with pytest.raises(ValueError, match="Hilltop"):
        sb.viewshed(dem, [(105, 105), (-500, 5)], names=["Tower", "Hilltop"])


@pytest.mark.parametrize("model, message", [
    (dict(vertical_rmse=-1), r"vertical_rmse is -1.*0"), (dict(vertical_rmse=NAN), "vertical_rmse.*nan"), (dict(vertical_rmse="a", geologic_variation=-1), "geologic_variation"),
    (dict(horizontal_rmse=-2), "horizontal_rmse is -2"), (dict(geologic_variation=-3), "geologic_variation is -3"),
    (dict(geologic_variation=1, geologic_range=0), "geologic_range is 0"), (dict(geologic_variation=1, geologic_range=-4), "geologic_range is -4"),
    (dict(geologic_model="fractal"), "geologic_model is 'fractal'.*'gaussian', 'step' and 'growth'"),
    (dict(geologic_variation=1, geologic_model="step"), "'step' needs a geologic_range"),
    (dict(geologic_variation=1, geologic_model="growth"), "'growth' needs a growth_exponent"),
    (dict(geologic_variation=1, geologic_model="growth", growth_exponent=9), "growth_exponent is 9"),
    (dict(terrain_table={"a": 1}), "terrain_types.*missing"), (dict(terrain_types="x.gpkg"), "terrain_field is missing"),
    (dict(vertical_rmse=np.zeros(5)), r"vertical_rmse has shape \(5,\)"),
])
def test_error_model(model, message):
    with pytest.raises(ValueError, match=message):
        sb.ErrorModel(**model)


def test_error_model_against_the_dem(dem):
    with pytest.raises(ValueError, match=r"vertical_rmse has shape \(3, 3\), the DEM has \(20, 20\)"):
        sb.viewshed(dem, EYE, error_model=sb.ErrorModel(vertical_rmse=np.ones((3, 3))))
    with pytest.raises(ValueError, match="vertical_rmse.*-1"):
        sb.viewshed(dem, EYE, error_model=sb.ErrorModel(vertical_rmse=np.full((20, 20), -1.0), geologic_variation=0))
    with pytest.raises(OSError, match="missing.tif"):
        sb.viewshed(dem, EYE, error_model=sb.ErrorModel(vertical_rmse="missing.tif", geologic_variation=0))
    with pytest.raises(TypeError, match="error_model"):
        sb.viewshed(dem, EYE, error_model=1.0)


@pytest.mark.parametrize("accuracy, message", [
    (dict(rmse=1, le90=2), "rmse and le90"), (dict(ce90=1, ce95=2), "ce90 and ce95"), (dict(le90=-1), "-1|-0.6"), (dict(le95="x.tif"), "le95.*path")])
def test_from_accuracy(accuracy, message):
    with pytest.raises(ValueError, match=message):
        sb.ErrorModel.from_accuracy(**accuracy)


@pytest.mark.parametrize("text, message", [("{", "JSON|json"), ('{"vertical_rmse": "high"}', "vertical_rmse"), ('{"vertical_rmse": -1}', "vertical_rmse"),
                                           ('{"colour": 1}', "colour"), ("[]", "(?i)json|no such file")])
def test_from_json(text, message):
    with pytest.raises((ValueError, OSError), match=message):
        sb.ErrorModel.from_json(text)


@pytest.mark.parametrize("heights, gt, more, message", [
    (np.zeros(5), GT, {}, r"heights has shape \(5,\)"), (np.zeros((3, 3), complex), GT, {}, "heights has type complex"),
    (np.array([["a", "b"], ["c", "d"]]), GT, {}, "heights has type"), (np.zeros((3, 3)), (0, 1, 0), {}, "geotransform.*six"),
    (np.zeros((3, 3)), (0, 0, 0, 0, 0, 0), {}, "geotransform"), (np.zeros((3, 3)), (0, NAN, 0, 0, 0, 1), {}, "geotransform.*nan"),
    (np.zeros((3, 3)), (0, 1, 1, 0, 1, 1), {}, "geotransform"), (np.zeros((3, 3)), GT, dict(vertical_unit="yard"), "vertical_unit is 'yard'"),
    (np.zeros((3, 3)), GT, dict(vertical_unit="auto"), "vertical_unit is 'auto'"), (np.zeros((3, 3)), GT, dict(crs_wkt="nonsense"), "CRS.*nonsense"),
    (np.zeros((3, 3)), (10, 0.001, 0, 46, 0, -0.001), {}, r"(?s)look like degrees.*EPSG:4326"),
])
def test_dem(heights, gt, more, message):
    with pytest.raises(ValueError, match=message):
        dem = sb.Dem(heights, gt, **more)
        x0, y0, x1, y1 = dem.extent
        sb.viewshed(dem, [((x0 + x1) / 2, (y0 + y1) / 2)])


def test_read_dem(tmp_path):
    path = rasters.geotiff(tmp_path / "a.tif", np.zeros((5, 5), np.float32), GT)
    with pytest.raises(OSError, match="nowhere.tif"):
        sb.read_dem(tmp_path / "nowhere.tif")
    with pytest.raises(ValueError, match=r"(?i)band.*2.*1"):
        sb.read_dem(path, band=2)
    with pytest.raises(ValueError, match=r"(?i)band.*0"):
        sb.read_dem(path, band=0)
    with pytest.raises(ValueError, match="band is 1.5"):
        sb.read_dem(path, band=1.5)
    with pytest.raises(ValueError, match="vertical_unit is 'ell'"):
        sb.read_dem(path, vertical_unit="ell")
    with pytest.raises(OSError):
        sb.read_dem(path, ground=tmp_path / "none.tif")
    text = tmp_path / "notes.txt"
    text.write_text("not a raster")
    with pytest.raises(OSError, match="notes.txt"):
        sb.read_dem(text)
    with pytest.raises(ValueError, match="(?i)georeference|geotransform"):
        sb.read_dem(rasters.geotiff(tmp_path / "bare.tif", np.zeros((5, 5), np.float32)))
    with pytest.raises(TypeError, match="read_dem"):
        sb.viewshed(path, EYE)


def test_line_of_sight(dem):
    with pytest.raises(ValueError, match="(?i)target.*outside"):
        sb.line_of_sight(dem, (105, 105), (1e6, 5))
    with pytest.raises(ValueError, match="(?i)target.*nodata"):
        sb.line_of_sight(dem, (105, 105), (45, 155))
    with pytest.raises(ValueError, match="(?i)observer.*outside"):
        sb.line_of_sight(dem, (-105, 105), (45, 45))
    with pytest.raises(ValueError, match="target.*pair"):
        sb.line_of_sight(dem, (105, 105), 7)
    with pytest.raises(ValueError, match="observers has 2 places, targets has 1"):
        sb.lines_of_sight(dem, [(105, 105), (45, 45)], [(85, 85)])


def test_write(dem, tmp_path):
    result = sb.viewshed(dem, EYE)
    with pytest.raises(ValueError, match="(?i)nothing to write"):
        result.write()
    with pytest.raises(ValueError, match="heights=True"):
        result.write(height=tmp_path / "h.tif")
    with pytest.raises(ValueError, match="same|twice"):
        result.write(tmp_path / "a.tif", verdict=tmp_path / "a.tif")
    with pytest.raises(ValueError, match="confidence.*empty path"):
        result.write("")
    with pytest.raises(ValueError, match="creation_options"):
        result.write(tmp_path / "a.tif", creation_options="COMPRESS")
    with pytest.raises(OSError, match="no_such_folder"):
        result.write(tmp_path / "no_such_folder" / "a.tif")
    assert list(tmp_path.iterdir()) == []
