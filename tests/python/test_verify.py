# SPDX-License-Identifier: GPL-3.0-or-later
"""sb.verify(): deviations known in closed form, planted defects, wrong arguments."""

import numpy as np
import pytest
from osgeo import osr

import sightbound as sb

WEST, NORTH, CELL = 500000.0, 5000000.0, 10.0


def wkt(code):
    system = osr.SpatialReference()
    system.ImportFromEPSG(code)
    return system.ExportToWkt()


UTM = wkt(32633)


def dem_of(heights, south_up=False):
    rows = len(heights)
    transform = (WEST, CELL, 0, NORTH - rows * CELL, 0, CELL) if south_up else (WEST, CELL, 0, NORTH, 0, -CELL)
    return sb.Dem(np.asarray(heights, dtype=np.float32), transform, UTM)


def rough(seed=1, rows=21, cols=25):
    return np.random.default_rng(seed).random((rows, cols)) * 10 + 100


def corners_only(heights, crs=UTM):
    """Two triangles over the four outer samples."""
    rows, cols = heights.shape
    at = [(0, 0), (rows - 1, 0), (rows - 1, cols - 1), (0, cols - 1)]
    vertices = [(WEST + (c + 0.5) * CELL, NORTH - (r + 0.5) * CELL, heights[r, c]) for r, c in at]
    return sb.Tin(vertices, [(0, 1, 2), (0, 2, 3)], crs)


def test_a_dem_and_its_tin_are_the_same():
    dem = dem_of(rough())
    found = sb.verify(dem, sb.Tin.from_dem(dem), 0.001)
    assert found.within_tolerance and found.well_formed
    assert found.largest_deviation < 1e-7  # coordinates of the CRS are rounded to 1e-9 m, and it is steep here
    assert found.report["method"] == "vertical" and found.report["faces_before"] == 2 * 20 * 24
    assert found.vertex_deviation.shape == dem.shape and np.abs(found.vertex_deviation).max() < 1e-8
    assert found.report["uncovered"] == found.report["surplus"] == {"m2": 0.0, "place": None}


@pytest.mark.parametrize("south_up", [False, True])
def test_deviation_of_each_sample(south_up):
    heights = rough().astype(np.float32)
    dem = dem_of(heights[::-1] if south_up else heights, south_up)
    found = sb.verify(dem, corners_only(heights), 20.0)
    row, col = np.mgrid[0:21, 0:25]
    u, v = col / 24, row / 20
    nw, ne, sw, se = (float(heights[r, c]) for r, c in ((0, 0), (0, -1), (-1, 0), (-1, -1)))
    plane = np.where(v >= u, nw + v * (sw - nw) + u * (se - sw), nw + u * (ne - nw) + v * (se - ne))
    expected = plane - heights
    if south_up:
        expected = expected[::-1]
    np.testing.assert_allclose(found.vertex_deviation, expected, atol=1e-4)
    report = found.report
    # Both are straight between the samples, but not along the same diagonal everywhere: the largest may lie between.
    assert report["largest_deviation"]["bound"] >= np.abs(expected).max() - 1e-4
    assert report["rms_deviation"] == pytest.approx(np.sqrt((expected**2).mean()), rel=1e-5)
    assert sum(report["histogram"]["counts"]) == heights.size
    assert report["histogram"]["low"] == pytest.approx(expected.min(), abs=1e-4)


def test_between_the_samples_is_looked_at_too():
    """A saddle, cut along the other diagonal: all four samples agree, the middle is 1 m off."""
    heights = np.array([[0.0, 1.0], [1.0, 0.0]])
    other = [(WEST + 5, NORTH - 5, 0), (WEST + 15, NORTH - 5, 1), (WEST + 5, NORTH - 15, 1), (WEST + 15, NORTH - 15, 0)]
    found = sb.verify(dem_of(heights), sb.Tin(other, [(0, 2, 1), (1, 2, 3)], UTM), 0.9)
    worst = found.report["largest_deviation"]
    assert np.abs(found.vertex_deviation).max() == 0
    assert found.largest_deviation == pytest.approx(1.0) and not found.within_tolerance
    assert worst["place"] == pytest.approx((WEST + 10, NORTH - 10, 1.0))


@pytest.mark.parametrize("south_up", [False, True])
def test_a_tolerance_for_each_sample(south_up):
    heights = np.full((5, 5), 50.0)
    tolerance = np.full((5, 5), 4.0)
    tolerance[1, 3] = 0.5
    lifted = heights + 1
    order = slice(None, None, -1) if south_up else slice(None)
    found = sb.verify(dem_of(heights[order], south_up), corners_only(lifted), tolerance[order])
    assert found.largest_deviation == pytest.approx(1.0) and found.largest_ratio == pytest.approx(2.0)
    assert found.report["largest_ratio"]["place"] == pytest.approx((WEST + 35, NORTH - 15, 51.0))


def test_a_vertex_moved_a_little_beyond_the_tolerance():
    heights = np.full((3, 3), 10.0)
    for share, within in ((0.9999, True), (1.0001, False)):
        tin = sb.Tin.from_dem(dem_of(heights))
        vertices = tin.vertices.copy()
        vertices[4, 2] += share * 0.25
        found = sb.verify(dem_of(heights), sb.Tin(vertices, tin.faces, UTM), 0.25)
        assert found.within_tolerance == within and found.largest_ratio == pytest.approx(share, abs=1e-6)


def test_holes_folds_and_faces_without_width_are_found():
    dem = dem_of(np.full((5, 5), 10.0))
    tin = sb.Tin.from_dem(dem)
    torn = sb.verify(dem, sb.Tin(tin.vertices, tin.faces[1:], UTM), 1.0)
    assert torn.report["uncovered"]["m2"] == pytest.approx(50.0)
    assert torn.report["uncovered"]["place"][:2] == pytest.approx((WEST + 5 + 10 / 3, NORTH - 5 - 20 / 3))
    vertices = tin.vertices.copy()
    vertices[12, 0] += 14.0  # over its neighbour to the east
    folded = sb.verify(dem, sb.Tin(vertices, tin.faces, UTM), 1.0)
    assert folded.report["flipped"]["count"] > 0 and folded.report["folded"]["count"] > 0 and not folded.well_formed
    upright = sb.Tin(np.vstack([tin.vertices, [WEST + 5, NORTH - 5, 20]]), np.vstack([tin.faces, [0, 1, 25]]), UTM)
    assert sb.verify(dem, upright, 100.0).report["degenerate"] == {"count": 1, "first": 32}


def test_holes_of_the_dem_are_no_ground():
    heights = np.full((5, 5), 10.0)
    heights[2, 2] = np.nan
    found = sb.verify(dem_of(heights), corners_only(np.full((5, 5), 10.0)), 1.0)
    assert found.report["surplus"]["m2"] == pytest.approx(300.0) and found.report["uncovered"]["m2"] == 0
    assert np.isnan(found.vertex_deviation[2, 2]) and found.report["uncovered_vertices"] == 0


def test_a_tin_that_is_no_height_field():
    def cube(side):
        corners = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]) * side - side / 2
        quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        return sb.Tin(corners, quads)

    found = sb.verify(cube(10), cube(12), 2.0, resolution=0.2)
    assert found.report["method"] == "distance" and found.report["resolution"] <= 0.2
    assert found.report["largest_deviation"]["measured"] == pytest.approx(np.sqrt(3))
    assert np.sqrt(3) <= found.largest_deviation <= np.sqrt(3) + 0.2 + 1e-9
    assert found.within_tolerance and found.vertex_deviation.tolist() == [1.0] * 8


def test_same_for_any_number_of_threads():
    heights = rough(4, 200, 210)
    one, two = (sb.verify(dem_of(heights), corners_only(heights), 3.0, threads=n) for n in (1, 2))
    assert one.report == two.report and (one.vertex_deviation == two.vertex_deviation).all()


def test_bad_arguments_are_named():
    dem, tin = dem_of(rough()), corners_only(rough())
    cases = {
        "tolerance is 0": {"tolerance": 0},
        "tolerance is -1": {"tolerance": -1.0},
        "tolerance is nan": {"tolerance": np.nan},
        r"tolerance has the shape \(3,\); give one number, or an array of \(21, 25\)": {"tolerance": [1, 2, 3]},
        "tolerance of vertex 0": {"tolerance": np.full((21, 25), -1.0)},
        "different CRSs": {"simplified": corners_only(rough(), wkt(32634))},
        "no place in common": {"original": sb.Dem(rough(), (0, CELL, 0, 0, 0, -CELL), UTM)},
        "threads": {"threads": 0},
    }
    for message, given in cases.items():
        with pytest.raises(ValueError, match=message):
            sb.verify(**{"original": dem, "simplified": tin, "tolerance": 1.0, **given})
    with pytest.raises(MemoryError, match="Verifying 2 faces against 525 samples"):
        sb.verify(dem, tin, 1.0, memory_budget=1000)
    for given in ({"original": "dem.tif"}, {"simplified": dem}):
        with pytest.raises(TypeError, match="sightbound.Tin"):
            sb.verify(**{"original": dem, "simplified": tin, "tolerance": 1.0, **given})
    with pytest.raises(ValueError, match="resolution is -1"):
        upright = sb.Tin([(0, 0, 0), (10, 0, 0), (10, 0, 10)], [(0, 1, 2)])
        sb.verify(upright, upright, 1.0, resolution=-1)


def test_progress_and_cancel():
    dem, tin, fractions = dem_of(rough()), corners_only(rough()), []
    sb.verify(dem, tin, 1.0, progress=lambda f: fractions.append(f) or True)
    assert fractions[-1] == 1 and fractions == sorted(fractions)
    with pytest.raises(sb.Cancelled):
        sb.verify(dem, tin, 1.0, progress=lambda f: False)
