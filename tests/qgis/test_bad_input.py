# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input raises QgsProcessingException that names the parameter and the remedy."""

import numpy
import pytest
import scenes
from osgeo import gdal, ogr
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessing,
    QgsProcessingException,
    QgsProperty,
    QgsRasterLayer,
)

POINT = f"{scenes.FIRST[0]},{scenes.FIRST[1]} [EPSG:{scenes.UTM}]"


@pytest.fixture
def refused(run, dem):
    """Runs an algorithm that must refuse, and returns its message."""

    def message(algorithm="confidenceviewshed", **parameters):
        output = {
            "confidenceviewshed": "OUTPUT",
            "errorsurfaces": "OUTPUT_SIGMA",
            "lineofsightprofile": "OUTPUT",
        }
        parameters = {"INPUT": dem, output[algorithm]: QgsProcessing.TEMPORARY_OUTPUT, **parameters}
        with pytest.raises(QgsProcessingException) as raised:
            run(algorithm, **parameters)
        return str(raised.value)

    return message


def says(message, *words):
    missing = [word for word in words if word not in message]
    assert missing == [], message
    return True


def test_exactly_one_kind_of_observer(refused, observers):
    assert says(refused(), "OBSERVERS:", "OBSERVER")
    assert says(refused(OBSERVERS=observers, OBSERVER=POINT), "OBSERVERS:", "not both")


@pytest.mark.parametrize(
    "parameters, words",
    [
        ({"CONFIDENCE": 1.0}, ("CONFIDENCE:", "0.95")),
        ({"CONFIDENCE": 0.0}, ("CONFIDENCE:", "0.95")),
        ({"VERTICAL_ACCURACY": 1.0, "ERROR_RASTER": "INPUT"}, ("VERTICAL_ACCURACY:", "ERROR_RASTER")),
        ({"GEOLOGIC_VARIATION": 1.0, "GEOLOGIC_RASTER": "INPUT"}, ("GEOLOGIC_VARIATION:", "GEOLOGIC_RASTER")),
        ({"GEOLOGIC_MODEL": "step"}, ("GEOLOGIC_RANGE:", "step")),
        ({"GEOLOGIC_RANGE": 10.0}, ("GEOLOGIC_RANGE", "GEOLOGIC_VARIATION")),
        ({"OBSERVER_HEIGHT_FIELD": "eye"}, ("OBSERVER_HEIGHT_FIELD:", "OBSERVERS")),
        ({"BAND": 7}, ("BAND:", "7", "1")),
        ({"MIN_DISTANCE": 50.0, "MAX_DISTANCE": 20.0}, ("MIN_DISTANCE:", "50", "MAX_DISTANCE")),
        ({"CREATION_OPTIONS": "LZW"}, ("CREATION_OPTIONS:", "KEY=VALUE")),
        ({"EXTENT": "0,1,0,1 [EPSG:32633]"}, ("EXTENT:", "INPUT")),
        ({"ERROR_MODEL": "/nowhere/model.json"}, ("ERROR_MODEL:", "/nowhere/model.json")),
        ({"OUTPUT": "/nowhere/p.tif"}, ("OUTPUT:", "/nowhere")),
        ({"OBSERVER": "0,0 [EPSG:32633]"}, ("OBSERVER:", "outside INPUT", "CRS")),
        ({"OBSERVER_HEIGHT": QgsProperty.fromField("eye")}, ("OBSERVER_HEIGHT:", "NULL")),
    ],
)
def test_values_that_cannot_be(refused, dem, parameters, words):
    parameters = {name: dem if value == "INPUT" else value for name, value in parameters.items()}
    assert says(refused(**{"OBSERVER": POINT, **parameters}), *words)


@pytest.mark.parametrize("name, value", [
    ("COMBINE", "all"), ("HEIGHT_REFERENCE", "sea"), ("THREADS", 0), ("MAX_DISTANCE", -5.0), ("AZIMUTH_FROM", 1000.0),
])  # fmt: skip
def test_values_outside_their_definition_are_refused_by_name(refused, name, value):
    assert says(refused(OBSERVER=POINT, **{name: value}), name)


def test_error_model_must_be_one(refused, tmp_path):
    broken = tmp_path / "model.json"
    broken.write_text('{"vertical_rmse": "much"}')
    assert says(refused(OBSERVER=POINT, ERROR_MODEL=str(broken)), "ERROR_MODEL")


def test_null_height_names_the_feature(refused, tmp_path):
    layer = str(scenes.write_observers(tmp_path / "null.gpkg", heights=(1.7, None)))
    for height in ({"OBSERVER_HEIGHT_FIELD": "eye"}, {"OBSERVER_HEIGHT": QgsProperty.fromField("eye")}):
        assert says(refused(OBSERVERS=layer, **height), "OBSERVER_HEIGHT:", "NULL", "feature 2 of OBSERVERS")


def test_field_and_expression_contradict_each_other(refused, observers):
    heights = {"OBSERVER_HEIGHT_FIELD": "eye", "OBSERVER_HEIGHT": QgsProperty.fromField("eye")}
    assert says(refused(OBSERVERS=observers, **heights), "OBSERVER_HEIGHT:", "one of them")


def test_varying_values_have_the_limits_of_the_parameter(refused, observers):
    far = QgsProperty.fromExpression("-1 * $id")
    assert says(
        refused(OBSERVERS=observers, MAX_DISTANCE=far), "MAX_DISTANCE:", "-1", "feature 1 of OBSERVERS"
    )
    text = QgsProperty.fromField("name")
    assert says(refused(OBSERVERS=observers, TARGET_HEIGHT=text), "TARGET_HEIGHT:", "feature 1 of OBSERVERS")


def test_missing_field_lists_those_there_are(refused, observers):
    assert says(
        refused(OBSERVERS=observers, OBSERVER_HEIGHT_FIELD="size"), "OBSERVER_HEIGHT_FIELD:", "'size'", "eye"
    )


def test_observer_outside_names_the_feature(refused, tmp_path):
    layer = scenes.write_observers(tmp_path / "far.gpkg", places=(scenes.FIRST, (0.0, 0.0)))
    assert says(refused(OBSERVERS=str(layer)), "OBSERVERS:", "feature 2", "outside INPUT")


def test_observer_on_nodata_names_the_feature(refused, tmp_path):
    heights = scenes.hills()
    heights[18:23, 28:33] = -9999.0
    dem = str(scenes.write_dem(tmp_path / "hole.tif", heights))
    layer = str(scenes.write_observers(tmp_path / "on_hole.gpkg"))
    assert says(refused(INPUT=dem, OBSERVERS=layer), "OBSERVERS", "feature 2 of OBSERVERS", "nodata")
    lines = {"algorithm": "lineofsightprofile", "INPUT": dem}
    near = str(scenes.write_observers(tmp_path / "near.gpkg", places=[scenes.FIRST]))
    assert says(refused(**lines, OBSERVERS=near, TARGETS=layer), "TARGETS", "feature 2 of TARGETS", "nodata")
    point = f"{scenes.SECOND[0]},{scenes.SECOND[1]} [EPSG:{scenes.UTM}]"
    assert says(refused(INPUT=dem, OBSERVER=point), "OBSERVER:", "nodata")


def test_feature_without_a_point(refused, tmp_path):
    layer = str(scenes.write_observers(tmp_path / "empty.gpkg"))
    source = ogr.Open(layer, update=1)
    source.GetLayer(0).CreateFeature(ogr.Feature(source.GetLayer(0).GetLayerDefn()))
    source = None
    assert says(refused(OBSERVERS=layer), "OBSERVERS:", "feature 3", "no point")


def test_layer_without_features(refused, tmp_path):
    layer = str(scenes.write_observers(tmp_path / "none.gpkg", places=()))
    assert says(refused(OBSERVERS=layer), "OBSERVERS:", "no points")


def test_dem_in_memory(refused, context):
    scenes.write_dem("/vsimem/dem.tif")
    layer = QgsRasterLayer("/vsimem/dem.tif", "in memory")
    assert layer.isValid()
    assert says(refused(INPUT=layer, OBSERVER=POINT), "INPUT:", "memory", "GeoTIFF")
    gdal.Unlink("/vsimem/dem.tif")


def test_dem_that_is_no_file(refused):
    uri = "crs=EPSG:3857&format&type=xyz&url=http://localhost/%7Bz%7D/%7Bx%7D/%7By%7D.png&zmax=1&zmin=0"
    layer = QgsRasterLayer(uri, "tiles", "wms")
    assert layer.isValid()
    assert says(refused(INPUT=layer, OBSERVER=POINT), "INPUT:", "wms", "GeoTIFF")


def test_dem_in_degrees_without_a_crs(refused, tmp_path):
    dem = scenes.write_raster(tmp_path / "bare.tif", scenes.hills(), (10.0, 0.001, 0, 60.0, 0, -0.001), None)
    assert says(refused(INPUT=str(dem), OBSERVER="10.01,59.99"), "INPUT", "CRS")


def test_unknown_terrain_type_is_listed(refused, tmp_path):
    types = str(scenes.write_terrain_types(tmp_path / "types.gpkg", kinds=("grassland", "moon")))
    common = {"algorithm": "errorsurfaces", "TERRAIN_TYPES": types}
    assert says(refused(**common), "TERRAIN_FIELD:", "TERRAIN_TYPES")
    assert says(refused(**common, TERRAIN_FIELD="kind"), "TERRAIN_TYPES:", "moon", "craggy")
    assert says(refused(**common, TERRAIN_FIELD="sort"), "TERRAIN_FIELD:", "'sort'", "kind")


@pytest.mark.parametrize("table", ["grassland,0.5,craggy", "grassland,soft", "/nowhere/table.csv"])
def test_terrain_table_that_is_none(refused, tmp_path, table):
    types = str(scenes.write_terrain_types(tmp_path / "types.gpkg"))
    common = {"algorithm": "errorsurfaces", "TERRAIN_TYPES": types, "TERRAIN_FIELD": "kind"}
    assert says(refused(**common, TERRAIN_TABLE=table), "TERRAIN_TABLE:")


def test_error_raster_elsewhere(refused, tmp_path):
    values = numpy.ones((5, 5), "float32")
    elsewhere = scenes.write_raster(tmp_path / "off.tif", values, (0.0, 10.0, 0, 100.0, 0, -10.0), scenes.UTM)
    assert says(refused("errorsurfaces", ERROR_RASTER=str(elsewhere)), "ERROR_RASTER:")


def test_pairs(refused, observers, tmp_path):
    common = {"algorithm": "lineofsightprofile", "OBSERVERS": observers, "TARGETS": observers}
    assert says(refused(**common, PAIRING="field"), "OBSERVER_FIELD:", "PAIRING")
    assert says(refused(**common, MAX_DISTANCE=1.0), "MAX_DISTANCE:", "target")
    same = {"OBSERVER_FIELD": "name", "TARGET_FIELD": "eye"}
    assert says(refused(**common, PAIRING="field", **same), "TARGET_FIELD:")
    alone = str(scenes.write_observers(tmp_path / "alone.gpkg", places=[scenes.FIRST]))
    common = {"algorithm": "lineofsightprofile", "OBSERVERS": alone, "TARGETS": alone}
    assert says(refused(**common), "TARGETS:")


def test_crs_is_named_in_the_layer_not_lost(refused, dem):
    assert QgsCoordinateReferenceSystem("EPSG:32633").isValid()
    assert says(refused(OBSERVER="5,5 [EPSG:4326]"), "OBSERVER:", "CRS")
