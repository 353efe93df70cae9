# SPDX-License-Identifier: GPL-3.0-or-later
"""Targets in an error volume through processing.run: points with their attributes, rasters at one height."""

import numpy
import pytest
import scenes
from osgeo import ogr
from qgis.core import QgsProcessingException, QgsProperty

NEAR = (scenes.FIRST[0] + 60.0, scenes.FIRST[1] - 10.0)
FAR = (scenes.WEST + 380.0, scenes.NORTH - 20.0)  # behind two ridges
OFF = (0.0, 0.0)
COUNTS = ("COUNT_HIDDEN", "COUNT_UNCERTAIN", "COUNT_VISIBLE")


@pytest.fixture
def volume(run, dem, tmp_path):
    path = str(tmp_path / "volume.vdb")
    run("builderrorvolume", INPUT=dem, VOXEL=2.0, OUTPUT=path, VERTICAL_ACCURACY=0.5, GEOLOGIC_VARIATION=0.0)
    return path


@pytest.fixture
def eye(tmp_path):
    return str(scenes.write_observers(tmp_path / "eye.gpkg", (5.0,), ("a",), (scenes.FIRST,)))


@pytest.fixture
def targets(tmp_path):
    rows = [(*NEAR, {"up": 40.0, "verdict": 7}), (*FAR, {"up": 0.5, "verdict": 8}), (*OFF, {"up": 2.0, "verdict": 9})]
    return str(scenes.write_points(tmp_path / "targets.gpkg", rows, {"up": ogr.OFTReal, "verdict": ogr.OFTInteger}))


def see(run, volume, eye, folder, **more):
    given = {"INPUT": volume, "OBSERVERS": eye, "OBSERVER_HEIGHT": 5.0, "HOLDS_FOR": "place"}
    return run("volumetargets", **{**given, **more})


def test_each_target_keeps_its_attributes(run, volume, eye, targets, tmp_path):
    log, path = scenes.Log(), str(tmp_path / "seen.gpkg")
    height = QgsProperty.fromField("up")
    found = see(run, volume, eye, tmp_path, TARGETS=targets, TARGET_HEIGHT=height, OUTPUT=path, feedback=log)
    rows = scenes.rows_of(path)
    assert [row["up"] for row in rows] == [40.0, 0.5, 2.0] and [row["verdict"] for row in rows] == [7, 8, 9]
    assert rows[0]["verdict_2"] == "visible" and rows[0]["p"] > 0.99
    assert rows[1]["verdict_2"] == "hidden" and rows[1]["p"] < 0.01
    assert rows[2]["verdict_2"] == "unknown" and rows[2]["p"] is None
    assert sum(found[name] for name in COUNTS) == 2 and found["COUNT_VISIBLE"] == 1
    assert any("1 of 3 targets are not on the terrain" in line for line in log.warnings)
    by_field = see(run, volume, eye, tmp_path, TARGETS=targets, TARGET_HEIGHT_FIELD="up", OUTPUT=str(tmp_path / "again.gpkg"))
    assert [by_field[name] for name in COUNTS] == [found[name] for name in COUNTS]


def test_rasters_and_points_agree(run, volume, eye, tmp_path):
    rasters = {name: str(tmp_path / f"{name}.tif") for name in ("OUTPUT_CONFIDENCE", "OUTPUT_VERDICT")}
    see(run, volume, eye, tmp_path, TARGET_HEIGHT=3.0, TARGET_SPACING=20.0, **rasters)
    verdict, dataset = scenes.read(rasters["OUTPUT_VERDICT"])
    transform = dataset.GetGeoTransform()
    p = scenes.read(rasters["OUTPUT_CONFIDENCE"])[0]
    asked = verdict != 255
    assert asked.any() and (numpy.isfinite(p) == asked).all() and {0, 2} <= set(verdict[asked].tolist())
    places = [(*middle(transform, row, col), {}) for row, col in zip(*numpy.nonzero(asked))]
    points = str(scenes.write_points(tmp_path / "middles.gpkg", places, {}))
    path = str(tmp_path / "points.gpkg")
    found = see(run, volume, eye, tmp_path, TARGETS=points, TARGET_HEIGHT=3.0, OUTPUT=path)
    for name, number in zip(COUNTS, range(3)):
        assert found[name] == (verdict == number).sum()
    numpy.testing.assert_allclose([row["p"] for row in scenes.rows_of(path)], p[asked], atol=1e-3)


def middle(transform, row, col):
    return transform[0] + (col + 0.5) * transform[1], transform[3] + (row + 0.5) * transform[5]


def test_absolute_heights_beneath_the_ground_have_no_verdict(run, volume, eye, targets, tmp_path):
    log = scenes.Log()
    found = see(
        run, volume, eye, tmp_path, TARGETS=targets, TARGET_HEIGHT=-500.0, TARGET_HEIGHT_REFERENCE="absolute",
        OUTPUT=str(tmp_path / "none.gpkg"), feedback=log,
    )
    assert sum(found[name] for name in COUNTS) == 0
    assert any("beneath the ground" in line for line in log.warnings)


def test_contradictions_and_bad_values_name_their_parameter(run, volume, eye, targets, tmp_path):
    raster = {"OUTPUT_VERDICT": str(tmp_path / "verdict.tif")}
    point = {"TARGETS": targets, "OUTPUT": str(tmp_path / "points.gpkg")}
    off = str(scenes.write_points(tmp_path / "off.gpkg", [(*OFF, {})], {}))
    empty = str(scenes.write_points(tmp_path / "empty.gpkg", [], {}))
    cases = [
        ("TARGETS: give points", {}),
        ("TARGET_HEIGHT: rasters are at one height", {**point, **raster, "TARGET_HEIGHT_FIELD": "up"}),
        ("TARGET_HEIGHT_REFERENCE: rasters", {**raster, "TARGET_HEIGHT_REFERENCE": "absolute"}),
        ("TARGET_HEIGHT is 0", raster),
        ("TARGET_SPACING is 0", {**raster, "TARGET_HEIGHT": 2.0, "TARGET_SPACING": 0.0}),
        ("TARGETS: None of the targets is on the terrain", {**point, "TARGETS": off}),
        ("TARGETS: the layer holds nothing", {**point, "TARGETS": empty}),
        ("TARGET_HEIGHT_FIELD: the layer has no field", {**point, "TARGET_HEIGHT_FIELD": "none"}),
        ("CONFIDENCE", {**point, "CONFIDENCE": 1.0}),
        ("MOST_LINES", {**point, "MOST_LINES": 1.0}),
        ("INPUT: there is no file", {**point, "INPUT": str(tmp_path / "none.vdb")}),
    ]
    for message, given in cases:
        with pytest.raises(QgsProcessingException, match=message):
            see(run, volume, eye, tmp_path, **given)
    assert not (tmp_path / "verdict.tif").exists()


def test_cancelled_it_leaves_nothing(run, volume, eye, tmp_path):
    log, path = scenes.Log(cancel_at=30), tmp_path / "verdict.tif"
    found = see(run, volume, eye, tmp_path, TARGET_HEIGHT=2.0, TARGET_SPACING=2.0, OUTPUT_VERDICT=str(path), feedback=log)
    assert found == {} and not path.exists()
