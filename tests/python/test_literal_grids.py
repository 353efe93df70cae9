# SPDX-License-Identifier: GPL-3.0-or-later
"""Tiny grids whose answers are worked out by hand. V visible, u uncertain, - hidden, . nodata or not asked.

Cells of 10 m, flat earth, eye and targets in metres above ground; columns count from 0 in the west, rows from the north."""
from statistics import NormalDist

import numpy as np
import pytest
import sightbound as sb

PHI = NormalDist().cdf
NAN = float("nan")


def gt(rows, south_up=False):
    return (0, 10, 0, 0, 0, 10) if south_up else (0, 10, 0, 10 * rows, 0, -10)


def centre(col, row, rows):
    return 10 * col + 5, 10 * (rows - row) - 5


def look(z, *eyes, error=None, south_up=False, **how):
    z = np.float32(z)
    model = sb.ErrorModel(**{"vertical_rmse": 0, "geologic_variation": 0, **(error or {})})
    dem = sb.Dem(z[::-1] if south_up else z, gt(len(z), south_up))
    how = {"observer_height": 2.0, "curvature": False, **how}
    return sb.viewshed(dem, [centre(*eye, len(z)) for eye in eyes], error_model=model, **how)


def drawn(result):
    return ["".join({0: "-", 1: "u", 2: "V", 255: "."}[int(v)] for v in row) for row in result.verdict]


WALL = [[0, 0, 0, 5, 0, 0, 0, 0]] * 3


def test_wall():
    """The line from 2 m to the ground cannot pass a wall of 5 m; the wall's own top is seen."""
    assert drawn(look(WALL, (0, 1))) == ["VVVV----",
                                         "VVVV----",
                                         "VVVV----"]


def test_wall_in_doubt():
    """sigma 4 m. At the wall (column 3) the line to column c is 2 (c - 3) / c high, 5 m is the wall:

        c = 5: 0.8 - 5 = -4.2 m, k = -1.05        c = 6: k = -1        c = 7: k = 1.142857 - 5 over 4 = -0.964286

    Column 4 is nearer than 1.5 cells to the wall: only the floor of 1 mm counts there, and it is surely hidden."""
    result = look(WALL, (0, 1), error={"vertical_rmse": 4})
    assert drawn(result)[1] == "VVVV-uuu"
    assert result.confidence[1] == pytest.approx([1, 1, 1, 1, 0, PHI(-1.05), PHI(-1), PHI(-27 / 28)], abs=1e-6)
    assert result.confidence.dtype == np.float32 and result.verdict.dtype == np.uint8 and result.count.dtype == np.uint32


def test_lowest_visible_heights():
    """Column 6, wall at half way: the top must reach 2 (5 + 1.96 * 0.5) - 2 for certain, 2 * 5 - 2 to be as likely as not."""
    result = look(WALL, (0, 1), error={"vertical_rmse": 0.5}, heights=True)
    assert result.likely_visible_height[1, 6] == pytest.approx(8, abs=0.1)
    assert result.lowest_visible_height[1, 6] == pytest.approx(2 * (5 + 1.959964 * 0.5) - 2, abs=0.1)
    assert result.likely_visible_height[1, 3] == 0 and result.lowest_visible_height[1, 3] == pytest.approx(0, abs=0.1)


RING = [[9, 9, 9],
        [9, 0, 9],
        [9, 9, 9]]


def test_the_diagonal_is_north_west_to_south_east():
    """From the middle of the pit the way to the north-east crosses the edge from the north to the east sample, 9 m high, where
    the line is (2 + 9) / 2 = 5.5 m; the ways to the north-west and south-east run along an edge, below the line."""
    assert drawn(look(RING, (1, 1))) == ["VV-",
                                         "VVV",
                                         "-VV"]


def test_the_diagonal_is_that_of_the_ground_in_a_south_up_file():
    assert drawn(look(RING, (1, 1), south_up=True)) == ["-VV",
                                                        "VVV",
                                                        "VV-"]


def test_a_rotated_file_keeps_the_ground_s_diagonal():
    """The same pit with the file's columns running south and its rows running east."""
    result = sb.viewshed(sb.Dem(np.float32(RING), (0, 0, 10, 30, -10, 0)), [(15, 15)], observer_height=2.0, curvature=False,
                         error_model=sb.ErrorModel(0, 0, 0))
    assert drawn(result) == ["VV-", "VVV", "-VV"]


def test_hole():
    """Behind a hole a clear line is worth 0.5; the hole itself has no answer."""
    z = [[0, 0, 0, 0, NAN, 0, 0, 0, 0]] * 3
    result = look(z, (0, 1), target_height=2)
    assert drawn(result)[1] == "VVVV.uuuu"
    assert result.confidence[1, 5:] == pytest.approx([0.5] * 4)
    assert np.isnan(result.confidence[1, 4]) and result.count[1, 4] == 4294967295
    assert result.count[1, :4].tolist() == [1] * 4 and result.count[1, 5:].tolist() == [0] * 4
    assert drawn(look(z, (0, 1), target_height=2, see_across_nodata=True))[1] == "VVVV.VVVV"


def test_a_wall_before_the_hole_still_hides():
    z = [[0, 0, 9, 0, NAN, 0, 0, 0, 0]] * 3
    assert drawn(look(z, (0, 1)))[1] == "VVV-.----"


def test_no_certain_height_behind_a_hole():
    z = [[0, 0, 0, 0, NAN, 0, 0, 0, 0]] * 3
    result = look(z, (0, 1), heights=True)
    assert not np.isfinite(result.lowest_visible_height[1, 5:]).any()
    assert result.likely_visible_height[1, 5:] == pytest.approx([0] * 4, abs=0.1)
    assert np.isnan(result.lowest_visible_height[1, 4])


def test_two_observers():
    """A wall between them: each sees his side and the wall's top."""
    assert drawn(look(WALL, (0, 1), (7, 1)))[1] == "VVVVVVVV"
    assert drawn(look(WALL, (0, 1), (7, 1), combine="worst"))[1] == "---V----"
    assert look(WALL, (0, 1), (7, 1)).count[1].tolist() == [1, 1, 1, 2, 1, 1, 1, 1]
    assert look(WALL, (0, 1), (7, 1), combine="worst").count[1].tolist() == [1, 1, 1, 2, 1, 1, 1, 1]


def test_worst_counts_only_observers_in_range():
    result = look(WALL, (0, 1), (7, 1), combine="worst", max_distance=[35, 35])
    assert drawn(result)[1] == "VVVVVVVV"   # columns 0-3 are only the first's, 4-7 only the second's


def test_standing_on_the_ground():
    """Flat, sigma 0.5 at both ends and in between, eye and target 2 m: k = 2 / (0.5 + 0.5) where the line was 4 sigmas clear.
    Near the ends only the ends' own 0.5 counts."""
    z = [[0] * 9] * 3
    assert look(z, (0, 1), target_height=2, error={"vertical_rmse": 0.5}).confidence[1, 8] == 1
    result = look(z, (0, 1), target_height=2, error={"vertical_rmse": 0.5}, stand="ground")
    assert result.confidence[1, 8] == pytest.approx(PHI(2), abs=1e-6)
    assert drawn(result)[1] == "VVVVVVVVV"


def test_absolute_heights():
    """Eye at 8 m above the datum on ground of 6 m, targets at 6 m: a ridge of 7.5 m in column 3 hides those behind it."""
    z = [[6, 6, 6, 7.5, 6, 6, 6, 6]] * 3
    result = look(z, (0, 1), observer_height=8, target_height=6.0, height_reference="absolute")
    assert drawn(result)[1] == "VVV-----"   # 6 m is inside the ridge in column 3
    assert result.report["observers"][0]["ground_height"] == 6 and result.report["observers"][0]["eye_height"] == 8


def test_ground_raster():
    """Trees of 4.5 m on flat ground: with the bare ground given, the eye stands beneath, not on top of them."""
    trees = np.float32([[4.5, 4.5, 0, 0, 0, 0]] * 3)
    ground = sb.Dem(np.zeros_like(trees), gt(3))
    on_top = look(trees, (0, 1))
    below = look(trees, (0, 1), ground=ground)
    assert drawn(on_top)[1] == "VV--VV"      # the edge of the trees hides the ground right before it
    assert drawn(below)[1] == "V-----"
    assert below.report["observers"][0]["eye_height"] == 2


def test_smallest_dem():
    assert drawn(look([[0, 0], [0, 0]], (0, 0), observer_height=5)) == ["VV", "VV"]


@pytest.mark.parametrize("shape", [(1, 8), (8, 1), (1, 1), (0, 0)])
def test_a_terrain_needs_two_rows_and_columns(shape):
    with pytest.raises(ValueError, match="2 x 2|2 rows"):
        sb.Dem(np.zeros(shape, np.float32), gt(8))


def test_an_eye_in_the_outer_half_of_a_border_cell_stands_on_the_rim():
    """The terrain ends at the cell centres; 3 m east of the last one is taken as on it."""
    dem, model = sb.Dem(np.float32(WALL), gt(3)), sb.ErrorModel(0, 0, 0)
    inside, outside = (sb.viewshed(dem, [(x, 15)], error_model=model, curvature=False) for x in (75, 78))
    assert inside.confidence.tobytes() == outside.confidence.tobytes()


def test_an_eye_below_the_ground():
    result = look(WALL, (0, 1), observer_height=-1)
    assert drawn(result)[1] == "V-------"
    assert result.report["observers"][0]["status"] != "ok" and any("below the terrain" in w for w in result.report["warnings"])
