# SPDX-License-Identifier: GPL-3.0-or-later
"""The oracle itself, against numbers worked out by hand."""
import math

import numpy as np
import pytest

from sight_oracle import END_FRACTIONS, Errors, Oracle, probability, verdict, z_two_sided

ROW_OF_FIVE = (0, 10, 0, 30, 0, -10)   # 10 m cells, sample centres at x = 5, 15, ... and y = 25, 15, 5


def test_quantiles():
    assert z_two_sided(0.95) == pytest.approx(1.959964, abs=1e-6)
    assert (probability(3.3, 0.95), probability(-3.3, 0.95), probability(0, 0.95)) == (1.0, 0.0, 0.5)
    assert [verdict(k, 0.95) for k in (1.97, 1.9, -1.9, -1.97)] == [2, 1, 1, 0]
    # Tables of t with 5 degrees of freedom, over its sd sqrt(5/3); the Laplace distribution in closed form.
    assert z_two_sided(0.95, "student") == pytest.approx(2.570582 / math.sqrt(5 / 3), abs=1e-6)
    assert z_two_sided(0.999, "student") == pytest.approx(6.868827 / math.sqrt(5 / 3), abs=1e-6)
    assert z_two_sided(0.99, "laplace") == pytest.approx(math.log(100) / math.sqrt(2), abs=1e-9)


def test_wall_of_five_metres():
    """Eye 2 m at column 0, target on the ground at column 4, a wall of 5 m in column 2, sigma_v 1 m, no earth.

        z:  0 0 5 0 0      the line falls from 2 m to 0 m over 40 m: at 20 m it is 1 m high, 4 m below the wall's top
    """
    z = np.zeros((3, 5))
    z[:, 2] = 5
    oracle = Oracle(z, ROW_OF_FIVE, None, Errors(vertical=1.0))
    sight = oracle.sight((5, 15), (45, 15), 2.0, 0.0, curvature=False)
    assert sight.k == pytest.approx(-4.0)
    assert sight.distance == 40 and sight.azimuth == 90
    assert oracle.cell == pytest.approx(10)
    # To clear the wall's top by k sigmas the line must be 5 + k high halfway: the target at 2 (5 + k) - 2.
    assert sight.needed_height(0.0) == pytest.approx(8.0)
    assert sight.needed_height(1.96) == pytest.approx(11.92)


def test_end_zone_uses_geologic_error_alone():
    """Only one sample lies between the ends, less than 1.5 cells from both: sigma there is the floor of 1 mm."""
    z = np.zeros((3, 3))
    z[:, 1] = 1.0
    sight = Oracle(z, ROW_OF_FIVE, None, Errors(vertical=5.0)).sight((5, 15), (25, 15), 2.0, 2.0, curvature=False)
    assert sight.k == pytest.approx((2.0 - 1.0) / 0.001)


def test_end_places_and_gaussian():
    """Flat ground, neighbours 10 m apart: only the places f * 10 m from both ends are judged."""
    oracle = Oracle(np.zeros((3, 3)), ROW_OF_FIVE, None, Errors(vertical=1.0, delta=1.959963984540054, range=5.0))
    sight = oracle.sight((5, 15), (15, 15), 1.0, 1.0, curvature=False)
    assert sorted(sight.places["s"]) == pytest.approx(sorted([10 * f for f in END_FRACTIONS] + [10 - 10 * f for f in END_FRACTIONS]))
    # Halfway the nearest sample is 5 m off: sigma_g = 1 - exp(-1/2).
    assert sight.k == pytest.approx(1 / (1 - math.exp(-0.5)))


def test_diagonal_runs_from_north_west_to_south_east():
    z = np.zeros((2, 2))
    z[0, 0] = z[1, 1] = 4.0                      # north-west and south-east corners high: the middle is high
    north_up = Oracle(z, (0, 10, 0, 20, 0, -10))
    south_up = Oracle(z[::-1], (0, 10, 0, 0, 0, 10))
    assert north_up.frame.diagonal == "main" and south_up.frame.diagonal == "anti"
    for oracle in (north_up, south_up):
        assert oracle.at(oracle.z, *oracle.frame.colrow(10, 10)) == pytest.approx(4.0)
        assert oracle.at(oracle.z, *oracle.frame.colrow(7.5, 7.5)) == pytest.approx(2.0)


def test_earth_drops_by_the_euler_radius():
    """Along the equator the radius is the semi-major axis: 1 degree is 111319.49 m, and the drop in the middle L^2/8R."""
    shape = (3, 101)
    oracle = Oracle(np.zeros(shape), (0, 0.01, 0, 0.015, 0, -0.01), "EPSG:4326", Errors(vertical=1.0))
    sight = oracle.sight(tuple(oracle.frame.xy(0, 1)), tuple(oracle.frame.xy(100, 1)), 1000.0, 1000.0, refraction=0.0)
    assert sight.distance == pytest.approx(math.radians(1.0) * 6378137.0, rel=1e-12)
    middle = np.argmin(np.abs(sight.places["s"] - sight.distance / 2))
    assert 1000 - sight.places["line"][middle] == pytest.approx(sight.distance ** 2 / 8 / 6378137.0, rel=1e-9)


def test_geodesic_bulges_towards_the_pole():
    """At 60 degrees north, 10 degrees apart on a parallel: the geodesic passes 0.1899 degrees further north (spherical)."""
    oracle = Oracle(np.zeros((21, 101)), (0, 0.1, 0, 61.05, 0, -0.1), "EPSG:4326")
    a, b = tuple(oracle.frame.xy(0, 10)), tuple(oracle.frame.xy(100, 10))
    distance, azimuth = oracle.frame.inverse_geodesic(a, b)
    _, row = oracle.frame.path(a, azimuth, distance / 2)
    spherical = math.degrees(math.atan(math.tan(math.radians(60)) / math.cos(math.radians(5)))) - 60
    assert (10 - row) * 0.1 == pytest.approx(spherical, abs=1e-3)


def test_hole_leaves_doubt_unless_sight_may_cross():
    z = np.zeros((3, 9))
    z[:, 4] = np.nan
    oracle = Oracle(z, (0, 10, 0, 30, 0, -10), None, Errors(vertical=0.1))
    how = dict(observer_height=2.0, target_height=2.0, curvature=False)
    assert oracle.sight((5, 15), (85, 15), **how).k == 0.0
    assert oracle.sight((5, 15), (85, 15), see_across=True, **how).k == pytest.approx(20.0)
    assert oracle.sight((5, 15), (85, 15), **how).needed_height(1.96) == math.inf


def test_standing_on_unknown_ground_adds_both_ends():
    z = np.zeros((3, 9))
    oracle = Oracle(z, (0, 10, 0, 30, 0, -10), None, Errors(vertical=0.5))
    sight = oracle.sight((5, 15), (85, 15), 2.0, 2.0, curvature=False, stand="ground")
    assert sight.k == pytest.approx(2.0 / (0.5 + 0.5))


def test_steepest_triangle():
    """One sample raised by 10 m in 10 m cells: slope 1 along the axes; the two triangles where it is a right-angled corner
    rise along both axes at once: sqrt(2)."""
    z = np.zeros((3, 3))
    z[1, 1] = 10.0
    slope = Oracle(z, ROW_OF_FIVE).slope()
    assert slope[1, 1] == pytest.approx(math.sqrt(2))
    assert slope[0, 0] == pytest.approx(1.0)     # its only raised triangles: legs through (0,1) or (1,0) and up to the middle
    assert slope[0, 2] == 0.0                    # across the other diagonal
