# SPDX-License-Identifier: GPL-3.0-or-later
"""sightbound.Tin: from arrays, points, DEMs and files, and back through QGIS."""
import os
import subprocess
import sys

import numpy as np
import pytest
import sightbound as sb

NAN = float("nan")
SQUARE = np.array([(416155.123456789, 5381556.987654321, 309.78), (416165.1, 5381556.7, 1 / 3), (416160.3, 5381566.9, -5), (416150.1, 5381566, 7)])
FACES = np.array([(0, 1, 2), (0, 2, 3)])


def square(**how):
    return sb.Tin(SQUARE, FACES, "EPSG:32633", [0.5, NAN, 0.25, 1], face_attributes={"max_error": [0.125, 0.5]}, **how)


def test_arrays_in_and_out():
    tin = square(vertex_attributes={"id": range(4)})
    assert np.array_equal(tin.vertices, SQUARE) and tin.vertices.dtype == np.float64
    assert np.array_equal(tin.faces, FACES) and tin.faces.dtype == np.int32 and not tin.faces.flags.writeable
    assert np.array_equal(tin.local_vertices + tin.origin, SQUARE)
    assert np.array_equal(tin.sigma_v, [0.5, NAN, 0.25, 1], equal_nan=True)
    assert tin.vertex_attributes["id"].tolist() == [0, 1, 2, 3] and tin.face_attributes["max_error"].tolist() == [0.125, 0.5]
    assert "UTM zone 33N" in tin.crs_wkt and tin.notes == [] and tin.samples is None
    assert tin.bounds == (*SQUARE.min(axis=0), *SQUARE.max(axis=0))
    assert tin.is_height_field and tin.why_no_height_field is None
    edges = np.linalg.norm(SQUARE[FACES] - SQUARE[np.roll(FACES, -1, axis=1)], axis=2)
    assert tin.median_edge == pytest.approx(np.sort(edges.ravel())[3])
    assert repr(tin) == "<sightbound.Tin: 4 vertices, 2 faces>"
    faces = tin.faces
    del tin
    assert faces.tolist() == FACES.tolist()  # the array keeps its memory


def test_quads_and_larger_faces_are_cut():
    xyz = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (20, 0, 0), (20, 10, 0), (15, 15, 0)]
    tin = sb.Tin(xyz, [(0, 1, 2, 3, -1), (1, 4, 5, 6, 2)], face_attributes={"n": [7, 8]})
    assert tin.faces.shape == (5, 3) and tin.face_attributes["n"].tolist() == [7, 7, 8, 8, 8]
    assert any("four corners" in note for note in tin.notes) and any("more than four" in note for note in tin.notes)
    assert tin.is_height_field and tin.crs_wkt is None


def test_a_box_is_no_height_field():
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (1, 5, 7, 3), (3, 7, 6, 2), (2, 6, 4, 0)]
    tin = sb.Tin(corners, quads)  # every face turned inward
    assert not tin.is_height_field and "look down" in tin.why_no_height_field
    p = tin.vertices[tin.faces]
    assert np.einsum("fi,fi", p[:, 0], np.cross(p[:, 1], p[:, 2])) / 6 == pytest.approx(1)
    assert any("12 faces turned" in note for note in tin.notes)


@pytest.mark.parametrize("how, message", [
    (dict(vertices=[(0, 0)], faces=FACES), r"vertices.*\(1, 2\)"), (dict(vertices="here", faces=FACES), "vertices"),
    (dict(vertices=SQUARE, faces=[(0, 1)]), r"faces.*\(1, 2\)"), (dict(vertices=SQUARE, faces=[(0.0, 1, 2)]), "faces.*float64"),
    (dict(vertices=SQUARE, faces=[(0, 1, 4)]), "vertex 4; there are vertices 0 to 3"), (dict(vertices=SQUARE, faces=[(0, 1, -2)]), "index -2"),
    (dict(vertices=SQUARE, faces=[(0, 1, 2**40)]), "index 1099511627776"), (dict(vertices=SQUARE, faces=[(0, 1, 2, 9)]), "vertex 9"),
    (dict(vertices=SQUARE, faces=np.zeros((0, 3), int)), "no faces"), (dict(vertices=np.zeros((0, 3)), faces=FACES), "no vertices"),
    (dict(vertices=np.where(SQUARE < 0, NAN, SQUARE), faces=FACES), "vertex 2.*nan.*finite"),
    (dict(vertices=np.zeros((4, 3)), faces=FACES), "no face with an area"),
    (dict(vertices=SQUARE, faces=FACES, sigma_v=[1, 2]), "sigma_v has 2 values; it must have 4"),
    (dict(vertices=SQUARE, faces=FACES, sigma_v=[1, 2, 3, -4]), "sigma_v.*-4"), (dict(vertices=SQUARE, faces=FACES, sigma_v="x"), "sigma_v"),
    (dict(vertices=SQUARE, faces=FACES, face_attributes={"a": [1]}), "'a' has 1 values; it must have 2"),
    (dict(vertices=SQUARE, faces=FACES, vertex_attributes=[1]), "vertex_attributes.*dict"),
    (dict(vertices=SQUARE, faces=FACES, crs="EPSG:4326"), "degrees.*reproject.*UTM"), (dict(vertices=SQUARE, faces=FACES, crs="x"), "crs is 'x'"),
    (dict(vertices=SQUARE, faces=FACES, vertical_unit="mile"), "vertical_unit.*'mile'"),
])
def test_wrong_arguments(how, message):
    with pytest.raises(ValueError, match=message):
        sb.Tin(**how)


def test_feet():
    tin = sb.Tin([(1e6, 2e5, 10), (1e6 + 100, 2e5, 10), (1e6, 2e5 + 100, 20)], [(0, 1, 2)], "EPSG:2263", vertical_unit="foot")
    foot = 1200 / 3937
    assert tin.metres_per_unit == pytest.approx(foot, rel=1e-12)
    assert np.ptp(tin.local_vertices[:, 0]) == pytest.approx(100 * foot) and np.ptp(tin.vertices[:, 0]) == pytest.approx(100)
    assert tin.vertices[2, 2] == pytest.approx(6.096)


def test_from_dem():
    z = np.arange(12, dtype=np.float32).reshape(3, 4)
    dem = sb.Dem(z, (500000, 10, 0, 4000000, 0, -10))
    tin = sb.Tin.from_dem(dem)
    assert tin.faces.shape == (12, 3) and tin.samples is None and tin.is_height_field
    assert tin.vertices[5].tolist() == [500015, 3999985, 5]
    z[0, 0] = NAN
    heard = []
    tin = sb.Tin.from_dem(sb.Dem(z, (500000, 10, 0, 4000000, 0, -10)), progress=heard.append)
    assert tin.faces.shape == (10, 3) and heard[-1] == 1
    assert tin.samples.tolist() == list(range(1, 12)) and np.array_equal(tin.vertices[:, 2], tin.samples)
    with pytest.raises(ValueError, match="no three samples"):
        sb.Tin.from_dem(sb.Dem(np.full((3, 3), NAN), (0, 1, 0, 0, 0, -1)))
    with pytest.raises(MemoryError, match="TIN of the DEM"):
        sb.Tin.from_dem(dem, memory_budget=100)
    with pytest.raises(TypeError, match="dem must be a sightbound.Dem"):
        sb.Tin.from_dem(z)
    wkt = sb.Tin(SQUARE, FACES, "EPSG:32633").crs_wkt
    assert sb.Tin.from_dem(sb.Dem(z, (500000, 10, 0, 4000000, 0, -10), wkt)).crs_wkt == wkt


def test_from_points_is_delaunay_and_keeps_breaklines():
    from scipy.spatial import Delaunay

    rng = np.random.default_rng(3)
    points = rng.uniform(0, 100, (500, 3)) + (5e5, 4e6, 0)
    tin = sb.Tin.from_points(points, sigma_v=np.arange(500), attributes={"id": np.arange(500)})
    ours = {tuple(sorted(face)) for face in tin.faces.tolist()}
    assert ours == {tuple(sorted(face)) for face in Delaunay(points[:, :2] - (5e5, 4e6)).simplices.tolist()}
    assert np.array_equal(tin.vertices, points) and tin.sigma_v.tolist() == list(range(500))
    line = [(500010.5, 4000010.5, 500), (500090.5, 4000070.25, 600)]
    broken = sb.Tin.from_points(points, sigma_v=np.arange(500), breaklines=[line])
    ends = [int(np.argmin(np.abs(broken.vertices - end).sum(axis=1))) for end in line]
    assert any(set(ends) <= set(face) for face in broken.faces.tolist())
    assert np.isnan(broken.sigma_v[ends]).all() and broken.is_height_field
    assert sb.Tin.from_points(points, longest_edge=8).faces.shape[0] < tin.faces.shape[0]


@pytest.mark.parametrize("how, message", [
    (dict(points=[(0, 0, 0), (1, 1, 1)]), "2 points.*3 to"), (dict(points=[(0, 0, 0), (1, 1, 1), (2, 2, 2)]), "on a line"),
    (dict(points=[(0, 0, 0), (1, NAN, 1), (2, 0, 2)]), "Point 1 .*finite"), (dict(points=SQUARE, longest_edge=0), "longest_edge"),
    (dict(points=SQUARE, breaklines=[[(0, 0)]]), "breakline 1"), (dict(points=SQUARE, crs="EPSG:4326"), "degrees"),
    (dict(points=SQUARE, sigma_v=[1]), "sigma_v has 1 values for 4 points"), (dict(points=SQUARE, attributes={"a": [1]}), "attribute 'a'"),
])
def test_wrong_points(how, message):
    with pytest.raises(ValueError, match=message):
        sb.Tin.from_points(**how)


def test_cancel():
    points = np.random.default_rng(1).uniform(0, 1000, (200000, 3))
    with pytest.raises(sb.Cancelled):
        sb.Tin.from_points(points, progress=lambda done: False)


@pytest.mark.parametrize("ending", ["ply", "nc", "gpkg", "2dm", "obj"])
def test_written_and_read_again(tmp_path, ending):
    path = tmp_path / f"a b.{ending}"
    heard = []
    warnings = square().write(path, progress=heard.append)
    assert bool(warnings) == (ending not in ("ply", "nc")) and heard[-1] == 1
    assert [one.name for one in tmp_path.iterdir()] == [path.name]
    if ending == "nc":
        return  # read by QGIS below
    back = sb.read_tin(path)
    assert np.array_equal(back.vertices, SQUARE) and np.array_equal(back.faces, FACES)
    assert (back.crs_wkt is None) == (ending == "2dm")
    assert sb.read_tin(path, crs="EPSG:32632").crs_wkt.find("zone 32N") > 0
    assert sb.tin_layers(path) == (["a b"] if ending == "gpkg" else [])


def test_files_that_are_none(tmp_path):
    with pytest.raises(OSError, match="missing.ply"):
        sb.read_tin(tmp_path / "missing.ply")
    (tmp_path / "a.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n")
    with pytest.raises(ValueError, match="header does not end"):
        sb.read_tin(tmp_path / "a.ply")
    with pytest.raises(ValueError, match="path"):
        sb.read_tin("")
    with pytest.raises(ValueError, match="layer"):
        sb.read_tin(tmp_path / "a.ply", layer=7)
    with pytest.raises(ValueError, match="'stl'"):
        square().write(tmp_path / "a.stl")
    with pytest.raises(OSError, match="does not exist"):
        square().write(tmp_path / "no" / "a.ply")
    assert [one.name for one in tmp_path.iterdir()] == ["a.ply"]


LOAD = """
import sys
from qgis.core import QgsApplication, QgsMesh, QgsMeshLayer, QgsMeshDatasetIndex
app = QgsApplication([], False)
app.initQgis()
for path in sys.argv[1:]:
    layer = QgsMeshLayer(path, "m", "mdal")
    mesh, provider = QgsMesh(), layer.dataProvider()
    provider.populateMesh(mesh)
    first = mesh.vertex(0)
    groups = {provider.datasetGroupMetadata(g).name(): provider.datasetValue(QgsMeshDatasetIndex(g, 0), 1).scalar()
              for g in range(provider.datasetGroupCount())}
    print("MESH", repr((mesh.vertexCount(), mesh.faceCount(), layer.crs().authid(), first.x(), first.y(), first.z(), mesh.face(1),
                        {name: str(value) for name, value in groups.items()})))
"""


def test_qgis_reads_what_is_written(tmp_path):
    """Counts, CRS, coordinates to the last bit, attributes as dataset groups; NaN stays NaN."""
    names = ["a.ply", "a.nc", "a.2dm"]
    for name in names:
        square().write(tmp_path / name)
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "XDG_RUNTIME_DIR": str(tmp_path)}
    job = subprocess.run([sys.executable, "-c", LOAD, *(str(tmp_path / name) for name in names)], capture_output=True, text=True, env=environment)
    found = [eval(line[5:]) for line in job.stdout.splitlines() if line.startswith("MESH ")]
    assert len(found) == 3, job.stderr[-2000:]
    for name, (vertices, faces, crs, x, y, z, face, groups) in zip(names, found):
        assert (vertices, faces) == (4, 2) and (x, y, z) == tuple(SQUARE[0]) and face == [0, 2, 3], name
        assert crs == ("" if name == "a.2dm" else "EPSG:32633")
        if name != "a.2dm":
            assert groups.keys() == {"Bed Elevation", "sigma_v", "max_error"}
            assert groups["sigma_v"] == "nan" and groups["max_error"] == "0.5"
