# SPDX-License-Identifier: GPL-3.0-or-later
"""V3 reciprocal: swapping observer and target (with their heights) keeps the verdict."""
import numpy as np
import pytest
import sightbound as sb
import terrains
from judge import TIE, Scene
from sight_oracle import Errors, z_two_sided

SHAPE = (30, 34)
EARTHS = {"plane": ((500.0, 10.0, 0.0, 900.0, 0.0, -10.0), None, 60.0),
          "UTM": ((612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0), "EPSG:32633", 60.0),
          "degrees at 77": ((10.0, 0.01, 0.0, 77.0, 0.0, -0.005), "EPSG:4326", 500.0),
          "Web Mercator, wide": ((1.2e6, 2000.0, 0.0, 8.4e6, 0.0, -2000.0), "EPSG:3857", 2000.0),
          "south-up": ((612340.0, 10.0, 0.0, 5538120.0, 0.0, 10.0), "EPSG:32633", 60.0)}


@pytest.mark.parametrize("stand", ["model", "ground"])
@pytest.mark.parametrize("earth", EARTHS)
def test_there_and_back(earth, stand):
    gt, crs, relief = EARTHS[earth]
    z = terrains.with_holes(terrains.fractal(SHAPE, 81, relief), 82, 0.002)
    scene = Scene(earth, z, gt, crs, Errors(vertical=relief / 100, horizontal=0.4, delta=relief / 20, range=6.0))
    oracle, dem, model = scene.oracle(), scene.dem, scene.model
    rng = np.random.default_rng(83)
    verdicts = []
    for _ in range(60):
        ends = [(float(rng.uniform(0, SHAPE[1] - 1)), float(rng.uniform(0, SHAPE[0] - 1))) for _ in range(2)]
        if any(np.isnan(oracle.at(oracle.z, *end)) for end in ends):
            continue
        a, b = (tuple(float(v) for v in oracle.frame.xy(*end)) for end in ends)
        heights = [float(v) for v in rng.uniform(0, relief / 3, 2)]
        there = sb.line_of_sight(dem, a, b, observer_height=heights[0], target_height=heights[1], error_model=model, stand=stand)
        back = sb.line_of_sight(dem, b, a, observer_height=heights[1], target_height=heights[0], error_model=model, stand=stand)
        assert there.k == pytest.approx(back.k, abs=5e-4, rel=1e-4), f"{ends}: {there.k} there, {back.k} back"
        z95 = z_two_sided(0.95)
        if min(abs(there.k - z95), abs(there.k + z95)) > max(TIE, abs(there.k - back.k)):
            assert there.verdict == back.verdict, f"{ends}: {there.k} there, {back.k} back"
        verdicts.append(there.verdict)
    assert set(verdicts) >= {0, 1}


def test_viewsheds_see_each_other():
    """The cell of B in A's viewshed and the cell of A in B's."""
    z = terrains.fractal((80, 80), 84, 80.0)
    scene = Scene("pairs", z, (612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0), "EPSG:32633", Errors(0.3, 0.3, 1.0, 6.0),
                  observer_height=3.0, target_height=3.0)
    rng = np.random.default_rng(85)
    cells = [tuple(int(v) for v in rng.integers(0, 80, 2)) for _ in range(8)]
    views = [scene.but(observer=(float(c), float(r))).viewshed() for r, c in cells]
    for i, a in enumerate(cells):
        for j, b in enumerate(cells):
            assert views[i].confidence[b] == pytest.approx(float(views[j].confidence[a]), abs=1e-3)
            assert views[i].verdict[b] == views[j].verdict[a]
