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
    assert numpy.nanmax(abs(error - numpy.sqrt(p * (1 - p) / 200))) < 0.001  # some cells are left after 192
    assert results["LARGEST_ERROR"] == pytest.approx(numpy.nanmax(error))
    assert results["AREA_EXPECTED"] == pytest.approx(numpy.nansum(p) * scenes.CELL**2, rel=2e-3)
    assert "from_dem" in json.loads(results["ERROR_MODEL_USED"])["geologic_variation"]
    assert log.fractions == sorted(log.fractions) and log.fractions[-1] == 100.0
    whole = sum(results[f"AREA_{word}"] for word in ("VISIBLE", "UNCERTAIN", "HIDDEN"))
    told = " ".join(log.infos)
    assert f"Of {whole / 1e6:.4g} km² judged" in told and "at a confidence of 0.95" in told
    assert f"{round(results['AREA_VISIBLE'], -1):,.0f} m² (" in told, "no powers of ten"
    assert "learnt from the elevation model" in told and "Up to 200 terrains were drawn" in told


def test_the_seed_draws(run, dem, observers):
    one, same, other = (
        scenes.read(look(run, dem, observers, SEED=seed, VERTICAL_ACCURACY=2.0)["OUTPUT"])[0] for seed in (1, 1, 2)
    )
    assert numpy.array_equal(one, same, equal_nan=True) and not numpy.array_equal(one, other, equal_nan=True)


def test_heights_have_bands(run, dem, observers, tmp_path):
    results = look(run, dem, observers, HEIGHTS="0.5; 30", OUTPUT_HEIGHTS=str(tmp_path / "h.tif"))
    bands, dataset = scenes.read(results["OUTPUT_HEIGHTS"])
    assert bands.shape == (2, scenes.ROWS, scenes.COLS) and "30 m" in dataset.GetRasterBand(2).GetDescription()
    assert numpy.nanmean(bands[1]) > numpy.nanmean(bands[0])


def test_a_decimal_comma_is_one_between_semicolons(run, dem, observers, tmp_path):
    """As German and French keyboards write it: never other heights without a word."""
    with_commas = look(run, dem, observers, HEIGHTS="0,5; 30", OUTPUT_HEIGHTS=str(tmp_path / "commas.tif"))
    with_points = look(run, dem, observers, HEIGHTS="0.5; 30", OUTPUT_HEIGHTS=str(tmp_path / "points.tif"))
    found, wanted = (scenes.read(one["OUTPUT_HEIGHTS"])[0] for one in (with_commas, with_points))
    assert numpy.array_equal(found, wanted, equal_nan=True)


def test_how_terrains_are_drawn(run, dem, observers):
    def drawn(**more):
        return scenes.read(look(run, dem, observers, VERTICAL_ACCURACY=2.0, **more)["OUTPUT"])[0]

    usual = drawn()
    for more in ({"METHOD": "perturb"}, {"REFINEMENT": 0}):
        assert not numpy.array_equal(usual, drawn(**more), equal_nan=True)
    assert numpy.nanmax(abs(usual - drawn(PRECISION=0))) < 0.1


@pytest.mark.parametrize("wrong, message", [
    ({"HEIGHTS": "2, high"}, "HEIGHTS"),
    ({"OUTPUT_HEIGHTS": "TEMPORARY_OUTPUT"}, "OUTPUT_HEIGHTS"),
    ({"PRECISION": 0.7}, "PRECISION"),
    ({"OBSERVERS": None}, "OBSERVERS"),
    ({"CONFIDENCE": 1.0}, "CONFIDENCE"),
    ({"REALISATIONS": 0}, "REALISATIONS"),
    ({"OUTPUT": "/nowhere/p.tif"}, "OUTPUT"),
])
def test_what_is_wrong_is_named(run, dem, observers, wrong, message):
    with pytest.raises(QgsProcessingException, match=message):
        look(run, dem, observers, **wrong)
