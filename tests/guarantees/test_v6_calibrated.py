# SPDX-License-Identifier: GPL-3.0-or-later
"""V6: what the probable viewshed claims of terrain that nobody tuned it for is true at least as often as it says, and its
probabilities are those of the truth. Truths are self-affine surfaces; of each every fourth sample (or means over 4 x 4) is
given away, the error model is learnt from these alone, and the truth is judged here by walking along straight lines over
bilinear ground. docs/calibration.md holds the record on real terrain."""

import numpy as np
import pytest
import terrains

import sightbound as sb

FACTOR, SIDE, CELL = 4, 384, 10.0
HEIGHT = 1.7
EYES = [  # coarse rows and columns
    (20.3, 18.6), (61.7, 30.2), (40.5, 66.4), (77.2, 75.8), (15.4, 80.1), (50.8, 48.3),
    (30.6, 40.7), (70.1, 12.4), (12.8, 52.9), (84.3, 50.5), (56.2, 82.6), (34.9, 9.8)]


def bilinear(z, row, col):
    r, c = np.clip(row.astype(int), 0, z.shape[0] - 2), np.clip(col.astype(int), 0, z.shape[1] - 2)
    v, u = row - r, col - c
    return (z[r, c] * (1 - v) + z[r + 1, c] * v) * (1 - u) + (z[r, c + 1] * (1 - v) + z[r + 1, c + 1] * v) * u


def truly_seen(z, eye, rows, cols):
    """Which of the targets at rows x cols (samples of z) an eye over place `eye` sees, looking at two places a sample."""
    target_r, target_c = (grid.ravel().astype(float) for grid in np.meshgrid(rows, cols, indexing="ij"))
    eye = np.array(eye, float)
    eye_height = bilinear(z, eye[:1], eye[1:])[0] + HEIGHT
    target_height = bilinear(z, target_r, target_c) + HEIGHT
    steps = 2 * SIDE
    clear = np.ones(target_r.size, bool)
    for i in range(1, steps):
        t = i / steps
        ground = bilinear(z, eye[0] + t * (target_r - eye[0]), eye[1] + t * (target_c - eye[1]))
        clear &= ground <= eye_height + t * (target_height - eye_height)
    return clear.reshape(len(rows), len(cols))


@pytest.fixture(scope="module", params=[("samples", 0.6, 40.0), ("samples", 1.0, 400.0), ("means", 1.0, 400.0)], ids=str)
def record(request):
    """Probabilities claimed, ordinary answers and truth, a row an observer."""
    cells, exponent, relief = request.param
    z = terrains.fractal((SIDE, SIDE), 611, relief, roughness=exponent + 1).astype(float)
    if cells == "means":
        heights = z.reshape(SIDE // FACTOR, FACTOR, SIDE // FACTOR, FACTOR).mean(axis=(1, 3))
        first, offset = FACTOR // 2, (FACTOR - 1) / 2
    else:
        heights, first, offset = z[::FACTOR, ::FACTOR], 0, 0.0
    step = FACTOR * CELL
    dem = sb.Dem(np.ascontiguousarray(heights, np.float32), (500000.0, step, 0, 5000000.0, 0, -step), "EPSG:32633")
    model = sb.estimate_error(dem, samples_or_means=cells)
    at = first + FACTOR * np.arange(SIDE // FACTOR)
    claimed, ordinary, seen = [], [], []
    for row, col in EYES:
        place = [(500000.0 + (col + 0.5) * step, 5000000.0 - (row + 0.5) * step)]
        view = {"observer_height": HEIGHT, "target_height": HEIGHT, "curvature": False, "refraction": 0.0}
        claimed.append(sb.probable_viewshed(dem, place, error_model=model, realisations=512, **view).probability)
        exact = sb.ErrorModel(vertical_rmse=0, geologic_variation=0)
        ordinary.append(sb.viewshed(dem, place, error_model=exact, **view).confidence > 0.5)
        seen.append(truly_seen(z, (offset + FACTOR * row, offset + FACTOR * col), at, at))
    return [np.array(rows).reshape(len(EYES), -1) for rows in (claimed, ordinary, seen)]


def share(which, true):
    """Of the cells that are `which`, the share that is true, and its standard error clustered by observer."""
    counts, hits = which.sum(axis=1), (which & true).sum(axis=1)
    mean = hits.sum() / counts.sum()
    n = len(counts)
    return mean, np.sqrt(n / (n - 1) * ((hits - mean * counts) ** 2).sum()) / counts.sum()


@pytest.mark.parametrize("level", [0.90, 0.95, 0.99])
def test_claims_hold(record, level):
    claimed, _, seen = record
    visible, error = share(claimed >= (1 + level) / 2, seen)
    assert visible >= level - 2 * min(error, 0.01)
    hidden, error = share(claimed <= (1 - level) / 2, ~seen)
    assert hidden >= level - 2 * min(error, 0.01)


def test_probabilities_are_those_of_the_truth(record):
    claimed, _, seen = record
    for low, high in ((0.1, 0.35), (0.35, 0.65), (0.65, 0.9)):
        which = (claimed >= low) & (claimed < high)
        found, error = share(which, seen)
        assert abs(found - claimed[which].mean()) <= 0.1 + 2 * min(error, 0.05), (low, high)


def test_knows_more_than_an_ordinary_viewshed(record):
    claimed, ordinary, seen = record
    assert ((claimed - seen) ** 2).mean() < 0.7 * ((ordinary ^ seen)).mean()
    right, _ = share(ordinary, seen)
    claims, _ = share(claimed >= 0.975, seen)
    assert claims > right
