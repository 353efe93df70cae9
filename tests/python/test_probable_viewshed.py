# SPDX-License-Identifier: GPL-3.0-or-later
"""probable_viewshed: what the caller gets and is told. That it holds on terrain whose truth is known is shown here on a small
fractal, and measured on real terrain in docs."""

import json

import numpy as np
import pytest
from osgeo import gdal, osr
from scipy.stats import norm

import sightbound as sb

WEST, NORTH, CELL = 500000.0, 5000000.0, 10.0


def crs(code=32633):
    system = osr.SpatialReference()
    system.ImportFromEPSG(code)
    return system.ExportToWkt()


def fractal(side, exponent, seed):
    """A random terrain whose error grows as distance^exponent, rms slope of samples about 0.2."""
    random = np.random.default_rng(seed)
    fy, fx = np.fft.fftfreq(side)[:, None], np.fft.rfftfreq(side)[None, :]
    f = np.hypot(fy, fx)
    f[0, 0] = 1
    spectrum = np.fft.rfft2(random.standard_normal((side, side))) * f ** -(exponent + 1)
    spectrum[0, 0] = 0
    heights = np.fft.irfft2(spectrum, s=(side, side))
    return (heights * 2 / np.std(np.diff(heights, axis=0)) + 500).astype(np.float32)


def dem_of(heights, cell=CELL, step=-1):
    return sb.Dem(heights, (WEST, cell, 0, NORTH, 0, step * cell), crs())


@pytest.fixture(scope="module")
def dem():
    return dem_of(fractal(64, 0.9, 1))


def place(row, col, cell=CELL):
    return [(WEST + (col + 0.5) * cell, NORTH - (row + 0.5) * cell)]


def test_arrays_and_report(dem):
    found = sb.probable_viewshed(dem, place(30, 30), 10, realisations=128, precision=0)
    assert found.probability.shape == found.verdict.shape == dem.shape
    assert found.probability.min() >= 0 and found.probability.max() == 1 and found.probability[30, 30] == 1
    assert np.allclose(found.standard_error, np.sqrt(found.probability * (1 - found.probability) / 128), atol=1e-6)
    assert set(np.unique(found.verdict)) <= {0, 1, 2}
    assert found.geotransform == dem.geotransform and found.report["realisations"] == 128
    areas = sum(found.report[name] for name in ("visible_m2", "uncertain_m2", "hidden_m2"))
    assert areas == pytest.approx(64 * 64 * CELL * CELL, rel=1e-2)
    assert found.report["expected_visible_m2"] == pytest.approx(found.probability.mean() * areas, rel=1e-3)
    assert "from_dem" in json.loads(found.report["error_model"])["geologic_variation"]
    assert found.report["observers"][0]["eye_height"] == pytest.approx(float(dem.heights[30, 30]) + 10, abs=1e-3)


def test_claims_hold_on_terrain_whose_truth_is_known():
    """Every fourth sample of a fractal; nothing of the truth is used. Half as sure would not do: nor would a boolean viewshed."""
    visible = right = hidden = right_hidden = boolean = right_boolean = 0
    exact = sb.ErrorModel(vertical_rmse=0, geologic_variation=0)
    for seed in range(3):
        fine = fractal(384, 1.0, 10 + seed)
        truth, coarse = dem_of(fine), dem_of(fine[::4, ::4].copy(), 4 * CELL)
        coarse = sb.Dem(fine[::4, ::4].copy(), (WEST - 1.5 * CELL, 4 * CELL, 0, NORTH + 1.5 * CELL, 0, -4 * CELL), crs())
        for row, col in ((48, 48), (20, 70), (75, 15), (10, 10)):
            eye = place(4 * row, 4 * col)
            p = sb.probable_viewshed(coarse, eye, 5, 5, realisations=256).probability
            seen = sb.viewshed(truth, eye, 5, 5, error_model=exact).verdict[::4, ::4] == 2
            told = sb.viewshed(coarse, eye, 5, 5, error_model=exact).verdict == 2
            visible += (p >= 0.975).sum()
            right += seen[p >= 0.975].sum()
            hidden += (p <= 0.025).sum()
            right_hidden += (~seen[p <= 0.025]).sum()
            boolean += told.sum()
            right_boolean += seen[told].sum()
    assert visible > 1000 and hidden > 10000
    assert right / visible >= 0.95 > right_boolean / boolean
    assert right_hidden / hidden >= 0.975


def test_several_observers_any_of_whom_sees(dem):
    one, other = place(10, 12), place(50, 40)
    apart = [sb.probable_viewshed(dem, who, 5, realisations=64).probability for who in (one, other)]
    both = sb.probable_viewshed(dem, one + other, 5, realisations=64, names=["a", "b"])
    assert (both.probability >= np.maximum(*apart)).all() and (both.probability <= apart[0] + apart[1] + 1e-6).all()
    assert [eye["name"] for eye in both.report["observers"]] == ["a", "b"]


def test_row_order_threads_and_seed(dem):
    where = place(30, 30)
    north_up = sb.probable_viewshed(dem, where, 5, realisations=48, threads=1)
    south_up = sb.Dem(dem.heights[::-1].copy(), (WEST, CELL, 0, NORTH - 64 * CELL, 0, CELL), crs())
    flipped = sb.probable_viewshed(south_up, where, 5, realisations=48, threads=2)
    assert np.array_equal(north_up.probability, flipped.probability[::-1])
    assert not np.array_equal(north_up.probability, sb.probable_viewshed(dem, where, 5, realisations=48, seed=2).probability)


def test_measurement_error_makes_less_sure(dem):
    sure = sb.ErrorModel(vertical_rmse=0, geologic_variation=0)
    doubtful = sb.ErrorModel(vertical_rmse=3, geologic_variation=0)
    spread = [
        (lambda p: (p * (1 - p)).mean())(sb.probable_viewshed(dem, place(30, 30), 5, error_model=model, realisations=64).probability)
        for model in (sure, doubtful)
    ]
    assert spread[0] == 0 < spread[1]


@pytest.mark.parametrize("arguments, message", [
    ({"realisations": 0}, "realisations is 0"),
    ({"realisations": 1.5}, "realisations"),
    ({"seed": -1}, "seed is -1"),
    ({"precision": 0.6}, "precision is 0.6"),
    ({"refinement": 2}, "refinement is 2"),
    ({"method": "guess"}, "method is 'guess'"),
    ({"heights": [1, -2]}, "heights has -2"),
    ({"heights": range(16)}, "heights has 16"),
    ({"confidence": 1}, "confidence"),
    ({"max_distance": -1}, "max_distance"),
    ({"threads": 0}, "threads"),
])
def test_wrong_arguments_are_named(dem, arguments, message):
    with pytest.raises(ValueError, match=message):
        sb.probable_viewshed(dem, place(30, 30), **arguments)


def test_cells_are_left_when_they_are_settled(dem):
    """With Wilson's interval, its doubt of 5 % split over the looks as 1 / k^2, no wider than twice the precision; what all
    realisations say lies within it, and the claims are the same but where these are close to the bound."""
    early = sb.probable_viewshed(dem, place(30, 30), 5, realisations=2000)
    whole = sb.probable_viewshed(dem, place(30, 30), 5, realisations=2000, precision=0)
    assert set(np.unique(whole.realisations)) == {2000} and set(np.unique(early.realisations)) <= {192, 384, 768, 1536, 2000}
    assert (early.realisations < 2000).mean() > 0.4
    assert (early.probability == whole.probability)[early.realisations == 2000].all()
    beyond = []
    for k, n in enumerate((192, 384, 768, 1536), start=1):
        left = early.realisations == n
        p, z = early.probability[left], norm.isf(0.025 / k**2 / sum(1 / i**2 for i in range(1, 6)))
        middle, half = (p + z**2 / (2 * n)) / (1 + z**2 / n), z / (1 + z**2 / n) * np.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
        assert half.size and half.max() <= 0.03 + 1e-6
        beyond += list(abs(whole.probability[left] - middle) > half + 1e-6)
    assert np.mean(beyond) < 0.05
    claimed = early.verdict != 1
    assert (early.verdict == whole.verdict)[claimed & (whole.verdict != 1)].all() and claimed.mean() > 0.5
    error = np.sqrt(early.probability * (1 - early.probability) / early.realisations)
    assert np.allclose(early.standard_error, error, atol=1e-6)
    assert early.report["largest_standard_error"] == pytest.approx(early.standard_error.max())


def test_further_heights_are_runs_of_their_own(dem):
    """... on the same terrains, to the byte: and the higher, the more is seen."""
    heights = [10.0, 0.0, 2.5]
    found = sb.probable_viewshed(dem, place(30, 30), 5, 1.7, realisations=400, heights=heights)
    for height in heights:
        alone = sb.probable_viewshed(dem, place(30, 30), 5, height, realisations=400)
        assert np.array_equal(found.probability_at(height), alone.probability)
    plain = sb.probable_viewshed(dem, place(30, 30), 5, 1.7, realisations=400)
    assert np.array_equal(found.probability, plain.probability) and np.array_equal(found.verdict, plain.verdict)
    whole = sb.probable_viewshed(dem, place(30, 30), 5, 1.7, realisations=100, heights=heights, precision=0)
    assert (whole.probability_at(10) >= whole.probability).all() and (whole.probability >= whole.probability_at(0)).all()
    with pytest.raises(ValueError, match="height is 3"):
        found.probability_at(3)


def test_perturbed_terrains_are_the_dem_with_noise(dem):
    """By hand: one doubtful sample between two heads 1.7 m high on a plain hides as often as it stands higher."""
    sigma = np.zeros((21, 41))
    sigma[10, 20] = 2.0
    plain = dem_of(np.zeros((21, 41), np.float32))
    model = sb.ErrorModel(vertical_rmse=sigma, geologic_variation=0)
    found = sb.probable_viewshed(
        plain, place(10, 5), error_model=model, target_height=1.7, curvature=False, method="perturb", realisations=4000, precision=0
    )
    assert found.probability[10, 35] == pytest.approx(0.802, abs=0.025)  # Phi(1.7 / 2)
    assert found.probability[3, 35] == 1
    without = sb.probable_viewshed(dem, place(30, 30), 5, method="perturb", error_model=sb.ErrorModel(0, geologic_variation=0))
    assert set(np.unique(without.probability)) == {0, 1}
    assert any("vertical_rmse" in warning for warning in without.report["warnings"])


def in_a_row(z, eye, target):
    """Does each realisation (a row of `z`: heights one sample apart) see each sample to the right of sample 0, for eye and
    target so high above the ground? Flat Earth."""
    x = np.arange(1, z.shape[1]) * CELL
    slope = (z[:, 1:] - z[:, :1] - eye) / x
    horizon = np.maximum.accumulate(np.column_stack([np.full(len(z), -np.inf), slope[:, :-1]]), axis=1)
    return slope + target / x >= horizon


@pytest.mark.parametrize(("length", "sigma"), [(0.0, 1.0), (30.0, 2.0), (120.0, 5.0)])
def test_correlated_errors_are_drawn_as_such(length, sigma):
    """Against Cholesky's factor of the covariance, along the observer's row: there the line of sight passes over samples alone."""
    cols, eye, target = 24, 1.7, 1.7
    distance = np.abs(np.subtract.outer(np.arange(cols), np.arange(cols))) * CELL
    covariance = np.exp(-distance / length) if length else np.eye(cols)
    noise = np.random.default_rng(1).normal(size=(40000, cols)) @ np.linalg.cholesky(covariance + 1e-12 * np.eye(cols)).T
    expected = in_a_row(sigma * noise, eye, target).mean(axis=0)
    level = sb.Dem(np.zeros((9, cols), np.float32), (500000, CELL, 0, 5000000, 0, -CELL), crs())
    model = sb.ErrorModel(sigma, geologic_variation=0, correlation_length=length)
    found = sb.probable_viewshed(
        level, place(4, 0), eye, target, error_model=model, curvature=False, method="perturb", realisations=4000, precision=0, refinement=0
    ).probability[4, 1:]
    assert np.ptp(expected) > 0.5  # from seen by nearly all to seen by few
    np.testing.assert_allclose(found, expected, atol=0.06 if length else 0.03)


def test_steps_and_levels_of_a_told_model_count():
    """Level ground that hides nothing shows more."""
    flat = sb.Dem(np.zeros((60, 60), np.float32) + np.random.default_rng(2).normal(0, 0.2, (60, 60)).astype(np.float32),
                  (500000, CELL, 0, 5000000, 0, -CELL), crs())
    p = [
        np.nanmean(sb.probable_viewshed(
            flat, place(30, 30), error_model=sb.ErrorModel(geologic_model="growth", level_variance=v, step_variance=1), realisations=256
        ).probability)
        for v in (0.1, 1.0)
    ]
    assert p[0] > p[1] + 0.02


def test_level_ground_that_is_mostly_bare_shows_more():
    """As much variance, in fewer places."""
    flat = sb.Dem(np.random.default_rng(2).normal(0, 0.2, (60, 60)).astype(np.float32), (500000, CELL, 0, 5000000, 0, -CELL), crs())
    p = [
        np.nanmean(sb.probable_viewshed(
            flat, place(30, 30), error_model=sb.ErrorModel(geologic_model="growth", tails="normal", level_tail=q, step_tail=0), realisations=256
        ).probability)
        for q in (1.2, 0.0)
    ]
    assert p[0] > p[1] + 0.02


@pytest.mark.parametrize("holes", [0.0, 0.1, 0.25])
def test_a_cell_does_not_depend_on_which_others_are_asked(holes):
    """To the last bit, holes or not: with a least distance, what lies nearer is only ground."""
    side = 48
    row, col = np.mgrid[:side, :side]
    model = sb.ErrorModel(vertical_rmse=0.3, geologic_variation=1.0)
    for seed in range(3):
        random = np.random.default_rng(seed)
        heights = 0.004 * ((row - 23) ** 2 + (col - 24) ** 2) + random.normal(size=(side, side)) * 0.4
        unknown = random.random((side, side)) < holes
        unknown[20:28, 20:28] = False
        heights[unknown] = np.nan
        bowl = dem_of(heights.astype(np.float32))
        look = dict(error_model=model, realisations=64, precision=0, max_distance=22 * CELL)
        whole = sb.probable_viewshed(bowl, place(23, 24), 1.7, 0.5, **look).probability
        for least in (4 * CELL, 12 * CELL, 16 * CELL):
            found = sb.probable_viewshed(bowl, place(23, 24), 1.7, 0.5, min_distance=least, **look).probability
            asked = np.isfinite(found)
            assert asked.sum() > 100 and np.array_equal(found[asked], whole[asked])


def test_perturbing_takes_any_model(dem):
    """What it does not draw may be said in any way; correlated errors are errors."""
    learnt = sb.ErrorModel.from_json('{"vertical_rmse": 0.5, "geologic_variation": {"from_dem": {"exponent": 1.0, "typical_m": 0.5}}}')
    alike = sb.ErrorModel(0.5, geologic_variation=0, correlation_length=5 * CELL)
    for model in (learnt, alike):
        found = sb.probable_viewshed(dem, place(30, 30), 5, method="perturb", error_model=model, realisations=64)
        assert ((found.probability > 0) & (found.probability < 1)).any()
        assert not any("no measurement error" in warning for warning in found.report["warnings"])


def test_of_means_only_the_measurement_error_is_added(dem):
    means, samples = (sb.ErrorModel(samples_or_means=content, tails="normal") for content in ("means", "samples"))
    of_means, of_samples = (
        sb.probable_viewshed(dem, place(30, 30), 5, method="perturb", error_model=model, realisations=64) for model in (means, samples)
    )
    assert np.array_equal(of_means.probability, of_samples.probability)
    assert set(np.unique(of_means.probability)) == {0, 1}
    assert any("no measurement error" in warning for warning in of_means.report["warnings"])


def test_fine_ground_takes_sight(dem):
    with_it, without = (sb.probable_viewshed(dem, place(30, 30), 1.7, realisations=400, refinement=n) for n in (1, 0))
    assert with_it.probability.mean() < without.probability.mean()


def test_written_rasters_say_how_they_were_made(dem, tmp_path):
    found = sb.probable_viewshed(dem, place(30, 30), 5, realisations=32, seed=7, heights=[0.5, 20])
    paths = [str(tmp_path / name) for name in ("p.tif", "e.tif", "v.tif")]
    found.write(*paths, at_heights=tmp_path / "h.tif")
    bands = gdal.Open(str(tmp_path / "h.tif"))
    assert np.array_equal(bands.ReadAsArray(), [found.probability_at(0.5), found.probability_at(20)])
    assert bands.GetRasterBand(2).GetDescription() == "probability that a target 20 m above ground is seen"
    for path, values in zip(paths, (found.probability, found.standard_error, found.verdict)):
        dataset = gdal.Open(path)
        assert np.array_equal(dataset.ReadAsArray(), values)
        assert dataset.GetMetadataItem("SIGHTBOUND_REALISATIONS") == "32" and dataset.GetMetadataItem("SIGHTBOUND_SEED") == "7"
    with pytest.raises(ValueError, match="nothing to write"):
        found.write()
    with pytest.raises(ValueError, match="no heights were given"):
        sb.probable_viewshed(dem, place(30, 30), realisations=1).write(at_heights=tmp_path / "n.tif")


def test_it_can_be_cancelled(dem):
    with pytest.raises(sb.Cancelled):
        sb.probable_viewshed(dem, place(30, 30), progress=lambda fraction: False)


@pytest.mark.parametrize(("row", "col"), [(30.7, 30.3), (30.3, 30.1)])
def test_an_eye_beside_a_hole_sees_the_rest(row, col):
    """Of the four nodes around it those count that are known."""
    heights = (np.random.default_rng(1).normal(size=(64, 64)) * 0.05 + 100).astype(np.float32)
    heights[30, 31] = np.nan
    found = sb.probable_viewshed(dem_of(heights), place(row, col), 20, 20, realisations=192)
    assert found.verdict[40, 5] == 2 and np.nanmean(found.probability) > 0.6
