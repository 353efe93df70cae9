# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole line's probability: against a simulation written here, its bound, and a radio link's Fresnel zone."""

from statistics import NormalDist

import numpy as np
import pytest

import sightbound as sb
import terrains

GT = (0.0, 10.0, 0.0, 300.0, 0.0, -10.0)
SIDE, REALISATIONS = 30, 20000
EXACT = sb.ErrorModel(0, 0, 0)


def at(row, col):
    return 10 * (col + 0.5), 300 - 10 * (row + 0.5)


def lines(dem, ends, **how):
    eyes, targets = zip(*ends)
    how = {"curvature": False, "probability": True, **how}
    return sb.lines_of_sight(dem, [at(*eye) for eye in eyes], [at(*one) for one in targets], **how)


def rough(seed, relief=10.0):
    return terrains.fractal((SIDE, SIDE), seed, relief, roughness=1.5)


def some_ends(count, seed):
    random = np.random.default_rng(seed)
    ends = []
    while len(ends) < count:
        a, b = random.uniform(3, SIDE - 4, (2, 2))
        if np.hypot(*(b - a)) > 5:
            ends.append((tuple(a), tuple(b)))
    return ends


def tin(nodes, row, col, scale):
    """Heights between samples split along NW-SE diagonals; `scale` nodes to a cell. Nodes: [..., rows, cols]."""
    r, c = row * scale, col * scale
    i, j = np.minimum(r.astype(int), nodes.shape[-2] - 2), np.minimum(c.astype(int), nodes.shape[-1] - 2)
    u, v = r - i, c - j
    corner = np.where(u >= v, nodes[..., i + 1, j], nodes[..., i, j + 1])
    low, high = np.minimum(u, v), np.maximum(u, v)
    return (1 - high) * nodes[..., i, j] + (high - low) * corner + low * nodes[..., i + 1, j + 1]


def simulated(nodes, scale, ends, heights, z=None):
    """Share of the realisations [n, rows, cols] in which the line is clear; both ends on the ground of each, or of `z`."""
    (r0, c0), (r1, c1) = ends
    t = np.linspace(0, 1, 1501)[1:-1]
    ground = tin(nodes, r0 + t * (r1 - r0), c0 + t * (c1 - c0), scale)
    a = tin(nodes, np.array([r0]), np.array([c0]), scale) + heights[0]
    b = tin(nodes, np.array([r1]), np.array([c1]), scale) + heights[1]
    return np.mean(np.all(a + t * (b - a) >= ground, axis=1))


def drawn_samples(z, sigma, n, random):
    """What measurements leave open: a height and the mean of its neighbours as two witnesses."""
    around = (np.roll(z, 1, 0) + np.roll(z, -1, 0) + np.roll(z, 1, 1) + np.roll(z, -1, 1)) / 4
    s2, q2 = sigma**2, sigma**2 / 4
    mean, spread = z + (around - z) * s2 / (s2 + q2), np.sqrt(s2 * q2 / (s2 + q2))
    return mean + spread * random.standard_normal((n, *z.shape))


def drawn_nodes(z, spread, n, random):
    """The samples as they are, and half-way between two of them the mean of both and a normal departure."""
    nodes = np.zeros((n, 2 * SIDE - 1, 2 * SIDE - 1))
    nodes[:, ::2, ::2] = z
    nodes[:, ::2, 1::2] = (z[:, :-1] + z[:, 1:]) / 2
    nodes[:, 1::2, ::2] = (z[:-1] + z[1:]) / 2
    nodes[:, 1::2, 1::2] = (z[:-1, :-1] + z[1:, 1:]) / 2
    noise = spread * random.standard_normal(nodes.shape)
    noise[:, ::2, ::2] = 0
    return nodes + noise


def assert_near(found, expected, n):
    error = np.sqrt(np.maximum(expected * (1 - expected), 1e-4) * (1 / n + 1 / REALISATIONS))
    assert np.all(np.abs(found - expected) < 4 * error), (found, expected)


def test_measurement_error_against_a_simulation():
    z, n = rough(301), 4000
    ends = some_ends(20, 302)
    nodes = drawn_samples(z, 1.0, n, np.random.default_rng(303))
    expected = np.array([simulated(nodes, 1, one, (2.0, 1.0)) for one in ends])
    found = lines(sb.Dem(z, GT), ends, observer_height=2.0, target_height=1.0, error_model=sb.ErrorModel(1.0, 0, 0), realisations=REALISATIONS)
    assert ((expected > 0.02) & (expected < 0.98)).sum() >= 5
    assert_near(np.array([line.probability for line in found]), expected, n)


def test_error_between_samples_against_a_simulation():
    """All of it half a cell from a sample, nothing nearer: what fine ground adds near the ends is 0."""
    z, n = rough(311), 4000
    ends = some_ends(12, 312)
    nodes = drawn_nodes(z.astype(float), 0.8, n, np.random.default_rng(313))
    expected = np.array([simulated(nodes, 2, one, (2.0, 2.0)) for one in ends])
    model = sb.ErrorModel(0, 0, 0.8 * 1.959964, geologic_range=4.5, geologic_model="step")
    found = lines(sb.Dem(z, GT), ends, observer_height=2.0, target_height=2.0, error_model=model, realisations=REALISATIONS)
    assert ((expected > 0.02) & (expected < 0.98)).sum() >= 5
    assert_near(np.array([line.probability for line in found]), expected, n)


def test_without_error_it_is_the_line_itself():
    z = rough(321, 8.0)
    for stand in ("ground", "model"):
        found = lines(sb.Dem(z, GT), some_ends(80, 322), observer_height=2.0, error_model=EXACT, realisations=16, probability_stand=stand)
        clear = np.array([line.probability for line in found])
        assert set(np.unique(clear)) == {0, 1}
        assert np.array_equal(clear, [line.k > 0 for line in found])
        assert np.array_equal(1 - clear, [line.whole_line.blocked_bound for line in found])


@pytest.mark.parametrize("model", [sb.ErrorModel(1.5, 0, 0), sb.ErrorModel(0.3, 0, 2.0, 5.0), None])
def test_both_ways_alike(model):
    dem, ends = sb.Dem(rough(331), GT), some_ends(40, 332) + [((5, 5), (5, 20)), ((4, 6), (20, 6)), ((5, 5), (21, 21)), ((20, 4), (4, 20))]
    how = dict(observer_height=2.0, target_height=2.0, error_model=model, realisations=256)
    there = lines(dem, ends, **how)
    back = lines(dem, [(b, a) for a, b in ends], **how)
    assert [line.probability for line in there] == [line.probability for line in back]
    bounds = np.array([(one.whole_line.blocked_bound, other.whole_line.blocked_bound) for one, other in zip(there, back)])
    blocked = 1 - np.array([line.probability for line in there])
    assert len(set(blocked)) > 10
    if model is None:  # learnt: the tails need not be normal, and then no bound is known
        assert np.isnan(bounds).all() or np.isfinite(bounds).all()
        return
    assert (bounds.min(axis=1) >= blocked - 4 * np.sqrt(blocked * (1 - blocked) / 256) - 1 / 256).all()


def test_what_is_told_of_it():
    some = lines(sb.Dem(rough(341), GT), some_ends(20, 342), observer_height=2.0, target_height=2.0, error_model=sb.ErrorModel(2.0, 0, 0), realisations=300, seed=7)
    line = min(some, key=lambda one: abs(one.probability - 0.5))
    found = line.whole_line
    assert (found.realisations, found.seed) == (300, 7) and line.probability == found.probability
    p = found.probability
    assert 0 < p < 1 and found.standard_error == pytest.approx(np.sqrt(p * (1 - p) / 300))
    assert found.interval[0] < p < found.interval[1] and found.interval[1] - found.interval[0] == pytest.approx(4 * found.standard_error, rel=0.1)
    places = found.places
    most = int(np.argmax(places["blocked"]))
    assert np.all(np.diff(places["distance"]) >= 0) and 0 < places["distance"][0] and places["distance"][-1] < line.distance
    assert found.blocked_share == places["blocked"][most] <= 1 - p <= places["blocked"].sum()
    assert found.blocked_at == (places["x"][most], places["y"][most]) and found.blocked_distance == places["distance"][most]
    plain = lines(sb.Dem(rough(341), GT), some_ends(1, 342), probability=False)[0]
    assert plain.whole_line is None and plain.probability is None and plain.fresnel is None


def test_seeds_draw_other_terrain_and_many_are_one_by_one():
    dem, ends = sb.Dem(rough(351), GT), some_ends(15, 352)
    how = dict(observer_height=3.0, target_height=2.0, error_model=sb.ErrorModel(1.5, 0, 0), realisations=200)
    many = [line.whole_line for line in lines(dem, ends, **how)]
    for one, together in zip(ends, many):
        alone = lines(dem, [one], **how)[0].whole_line
        np.testing.assert_equal(alone[:9], together[:9])
    other = [line.probability for line in lines(dem, ends, seed=2, **how)]
    assert other != [one.probability for one in many]


def test_along_rays_it_is_the_probable_viewshed():
    """Along rows, columns and diagonals rays and lines are the same; lines look finer at the target's end too."""
    z = rough(361)
    dem, model = sb.Dem(z, GT), sb.ErrorModel(0.4, 0, 1.0, 5.0)
    how = dict(observer_height=2.0, target_height=1.0, error_model=model, curvature=False, realisations=2000)
    seen = sb.probable_viewshed(dem, [at(14, 14)], **how).probability
    cells = [(14 + d * i, 14 + d * j) for i, j in ((0, 1), (1, 0), (1, 1), (1, -1)) for d in range(-12, 13) if abs(d) > 1]
    found = np.array([line.probability for line in lines(dem, [((14, 14), cell) for cell in cells], **how)])
    view = np.array([seen[cell] for cell in cells])
    assert ((view > 0.05) & (view < 0.95)).sum() > 10
    assert np.abs(found - view).mean() < 0.01 and np.abs(found - view).max() < 0.06


def test_unknown_ground():
    z = rough(371)
    z[:, 15] = np.nan
    dem, how = sb.Dem(z, GT), dict(observer_height=90.0, target_height=90.0, error_model=sb.ErrorModel(0.5, 0, 0), realisations=64)
    blocked, across = (lines(dem, [((14, 4), (16, 27))], see_across_nodata=see, **how)[0] for see in (False, True))
    assert 0.25 < blocked.probability < 0.75 and blocked.whole_line.verdict == 1 and blocked.whole_line.blocked_bound == pytest.approx(0.5)
    assert 14 <= blocked.whole_line.blocked_at[0] / 10 - 0.5 <= 16
    low = lines(dem, [((14, 4), (16, 27))], **{**how, "observer_height": -50.0})[0]
    assert low.probability == 0 and low.whole_line.blocked_bound == 1
    assert across.probability == 1 and across.whole_line.blocked_bound < 1e-9


def test_the_bound_holds_and_says_something():
    dem, ends = sb.Dem(rough(381), GT), some_ends(150, 382)
    for model in (sb.ErrorModel(1.0, 0, 0), sb.ErrorModel(0.5, 0, 2.0, 5.0)):
        for stand in ("ground", "model"):
            found = lines(dem, ends, observer_height=3.0, target_height=3.0, error_model=model, realisations=4000, probability_stand=stand)
            blocked = 1 - np.array([line.probability for line in found])
            bound = np.array([line.whole_line.blocked_bound for line in found])
            error = np.sqrt(np.maximum(blocked * (1 - blocked), bound * (1 - np.minimum(bound, 1))) / 4000)
            assert np.all(blocked <= bound + 4 * error + 1e-12)
            doubtful = (blocked > 0.01) & (blocked < 0.2)
            assert doubtful.sum() >= 5 and np.median(bound[doubtful] / blocked[doubtful]) < 1.5
            sure = np.array([line.k > 2 for line in found])
            assert sure.sum() > 20 and np.median(bound[sure]) < 0.05


def test_fresnel_zone():
    """A plain with one sample that rises to 5 m below the line, half-way along 200 m."""
    z = np.zeros((SIDE, SIDE), np.float32)
    z[15, 15] = 15
    dem = sb.Dem(z, GT)
    how = dict(observer_height=20.0, target_height=20.0, error_model=sb.ErrorModel(1.0, 0, 0), stand="model", realisations=4000)
    line = lines(dem, [((15, 5), (15, 25))], frequency=1000.0, **how)[0]
    radius = np.sqrt(0.299792458 * 100 * 100 / 200)
    zone = line.fresnel
    assert zone.middle_radius == pytest.approx(radius) and zone.worst_radius == pytest.approx(radius)
    assert zone.worst == pytest.approx(at(15, 15)) and zone.worst_distance == pytest.approx(100)
    assert zone.clear == pytest.approx(5 / radius) and zone.k == pytest.approx(5 - 0.6 * radius)
    assert line.k == 3.29 and zone.p == pytest.approx(NormalDist().cdf(zone.k), abs=1e-6) and zone.verdict == 2
    np.testing.assert_allclose(line.profile["fresnel"], np.sqrt(0.299792458 * line.profile["distance"] * (200 - line.profile["distance"]) / 200))
    assert line.whole_line.fresnel_probability <= line.probability
    without = lines(dem, [((15, 5), (15, 25))], **how)[0]
    assert np.isnan(without.whole_line.fresnel_probability) and "fresnel" not in without.profile
    assert without.probability == line.probability
    none = lines(dem, [((15, 5), (15, 25))], frequency=1000.0, fresnel_share=0, **how)[0]
    assert none.whole_line.fresnel_probability == none.probability and none.fresnel.p == none.p


def test_fresnel_probability_is_that_of_a_lower_line():
    """Over a plain the lowest place of a zone is half-way: clear where its ground is low enough."""
    z = np.zeros((SIDE, SIDE), np.float32)
    sigma = np.zeros_like(z)
    sigma[15, 15] = 1.0
    model = sb.ErrorModel(sigma, 0, 0)
    radius = np.sqrt(0.299792458 * 100 * 100 / 200)
    line = lines(sb.Dem(z, GT), [((15, 5), (15, 25))], observer_height=2.5, target_height=2.5, error_model=model, frequency=1000.0, fresnel_share=0.5, realisations=REALISATIONS)[0]
    # The posterior's share of a sigma of 1 beside exact neighbours on a plain: q = 1 / 2.
    spread = np.sqrt(0.25 / 1.25)
    expected = NormalDist().cdf((2.5 - 0.5 * radius) / spread)
    assert line.whole_line.fresnel_probability == pytest.approx(expected, abs=4 * np.sqrt(expected * (1 - expected) / REALISATIONS))
    assert line.probability > 0.9999 - 1e-3


@pytest.mark.parametrize("arguments, message", [
    ({"frequency": 0}, "frequency is 0"),
    ({"frequency": -5}, "frequency is -5"),
    ({"frequency": "high"}, "frequency"),
    ({"frequency": 100, "fresnel_share": 1.5}, "fresnel_share is 1.5"),
    ({"probability": True, "realisations": 0}, "realisations is 0"),
    ({"probability": True, "seed": -1}, "seed is -1"),
    ({"probability": True, "probability_stand": "sky"}, "sky"),
])
def test_wrong_arguments_are_named(arguments, message):
    with pytest.raises(ValueError, match=message):
        sb.line_of_sight(sb.Dem(rough(391), GT), at(5, 5), at(20, 20), error_model=EXACT, **arguments)


@pytest.mark.parametrize("ends", [((3, 5), (12, 22)), ((3, 5.25), (12, 22.25)), ((3.2, 5.1), (12.2, 22.1))], ids=["samples", "sides", "inside"])
def test_four_times_the_variance_is_twice_the_error(ends):
    """Levels and steps count once at each stage, wherever the ends lie."""
    heads = 1.25
    dem = sb.Dem(rough(3, 4.0), GT)
    learnt = '{"vertical_rmse": 0, "geologic_model": "growth", "geologic_variation": {"from_dem": {"exponent": 1.0, "typical_m": 0.5, "scale": %g}}%s}'
    twice, quadruple = learnt % (2, ""), learnt % (1, ', "level_variance": 4, "step_variance": 4')
    found = [
        lines(dem, [ends], observer_height=heads, target_height=heads, error_model=sb.ErrorModel.from_json(model), realisations=4096)[0].whole_line.probability
        for model in (twice, quadruple)
    ]
    assert 0.02 < found[0] < 0.98 and found[0] == found[1]
