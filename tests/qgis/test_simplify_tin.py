# SPDX-License-Identifier: GPL-3.0-or-later
"""Simplify TIN through processing.run: meshes, layers and files of any shape, numbers, and what is refused."""

import json
import math

import numpy
import pytest
import scenes
from osgeo import gdal, ogr
from qgis.core import (
    QgsMeshLayer,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingModelAlgorithm,
    QgsProcessingModelChildAlgorithm,
    QgsProcessingModelChildParameterSource,
    QgsProcessingUtils,
    QgsProject,
)


def tunnel(rows=24, cols=30):
    """A half pipe that overhangs at its feet: no height field."""
    angle = numpy.linspace(-0.3, math.pi + 0.3, cols + 1)
    rough = numpy.random.default_rng(1).normal(0, 0.02, (rows + 1, cols + 1))
    vertices = [
        (scenes.WEST + 20 - 9 * math.cos(a), scenes.NORTH - 60 + 1.5 * r, 105 + 9 * math.sin(a) + rough[r, c])
        for r in range(rows + 1)
        for c, a in enumerate(angle)
    ]
    at = lambda r, c: r * (cols + 1) + c
    return vertices, [(at(r, c), at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)) for r in range(rows) for c in range(cols)]


@pytest.fixture
def mesh(tmp_path):
    import sightbound

    path = str(tmp_path / "tunnel.ply")
    sightbound.Tin(*tunnel(), f"EPSG:{scenes.UTM}").write(path)
    return path


def simplify(run, mesh, folder, **more):
    return run("simplifytin", **{"INPUT": mesh, "TOLERANCE": 0.4, "OUTPUT": str(folder / "tin.ply"), **more})


def test_mesh_polygons_and_numbers(run, mesh, tmp_path):
    polygons, log = str(tmp_path / "tin.gpkg"), scenes.Log()
    found = simplify(run, mesh, tmp_path, OUTPUT_POLYGONS=polygons, feedback=log)
    assert found["TRIANGLES"] < 0.5 * found["TRIANGLES_BEFORE"] == 0.5 * 2 * 24 * 30
    assert "LARGEST_DEVIATION" not in found
    assert found["LARGEST_TOLERANCE"] == found["BORDER_TOLERANCE_USED"] == 0.4 and 0 < found["VOXEL_USED"] < 0.4
    made = QgsMeshLayer(found["OUTPUT"], "tin", "mdal")
    assert made.isValid() and made.crs().authid() == "EPSG:32633" and made.meshFaceCount() == found["TRIANGLES"]
    assert len(scenes.rows_of(polygons)) == found["TRIANGLES"]
    assert any("distance to the nearest place" in line for line in log.infos) and log.warnings == []
    verified = run("verifytin", MESH=mesh, SIMPLIFIED=found["OUTPUT"], TOLERANCE=0.4)
    assert verified["WITHIN_TOLERANCE"] and verified["DEGENERATE"] == 0


def test_an_accuracy_is_a_tolerance_at_the_confidence(run, mesh, tmp_path):
    error = {"TOLERANCE": None, "VERTICAL_ACCURACY": 0.2, "HORIZONTAL_ACCURACY": 0.2}
    found = simplify(run, mesh, tmp_path, **error)
    assert 0.39 < found["LARGEST_TOLERANCE"] <= 1.96 * 0.2 * math.sqrt(2) + 1e-3
    assert json.loads(found["ERROR_MODEL_USED"])["vertical_rmse"] == 0.2
    assert simplify(run, mesh, tmp_path, CONFIDENCE=0.999, **error)["TRIANGLES"] < found["TRIANGLES"]


def east_and_west(folder, crs=scenes.UTM, nodata=None):
    """0.1 m west of the tunnel's middle, 0.8 m east of it, in cells of 1 m."""
    values = numpy.where(numpy.arange(60) < 20, 0.1, 0.8).astype("float32") * numpy.ones((60, 1), "float32")
    if nodata is not None:
        values[values > 0.5] = nodata
    place = (scenes.WEST, 1.0, 0.0, scenes.NORTH - 10, 0.0, -1.0)
    return str(scenes.write_raster(folder / "tolerance.tif", values, place, crs, nodata))


def test_a_raster_of_tolerances(run, mesh, tmp_path):
    found = simplify(run, mesh, tmp_path, TOLERANCE=None, TOLERANCE_RASTER=east_and_west(tmp_path))
    assert found["LARGEST_TOLERANCE"] == pytest.approx(0.8)
    west, east = (
        sum((x < scenes.WEST + 20) == side for x, *_ in vertices(found["OUTPUT"])) for side in (True, False)
    )
    assert west > 1.3 * east
    # The same in another CRS, cells turned by the convergence of meridians.
    warped = str(tmp_path / "other.tif")
    gdal.Warp(warped, east_and_west(tmp_path), dstSRS="EPSG:3035", xRes=0.5, yRes=0.5, dstNodata=-1)
    other = simplify(run, mesh, tmp_path, TOLERANCE=None, TOLERANCE_RASTER=warped)
    assert abs(other["TRIANGLES"] - found["TRIANGLES"]) < 0.15 * found["TRIANGLES"]


def vertices(path):
    import sightbound

    return sightbound.read_tin(path).vertices.tolist()


@pytest.mark.parametrize("wrong, message", [
    ({"crs": 32634}, "TOLERANCE_RASTER: it does not lie under"),
    ({"nodata": -9.0}, r"TOLERANCE_RASTER: it has no value at \d+ of"),
])
def test_a_raster_that_does_not_hold_all_is_refused(run, mesh, tmp_path, wrong, message):
    with pytest.raises(QgsProcessingException, match=message):
        simplify(run, mesh, tmp_path, TOLERANCE=None, TOLERANCE_RASTER=east_and_west(tmp_path, **wrong))


def test_an_attribute_of_the_vertices_is_a_tolerance(run, mesh, tmp_path):
    import sightbound

    tin = sightbound.read_tin(mesh)
    there = tin.vertices
    tolerance = numpy.where(there[:, 0] < scenes.WEST + 20, 0.1, 0.8)
    path, points = str(tmp_path / "told.ply"), str(tmp_path / "told.gpkg")
    sightbound.Tin(there, tin.faces, tin.crs_wkt, vertex_attributes={"reach": tolerance}).write(path)
    by_mesh = simplify(run, path, tmp_path, TOLERANCE=None, TOLERANCE_FIELD="reach")
    by_file = simplify(run, None, tmp_path, FILE=path, TOLERANCE=None, TOLERANCE_FIELD="reach")
    assert by_mesh["LARGEST_TOLERANCE"] == pytest.approx(0.8) and by_file["TRIANGLES"] == by_mesh["TRIANGLES"]
    rows = [(x, y, z + 5 * math.sin(x / 2), 0.1 + 0.1 * n) for n, (x, y, z) in enumerate(ground())]
    write_points_with_heights(points, rows)
    by_points = simplify(run, None, tmp_path, TIN=points, TOLERANCE=None, TOLERANCE_FIELD="reach")
    assert by_points["LARGEST_TOLERANCE"] == pytest.approx(0.1 + 0.1 * 99)
    for source in ({"INPUT": path}, {"INPUT": None, "FILE": path}):
        with pytest.raises(QgsProcessingException, match="TOLERANCE_FIELD: the .* 'height'"):
            simplify(run, None, tmp_path, TOLERANCE=None, TOLERANCE_FIELD="height", **source)


def ground():
    return [(scenes.WEST + 3.0 * c, scenes.NORTH - 3.0 * r, 100.0) for r in range(10) for c in range(10)]


def write_points_with_heights(path, rows):
    source = ogr.GetDriverByName("GPKG").CreateDataSource(path)
    layer = source.CreateLayer("points", scenes.reference(scenes.UTM), ogr.wkbPoint25D)
    layer.CreateField(ogr.FieldDefn("reach", ogr.OFTReal))
    for x, y, z, reach in rows:
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(f"POINT Z ({x} {y} {z})"))
        feature.SetField("reach", reach)
        layer.CreateFeature(feature)
    source = None


def test_the_tolerance_grows_with_the_distance_from_the_focus(run, mesh, tmp_path):
    focus = square(tmp_path / "focus.gpkg", scenes.WEST + 5, scenes.NORTH - 65, 30)
    fine = simplify(run, mesh, tmp_path, TOLERANCE=0.1)["TRIANGLES"]
    found = simplify(run, mesh, tmp_path, TOLERANCE=0.1, FOCUS=focus, FOCUS_GROWTH=30.0)
    assert found["TRIANGLES"] < 0.9 * fine and 0.1 < found["LARGEST_TOLERANCE"] < 0.1 + 0.03 * 40
    far = square(tmp_path / "far.gpkg", scenes.WEST + 9000, scenes.NORTH, 10)
    with pytest.raises(QgsProcessingException, match="FOCUS: no feature lies on the TIN"):
        simplify(run, mesh, tmp_path, FOCUS=far, FOCUS_GROWTH=30.0)


def test_layers_and_files_are_taken_too(run, mesh, tmp_path):
    import sightbound

    layer, file = str(tmp_path / "tunnel.gpkg"), str(tmp_path / "tunnel.obj")
    sightbound.read_tin(mesh).write(layer)
    sightbound.read_tin(mesh).write(file)
    expected = simplify(run, mesh, tmp_path)["TRIANGLES"]
    for source in ({"TIN": layer}, {"FILE": file}, {"FILE": mesh}):
        found = simplify(run, None, tmp_path, **source)
        assert abs(found["TRIANGLES"] - expected) <= 0.2 * expected, source


def test_quads_are_triangulated_and_it_is_said(run, tmp_path):
    vertices, quads = tunnel()
    lines = ["MESH2D"] + [f"E4Q {n} {' '.join(str(v + 1) for v in quad)} 1" for n, quad in enumerate(quads, 1)]
    lines += [f"ND {n} {x} {y} {z}" for n, (x, y, z) in enumerate(vertices, 1)]
    path, log = tmp_path / "quads.2dm", scenes.Log()
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
    found = simplify(run, str(path), tmp_path, feedback=log)
    assert found["TRIANGLES_BEFORE"] == 2 * len(quads)
    assert any("triang" in line for line in log.infos + log.warnings)


def test_height_fields_lose_nothing_to_voxels(run, dem, tmp_path):
    import sightbound

    path = str(tmp_path / "full.ply")
    sightbound.Tin.from_dem(sightbound.read_dem(dem)).write(path)
    found = simplify(run, path, tmp_path, TOLERANCE=1.0)
    assert found["VOXEL_USED"] == 0 and found["TRIANGLES"] < 0.5 * found["TRIANGLES_BEFORE"]
    assert 0.9 < found["LARGEST_DEVIATION"] <= 1.0 and 0.9 < found["LARGEST_RATIO"] <= 1.0
    verified = run("verifytin", INPUT=dem, SIMPLIFIED=found["OUTPUT"], TOLERANCE=1.0)
    assert verified["WITHIN_TOLERANCE"] and verified["WELL_FORMED"] and 0.9 < verified["LARGEST_DEVIATION"] <= 1.0


def test_targets_borders_and_areas_to_keep(run, mesh, tmp_path):
    plain = simplify(run, mesh, tmp_path)["TRIANGLES"]
    assert abs(simplify(run, mesh, tmp_path, TARGET_TRIANGLES=900)["TRIANGLES"] - 900) <= 2
    small = simplify(run, mesh, tmp_path, TARGET_SIZE=0.016, OUTPUT=str(tmp_path / "small.ply"))
    assert 15_900 < (tmp_path / "small.ply").stat().st_size <= 16_000 and small["TRIANGLES"] > plain
    log = scenes.Log()
    simplify(run, mesh, tmp_path, TARGET_TRIANGLES=5, feedback=log)
    assert [line for line in log.warnings if "TARGET_TRIANGLES is 5, but" in line]
    assert simplify(run, mesh, tmp_path, BORDER_TOLERANCE=0.0)["TRIANGLES"] > plain
    assert simplify(run, mesh, tmp_path, VOXEL=0.2)["TRIANGLES"] > plain
    areas = square(tmp_path / "keep.gpkg", scenes.WEST + 8, scenes.NORTH - 45, 10)
    assert simplify(run, mesh, tmp_path, KEEP=areas)["TRIANGLES"] > 1.2 * plain


@pytest.mark.parametrize("wkt", ["POINT ({x} {y})", "LINESTRING ({x} {y}, {x2} {y2})", "POLYGON (({x} {y}, {x2} {y}, {x2} {y2}, {x} {y}))"])
def test_what_points_lines_and_polygons_touch_is_kept(run, mesh, tmp_path, wkt):
    import sightbound

    x, y = scenes.WEST + 20.3, scenes.NORTH - 45.2
    place = ogr.CreateGeometryFromWkt(wkt.format(x=x, y=y, x2=x + 4, y2=y + 7))
    path = str(tmp_path / "keep.gpkg")
    source = ogr.GetDriverByName("GPKG").CreateDataSource(path)
    layer = source.CreateLayer("keep", scenes.reference(scenes.UTM), place.GetGeometryType())
    feature = ogr.Feature(layer.GetLayerDefn())
    feature.SetGeometry(place)
    layer.CreateFeature(feature)
    source = None
    tin = sightbound.read_tin(mesh)
    there = tin.vertices
    touched = [face for face in tin.faces.tolist() if triangle(there[face]).Intersects(place)]
    kept = set(map(tuple, vertices(simplify(run, mesh, tmp_path, KEEP=path)["OUTPUT"])))
    assert touched and all(tuple(there[v]) in kept for face in touched for v in face)


def triangle(corners):
    a, b, c = ((x, y) for x, y, _ in corners)
    ring = ", ".join(f"{x!r} {y!r}" for x, y in map(lambda p: (float(p[0]), float(p[1])), (a, b, c, a)))
    return ogr.CreateGeometryFromWkt(f"POLYGON (({ring}))")


def write_lines(path, lines):
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = source.CreateLayer("lines", scenes.reference(scenes.UTM), ogr.wkbLineString25D)
    for line in lines:
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(f"LINESTRING Z ({', '.join(' '.join(map(repr, p)) for p in line)})"))
        layer.CreateFeature(feature)
    source = None
    return str(path)


def test_edges_stay_along_break_lines(run, mesh, tmp_path):
    import sightbound

    tin = sightbound.read_tin(mesh)
    there = tin.vertices.tolist()
    start = (scenes.WEST + 20 - 9 * math.cos(-0.3), scenes.NORTH - 60)  # a foot of the tunnel, all along
    foot = sorted((v for v in there if abs(v[0] - start[0]) < 1e-6), key=lambda v: v[1])
    rib = [v for v in there if abs(v[1] - (scenes.NORTH - 60 + 1.5 * 12)) < 1e-6]
    plain = simplify(run, mesh, tmp_path)["TRIANGLES"]
    kept = simplify(run, mesh, tmp_path, BREAK_LINES=write_lines(tmp_path / "rib.gpkg", [rib]))
    assert kept["TRIANGLES"] > plain and set(map(tuple, rib)) <= set(map(tuple, vertices(kept["OUTPUT"])))
    loose = simplify(
        run, mesh, tmp_path, BREAK_LINES=write_lines(tmp_path / "rib.gpkg", [rib]), BREAK_LINE_TOLERANCE=0.3
    )
    assert plain <= loose["TRIANGLES"] < kept["TRIANGLES"]
    beside = [(x, y, z + 0.5) for x, y, z in rib]
    with pytest.raises(QgsProcessingException, match="BREAK_LINES has 30 pieces, of which 30 do not run along"):
        simplify(run, mesh, tmp_path, BREAK_LINES=write_lines(tmp_path / "beside.gpkg", [beside]))


def square(path, x, y, side):
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = source.CreateLayer("keep", scenes.reference(scenes.UTM), ogr.wkbPolygon)
    feature = ogr.Feature(layer.GetLayerDefn())
    corners = [(x, y), (x + side, y), (x + side, y + side), (x, y + side), (x, y)]
    ring = ", ".join(f"{a} {b}" for a, b in corners)
    feature.SetGeometry(ogr.CreateGeometryFromWkt(f"POLYGON (({ring}))"))
    layer.CreateFeature(feature)
    source = None
    return str(path)


def test_the_mesh_is_loaded_with_its_edges(provider, mesh, tmp_path, log):
    context, project = QgsProcessingContext(), QgsProject()
    context.setProject(project)
    parameters = {"INPUT": mesh, "TOLERANCE": 0.4, "OUTPUT": str(tmp_path / "tin.ply")}
    results, done = provider.algorithm("simplifytin").create().run(parameters, context, log)
    assert done, log.errors
    details = context.layersToLoadOnCompletion()[results["OUTPUT"]]
    layer = QgsProcessingUtils.mapLayerFromString(results["OUTPUT"], context, True, details.layerTypeHint)
    details.postProcessor().postProcessLayer(layer, context, log)
    assert layer.rendererSettings().nativeMeshSettings().isEnabled()


@pytest.mark.parametrize("wrong, message", [
    ({"TOLERANCE": None}, "TOLERANCE: say how far"),
    ({"VERTICAL_ACCURACY": 1.0}, "TOLERANCE: say how far"),
    ({"TOLERANCE": None, "VERTICAL_ACCURACY": 1.0, "CONFIDENCE": 1.0}, "CONFIDENCE"),
    ({"TOLERANCE": None, "VERTICAL_ACCURACY": 1.0, "GEOLOGIC_RASTER": "dem"}, "GEOLOGIC_VARIATION|GEOLOGIC_RASTER"),
    ({"TOLERANCE_FIELD": "reach"}, "TOLERANCE_FIELD: TOLERANCE says the same"),
    ({"TARGET_SIZE": 1.0, "TARGET_TRIANGLES": 9}, "TARGET_SIZE: TARGET_TRIANGLES says"),
    ({"FOCUS_GROWTH": 1.0}, "FOCUS_GROWTH: give it together"),
    ({"INPUT": None}, "INPUT: give a mesh"),
    ({"FILE": "missing.ply"}, "INPUT: give a mesh"),
    ({"INPUT": None, "FILE": "/nowhere.ply"}, "FILE: there is no file"),
    ({"INPUT": "dem"}, "INPUT"),
    ({"KEEP": "far"}, "KEEP: no feature lies on the TIN"),
    ({"VOXEL": 0.002}, "VOXEL"),
    ({"OUTPUT": "/nowhere/tin.ply"}, "OUTPUT"),
    ({"OUTPUT": "tin.xyz"}, "OUTPUT"),
])
def test_what_is_wrong_is_named(run, mesh, dem, tmp_path, wrong, message):
    stand_ins = {"dem": dem, "far": lambda: square(tmp_path / "far.gpkg", scenes.WEST + 9000, scenes.NORTH, 10)}
    wrong = {name: stand_ins.get(value, value) for name, value in wrong.items()}
    wrong = {name: value() if callable(value) else value for name, value in wrong.items()}
    if wrong.get("OUTPUT") == "tin.xyz":
        wrong["OUTPUT"] = str(tmp_path / "tin.xyz")
    with pytest.raises(QgsProcessingException, match=message):
        simplify(run, mesh, tmp_path, **wrong)
    assert list(tmp_path.glob("tin.*")) == []


def test_cancelling_leaves_nothing(run, mesh, tmp_path):
    log = scenes.Log(cancel_at=20)
    found = simplify(run, mesh, tmp_path, feedback=log)
    assert "OUTPUT" not in found or found == {} or not (tmp_path / "tin.ply").exists()
    assert not (tmp_path / "tin.ply").exists()


def test_it_works_inside_a_model(mesh, tmp_path):
    source = QgsProcessingModelChildParameterSource
    model = QgsProcessingModelAlgorithm("One step", "tests", "tests")
    child = QgsProcessingModelChildAlgorithm("sightbound:simplifytin")
    child.setChildId("simple")
    out = str(tmp_path / "tin.ply")
    for name, value in {"INPUT": mesh, "TOLERANCE": 0.4, "CONFIDENCE": 0.95, "OUTPUT": out}.items():
        child.addParameterSources(name, [source.fromStaticValue(value)])
    model.addChildAlgorithm(child)
    assert model.validate() == (True, [])
    _, done = model.run({}, QgsProcessingContext(), scenes.Log())
    assert done and QgsMeshLayer(out, "tin", "mdal").meshFaceCount() > 0
