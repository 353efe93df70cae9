# SPDX-License-Identifier: GPL-3.0-or-later
"""Lowest visible heights: the least height above ground, never negative, at which k* reaches z(c) (certain) or 0 (likely),
within 0.1 m of the definition; unknown ground on the way leaves no certain height."""
import numpy as np
import pytest
import sightbound as sb
import terrains
from judge import NORTH_UP, Scene, check, placed
from sight_oracle import Errors, z_two_sided

SHAPE = (16, 18)
UTM = dict(gt=(612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0), crs="EPSG:32633")
SOFT = Errors(vertical=0.4, horizontal=0.5, delta=1.5, range=4.0)

SCENES = [
    Scene("fractal", terrains.fractal(SHAPE, 111), **UTM, errors=SOFT, observer=(9.0, 7.0), observer_height=3.0),
    Scene("no error", terrains.fractal(SHAPE, 111), **UTM, errors=Errors(0.0), observer=(9.0, 7.0), observer_height=3.0),
    Scene("on the ground", terrains.fractal(SHAPE, 112), **UTM, errors=SOFT, observer=(4.4, 7.7), how=dict(stand="ground")),
    Scene("errors as rasters", terrains.fractal(SHAPE, 113), **UTM, observer=(4.4, 7.7), confidence=0.8,
          errors=Errors(terrains.noise(SHAPE, 114, 2.0), 0.3, terrains.noise(SHAPE, 115, 3.0), 4.0)),
    Scene("holes", terrains.with_holes(terrains.fractal(SHAPE, 116), 117, keep=(9, 7)), NORTH_UP, errors=SOFT, observer=(9.0, 7.0)),
    Scene("holes, sight crosses", terrains.with_holes(terrains.fractal(SHAPE, 116), 117, keep=(9, 7)), NORTH_UP, errors=SOFT,
          observer=(9.0, 7.0), how=dict(see_across=True)),
    Scene("degrees at 77", terrains.fractal(SHAPE, 118, 200.0), (10.0, 1 / 600, 0.0, 77.0, 0.0, -1 / 3600), "EPSG:4326", SOFT, (9.0, 7.0)),
    Scene("absolute eye", terrains.fractal(SHAPE, 119), **UTM, errors=SOFT, observer=(9.0, 7.0), observer_height=45.0, target_height=30.0,
          how=dict(height_reference="absolute")),
    Scene("tall targets asked for", terrains.fractal(SHAPE, 119), **UTM, errors=SOFT, observer=(9.0, 7.0), observer_height=3.0, target_height=12.0),
    Scene("surface model", terrains.fractal(SHAPE, 111) + terrains.spikes(SHAPE, 12, 30, 9.0), **UTM, errors=SOFT, observer=(9.0, 7.0),
          ground=terrains.fractal(SHAPE, 111)),
    Scene("80 x 80", terrains.fractal((80, 80), 120, 120.0), **UTM, errors=SOFT, observer=(40.0, 31.0), sample=250),
    Scene("80 x 80, towers", terrains.fractal((80, 80), 121, 120.0), **UTM, errors=Errors(2.0), observer=(40.2, 31.7), observer_height=60.0,
          sample=250),
]


@pytest.mark.parametrize("scene", [pytest.param(s, id=s.name) for s in SCENES])
def test_the_definition(scene):
    check(scene, heights=True)


def test_a_target_of_that_height_is_seen():
    scene = Scene("tower", terrains.fractal((60, 60), 122, 100.0), **UTM, errors=SOFT, observer=(30.0, 30.0), observer_height=3.0)
    oracle, result = scene.oracle(), scene.viewshed(heights=True)
    certain, likely = placed(result, result.lowest_visible_height, scene), placed(result, result.likely_visible_height, scene)
    xy, rng, judged = scene.xy(oracle), np.random.default_rng(123), 0
    for row, col in rng.integers(0, 60, (60, 2)):
        if certain[row, col] < 0.5:
            continue
        judged += 1
        target = tuple(float(v) for v in oracle.frame.xy(int(col), int(row)))

        def k(height):
            return sb.line_of_sight(scene.dem, xy, target, observer_height=3.0, target_height=float(height), error_model=scene.model).k

        assert k(certain[row, col] + 0.11) >= z_two_sided(0.95) > k(certain[row, col] - 0.11)
        assert k(likely[row, col] + 0.11) >= 0
    assert judged > 10


def test_heights_are_ordered_and_agree_with_the_verdict():
    scene = Scene("order", terrains.fractal((120, 120), 124, 120.0), **UTM, errors=SOFT, observer=(60.3, 50.1), observer_height=4.0)
    result = scene.viewshed(heights=True)
    certain, likely = result.lowest_visible_height, result.likely_visible_height
    assert np.all(likely >= 0) and np.all(certain >= likely - 0.1)
    assert np.all(certain[result.verdict == 2] <= 0.1) and np.all(certain[result.verdict != 2] > -0.1)
    assert np.all(likely[result.confidence > 0.501] <= 0.1)
    assert result.confidence.tobytes() == scene.viewshed().confidence.tobytes()


def test_not_computed_unless_asked():
    result = Scene("none", terrains.fractal(SHAPE, 1), **UTM).viewshed()
    assert result.lowest_visible_height is None and result.likely_visible_height is None


@pytest.mark.parametrize("combine, pick", [("best", np.fmin), ("worst", np.fmax)])
def test_combined(combine, pick):
    scene = Scene("two", terrains.fractal((50, 50), 125, 80.0), **UTM, errors=SOFT)
    oracle = scene.oracle()
    eyes = [tuple(float(v) for v in oracle.frame.xy(c, r)) for c, r in ((10.0, 10.0), (40.0, 30.0))]
    alone = [sb.viewshed(scene.dem, [eye], error_model=scene.model, heights=True) for eye in eyes]
    both = sb.viewshed(scene.dem, eyes, error_model=scene.model, heights=True, combine=combine)
    assert np.array_equal(both.lowest_visible_height, pick(*[r.lowest_visible_height for r in alone]), equal_nan=True)
    assert np.array_equal(both.likely_visible_height, pick(*[r.likely_visible_height for r in alone]), equal_nan=True)
