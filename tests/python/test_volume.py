# SPDX-License-Identifier: GPL-3.0-or-later
"""Error volumes and hidden volumes from Python: scenes whose answer is known, files, bad arguments."""

import numpy as np
import pytest
from osgeo import osr

import sightbound as sb

WEST, NORTH, CELL = 500000.0, 5000000.0, 10.0
EXACT = sb.ErrorModel(vertical_rmse=0.3, geologic_variation=0.0)


def wkt(code):
    system = osr.SpatialReference()
    system.ImportFromEPSG(code)
    return system.ExportToWkt()


def dem_of(heights, west=WEST):
    return sb.Dem(np.asarray(heights, dtype=np.float32), (west, CELL, 0, NORTH, 0, -CELL), wkt(32633))


def wall(rows=21, cols=41):
    """A plain at 100 m with a ridge 12 m high, three samples wide, along column 20."""
    heights = np.full((rows, cols), 100.0)
    heights[:, 19:22] = 112.0
    return dem_of(heights)


@pytest.fixture(scope="module")
def volume():
    return sb.ErrorVolume.build(wall(), EXACT, voxel=2.0, voxel_height=0.5)


@pytest.fixture(scope="module")
def eye():
    return WEST + 5 * CELL, NORTH - 10.3 * CELL


@pytest.fixture(scope="module")
def hidden(volume, eye):
    return sb.volume_viewshed(volume, [eye], view_height=3, target_ceiling=30, target_spacing=5, curvature=False)


def place(col, row):
    return WEST + col * CELL, NORTH - row * CELL


def test_estimate_says_what_build_takes(volume):
    need = sb.ErrorVolume.estimate(wall(), EXACT, voxel=2.0, voxel_height=0.5)
    assert (need["voxel"], need["voxel_height"]) == (volume.voxel, volume.voxel_height) == (2.0, 0.5)
    assert 0.3 < need["voxels"] / volume.report["voxels"] < 3
    assert volume.is_height_field and '"vertical_rmse": 0.3' in volume.report["error_model"]


def test_behind_a_wall(hidden):
    x, y = place(30, 10.3)
    verdict, p = hidden.at(x, y, 102.0)
    assert verdict == 0 and p < 0.001  # surely hidden
    verdict, p = hidden.at(x, y, 128.0)
    assert verdict == 2 and p > 0.999
    near_x, near_y = place(12, 10.3)
    assert hidden.at(near_x, near_y, 103.0)[0] == 2
    assert hidden.at(x, y, 20.0) is None and hidden.at(WEST - 1000, y, 102.0) is None


def test_rasters_follow_the_line_over_the_wall(hidden):
    rasters = hidden.rasters()
    west, step, _, north, _, _ = hidden.geotransform
    x, y = place(30, 10.3)
    col, row = int((x - west) / step), int((north - y) / step)
    over = 103 + (112 - 103) / 15.5 * 25  # from the eye over the ridge's far edge, 155 m off, to 250 m
    assert rasters.lowest_visible_height[row, col] + 100 == pytest.approx(over, abs=6)
    assert 0 < rasters.core_thickness[row, col] <= rasters.thickness[row, col] < 30
    assert rasters.thickness.dtype == np.float32


def test_volumes_areas_and_places_agree(hidden):
    volumes, rasters = hidden.volumes(), hidden.rasters()
    column = hidden.lattice["spacing"] ** 2
    assert np.nansum(rasters.thickness) * column == pytest.approx(volumes["hidden_m3"] + volumes["uncertain_m3"])
    assert np.nansum(rasters.core_thickness) * column == pytest.approx(volumes["hidden_m3"])
    area, places = hidden.area(1.8), hidden.places(1.8, most=10**6)
    assert sum(one["area_m2"] for one in places) == pytest.approx(area["hidden_m2"])
    assert 0 < area["core_m2"] <= area["hidden_m2"] <= area["asked_m2"]
    assert hidden.area(25.0)["hidden_m2"] <= area["hidden_m2"]
    assert places[0]["deepest"][0] > WEST + 21 * CELL  # behind the ridge


def test_an_observer_on_the_other_side_takes_it_away(volume, hidden, eye):
    other = place(36, 10.3)
    rest, gain = sb.subtract_observer(hidden, volume, [other], view_height=3, height=1.8, curvature=False)
    alone = sb.volume_viewshed(volume, [other], view_height=3, target_ceiling=30, target_spacing=5, curvature=False)
    both = sb.volume_viewshed(volume, [eye, other], view_height=3, target_ceiling=30, target_spacing=5, curvature=False)
    assert rest == (hidden | alone) == both
    assert gain["gained_m3"] == pytest.approx(rest.volumes()["visible_m3"] - hidden.volumes()["visible_m3"])
    assert gain["gained_m2"] == gain["before"]["hidden_m2"] - gain["after"]["hidden_m2"] > 0
    assert (alone - hidden).volumes()["visible_m3"] == pytest.approx(gain["gained_m3"])
    all_see = sb.volume_viewshed(
        volume, [eye, other], view_height=3, target_ceiling=30, target_spacing=5, seen_from="all", curvature=False
    )
    assert all_see == (hidden & alone)
    assert len(rest.report["observers"]) == 2


def test_patrol_areas_have_places_inside(volume):
    corners = [place(3, 5), place(9, 5), place(9, 12), place(3, 12)]
    need = sb.estimate_volume_viewshed(volume, [corners], view_height=2, view_height_to=6, view_spacing=10)
    assert 30 <= need["view_places"] / 2 <= 54 and need["lines"] == need["view_places"] * need["targets"]
    assert need["seconds"] > 0
    tiny = [place(3, 5), place(3.01, 5), place(3, 5.01)]
    assert sb.estimate_volume_viewshed(volume, [tiny], view_spacing=10)["view_places"] >= 1


def test_claims_shrink_as_they_hold_for_more(volume, eye):
    claims = []
    for word in ("place", "voxel", "target"):
        seen = sb.volume_viewshed(volume, [eye], view_height=3, target_ceiling=30, target_spacing=5, holds_for=word).volumes()
        claims.append(seen["hidden_m3"] + seen["visible_m3"])
    assert claims[0] > claims[1] > claims[2] > 0.3 * claims[0]


def test_hidden_from_an_area_is_hidden_from_all_of_it(volume):
    area, rng = [place(2, 4), place(10, 5), place(4, 13)], np.random.default_rng(1)
    seen = sb.volume_viewshed(volume, [area], view_height=2, target_ceiling=30, target_spacing=5, view_spacing=40)
    assert seen.volumes()["hidden_m3"] > 0
    for _ in range(12):
        share = np.sort(rng.random(2))
        share = np.diff([0, *share, 1])  # even over the triangle
        somewhere = tuple(float(v) for v in share @ np.array(area))
        alone = sb.volume_viewshed(
            volume, [somewhere], view_height=2, target_ceiling=30, target_spacing=5, holds_for="place"
        )
        # Nothing that the area never sees is less than hidden from a place in it.
        assert (seen | alone).volumes()["hidden_m3"] == seen.volumes()["hidden_m3"]


def test_nobody_looks_out_of_a_hole(volume):
    def square(col, row, cells):
        return [place(col, row), place(col + cells, row), place(col + cells, row + cells), place(col, row + cells)]

    def places(*views):
        return sb.estimate_volume_viewshed(volume, views, view_height=2, view_spacing=10)["view_places"]

    outline, hole = square(2, 5, 12), square(5, 8, 4)
    assert places([outline, hole]) == places(outline) - places(hole) == 144 - 16
    assert places([outline]) == places(outline) and places([outline, hole, square(6, 9, 2)]) == 144 - 16 + 4
    assert places([square(2, 5, 3), square(8, 5, 2)]) == places(square(2, 5, 3), square(8, 5, 2)) == 9 + 4
    assert places(np.array(outline), [np.array(outline), np.array(hole)]) == 2 * 144 - 16
    # From the plain and the ridge; with the ridge in a hole there is no view behind it.
    ridge = [place(15, 1.1), place(20.95, 1.1), place(20.95, 17.9), place(15, 17.9)]
    seen = [
        sb.volume_viewshed(volume, [view], view_height=2, target_spacing=20, view_spacing=20, curvature=False)
        for view in (square(4, 1, 17), [square(4, 1, 17), ridge])
    ]
    assert seen[0].volumes()["visible_m3"] > seen[1].volumes()["visible_m3"] > 0
    assert "further_rings" in seen[1].report["observers"][0]
    for wrong, message in (([outline, [place(5, 8)]], "too few corners"), ([outline, outline], "without area"),
                           ([outline, [place(5, 8), 3.0]], "view 1")):
        with pytest.raises(ValueError, match=message):
            places(wrong)


def test_same_bytes_for_any_number_of_threads(volume, hidden, eye, tmp_path):
    again = sb.volume_viewshed(
        volume, [eye], view_height=3, target_ceiling=30, target_spacing=5, curvature=False, threads=1
    )
    hidden.save(tmp_path / "a.vdb")
    again.save(tmp_path / "b.vdb")
    assert again == hidden and (tmp_path / "a.vdb").read_bytes() == (tmp_path / "b.vdb").read_bytes()


def test_files_come_back(volume, hidden, eye, tmp_path):
    volume.save(tmp_path / "volume.vdb")
    opened = sb.ErrorVolume.open(tmp_path / "volume.vdb")
    assert opened.report["error_model"] == volume.report["error_model"] and opened.bounds == volume.bounds
    again = sb.volume_viewshed(opened, [eye], view_height=3, target_ceiling=30, target_spacing=5, curvature=False)
    assert again == hidden
    hidden.save(tmp_path / "hidden.vdb")
    back = sb.HiddenVolume.open(tmp_path / "hidden.vdb")
    assert back == hidden and back.report["observers"] == hidden.report["observers"]
    with pytest.raises(ValueError, match="not an error volume"):
        sb.ErrorVolume.open(tmp_path / "hidden.vdb")
    with pytest.raises(ValueError, match="not a hidden volume"):
        sb.HiddenVolume.open(tmp_path / "volume.vdb")
    with pytest.raises(OSError, match="cannot be opened"):
        sb.HiddenVolume.open(tmp_path / "none.vdb")


def test_written_rasters_and_mesh(hidden, tmp_path):
    gdal = pytest.importorskip("osgeo.gdal")
    gdal.UseExceptions()
    hidden.write(thickness=tmp_path / "t.tif", core_thickness=tmp_path / "c.tif", top=tmp_path / "top.ply")
    dataset = gdal.Open(str(tmp_path / "t.tif"))
    assert np.array_equal(dataset.ReadAsArray(), hidden.rasters().thickness, equal_nan=True)
    assert dataset.GetGeoTransform() == hidden.geotransform
    assert dataset.GetMetadataItem("SIGHTBOUND_TARGET_SPACING") == "5"
    top = sb.read_tin(tmp_path / "top.ply")
    assert {"p", "thickness"} <= set(top.vertex_attributes) and top.is_height_field
    assert top.faces.shape[0] == 2 * np.count_nonzero(hidden.rasters().thickness > 0)
    assert hidden.write(fog=tmp_path / "fog.gpkg") == []
    fog = sb.read_tin(tmp_path / "fog.gpkg")
    corners = top.vertex_attributes["p"][top.faces].mean(axis=1)
    assert fog.faces.shape == top.faces.shape and np.allclose(np.sort(fog.face_attributes["p"]), np.sort(corners), atol=1e-6)
    for wrong in ({"fog": tmp_path / "fog.ply"}, {"fog": tmp_path / "a.gpkg", "top": tmp_path / "a.gpkg"}):
        with pytest.raises(ValueError, match="fog"):
            hidden.write(**wrong)
    with pytest.raises(ValueError, match="nothing to write"):
        hidden.write()


def test_the_curve_of_the_earth_hides():
    """On a plain the ground 20 km off lies 6 m below the horizon of an eye 10 m up."""
    flat = sb.ErrorVolume.build(dem_of(np.full((12, 2001), 50.0)), EXACT, voxel=10.0, voxel_height=1.0)
    eye = WEST + 15.0, NORTH - 65.0
    distance, found = 100.0 * 199.5 - 15.0, []
    for bend in (1 / (2 * 6.38e6), 0.87 / (2 * 6.38e6), 0.0):
        seen = sb.volume_viewshed(
            flat, [eye], view_height=10.0, target_spacing=100.0, target_height_spacing=1.0, target_ceiling=40.0,
            refraction=0.13 if bend < 7e-8 else 0.0, curvature=bend > 0,
        )
        found.append(seen.rasters().lowest_visible_height[-1, 199])
        horizon = (10.0 / bend) ** 0.5 if bend else np.inf
        expected = bend * max(distance - horizon, 0.0) ** 2
        # A claim clears the ground by z(0.95) sigma and a voxel: the eye is as good as 2 m lower.
        assert expected - 0.5 <= found[-1] <= expected + 6
    assert found[0] > found[1] + 1 > found[2] + 1


def test_bad_arguments_are_named(volume, eye):
    cases = {
        "views is empty": {"views": []},
        "For one place": {"views": eye},
        "target_spacing is 0": {"target_spacing": 0},
        "target_ceiling is -1": {"target_ceiling": -1},
        "at most the ceiling": {"target_height_spacing": 50},
        "confidence": {"confidence": 0.99999},
        "seen_from is 'some'": {"seen_from": "some"},
        "'place', 'voxel' and 'target'": {"holds_for": "all"},
        "view_height has 3 values": {"view_height": [1, 2, 3]},
        "ends at 1": {"view_height": 3, "view_height_to": 1},
        "not on the terrain": {"views": [(0.0, 0.0)]},
        "two corners": {"views": [[eye, eye]]},
        "max_distance": {"max_distance": -5},
        "would fit": {"most_lines": 10},
        "view_spacing": {"view_spacing": -1},
    }
    for message, given in cases.items():
        with pytest.raises(ValueError, match=message):
            sb.volume_viewshed(volume, **{"views": [eye], **given})
    with pytest.raises(TypeError, match="ErrorVolume"):
        sb.volume_viewshed(wall(), [eye])
    with pytest.raises(ValueError, match="voxel is -1"):
        sb.ErrorVolume.build(wall(), EXACT, voxel=-1)
    with pytest.raises(MemoryError, match="would fit"):
        sb.ErrorVolume.build(wall(), EXACT, voxel=0.05, memory_budget=10**6)
    degrees = sb.Dem(np.zeros((5, 5), np.float32), (10, 0.01, 0, 50, 0, -0.01), wkt(4326))
    with pytest.raises(ValueError, match="reproject"):
        sb.ErrorVolume.build(degrees, EXACT)


def test_a_tin_needs_a_model(volume):
    tin = sb.Tin.from_dem(wall())
    with pytest.raises(ValueError, match="cannot be learnt"):
        sb.ErrorVolume.build(tin)
    same = sb.ErrorVolume.build(tin, EXACT, voxel=2.0, voxel_height=0.5)
    assert same.report["voxels"] == volume.report["voxels"]


def test_another_volume_is_refused(hidden, eye):
    elsewhere = sb.ErrorVolume.build(dem_of(np.full((21, 41), 100), WEST + 7), EXACT, voxel=2.0, voxel_height=0.5)
    with pytest.raises(ValueError, match="another error volume"):
        sb.subtract_observer(hidden, elsewhere, [eye], view_height=3)


def test_progress_and_cancel(volume, eye):
    fractions = []
    sb.volume_viewshed(volume, [eye], progress=lambda f: fractions.append(f) or True)
    assert fractions[-1] == 1 and fractions == sorted(fractions)
    with pytest.raises(sb.Cancelled):
        sb.volume_viewshed(volume, [eye], progress=lambda f: False)
    with pytest.raises(sb.Cancelled):
        sb.ErrorVolume.build(wall(), EXACT, progress=lambda f: False)
