# SPDX-License-Identifier: GPL-3.0-or-later
"""V7: without error the verdict is the exact boolean viewshed of the TIN. Sigma never falls below 1 mm, so only a line that
passes within 1.96 mm of the ground stays uncertain."""
import numpy as np
import pytest
import terrains
from boolean_oracle import least_clearance
from judge import NORTH_UP, Scene
from sight_oracle import Errors, z_two_sided

GRAZING = z_two_sided(0.95) * 0.001


@pytest.mark.parametrize("z, eye, observer", [
    (terrains.fractal((24, 28), 91), 2.0, (11, 13)),
    (np.round(terrains.fractal((24, 28), 92)), 1.5, (3, 25)),
    (terrains.noise((20, 20), 93), 9.0, (10, 10)),
    (terrains.plateaus((24, 24), 94), 5.0, (12, 11)),
    (terrains.spikes((22, 22), 95), 12.0, (11, 11)),
    (terrains.ridges((22, 22)), 25.0, (10, 4)),
    (terrains.fractal((40, 9), 96, 30.0), 3.0, (0, 0)),
], ids=["fractal", "whole metres", "noise", "terraces", "spikes", "walls", "narrow"])
@pytest.mark.parametrize("target_height", [0.0, 3.0])
def test_exact_boolean_viewshed(z, eye, observer, target_height):
    z = np.float32(z)
    result = Scene("boolean", z, NORTH_UP, None, Errors(vertical=0.0), observer=(float(observer[1]), float(observer[0])), observer_height=eye,
                   target_height=target_height, how=dict(curvature=False)).viewshed()
    heights, count = z.tolist(), {0: 0, 1: 0, 2: 0}
    for cell in np.ndindex(z.shape):
        if cell == observer:
            assert result.verdict[cell] == 2
            continue
        exact = float(least_clearance(heights, observer, cell, eye, target_height))
        claimed = int(result.verdict[cell])
        count[claimed] += 1
        if abs(abs(exact) - GRAZING) > 1e-8:
            assert claimed == (2 if exact > GRAZING else 0 if exact < -GRAZING else 1), f"{cell}: clear by {exact} m, verdict {claimed}"
    assert count[0] and count[2]
