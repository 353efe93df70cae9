# SPDX-License-Identifier: GPL-3.0-or-later
"""sightbound:errorsurfaces through processing.run."""

import numpy
import pytest
import scenes

NAMES = ("OUTPUT_SIGMA", "OUTPUT_LOWER", "OUTPUT_UPPER")


def test_surfaces_lie_z_sigma_off_the_terrain(run, dem, tmp_path):
    out = {name: str(tmp_path / f"{name}.tif") for name in NAMES}
    run("errorsurfaces", INPUT=dem, VERTICAL_ACCURACY=2.0, GEOLOGIC_VARIATION=0.0, CONFIDENCE=0.9, **out)
    sigma, lower, upper = (scenes.read(out[name])[0] for name in NAMES)
    heights, _ = scenes.read(dem)
    assert sigma == pytest.approx(2.0)
    assert numpy.allclose(upper - heights, 1.6449 * 2.0, atol=1e-3)
    assert numpy.allclose(heights - lower, 1.6449 * 2.0, atol=1e-3)


def test_extent_and_nodata(run, tmp_path):
    heights = scenes.hills()
    heights[12:14, 22:25] = -9999.0
    dem = str(scenes.write_dem(tmp_path / "holes.tif", heights))
    box = f"{scenes.WEST + 200},{scenes.WEST + 300},{scenes.NORTH - 200},{scenes.NORTH - 100} [EPSG:{scenes.UTM}]"
    results = run("errorsurfaces", INPUT=dem, EXTENT=box, OUTPUT_SIGMA=str(tmp_path / "sigma.tif"))
    sigma, _ = scenes.read(results["OUTPUT_SIGMA"])
    assert (
        sigma.shape == (10, 10) and numpy.isnan(sigma[2:4, 2:5]).all() and numpy.isfinite(sigma).sum() == 94
    )


def test_only_sigma_is_needed(run, dem, tmp_path):
    results = run("errorsurfaces", INPUT=dem, OUTPUT_SIGMA=str(tmp_path / "sigma.tif"))
    assert set(results) == {"OUTPUT_SIGMA", "ERROR_MODEL_USED"}
