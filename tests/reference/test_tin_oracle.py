# SPDX-License-Identifier: GPL-3.0-or-later
"""The oracle for lines and TINs, against numbers worked out by hand."""
import numpy as np
import pytest

from tin_oracle import TinOracle
from tins import block, sheet

Z = 1.96


def deck(**errors):
    """Level, 10 m up, 8 x 8 m in squares of 2 m."""
    return TinOracle(*sheet(4, 4, lambda u, v: (8 * u, 8 * v, 10.0)), **errors)


def line(*ends):
    return tuple(np.array(end, float) for end in ends)


def test_errors_along_the_normal():
    slope = TinOracle(*sheet(2, 2, lambda u, v: (4 * u, 4 * v, 4 * u)), sigma_v=0.1, sigma_h=0.2)
    assert slope.sigma_s == pytest.approx((0.1 + 0.2) / np.sqrt(2))
    assert slope.L == pytest.approx(2 * np.sqrt(2))   # of 2, 2 sqrt 2 and 2 sqrt 3
    wall = TinOracle(*sheet(1, 1, lambda u, v: (4 * u, 0.0, 4 * v)), sigma_v=0.1, sigma_h=0.2)
    assert wall.sigma_s == pytest.approx(0.2)


def test_distance_and_ratio():
    oracle = deck(sigma_v=0.5)
    distance, sampling, between, border = oracle.nearest([[3, 3, 12], [11, 4, 10], [11, 12, 10]])
    assert distance == pytest.approx([2, 3, 5])
    assert sampling == pytest.approx(0.5) and between == pytest.approx(0)
    assert border.tolist() == [False, True, True]
    assert oracle.nearest([[3, 3, 12]], 1.5)[0] == np.inf
    # One metre from the nearest sample, Delta = z(0.95), a range of 1 m: sigma_g = 1 - exp(-1/2).
    assert deck(sigma_v=0.5, delta=1.959963984540054, range_m=1.0).nearest([[3, 2, 12]])[2] == pytest.approx(1 - np.exp(-0.5))


def test_crossings_and_inside():
    body = TinOracle(*block((0, 0, 0), (4, 4, 4)))
    assert body.crossings(*line((-4, 1.1, 1.3), (12, 1.1, 1.3))) == pytest.approx([4 / 16, 8 / 16])
    assert body.crossings(*line((-4, 5, 1), (12, 5, 1))).size == 0
    assert body.inside(np.array([1.0, 2, 3])) and not body.inside(np.array([1.0, 2, 5]))


def test_what_refutes_a_claim_on_a_sheet():
    oracle = deck(sigma_v=0.1)
    through, over, close = line((3.1, 3.3, 20), (3.1, 3.3, 0)), line((-9, 3, 12), (17, 3, 12)), line((-9, 3, 10.15), (17, 3, 10.15))
    assert "goes through" in oracle.refutes_visible(*through, Z, 100)
    assert oracle.refutes_hidden(*through, Z, 0.1, False) is None
    assert oracle.refutes_visible(*over, Z, 100) is None
    assert "meets no face" in oracle.refutes_hidden(*over, Z, 0.1, False)
    assert "k is 1.5" in oracle.refutes_visible(*close, Z, 400)
    # From 0.04 m above the rim to 0.04 m below the other: away from faces by no more.
    assert "on both sides" in oracle.refutes_hidden(*line((-9, 3.1, 10.13), (17, 3.1, 9.87)), Z, 0.005, False)


def test_end_zones_count_no_sampling_error():
    oracle = deck(sigma_v=1.0)
    assert oracle.refutes_visible(*line((4, 4, 10.1), (4, 4, 12.9)), Z, 100) is None      # shorter than 2 x 1.5 L
    assert "k is" in oracle.refutes_visible(*line((-2, 4, 10.1), (10, 4, 10.1)), Z, 100)
    unknown = deck(sigma_v=0.0, delta=1.0, range_m=0.5)
    assert "k is" in unknown.refutes_visible(*line((3, 4, 10.1), (3, 4, 12.9)), Z, 100)


def test_what_refutes_a_claim_on_a_body():
    body = TinOracle(*block((0, 0, 0), (4, 4, 4)), sigma_v=0.1, sigma_h=0.1)
    assert body.refutes_hidden(*line((-8, 2.1, 2.2), (12, 2.1, 2.2)), Z, 0.05, True) is None
    assert "deep" in body.refutes_hidden(*line((-8, 2.1, 3.9), (12, 2.1, 3.9)), Z, 0.005, True)
    assert body.refutes_hidden(*line((2, 2, 2), (2.1, 2.1, 2.1)), Z, 0.05, True) is None
