# SPDX-License-Identifier: GPL-3.0-or-later
"""Tails, shared bias and products: that every engine follows them, and that nothing else does."""
import json

import numpy as np
import pytest
import rasters
import sightbound as sb
import terrains
from sight_oracle import DENSITIES, cdf, certain_k, z_two_sided
from sightbound._loading import core

UTM, UTM_GT = rasters.wkt_of("EPSG:32633"), (612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0)
Z = np.round(terrains.fractal((40, 50), 181, 80.0), 1)
EYE = (612595.0, 5537915.0)
SIGMA = dict(vertical_rmse=0.5, geologic_variation=0)
TAILS = ["normal", "laplace", "student"]


@pytest.fixture
def dem():
    return sb.Dem(Z, UTM_GT, UTM)


# ---- tails -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("tails", TAILS)
def test_quantiles_and_distribution_are_those_of_the_density(tails):
    for c in (0.2, 0.5, 0.9, 0.95, 0.99, 0.999):
        z = sb.two_sided_quantile(c, tails)
        assert z == pytest.approx(z_two_sided(c, tails), rel=1e-9)
        assert core.tails_cdf(z, tails) == pytest.approx((1 + c) / 2, abs=1e-14)
        assert core.tails_cdf(-z, tails) == pytest.approx(cdf(-z, tails), abs=1e-9)


@pytest.mark.parametrize("tails", DENSITIES)
def test_tails_have_unit_variance(tails):
    nodes, weights = np.polynomial.legendre.leggauss(400)
    k, step = np.tan((nodes + 1) * np.pi / 4), weights * np.pi / 4
    moments = [np.sum(step * 2 * DENSITIES[tails](k) * k**n * (1 + k * k)) for n in (0, 2)]
    assert moments == pytest.approx([1, 1], abs=1e-6)
    assert sb.two_sided_quantile(0.99, "student") == pytest.approx(3.1233, abs=1e-4)  # of real ground about 3.1


def test_normal_is_the_default(dem):
    """To the last bit, and in the text of the model too."""
    assert sb.ErrorModel(**SIGMA).to_json() == sb.ErrorModel(**SIGMA, tails=None).to_json()
    unset, normal = (sb.viewshed(dem, [EYE], error_model=sb.ErrorModel(**SIGMA, tails=t)) for t in (None, "normal"))
    assert np.array_equal(unset.confidence, normal.confidence, equal_nan=True)
    assert sb.two_sided_quantile(0.95) == sb.two_sided_quantile(0.95, "normal") == pytest.approx(1.959963984540054, abs=1e-15)
    for wrong in ("cauchy", "Normal"):
        with pytest.raises(ValueError, match="tails is"):
            sb.two_sided_quantile(0.95, wrong)
    with pytest.raises(ValueError, match="confidence"):
        sb.two_sided_quantile(95)


@pytest.mark.parametrize("tails", ["laplace", "student"])
def test_the_same_ratio_under_other_tails(dem, tails):
    """k is the terrain's; only what it is worth changes. p of the two engines, the line's, and of normal tails agree through k."""
    model = sb.ErrorModel(**SIGMA, tails=tails)
    p = sb.viewshed(dem, [EYE], error_model=model).confidence
    plain = sb.viewshed(dem, [EYE], error_model=sb.ErrorModel(**SIGMA)).confidence
    most = certain_k(tails) * (1 - 1e-9)  # beyond, k is no longer told
    for row, col in [(r, c) for r in range(3, 40, 6) for c in range(2, 50, 6)]:
        target = (UTM_GT[0] + 10 * (col + 0.5), UTM_GT[3] - 10 * (row + 0.5))
        sight = sb.line_of_sight(dem, EYE, target, error_model=model)
        expected = 1.0 if sight.k >= most else 0.0 if sight.k <= -most else cdf(sight.k, tails)
        assert sight.p == pytest.approx(expected, abs=1e-6)
        assert p[row, col] == pytest.approx(sight.p, abs=0.005)
    settled = (plain > 0) & (plain < 1)
    assert settled.any() and np.array_equal(p[settled] > 0.5, plain[settled] > 0.5)


@pytest.mark.parametrize("tails", TAILS)
def test_error_surfaces_are_wide_by_the_tails(dem, tails):
    surfaces = sb.error_surfaces(dem, sb.ErrorModel(**SIGMA, tails=tails), confidence=0.99)
    np.testing.assert_allclose(surfaces.upper - Z, z_two_sided(0.99, tails) * 0.5, rtol=1e-4)
    np.testing.assert_allclose(Z - surfaces.lower, z_two_sided(0.99, tails) * 0.5, rtol=1e-4)


@pytest.mark.parametrize("tails", ["laplace", "student"])
def test_simplifying_goes_as_far_as_the_tails(dem, tails):
    by_model = sb.dem_to_tin(dem, error_model=sb.ErrorModel(**SIGMA, tails=tails), confidence=0.99)
    by_metres = sb.dem_to_tin(dem, tolerance=float(z_two_sided(0.99, tails)) * 0.5)
    assert by_model.report["largest_tolerance"] == pytest.approx(by_metres.report["largest_tolerance"], rel=1e-6)
    normal = sb.dem_to_tin(dem, error_model=sb.ErrorModel(**SIGMA), confidence=0.99)
    assert by_model.report["faces_after"] < normal.report["faces_after"]
    tin = sb.dem_to_tin(dem, tolerance=0.01)
    report = sb.simplify(tin, error_model=sb.ErrorModel(**SIGMA, horizontal_rmse=0.2, tails=tails), confidence=0.99).report
    # On slopes sigma_h adds to sigma; the outline may move by z times sigma_h.
    assert report["least_tolerance"] > 0.99 * z_two_sided(0.99, tails) * 0.5
    assert report["border_tolerance"] == pytest.approx(z_two_sided(0.99, tails) * 0.2, rel=1e-9)


@pytest.mark.parametrize("tails", TAILS)
def test_a_saved_volume_keeps_its_tails(dem, tails, tmp_path):
    volume = sb.ErrorVolume.build(dem, sb.ErrorModel(**SIGMA, tails=tails), voxel=2.0, voxel_height=0.5, largest_confidence=0.9995)
    volume.save(tmp_path / "v.vdb")
    again = sb.ErrorVolume.open(tmp_path / "v.vdb")
    for one in (volume, again):
        assert one.largest_confidence == pytest.approx(0.9995, abs=1e-12)
        assert json.loads(one.report["error_model"])["tails"] == tails
    first, second = (sb.volume_viewshed(v, [EYE], view_height=2, target_spacing=20, confidence=0.99).rasters() for v in (volume, again))
    assert np.array_equal(first.lowest_visible_height, second.lowest_visible_height, equal_nan=True)
    # Half the outer cover's thickness: z(c) sigma, what the ground rises across a voxel, and a voxel's height less or more.
    flat = sb.ErrorVolume.build(sb.Dem(np.full((12, 12), 50.0, np.float32), UTM_GT, UTM), sb.ErrorModel(**SIGMA, tails=tails), voxel=2.0,
                                voxel_height=0.05, largest_confidence=0.9995)
    outer = flat.rasters(confidence=0.99)
    assert np.nanmedian(outer.upper - outer.lower) == pytest.approx(2 * z_two_sided(0.99, tails) * 0.5, abs=0.11)


# ---- shared bias -------------------------------------------------------------------------------------------------------

BIAS = 2.5


def flat_numbers(z):
    """Heights that stay exact when the bias is taken off."""
    return np.round(np.asarray(z) * 8) / 8


@pytest.fixture
def biased():
    return sb.Dem(flat_numbers(Z), UTM_GT, UTM)


def test_heights_above_the_ground_do_not_feel_a_bias(biased):
    with_bias, without = (sb.viewshed(biased, [EYE], error_model=sb.ErrorModel(**SIGMA, shared_bias=b)) for b in (BIAS, 0))
    assert np.array_equal(with_bias.confidence, without.confidence, equal_nan=True)
    assert json.loads(with_bias.report["error_model"])["shared_bias"] == BIAS


def test_absolute_heights_stand_over_the_true_ground(biased):
    """A DEM that is 2.5 m too high hides as much as one that is right, with eye and targets 2.5 m higher."""
    top = float(flat_numbers(Z).max())
    how = dict(height_reference="absolute", observer_height=top + 8.0, target_height=top - 4.0)
    told = sb.viewshed(biased, [EYE], error_model=sb.ErrorModel(**SIGMA, shared_bias=BIAS), **how)
    how = {**how, "observer_height": how["observer_height"] + BIAS, "target_height": how["target_height"] + BIAS}
    same = sb.viewshed(biased, [EYE], error_model=sb.ErrorModel(**SIGMA), **how)
    assert np.array_equal(told.confidence, same.confidence, equal_nan=True)
    assert np.unique(told.verdict).size > 1


def test_a_line_tells_the_true_heights(biased):
    end = (612355.0, 5538105.0)
    with_bias, without = (sb.line_of_sight(biased, EYE, end, error_model=sb.ErrorModel(**SIGMA, shared_bias=b)) for b in (BIAS, 0))
    assert with_bias.k == without.k
    assert with_bias.report["observer_ground"] == pytest.approx(without.report["observer_ground"] - BIAS, abs=1e-9)
    np.testing.assert_allclose(with_bias.profile["ground"], without.profile["ground"] - BIAS, atol=1e-9)


def test_surfaces_and_volumes_are_those_of_the_true_ground(biased):
    surfaces = [sb.error_surfaces(biased, sb.ErrorModel(**SIGMA, shared_bias=b)) for b in (BIAS, 0)]
    np.testing.assert_allclose(surfaces[0].lower, surfaces[1].lower - BIAS, rtol=0, atol=1e-4)
    assert np.array_equal(surfaces[0].sigma, surfaces[1].sigma)
    tin = sb.dem_to_tin(biased, tolerance=0.01)
    for terrain in (biased, tin):
        heights = [sb.ErrorVolume.build(terrain, sb.ErrorModel(**SIGMA, shared_bias=b), voxel=5.0).bounds for b in (BIAS, 0)]
        assert heights[0][2] == pytest.approx(heights[1][2] - BIAS, abs=1e-4)
        assert heights[0][:2] == heights[1][:2]


def test_what_simplifies_keeps_the_dem_s_heights(biased):
    tins = [sb.dem_to_tin(biased, error_model=sb.ErrorModel(**SIGMA, shared_bias=b)) for b in (BIAS, 0)]
    assert np.array_equal(tins[0].vertices, tins[1].vertices) and np.array_equal(tins[0].faces, tins[1].faces)


# ---- products ----------------------------------------------------------------------------------------------------------


def test_products_state_their_source(dem):
    found = sb.products()
    assert {"srtm_eurasia", "aster_gdem3", "alos_aw3d30", "tandemx", "copernicus_glo30", "ned", "3dep_ql2", "lidar_10cm"} <= set(found)
    for name, product in found.items():
        model = sb.product_error(name)
        assert model.vertical_rmse == product["vertical_rmse"] > 0 and model.geologic_variation is None
        assert model.report["product"] == name and model.report["source"] == product["source"] != ""
        assert sb.ErrorModel.from_json(model.to_json()).vertical_rmse == model.vertical_rmse
    assert found["srtm_eurasia"]["vertical_rmse"] == pytest.approx(6.2 / z_two_sided(0.9), rel=1e-9)
    assert found["copernicus_glo30"]["vertical_rmse"] == pytest.approx(2 / z_two_sided(0.9) / np.sqrt(2), rel=1e-9)
    assert sb.defaults()["error_products"] == list(found)
    sigma = sb.error_surfaces(dem, sb.product_error("ned", geologic_variation=0)).sigma
    np.testing.assert_allclose(sigma, 1.55, rtol=1e-6)


def test_what_the_user_says_of_a_product_wins():
    assert sb.product_error("ned", le95=z_two_sided(0.95)).vertical_rmse == pytest.approx(1.0)
    model = sb.product_error("ned", geologic_variation=0.5, tails="student", horizontal_rmse=1.0)
    assert (model.vertical_rmse, model.geologic_variation, model.tails, model.horizontal_rmse) == (1.55, 0.5, "student", 1.0)
    with pytest.raises(ValueError, match="no product 'srtm'.*srtm_eurasia"):
        sb.product_error("srtm")
