# SPDX-License-Identifier: GPL-3.0-or-later
"""sightbound:confidenceviewshed through processing.run."""

import json
from pathlib import Path

import numpy
import pytest
import scenes
from osgeo import gdal
from qgis.core import (
    QgsProcessing,
    QgsProcessingException,
    QgsProcessingFeatureSourceDefinition,
    QgsProperty,
    QgsVectorLayer,
)

POINT = f"{scenes.FIRST[0]},{scenes.FIRST[1]} [EPSG:{scenes.UTM}]"


def test_confidence_and_verdict_are_written(run, dem, observers, tmp_path, log):
    out = {name: str(tmp_path / f"{name}.tif") for name in ("OUTPUT", "OUTPUT_VERDICT", "OUTPUT_COUNT")}
    results = run(
        "confidenceviewshed", feedback=log, INPUT=dem, OBSERVERS=observers, VERTICAL_ACCURACY=0.5, **out
    )
    p, dataset = scenes.read(results["OUTPUT"])
    assert p.dtype == numpy.float32 and p.shape == (scenes.ROWS, scenes.COLS)
    assert numpy.isnan(dataset.GetRasterBand(1).GetNoDataValue())
    assert numpy.nanmin(p) >= 0.0 and numpy.nanmax(p) <= 1.0 and len(numpy.unique(p)) > 10
    verdict, dataset = scenes.read(results["OUTPUT_VERDICT"])
    assert verdict.dtype == numpy.uint8 and dataset.GetRasterBand(1).GetNoDataValue() == 255
    sure = numpy.abs(p - 0.5) < 0.4749
    assert set(numpy.unique(verdict)) <= {0, 1, 2, 255} and (verdict[sure] == 1).all()
    count, dataset = scenes.read(results["OUTPUT_COUNT"])
    assert dataset.GetRasterBand(1).DataType == gdal.GDT_UInt32 and ((count > 0) == (verdict == 2)).all()
    assert log.fractions == sorted(log.fractions) and log.fractions[-1] == 100.0


def test_areas_are_those_of_the_verdict(run, dem, observers):
    results = run(
        "confidenceviewshed", INPUT=dem, OBSERVERS=observers, VERTICAL_ACCURACY=0.5,
        OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, OUTPUT_VERDICT=QgsProcessing.TEMPORARY_OUTPUT,
    )  # fmt: skip
    verdict, _ = scenes.read(results["OUTPUT_VERDICT"])
    for number, name in enumerate(("HIDDEN", "UNCERTAIN", "VISIBLE")):
        cells = (verdict == number).sum()
        assert results[f"AREA_{name}"] == pytest.approx(cells * scenes.CELL**2, rel=2e-3)
        assert results[f"SHARE_{name}"] == pytest.approx(cells / (verdict != 255).sum(), abs=2e-3)


def test_one_point_gives_the_same_as_a_layer_with_that_point(run, dem, tmp_path):
    layer = scenes.write_observers(tmp_path / "one.gpkg", places=[scenes.FIRST])
    common = {"INPUT": dem, "VERTICAL_ACCURACY": 1.0, "OUTPUT": QgsProcessing.TEMPORARY_OUTPUT}
    by_layer = run("confidenceviewshed", OBSERVERS=str(layer), **common)
    by_point = run("confidenceviewshed", OBSERVER=POINT, **common)
    assert numpy.array_equal(*(scenes.read(one["OUTPUT"])[0] for one in (by_layer, by_point)), equal_nan=True)


def test_observers_in_another_crs_are_transformed(run, dem, tmp_path):
    def transformed(place):
        to = scenes.osr.CoordinateTransformation(scenes.reference(scenes.UTM), scenes.reference(4326))
        return to.TransformPoint(*place)[:2]

    common = {"INPUT": dem, "VERTICAL_ACCURACY": 1.0, "OUTPUT": QgsProcessing.TEMPORARY_OUTPUT}
    here = scenes.write_observers(tmp_path / "utm.gpkg", places=[scenes.FIRST])
    there = scenes.write_observers(tmp_path / "wgs84.gpkg", places=[transformed(scenes.FIRST)], crs=4326)
    results = [run("confidenceviewshed", OBSERVERS=str(layer), **common) for layer in (here, there)]
    p, q = (scenes.read(one["OUTPUT"])[0] for one in results)
    assert numpy.nanmax(numpy.abs(p - q)) < 0.01


def test_max_distance_is_metres_for_a_dem_in_degrees(run, tmp_path):
    dem = str(scenes.write_dem_in_degrees(tmp_path / "degrees.tif"))
    _, dataset = scenes.read(dem)
    x0, width, _, y0, _, height = dataset.GetGeoTransform()
    observer = f"{x0 + 20.5 * width},{y0 + 15.5 * height} [EPSG:4326]"
    results = run("confidenceviewshed", INPUT=dem, OBSERVER=observer, MAX_DISTANCE=85.0, OUTPUT=str(tmp_path / "p.tif"),
                  OUTPUT_VERDICT=QgsProcessing.TEMPORARY_OUTPUT)  # fmt: skip
    p, _ = scenes.read(results["OUTPUT"])
    cells = numpy.isfinite(p).sum()
    assert cells == pytest.approx(numpy.pi * 8.5**2, rel=0.06)
    total = sum(results[f"AREA_{name}"] for name in ("VISIBLE", "UNCERTAIN", "HIDDEN"))
    assert total == pytest.approx(cells * 100.0, rel=0.01)


@pytest.mark.parametrize(
    "height", [QgsProperty.fromField("eye"), QgsProperty.fromExpression('"eye" * 2 / 2')]
)
def test_heights_come_from_a_field_or_an_expression(run, dem, observers, height):
    common = {"INPUT": dem, "OBSERVERS": observers, "OUTPUT": QgsProcessing.TEMPORARY_OUTPUT}
    table = run("confidenceviewshed", OBSERVER_HEIGHT=height, OUTPUT_OBSERVERS="memory:", **common)[
        "OUTPUT_OBSERVERS"
    ]
    above = [feature["eye_height"] - feature["ground_height"] for feature in table.getFeatures()]
    assert above == pytest.approx([1.7, 8.0], abs=1e-3)


def test_heights_come_from_a_field_by_name(run, dem, observers):
    table = run("confidenceviewshed", INPUT=dem, OBSERVERS=observers, OBSERVER_HEIGHT_FIELD="eye",
                OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, OUTPUT_OBSERVERS="memory:")["OUTPUT_OBSERVERS"]  # fmt: skip
    above = [feature["eye_height"] - feature["ground_height"] for feature in table.getFeatures()]
    assert above == pytest.approx([1.7, 8.0], abs=1e-3)


def test_limits_may_differ_by_observer(run, dem, observers, tmp_path):
    folder = tmp_path / "each"
    run("confidenceviewshed", INPUT=dem, OBSERVERS=observers, MAX_DISTANCE=QgsProperty.fromField("reach"),
        OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, OUTPUT_FOLDER=str(folder), ID_FIELD="name")  # fmt: skip
    near, far = (scenes.read(folder / name)[0] for name in ("tower_a_b.tif", "hut.tif"))
    assert numpy.isfinite(near).sum() == pytest.approx(numpy.pi * 6**2, rel=0.1)
    assert numpy.isfinite(far).sum() == pytest.approx(numpy.pi * 12**2, rel=0.2)


def test_sector_is_clockwise_from_north(run, dem):
    results = run("confidenceviewshed", INPUT=dem, OBSERVER=POINT, AZIMUTH_FROM=350, AZIMUTH_TO=10,
                  OUTPUT=QgsProcessing.TEMPORARY_OUTPUT)  # fmt: skip
    p, dataset = scenes.read(results["OUTPUT"])
    x0, width, _, y0, _, height = dataset.GetGeoTransform()
    rows, cols = numpy.nonzero(numpy.isfinite(p))
    east = x0 + (cols + 0.5) * width - scenes.FIRST[0]
    north = y0 + (rows + 0.5) * height - scenes.FIRST[1]
    elsewhere = numpy.hypot(east, north) > scenes.CELL
    assert elsewhere.any() and (north[elsewhere] > 0).all() and (abs(east) < 0.2 * north)[elsewhere].all()


def test_folder_holds_one_styled_raster_per_observer(run, dem, tmp_path):
    layer = scenes.write_observers(tmp_path / "twins.gpkg", names=("twin", "TWIN"))
    folder = tmp_path / "new" / "folder"
    results = run("confidenceviewshed", INPUT=dem, OBSERVERS=str(layer), ID_FIELD="name", MAX_DISTANCE=60,
                  OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, OUTPUT_FOLDER=str(folder))  # fmt: skip
    assert Path(results["OUTPUT_FOLDER"]) == folder
    assert sorted(one.name for one in folder.iterdir()) == [
        "TWIN_2.qml",
        "TWIN_2.tif",
        "twin.qml",
        "twin.tif",
    ]
    p, _ = scenes.read(folder / "twin.tif")
    assert max(p.shape) < 25


def test_folder_is_replaced_whole_or_not_at_all(run, dem, observers, tmp_path):
    folder = tmp_path / "each"
    how = {"INPUT": dem, "OBSERVERS": observers, "ID_FIELD": "name", "MAX_DISTANCE": 60, "OUTPUT_FOLDER": str(folder),
           "OUTPUT": QgsProcessing.TEMPORARY_OUTPUT}  # fmt: skip
    run("confidenceviewshed", **how)
    stale = folder / "hut.tif.aux.xml"
    stale.write_text("statistics of an older raster")
    before = {one.name: one.read_bytes() for one in folder.iterdir()}
    run("confidenceviewshed", **how, TARGET_HEIGHT=20)
    after = {one.name: one.read_bytes() for one in folder.iterdir()}
    assert after["hut.tif"] != before["hut.tif"] and set(before) - set(after) == {stale.name}
    (folder / "tower_a_b.tif").unlink()
    (folder / "tower_a_b.tif").mkdir()  # in the way of the last file
    with pytest.raises(QgsProcessingException, match="OUTPUT_FOLDER"):
        run("confidenceviewshed", **how)
    del after["tower_a_b.tif"]
    assert {one.name: one.read_bytes() for one in folder.iterdir() if one.is_file()} == after
    assert {one.name for one in folder.iterdir() if one.is_dir()} == {"tower_a_b.tif"}


def test_table_keeps_the_attributes_and_adds_areas(run, dem, observers):
    results = run("confidenceviewshed", INPUT=dem, OBSERVERS=observers, OUTPUT=QgsProcessing.TEMPORARY_OUTPUT,
                  OUTPUT_VERDICT=QgsProcessing.TEMPORARY_OUTPUT, OUTPUT_OBSERVERS="memory:")  # fmt: skip
    rows = list(results["OUTPUT_OBSERVERS"].getFeatures())
    assert [row["name"] for row in rows] == ["tower a/b", "hut"] and {row["status"] for row in rows} == {"ok"}
    for row in rows:
        assert row["ground_height"] == pytest.approx(100.0, abs=20.0)
        total = row["visible_m2"] + row["uncertain_m2"] + row["hidden_m2"]
        assert total == pytest.approx(scenes.ROWS * scenes.COLS * scenes.CELL**2, rel=2e-3)


def test_selected_observers_only(run, dem, observers, context):
    layer = QgsVectorLayer(observers, "observers")
    context.project().addMapLayer(layer)
    layer.selectByIds([2])
    source = QgsProcessingFeatureSourceDefinition(layer.id(), True)
    results = run("confidenceviewshed", context=context, INPUT=dem, OBSERVERS=source,
                  OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, OUTPUT_OBSERVERS="memory:")  # fmt: skip
    assert [row["name"] for row in results["OUTPUT_OBSERVERS"].getFeatures()] == ["hut"]


def test_heights_are_written_when_asked_for(run, dem, observers):
    results = run("confidenceviewshed", INPUT=dem, OBSERVERS=observers, VERTICAL_ACCURACY=1.0,
                  **{name: QgsProcessing.TEMPORARY_OUTPUT
                     for name in ("OUTPUT", "OUTPUT_VERDICT", "OUTPUT_HEIGHT", "OUTPUT_HEIGHT_LIKELY")})  # fmt: skip
    certain, likely = (scenes.read(results[name])[0] for name in ("OUTPUT_HEIGHT", "OUTPUT_HEIGHT_LIKELY"))
    verdict, _ = scenes.read(results["OUTPUT_VERDICT"])
    assert (certain[verdict == 2] < 0.11).all() and (certain[verdict == 0] > 0.0).all()
    assert (likely <= certain + 0.2).all() and (likely >= 0.0).all()


def test_extent_is_computed_alone_and_changes_nothing(run, dem, observers):
    common = {"INPUT": dem, "OBSERVERS": observers, "VERTICAL_ACCURACY": 1.0}
    box = f"{scenes.WEST + 200},{scenes.WEST + 300},{scenes.NORTH - 200},{scenes.NORTH - 100} [EPSG:{scenes.UTM}]"
    whole = run("confidenceviewshed", OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, **common)
    part = run("confidenceviewshed", OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, EXTENT=box, **common)
    p, q = (scenes.read(one["OUTPUT"])[0] for one in (whole, part))
    assert q.shape == (10, 10) and numpy.array_equal(p[10:20, 20:30], q, equal_nan=True)


def test_worst_is_never_above_best(run, dem, observers):
    common = {"INPUT": dem, "OBSERVERS": observers, "VERTICAL_ACCURACY": 1.0}
    best, worst = (
        scenes.read(
            run("confidenceviewshed", COMBINE=how, OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, **common)["OUTPUT"]
        )[0]
        for how in ("best", "worst")
    )
    assert (worst <= best).all() and (worst < best).any()


def test_number_of_threads_does_not_change_the_result(run, dem, observers):
    common = {"INPUT": dem, "OBSERVERS": observers}
    one, two = (
        scenes.read(
            run("confidenceviewshed", THREADS=n, OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, **common)["OUTPUT"]
        )[0]
        for n in (1, 2)
    )
    assert numpy.array_equal(one, two, equal_nan=True)


def test_creation_options_reach_the_file(run, dem, observers):
    results = run("confidenceviewshed", INPUT=dem, OBSERVERS=observers, CREATION_OPTIONS="COMPRESS=LZW|TILED=NO",
                  OUTPUT=QgsProcessing.TEMPORARY_OUTPUT)  # fmt: skip
    _, dataset = scenes.read(results["OUTPUT"])
    assert dataset.GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE") == "LZW"


def test_error_model_is_logged_and_in_the_metadata(run, dem, observers, log):
    results = run("confidenceviewshed", feedback=log, INPUT=dem, OBSERVERS=observers, VERTICAL_ACCURACY=1.6449,
                  VERTICAL_MEASURE="LE90", GEOLOGIC_VARIATION=0.0, OUTPUT=QgsProcessing.TEMPORARY_OUTPUT)  # fmt: skip
    used = json.loads(results["ERROR_MODEL_USED"])
    assert used["vertical_rmse"] == pytest.approx(1.0, abs=1e-4) and used["geologic_variation"] == 0.0
    assert any(json.dumps(used) in text for text in log.infos)
    _, dataset = scenes.read(results["OUTPUT"])
    kept = {key: value for key, value in dataset.GetMetadata().items() if key.startswith("SIGHTBOUND_")}
    assert json.loads(kept["SIGHTBOUND_ERROR_MODEL"]) == used


def test_crs_given_in_qgis_is_used(run, tmp_path, context, log):
    from qgis.core import QgsCoordinateReferenceSystem, QgsRasterLayer

    layer = QgsRasterLayer(str(scenes.write_dem(tmp_path / "plain.tif", crs=None)), "plain")
    layer.setCrs(QgsCoordinateReferenceSystem(f"EPSG:{scenes.UTM}"))
    context.project().addMapLayer(layer)
    results = run("confidenceviewshed", feedback=log, context=context, INPUT=layer.id(), OBSERVER=POINT,
                  OUTPUT=str(tmp_path / "p.tif"))  # fmt: skip
    _, dataset = scenes.read(tmp_path / "p.tif")
    assert results["AREA_VISIBLE"] > 0.0 and "32633" in dataset.GetProjection()
    assert any(f"EPSG:{scenes.UTM}" in text for text in log.infos)
