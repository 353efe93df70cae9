# SPDX-License-Identifier: GPL-3.0-or-later
"""On a TIN that was simplified with visibility_tolerance(), observers see what they are sure to see from the DEM, and nothing
that is surely hidden. Oracle: lines to every cell, held against the faces of the TIN at places strewn along them."""
import numpy as np
import pytest
import terrains

import sightbound as sb

CELL = 10.0
GT = (0.0, CELL, 0.0, 0.0, 0.0, -CELL)
AT_END = 1 / 16  # cells: places nearer to an end say nothing
PLACES = 100     # along a line


def height_of_tin(tin, x, y):
    heights = np.full(len(x), np.nan)
    for a, b, c in tin.vertices[tin.faces]:
        twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        near = np.flatnonzero((x >= min(a[0], b[0], c[0]) - 1e-6) & (x <= max(a[0], b[0], c[0]) + 1e-6)
                              & (y >= min(a[1], b[1], c[1]) - 1e-6) & (y <= max(a[1], b[1], c[1]) + 1e-6))
        u = ((x[near] - a[0]) * (c[1] - a[1]) - (y[near] - a[1]) * (c[0] - a[0])) / twice
        v = ((b[0] - a[0]) * (y[near] - a[1]) - (b[1] - a[1]) * (x[near] - a[0])) / twice
        inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9)
        heights[near[inside]] = (a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]))[inside]
    return heights


def clearances(tin, shape, eye, eye_height, target_height):
    """Of the line to each cell: the least height above the TIN."""
    rows, cols = np.mgrid[:shape[0], :shape[1]]
    x, y = (cols.ravel() + 0.5) * CELL, -(rows.ravel() + 0.5) * CELL
    from_z = height_of_tin(tin, np.array([eye[0]]), np.array([eye[1]]))[0] + eye_height
    to_z = height_of_tin(tin, x, y) + target_height
    far = np.hypot(x - eye[0], y - eye[1])
    least = np.full(len(x), np.inf)
    for share in (np.arange(PLACES) + 0.5) / PLACES:
        between = (share * far > AT_END * CELL) & ((1 - share) * far > AT_END * CELL)
        ground = height_of_tin(tin, eye[0] + share * (x - eye[0]), eye[1] + share * (y - eye[1]))
        least[between] = np.minimum(least, from_z + share * (to_z - from_z) - ground)[between]
    return least.reshape(shape)


@pytest.mark.parametrize("z, sigma, tolerance, target_height, bites", [
    (terrains.fractal((24, 26), 3), 0.2, 6.0, 1.0, True),
    (terrains.fractal((26, 24), 12), 0.3, 12.0, 4.0, True),
    (terrains.ridges((26, 24)), 0.8, 10.0, 2.0, False),
], ids=["fractal", "fractal, tall targets", "walls"])
def test_views_stay(z, sigma, tolerance, target_height, bites):
    z = np.float32(z)
    dem, model = sb.Dem(z, GT), sb.ErrorModel(vertical_rmse=sigma, geologic_variation=0.0)
    observers, eye_height = [(131.7, -148.2), (35.0, -225.0)], 2.0
    how = dict(observer_height=eye_height, target_height=target_height, error_model=model, curvature=False)
    limit, report = sb.visibility_tolerance(dem, observers, tolerance, **how)
    tin = sb.dem_to_tin(dem, tolerance=limit)
    plain = sb.dem_to_tin(dem, tolerance=tolerance)
    assert 0 < report["free_share"] < 1 and limit.max() == pytest.approx(tolerance)
    assert len(plain.faces) < len(tin.faces) < 2 * z.size
    wrong = seen = hidden = 0
    for eye in observers:
        sure = sb.viewshed(dem, [eye], stand="ground", **how).verdict
        clear = clearances(tin, z.shape, eye, eye_height, target_height)
        lost = clearances(plain, z.shape, eye, eye_height, target_height)
        seen, hidden = seen + (sure == 2).sum(), hidden + (sure == 0).sum()
        assert (clear[sure == 2] > 0).all() and (clear[sure == 0] < 0).all()
        wrong += ((lost <= 0) & (sure == 2)).sum() + ((lost >= 0) & (sure == 0)).sum()
    assert seen > 20 and hidden > 20
    assert wrong > 0 or not bites  # is the plain tolerance too large for the views?


def test_without_error_what_is_in_view_stays_exactly():
    z = np.float32(terrains.fractal((24, 24), 8))
    dem = sb.Dem(z, GT)
    model = sb.ErrorModel(vertical_rmse=0.0, geologic_variation=0.0)
    limit, _ = sb.visibility_tolerance(dem, [(125.0, -125.0)], 5.0, error_model=model, curvature=False)
    seen = sb.viewshed(dem, [(125.0, -125.0)], error_model=model, curvature=False).verdict
    assert (limit[seen != 0] == 0).all() and (limit == 5).any()


def test_what_is_in_view_keeps_to_the_least_error_of_all():
    z, sigma = np.zeros((15, 24), np.float32), np.full((15, 24), 0.01, np.float32)
    z[:, 3], z[7, 3], sigma[7, 3] = 1.9, 0.0, 5.0  # a gate in a wall, badly known, right before the eye
    dem, model = sb.Dem(z, GT), sb.ErrorModel(vertical_rmse=sigma, geologic_variation=0.0)
    how = dict(observer_height=1.0, target_height=0.5, error_model=model, curvature=False)
    limit, _ = sb.visibility_tolerance(dem, [(25.0, -75.0)], 6.0, **how)
    sure = sb.viewshed(dem, [(25.0, -75.0)], stand="ground", **how).verdict
    assert (sure == 2).sum() > 100 and limit[sure == 2].max() <= 0.5 * 1.96 * 0.01
    clear = clearances(sb.dem_to_tin(dem, tolerance=limit), z.shape, (25.0, -75.0), 1.0, 0.5)
    assert (clear[sure == 2] > 0).all() and (clear[sure == 0] < 0).all()


def test_bad_input_is_named():
    dem = sb.Dem(np.float32(terrains.fractal((12, 12), 8)), GT)
    with pytest.raises(ValueError, match="target_height"):
        sb.visibility_tolerance(dem, [(55.0, -55.0)], 5.0, target_height=-1.0)
    for arguments, word in ((([(500.0, 500.0)], 5.0), "outside"), (([(55.0, -55.0)], -1.0), "tolerance"),
                            (([(55.0, -55.0)], float("nan")), "tolerance"), (([], 5.0), "observers")):
        with pytest.raises(ValueError, match=word):
            sb.visibility_tolerance(dem, *arguments)
