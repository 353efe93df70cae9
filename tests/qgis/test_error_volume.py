# SPDX-License-Identifier: GPL-3.0-or-later
"""The group Error volume through processing.run: build, see, subtract, map."""

import shutil

import numpy
import pytest
import scenes
from osgeo import ogr
from qgis.core import (
    Qgis,
    QgsMeshLayer,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingUtils,
    QgsProject,
)

ERROR = {"VERTICAL_ACCURACY": 0.5, "GEOLOGIC_VARIATION": 0.0}
RASTERS = ("OUTPUT_HEIGHT", "OUTPUT_THICKNESS", "OUTPUT_CORE")


@pytest.fixture
def volume(run, dem, tmp_path):
    path = str(tmp_path / "volume.vdb")
    run("builderrorvolume", INPUT=dem, VOXEL=2.0, OUTPUT=path, **ERROR)
    return path


@pytest.fixture
def one(tmp_path):
    return str(scenes.write_observers(tmp_path / "one.gpkg", (5.0,), ("a",), (scenes.FIRST,)))


def outputs(folder, prefix=""):
    files = {name: str(folder / f"{prefix}{name}.tif") for name in RASTERS}
    return {**files, "OUTPUT": str(folder / f"{prefix}hidden.vdb"), "OUTPUT_TOP": str(folder / f"{prefix}top.ply")}


def see(run, volume, observers, folder, **more):
    given = {"TARGET_SPACING": 10.0, "TARGET_CEILING": 12.0, "OBSERVER_HEIGHT": 5.0}
    return run("volumeviewshed", INPUT=volume, OBSERVERS=observers, **{**given, **outputs(folder), **more})


def square(side, offset=0.0):
    """The ring of a square whose north-western corner lies so many metres south-east of the first observer."""
    x, y = scenes.FIRST[0] + offset, scenes.FIRST[1] - offset
    corners = [(x, y), (x + side, y), (x + side, y - side), (x, y - side), (x, y)]
    return f"({', '.join(f'{a} {b}' for a, b in corners)})"


def patrol(path, geometry=f"POLYGON ({square(40.0)})"):
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = source.CreateLayer("patrol", scenes.reference(scenes.UTM), ogr.wkbUnknown)
    feature = ogr.Feature(layer.GetLayerDefn())
    feature.SetGeometry(ogr.CreateGeometryFromWkt(geometry))
    layer.CreateFeature(feature)
    source = None
    return str(path)


def test_size_and_memory_are_told_before_anything_is_built(run, dem, log, tmp_path):
    path = tmp_path / "volume.vdb"
    told = run("builderrorvolume", feedback=log, INPUT=dem, VOXEL=2.0, ESTIMATE_ONLY=True, OUTPUT=str(path), **ERROR)
    assert not path.exists() and told["VOXEL_USED"] == 2.0 and told["MEMORY"] > 1000
    built = run("builderrorvolume", feedback=log, INPUT=dem, VOXEL=2.0, OUTPUT=str(path), **ERROR)
    assert path.exists() and 0.3 < built["VOXELS"] / told["VOXELS"] < 3
    assert any("MB of memory" in line for line in log.infos)
    assert '"vertical_rmse": 0.5' in built["ERROR_MODEL_USED"]


def test_one_terrain_and_no_more(run, dem, observers):
    for given in ({}, {"INPUT": dem, "TIN": observers}):
        with pytest.raises(QgsProcessingException, match="INPUT: give an elevation model"):
            run("builderrorvolume", **given, **ERROR)


def test_degrees_are_refused(run, tmp_path):
    dem = str(scenes.write_dem_in_degrees(tmp_path / "degrees.tif"))
    with pytest.raises(QgsProcessingException, match="reproject"):
        run("builderrorvolume", INPUT=dem, OUTPUT=str(tmp_path / "v.vdb"), **ERROR)


def test_mesh_and_3d_layer_give_the_same_volume(run, dem, tmp_path):
    import sightbound

    tin = sightbound.Tin.from_dem(sightbound.read_dem(dem))
    mesh, polygons = str(tmp_path / "tin.ply"), str(tmp_path / "tin.gpkg")
    tin.write(mesh)
    tin.write(polygons)
    found = [
        run("builderrorvolume", VOXEL=2.0, OUTPUT=str(tmp_path / f"{name}.vdb"), **{name: path}, **ERROR)
        for name, path in (("INPUT", dem), ("MESH", mesh), ("TIN", polygons))
    ]
    assert found[0]["VOXELS"] == found[1]["VOXELS"] == found[2]["VOXELS"]


def test_viewshed_writes_rasters_mesh_and_numbers(run, volume, one, tmp_path):
    found = see(run, volume, one, tmp_path)
    height, thickness, core = (scenes.read(found[name])[0] for name in RASTERS)
    assert height.shape == thickness.shape == core.shape
    asked = numpy.isfinite(thickness)
    assert asked.any() and (core[asked] <= thickness[asked]).all()
    assert found["VOLUME_HIDDEN"] >= found["VOLUME_CORE"] > 0 and found["VOLUME_VISIBLE"] > 0
    assert found["VOLUME_HIDDEN"] == pytest.approx(numpy.nansum(thickness) * 100.0, rel=1e-6)
    assert found["AREA_HIDDEN"] >= found["AREA_CORE"] > 0
    fog = QgsMeshLayer(found["OUTPUT_TOP"], "fog", "mdal")
    groups = [fog.dataProvider().datasetGroupMetadata(n).name() for n in range(fog.dataProvider().datasetGroupCount())]
    assert fog.isValid() and {"p", "thickness"} <= set(groups) and fog.crs().authid() == "EPSG:32633"


def test_patrol_area_sees_more_from_any_place_than_from_all(run, volume, one, tmp_path):
    area = patrol(tmp_path / "patrol.gpkg")
    hidden = [
        see(run, volume, area, tmp_path, SEEN_FROM=word, OBSERVER_HEIGHT_TO=8.0)["VOLUME_HIDDEN"] for word in ("any", "all")
    ]
    assert hidden[0] < hidden[1]


def test_holes_and_parts_of_patrol_areas(run, volume, tmp_path):
    def places(name, geometry):
        log = scenes.Log()
        see(run, volume, patrol(tmp_path / name, geometry), tmp_path, feedback=log, VIEW_SPACING=5.0)
        (count,) = (line.split()[0] for line in log.infos if "view places" in line)
        return int(count)

    whole, hole, far = square(40.0), square(20.0, 10.0), square(10.0, 50.0)
    found = {
        name: places(f"{name}.gpkg", geometry)
        for name, geometry in {
            "whole": f"POLYGON ({whole})",
            "hole": f"POLYGON ({hole})",
            "far": f"POLYGON ({far})",
            "rim": f"POLYGON ({whole}, {hole})",
            "parts": f"MULTIPOLYGON (({whole}, {hole}), ({far}))",
        }.items()
    }
    assert found["rim"] == found["whole"] - found["hole"] > 0
    assert found["parts"] == found["rim"] + found["far"]


def test_subtracting_is_looking_together(run, volume, one, observers, tmp_path):
    first = see(run, volume, one, tmp_path)
    second = str(scenes.write_observers(tmp_path / "two.gpkg", (5.0,), ("b",), (scenes.SECOND,)))
    rest = run(
        "subtractobserver", HIDDEN=first["OUTPUT"], INPUT=volume, OBSERVERS=second, OBSERVER_HEIGHT=5.0,
        **outputs(tmp_path, "rest"),
    )
    both = see(run, volume, observers, tmp_path)
    assert rest["VOLUME_HIDDEN"] == both["VOLUME_HIDDEN"] and rest["AREA_CORE"] == both["AREA_CORE"]
    assert rest["GAIN_VOLUME"] == pytest.approx(first["VOLUME_HIDDEN"] - rest["VOLUME_HIDDEN"]) and rest["GAIN_VOLUME"] > 0
    assert rest["GAIN_AREA"] == pytest.approx(first["AREA_HIDDEN"] - rest["AREA_HIDDEN"])


def test_rasters_again_from_the_file(run, volume, one, tmp_path):
    first = see(run, volume, one, tmp_path)
    again = run(
        "volumetoraster", INPUT=first["OUTPUT"], OUTPUT_PLACES=str(tmp_path / "places.gpkg"),
        **{name: path for name, path in outputs(tmp_path, "again").items() if name != "OUTPUT"},
    )
    for name in RASTERS:
        assert numpy.array_equal(scenes.read(first[name])[0], scenes.read(again[name])[0], equal_nan=True)
    places = scenes.rows_of(again["OUTPUT_PLACES"])
    assert [row["rank"] for row in places] == list(range(1, len(places) + 1))
    assert places[0]["area_m2"] == max(row["area_m2"] for row in places)
    assert sum(row["area_m2"] for row in places) <= again["AREA_HIDDEN"]


def test_rasters_of_an_error_volume(run, volume, dem, log, tmp_path):
    import sightbound

    paths = {name: str(tmp_path / f"{name}.tif") for name in ("OUTPUT_LOWER", "OUTPUT_UPPER", "OUTPUT_THICKNESS")}
    found = run("volumetoraster", feedback=log, INPUT=volume, CONFIDENCE=0.9, OUTPUT_CORE=str(tmp_path / "core.tif"), **paths)
    assert found == paths and not (tmp_path / "core.tif").exists()
    assert any("no OUTPUT_CORE" in line for line in log.infos)
    lower, upper, thickness = (scenes.read(path)[0] for path in paths.values())
    expected = sightbound.ErrorVolume.open(volume).rasters(0.9)
    assert numpy.array_equal(lower, expected.lower, equal_nan=True)
    known = numpy.isfinite(lower)
    assert (thickness[known] == (upper - lower)[known]).all() and (thickness[known] >= 2 * 1.64 * 0.5).all()
    with pytest.raises(QgsProcessingException, match="CONFIDENCE"):
        run("volumetoraster", INPUT=volume, CONFIDENCE=0.99999, **paths)


def test_wrong_files_are_named(run, volume, one, dem, tmp_path):
    shutil.copy(dem, tmp_path / "dem.vdb")
    with pytest.raises(QgsProcessingException, match="INPUT: .*no .vdb file"):
        see(run, str(tmp_path / "dem.vdb"), one, tmp_path)
    with pytest.raises(QgsProcessingException, match="INPUT: there is no file"):
        see(run, str(tmp_path / "none.vdb"), one, tmp_path)
    with pytest.raises(QgsProcessingException, match="no .vdb file"):
        run("volumetoraster", INPUT=str(tmp_path / "dem.vdb"), OUTPUT_CORE=str(tmp_path / "core.tif"))
    with pytest.raises(QgsProcessingException, match="INPUT: .*not a hidden volume"):
        run("volumetoraster", INPUT=volume, OUTPUT_CORE=str(tmp_path / "core.tif"))


def test_bad_values_name_their_parameter(run, volume, one, tmp_path):
    for name, value in (("TARGET_SPACING", 0.0), ("MOST_LINES", 10.0), ("HIDE_HEIGHT", 13.0)):
        with pytest.raises(QgsProcessingException, match=name):
            see(run, volume, one, tmp_path, **{name: value})
    off = str(scenes.write_observers(tmp_path / "off.gpkg", (5.0,), ("a",), ((0.0, 0.0),)))
    with pytest.raises(QgsProcessingException, match="OBSERVERS: .*feature 1 of OBSERVERS.* not on the terrain"):
        see(run, volume, off, tmp_path)


def test_the_fog_is_loaded_and_styled(provider, volume, one, tmp_path, log):
    from qgis._3d import Qgs3D

    Qgs3D.initialize()  # as the desktop does; without it QGIS leaves 3D styles aside
    context = QgsProcessingContext()
    project = QgsProject()
    context.setProject(project)
    algorithm = provider.algorithm("volumeviewshed").create()
    parameters = {"INPUT": volume, "OBSERVERS": one, "OUTPUT_TOP": str(tmp_path / "top.ply"), "TARGET_CEILING": 12.0}
    results, done = algorithm.run(parameters, context, log)
    assert done, log.errors
    details = context.layersToLoadOnCompletion()[results["OUTPUT_TOP"]]
    layer = QgsProcessingUtils.mapLayerFromString(results["OUTPUT_TOP"], context, True, details.layerTypeHint)
    details.postProcessor().postProcessLayer(layer, context, log)
    settings = layer.rendererSettings()
    group = layer.dataProvider().datasetGroupMetadata(settings.activeScalarDatasetGroup()).name()
    assert group == "p"
    colours = [item.color for item in settings.scalarSettings(1).colorRampShader().colorRampItemList()]
    assert all(0 < one.alpha() < 255 for one in colours)
    assert (numpy.diff([one.lightness() for one in colours]) > 0).all(), "the surer hidden, the darker"
    assert log.warnings == []
    assert layer.renderer3D() is not None and layer.renderer3D().type() == "mesh"


def test_one_sees_through_the_fog_in_3d(provider, volume, one, tmp_path, log):
    from qgis._3d import Qgs3D, QgsPolygon3DSymbol, QgsRuleBased3DRenderer
    from qgis.PyQt import sip

    Qgs3D.initialize()
    context = QgsProcessingContext()
    project = QgsProject()
    context.setProject(project)
    algorithm = provider.algorithm("volumeviewshed").create()
    files = {"OUTPUT_TOP": str(tmp_path / "top.ply"), "OUTPUT_FOG": str(tmp_path / "fog.gpkg")}
    results, done = algorithm.run({"INPUT": volume, "OBSERVERS": one, "TARGET_CEILING": 12.0, **files}, context, log)
    assert done, log.errors
    layers = {}
    for name in files:
        details = context.layersToLoadOnCompletion()[results[name]]
        layers[name] = QgsProcessingUtils.mapLayerFromString(results[name], context, True, details.layerTypeHint)
        details.postProcessor().postProcessLayer(layers[name], context, log)
    fog, top = layers["OUTPUT_FOG"], layers["OUTPUT_TOP"]
    assert log.warnings == [] and fog.featureCount() == top.meshFaceCount()
    assert top.renderer3D() is None, "it would hide the fog"
    rules = sip.cast(fog.renderer3D(), QgsRuleBased3DRenderer).rootRule().children()
    shown = [len(list(fog.getFeatures(rule.filterExpression()))) for rule in rules]
    assert sum(shown) == fog.featureCount() and all(shown), "each face by one rule"
    for rule in rules:
        symbol = sip.cast(rule.symbol(), QgsPolygon3DSymbol)
        if Qgis.QGIS_VERSION_INT >= 32600:
            assert 0 < symbol.materialSettings().opacity() < 1
        else:
            assert symbol.renderedFacade() == 0 and symbol.edgesEnabled()


def test_a_fog_is_a_geopackage(run, volume, one, tmp_path):
    with pytest.raises(QgsProcessingException, match="GeoPackage"):
        see(run, volume, one, tmp_path, OUTPUT_FOG=str(tmp_path / "fog.ply"))
