# SPDX-License-Identifier: GPL-3.0-or-later
"""Listed targets, and all targets at one height, in the scene of a ridge on a plain."""

import numpy as np
import pytest
from osgeo import gdal, osr

import sightbound as sb

WEST, NORTH, CELL = 500000.0, 5000000.0, 10.0
EXACT = sb.ErrorModel(vertical_rmse=0.3, geologic_variation=0.0)
HIDDEN, UNCERTAIN, VISIBLE, NONE = 0, 1, 2, 255


def ridge():
    """A plain at 100 m with a ridge 12 m high, three samples wide, along column 20."""
    system = osr.SpatialReference()
    system.ImportFromEPSG(32633)
    heights = np.full((21, 41), 100.0, dtype=np.float32)
    heights[:, 19:22] = 112.0
    return sb.Dem(heights, (WEST, CELL, 0, NORTH, 0, -CELL), system.ExportToWkt())


@pytest.fixture(scope="module")
def volume():
    return sb.ErrorVolume.build(ridge(), EXACT, voxel=2.0, voxel_height=0.5)


def place(col, row=10.3):
    return WEST + col * CELL, NORTH - row * CELL


EYE = place(5)
SIGHT = {"view_height": 3, "curvature": False}


def test_a_target_behind_the_ridge_is_hidden(volume):
    found = sb.volume_targets(volume, [EYE], [place(30), place(12), place(30)], [2, 2, 60], **SIGHT)
    assert found.verdict.tolist() == [HIDDEN, VISIBLE, VISIBLE]
    assert found.verdict.dtype == np.uint8 and found.confidence.dtype == np.float32
    assert found.confidence[0] < 0.001 and found.confidence[1] > 0.999
    assert (found.report["targets"], found.report["lines"], found.report["warnings"]) == (3, 3, [])


def test_a_list_of_lattice_places_gets_the_lattices_verdicts(volume):
    views = [EYE, place(35)]
    sight = {**SIGHT, "holds_for": "place", "confidence": 0.9}
    lattice = sb.volume_viewshed(volume, views, target_ceiling=24, target_spacing=20, **sight)
    x0, step, _, y0, _, down = lattice.geotransform
    asked = lattice.lattice
    places = [(x0 + (i + 0.5) * step, y0 + (j + 0.5) * down) for j in range(asked["rows"]) for i in range(asked["columns"])]
    count = 0
    for height in np.arange(90 + asked["height_spacing"] / 2, 140, asked["height_spacing"]):
        answers = [lattice.at(*place, height) for place in places]
        if not any(answers):
            continue
        found = sb.volume_targets(volume, views, places, height, "absolute", **sight)
        for answer, verdict, p in zip(answers, found.verdict, found.confidence):
            if answer is not None:
                count += 1
                assert verdict == answer[0] and p == pytest.approx(answer[1], abs=1e-3)
    assert count == asked["targets"] > 500


def test_a_layer_is_a_list_of_its_cells_middles(volume):
    sight = {**SIGHT, "holds_for": "place"}
    layer = sb.volume_layer(volume, [EYE], 2.0, target_spacing=10, **sight)
    x0, step, _, y0, _, down = layer.geotransform
    assert (step, down) == (10, -10) and "UTM zone 33N" in layer.crs_wkt
    rows, cols = layer.verdict.shape
    places = [(x0 + (i + 0.5) * step, y0 + (j + 0.5) * down) for j in range(rows) for i in range(cols)]
    listed = sb.volume_targets(volume, [EYE], places, 2.0, **sight)
    assert (listed.verdict.reshape(rows, cols) == layer.verdict).all()
    np.testing.assert_allclose(listed.confidence.reshape(rows, cols), layer.confidence, atol=1e-3)
    assert {HIDDEN, VISIBLE} <= set(layer.verdict.ravel().tolist())
    assert layer.report["targets"] == (layer.verdict != NONE).sum()


def test_claims_for_whole_cells_are_fewer(volume):
    def claims(word):
        verdict = sb.volume_layer(volume, [EYE], 2.0, **SIGHT, holds_for=word).verdict
        return (verdict == HIDDEN).sum() + (verdict == VISIBLE).sum()

    assert claims("place") >= claims("voxel") >= claims("target") > 0
    assert claims("place") > claims("target")


def test_seen_from_any_and_from_all(volume):
    views = [EYE, place(35)]
    for word, verdict in (("any", VISIBLE), ("all", HIDDEN)):
        found = sb.volume_targets(volume, views, [place(10), place(30)], 2, seen_from=word, **SIGHT)
        assert found.verdict.tolist() == [verdict, verdict]


def test_what_cannot_be_asked_has_no_verdict(volume):
    targets = [place(12), (0.0, 0.0), place(20)]
    found = sb.volume_targets(volume, [EYE], targets, 103.0, "absolute", **SIGHT)
    assert found.verdict.tolist() == [VISIBLE, NONE, NONE] and np.isnan(found.confidence[1:]).all()
    off, beneath = found.report["warnings"]
    assert "1 of 3 targets are not on the terrain" in off and "1 of 3 targets are beneath the ground" in beneath
    far = sb.volume_targets(volume, [EYE], [place(12), place(30)], 2.0, max_distance=100, **SIGHT)
    assert far.verdict.tolist() == [VISIBLE, NONE]


def test_bad_arguments_are_named(volume):
    cases = {
        "targets is empty": {"targets": []},
        r"sequence of \(x, y\)": {"targets": EYE},
        r"\(x, y\) of target 2 is nan": {"targets": [EYE, (np.nan, 0.0)]},
        "target_height of target 1 is nan": {"target_height": [np.nan]},
        "target_height has 2 values for 1 target;": {"target_height": [1, 2]},
        "height is 1000000000": {"target_height": 1e9},
        "height_reference is 'sea'": {"target_height_reference": "sea"},
        "None of the targets": {"targets": [(0.0, 0.0)]},
        "views is empty": {"views": []},
        "Fewer targets": {"targets": [EYE, EYE], "most_lines": 1},
        "confidence": {"confidence": 1.5},
    }
    for message, given in cases.items():
        with pytest.raises(ValueError, match=message):
            sb.volume_targets(volume, **{"views": [EYE], "targets": [place(12)], **given})
    for message, given in {"target_height is 0": {"target_height": 0}, "target_spacing is -1": {"target_spacing": -1}}.items():
        with pytest.raises(ValueError, match=message):
            sb.volume_layer(volume, **{"views": [EYE], "target_height": 2, **given})
    with pytest.raises(TypeError, match="ErrorVolume"):
        sb.volume_targets(ridge(), [EYE], [EYE])


def test_progress_and_cancel(volume):
    fractions = []
    sb.volume_layer(volume, [EYE], 2, progress=lambda f: fractions.append(f) or True)
    assert fractions[-1] == 1 and fractions == sorted(fractions)
    for see in (lambda stop: sb.volume_layer(volume, [EYE], 2, progress=stop),
                lambda stop: sb.volume_targets(volume, [EYE], [place(12)], 2, progress=stop)):
        with pytest.raises(sb.Cancelled):
            see(lambda f: False)


def test_layers_are_written_with_how_they_were_made(volume, tmp_path):
    layer = sb.volume_layer(volume, [EYE], 2.0, target_spacing=20, **SIGHT)
    layer.write(tmp_path / "p.tif", verdict=tmp_path / "verdict.tif")
    verdict, p = gdal.Open(str(tmp_path / "verdict.tif")), gdal.Open(str(tmp_path / "p.tif"))
    assert (verdict.ReadAsArray() == layer.verdict).all() and verdict.GetRasterBand(1).GetNoDataValue() == NONE
    np.testing.assert_array_equal(p.ReadAsArray(), layer.confidence)
    assert tuple(p.GetGeoTransform()) == layer.geotransform
    notes = p.GetMetadata()
    assert notes["SIGHTBOUND_TARGET_HEIGHT"] == "2" and notes["SIGHTBOUND_TARGET_SPACING"] == "20"
    assert notes["SIGHTBOUND_CONFIDENCE"] == "0.95" and '"vertical_rmse"' in notes["SIGHTBOUND_ERROR_MODEL"]
    with pytest.raises(ValueError, match="name at least one"):
        layer.write()
