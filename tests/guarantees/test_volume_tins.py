# SPDX-License-Identifier: GPL-3.0-or-later
"""V1 in the volume, for TINs that are no height fields: every claim of a volume viewshed against the triangles themselves.

Eyes stand anywhere over the terrain, half of them between two of its sheets (under a roof, a deck, an overhang). `visible` must be clear of
every face by z(c) sigma, `hidden` must go through one, z(c) sigma deep (reference/tin_oracle.py). Both must be frequent enough for that to
mean something."""
import numpy as np
import pytest
import sightbound as sb
import tins
from sight_oracle import z_two_sided
from tin_oracle import TinOracle

EYES = 4
CHECKED = {0: 20, 2: 50}      # of each eye's claims, hidden and visible
SPACING, HEIGHT = 2.5, 0.5
SAMPLES, STEP = 120, 0.05     # places looked at on a line called visible; metres between them on one called hidden
# The least share of claims of either kind among all lines of a scene's eyes and seeds, about half of what there are.
LEAST = {"arch": (0.1, 0.3), "cave": (0.25, 0.15), "bridge": (0.05, 0.35), "quarry": (0.2, 0.25), "building": (0.06, 0.3),
         "bodies": (0.3, 0.2), "two sheets": (0.3, 0.07), "leaning": (0.1, 0.3)}
ERRORS = (dict(), dict(delta=0.25, range_m=2.0))   # by seed: sampling error alone, and between the samples too


class Scene:
    def __init__(self, name, seed, delta=0.0, range_m=None, tails="normal"):
        self.rng = np.random.default_rng([seed, *name.encode()])
        vertices, faces = tins.ALL[name](self.rng)
        given = sb.Tin(vertices, faces, sigma_v=self.rng.uniform(0.04, 0.1, len(vertices)))
        model = sb.ErrorModel(horizontal_rmse=0.03, geologic_variation=delta, geologic_range=range_m, tails=tails)
        self.tails = tails
        self.volume = sb.ErrorVolume.build(given, model, voxel=0.2)
        self.oracle = TinOracle(given.vertices, given.faces, given.sigma_v, 0.03, delta, range_m=range_m)
        self.solid = name == "bodies"
        assert not self.volume.is_height_field

    def eye(self, between):
        x, y = self.rng.uniform(3, 37, 2)
        floors = -100 + 200 * self.oracle.crossings(np.array([x, y, -100.0]), np.array([x, y, 100.0]))
        if not between or len(floors) < 2:
            return np.array([x, y, self.rng.uniform(1, 14)])
        gap = self.rng.integers(len(floors) - 1)
        return np.array([x, y, self.rng.uniform(floors[gap], floors[gap + 1])])

    def answers(self, eye, confidence):
        """(places, verdicts) of all targets."""
        hidden = sb.volume_viewshed(self.volume, [tuple(eye[:2])], view_height=float(eye[2]), height_reference="absolute", curvature=False,
                                    target_spacing=SPACING, target_height_spacing=HEIGHT, target_ceiling=6.0, confidence=confidence)
        west, south, low, _, _, high = self.volume.bounds
        lattice = hidden.lattice
        across, along = np.arange(lattice["columns"]) + 0.5, np.arange(lattice["rows"]) + 0.5
        up = np.floor(low / HEIGHT) + np.arange(int((high - low + 6) / HEIGHT) + 2) + 0.5
        x, y, z = np.meshgrid(west + SPACING * across, south + SPACING * along, HEIGHT * up, indexing="ij")
        places = np.stack([x, y, z], -1).reshape(-1, 3)
        found = [hidden.at(*place) for place in places]
        asked = np.array([one is not None for one in found])
        assert asked.sum() == lattice["targets"]
        return places[asked], np.array([one[0] for one in found if one is not None])


def judged(scene, n, label):
    """Of the n-th eye: how many targets got each verdict, and what refutes those claims that were looked at."""
    eye, confidence = scene.eye(n % 2 == 1), (0.95, 0.8)[n % 2]
    places, verdicts = scene.answers(eye, confidence)
    z, wrong = z_two_sided(confidence, scene.tails), []
    for verdict, count in CHECKED.items():
        claimed = np.flatnonzero(verdicts == verdict)
        for i in scene.rng.permutation(claimed)[:count]:
            why = (scene.oracle.refutes_hidden(eye, places[i], z, STEP, scene.solid) if verdict == 0 else
                   scene.oracle.refutes_visible(eye, places[i], z, SAMPLES))
            if why:
                called = ("hidden", "", "visible")[verdict]
                wrong.append(f"{label}, c {confidence}, {eye} to {places[i]}: called {called}, but {why}")
    return np.bincount(verdicts, minlength=3), wrong


@pytest.mark.parametrize("name", ["arch", "building"])
@pytest.mark.parametrize("tails", ["laplace", "student"])
def test_claims_hold_under_other_tails(name, tails):
    scene = Scene(name, 5, delta=0.25, range_m=2.0, tails=tails)
    counts, wrong = judged(scene, 0, tails)
    assert not wrong, f"{len(wrong)} claims are refuted:\n" + "\n".join(wrong[:10])
    assert counts[0] >= CHECKED[0] and counts[2] >= CHECKED[2]


@pytest.mark.parametrize("name", tins.ALL)
def test_claims_hold_for_the_triangles(name):
    counts, wrong = np.zeros(3, int), []
    for seed, errors in enumerate(ERRORS):
        scene = Scene(name, seed, **errors)
        for n in range(EYES):
            seen, refuted = judged(scene, n, f"seed {seed}")
            counts += seen
            wrong += refuted
    shares = counts / counts.sum()
    print(f"{name}: hidden {shares[0]:.3f}, uncertain {shares[1]:.3f}, visible {shares[2]:.3f} of {counts.sum()}")
    assert not wrong, f"{len(wrong)} claims are refuted:\n" + "\n".join(wrong[:10])
    least = LEAST[name]
    assert shares[0] >= least[0] and shares[2] >= least[1]
