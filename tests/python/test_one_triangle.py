# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 8 of the paper: the error volume of one equilateral triangle grows away from the samples, the more the larger
the rise that may hide between them.

In closed form its thickness along the normal, at distance d from the nearest sample, is
    2 E(d) = 2 (z sigma_v + (1 - exp(-(D d)^2 / 2)) D)           at 95 %, where z sigma_g(infinity) is D itself
"""

import numpy as np
import pytest

import sightbound as sb

Z95 = 1.959963984540054
SIGMA_V, LENGTH = 0.05, 10.0
SIDE, HEIGHT = 0.1, 0.005
CORNERS = np.array([(0.0, 0.0), (LENGTH, 0.0), (LENGTH / 2, LENGTH * 3**0.5 / 2)])
CENTROID = CORNERS.mean(axis=0)
EDGE_MIDDLE = CORNERS[:2].mean(axis=0)
VARIATIONS = (0.1, 0.2, 0.5, 1.0)


def closed_form(d, variation):
    return 2 * (Z95 * SIGMA_V + (1 - np.exp(-0.5 * (variation * d) ** 2)) * variation)


def triangle(upright):
    """The triangle, level at 100 m; with another one standing upright far off it is no height field."""
    places, faces = [(*corner, 100.0) for corner in CORNERS], [(0, 1, 2)]
    if upright:
        places += [(40.0, 0.0, 100.0), (40.5, 0.0, 100.0), (40.25, 0.0, 100.4)]
        faces += [(3, 4, 5)]
    return sb.Tin(places, faces)


def thickness_of(variation, upright, step=SIDE, height=HEIGHT):
    model = sb.ErrorModel(vertical_rmse=SIGMA_V, geologic_variation=variation)
    volume = sb.ErrorVolume.build(triangle(upright), model, voxel=step, voxel_height=height)
    assert volume.is_height_field != upright
    return volume.rasters(0.95)


def bounds_over(rasters, place, variation):
    """The thickness over the cell that holds the place, and the closed form's least and largest in that cell."""
    west, step, _, north, _, _ = rasters.geotransform
    row, col = int((north - place[1]) / step), int((place[0] - west) / step)
    x = west + step * (col + np.linspace(0, 1, 21))
    y = north - step * (row + np.linspace(0, 1, 21))
    d = np.min([np.hypot(x[:, None] - cx, y[None, :] - cy) for cx, cy in CORNERS], axis=0)
    return rasters.thickness[row, col], closed_form(d.min(), variation), closed_form(d.max(), variation)


@pytest.mark.parametrize("variation", VARIATIONS)
def test_thickness_is_the_closed_form(variation):
    rasters = thickness_of(variation, upright=False)
    inward = 0.02 * (CENTROID - CORNERS[0])
    found = []
    for place in (CORNERS[0] + inward, EDGE_MIDDLE + (0.0, 0.15), CENTROID):
        thickness, least, largest = bounds_over(rasters, place, variation)
        # Both ends of the column go to whole voxels; bounds are rounded to half floats, 2^-10 of k.
        assert least <= thickness <= largest * (1 + 2**-10) + 2 * HEIGHT
        found.append(thickness)
    assert found[0] < found[1] <= found[2] + 2 * HEIGHT


def test_along_the_normal_as_well():
    """Coarser voxels, since each one bounds all its places: up to half its diagonal more, at either side."""
    step, height = 0.25, 0.05
    for variation in (0.2, 1.0):
        rasters = thickness_of(variation, True, step, height)
        for place in (EDGE_MIDDLE + (0.0, 1.0), CENTROID, 0.7 * CORNERS[0] + 0.3 * CENTROID):
            thickness, least, largest = bounds_over(rasters, place, variation)
            assert least <= thickness <= largest + 2 * np.hypot(height, step)
        # Past the edges it reaches at least as far as half its thickness there. Voxels nearest to the border of a sheet
        # have no side, so the cover takes in all that is kept of them: to 3.29 times the largest sigma.
        west, side, _, north, _, _ = rasters.geotransform
        south = north - side * rasters.lower.shape[0]
        farthest = closed_form(LENGTH / 3**0.5, variation) / 2 * 3.29 / Z95 + 2 * side
        assert -farthest <= south <= -closed_form(LENGTH / 2, variation) / 2
        assert -farthest <= west <= -Z95 * SIGMA_V


@pytest.mark.parametrize("variation", VARIATIONS)
def test_it_grows_away_from_the_samples(variation):
    """Along the lines from the corners to the centroid, and with the variation."""
    rasters = thickness_of(variation, False, 0.2, 0.01)
    for corner in CORNERS:
        line = [corner + t * (CENTROID - corner) for t in np.linspace(0.05, 1, 15)]
        thickness = [bounds_over(rasters, place, variation)[0] for place in line]
        assert (np.diff(thickness) >= -1e-6).all() and thickness[-1] > thickness[0] + 2 * 0.01


def test_it_grows_with_the_variation():
    centre = [bounds_over(thickness_of(v, False, 0.2, 0.01), CENTROID, v)[0] for v in VARIATIONS]
    assert (np.diff(centre) > 0).all()
