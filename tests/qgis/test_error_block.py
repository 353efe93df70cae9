# SPDX-License-Identifier: GPL-3.0-or-later
"""Every way to state the error, told by the model that the outputs carry."""

import json

import numpy
import pytest
import scenes
from qgis.core import QgsProcessing, QgsVectorLayer

# With these sigma is that of the terrain types alone, and reaches its largest value within each cell.
GIVEN = {"VERTICAL_ACCURACY": 0.0, "GEOLOGIC_VARIATION": 1.0}


@pytest.fixture
def used(run, dem, tmp_path):
    """The error model that errorsurfaces used for the given parameters."""

    def model(**parameters):
        results = run("errorsurfaces", INPUT=dem, OUTPUT_SIGMA=str(tmp_path / "sigma.tif"), **parameters)
        return json.loads(results["ERROR_MODEL_USED"])

    return model


def sigma_of(tmp_path):
    return scenes.read(tmp_path / "sigma.tif")[0]


@pytest.mark.parametrize("measure, factor", [("RMSE", 1.0), ("LE90", 1.6449), ("LE95", 1.96)])
def test_vertical_measures(used, measure, factor):
    found = used(VERTICAL_ACCURACY=2.0 * factor, VERTICAL_MEASURE=measure, GEOLOGIC_VARIATION=0.0)
    assert found["vertical_rmse"] == pytest.approx(2.0, abs=1e-4)


@pytest.mark.parametrize("measure, factor", [("RMSE", 1.0), ("CE90", 2.1460), ("CE95", 2.4477)])
def test_horizontal_measures(used, measure, factor):
    found = used(VERTICAL_ACCURACY=1.0, GEOLOGIC_VARIATION=0.0, HORIZONTAL_ACCURACY=3.0 * factor,
                 HORIZONTAL_MEASURE=measure)  # fmt: skip
    assert found["horizontal_rmse"] == pytest.approx(3.0, abs=1e-3)


def test_zero_is_zero(used, tmp_path):
    used(VERTICAL_ACCURACY=0.0, GEOLOGIC_VARIATION=0.0)
    assert sigma_of(tmp_path) == pytest.approx(0.001)


def test_nothing_said_is_estimated(used, tmp_path):
    used()
    sigma = sigma_of(tmp_path)
    assert numpy.isfinite(sigma).all() and sigma.max() > 0.001


def test_gaussian_range_and_step(used):
    found = used(VERTICAL_ACCURACY=1.0, GEOLOGIC_VARIATION=2.0, GEOLOGIC_RANGE=15.0)
    assert found["geologic_range"] == 15.0 and found["geologic_model"] == "gaussian"
    found = used(VERTICAL_ACCURACY=1.0, GEOLOGIC_VARIATION=2.0, GEOLOGIC_RANGE=4.0, GEOLOGIC_MODEL="step")
    assert found["geologic_model"] == "step"


def test_the_nature_of_errors(used, tmp_path):
    found = used(VERTICAL_ACCURACY=1.0, GEOLOGIC_VARIATION=0.0, TAILS="student", CORRELATION_LENGTH=12.5, SHARED_BIAS=-0.5,
                 SAMPLES_OR_MEANS="means")  # fmt: skip
    said = [found[name] for name in ("tails", "correlation_length", "shared_bias", "samples_or_means")]
    assert said == ["student", 12.5, -0.5, "means"]
    found = used(VERTICAL_ACCURACY=1.0, GEOLOGIC_VARIATION=0.0, TAILS="auto", SAMPLES_OR_MEANS="auto", SHARED_BIAS=0.0)
    assert "shared_bias" not in found and "correlation_length" not in found
    found = used(RIDGE_GAIN=0.125)
    assert found["ridge_gain"] == 0.125 and "typical_m" in found["geologic_variation"]["from_dem"]


def test_products_stand_for_what_was_not_said(used, tmp_path):
    assert used(ERROR_PRODUCT="ned")["vertical_rmse"] == 1.55
    found = used(ERROR_PRODUCT="ned", VERTICAL_ACCURACY=0.4, GEOLOGIC_VARIATION=0.0)
    assert (found["vertical_rmse"], found["geologic_variation"]) == (0.4, 0.0)
    raster = scenes.write_dem(tmp_path / "e.tif", numpy.full((scenes.ROWS, scenes.COLS), 2.0, "float32"))
    assert "raster" in used(ERROR_PRODUCT="ned", ERROR_RASTER=str(raster))["vertical_rmse"]


def test_rasters(used, tmp_path):
    errors = numpy.where(numpy.arange(scenes.COLS) < 20, 1.0, 3.0)
    raster = scenes.write_dem(tmp_path / "errors.tif", numpy.tile(errors, (scenes.ROWS, 1)).astype("float32"))
    used(ERROR_RASTER=str(raster), GEOLOGIC_VARIATION=0.0)
    sigma = sigma_of(tmp_path)
    assert sigma[:, :18] == pytest.approx(1.0, abs=0.01) and sigma[:, 22:] == pytest.approx(3.0, abs=0.01)
    used(VERTICAL_ACCURACY=0.0, GEOLOGIC_RASTER=str(raster))
    sigma = sigma_of(tmp_path)
    assert sigma[:, 22:].min() > sigma[:, :18].max()


@pytest.mark.parametrize("table", [
    ["grassland", 0.5, "craggy", "6"], "grassland,0.5,craggy,6",
])  # fmt: skip
def test_terrain_types_with_a_table(used, tmp_path, table):
    types = scenes.write_terrain_types(tmp_path / "types.gpkg")
    used(**GIVEN, TERRAIN_TYPES=str(types), TERRAIN_FIELD="kind", TERRAIN_TABLE=table)
    sigma = sigma_of(tmp_path)
    assert sigma[:, :18] == pytest.approx(0.5 / 1.96, abs=0.01) and sigma[:, 22:] == pytest.approx(
        6 / 1.96, abs=0.01
    )


@pytest.mark.parametrize("name, text", [
    ("table.json", '{"grassland": 0.5, "craggy": 6}'), ("table.csv", "grassland,0.5\ncraggy,6\n"),
])  # fmt: skip
def test_terrain_table_from_a_file(used, tmp_path, name, text):
    (tmp_path / name).write_text(text)
    types = scenes.write_terrain_types(tmp_path / "types.gpkg")
    used(**GIVEN, TERRAIN_TYPES=str(types), TERRAIN_FIELD="kind", TERRAIN_TABLE=str(tmp_path / name))
    assert sigma_of(tmp_path)[:, 22:] == pytest.approx(6 / 1.96, abs=0.01)


def test_terrain_types_from_any_layer(used, tmp_path, context, run, dem):
    """A layer in memory, in another CRS, of which one polygon is filtered away."""
    import processing

    types = str(scenes.write_terrain_types(tmp_path / "types.gpkg"))
    parameters = {"INPUT": types, "TARGET_CRS": "EPSG:4326", "OUTPUT": "memory:"}
    layer = processing.run("native:reprojectlayer", parameters)["OUTPUT"]
    assert isinstance(layer, QgsVectorLayer)
    layer.setSubsetString("kind = 'craggy'")
    context.project().addMapLayer(layer)
    run("errorsurfaces", context=context, INPUT=dem, VERTICAL_ACCURACY=0.0, GEOLOGIC_VARIATION=0.0,
        TERRAIN_TYPES=layer.id(), TERRAIN_FIELD="kind", TERRAIN_TABLE=["craggy", 6],
        OUTPUT_SIGMA=str(tmp_path / "sigma.tif"))  # fmt: skip
    assert sigma_of(tmp_path)[:, 22:] == pytest.approx(6 / 1.96, abs=0.01)


def test_error_model_file_replaces_the_rest(run, dem, tmp_path, log):
    recipe = tmp_path / "model.json"
    first = run("errorsurfaces", INPUT=dem, VERTICAL_ACCURACY=2.5, GEOLOGIC_VARIATION=0.0, OUTPUT_MODEL=str(recipe),
                OUTPUT_SIGMA=QgsProcessing.TEMPORARY_OUTPUT)  # fmt: skip
    second = run("errorsurfaces", feedback=log, INPUT=dem, VERTICAL_ACCURACY=9.0, ERROR_MODEL=str(recipe),
                 OUTPUT_SIGMA=QgsProcessing.TEMPORARY_OUTPUT)  # fmt: skip
    assert second["ERROR_MODEL_USED"] == first["ERROR_MODEL_USED"]
    assert any("VERTICAL_ACCURACY" in text for text in log.warnings)
