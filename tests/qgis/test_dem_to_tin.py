# SPDX-License-Identifier: GPL-3.0-or-later
"""DEM to TIN through processing.run: files, numbers, layers, and what is refused."""

import json

import pytest
import scenes
from qgis.core import (
    QgsFeature,
    QgsGeometry,
    QgsMesh,
    QgsMeshDatasetIndex,
    QgsMeshLayer,
    QgsPointXY,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingUtils,
    QgsProject,
    QgsRectangle,
    QgsVectorLayer,
)


def simplify(run, dem, folder, **more):
    return run("demtotin", **{"INPUT": dem, "TOLERANCE": 1.0, "OUTPUT": str(folder / "tin.ply"), **more})


def test_mesh_polygons_and_numbers(run, dem, tmp_path):
    polygons, log = str(tmp_path / "tin.gpkg"), scenes.Log()
    found = simplify(run, dem, tmp_path, OUTPUT_POLYGONS=polygons, feedback=log)
    assert found["TRIANGLES"] < 0.5 * found["TRIANGLES_BEFORE"] == 0.5 * 2 * 39 * 29
    assert 0.5 < found["LARGEST_DEVIATION"] <= 1.0 and found["LARGEST_RATIO"] <= 1.0
    mesh = QgsMeshLayer(found["OUTPUT"], "tin", "mdal")
    assert mesh.isValid() and mesh.crs().authid() == "EPSG:32633" and mesh.meshFaceCount() == found["TRIANGLES"]
    names = {mesh.datasetGroupMetadata(QgsMeshDatasetIndex(group)).name() for group in mesh.datasetGroupsIndexes()}
    assert names == {"Bed Elevation", "deviation", "bound_used", "tolerance", "deviation_around"}
    rows = scenes.rows_of(polygons)
    assert len(rows) == found["TRIANGLES"]
    assert max(row["deviation"] for row in rows) == pytest.approx(found["LARGEST_DEVIATION"])
    assert any("Triangles of the TIN" in line for line in log.infos) and log.warnings == []


def test_an_accuracy_is_a_tolerance_at_the_confidence(run, dem, tmp_path):
    error = {"TOLERANCE": None, "VERTICAL_ACCURACY": 0.5, "GEOLOGIC_VARIATION": 0.0}
    found = simplify(run, dem, tmp_path, **error)
    assert 0.5 < found["LARGEST_DEVIATION"] <= 0.98
    assert json.loads(found["ERROR_MODEL_USED"])["vertical_rmse"] == 0.5
    surer = simplify(run, dem, tmp_path, CONFIDENCE=0.999, **error)
    assert surer["TRIANGLES"] < found["TRIANGLES"]


def test_a_raster_of_tolerances(run, dem, tmp_path):
    values = scenes.hills() * 0 + 0.25
    values[:, 20:] = 3.0
    transform = (scenes.WEST, scenes.CELL, 0, scenes.NORTH, 0, -scenes.CELL)
    path = str(tmp_path / "tolerance.tif")
    scenes.write_raster(path, values, transform, scenes.UTM)
    found = simplify(run, dem, tmp_path, TOLERANCE=None, TOLERANCE_RASTER=path)
    assert 1.0 < found["LARGEST_DEVIATION"] <= 3.0
    assert found["TRIANGLES"] > simplify(run, dem, tmp_path, TOLERANCE=3.0)["TRIANGLES"]


def test_the_mesh_is_loaded_with_edges_and_the_heights_colours(provider, dem, tmp_path, log):
    context, project = QgsProcessingContext(), QgsProject()
    context.setProject(project)
    parameters = {"INPUT": dem, "TOLERANCE": 1.0, "OUTPUT": str(tmp_path / "tin.ply")}
    results, done = provider.algorithm("demtotin").create().run(parameters, context, log)
    assert done, log.errors
    details = context.layersToLoadOnCompletion()[results["OUTPUT"]]
    layer = QgsProcessingUtils.mapLayerFromString(results["OUTPUT"], context, True, details.layerTypeHint)
    details.postProcessor().postProcessLayer(layer, context, log)
    settings = layer.rendererSettings()
    assert settings.nativeMeshSettings().isEnabled() and settings.activeScalarDatasetGroup() == 0
    heights = settings.scalarSettings(0)
    assert 80 < heights.classificationMinimum() < heights.classificationMaximum() < 125
    stops = [item.value for item in heights.colorRampShader().colorRampItemList()]
    assert stops[0] == pytest.approx(heights.classificationMinimum()) and stops == sorted(stops)
    for group in layer.datasetGroupsIndexes()[1:]:
        scalar, largest = settings.scalarSettings(group), layer.datasetGroupMetadata(QgsMeshDatasetIndex(group)).maximum()
        stops = [item.value for item in scalar.colorRampShader().colorRampItemList()]
        assert stops[0] == 0 and stops[-1] == scalar.classificationMaximum() == pytest.approx(largest)


def test_views_of_observers_stay(run, dem, tmp_path):
    points = str(scenes.write_points(tmp_path / "eye.gpkg", [(scenes.WEST + 105.0, scenes.NORTH - 105.0, {})], {}))
    views = {"OBSERVERS": points, "OBSERVER_HEIGHT": 2.0, "VERTICAL_ACCURACY": 0.3, "GEOLOGIC_VARIATION": 0.0}
    log = scenes.Log()
    kept = simplify(run, dem, tmp_path, TOLERANCE=8.0, feedback=log, **views)
    assert kept["TRIANGLES"] > simplify(run, dem, tmp_path, TOLERANCE=8.0)["TRIANGLES"]
    assert any("free to move" in line for line in log.infos)
    with pytest.raises(QgsProcessingException, match="TOLERANCE"):
        simplify(run, dem, tmp_path, TOLERANCE=None, **views)
    with pytest.raises(QgsProcessingException, match="OBSERVERS"):
        away = str(scenes.write_points(tmp_path / "away.gpkg", [(scenes.WEST - 1000.0, scenes.NORTH, {})], {}))
        simplify(run, dem, tmp_path, TOLERANCE=8.0, **{**views, "OBSERVERS": away})


def test_degrees_are_refused_before_views_are_asked_for(run, tmp_path):
    path = tmp_path / "degrees.tif"
    scenes.write_raster(path, scenes.hills(), (11.0, 0.001, 0.0, 47.0, 0.0, -0.001), 4326)
    points = str(scenes.write_points(tmp_path / "eye.gpkg", [(11.0105, 46.9895, {})], {}, crs=4326))
    log = scenes.Log()
    with pytest.raises(QgsProcessingException, match="degrees"):
        simplify(run, str(path), tmp_path, TOLERANCE=8.0, OBSERVERS=points, VERTICAL_ACCURACY=0.3, feedback=log)
    assert log.infos == log.warnings == log.fractions == []


def test_tiles_and_targets(run, dem, tmp_path):
    kept = simplify(run, dem, tmp_path, TOLERANCE=20.0, KEEP_BORDER=True)
    assert kept["TRIANGLES"] >= 2 * (39 + 29) - 2 > simplify(run, dem, tmp_path, TOLERANCE=20.0)["TRIANGLES"]
    assert abs(simplify(run, dem, tmp_path, TOLERANCE=20.0, TARGET_TRIANGLES=300)["TRIANGLES"] - 300) <= 2
    small = simplify(run, dem, tmp_path, TOLERANCE=20.0, TARGET_SIZE=0.01, OUTPUT=str(tmp_path / "small.ply"))
    assert 9_900 < (tmp_path / "small.ply").stat().st_size <= 10_000 and small["TRIANGLES"] > 240


def test_places_to_keep(run, dem, observers, tmp_path):
    plain = simplify(run, dem, tmp_path, TOLERANCE=20.0)
    kept = simplify(run, dem, tmp_path, TOLERANCE=20.0, KEEP=observers)
    assert kept["TRIANGLES"] > plain["TRIANGLES"]
    mesh = QgsMeshLayer(kept["OUTPUT"], "tin", "mdal")
    extent = mesh.extent()
    assert extent.xMinimum() == scenes.WEST + 5 and extent.yMaximum() == scenes.NORTH - 5


def test_break_lines_stay_edges(run, dem, tmp_path):
    y = scenes.NORTH - 10.5 * scenes.CELL
    ends = [(scenes.WEST + c * scenes.CELL, y) for c in (4.5, 30.5)]
    lines = QgsVectorLayer("LineString?crs=EPSG:32633", "lines", "memory")
    feature = QgsFeature()
    feature.setGeometry(QgsGeometry.fromPolylineXY([QgsPointXY(*end) for end in ends]))
    lines.dataProvider().addFeatures([feature])
    found = simplify(run, dem, tmp_path, TOLERANCE=50.0, BREAK_LINES=lines, BREAK_LINE_TOLERANCE=0.0)
    mesh = QgsMeshLayer(found["OUTPUT"], "tin", "mdal")
    triangles = QgsMesh()
    mesh.dataProvider().populateMesh(triangles)
    along = 0.0
    for n in range(triangles.faceCount()):
        face = [triangles.vertex(v) for v in triangles.face(n)]
        for a, b in zip(face, face[1:] + face[:1]):
            if abs(a.y() - y) < 1e-3 and abs(b.y() - y) < 1e-3:
                along += abs(a.x() - b.x()) / 2
    assert along == pytest.approx(26 * scenes.CELL)
    assert simplify(run, dem, tmp_path, TOLERANCE=50.0)["TRIANGLES"] < found["TRIANGLES"]


def test_the_outline_moves_where_it_may(run, tmp_path):
    heights = scenes.hills()
    rows, cols = heights.shape
    for row in range(rows):
        heights[row, : row * cols // (2 * rows)] = float("nan")
    path = str(tmp_path / "coast.tif")
    transform = (scenes.WEST, scenes.CELL, 0, scenes.NORTH, 0, -scenes.CELL)
    scenes.write_raster(path, heights, transform, scenes.UTM)
    still = simplify(run, path, tmp_path, TOLERANCE=20.0)
    moved = simplify(run, path, tmp_path, TOLERANCE=20.0, BORDER_TOLERANCE=scenes.CELL)
    assert moved["TRIANGLES"] < 0.6 * still["TRIANGLES"]


@pytest.mark.parametrize("parameters", [{"KEEP": 0}, {"FOCUS": 0, "FOCUS_GROWTH": 1.0}])
def test_places_beside_the_elevation_model_are_refused(run, dem, tmp_path, parameters):
    beside = str(scenes.write_points(tmp_path / "beside.gpkg", [(scenes.WEST - 5000.0, scenes.NORTH, {})], {}))
    parameters = {name: value or beside for name, value in parameters.items()}
    with pytest.raises(QgsProcessingException, match=next(iter(parameters)) + ": no feature lies on INPUT"):
        simplify(run, dem, tmp_path, **parameters)


def test_the_tolerance_grows_with_the_distance_from_the_focus(run, dem, tmp_path):
    focus = str(scenes.write_points(tmp_path / "focus.gpkg", [(scenes.WEST + 15.0, scenes.NORTH - 15.0, {})], {}))
    found = simplify(run, dem, tmp_path, TOLERANCE=0.2, FOCUS=focus, FOCUS_GROWTH=10.0)
    even = simplify(run, dem, tmp_path, TOLERANCE=0.2, OUTPUT=str(tmp_path / "even.ply"))
    assert found["TRIANGLES"] < 0.7 * even["TRIANGLES"] and 0.2 < found["LARGEST_DEVIATION"] < 0.2 + 10.0 * 0.47
    assert found["LARGEST_RATIO"] <= 1.0
    corner = QgsRectangle(scenes.WEST, scenes.NORTH - 60.0, scenes.WEST + 60.0, scenes.NORTH)
    places = [vertices(one["OUTPUT"]) for one in (found, even)]
    near = [sum(corner.contains(QgsPointXY(x, y)) for x, y in all_of_it) for all_of_it in places]
    assert near[0] / near[1] > 1.5 * len(places[0]) / len(places[1])


def vertices(path):
    mesh = QgsMesh()
    layer = QgsMeshLayer(path, "tin", "mdal")
    layer.dataProvider().populateMesh(mesh)
    return [(mesh.vertex(n).x(), mesh.vertex(n).y()) for n in range(mesh.vertexCount())]


@pytest.mark.parametrize("wrong, message", [
    ({"TOLERANCE": None}, "TOLERANCE: say how far"),
    ({"VERTICAL_ACCURACY": 1.0}, "TOLERANCE: the accuracy"),
    ({"TOLERANCE": None, "VERTICAL_ACCURACY": 1.0, "CONFIDENCE": 1.0}, "CONFIDENCE"),
    ({"FOCUS_GROWTH": 1.0}, "FOCUS_GROWTH: give it together"),
    ({"BREAK_LINE_TOLERANCE": 1.0}, "BREAK_LINE_TOLERANCE: give the BREAK_LINES"),
    ({"BORDER_TOLERANCE": 1.0, "KEEP_BORDER": True}, "BORDER_TOLERANCE: KEEP_BORDER"),
    ({"OUTPUT": "/nowhere/tin.ply"}, "OUTPUT"),
    ({"OUTPUT": "tin.xyz"}, "OUTPUT"),
])
def test_what_is_wrong_is_named(run, dem, tmp_path, wrong, message):
    if "OUTPUT" in wrong and "/" not in wrong["OUTPUT"]:
        wrong = {**wrong, "OUTPUT": str(tmp_path / wrong["OUTPUT"])}
    with pytest.raises(QgsProcessingException, match=message):
        simplify(run, dem, tmp_path, **wrong)
    assert list(tmp_path.glob("tin*")) == []
