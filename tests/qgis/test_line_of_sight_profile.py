# SPDX-License-Identifier: GPL-3.0-or-later
"""sightbound:lineofsightprofile through processing.run."""

import html
import re

import pytest
import scenes
from osgeo import ogr
from qgis.core import QgsProcessing

COMMON = {"VERTICAL_ACCURACY": 0.5, "GEOLOGIC_VARIATION": 0.0, "OUTPUT": "memory:"}


@pytest.fixture
def targets(tmp_path):
    rows = [
        (scenes.WEST + 205.0, scenes.NORTH - 95.0, {"name": "hut", "top": 3.0}),
        (scenes.WEST + 355.0, scenes.NORTH - 255.0, {"name": "tower a/b", "top": 30.0}),
        (scenes.WEST + 15.0, scenes.NORTH - 15.0, {"name": "nobody's", "top": 1.0}),
    ]
    fields = {"name": ogr.OFTString, "top": ogr.OFTReal}
    return str(scenes.write_points(tmp_path / "targets.gpkg", rows, fields))


def test_all_pairs(run, dem, observers, targets, tmp_path):
    page = tmp_path / "profiles.html"
    results = run("lineofsightprofile", INPUT=dem, OBSERVERS=observers, TARGETS=targets, OBSERVER_FIELD="name",
                  TARGET_FIELD="name", OUTPUT_CRITICAL="memory:", OUTPUT_HTML=str(page), **COMMON)  # fmt: skip
    lines = list(results["OUTPUT"].getFeatures())
    assert len(lines) == 6 and {line["observer"] for line in lines} == {"tower a/b", "hut"}
    for line in lines:
        assert line["distance"] == pytest.approx(line.geometry().length(), rel=1e-3)
        assert 0.0 <= line["p"] <= 1.0 and line["verdict"] in ("hidden", "uncertain", "visible")
    places = list(results["OUTPUT_CRITICAL"].getFeatures())
    assert len(places) == 6
    for line, place in zip(lines, places):
        assert place.geometry().distance(line.geometry()) < 0.5 and place["p"] == line["p"]
        k = (place["line_height"] - place["ground"]) / place["sigma"]
        assert place["k"] == pytest.approx(max(-3.29, min(3.29, k)), abs=0.01)
    counts = [results[f"COUNT_{word}"] for word in ("VISIBLE", "UNCERTAIN", "HIDDEN")]
    assert sum(counts) == 6
    text = page.read_text(encoding="utf-8")
    assert text.count("<h2>") == 6 + 1 and text.count("class='critical'") == 12 + 1 and "tower a/b → hut" in text
    assert "left out" not in text and html.escape(results["ERROR_MODEL_USED"]) in text


def test_pairs_by_field(run, dem, observers, targets, log):
    results = run("lineofsightprofile", feedback=log, INPUT=dem, OBSERVERS=observers, TARGETS=targets, PAIRING="field",
                  OBSERVER_FIELD="name", TARGET_FIELD="name", **COMMON)  # fmt: skip
    pairs = {(line["observer"], line["target"]) for line in results["OUTPUT"].getFeatures()}
    assert pairs == {("tower a/b", "tower a/b"), ("hut", "hut")}
    assert any("feature 3 of TARGETS" in text for text in log.warnings)


def test_max_distance_leaves_out_far_pairs(run, dem, observers, targets, log):
    results = run("lineofsightprofile", feedback=log, INPUT=dem, OBSERVERS=observers, TARGETS=targets,
                  MAX_DISTANCE=130.0, **COMMON)  # fmt: skip
    lines = list(results["OUTPUT"].getFeatures())
    assert lines and all(line["distance"] <= 130.0 for line in lines)
    assert any(str(6 - len(lines)) in text and "MAX_DISTANCE" in text for text in log.infos)


def test_heights_of_both_ends_come_from_fields(run, dem, observers, targets):
    common = {"INPUT": dem, "OBSERVERS": observers, "TARGETS": targets, **COMMON}
    low = run("lineofsightprofile", OBSERVER_HEIGHT=0.5, TARGET_HEIGHT=0.0, **common)["OUTPUT"]
    high = run("lineofsightprofile", OBSERVER_HEIGHT_FIELD="eye", TARGET_HEIGHT_FIELD="top", **common)[
        "OUTPUT"
    ]
    for one, other in zip(low.getFeatures(), high.getFeatures()):
        assert other["k"] >= one["k"]
    assert any(other["k"] > one["k"] for one, other in zip(low.getFeatures(), high.getFeatures()))


def test_a_layer_may_look_at_itself(run, dem, observers):
    results = run("lineofsightprofile", INPUT=dem, OBSERVERS=observers, TARGETS=observers, **COMMON)
    pairs = {(line["observer_fid"], line["target_fid"]) for line in results["OUTPUT"].getFeatures()}
    assert pairs == {(1, 2), (2, 1)}


def test_at_most_fifty_profiles_are_drawn(run, dem, tmp_path):
    places = [
        (scenes.WEST + 30.0 * (i % 12) + 15.0, scenes.NORTH - 40.0 * (i // 12) - 25.0) for i in range(60)
    ]
    rows = [(*place, {}) for place in places]
    targets = str(scenes.write_points(tmp_path / "many.gpkg", rows, {}))
    observer = str(scenes.write_points(tmp_path / "one.gpkg", [(*scenes.FIRST, {})], {}))
    page = tmp_path / "profiles.html"
    results = run(
        "lineofsightprofile", INPUT=dem, OBSERVERS=observer, TARGETS=targets, OUTPUT_HTML=str(page), **COMMON
    )
    assert results["OUTPUT"].featureCount() == 60
    text = page.read_text(encoding="utf-8")
    assert text.count("<h2>") == 50 + 1 and re.search(r"first 50 are drawn; 10 were left out", text)


def test_temporary_outputs_by_default(run, dem, observers, targets):
    results = run("lineofsightprofile", INPUT=dem, OBSERVERS=observers, TARGETS=targets,
                  OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, OUTPUT_HTML=QgsProcessing.TEMPORARY_OUTPUT)  # fmt: skip
    assert results["OUTPUT_HTML"].endswith(".html") and results["OUTPUT"].featureCount() == 6


def test_probability_and_fresnel_zone(run, dem, observers, targets, tmp_path):
    page = tmp_path / "profiles.html"
    results = run("lineofsightprofile", INPUT=dem, OBSERVERS=observers, TARGETS=targets, PROBABILITY=True,
                  REALISATIONS=64, FREQUENCY=900.0, FRESNEL_SHARE=0.5, OUTPUT_HTML=str(page), **COMMON)  # fmt: skip
    for line in results["OUTPUT"].getFeatures():
        assert 0.0 <= line["fresnel_probability"] <= line["probability"] <= 1.0
        assert 0.0 <= line["blocked_bound"] <= 1.0 and line["fresnel_p"] <= line["p"] + 1e-6
    text = page.read_text(encoding="utf-8")
    assert text.count("class='zone'") >= 6 and "Whole line: clear with P" in text and "Fresnel zone" in text
