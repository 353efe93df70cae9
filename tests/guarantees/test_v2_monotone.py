# SPDX-License-Identifier: GPL-3.0-or-later
"""V2 monotone: raising the confidence never enlarges visible or hidden, only uncertain; p does not depend on it."""
import numpy as np
import pytest
import terrains
from judge import Scene
from sight_oracle import CERTAIN_K, NORMAL, Errors

LEVELS = [0.1, 0.5, 0.8, 0.9, 0.95, 0.99, 0.999, 0.9999]
UTM = dict(gt=(612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0), crs="EPSG:32633")


@pytest.mark.parametrize("stand, tails", [("model", "normal"), ("ground", "normal"), ("model", "laplace"), ("ground", "student")])
@pytest.mark.parametrize("seed", range(4))
def test_claims_shrink(seed, stand, tails):
    scene = Scene(f"seed {seed}", terrains.fractal((90, 110), seed, 120.0), **UTM, errors=Errors(0.5, 0.3, 2.0, 6.0, tails=tails),
                  observer=(40.3, 52.8), observer_height=5.0, how=dict(stand=stand))
    results = [scene.viewshed(confidence=c) for c in LEVELS]
    for narrow, wide in zip(results, results[1:]):
        assert not np.any((wide.verdict == 2) & (narrow.verdict != 2))
        assert not np.any((wide.verdict == 0) & (narrow.verdict != 0))
    shares = [np.mean(r.verdict == 1) for r in results]
    assert shares[0] < shares[-1]


@pytest.mark.parametrize("tails", ["normal", "student"])
def test_p_is_the_same_at_every_confidence(tails):
    scene = Scene("p", terrains.fractal((60, 60), 9, 120.0), **UTM, errors=Errors(0.5, 0.3, 2.0, 6.0, tails=tails), observer=(30.0, 30.0), observer_height=5.0)
    low, high = scene.viewshed(confidence=0.5).confidence, scene.viewshed(confidence=0.9999).confidence
    settled = (low > 0) & (low < 1)
    assert settled.any() and np.array_equal(low[settled], high[settled])
    # Beyond 3.29 (for other tails: beyond the same p) the lower confidence says 0 or 1, the higher one the value.
    edge = NORMAL.cdf(-CERTAIN_K)
    assert np.all(high[low == 0] <= edge + 1e-6) and np.all(high[low == 1] >= 1 - edge - 1e-6)


@pytest.mark.parametrize("tails", ["normal", "laplace", "student"])
def test_one_rule_for_claims(tails):
    """visible when p >= (1 + c) / 2, hidden when p <= (1 - c) / 2."""
    for c in LEVELS:
        result = Scene("rule", terrains.fractal((60, 60), 10, 120.0), **UTM, errors=Errors(0.5, 0.3, 2.0, 6.0, tails=tails), observer=(30.0, 30.0),
                       observer_height=5.0, confidence=c).viewshed()
        p, margin = result.confidence.astype(float), 1e-6
        assert np.all(result.verdict[p >= (1 + c) / 2 + margin] == 2) and np.all(p[result.verdict == 2] >= (1 + c) / 2 - margin)
        assert np.all(result.verdict[p <= (1 - c) / 2 - margin] == 0) and np.all(p[result.verdict == 0] <= (1 - c) / 2 + margin)
