# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that hold whatever the terrain: the same ground gives the same answer however it is stored, and more height,
more observers or more limits move the answer the one way they should."""
import numpy as np
import sightbound as sb
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

settings.register_profile("sightbound", max_examples=25, deadline=None, derandomize=True,
                          suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
settings.load_profile("sightbound")

X, Y, CELL = 500.0, 900.0, 10.0
heights = st.tuples(st.integers(3, 9), st.integers(3, 9)).flatmap(
    lambda shape: arrays(np.float32, shape, elements=st.integers(0, 40).map(float)))
models = st.builds(lambda v, h, d, r: sb.ErrorModel(vertical_rmse=v, horizontal_rmse=h, geologic_variation=d, geologic_range=r),
                   st.sampled_from([0.0, 0.5, 3.0]), st.sampled_from([0.0, 0.7]), st.sampled_from([0.0, 2.0]), st.sampled_from([4.0, 9.0]))
eyes = st.tuples(st.floats(0, 1), st.floats(0, 1), st.sampled_from([0.5, 2.0, 15.0]))
NEAR = dict(rtol=0, atol=2e-5)


def north_up(z):
    return X, CELL, 0.0, Y, 0.0, -CELL


def eye_xy(z, eye, on_sample=False):
    col, row = eye[0] * (z.shape[1] - 1), eye[1] * (z.shape[0] - 1)
    if on_sample:
        col, row = round(col), round(row)
    return X + CELL * (col + 0.5), Y - CELL * (row + 0.5)


def look(z, gt, eye, xy, model, **how):
    return sb.viewshed(sb.Dem(np.ascontiguousarray(z), gt), [xy], observer_height=eye[2], error_model=model, **how)


def agree(a, b):
    """Same p; same verdict but where p stands on the border between two."""
    np.testing.assert_allclose(a.confidence, b.confidence, **NEAR)
    border = np.minimum(abs(a.confidence - 0.975), abs(a.confidence - 0.025)) < 2e-5
    assert np.all((a.verdict == b.verdict) | border)


class Turned:
    """A result's arrays turned back into the order of the north-up raster."""

    def __init__(self, result, turn):
        self.confidence, self.verdict = turn(result.confidence), turn(result.verdict)


@given(heights, models, eyes)
def test_a_south_up_file_gives_the_same_bytes(z, model, eye):
    xy = eye_xy(z, eye)
    a = look(z, north_up(z), eye, xy, model)
    b = look(z[::-1], (X, CELL, 0.0, Y - CELL * len(z), 0.0, CELL), eye, xy, model)
    assert a.confidence.tobytes() == np.ascontiguousarray(b.confidence[::-1]).tobytes()
    assert a.verdict.tobytes() == np.ascontiguousarray(b.verdict[::-1]).tobytes()


@given(heights, models, eyes)
def test_however_the_file_is_turned(z, model, eye):
    xy = eye_xy(z, eye)
    rows, cols = z.shape
    a = look(z, north_up(z), eye, xy, model)
    east, south = X + CELL * cols, Y - CELL * rows
    transposed = look(z.T, (X, 0.0, CELL, Y, -CELL, 0.0), eye, xy, model)
    agree(a, Turned(transposed, lambda v: v.T))
    both = look(z[::-1, ::-1], (east, -CELL, 0.0, south, 0.0, CELL), eye, xy, model)
    agree(a, Turned(both, lambda v: v[::-1, ::-1]))
    mirrored = look(z[:, ::-1], (east, -CELL, 0.0, Y, 0.0, -CELL), eye, xy, model)
    agree(a, Turned(mirrored, lambda v: v[:, ::-1]))
    quarter = look(np.rot90(z), (east, 0.0, -CELL, Y, -CELL, 0.0), eye, xy, model)
    agree(a, Turned(quarter, lambda v: np.rot90(v, -1)))


@given(heights, models, eyes)
def test_ground_turned_by_half_a_turn(z, model, eye):
    """The diagonals of the TIN map onto themselves."""
    xy = eye_xy(z, eye)
    turned_xy = 2 * X + CELL * z.shape[1] - xy[0], 2 * Y - CELL * z.shape[0] - xy[1]
    a, b = look(z, north_up(z), eye, xy, model), look(z[::-1, ::-1], north_up(z), eye, turned_xy, model)
    agree(a, Turned(b, lambda v: v[::-1, ::-1]))


@given(heights, models, eyes, st.integers(-50000, 50000), st.integers(-50000, 50000))
def test_translation(z, model, eye, dx, dy):
    xy = eye_xy(z, eye)
    b = look(z, (X + dx, CELL, 0.0, Y + dy, 0.0, -CELL), eye, (xy[0] + dx, xy[1] + dy), model)
    agree(look(z, north_up(z), eye, xy, model), b)


@given(heights, models, eyes, st.integers(-400, 4000))
def test_adding_a_height_changes_nothing(z, model, eye, lift):
    xy = eye_xy(z, eye)
    agree(look(z, north_up(z), eye, xy, model), look(z + np.float32(lift), north_up(z), eye, xy, model))


@given(heights, models, eyes, st.sampled_from(["model", "ground"]))
def test_higher_targets_and_eyes_are_seen_better(z, model, eye, stand):
    xy = eye_xy(z, eye)
    low = look(z, north_up(z), eye, xy, model, stand=stand).confidence
    assert np.all(look(z, north_up(z), eye, xy, model, stand=stand, target_height=1.5).confidence >= low - 1e-6)
    assert np.all(look(z, north_up(z), (*eye[:2], eye[2] + 1.5), xy, model, stand=stand).confidence >= low - 1e-6)


@given(heights, eyes, st.floats(0, 1), st.floats(0, 1), st.sampled_from([0.0, 1.0]))
def test_raising_the_ground_hides(z, eye, col, row, sigma):
    """Without sigma_h, raising one sample can only take sight away, but from those who stand on it."""
    model = sb.ErrorModel(vertical_rmse=sigma, geologic_variation=0)
    xy = eye_xy(z, eye, on_sample=True)
    r, c = round(row * (z.shape[0] - 1)), round(col * (z.shape[1] - 1))
    if (round(eye[1] * (z.shape[0] - 1)), round(eye[0] * (z.shape[1] - 1))) == (r, c):
        return
    raised = z.copy()
    raised[r, c] += 7
    before, after = (look(v, north_up(z), eye, xy, model).confidence.copy() for v in (z, raised))
    before[r, c] = after[r, c] = 0
    assert np.all(after <= before + 1e-6)


@given(heights, models, st.lists(eyes, min_size=2, max_size=4))
def test_observers_combine(z, model, several):
    dem = sb.Dem(z, north_up(z))
    places = [eye_xy(z, eye) for eye in several]
    options = dict(error_model=model, observer_height=[eye[2] for eye in several])
    alone = [sb.viewshed(dem, [p], error_model=model, observer_height=eye[2]) for p, eye in zip(places, several)]
    best, worst = (sb.viewshed(dem, places, combine=c, **options) for c in ("best", "worst"))
    p, v = np.stack([a.confidence for a in alone]), np.stack([a.verdict for a in alone])
    assert np.array_equal(best.confidence, p.max(0)) and np.array_equal(worst.confidence, p.min(0))
    assert np.array_equal(best.verdict, v.max(0)) and np.array_equal(worst.verdict, v.min(0))
    assert np.array_equal(best.count, (v == 2).sum(0)) and np.array_equal(worst.count, best.count)


@given(heights, models, eyes, st.sampled_from([0.5, 0.9, 0.99]))
def test_the_areas_are_those_of_the_verdicts(z, model, eye, confidence):
    result = look(z, north_up(z), eye, eye_xy(z, eye), model, confidence=confidence)
    for verdict, name in ((2, "visible"), (1, "uncertain"), (0, "hidden")):
        area = np.sum(result.verdict == verdict) * CELL ** 2
        assert np.isclose(result.report[f"{name}_m2"], area) and np.isclose(result.report["observers"][0][f"{name}_m2"], area)
