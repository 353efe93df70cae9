# SPDX-License-Identifier: GPL-3.0-or-later
"""sb.verify() far from the CRS's origin and on heights that jump, against rational numbers: what is measured is what is."""

import numpy as np
import pytest
from osgeo import osr

import sightbound as sb
from exact_overlay import exact_deviation

WEST = 500000.0


def utm():
    system = osr.SpatialReference()
    system.ImportFromEPSG(32633)
    return system.ExportToWkt()


def jumping(jump, rough, seed, side=8):
    """Ground that is `rough` between steps of `jump`."""
    random = np.random.default_rng(seed)
    return (np.where(random.random((side, side)) < 0.3, jump, 0) + rough * random.random((side, side))).astype(np.float32)


# What bounds may be above the truth, metres: coordinates of a hundred metres, rounded, times the slope of the narrowest faces.
CLOSE = 1e-8
# Cell, northing, jump and tolerance.
CASES = [(10.0, 5e6, 10.0, 1.0), (0.4, 5e6, 3000.0, 0.002), (0.1, 5e6, 3000.0, 0.2), (0.001, 1e7, 3.0, 0.02)]


@pytest.mark.parametrize("south_up", [False, True])
@pytest.mark.parametrize("cell, north, jump, tolerance", CASES)
def test_measures_what_is(cell, north, jump, tolerance, south_up):
    heights = jumping(jump, 3 * tolerance, seed=1)
    transform = (WEST, cell, 0, north, 0, cell if south_up else -cell)
    dem = sb.Dem(heights, transform, utm())
    tin = sb.dem_to_tin(dem, tolerance=tolerance)
    deviation, ratio, _ = exact_deviation(heights, transform, np.full(heights.shape, tolerance), tin.vertices, tin.faces)
    found = sb.verify(dem, tin, tolerance).report
    assert found["largest_deviation"]["measured"] == pytest.approx(float(deviation), abs=1e-12)
    assert deviation <= found["largest_deviation"]["bound"] <= deviation + CLOSE
    assert ratio <= found["largest_ratio"]["bound"]
    assert found["uncovered"]["m2"] == found["surplus"]["m2"] == 0 and found["uncovered_vertices"] == 0


@pytest.mark.parametrize("seed", range(4))
def test_measures_what_is_in_windows_of_turned_rasters(seed):
    """Against a TIN that is no simplification: its heights are off by up to 2 km, its faces as they come."""
    random = np.random.default_rng(seed)
    heights = jumping(3000.0, 1.0, seed, side=7)
    transform = (WEST + 0.1, 0.31, 0.07, 5e6 + 0.7, 0.11, -0.37)
    at = [(c, r) for r in (0, 4, 6) for c in (0, 3, 6)]
    shift = np.array([random.uniform(-0.4, 0.4, 2) if c in (3,) and r in (4,) else (0, 0) for c, r in at])
    col, row = (np.array(at, dtype=float) + shift).T + 0.5
    x = transform[0] + col * transform[1] + row * transform[2]
    y = transform[3] + col * transform[4] + row * transform[5]
    vertices = np.column_stack([x, y, random.uniform(0, 2000, len(at))])
    squares = [(3 * r + c, 3 * r + c + 3, 3 * r + c + 4, 3 * r + c + 1) for r in (0, 1) for c in (0, 1)]
    faces = [f for nw, sw, se, ne in squares for f in ((nw, sw, se), (nw, se, ne))]
    tin = sb.Tin(vertices, faces, utm())
    deviation, _, _ = exact_deviation(heights, transform, np.ones(heights.shape), tin.vertices, tin.faces)
    found = sb.verify(sb.Dem(heights, transform, utm()), tin, 1.0).report["largest_deviation"]
    assert found["measured"] == pytest.approx(float(deviation), abs=1e-9)
    assert deviation <= found["bound"] <= deviation + CLOSE
