# SPDX-License-Identifier: GPL-3.0-or-later
"""sightbound:estimateerror through processing.run."""

import json
import re
import xml.etree.ElementTree as ElementTree

import numpy
import pytest
import scenes
from osgeo import ogr, osr
from qgis.core import QgsProcessingException
from qgis.PyQt.QtCore import QByteArray
from qgis.PyQt.QtGui import QImage, QPainter
from qgis.PyQt.QtSvg import QSvgRenderer

COUNT = 30


@pytest.fixture
def points(tmp_path):
    """Places on the hills, the DEM 1.5 m too high there: with Z, and with a field `true`."""
    rng = numpy.random.default_rng(3)
    rows, cols = rng.integers(2, scenes.ROWS - 2, COUNT), rng.integers(2, scenes.COLS - 2, COUNT)
    heights = scenes.hills()[rows, cols] - 1.5
    x, y = scenes.WEST + (cols + 0.5) * scenes.CELL, scenes.NORTH - (rows + 0.5) * scenes.CELL
    return write_layer(tmp_path / "checks.gpkg", zip(x, y, heights.astype(float)))


def write_layer(path, places, crs=scenes.UTM, kind=ogr.wkbPoint25D):
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = source.CreateLayer("checks", scenes.reference(crs), kind)
    layer.CreateField(ogr.FieldDefn("true", ogr.OFTReal))
    for x, y, z in places:
        feature = ogr.Feature(layer.GetLayerDefn())
        point = ogr.Geometry(kind)
        point.AddPoint(x, y, z) if kind == ogr.wkbPoint25D else point.AddPoint_2D(x, y)
        feature.SetGeometry(point)
        feature.SetField("true", z)
        layer.CreateFeature(feature)
    return str(path)


@pytest.fixture
def better(tmp_path):
    """The hills with cells of half the size, 2 m lower and 6 m to the east."""
    row, col = numpy.mgrid[0 : 2 * scenes.ROWS, 0 : 2 * scenes.COLS]
    heights = 98.0 + 10.0 * numpy.sin((col / 2.0 - 0.25) / 4.0) + 8.0 * numpy.cos((row / 2.0 - 0.25) / 5.0)
    half = scenes.CELL / 2.0
    transform = (scenes.WEST + 6.0, half, 0.0, scenes.NORTH, 0.0, -half)
    return str(scenes.write_raster(tmp_path / "better.tif", heights.astype("float32"), transform, scenes.UTM))


def test_the_dem_alone(run, dem, tmp_path):
    out = {"OUTPUT_MODEL": str(tmp_path / "model.json"), "OUTPUT_BETWEEN": str(tmp_path / "between.tif")}
    results = run("estimateerror", INPUT=dem, **out)
    assert set(results) == {*out, "ERROR_MODEL_USED", "GROWTH_EXPONENT", "TYPICAL_SIGMA"}
    assert json.loads((tmp_path / "model.json").read_text()) == json.loads(results["ERROR_MODEL_USED"])
    between, _ = scenes.read(out["OUTPUT_BETWEEN"])
    assert numpy.sqrt((between**2).mean()) == pytest.approx(results["TYPICAL_SIGMA"], rel=0.1)


def test_nothing_need_be_written(run, dem):
    assert set(run("estimateerror", INPUT=dem)) == {"ERROR_MODEL_USED", "GROWTH_EXPONENT", "TYPICAL_SIGMA"}


def test_a_product_of_published_accuracy(run, dem):
    model = json.loads(run("estimateerror", INPUT=dem, ERROR_PRODUCT="3dep_ql2")["ERROR_MODEL_USED"])
    assert model["vertical_rmse"] > 0.0 and "from_dem" in model["geologic_variation"]


def test_check_points_with_z_or_a_field_in_any_crs(run, dem, points, tmp_path):
    found = [
        run("estimateerror", INPUT=dem, CHECKPOINTS=points),
        run("estimateerror", INPUT=dem, CHECKPOINTS=points, ELEVATION_FIELD="true"),
    ]
    for results in found:
        assert results["BIAS"] == pytest.approx(1.5, abs=1e-3) and results["RMSE"] == pytest.approx(1.5, abs=1e-3)
        assert json.loads(results["ERROR_MODEL_USED"])["shared_bias"] == pytest.approx(1.5, abs=1e-3)

    to_degrees = osr.CoordinateTransformation(scenes.reference(scenes.UTM), scenes.reference(4326))
    source, places = ogr.Open(points), []
    for feature in source.GetLayer(0):
        lon, lat, _ = to_degrees.TransformPoint(*feature.GetGeometryRef().GetPoint_2D())
        places.append((lon, lat, feature["true"] / 0.3048))
    degrees = write_layer(tmp_path / "feet.gpkg", places, 4326)
    results = run("estimateerror", INPUT=dem, CHECKPOINTS=degrees, CHECKPOINT_UNIT="foot")
    assert results["BIAS"] == pytest.approx(1.5, abs=1e-2)


def test_a_better_dem_tells_the_shift_and_it_is_taken_off(run, dem, better, tmp_path):
    moved = str(tmp_path / "moved.tif")
    log = scenes.Log()
    results = run("estimateerror", feedback=log, INPUT=dem, REFERENCE=better, SAMPLES_OR_MEANS="samples", OUTPUT_CORRECTED=moved)
    assert results["SHIFT_X"] == pytest.approx(-6.0, abs=0.1)
    assert results["SHIFT_Y"] == pytest.approx(0.0, abs=0.1)
    assert results["SHIFT_Z"] == pytest.approx(2.0, abs=0.1)
    assert any("sideways" in warning for warning in log.warnings)
    assert any("not that of OUTPUT_CORRECTED" in warning for warning in log.warnings)
    heights, raster = scenes.read(moved)
    assert raster.GetGeoTransform()[0] == pytest.approx(scenes.WEST + 6.0, abs=0.1)
    assert numpy.allclose(heights, scenes.hills() - results["SHIFT_Z"], atol=1e-3)
    again = run("estimateerror", INPUT=moved, REFERENCE=better)
    assert again["RMSE"] < 0.1 < results["RMSE"]


@pytest.mark.parametrize("correct", [False, True])
def test_the_model_belongs_to_one_dem(run, dem, points, tmp_path, correct):
    """Check points on a DEM that is 1.5 m too high: the bias goes off once, whichever of the two DEMs the model is of."""
    log, moved = scenes.Log(), str(tmp_path / "moved.tif")
    results = run("estimateerror", feedback=log, INPUT=dem, CHECKPOINTS=points, CORRECT_SHIFT=correct, OUTPUT_CORRECTED=moved)
    bias = json.loads(results["ERROR_MODEL_USED"]).get("shared_bias", 0.0)
    assert bias == pytest.approx(0.0 if correct else 1.5, abs=1e-3)
    heights, _ = scenes.read(moved)
    assert numpy.allclose(heights, scenes.hills() - 1.5, atol=1e-3)
    assert any("not that of OUTPUT_CORRECTED" in warning for warning in log.warnings) == (not correct)


def test_without_a_shift_the_bias_alone_goes_off_and_once(run, tmp_path):
    row, col = numpy.mgrid[0 : scenes.ROWS, 0 : scenes.COLS]
    slope = (100.0 + 2.0 * col).astype("float32")
    grid = (scenes.WEST, scenes.CELL, 0.0, scenes.NORTH, 0.0, -scenes.CELL)
    tilted = str(scenes.write_raster(tmp_path / "tilted.tif", slope, grid, scenes.UTM))
    places = [
        (scenes.WEST + (c + 0.5) * scenes.CELL, scenes.NORTH - (r + 0.5) * scenes.CELL, 98.0 + 2.0 * c)
        for r in range(3, 20, 4) for c in range(3, 20, 4)
    ]
    points = write_layer(tmp_path / "on_slope.gpkg", places)
    log, moved = scenes.Log(), str(tmp_path / "moved.tif")
    results = run("estimateerror", feedback=log, INPUT=tilted, CHECKPOINTS=points, CORRECT_SHIFT=True, OUTPUT_CORRECTED=moved)
    assert "SHIFT_X" not in results and any("only has the bias taken off" in warning for warning in log.warnings)
    assert json.loads(results["ERROR_MODEL_USED"]).get("shared_bias", 0.0) == pytest.approx(0.0, abs=1e-3)
    assert numpy.allclose(scenes.read(moved)[0], slope - 2.0, atol=1e-3)


def test_the_model_serves_the_others(run, dem, better, tmp_path):
    model = str(tmp_path / "model.json")
    run("estimateerror", INPUT=dem, REFERENCE=better, CORRECT_SHIFT=True, OUTPUT_MODEL=model)
    results = run("errorsurfaces", INPUT=dem, ERROR_MODEL=model, OUTPUT_SIGMA=str(tmp_path / "sigma.tif"))
    assert json.loads(results["ERROR_MODEL_USED"]) == json.loads((tmp_path / "model.json").read_text())


@pytest.mark.parametrize("known", ["none", "points", "better"])
def test_report(run, dem, points, better, tmp_path, known):
    page = tmp_path / "report.html"
    more = {"none": {}, "points": {"CHECKPOINTS": points}, "better": {"REFERENCE": better}}[known]
    run("estimateerror", INPUT=dem, OUTPUT_HTML=str(page), **more)
    text = page.read_text(encoding="utf-8")
    drawings = re.findall(r"<svg .*?</svg>", text, re.DOTALL)
    assert len(drawings) == (1 if known == "none" else 4)
    assert "nan" not in text.lower().replace("nanometre", "") and "data:image/png;base64," in text
    for drawing in drawings:
        assert is_drawn(drawing.replace("<svg ", "<svg xmlns='http://www.w3.org/2000/svg' ", 1))
    assert ("NMAD" in text) == (known != "none")


def is_drawn(drawing):
    """Is it well formed, and does it leave ink?"""
    ElementTree.fromstring(drawing)
    renderer = QSvgRenderer(QByteArray(drawing.encode()))
    image = QImage(430, 160, QImage.Format.Format_RGB32)
    image.fill(0xFFFFFFFF)
    painter = QPainter(image)
    renderer.render(painter)
    painter.end()
    white = QImage(image)
    white.fill(0xFFFFFFFF)
    return renderer.isValid() and image != white


def test_bad_input(run, dem, points, tmp_path):
    def refused(**parameters):
        with pytest.raises(QgsProcessingException) as raised:
            run("estimateerror", INPUT=dem, **parameters)
        return str(raised.value)

    few = write_layer(tmp_path / "few.gpkg", [(scenes.WEST + 50.0 + 10 * i, scenes.NORTH - 50.0, 100.0) for i in range(9)])
    flat = write_layer(tmp_path / "flat.gpkg", [(scenes.WEST + 50.0, scenes.NORTH - 50.0, 1.0)], kind=ogr.wkbPoint)
    empty = write_layer(tmp_path / "empty.gpkg", [])
    far = str(scenes.write_raster(tmp_path / "far.tif", scenes.hills(), (0.0, 10.0, 0.0, 0.0, 0.0, -10.0), scenes.UTM))
    assert "CHECKPOINTS: Only 9 places" in refused(CHECKPOINTS=few)
    assert "ELEVATION_FIELD:" in refused(CHECKPOINTS=flat)
    assert "ELEVATION_FIELD:" in refused(CHECKPOINTS=points, ELEVATION_FIELD="none")
    assert "CHECKPOINTS: the layer is empty" in refused(CHECKPOINTS=empty)
    assert "REFERENCE: The reference does not overlap" in refused(REFERENCE=far)
    assert "ERROR_PRODUCT:" in refused(CHECKPOINTS=points, ERROR_PRODUCT="3dep_ql2")
    assert "OUTPUT_CORRECTED:" in refused(OUTPUT_CORRECTED=str(tmp_path / "moved.tif"))
