# SPDX-License-Identifier: GPL-3.0-or-later
"""ErrorVolume.rasters(): the outer cover seen from above, against points sampled on the terrain with NumPy alone."""

import numpy as np
import pytest
from osgeo import gdal

import sightbound as sb

gdal.UseExceptions()

WEST, NORTH, CELL, SIGMA = 500000.0, 5000000.0, 10.0, 0.6
Z95 = 1.959963984540054
MODEL = sb.ErrorModel(vertical_rmse=SIGMA, geologic_variation=0.0)
SIDE, HEIGHT = 3.0, 0.25


@pytest.fixture(scope="module")
def heights():
    y, x = np.mgrid[0:24, 0:31]
    waves = 30 * np.sin(x / 4.0) * np.cos(y / 5.0) + 2 * np.random.default_rng(8).standard_normal(x.shape)
    return (200 + waves).astype(np.float32)


@pytest.fixture(scope="module")
def volume(heights):
    dem = sb.Dem(heights, (WEST, CELL, 0, NORTH, 0, -CELL), "EPSG:32633")
    return sb.ErrorVolume.build(dem, MODEL, voxel=SIDE, voxel_height=HEIGHT)


def terrain_at(heights, x, y):
    """The TIN's heights: squares of four samples split from north-west to south-east."""
    c, r = (x - WEST) / CELL - 0.5, (NORTH - y) / CELL - 0.5
    i, j = np.floor(c).astype(int), np.floor(r).astype(int)
    u, v = c - i, r - j
    nw, ne, sw, se = heights[j, i], heights[j, i + 1], heights[j + 1, i], heights[j + 1, i + 1]
    return np.where(u > v, nw + u * (ne - nw) + v * (se - ne), nw + v * (sw - nw) + u * (se - sw))


def cells_of(rasters, x, y):
    west, step, _, north, _, _ = rasters.geotransform
    return np.floor((north - y) / step).astype(int), np.floor((x - west) / step).astype(int)


@pytest.mark.parametrize("confidence, z", [(0.5, 0.6744897501960817), (0.95, Z95)])
def test_rasters_hold_the_sampled_volume_and_little_more(volume, heights, confidence, z):
    random = np.random.default_rng(4)
    rows, cols = heights.shape
    x = WEST + CELL * (0.5 + random.uniform(0, cols - 1.001, 400000))
    y = NORTH - CELL * (0.5 + random.uniform(0, rows - 1.001, 400000))
    h = terrain_at(heights, x, y)
    rasters = volume.rasters(confidence)
    cell = cells_of(rasters, x, y)
    assert (rasters.lower[cell] <= h - z * SIGMA).all() and (rasters.upper[cell] >= h + z * SIGMA).all()
    # Tight: about 70 samples a column come near its lowest and highest place, so that a voxel and the terrain's fall
    # between neighbouring samples are all that is left over.
    lowest, highest = np.full(rasters.lower.shape, np.inf), np.full(rasters.lower.shape, -np.inf)
    np.minimum.at(lowest, cell, h)
    np.maximum.at(highest, cell, h)
    inner = np.zeros(lowest.shape, bool)
    inner[5:-5, 5:-5] = True
    low, high = (lowest - z * SIGMA - rasters.lower)[inner], (rasters.upper - highest - z * SIGMA)[inner]
    assert np.quantile(low, 0.5) < 2.5 * HEIGHT and np.quantile(high, 0.5) < 2.5 * HEIGHT
    assert (rasters.thickness == rasters.upper - rasters.lower)[np.isfinite(rasters.lower)].all(), "no gaps"


def test_a_confidence_more_is_a_thicker_volume(volume):
    thin, thick = volume.rasters(0.5), volume.rasters(0.99)
    assert thin.geotransform == thick.geotransform
    known = np.isfinite(thin.thickness)
    assert (known == np.isfinite(thick.thickness)).all() and (thick.thickness > thin.thickness)[known].all()
    for wrong in (0.0, 1.0, 0.9999):
        with pytest.raises(ValueError, match="confidence"):
            volume.rasters(wrong)


def test_gaps_under_a_deck_do_not_count():
    """Ground at 0, a deck at 20 over its middle: two slabs of 2 z sigma each, and air between."""
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    places = np.vstack([np.column_stack([60 * square, np.zeros(4)]), np.column_stack([20 + 20 * square, np.full(4, 20.0)])])
    tin = sb.Tin(places, [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
    volume = sb.ErrorVolume.build(tin, MODEL, voxel=1.0, voxel_height=0.1)
    assert not volume.is_height_field
    rasters = volume.rasters()
    slab = 2 * Z95 * SIGMA
    deck, ground = cells_of(rasters, 30.3, 30.3), cells_of(rasters, 8.3, 8.3)
    for cell, slabs, top in ((deck, 2, 20.0), (ground, 1, 0.0)):
        assert slabs * slab <= rasters.thickness[cell] <= slabs * (slab + 3 * 0.1)
        assert -Z95 * SIGMA - 0.2 <= rasters.lower[cell] <= -Z95 * SIGMA
        assert top + Z95 * SIGMA <= rasters.upper[cell] <= top + Z95 * SIGMA + 0.2
    # Along the normal the volume goes round the edges: it is wider than the ground by z sigma, and a voxel.
    west, step, _, north, _, _ = rasters.geotransform
    assert -Z95 * SIGMA - 2.0 <= west <= -Z95 * SIGMA and 60 + Z95 * SIGMA <= north <= 62 + Z95 * SIGMA


def test_written_rasters(volume, tmp_path):
    paths = {name: tmp_path / f"{name}.tif" for name in ("lower", "upper", "thickness")}
    volume.write(**paths, confidence=0.9)
    rasters = volume.rasters(0.9)
    for name, path in paths.items():
        dataset = gdal.Open(str(path))
        assert np.array_equal(dataset.ReadAsArray(), getattr(rasters, name), equal_nan=True)
        assert dataset.GetGeoTransform() == rasters.geotransform
        assert dataset.GetMetadataItem("SIGHTBOUND_CONFIDENCE") == "0.9"
        assert '"vertical_rmse": 0.6' in dataset.GetMetadataItem("SIGHTBOUND_ERROR_MODEL")
    with pytest.raises(ValueError, match="nothing to write"):
        volume.write()
    with pytest.raises(OSError):
        volume.write(lower=tmp_path / "no" / "such.tif")
