# SPDX-License-Identifier: GPL-3.0-or-later
"""dem_to_tin: what the caller gets and is told. That the TIN stays within its tolerance everywhere is held in C++ against an overlay
of both surfaces; here, against places strewn over the DEM."""

import numpy as np
import pytest
from osgeo import gdal, osr

import sightbound as sb

WEST, NORTH, CELL = 500000.0, 5000000.0, 10.0


def crs(code=32633):
    system = osr.SpatialReference()
    system.ImportFromEPSG(code)
    return system.ExportToWkt()


def hills(rows=41, cols=53):
    y, x = np.mgrid[:rows, :cols]
    rough = np.random.default_rng(3).normal(0, 0.6, (rows, cols))
    return (100 + 20 * np.sin(x / 7.0) * np.cos(y / 9.0) + rough).astype(np.float32)


def dem_of(heights, step=-CELL):
    return sb.Dem(heights, (WEST, CELL, 0, NORTH, 0, step), crs())


@pytest.fixture(scope="module")
def dem():
    return dem_of(hills())


def height_of_tin(tin, x, y):
    """Of each place the height of the face over it; nan where there is none. Brute force."""
    corners = tin.vertices[tin.faces]
    heights = np.full(len(x), np.nan)
    for a, b, c in corners:
        twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        u = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / twice
        v = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / twice
        inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9)
        heights[inside] = (a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]))[inside]
    return heights


def height_of_dem(grid, x, y):
    """The regular TIN, NW-SE diagonals; `grid` of values at cell centres, north up."""
    col, row = (x - WEST) / CELL - 0.5, (NORTH - y) / CELL - 0.5
    c, r = np.floor(col).astype(int), np.floor(row).astype(int)
    u, v = col - c, row - r
    nw, ne, sw, se = (grid[r + i, c + j].astype(float) for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)))
    return np.where(u >= v, nw + u * (ne - nw) + v * (se - ne), nw + v * (sw - nw) + u * (se - sw))


def strewn(rows, cols, count=3000):
    random = np.random.default_rng(1)
    col, row = random.uniform(0, cols - 1, count), random.uniform(0, rows - 1, count)
    keep = (col < cols - 1) & (row < rows - 1)
    return WEST + (col[keep] + 0.5) * CELL, NORTH - (row[keep] + 0.5) * CELL


def test_the_tin_stays_within_the_tolerance(dem):
    tin = sb.dem_to_tin(dem, tolerance=2.0)
    x, y = strewn(*dem.shape)
    off = np.abs(height_of_tin(tin, x, y) - height_of_dem(hills(), x, y))
    assert np.isfinite(off).all() and 1.0 < off.max() <= 2.0
    report = tin.report
    assert report["faces_before"] == 2 * 40 * 52 and report["faces_after"] == len(tin.faces) < 0.3 * report["faces_before"]
    assert off.max() <= report["largest_deviation"] <= 2.0 and report["largest_ratio"] <= 1
    assert tin.face_attributes["deviation"].max() == pytest.approx(report["largest_deviation"], rel=1e-6)
    assert report["least_tolerance"] == report["largest_tolerance"] == 2.0
    assert report["warnings"] == [] and report["error_model"] is None and report["version"] == sb.__version__
    assert tin.is_height_field and "WGS 84 / UTM zone 33N" in tin.crs_wkt


def test_an_error_model_is_a_tolerance_at_its_confidence(dem):
    model = sb.ErrorModel(vertical_rmse=1.0, geologic_variation=0.0)
    by_error = sb.dem_to_tin(dem, error_model=model, confidence=0.95)
    assert by_error.report["largest_tolerance"] == pytest.approx(1.959964)
    assert by_error.report["error_model"] == model.to_json()
    by_tolerance = sb.dem_to_tin(dem, tolerance=by_error.report["largest_tolerance"])
    assert np.array_equal(by_error.faces, by_tolerance.faces)
    assert len(sb.dem_to_tin(dem, error_model=model, confidence=0.5).faces) > len(by_error.faces)


def test_a_tolerance_may_vary_over_the_ground(dem, tmp_path):
    tolerance = np.full(dem.shape, 4.0, np.float32)
    tolerance[:, :26] = 0.5
    tin = sb.dem_to_tin(dem, tolerance=tolerance)
    x, y = strewn(*dem.shape)
    off = np.abs(height_of_tin(tin, x, y) - height_of_dem(hills(), x, y))
    allowed = height_of_dem(tolerance, x, y)
    assert (off <= allowed).all() and (off > 2).any() and off[allowed == 0.5].max() > 0.3
    assert (tin.report["least_tolerance"], tin.report["largest_tolerance"]) == (0.5, 4.0)
    path = str(tmp_path / "tolerance.tif")
    out = gdal.GetDriverByName("GTiff").Create(path, dem.shape[1], dem.shape[0], 1, gdal.GDT_Float32)
    out.SetGeoTransform((WEST, CELL, 0, NORTH, 0, -CELL))
    out.SetProjection(crs())
    out.GetRasterBand(1).WriteArray(tolerance)
    out = None
    assert np.array_equal(sb.dem_to_tin(dem, tolerance=path).faces, tin.faces)


def test_row_order_does_not_matter(dem):
    # The diagonals run NW-SE on the ground whatever the row order.
    flipped = sb.Dem(hills()[::-1].copy(), (WEST, CELL, 0, NORTH - 41 * CELL, 0, CELL), crs())
    north_up, south_up = (sb.dem_to_tin(one, tolerance=2.0) for one in (dem, flipped))
    assert np.allclose(north_up.vertices, south_up.vertices) and np.array_equal(north_up.faces, south_up.faces)


def test_holes_stay_open():
    heights = hills()
    heights[15:20, 20:30] = np.nan
    tin = sb.dem_to_tin(dem_of(heights), tolerance=3.0)
    x, y = strewn(*heights.shape)
    got, true = height_of_tin(tin, x, y), height_of_dem(heights, x, y)
    assert np.array_equal(np.isnan(got), np.isnan(true)) and np.nanmax(np.abs(got - true)) <= 3.0


def test_tiles_that_keep_their_border_fit(dem):
    def border(tin, x):
        places = tin.vertices
        return {tuple(place) for place in np.round(places[np.isclose(places[:, 0], x)], 6)}

    middle = WEST + 26.5 * CELL
    west = sb.dem_to_tin(dem, tolerance=3.0, keep_border=True, extent=(WEST, NORTH - 410, middle + 5, NORTH))
    east = sb.dem_to_tin(dem, tolerance=3.0, keep_border=True, extent=(middle - 5, NORTH - 410, WEST + 530, NORTH))
    assert border(west, middle) == border(east, middle) and len(border(west, middle)) == 41


def test_kept_samples_stay_vertices(dem):
    keep = np.zeros(dem.shape, bool)
    keep[10:14, 20:25] = True
    for order in (slice(None), slice(None, None, -1)):
        one = dem if order.step is None else sb.Dem(hills()[::-1].copy(), (WEST, CELL, 0, NORTH - 41 * CELL, 0, CELL), crs())
        tin = sb.dem_to_tin(one, tolerance=5.0, keep=keep[order])
        vertices = {tuple(place) for place in np.round(tin.vertices, 4)}
        row, col = np.nonzero(keep)
        kept = np.column_stack([WEST + (col + 0.5) * CELL, NORTH - (row + 0.5) * CELL, hills()[row, col].astype(float)])
        assert {tuple(place) for place in np.round(kept, 4)} <= vertices
        assert len(tin.faces) > len(sb.dem_to_tin(one, tolerance=5.0).faces)


def edges_of(tin):
    pairs = np.sort(np.concatenate([tin.faces[:, [0, 1]], tin.faces[:, [1, 2]], tin.faces[:, [2, 0]]]), axis=1)
    return np.unique(pairs, axis=0, return_counts=True)


def test_break_lines_stay_edges(dem):
    y = NORTH - 20.5 * CELL  # along a row of samples
    ends = WEST + 5.5 * CELL, WEST + 40.5 * CELL
    tin = sb.dem_to_tin(dem, tolerance=100, break_lines=[[(ends[0], y), (ends[1], y)]], break_line_tolerance=0)
    a, b = (tin.vertices[edges_of(tin)[0][:, n]] for n in (0, 1))
    along = (np.abs(a[:, 1] - y) < 1e-6) & (np.abs(b[:, 1] - y) < 1e-6)
    covered = np.sort(np.concatenate([a[along, 0], b[along, 0]]))
    assert covered[0] == pytest.approx(ends[0]) and covered[-1] == pytest.approx(ends[1])
    assert np.abs(a[along, 0] - b[along, 0]).sum() == pytest.approx(ends[1] - ends[0])
    assert len(sb.dem_to_tin(dem, tolerance=100).faces) < len(tin.faces)


def test_a_break_line_off_the_terrain_is_told_of():
    heights = hills()
    heights[:, 20] = np.nan
    line = [(WEST + 3 * CELL, NORTH - 200), (WEST + 50 * CELL, NORTH - 200)]
    tin = sb.dem_to_tin(dem_of(heights), tolerance=5, break_lines=[line])
    assert any("break lines have no terrain" in warning for warning in tin.report["warnings"])


def test_a_break_line_beside_the_dem_is_told_of(dem):
    tin = sb.dem_to_tin(dem, tolerance=5, break_lines=[[(0, 0), (100, 0)], [(WEST, NORTH), (WEST + 200, NORTH - 200)]])
    assert any("1 of 2 break lines do not cross" in warning for warning in tin.report["warnings"])


def test_outlines_move_within_their_tolerance():
    y, x = np.mgrid[:60, :60]
    coast = hills(60, 60)
    coast[np.hypot(x - 30, y - 28) > 25 + 2 * np.sin(5 * np.arctan2(y - 28, x - 30))] = np.nan
    outline = {}
    for tolerance in (0, 15):
        tin = sb.dem_to_tin(dem_of(coast), tolerance=5, border_tolerance=tolerance)
        edges, count = edges_of(tin)
        outline[tolerance] = tin.vertices[edges[count == 1]]
    assert len(outline[15]) < 0.5 * len(outline[0])
    a, b = (outline[15][None, :, n, :2] for n in (0, 1))
    p = outline[0][:, None, 0, :2]
    t = np.clip(((p - a) * (b - a)).sum(2) / ((b - a) ** 2).sum(2), 0, 1)[..., None]
    assert np.linalg.norm(p - a - t * (b - a), axis=2).min(axis=1).max() <= 15


def test_several_confidences_give_nested_tins(dem):
    tins = sb.dem_to_tins(dem, error_model=sb.ErrorModel(vertical_rmse=1), confidences=[0.5, 0.8, 0.95])
    assert [len(tin.faces) for tin in tins] == sorted((len(tin.faces) for tin in tins), reverse=True)
    assert tins[0].report["largest_tolerance"] == pytest.approx(0.6745, abs=1e-3)
    assert tins[2].report["largest_tolerance"] == pytest.approx(1.96, abs=1e-3)
    assert tins[-1].coarser_vertex is None
    for finer, coarser in zip(tins, tins[1:]):
        assert finer.report["largest_ratio"] <= 1
        drawn = finer.coarser_vertex[finer.faces]
        left = drawn[(drawn[:, 0] != drawn[:, 1]) & (drawn[:, 1] != drawn[:, 2]) & (drawn[:, 2] != drawn[:, 0])]
        assert {tuple(np.roll(f, -f.argmin())) for f in left} == {tuple(np.roll(f, -f.argmin())) for f in coarser.faces}
        assert len(left) == len(coarser.faces)


def test_tolerances_of_a_hierarchy_grow(dem):
    tins = sb.dem_to_tins(dem, tolerance=1, factors=[1, 3])
    assert tins[0].faces.tolist() == sb.dem_to_tin(dem, tolerance=1).faces.tolist()
    assert 1 < tins[1].report["largest_deviation"] <= 3
    for factors in ([], [2, 3], [1, 1], [1, "x"]):
        with pytest.raises(ValueError, match="factors"):
            sb.dem_to_tins(dem, tolerance=1, factors=factors)
    with pytest.raises(ValueError, match="factors go with"):
        sb.dem_to_tins(dem, tolerance=1, confidences=[0.5])
    with pytest.raises(ValueError, match="confidences"):
        sb.dem_to_tins(dem, error_model=sb.ErrorModel(vertical_rmse=1), confidences=[0.9, 0.5])


def test_it_stops_at_a_number_of_faces(dem):
    tin = sb.dem_to_tin(dem, tolerance=50.0, target_faces=500)
    assert 498 <= len(tin.faces) <= 502 and tin.report["largest_deviation"] < 50


@pytest.mark.parametrize("ending", ["ply", "nc", "gpkg", "2dm", "obj"])
def test_it_stops_at_a_size_of_the_file(dem, tmp_path, ending):
    path = tmp_path / f"tin.{ending}"
    least = {"ply": 20_000, "nc": 40_000, "gpkg": 300_000, "2dm": 40_000, "obj": 40_000}[ending]
    tin = sb.dem_to_tin(dem, tolerance=50.0, target_bytes=least, target_ending=ending)
    assert tin.report["warnings"] == []
    tin.write(path)
    assert path.stat().st_size <= least
    if ending == "ply":
        assert path.stat().st_size > least - 24 - 2 * 17 - 20
    tin = sb.dem_to_tin(dem, tolerance=0.01, target_bytes=least, target_ending=ending)
    assert "more than target_bytes" in tin.report["warnings"][0]


def test_a_target_that_the_tolerance_forbids_is_told(dem):
    tin = sb.dem_to_tin(dem, tolerance=0.01, target_faces=9)
    assert tin.report["warnings"] == [
        f"target_faces is 9, but {len(tin.faces)} are left: nothing more can be removed (tolerance, vertices and lines to keep)."
    ]


def test_the_same_bytes_for_any_number_of_threads(dem):
    one, two = (sb.dem_to_tin(dem, tolerance=1.5, threads=n) for n in (1, 2))
    assert np.array_equal(one.vertices, two.vertices) and np.array_equal(one.faces, two.faces)


def test_exact_samples_are_told_of(dem):
    tin = sb.dem_to_tin(dem, error_model=sb.ErrorModel(vertical_rmse=0.0, geologic_variation=1.0))
    assert "count as exact" in tin.report["warnings"][0]


def test_it_can_be_cancelled(dem):
    with pytest.raises(sb.Cancelled):
        sb.dem_to_tin(dem, tolerance=2.0, progress=lambda done: False)
    heard = []
    sb.dem_to_tin(dem, tolerance=2.0, progress=heard.append)
    assert heard[-1] == 1.0 and heard == sorted(heard)


@pytest.mark.parametrize("arguments, message", [
    ({}, "give either tolerance"),
    ({"tolerance": 1.0, "error_model": sb.ErrorModel(1, 0, 0)}, "give either tolerance"),
    ({"tolerance": -1.0}, "tolerance is -1"),
    ({"tolerance": float("nan")}, "tolerance"),
    ({"tolerance": np.ones((3, 3))}, "tolerance has shape"),
    ({"tolerance": np.full((41, 53), np.nan)}, "tolerance is NaN at every cell"),
    ({"tolerance": 1.0, "target_faces": 0}, "target_faces is 0"),
    ({"tolerance": 1.0, "target_bytes": 0}, "target_bytes is 0"),
    ({"tolerance": 1.0, "target_bytes": 100}, "takes more than"),
    ({"tolerance": 1.0, "target_bytes": 1e5, "target_faces": 7}, "only one of them"),
    ({"tolerance": 1.0, "target_bytes": 1e5, "target_ending": "shp"}, "ends in 'shp'"),
    ({"tolerance": 1.0, "keep": np.ones((3, 3))}, "keep has shape"),
    ({"tolerance": 1.0, "border_tolerance": -1}, "border_tolerance is -1"),
    ({"tolerance": 1.0, "border_tolerance": 1, "keep_border": True}, "keep_border"),
    ({"tolerance": 1.0, "break_line_tolerance": float("nan")}, "break_line_tolerance"),
    ({"tolerance": 1.0, "break_lines": [[(0, 0), (np.nan, 1)]]}, "break_lines: line 1"),
    ({"tolerance": 1.0, "break_lines": [[(0, 0), (1, 1)], [1, 2]]}, "break_lines: line 2 has shape"),
    ({"tolerance": 1.0, "break_lines": ["x"]}, "break_lines: line 1"),
    ({"tolerance": 1.0, "break_lines": [[(0, 0)]]}, "break_lines: line 1 has shape"),
    ({"tolerance": 1.0, "break_lines": 5}, "break_lines is 5"),
    ({"error_model": sb.ErrorModel(1, 0, 0), "confidence": 1.0}, "confidence"),
])
def test_wrong_arguments_are_named(dem, arguments, message):
    with pytest.raises(ValueError, match=message):
        sb.dem_to_tin(dem, **arguments)


@pytest.mark.parametrize("step, turn", [(0.3, 0.0), (10.0, 4.0), (0.3, 0.01)])
def test_coordinates_that_are_rounded_leave_nothing_uncovered(step, turn):
    dem = sb.Dem(hills(), (WEST + 0.1, step, turn, NORTH + 0.7, turn, -step), crs())
    found = sb.verify(dem, sb.dem_to_tin(dem, tolerance=2.0), 2.0)
    assert found.within_tolerance and found.well_formed and found.report["uncovered_vertices"] == 0
    assert found.report["uncovered"]["m2"] == found.report["surplus"]["m2"] == 0


def test_what_is_wrong_with_a_tolerance_is_called_so(dem, tmp_path):
    negative = np.ones(dem.shape)
    negative[3, 3] = -1
    for tolerance in (1e5, negative):
        with pytest.raises(ValueError, match="^tolerance") as found:
            sb.dem_to_tin(dem, tolerance=tolerance)
        assert "vertical_rmse" not in str(found.value)
    with pytest.raises(OSError, match="tolerance raster"):
        sb.dem_to_tin(dem, tolerance=str(tmp_path / "none.tif"))


def test_degrees_are_refused():
    dem = sb.Dem(hills(), (8.0, 0.001, 0, 47.0, 0, -0.001), crs(4326))
    with pytest.raises(ValueError, match="[Rr]eproject"):
        sb.dem_to_tin(dem, tolerance=2.0)


def test_written_and_read_again(dem, tmp_path):
    tin = sb.dem_to_tin(dem, tolerance=2.0)
    path = tmp_path / "tin.ply"
    tin.write(path)
    again = sb.read_tin(path)
    assert np.array_equal(again.vertices, tin.vertices) and "deviation" in again.face_attributes
