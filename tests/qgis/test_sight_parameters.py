# SPDX-License-Identifier: GPL-3.0-or-later
"""Each advanced parameter of the viewshed reaches the core and means what its help says."""

import numpy
import pytest
import scenes
from qgis.core import QgsProcessing

POINT = f"{scenes.FIRST[0]},{scenes.FIRST[1]} [EPSG:{scenes.UTM}]"


@pytest.fixture
def viewshed(run, dem):
    """(p, report of the one observer) for the given parameters."""

    def of(**parameters):
        common = {"INPUT": dem, "OBSERVER": POINT, "VERTICAL_ACCURACY": 1.0, "GEOLOGIC_VARIATION": 0.0}
        outputs = {"OUTPUT": QgsProcessing.TEMPORARY_OUTPUT, "OUTPUT_OBSERVERS": "memory:"}
        results = run("confidenceviewshed", **{**common, **outputs, **parameters})
        return scenes.read(results["OUTPUT"])[0], next(results["OUTPUT_OBSERVERS"].getFeatures())

    return of


def test_absolute_heights(viewshed):
    _, observer = viewshed(HEIGHT_REFERENCE="absolute", OBSERVER_HEIGHT=150.0, TARGET_HEIGHT=140.0)
    assert observer["eye_height"] == pytest.approx(150.0)


def test_vertical_unit(viewshed):
    _, metres = viewshed()
    _, feet = viewshed(VERTICAL_UNIT="foot")
    assert feet["ground_height"] == pytest.approx(0.3048 * metres["ground_height"], rel=1e-5)


def test_ground_under_a_surface_model(viewshed, tmp_path):
    ground = scenes.write_dem(tmp_path / "ground.tif", scenes.hills() - 5.0)
    _, bare = viewshed()
    _, below = viewshed(GROUND=str(ground), OBSERVER_HEIGHT=7.0)
    assert below["ground_height"] == pytest.approx(bare["ground_height"] - 5.0, abs=1e-3)
    assert below["eye_height"] == pytest.approx(bare["ground_height"] + 2.0, abs=1e-3)


def test_stand_on_the_ground_adds_doubt(viewshed):
    model, _ = viewshed(STAND="model")
    ground, _ = viewshed(STAND="ground")
    assert (numpy.abs(ground - 0.5) <= numpy.abs(model - 0.5) + 1e-6).all() and (ground != model).any()


def test_curvature_and_refraction(run, tmp_path):
    """On a plain the horizon of an eye at 2 m is 5 km away; without curvature there is none."""
    plain = numpy.zeros((3, 120), "float32")
    dem = scenes.write_raster(
        tmp_path / "plain.tif", plain, (scenes.WEST, 100.0, 0, scenes.NORTH, 0, -100.0), scenes.UTM
    )
    observer = f"{scenes.WEST + 50.0},{scenes.NORTH - 150.0} [EPSG:{scenes.UTM}]"

    def seen(**parameters):
        results = run("confidenceviewshed", INPUT=str(dem), OBSERVER=observer, OBSERVER_HEIGHT=2.0,
                      VERTICAL_ACCURACY=0.0, GEOLOGIC_VARIATION=0.0,
                      OUTPUT=QgsProcessing.TEMPORARY_OUTPUT, **parameters)  # fmt: skip
        return (scenes.read(results["OUTPUT"])[0][1] > 0.5).sum() * 100.0

    assert seen(REFRACTION=0.0) == pytest.approx(numpy.sqrt(2 * 6.37e6 * 2.0), rel=0.05)
    assert seen(REFRACTION=0.25) == pytest.approx(numpy.sqrt(2 * 6.37e6 * 2.0 / 0.75), rel=0.05)
    assert seen(CURVATURE=False) == 12000.0


def test_vertical_angles(viewshed):
    below, _ = viewshed(ANGLE_TO=0.0)
    above, _ = viewshed(ANGLE_FROM=0.0)
    assert numpy.isfinite(below).any() and numpy.isfinite(above).any()
    assert not (numpy.isfinite(below) & numpy.isfinite(above)).sum() > 5


def test_minimum_distance(viewshed):
    p, _ = viewshed(MIN_DISTANCE=50.0)
    assert numpy.isnan(p[9, 10]) and numpy.isfinite(p[9, 30])


def test_see_across_nodata(run, tmp_path):
    heights = numpy.zeros((5, 40), "float32")
    heights[:, 15:17] = -9999.0
    dem = str(scenes.write_dem(tmp_path / "gap.tif", heights))
    observer = f"{scenes.WEST + 55.0},{scenes.NORTH - 25.0} [EPSG:{scenes.UTM}]"
    common = {"INPUT": dem, "OBSERVER": observer, "OBSERVER_HEIGHT": 10.0, "VERTICAL_ACCURACY": 0.1}
    common |= {"GEOLOGIC_VARIATION": 0.0, "OUTPUT": QgsProcessing.TEMPORARY_OUTPUT}
    closed, across = (
        scenes.read(run("confidenceviewshed", SEE_ACROSS_NODATA=see, **common)["OUTPUT"])[0]
        for see in (False, True)
    )
    assert (
        (closed[:, 18:] <= 0.5).all()
        and (across[:, 18:] > 0.99).all()
        and numpy.isnan(across[:, 15:17]).all()
    )


def test_south_up_dem(run, tmp_path, observers):
    south = scenes.NORTH - scenes.ROWS * scenes.CELL
    turned = (scenes.WEST, scenes.CELL, 0.0, south, 0.0, scenes.CELL)
    up = scenes.write_raster(tmp_path / "up.tif", numpy.flipud(scenes.hills()).copy(), turned, scenes.UTM)
    down = scenes.write_dem(tmp_path / "down.tif")
    one, other = (
        scenes.read(run("confidenceviewshed", INPUT=str(dem), OBSERVERS=observers, VERTICAL_ACCURACY=1.0,
                        OUTPUT=QgsProcessing.TEMPORARY_OUTPUT)["OUTPUT"])[0]
        for dem in (down, up)
    )  # fmt: skip
    assert numpy.array_equal(one, numpy.flipud(other), equal_nan=True)
