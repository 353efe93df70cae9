# SPDX-License-Identifier: GPL-3.0-or-later
"""sb.simplify: any TIN within its tolerance, against distances by brute force; what the caller gets and is told."""

import sys
from pathlib import Path

import numpy as np
import pytest

import sightbound as sb

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))
import tins  # noqa: E402


def building(cells=24):
    """Walls and a gable roof on ground with bumps, as one sheet that is no height field."""
    rng = np.random.default_rng(1)
    x = np.array([0, 5, 10, 15, 15, 15, 14, 20, 26, 25, 25, 25, 30, 35, 40.0])
    z = np.array([0, 0, 0, 0, 3, 6, 6, 10, 6, 6, 3, 0, 0, 0, 0.0])
    along = np.linspace(0, 1, len(x))
    u = np.linspace(0, 1, 57)
    return tins.sheet(cells, 56, lambda s, v: (np.interp(s, along, x), 40 * v, np.interp(s, along, z) + rng.normal(0, 0.02, s.shape)))


def bodies():
    rng = np.random.default_rng
    return {"arch": tins.arch(rng(2)), "cave": tins.cave(rng(3)), "bridge": tins.bridge(rng(4)), "building": building()}


@pytest.fixture(scope="module", params=["arch", "cave", "bridge", "building"])
def body(request):
    return bodies()[request.param]


def distances(places, vertices, faces):
    """Of places from triangles, by all of them; no code of the product. Closest place on the plane, else on the edges."""
    best = np.full(len(places), np.inf)
    for a, b, c in vertices[faces]:
        normal = np.cross(b - a, c - a)
        normal = normal / np.linalg.norm(normal)
        height = (places - a) @ normal
        foot = places - height[:, None] * normal
        inside = np.ones(len(places), bool)
        found = np.full(len(places), np.inf)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= np.cross(q - p, foot - p) @ normal >= 0
            t = np.clip((places - p) @ (q - p) / ((q - p) @ (q - p)), 0, 1)
            found = np.minimum(found, np.linalg.norm(p + t[:, None] * (q - p) - places, axis=1))
        best = np.minimum(best, np.where(inside, np.abs(height), found))
    return best


def places_on(vertices, faces, steps=6):
    """A net over every triangle: corners, edges, interior."""
    weights = np.array([(i, j, steps - i - j) for i in range(steps + 1) for j in range(steps + 1 - i)]) / steps
    return np.einsum("wk,fkx->fwx", weights, vertices[faces]).reshape(-1, 3)


def shape(faces):
    """Euler characteristic, and how many edges have one face, and three or more."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    edges, count = np.unique(edges, axis=0, return_counts=True)
    return len(np.unique(faces)) - len(edges) + len(faces), int((count > 2).sum())


def outlines(faces):
    """Loops of border."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    edges, count = np.unique(edges, axis=0, return_counts=True)
    parent = {}
    def root(v):
        while parent.setdefault(v, v) != v:
            v = parent[v]
        return v
    for a, b in edges[count == 1]:
        parent[root(int(a))] = root(int(b))
    return sum(v == root(v) for v in parent)


def test_every_place_is_within_the_tolerance_and_the_topology_stays(body):
    original = sb.Tin(*body)
    assert not original.is_height_field
    made = sb.simplify(original, tolerance=0.5)
    assert made.report["method"] == "distance" and made.report["largest_tolerance"] == 0.5
    far = distances(places_on(made.vertices, made.faces), original.vertices, original.faces)
    assert far.max() <= 0.5
    assert len(made.faces) == made.report["faces_after"] < 0.5 * made.report["faces_before"] == 0.5 * len(original.faces)
    assert shape(made.faces) == shape(original.faces) and outlines(made.faces) == outlines(original.faces)
    found = sb.verify(original, made, 0.5, resolution=0.02).report
    assert found["degenerate"]["count"] == 0


def test_an_error_model_is_a_tolerance_at_the_confidence(body):
    original = sb.Tin(*body)
    model = sb.ErrorModel(vertical_rmse=0.2, horizontal_rmse=0.1, geologic_variation=0)
    made = sb.simplify(original, error_model=model, confidence=0.9)
    assert made.report["largest_tolerance"] <= 1.645 * 0.3 and '"vertical_rmse"' in made.report["error_model"]
    far = distances(places_on(made.vertices, made.faces), original.vertices, original.faces)
    assert far.max() <= made.report["largest_tolerance"]
    assert len(made.faces) < len(original.faces)
    surer = sb.simplify(original, error_model=model, confidence=0.999)
    assert len(surer.faces) <= len(made.faces)


@pytest.fixture(scope="module")
def points():
    rng = np.random.default_rng(7)
    xy = np.round(rng.uniform(0, 300, (1500, 2)), 2)
    z = 20 * np.sin(xy[:, 0] / 40) * np.cos(xy[:, 1] / 50) + rng.normal(0, 0.3, len(xy))
    return np.column_stack([xy + [500000, 5000000], z])


def growing(vertices, most):
    along = vertices[:, 0] - vertices[:, 0].min()
    return 0.1 + (most - 0.1) * along / along.max()


def test_a_tolerance_that_varies_holds_at_every_place(body):
    original = sb.Tin(*body)
    tolerance = growing(original.vertices, 1.0)
    made = sb.simplify(original, tolerance=tolerance)
    assert made.report["least_tolerance"] == pytest.approx(0.1) and made.report["largest_tolerance"] == pytest.approx(1.0)
    weights = np.array([(i, j, 3 - i - j) for i in range(4) for j in range(4 - i)]) / 3
    allowed = np.einsum("wk,fk->fw", weights, tolerance[original.faces]).ravel()
    far = distances(places_on(original.vertices, original.faces, 3), made.vertices, made.faces)
    assert (far <= allowed).all()
    assert sb.verify(original, made, tolerance, resolution=0.02).within_tolerance
    even = sb.simplify(original, tolerance=0.1, voxel=made.report["voxel"])
    assert len(made.faces) < len(even.faces)


def test_a_tolerance_that_varies_over_a_height_field(points):
    original = sb.Tin.from_points(points)
    tolerance = growing(original.vertices, 4.0)
    tolerance[np.linalg.norm(original.vertices[:, :2] - [500150, 5000150], axis=1) < 60] = 0
    made = sb.simplify(original, tolerance=tolerance)
    height = np.minimum(tolerance + 1e-4, tolerance.max()).astype("float32")
    assert sb.verify(original, made, height).within_tolerance
    there = {tuple(v) for v in made.vertices.tolist()}
    assert 0.9 < made.report["largest_ratio"] <= 1 and 3 < made.report["largest_deviation"] <= 4
    exact = tolerance[original.faces].max(axis=1) == 0
    assert all(tuple(v) in there for v in original.vertices[np.unique(original.faces[exact])].tolist())
    assert len(made.faces) < 0.4 * len(original.faces)


def test_any_height_field_uses_the_whole_tolerance(points):
    original = sb.Tin.from_points(points)
    made = sb.simplify(original, tolerance=1.5)
    found = sb.verify(original, made, 1.5).report
    assert found["method"] == "vertical" and found["within_tolerance"] and found["well_formed"]
    assert 1.4 < found["largest_deviation"]["bound"] <= 1.5
    assert found["uncovered"]["m2"] < 1e-3 and found["surplus"]["m2"] < 1e-3
    assert made.report["voxel"] == 0 and len(made.faces) < 0.25 * len(original.faces)


def test_the_outline_of_a_height_field_may_move_in_plan(points):
    original = sb.Tin.from_points(points)
    still, free = (sb.simplify(original, tolerance=1.5, border_tolerance=b) for b in (0.0, 3.0))
    outline = lambda tin: sum(tin.faces.size for _ in [0]) - 2 * (tin.faces.size - len(edges_of(tin.faces)))
    assert outline(free) <= outline(still)
    found = sb.verify(original, free, 1.5).report
    assert found["within_tolerance"] and found["uncovered"]["m2"] <= 3.0 * 1200


def edges_of(faces):
    return np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)


def test_a_dem_is_simplified_nearly_as_far_as_by_dem_to_tin():
    y, x = np.mgrid[:61, :61]
    heights = (20 * np.sin(x / 9.0) * np.cos(y / 7.0) + np.random.default_rng(3).normal(0, 0.4, x.shape)).astype(np.float32)
    dem = sb.Dem(heights, (0, 10, 0, 610, 0, -10))
    full = sb.Tin.from_dem(dem)
    made, best = sb.simplify(full, tolerance=1.0), sb.dem_to_tin(dem, tolerance=1.0)
    assert len(made.faces) < 1.6 * len(best.faces)
    assert sb.verify(dem, made, 1.0).report["within_tolerance"]


def test_a_tolerance_of_0_removes_what_is_coplanar():
    vertices, faces = tins.sheet(8, 8, lambda u, v: (8 * u, 8 * v, 2 * u + v))
    assert len(sb.simplify(sb.Tin(vertices, faces), tolerance=0).faces) == 2
    vertices[40, 2] += 1e-9
    assert 2 < len(sb.simplify(sb.Tin(vertices, faces), tolerance=0).faces) < 20


def test_targets_and_what_is_kept(body):
    original = sb.Tin(*body)
    keep = np.zeros(len(original.vertices))
    keep[::13] = 1
    target = int(0.8 * len(original.faces))
    made = sb.simplify(original, tolerance=0.5, keep=keep, target_faces=target)
    assert abs(len(made.faces) - target) <= 2
    there = {tuple(v) for v in made.vertices.tolist()}
    assert all(tuple(v) in there for v in original.vertices[::13].tolist())


def test_the_file_has_the_size_asked_for_or_a_warning_tells(body, points, tmp_path):
    for original in (sb.Tin(*body), sb.Tin.from_points(points)):
        sb.simplify(original, tolerance=0.5).write(tmp_path / "least.ply")
        target = (tmp_path / "least.ply").stat().st_size + 3000
        made = sb.simplify(original, tolerance=0.5, target_bytes=target)
        made.write(tmp_path / "made.ply")
        assert target - 150 < (tmp_path / "made.ply").stat().st_size <= target
        assert not any("target" in warning for warning in made.report["warnings"])
        missed = sb.simplify(original, tolerance=0.01, target_bytes=1500).report
        assert any("more than target_bytes: nothing more" in warning for warning in missed["warnings"])
    missed = sb.simplify(original, tolerance=0.01, target_faces=7).report
    assert f"target_faces is 7, but {missed['faces_after']} are left: nothing more can be removed (tolerance, vertices and lines to keep)." in missed["warnings"]


def edges_near(tin, line, reach):
    """Edges of a TIN all of whose places (a net of them) lie near a polyline, [n, 2, 3]."""
    ends = tin.vertices[edges_of(tin.faces)]
    near = np.ones(len(ends), bool)
    for t in np.linspace(0, 1, 21):
        near &= from_line(ends[:, 0] + t * (ends[:, 1] - ends[:, 0]), line) <= reach
    return ends[near]


def from_line(places, line):
    best = np.full(len(places), np.inf)
    for a, b in zip(line, line[1:]):
        t = np.clip((places - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        best = np.minimum(best, np.linalg.norm(a + t[:, None] * (b - a) - places, axis=1))
    return best


@pytest.mark.parametrize("reach", [0.0, 0.3])
def test_edges_still_run_along_break_lines(reach):
    vertices, faces = building()
    line = vertices[np.arange(57) + 12 * 57]  # across the roof and down its walls
    original = sb.Tin(vertices, faces)
    made = sb.simplify(original, tolerance=0.5, break_lines=[line], break_line_tolerance=reach)
    near = edges_near(made, line, reach + 1e-9)
    places = np.concatenate([line[:-1] + t * np.diff(line, axis=0) for t in np.linspace(0, 1, 11)])
    gaps = np.min([from_line(places, edge) for edge in near], axis=0)
    assert gaps.max() <= reach + 1e-9
    free = sb.simplify(original, tolerance=0.5)
    assert len(free.faces) < len(made.faces) < 0.5 * len(original.faces)
    far = distances(places_on(made.vertices, made.faces), original.vertices, original.faces)
    assert far.max() <= 0.5


def test_break_lines_of_a_triangulation_stay(points):
    lines = [np.array([[500040, 5000040, 5.0], [500150, 5000160, 9.0], [500260, 5000030, 2.0]]),
             np.array([[500030, 5000140, 5.0], [500280, 5000100, 5.0]])]
    original = sb.Tin.from_points(points, breaklines=lines)
    made = sb.simplify(original, tolerance=1.5, break_lines=[line[:, :2] for line in lines])
    for line in lines:
        flat = sb.Tin(made.vertices * [1, 1, 0], made.faces)
        near = edges_near(flat, line * [1, 1, 0], 1e-6)
        places = np.concatenate([line[:-1] + t * np.diff(line, axis=0) for t in np.linspace(0, 1, 101)]) * [1, 1, 0]
        assert np.min([from_line(places, edge) for edge in near], axis=0).max() <= 1e-6
    assert sb.verify(original, made, 1.5).within_tolerance and len(made.faces) < 0.3 * len(original.faces)


@pytest.mark.parametrize("lines, message", [
    ([[[0, 0, 0], [1, 1, 1]]], "break_lines has 1 pieces, of which 1 do not run along edges"),
    ([[[0, 0], [1, 1]]], "break_lines has a vertex without height"),
    ([[0, 1]], "line 1 of break_lines has shape"),
    (["here"], "line 1 of break_lines must be"),
])
def test_break_lines_that_are_none_are_refused(body, lines, message):
    with pytest.raises(ValueError, match=message):
        sb.simplify(sb.Tin(*body), tolerance=0.5, break_lines=lines)


def test_same_bytes_for_any_number_of_threads(body, tmp_path):
    files = []
    for threads in (1, 2):
        made = sb.simplify(sb.Tin(*body), tolerance=0.5, threads=threads)
        made.write(tmp_path / f"{threads}.ply")
        files.append((tmp_path / f"{threads}.ply").read_bytes())
    assert files[0] == files[1]


def test_reports_speak_with_the_same_words(points):
    heights = 5 * np.sin(np.arange(900).reshape(30, 30) / 40.0)
    dem = sb.Dem(heights.astype(np.float32), (0, 10, 0, 300, 0, -10))
    of_dem = sb.dem_to_tin(dem, tolerance=1.0)
    original = sb.Tin.from_points(points)
    of_tin = sb.simplify(original, tolerance=1.0)
    found = sb.verify(original, of_tin, 1.0).report
    shared = {"method", "faces_before", "faces_after", "least_tolerance", "largest_tolerance", "largest_deviation", "largest_ratio",
              "error_model", "warnings", "version"}
    assert shared == of_dem.report.keys() and shared < of_tin.report.keys()
    assert shared - found.keys() == {"least_tolerance", "largest_tolerance", "error_model"}
    for key in ("method", "faces_before", "faces_after", "version"):
        assert of_tin.report[key] == found[key], key
    for key in ("largest_deviation", "largest_ratio"):
        assert found[key]["measured"] <= of_tin.report[key] + 1e-9, key


def test_quads_become_triangles():
    vertices = [(x, y, 0.0) for y in range(5) for x in range(5)]
    quads = [(5 * r + c, 5 * r + c + 1, 5 * r + c + 6, 5 * r + c + 5) for r in range(4) for c in range(4)]
    made = sb.simplify(sb.Tin(vertices, quads), tolerance=0.1)
    assert made.report["faces_before"] == 32 and len(made.faces) == 2


@pytest.mark.parametrize("wrong, message", [
    ({}, "give either tolerance"),
    ({"tolerance": 1, "error_model": sb.ErrorModel(vertical_rmse=1, geologic_variation=0)}, "give either tolerance"),
    ({"tolerance": -1}, "tolerance is -1"),
    ({"tolerance": float("nan")}, "tolerance"),
    ({"tolerance": [1.0, 2.0]}, "tolerance has 2 values"),
    ({"tolerance": [[1.0, 2.0]]}, "tolerance has shape"),
    ({"tolerance": "nan"}, "tolerance is nan at vertex 0"),
    ({"tolerance": "negative"}, r"tolerance is -1 at vertex 7 \(1 such of \d+\); give metres"),
    ({"tolerance": 1, "border_tolerance": -2}, "border_tolerance is -2"),
    ({"tolerance": 1, "target_faces": 0}, "target_faces"),
    ({"tolerance": 1, "target_bytes": 100}, "takes more than"),
    ({"tolerance": 1, "target_bytes": 1e5, "target_faces": 7}, "only one of them"),
    ({"tolerance": 1, "keep": [1, 0]}, "keep has shape"),
    ({"tolerance": 1, "voxel": 0}, "voxel"),
    ({"error_model": sb.ErrorModel(vertical_rmse=1, geologic_variation=0), "confidence": 1.5}, "confidence"),
    ({"error_model": sb.ErrorModel()}, "geologic_variation"),
])
def test_what_is_wrong_is_named(wrong, message):
    cave = sb.Tin(*tins.cave(np.random.default_rng(3)))
    stand_ins = {"nan": np.full(len(cave.vertices), np.nan), "negative": np.ones(len(cave.vertices))}
    stand_ins["negative"][7] = -1
    wrong = {name: stand_ins.get(value, value) if isinstance(value, str) else value for name, value in wrong.items()}
    with pytest.raises(ValueError, match=message):
        sb.simplify(cave, **wrong)


def overhang():
    """A metre between vertices, centimetres of noise."""
    rng = np.random.default_rng(6)
    return tins.sheet(8, 12, lambda u, v: (6 * np.sin(3 * u), 8 * v, 5 * u + rng.normal(0, 0.004, u.shape)))


def test_voxels_are_fine_enough_for_centimetres():
    original = sb.Tin(*overhang())
    made = sb.simplify(original, tolerance=0.04)
    assert made.report["voxel"] < 0.04 / np.sqrt(3) and made.report["faces_not_held"] == 0
    assert len(made.faces) < 0.8 * len(original.faces)
    far = distances(places_on(made.vertices, made.faces), original.vertices, original.faces)
    assert far.max() <= 0.04


@pytest.mark.parametrize("given", [{"memory_budget": 20e6}, {"voxel": 0.05}])
def test_voxels_too_coarse_for_the_tolerance_are_told(given):
    report = sb.simplify(sb.Tin(*overhang()), tolerance=0.04, **given).report
    told = report["warnings"][-1]
    assert report["voxel"] > 0.04 / np.sqrt(3) and report["faces_not_held"] == report["faces_before"]
    assert "too coarse for the tolerance at 192 of 192 faces" in told and "A tolerance of" in told and "or voxel = 0.012" in told
    assert ("smallest that can be afforded" in told) == ("memory_budget" in given)


def test_a_tolerance_below_all_voxels_is_told():
    report = sb.simplify(sb.Tin(*overhang()), tolerance=0.001).report
    assert report["voxel"] == 0 and "No voxel is small enough for a tolerance of 0.001 m" in report["warnings"][-1]
    assert not any("voxel" in told for told in sb.simplify(sb.Tin(*overhang()), tolerance=0).report["warnings"])


def test_height_fields_take_the_smallest_tolerance(points):
    vertices = points.copy()
    vertices[:, 2] = np.random.default_rng(5).normal(0, 1e-4, len(vertices))
    made = sb.simplify(sb.Tin.from_points(vertices), tolerance=0.0005)
    assert made.report["largest_deviation"] <= 0.0005 and made.report["faces_after"] < 0.2 * made.report["faces_before"]


def test_too_much_for_the_memory_is_refused_with_advice():
    with pytest.raises(MemoryError, match="voxel"):
        sb.simplify(sb.Tin(*tins.cave(np.random.default_rng(3))), tolerance=0.5, voxel=0.01, memory_budget=50e6)


def test_it_is_cancelled_and_tells_its_progress(body):
    told = []
    sb.simplify(sb.Tin(*body), tolerance=0.5, progress=lambda f: told.append(f))
    assert told == sorted(told) and told[-1] == 1.0
    with pytest.raises(sb.Cancelled):
        sb.simplify(sb.Tin(*body), tolerance=0.5, progress=lambda f: f < 0.3)


def ring(radius, count=64, noise=None):
    turn = np.arange(count) * 2 * np.pi / count
    z = np.zeros(count) if noise is None else noise.normal(0, 0.02, count)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), z])


def test_an_outline_that_would_run_over_another_part_stays():
    """A disk in the hole of a plate, a hand's breadth from its rim."""
    noise = np.random.default_rng(4)
    n, radii = 64, (1.0, 3.0, 5.0, 5.2, 7.0, 9.0)
    points = np.vstack([ring(r, n, noise) for r in radii])
    faces = []
    for inner in (0, 1, 3, 4):
        for i in range(n):
            a, b, c, d = inner * n + i, inner * n + (i + 1) % n, (inner + 1) * n + i, (inner + 1) * n + (i + 1) % n
            faces += [(a, c, b), (b, c, d)]
    original = sb.Tin(points, faces)
    assert original.is_height_field
    simplified = sb.simplify(original, tolerance=1.0, border_tolerance=1.0)
    assert simplified.is_height_field and len(simplified.faces) < len(original.faces)
    assert simplified.report["border_tolerance"] == 0
    assert any("outline stays" in warning for warning in simplified.report["warnings"])
    with pytest.raises(ValueError, match="target_faces"):
        sb.simplify(original, tolerance=1.0, target_faces="5")


def cut_into_four(vertices, faces):
    """Every triangle into four: the surface stays the same."""
    vertices, middles, cut = [np.array(p, float) for p in vertices], {}, []
    def middle(a, b):
        edge = min(a, b), max(a, b)
        if edge not in middles:
            middles[edge] = len(vertices)
            vertices.append((vertices[a] + vertices[b]) / 2)
        return middles[edge]
    for a, b, c in faces:
        p, q, r = middle(a, b), middle(b, c), middle(c, a)
        cut += [[a, p, r], [p, b, q], [r, q, c], [p, q, r]]
    return vertices, cut


def test_an_outline_that_comes_back_over_ground_it_gave_up_keeps_to_it():
    top = [(9, 7.5, 0), (41, 13, 0), (79, 0.5, 0), (119, 16.5, 11), (163, 17, 0)]
    middle = [(8, -1.5, 0), (35, -5.5, 0), (74, -5.5, 0), (128, -3, 0), (152, -1.5, 0)]
    vertices = top + middle + [(40 * n, -40, 0) for n in range(5)]
    faces = [f for a in range(4) for f in ([a, a + 5, a + 6], [a, a + 6, a + 1])]
    faces += [f for a in (5, 6) for f in ([a, a + 5, a + 1], [a + 1, a + 5, a + 6])]
    faces += [f for a in (7, 8) for f in ([a, a + 5, a + 6], [a, a + 6, a + 1])]
    original = sb.Tin(*cut_into_four(*cut_into_four(vertices, faces)))
    for border in (10, 12, 15, 20, 30):
        made = sb.simplify(original, tolerance=2.0, border_tolerance=border)
        found = sb.verify(original, made, 2.0)
        assert found.within_tolerance
        assert made.report["largest_deviation"] >= found.report["largest_deviation"]["measured"] - 1e-6


def test_break_lines_along_the_outline_keep_their_own_tolerance():
    x, top = np.arange(5) * 10.0, np.array([0, 2, 0, 2, 0.0])
    vertices = np.r_[np.c_[x, top, 0 * x], np.c_[x, 0 * x - 20, 0 * x]]
    tin = sb.Tin(vertices, [f for i in range(4) for f in ([i, i + 5, i + 6], [i, i + 6, i + 1])])
    for line, left in ((vertices[:5], vertices[:5]), (vertices[1:4], vertices[1:4])):
        made = sb.simplify(tin, tolerance=1, border_tolerance=3, break_lines=[line[:, :2]], break_line_tolerance=0)
        assert {tuple(v) for v in left} <= {tuple(v) for v in made.vertices}
