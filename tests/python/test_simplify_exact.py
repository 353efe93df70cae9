# SPDX-License-Identifier: GPL-3.0-or-later
"""dem_to_tin as its file is read back, against rational numbers: within the tolerance, reports no less than what is, whatever the
geotransform."""

import numpy as np
import pytest

import sightbound as sb
from exact_overlay import exact_deviation
from test_verify_exact import jumping

# A cell, its corner's coordinates, how high the ground jumps, the tolerance.
CASES = {
    "whole metres": ((10.0, 0, 0, -10.0), (5e5, 5e6), 30.0, 2.0),
    "tenths": ((0.1, 0, 0, -0.1), (5e5, 9.9e6), 30.0, 0.05),
    "tenths and cliffs": ((0.3, 0, 0, -0.3), (5e5, 5e6), 3000.0, 0.2),
    "millimetres": ((0.001, 0, 0, -0.001), (5e8, 5e8), 0.003, 0.002),
    "turned": ((0.31, 0.07, 0.11, -0.37), (5e5 + 0.1, 5e6 + 0.7), 30.0, 0.2),
    "south up": ((0.3, 0, 0, 0.3), (5e5 + 0.1, 5e6 + 0.7), 30.0, 0.2),
    "spikes": ((0.7, 0, 0, -0.7), (5e5, 5e6), -32768.0, 0.1),
}


def transform_of(cell, corner):
    (a, b, c, d), (x, y) = cell, corner
    return (x, a, b, y, c, d)


def read_back(tin, folder):
    path = folder / "tin.ply"
    tin.write(path)
    return sb.read_tin(path)


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("cell, corner, jump, tolerance", CASES.values(), ids=CASES.keys())
def test_coordinates_as_written_keep_the_tolerance(cell, corner, jump, tolerance, seed, tmp_path):
    heights = jumping(jump, 1.5 * tolerance, seed, side=8)
    heights[np.random.default_rng(seed).random(heights.shape) < 0.05] = np.nan
    transform = transform_of(cell, corner)
    tin = sb.dem_to_tin(sb.Dem(heights, transform, None), tolerance=tolerance)
    assert tin.report["faces_after"] < tin.report["faces_before"]
    written = read_back(tin, tmp_path)
    everywhere = np.full(heights.shape, tolerance)
    deviation, ratio, excess = exact_deviation(heights, transform, everywhere, written.vertices, written.faces)
    assert excess <= 0
    assert deviation <= tin.report["largest_deviation"] and ratio <= tin.report["largest_ratio"]


@pytest.mark.parametrize("seed", range(3))
def test_a_window_keeps_the_tolerance_too(seed, tmp_path):
    heights = jumping(30.0, 0.3, seed, side=11)
    transform = transform_of((0.31, 0.07, 0.11, -0.37), (5e5 + 0.1, 5e6 + 0.7))
    dem = sb.Dem(heights, transform, None)
    tin = sb.dem_to_tin(dem, tolerance=0.2, extent=(5e5 + 1.2, 5e6 - 1.5, 5e5 + 2.2, 5e6 - 0.7))
    assert tin.report["faces_before"] < 200
    written = read_back(tin, tmp_path)
    deviation, _, excess = exact_deviation(heights, transform, np.full(heights.shape, 0.2), written.vertices, written.faces)
    assert excess <= 0 and deviation <= tin.report["largest_deviation"]


@pytest.mark.parametrize("cell", [10.0, 0.3])
def test_where_nothing_is_allowed_the_report_tells_what_writing_costs(cell, tmp_path):
    """Samples with a tolerance of 0 stay; their coordinates are rounded unless doubles hold them."""
    heights = jumping(300.0, 1.0, 5, side=8)
    tolerance = np.where(np.random.default_rng(5).random(heights.shape) < 0.3, 0, 2).astype(np.float32)
    transform = transform_of((cell, 0, 0, -cell), (5e5, 5e6))
    dem = sb.Dem(heights, transform, None)
    for allowed in (tolerance, np.zeros_like(tolerance)):
        tin = sb.dem_to_tin(dem, tolerance=allowed)
        written = read_back(tin, tmp_path)
        deviation, _, excess = exact_deviation(heights, transform, allowed, written.vertices, written.faces)
        assert deviation <= tin.report["largest_deviation"] <= float(deviation) + 1e-4
        assert excess <= (0 if cell == 10.0 else 1e-5)


def test_what_doubles_cannot_carry_is_refused():
    heights = jumping(30.0, 1.0, 1, side=6)

    def refused(cell, corner, tolerance=0.002, ground=heights):
        with pytest.raises(ValueError) as error:
            sb.dem_to_tin(sb.Dem(ground, (corner, cell, 0, corner, 0, -cell), None), tolerance=tolerance)
        return str(error.value)

    assert "coordinates of 2" in refused(1.0, 2e9)
    assert "cells are too small for coordinates" in refused(0.0005, 9e8)
    assert "tolerance is 0.002" in refused(0.001, 5e8)
    far = heights.copy()
    far[2, 2] = -3.4028235e38
    assert "height of the DEM is -3.4" in refused(1.0, 5e6, ground=far)
