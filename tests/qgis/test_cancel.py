# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancelling in the middle leaves no output."""

import numpy
import pytest
import scenes


@pytest.fixture
def large_dem(tmp_path):
    """Large enough for the core to tell its progress several times."""
    row, col = numpy.mgrid[0:400, 0:400]
    heights = (100.0 + 30.0 * numpy.sin(col / 17.0) * numpy.cos(row / 23.0)).astype("float32")
    return str(scenes.write_dem(tmp_path / "large.tif", heights))


@pytest.fixture
def many(tmp_path):
    places = [(scenes.WEST + 900.0 + 90.0 * i, scenes.NORTH - 900.0 - 81.0 * i) for i in range(30)]
    return str(scenes.write_points(tmp_path / "many.gpkg", [(*place, {}) for place in places], {}))


def left_in(folder, *known):
    """What a run left beside the `known` files and the statistics that QGIS keeps of rasters."""
    return sorted(one.name for one in folder.iterdir() if one.name not in known and one.suffix != ".xml")


@pytest.mark.parametrize("percent", [5, 30, 70])
def test_viewshed_leaves_nothing(run, large_dem, many, tmp_path, percent):
    log = scenes.Log(cancel_at=percent)
    out = {name: str(tmp_path / f"{name}.tif") for name in ("OUTPUT", "OUTPUT_VERDICT")}
    out |= {"OUTPUT_FOLDER": str(tmp_path / "each"), "OUTPUT_OBSERVERS": str(tmp_path / "table.gpkg")}
    results = run("confidenceviewshed", feedback=log, INPUT=large_dem, OBSERVERS=many, **out)
    assert log.isCanceled() and results == {}
    assert log.fractions[-1] < 100.0 and any("Cancelled" in text for text in log.infos)
    assert left_in(tmp_path, "large.tif", "many.gpkg") in ([], ["each"])
    if (tmp_path / "each").exists():
        assert left_in(tmp_path / "each") == []


def test_error_surfaces_leave_nothing(run, large_dem, tmp_path):
    log = scenes.Log(cancel_at=1)
    results = run("errorsurfaces", feedback=log, INPUT=large_dem, OUTPUT_SIGMA=str(tmp_path / "sigma.tif"),
                  OUTPUT_MODEL=str(tmp_path / "model.json"))  # fmt: skip
    assert results == {} and left_in(tmp_path, "large.tif") == []


def test_lines_of_sight_leave_nothing(run, large_dem, many, tmp_path):
    log = scenes.Log(cancel_at=10)
    results = run("lineofsightprofile", feedback=log, INPUT=large_dem, OBSERVERS=many, TARGETS=many,
                  OUTPUT=str(tmp_path / "lines.gpkg"), OUTPUT_HTML=str(tmp_path / "page.html"))  # fmt: skip
    assert results == {} and left_in(tmp_path, "large.tif", "many.gpkg") == []
