# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact: for every cell, verdict and p are what the definition says (|p - definition| <= 0.005, verdicts equal but for ties
of 1e-6 in k), in every CRS, for every error model, with and without holes."""
from dataclasses import replace

import numpy as np
import pytest
import terrains
from judge import NORTH_UP, Scene, check
from sight_oracle import Errors

SMALL = (16, 18)
UTM = "EPSG:32633"
UTM_GT = (612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0)
SOFT = Errors(vertical=0.4, horizontal=0.5, delta=1.5, range=4.0)


def utm(name, z=None, errors=SOFT, **more):
    more = {"observer": (9.0, 7.0), "observer_height": 3.0, **more}
    return Scene(name, terrains.fractal(SMALL, 11) if z is None else z, UTM_GT, UTM, errors, **more)


def degrees(name, latitude, step=(1 / 1200, 1 / 1200), shape=SMALL, relief=120.0, **more):
    gt = (10.0, step[0], 0.0, latitude, 0.0, -step[1])
    more = {"errors": Errors(vertical=2.0, horizontal=3.0, delta=6.0, range=40.0), "observer": (9.0, 8.0), **more}
    return Scene(name, terrains.fractal(shape, 21, relief), gt, "EPSG:4326", **more)


def lattice_of_holes(z):
    """Every line between samples passes exactly through samples that have holes for neighbours."""
    z = z.copy()
    z[::4, ::4] = np.nan
    return z


EARTH = [
    Scene("plane without CRS", terrains.fractal(SMALL, 1), errors=SOFT),
    utm("UTM"),
    utm("UTM, wide", z=terrains.fractal((20, 20), 3, 900.0), observer=(3.0, 15.0), observer_height=30.0).but(
        gt=(760000.0, 1000.0, 0.0, 6900000.0, 0.0, -1000.0), errors=Errors(vertical=8.0, horizontal=20.0, delta=60.0, range=500.0)),
    degrees("5 degrees north", 5.0),
    degrees("60 degrees north", 60.0),
    degrees("77 degrees north", 77.0),
    degrees("77 degrees north, tall cells", 77.0, step=(1 / 600, 1 / 3600)),
    degrees("60 degrees south, wide cells", -60.0, step=(1 / 1200, 1 / 2400)),
    Scene("Web Mercator at 60 degrees", terrains.fractal(SMALL, 4), (1.2e6, 20.0, 0.0, 8.4e6, 0.0, -20.0), "EPSG:3857", SOFT),
    Scene("Web Mercator at 60 degrees, wide", terrains.fractal(SMALL, 4, 700.0), (1.2e6, 2000.0, 0.0, 8.4e6, 0.0, -2000.0), "EPSG:3857",
          Errors(vertical=5.0, delta=20.0, range=400.0), observer=(2.0, 13.0), observer_height=40.0),
    Scene("Arctic polar stereographic", terrains.fractal(SMALL, 5, 90.0), (-1.9e5, 100.0, 0.0, -1.1e6, 0.0, -100.0), "EPSG:3413", SOFT),
    Scene("Antarctic polar stereographic", terrains.fractal(SMALL, 6, 90.0), (3.1e5, 100.0, 0.0, 1.3e6, 0.0, -100.0), "EPSG:3031", SOFT),
    Scene("feet", terrains.fractal(SMALL, 7), (6.0e6, 30.0, 0.0, 2.1e6, 0.0, -30.0), "EPSG:2227", SOFT),
    Scene("round the south pole", terrains.fractal(SMALL, 8, 900.0), (-9e3, 1000.0, 0.0, 8e3, 0.0, -1000.0), "EPSG:3031",
          Errors(vertical=5.0, delta=20.0, range=400.0), observer=(3.0, 4.0), observer_height=60.0),
    degrees("across the antimeridian", -16.0).but(gt=(179.99, 1 / 1200, 0.0, -16.0, 0.0, -1 / 1200)),
    degrees("88 degrees north", 88.0, step=(0.02, 1 / 1200)),
    utm("oblong cells").but(gt=(612340.0, 7.0, 0.0, 5538120.0, 0.0, -15.0)),
    utm("south-up").but(gt=(612340.0, 10.0, 0.0, 5538120.0, 0.0, 10.0)),
    utm("rotated by 30 degrees").but(gt=(612340.0, 8.66, 5.0, 5538120.0, 5.0, -8.66)),
    utm("rotated, mirrored").but(gt=(612340.0, 5.0, 8.66, 5538120.0, 8.66, -5.0)),
    degrees("south-up in degrees", 60.0).but(gt=(10.0, 1 / 600, 0.0, 60.0, 0.0, 1 / 2400)),
]

ERROR_MODELS = [
    utm("no error at all", errors=Errors(vertical=0.0)),
    utm("paper's Gaussian", errors=Errors(vertical=0.3, delta=0.15)),
    utm("paper's Gaussian, craggy", errors=Errors(vertical=0.3, delta=4.0)),
    utm("step", errors=Errors(vertical=0.3, delta=2.0, range=3.0, model="step")),
    utm("growth", errors=Errors(vertical=0.0, delta=2.5, model="growth", exponent=0.8)),
    utm("sigma as raster", errors=Errors(vertical=terrains.noise(SMALL, 31, 2.0), delta=1.0, range=5.0)),
    utm("Delta as raster", errors=Errors(vertical=0.2, delta=terrains.noise(SMALL, 32, 5.0), range=5.0)),
    utm("Delta as raster, paper's Gaussian", errors=Errors(vertical=0.2, delta=terrains.noise(SMALL, 33, 0.4))),
    utm("growth of a raster", errors=Errors(vertical=0.1, delta=terrains.noise(SMALL, 34, 3.0), model="growth", exponent=1.4)),
    utm("large sigma", errors=Errors(vertical=9.0, horizontal=4.0, delta=5.0, range=4.0)),
    utm("horizontal error alone", errors=Errors(vertical=0.0, horizontal=2.0)),
] + [
    utm(f"{tails} tails, confidence {confidence}", errors=replace(SOFT, tails=tails), confidence=confidence)
    for tails in ("laplace", "student") for confidence in (0.5, 0.95, 0.999)
] + [
    utm("student tails, standing on the ground", errors=Errors(vertical=terrains.noise(SMALL, 35, 2.0), delta=1.0, range=4.0, tails="student"),
        how=dict(stand="ground")),
]

OBSERVERS = [
    utm("off the samples", observer=(7.37, 13.81)),
    utm("almost on a sample", observer=(7.00004, 12.99997)),
    utm("in the corner", observer=(0.0, 0.0)),
    utm("in the opposite corner", observer=(17.0, 15.0)),
    utm("on the edge", observer=(17.0, 9.4)),
    utm("on a diagonal", observer=(7.25, 9.25)),
    utm("tower", observer_height=120.0),
    utm("tall targets", target_height=25.0),
    utm("target and eye at 2 m", target_height=2.0, observer_height=2.0),
    utm("lying on the ground", observer_height=0.0),
    utm("absolute heights", observer_height=48.0, target_height=44.0, how=dict(height_reference="absolute")),
    utm("standing on the ground", how=dict(stand="ground")),
    utm("standing on the ground, errors as rasters", how=dict(stand="ground"), observer=(7.37, 13.81), target_height=2.0,
        errors=Errors(vertical=terrains.noise(SMALL, 35, 2.0), horizontal=0.5, delta=terrains.noise(SMALL, 36, 3.0), range=4.0)),
    utm("on a surface model", z=terrains.fractal(SMALL, 11) + terrains.spikes(SMALL, 12, 30, 9.0), ground=terrains.fractal(SMALL, 11),
        target_height=1.0, observer=(11.0, 11.0)),
    utm("on a surface model, the ground has holes", z=terrains.fractal(SMALL, 11) + terrains.spikes(SMALL, 12, 30, 9.0), target_height=1.0,
        ground=terrains.with_holes(terrains.fractal(SMALL, 11), 13, 0.05, keep=(9, 7))),
    utm("confidence 0.5", confidence=0.5),
    utm("confidence 0.999", confidence=0.999),
    utm("strong refraction", how=dict(refraction=0.9)),
    utm("flat earth", how=dict(curvature=False)),
]

TERRAIN = [
    Scene("flat", terrains.plane(SMALL), errors=SOFT),
    Scene("tilted plane", terrains.plane(SMALL, 3.0, -2.0), errors=SOFT),
    Scene("terraces", terrains.plateaus(SMALL, 41), errors=SOFT, observer_height=5.0, target_height=5.0),
    Scene("noise", terrains.noise(SMALL, 42), errors=SOFT, observer=(12.0, 11.0)),
    Scene("spikes", terrains.spikes(SMALL, 43), errors=SOFT, observer_height=10.0),
    Scene("walls", terrains.ridges(SMALL), errors=SOFT, observer=(11.0, 10.0), observer_height=25.0),
    Scene("bowl", terrains.bowl(SMALL), errors=SOFT),
    Scene("below the sea", terrains.fractal(SMALL, 44) - 430, errors=SOFT),
    Scene("holes", terrains.with_holes(terrains.fractal(SMALL, 45), 46, keep=(12, 11)), errors=SOFT, observer=(12.0, 11.0), observer_height=12.0),
    Scene("holes, sight crosses", terrains.with_holes(terrains.fractal(SMALL, 45), 46, keep=(12, 11)), errors=SOFT, observer=(12.0, 11.0),
          observer_height=12.0, how=dict(see_across=True)),
    Scene("lattice of holes, lines through the samples between", lattice_of_holes(terrains.fractal(SMALL, 52)), errors=SOFT,
          observer=(9.0, 7.0), observer_height=25.0),
    utm("holes in UTM", z=terrains.with_holes(terrains.fractal(SMALL, 47), 48, keep=(12, 11)), observer=(12.3, 11.2), observer_height=12.0),
    utm("holes, standing on the ground", z=terrains.with_holes(terrains.fractal(SMALL, 47), 48, keep=(12, 11)), observer=(12.3, 11.2),
        observer_height=12.0, how=dict(stand="ground")),
    Scene("two by two", terrains.noise((2, 2), 50), errors=SOFT, observer=(0.0, 0.0)),
    Scene("narrow", terrains.fractal((2, 40), 51), errors=SOFT, observer=(4.0, 0.0)),
]

# Reach so large that the geodesic leaves the straight grid line by many cells, and terrain so large that whole stretches of it
# are settled by bounds alone.
LARGE = [
    degrees("coarse cells, long geodesics", 62.0, step=(0.05, 0.05), shape=(60, 60), relief=2500.0, observer=(4.0, 33.0),
            observer_height=2000.0, errors=Errors(vertical=20.0, delta=60.0, range=2000.0), sample=250),
    degrees("coarse cells at the equator", 1.5, step=(0.05, 0.05), shape=(60, 60), relief=2500.0, observer=(4.0, 3.0),
            observer_height=3000.0, errors=Errors(vertical=20.0, delta=60.0, range=2000.0), sample=150),
] + [
    Scene(f"300 x 300, sigma {sigma} m, eye {eye}", terrains.fractal((300, 300), 61, 300.0), UTM_GT, UTM,
          Errors(vertical=sigma, delta=sigma, range=5.0), observer=eye, observer_height=10.0, sample=200)
    for sigma, eye in ((0.02, (150.0, 150.0)), (1.0, (31.2, 250.7)), (12.0, (150.4, 149.1)))
] + [
    Scene("300 x 300, rough", terrains.fractal((300, 300), 62, 200.0, roughness=1.3), NORTH_UP, None,
          Errors(vertical=0.5, delta=1.0, range=5.0), observer=(140.0, 160.0), observer_height=25.0, sample=150),
    Scene("300 x 300, holes", terrains.with_holes(terrains.fractal((300, 300), 63, 300.0), 64, 0.0005, keep=(20, 30)), NORTH_UP, None,
          Errors(vertical=0.5, delta=1.0, range=5.0), observer=(20.0, 30.0), observer_height=60.0, sample=150),
]


def named(scenes):
    return [pytest.param(s, id=s.name) for s in scenes]


@pytest.mark.parametrize("scene", named(EARTH))
def test_every_earth(scene):
    check(scene)


@pytest.mark.parametrize("scene", named(ERROR_MODELS))
def test_every_error_model(scene):
    check(scene)


@pytest.mark.parametrize("scene", named(OBSERVERS))
def test_every_observer(scene):
    check(scene)


@pytest.mark.parametrize("scene", named(TERRAIN))
def test_every_terrain(scene):
    check(scene)


@pytest.mark.parametrize("scene", named(LARGE))
def test_large(scene):
    check(scene)


@pytest.mark.parametrize("seed", range(8))
def test_random_scenes(seed):
    """Everything drawn at random; the seed is the test's name."""
    rng = np.random.default_rng(1000 + seed)
    shape = tuple(int(v) for v in rng.integers(8, 20, 2))
    z = terrains.fractal(shape, seed, relief=float(10 ** rng.uniform(0, 2.3)), roughness=float(rng.uniform(1.0, 2.4)))
    observer = (float(rng.uniform(0, shape[1] - 1)), float(rng.uniform(0, shape[0] - 1)))
    if rng.random() < 0.5:
        observer = tuple(float(round(v)) for v in observer)
    if rng.random() < 0.3:
        z = terrains.with_holes(z, seed, 0.02, keep=observer)
    crs, gt = [(None, NORTH_UP), (UTM, UTM_GT), ("EPSG:4326", (10.0, 1e-3, 0.0, float(rng.uniform(-75, 75)), 0.0, -1e-3)),
               ("EPSG:3857", (1.2e6, 30.0, 0.0, float(rng.uniform(-9e6, 9e6)), 0.0, -30.0))][rng.integers(4)]
    errors = Errors(vertical=float(10 ** rng.uniform(-2, 1)), horizontal=float(rng.choice([0.0, 1.0])),
                    delta=float(rng.choice([0.0, 1.0, 5.0])), range=float(rng.uniform(2, 30)))
    check(Scene(f"seed {seed}", z, gt, crs, errors, observer, observer_height=float(10 ** rng.uniform(-1, 1.5)),
                target_height=float(rng.choice([0.0, 2.0])), confidence=float(rng.choice([0.8, 0.95, 0.99])),
                how=dict(stand=str(rng.choice(["model", "ground"])))))
