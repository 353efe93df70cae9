# SPDX-License-Identifier: GPL-3.0-or-later
"""Verify TIN through processing.run: figures, report and points, for every kind of original."""

import numpy
import pytest
import scenes
from qgis.core import QgsProcessingException

BUMP = 3.0  # metres
AT = 5 * scenes.COLS + 7  # the sample that is lifted


@pytest.fixture
def full(dem):
    import sightbound

    return sightbound.Tin.from_dem(sightbound.read_dem(dem))


@pytest.fixture
def bumped(full, tmp_path):
    """The TIN of the DEM with one sample lifted, as a mesh."""
    import sightbound

    vertices = full.vertices.copy()
    vertices[AT, 2] += BUMP
    path = str(tmp_path / "bumped.ply")
    sightbound.Tin(vertices, full.faces, full.crs_wkt).write(path)
    return path


def test_a_lifted_sample_is_found(run, dem, bumped, full, log, tmp_path):
    out = {"OUTPUT": str(tmp_path / "points.gpkg"), "OUTPUT_HTML": str(tmp_path / "report.html")}
    found = run("verifytin", INPUT=dem, SIMPLIFIED=bumped, TOLERANCE=2.0, MOST_POINTS=5, feedback=log, **out)
    assert found["LARGEST_DEVIATION"] == pytest.approx(BUMP, abs=1e-3)
    assert found["LARGEST_RATIO"] == pytest.approx(BUMP / 2.0, abs=1e-3)
    assert found["WITHIN_TOLERANCE"] is False and found["WELL_FORMED"] is True
    assert found["FLIPPED"] == found["FOLDED"] == found["DEGENERATE"] == 0
    assert found["UNCOVERED_AREA"] == pytest.approx(0, abs=1e-2)
    rows = scenes.rows_of(out["OUTPUT"])
    assert [row["kind"] for row in rows] == ["largest deviation", "largest ratio"] + 5 * ["vertex"]
    assert rows[2]["deviation_m"] == pytest.approx(BUMP, abs=1e-3) and rows[2]["ratio"] == pytest.approx(1.5, abs=1e-3)
    assert abs(rows[3]["deviation_m"]) < 0.01
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Some place is beyond the tolerance" in page and page.count("class='bar'") == 40
    assert f"{full.vertices[AT, 0]:.2f}, {full.vertices[AT, 1]:.2f}" in page
    assert any(line.startswith("Largest deviation, certified (m): 3") for line in log.infos)


def test_every_kind_of_original_and_of_simplified(run, dem, bumped, full, tmp_path):
    import sightbound

    mesh, polygons, lifted = (str(tmp_path / name) for name in ("full.ply", "full.gpkg", "bumped.gpkg"))
    full.write(mesh)
    full.write(polygons)
    sightbound.read_tin(bumped).write(lifted)
    cases = [
        {"INPUT": dem, "SIMPLIFIED": bumped},
        {"INPUT": dem, "SIMPLIFIED_TIN": lifted},
        {"MESH": mesh, "SIMPLIFIED": bumped},
        {"TIN": polygons, "SIMPLIFIED": bumped},
    ]
    for given in cases:
        found = run("verifytin", TOLERANCE=4.0, **given)
        assert found["LARGEST_DEVIATION"] == pytest.approx(BUMP, abs=1e-3), given
        assert found["WITHIN_TOLERANCE"] is True


def test_a_tolerance_raster_has_the_cells_of_the_dem(run, dem, bumped, tmp_path):
    values = numpy.full((scenes.ROWS, scenes.COLS), 10.0, dtype="float32")
    values.ravel()[AT] = 0.5
    raster = str(scenes.write_dem(tmp_path / "tolerance.tif", values))
    found = run("verifytin", INPUT=dem, SIMPLIFIED=bumped, TOLERANCE_RASTER=raster)
    assert found["LARGEST_RATIO"] == pytest.approx(BUMP / 0.5, rel=1e-3)
    small = str(scenes.write_dem(tmp_path / "small.tif", values[:20]))
    with pytest.raises(QgsProcessingException, match="TOLERANCE_RASTER: it must have the cells of INPUT"):
        run("verifytin", INPUT=dem, SIMPLIFIED=bumped, TOLERANCE_RASTER=small)


def test_a_hole_shows_as_uncovered_ground(run, dem, full, tmp_path):
    import sightbound

    torn, points = str(tmp_path / "torn.ply"), str(tmp_path / "points.gpkg")
    sightbound.Tin(full.vertices, full.faces[2:], full.crs_wkt).write(torn)
    found = run("verifytin", INPUT=dem, SIMPLIFIED=torn, TOLERANCE=1.0, OUTPUT=points)
    assert found["UNCOVERED_AREA"] == pytest.approx(scenes.CELL**2, rel=1e-3)
    assert "uncovered" in [row["kind"] for row in scenes.rows_of(points)]


def test_contradictions_and_bad_values_name_their_parameter(run, dem, bumped, tmp_path):
    cases = [
        ("INPUT: give an elevation model", {"SIMPLIFIED": bumped, "TOLERANCE": 1.0}),
        ("INPUT: give an elevation model", {"INPUT": dem, "MESH": bumped, "SIMPLIFIED": bumped, "TOLERANCE": 1.0}),
        ("SIMPLIFIED: give a mesh", {"INPUT": dem, "TOLERANCE": 1.0}),
        ("TOLERANCE: give a number", {"INPUT": dem, "SIMPLIFIED": bumped}),
        ("TOLERANCE_RASTER: goes with", {"MESH": bumped, "SIMPLIFIED": bumped, "TOLERANCE_RASTER": dem}),
        ("TOLERANCE is 0", {"INPUT": dem, "SIMPLIFIED": bumped, "TOLERANCE": 0.0}),
    ]
    for message, given in cases:
        with pytest.raises(QgsProcessingException, match=message):
            run("verifytin", **given)


def test_cancelled_it_writes_nothing(run, dem, bumped, tmp_path):
    log, path = scenes.Log(cancel_at=10), tmp_path / "report.html"
    assert run("verifytin", INPUT=dem, SIMPLIFIED=bumped, TOLERANCE=1.0, OUTPUT_HTML=str(path), feedback=log) == {}
    assert not path.exists()
