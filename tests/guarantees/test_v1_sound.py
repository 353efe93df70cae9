# SPDX-License-Identifier: GPL-3.0-or-later
"""V1 sound: what is called visible clears every surface inside the error volume, what is called hidden is blocked by every one.

Surfaces are drawn, and the worst ones built on purpose. Two views of the same promise:
- sampling error alone: it is linear on every triangle, so the promise holds at every point of the line, not only where it was
  judged. Surfaces are TINs with their samples moved within z(c) sigma_s; looked at every 1/20 cell;
- with geologic variation: at the judged places.
Within 1.5 cells of an end the volume has the between-sample error only (docs/guarantees.md)."""
import numpy as np
import pytest
import terrains
from judge import NORTH_UP, Scene, placed
from sight_oracle import END_ZONE, FLOOR, Errors

SHAPE = (16, 18)
SAG = 1e-4   # metres: the curved line sinks below the chord between two crossings by at most cell^2 / 8R
UTM = dict(gt=(612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0), crs="EPSG:32633")
STEPS = dict(errors=Errors(vertical=0.5, horizontal=0.7), observer=(7.3, 8.1), observer_height=4.0, confidence=0.9)

SCENES = [Scene("fractal", terrains.fractal(SHAPE, 71), **UTM, **STEPS),
          Scene("noise", terrains.noise(SHAPE, 72), NORTH_UP, **{**STEPS, "observer_height": 8.0}),
          Scene("degrees", terrains.fractal(SHAPE, 73, 150.0), (10, 1e-3, 0, 66, 0, -1e-3), "EPSG:4326", **STEPS),
          Scene("terraces, errors as raster", terrains.plateaus(SHAPE, 74), **UTM,
                **{**STEPS, "errors": Errors(vertical=terrains.noise(SHAPE, 75, 1.5))}),
          Scene("Student's tails", terrains.fractal(SHAPE, 77), **UTM,
                **{**STEPS, "errors": Errors(vertical=0.5, horizontal=0.7, tails="student"), "confidence": 0.99, "observer_height": 8.0})]


def moved_surfaces(rng):
    """Moves of the samples in units of z(c) sigma_s: both extremes, white noise, steps, waves."""
    rows, cols = np.indices(SHAPE)
    yield np.ones(SHAPE)
    yield -np.ones(SHAPE)
    for _ in range(6):
        yield rng.uniform(-1, 1, SHAPE)
        yield rng.choice([-1.0, 1.0], SHAPE)
        yield np.sin(rows * rng.uniform(0, 1) + cols * rng.uniform(0, 1) + rng.uniform(0, 6))


@pytest.mark.parametrize("scene", [pytest.param(s, id=s.name) for s in SCENES])
def test_along_the_whole_line(scene):
    oracle = scene.oracle()
    result = scene.viewshed(oracle)
    claimed = placed(result, result.verdict, scene)
    xy, z = scene.xy(oracle), scene.z_two_sided
    surfaces = [oracle.z + z * u * oracle.sigma_s for u in moved_surfaces(np.random.default_rng(5))]
    assert set(np.unique(claimed)) >= {0, 2}
    for row, col in np.argwhere(claimed != 1):
        t_xy = tuple(float(v) for v in oracle.frame.xy(col, row))
        clearances = least_clearances(oracle, xy, t_xy, scene.observer_height, surfaces, z)
        if claimed[row, col] == 2:
            assert min(clearances) >= -SAG, f"({row}, {col}) is called visible, a surface rises {-min(clearances)} m into the line"
        else:
            assert max(clearances) <= SAG, f"({row}, {col}) is called hidden, a surface lets the line pass by {max(clearances)} m"


def least_clearances(oracle, o_xy, t_xy, height, surfaces, z):
    """For each surface the least of line - surface, at the judged places and every 1/20 cell between them. Sigma jumps where
    the end zone begins: between the last place inside it and the first outside, the surface is left where it is."""
    distance, azimuth = oracle.frame.inverse_geodesic(o_xy, t_xy)
    if distance == 0:
        return [np.inf]
    judged, _, _ = oracle.judged_places(o_xy, azimuth, distance, t_xy)
    if judged.size == 0:
        return [np.inf]

    def at_end(s):
        return (s < END_ZONE * oracle.cell) | (distance - s < END_ZONE * oracle.cell)

    dense = np.linspace(judged[0], judged[-1], 2 + int(20 * distance / oracle.cell))
    before = np.clip(np.searchsorted(judged, dense, "right") - 1, 0, judged.size - 1)
    after = np.clip(before + 1, 0, judged.size - 1)
    s = np.concatenate([judged, dense])
    near = np.concatenate([at_end(judged), at_end(judged[before]) & at_end(judged[after])])
    mixed = np.concatenate([np.zeros(judged.size, bool), at_end(judged[before]) != at_end(judged[after])])

    col, row = oracle.frame.path(o_xy, azimuth, s)
    ends = [float(oracle.at(oracle.z, *oracle.frame.colrow(*p))) for p in (o_xy, t_xy)]
    t, bend = s / distance, (1 - 0.13) / (2 * oracle.frame.euler_radius(o_xy, azimuth, distance))
    line = (1 - t) * (ends[0] + height) + t * ends[1] - bend * t * (1 - t) * distance ** 2
    terrain = oracle.at(oracle.z, col, row)
    least = []
    for i, surface in enumerate(surfaces):
        floor = z * FLOOR * (1 if i % 2 == 0 else -1)
        there = np.where(near, terrain + floor, np.where(mixed, terrain, oracle.at(surface, col, row)))
        least.append(float(np.min(line - there)))
    return least


@pytest.mark.parametrize("errors", [Errors(0.4, 0.5, 2.0, 4.0), Errors(0.2, 0.0, 0.3), Errors(0.1, 0.0, 3.0, None, "growth", 0.7),
                                    Errors(0.4, 0.5, 2.0, 4.0, tails="laplace")],
                         ids=["gaussian", "paper's", "growth", "Laplace's tails"])
@pytest.mark.parametrize("stand", ["model", "ground"])
def test_at_the_judged_places(errors, stand):
    scene = Scene("fractal", terrains.fractal(SHAPE, 76), **UTM, errors=errors, observer=(9.0, 7.0), observer_height=6.0, confidence=0.8,
                  target_height=4.0, how=dict(stand=stand))
    oracle = scene.oracle()
    result = scene.viewshed(oracle)
    claimed, z = placed(result, result.verdict, scene), scene.z_two_sided
    rng = np.random.default_rng(6)
    seen = set()
    for (row, col), sight in oracle.viewshed(scene.xy(oracle), 6.0, 4.0, stand=stand).items():
        if not sight.places:
            continue
        clear, sigma = sight.places["line"] - sight.places["terrain"], sight.places["sigma"]
        seen.add(claimed[row, col])
        for _ in range(20):
            surface = z * sigma * rng.choice([-1.0, 1.0, rng.uniform(-1, 1)], clear.shape)
            if claimed[row, col] == 2:
                assert np.all(clear - surface >= -1e-5)
            elif claimed[row, col] == 0:
                assert np.any(clear - surface <= 1e-5)
    assert seen >= {0, 1}
