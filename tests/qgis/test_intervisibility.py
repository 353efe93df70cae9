# SPDX-License-Identifier: GPL-3.0-or-later
"""sightbound:intervisibility through processing.run."""

import pytest
import scenes
from osgeo import ogr
from qgis.core import QgsProcessingException

COMMON = {"VERTICAL_ACCURACY": 0.5, "GEOLOGIC_VARIATION": 0.0, "OUTPUT": "memory:"}


@pytest.fixture
def masts(tmp_path):
    rows = [
        (scenes.WEST + 205.0, scenes.NORTH - 95.0, {"name": "a", "top": 3.0}),
        (scenes.WEST + 355.0, scenes.NORTH - 255.0, {"name": "b", "top": 30.0}),
        (scenes.WEST + 15.0, scenes.NORTH - 15.0, {"name": "c", "top": 10.0}),
        (scenes.WEST - 500.0, scenes.NORTH - 15.0, {"name": "far off", "top": 10.0}),
    ]
    fields = {"name": ogr.OFTString, "top": ogr.OFTReal}
    return str(scenes.write_points(tmp_path / "masts.gpkg", rows, fields))


def test_each_two_once(run, dem, masts, log):
    results = run("intervisibility", feedback=log, INPUT=dem, POINTS_A=masts, FIELD_A="name", HEIGHT_A_FIELD="top",
                  OUTPUT_TABLE="memory:", **COMMON)  # fmt: skip
    lines, table = list(results["OUTPUT"].getFeatures()), list(results["OUTPUT_TABLE"].getFeatures())
    assert [(line["from"], line["to"]) for line in lines] == [
        ("a", "b"), ("a", "c"), ("a", "far off"), ("b", "c"), ("b", "far off"), ("c", "far off"),
    ]  # fmt: skip
    assert [line["status"] for line in lines] == ["ok", "ok", "outside", "ok", "outside", "outside"]
    assert results["COUNT_UNKNOWN"] == 3 and any("3 pairs" in text for text in log.warnings)
    assert sum(results[f"COUNT_{word}"] for word in ("VISIBLE", "UNCERTAIN", "HIDDEN")) == 3
    assert any(text.startswith("6 lines: ") and text.endswith("at a confidence of 0.95.") for text in log.infos)
    names = [field.name() for field in results["OUTPUT"].fields()]
    assert names == [field.name() for field in results["OUTPUT_TABLE"].fields()]
    assert not any(name.startswith(("probability", "fresnel")) for name in names)
    for line, row in zip(lines, table):
        assert line.attributes()[-len(names):] == row.attributes()[-len(names):] and not row.hasGeometry()
        if line["status"] != "ok":
            assert line["verdict"] == "unknown" and not line["p"]
            continue
        assert line["distance"] == pytest.approx(line.geometry().length(), rel=1e-3)
        assert 0.0 < line["critical_share"] < 1.0 and line["verdict"] in ("hidden", "uncertain", "visible")
        assert line["critical_share"] * line["distance"] == pytest.approx(line["critical_distance"])


def test_critical_places(run, dem, masts):
    results = run("intervisibility", INPUT=dem, POINTS_A=masts, OUTPUT_CRITICAL="memory:", **COMMON)
    judged = [line for line in results["OUTPUT"].getFeatures() if line["status"] == "ok"]
    places = list(results["OUTPUT_CRITICAL"].getFeatures())
    assert len(judged) == len(places) == 3
    for line, place in zip(judged, places):
        assert line.attributes() == place.attributes()
        point = place.geometry().asPoint()
        assert (point.x(), point.y()) == (line["critical_x"], line["critical_y"])
        start = line.geometry().asPolyline()[0]
        assert start.distance(point) == pytest.approx(line["critical_distance"], rel=1e-3)


def test_with_another_layer_probability_and_radio(run, dem, masts, observers):
    results = run("intervisibility", INPUT=dem, POINTS_A=observers, POINTS_B=masts, HEIGHT_A=4.0, HEIGHT_B=2.0,
                  FIELD_B="name", PROBABILITY=True, REALISATIONS=64, SEED=3, FREQUENCY=2400.0, MAX_DISTANCE=5000.0,
                  **COMMON)  # fmt: skip
    judged = [line for line in results["OUTPUT"].getFeatures() if line["status"] == "ok"]
    assert judged
    for line in judged:
        assert 0.0 <= line["fresnel_probability"] <= line["probability"] <= 1.0
        assert (line["probability"] * 64) % 1 == 0 and 0.0 <= line["blocked_bound"] <= 1.0
        assert line["fresnel_p"] <= line["p"] + 1e-6 and 0.0 < line["fresnel_distance"] < line["distance"]


def test_what_lines_of_sight_say(run, dem, observers):
    pairs = run("intervisibility", INPUT=dem, POINTS_A=observers, HEIGHT_A=2.0, **COMMON)["OUTPUT"].getFeatures()
    lines = run("lineofsightprofile", INPUT=dem, OBSERVERS=observers, TARGETS=observers, OBSERVER_HEIGHT=2.0,
                TARGET_HEIGHT=2.0, **COMMON)["OUTPUT"].getFeatures()  # fmt: skip
    found = {(line["observer"], line["target"]): line["p"] for line in lines}
    for pair in pairs:
        assert pair["p"] == pytest.approx(found[(pair["from"], pair["to"])], abs=1e-4)


@pytest.mark.parametrize("wrong, message", [
    ({"FIELD_B": "name"}, "POINTS_B"),
    ({"CONFIDENCE": 1.0}, "CONFIDENCE"),
    ({"FREQUENCY": 0.0}, "FREQUENCY|frequency|parameter"),
    ({"REALISATIONS": 0, "PROBABILITY": True}, "REALISATIONS|realisations|parameter"),
])
def test_wrong_input_is_named(run, dem, masts, wrong, message):
    with pytest.raises(QgsProcessingException, match=message):
        run("intervisibility", **{"INPUT": dem, "POINTS_A": masts, **COMMON, **wrong})


def test_empty_layer(run, dem, tmp_path):
    empty = str(scenes.write_points(tmp_path / "none.gpkg", [], {"name": ogr.OFTString}))
    with pytest.raises(QgsProcessingException, match="POINTS_A.*holds no points"):
        run("intervisibility", INPUT=dem, POINTS_A=empty, **COMMON)
