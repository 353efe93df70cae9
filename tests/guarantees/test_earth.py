# SPDX-License-Identifier: GPL-3.0-or-later
"""Earth: distances, directions and the drop of the ground are the ellipsoid's, in every CRS."""
import math

import numpy as np
import pyproj
import pytest
import sightbound as sb
from judge import Scene
from sight_oracle import Errors

SHAPE = (60, 60)
EYE = 15.0
CRSS = {"degrees at 5": ((20.0, 0.01, 0, 5.0, 0, -0.01), "EPSG:4326"),
        "degrees at 60": ((20.0, 0.01, 0, 60.0, 0, -0.01), "EPSG:4326"),
        "degrees at 77": ((20.0, 0.02, 0, 77.0, 0, -0.005), "EPSG:4326"),
        "degrees across 180": ((179.8, 0.01, 0, -16.0, 0, -0.01), "EPSG:4326"),
        "ETRS89": ((10.0, 0.01, 0, 48.0, 0, -0.01), "EPSG:4258"),
        "UTM": ((400000.0, 1000.0, 0, 6700000.0, 0, -1000.0), "EPSG:32633"),
        "Web Mercator at 60": ((1.2e6, 2000.0, 0, 8.4e6, 0, -2000.0), "EPSG:3857"),
        "Arctic": ((-5e4, 1000.0, 0, -1.1e6, 0, -1000.0), "EPSG:3413"),
        "round the south pole": ((-3e4, 1000.0, 0, 3e4, 0, -1000.0), "EPSG:3031"),
        "feet": ((6.0e6, 3000.0, 0, 2.1e6, 0, -3000.0), "EPSG:2227"),
        "Bessel": ((3.4e6, 1000.0, 0, 5.6e6, 0, -1000.0), "EPSG:31467")}


def flat(earth, **more):
    gt, crs = CRSS[earth]
    return Scene(earth, np.zeros(SHAPE, np.float32), gt, crs, **{"errors": Errors(vertical=0.0), "observer": (8.3, 41.6),
                                                                "observer_height": EYE, **more})


@pytest.mark.parametrize("earth", CRSS)
def test_distance_and_azimuth(earth):
    scene = flat(earth)
    oracle = scene.oracle()
    xy = scene.xy(oracle)
    rng = np.random.default_rng(7)
    for _ in range(20):
        target = tuple(float(v) for v in oracle.frame.xy(*rng.uniform(0, 59, 2)))
        line = sb.line_of_sight(scene.dem, xy, target, observer_height=EYE, error_model=scene.model)
        distance, azimuth = oracle.frame.inverse_geodesic(xy, target)
        assert line.distance == pytest.approx(distance, abs=1e-5 * oracle.cell)
        assert (line.azimuth - azimuth + 180) % 360 - 180 == pytest.approx(0, abs=math.degrees(1e-4 * oracle.cell / distance))


@pytest.mark.parametrize("refraction", [0.0, 0.13])
@pytest.mark.parametrize("earth", CRSS)
def test_a_tower_behind_the_horizon(earth, refraction):
    """Over a level sea an eye of height h touches it at sqrt(2 R' h); a tower at D must reach (D - sqrt(2 R' h))^2 / 2R',
    R' = R / (1 - refraction). The sea is a TIN here, so the touching point may lie up to half a cell off: the line then clears
    it by less, cell^2 / 8R', at most."""
    scene = flat(earth, how=dict(refraction=refraction))
    oracle = scene.oracle()
    xy = scene.xy(oracle)
    heights = []
    for col, row in ((59.0, 3.0), (55.0, 59.0), (2.0, 0.0)):
        target = tuple(float(v) for v in oracle.frame.xy(col, row))
        line = sb.line_of_sight(scene.dem, xy, target, observer_height=EYE, error_model=scene.model, refraction=refraction)
        distance, azimuth = oracle.frame.inverse_geodesic(xy, target)
        radius = oracle.frame.euler_radius(xy, azimuth, distance) / (1 - refraction)
        beyond = distance - math.sqrt(2 * radius * EYE)
        assert beyond > 0
        share = math.sqrt(2 * radius * EYE) / distance
        slack = (oracle.cell ** 2 / (8 * radius) + 0.002) / share
        heights.append(line.required_height)
        assert line.required_height == pytest.approx(beyond ** 2 / (2 * radius), abs=slack)
    assert min(heights) > 1.0


def test_the_same_ground_in_two_systems():
    """A sphere-like hill given in degrees and in UTM: nearly the same answer where neither is in doubt."""
    ground = pyproj.Transformer.from_crs("EPSG:32633", "EPSG:4326", always_xy=True)

    def hill(lon, lat):
        return 300 * np.exp(-((lon - 15.03) / 0.01) ** 2 - ((lat - 60.02) / 0.006) ** 2) + 20 * np.sin(lon * 900) * np.sin(lat * 1100)

    def scene(gt, crs, shape):
        frame = Scene("frame", np.zeros(shape, np.float32), gt, crs).oracle().frame
        cols, rows = np.meshgrid(np.arange(shape[1]), np.arange(shape[0]))
        x, y = frame.xy(cols, rows)
        lon, lat = (x, y) if crs == "EPSG:4326" else ground.transform(x, y)
        return Scene(crs, np.float32(hill(lon, lat)), gt, crs, Errors(vertical=2.0)), frame

    utm, utm_frame = scene((500500.0, 25.0, 0, 6654500.0, 0, -25.0), "EPSG:32633", (160, 160))
    degrees, degrees_frame = scene((15.002, 25 / 55800, 0, 60.035, 0, -25 / 111400), "EPSG:4326", (200, 175))
    eye = (15.04, 60.025)
    a = sb.viewshed(utm.dem, [ground.transform(*eye, direction="INVERSE")], observer_height=20.0, error_model=utm.model)
    b = sb.viewshed(degrees.dem, [eye], observer_height=20.0, error_model=degrees.model)
    rows, cols = np.mgrid[10:150:3, 10:150:3]
    lon, lat = ground.transform(*utm_frame.xy(cols, rows))
    other_col, other_row = (np.round(v).astype(int) for v in degrees_frame.colrow(lon, lat))
    here, there = a.verdict[rows, cols], b.verdict[other_row, other_col]
    assert np.mean((here == 2) & (there == 0)) + np.mean((here == 0) & (there == 2)) < 0.01
    assert np.mean(here == there) > 0.9


def test_curvature_off_is_a_plane():
    scene = flat("UTM", observer_height=10.0, target_height=10.0)
    assert np.all(scene.viewshed(curvature=False).verdict == 2)
    assert np.any(scene.viewshed(curvature=True).verdict == 0)


def test_refraction_bends_towards_the_ground():
    scene = flat("UTM", errors=Errors(vertical=1.0))
    areas = [np.sum(scene.viewshed(refraction=r).verdict == 2) for r in (0.0, 0.13, 0.5, 1.0)]
    assert areas == sorted(areas) and areas[0] < areas[-1]
