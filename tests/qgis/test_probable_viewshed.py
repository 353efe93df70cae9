# SPDX-License-Identifier: GPL-3.0-or-later
"""sightbound:probableviewshed through processing.run."""

import json

import numpy
import pytest
import scenes
from qgis.core import QgsProcessing, QgsProcessingException


def look(run, dem, observers, **more):
    given = {"INPUT": dem, "OBSERVERS": observers, "REALISATIONS": 200, "OUTPUT": QgsProcessing.TEMPORARY_OUTPUT, **more}
    return run("probableviewshed", **given)


def test_probability_verdict_and_areas(run, dem, observers, tmp_path, log):
    out = {name: str(tmp_path / f"{name}.tif") for name in ("OUTPUT", "OUTPUT_VERDICT", "OUTPUT_ERROR")}
    results = look(run, dem, observers, feedback=log, **out)
    p, dataset = scenes.read(results["OUTPUT"])
    assert p.shape == (scenes.ROWS, scenes.COLS) and dataset.GetMetadataItem("SIGHTBOUND_REALISATIONS") == "200"
    assert numpy.nanmin(p) >= 0.0 and numpy.nanmax(p) == 1.0
    verdict, _ = scenes.read(results["OUTPUT_VERDICT"])
    assert (p[verdict == 2] >= 0.975).all() and (p[verdict == 0] <= 0.025).all() and (verdict == 2).any()
    error, _ = scenes.read(results["OUTPUT_ERROR"])
    assert numpy.allclose(error, numpy.sqrt(p * (1 - p) / 200), atol=1e-6, equal_nan=True)
    assert results["AREA_EXPECTED"] == pytest.approx(numpy.nansum(p) * scenes.CELL**2, rel=2e-3)
    assert "from_dem" in json.loads(results["ERROR_MODEL_USED"])["geologic_variation"]
    assert log.fractions == sorted(log.fractions) and log.fractions[-1] == 100.0


def test_the_seed_draws(run, dem, observers):
    one, same, other = (
        scenes.read(look(run, dem, observers, SEED=seed, VERTICAL_ACCURACY=2.0)["OUTPUT"])[0] for seed in (1, 1, 2)
    )
    assert numpy.array_equal(one, same, equal_nan=True) and not numpy.array_equal(one, other, equal_nan=True)


@pytest.mark.parametrize("wrong, message", [
    ({"OBSERVERS": None}, "OBSERVERS"),
    ({"CONFIDENCE": 1.0}, "CONFIDENCE"),
    ({"REALISATIONS": 0}, "REALISATIONS"),
    ({"OUTPUT": "/nowhere/p.tif"}, "OUTPUT"),
])
def test_what_is_wrong_is_named(run, dem, observers, wrong, message):
    with pytest.raises(QgsProcessingException, match=message):
        look(run, dem, observers, **wrong)
