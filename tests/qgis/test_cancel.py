# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancelling in the middle leaves no output."""

import numpy
import pytest
import scenes
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsVectorLayer,
)


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


@pytest.mark.parametrize("percent", [70, 94, 96])
def test_rasters_of_an_earlier_run_stay(run, large_dem, many, tmp_path, percent):
    """Cancelled while the folder is made, at its end, and while the combined rasters are written."""
    folder = tmp_path / "each"
    folder.mkdir()
    earlier = {"1.tif": b"raster", "1.tif.aux.xml": b"statistics", "1.qml": b"style", "notes.txt": b"notes"}
    for name, content in earlier.items():
        (folder / name).write_bytes(content)
    log = scenes.Log(cancel_at=percent)
    run("confidenceviewshed", feedback=log, INPUT=large_dem, OBSERVERS=many, MAX_DISTANCE=300,
        VERTICAL_ACCURACY=1.0, OUTPUT=str(tmp_path / "out.tif"), OUTPUT_FOLDER=str(folder))  # fmt: skip
    assert log.isCanceled() and {one.name: one.read_bytes() for one in folder.iterdir()} == earlier


def test_cancelled_before_the_input_is_read(run, dem, observers, tmp_path):
    for algorithm, outputs in (("confidenceviewshed", {}), ("lineofsightprofile", {"TARGETS": observers})):
        log = scenes.Log()
        log.cancel()
        out = str(tmp_path / ("out.tif" if algorithm == "confidenceviewshed" else "out.gpkg"))
        results = run(algorithm, feedback=log, INPUT=dem, OBSERVERS=observers, OUTPUT=out, **outputs)
        assert results == {} and left_in(tmp_path, "dem.tif", "observers.gpkg") == []
        assert log.errors == [] and any("Cancelled" in text for text in log.infos)


def test_pairing_stops_between_pairs():
    from sightbound_qgis.feedback import Stopped
    from sightbound_qgis.observers import Place
    from sightbound_qgis.pairs import find_pairs

    class Impatient(QgsProcessingFeedback):
        asked = 0

        def isCanceled(self):
            self.asked += 1
            return self.asked > 5

    places = [Place(f"feature {i}", str(i), float(i), 0.0, None, None) for i in range(1000)]
    log = Impatient()
    with pytest.raises(Stopped):
        find_pairs(places, places, False, None, QgsCoordinateReferenceSystem(), QgsProcessingContext(), log)
    assert log.asked == 6


def test_copying_polygons_stops(tmp_path, context):
    from sightbound_qgis.error_block import _copy_polygons
    from sightbound_qgis.feedback import Stopped

    layer = QgsVectorLayer(str(scenes.write_terrain_types(tmp_path / "types.gpkg")), "types")
    log = scenes.Log()
    log.cancel()
    with pytest.raises(Stopped):
        _copy_polygons(layer, layer.fields().lookupField("kind"), layer.crs(), context, log)
