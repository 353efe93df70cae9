# SPDX-License-Identifier: GPL-3.0-or-later
"""sample_data/README.md: what it says of the files, and the closed-form answers of the analytic scenes."""
import subprocess
import sys
from pathlib import Path
from statistics import NormalDist

import numpy as np
import pytest
import sightbound as sb
from osgeo import gdal, ogr

gdal.UseExceptions()
ogr.UseExceptions()

DATA = Path(__file__).resolve().parents[2] / "sample_data"
MIDDLE = 32
NORMAL = NormalDist()


def look(scene, column, eye, sigma, **options):
    """The viewshed from `column` of row 32 without curvature, error given."""
    model = sb.ErrorModel(vertical_rmse=sigma, geologic_variation=0.0)
    dem = sb.read_dem(str(DATA / "analytic" / f"{scene}.tif"))
    observer = (500000.0 + 10.0 * (column - MIDDLE), 5000000.0)
    return sb.viewshed(dem, [observer], observer_height=eye, error_model=model, curvature=False, **options)


def radius():
    row, col = np.mgrid[0:65, 0:65]
    return 10.0 * np.hypot(col - MIDDLE, row - MIDDLE)


@pytest.mark.parametrize("eye, target, sigma", [(2.0, 1.0, 0.5), (3.0, 0.0, 0.2)])
def test_plane(eye, target, sigma):
    result = look("plane", MIDDLE, eye, sigma, target_height=target)
    for n in (4, 7, 16, 32):
        k = (target + (eye - target) * 2 / n) / sigma
        expected = 1.0 if k >= 3.29 else NORMAL.cdf(k)
        for row, col in ((MIDDLE, MIDDLE + n), (MIDDLE, MIDDLE - n), (MIDDLE + n, MIDDLE), (MIDDLE - n, MIDDLE)):
            assert result.confidence[row, col] == pytest.approx(expected, abs=1e-6)


def test_ridge():
    result = look("ridge", 16, 10.0, 1.0, heights=True)
    assert (result.verdict[MIDDLE, 42:] == 0).all()
    for n in (45, 52, 60):
        assert result.likely_visible_height[MIDDLE, n] == pytest.approx(10 + 10 * (n - 16) / 24, abs=0.1)
        assert result.lowest_visible_height[MIDDLE, n] == pytest.approx(10 + 11.96 * (n - 16) / 24, abs=0.1)


def test_cone_from_its_apex():
    assert (look("cone", MIDDLE, 5.0, 0.0).verdict == 2).all()
    result = look("cone", MIDDLE, 5.0, 1.0)
    for n in (4, 10, 30):
        for row, col in ((MIDDLE, MIDDLE + n), (MIDDLE - n, MIDDLE)):
            assert result.confidence[row, col] == pytest.approx(NORMAL.cdf(min(5.0 * 2 / n, 9)), abs=1e-6)


def test_cone_from_its_foot():
    height = 30.0
    verdict = look("cone", 64, height, 0.0).verdict
    row, col = np.mgrid[0:65, 0:65]
    direction = np.arctan2(row - MIDDLE, col - MIDDLE)
    edge = np.arccos((160 - height) / 160)
    cells_off = np.abs(np.abs(direction) - edge) * radius() / 10.0
    clear = (cells_off > 1.0) & (radius() > 10.0) & (radius() < 320.0)
    assert (verdict[clear & (np.abs(direction) < edge)] == 2).all()
    assert (verdict[clear & (np.abs(direction) > edge)] == 0).all()


def test_step():
    verdict = look("step", 40, 21.0, 0.0).verdict[MIDDLE]
    assert (verdict[:13] == 2).all()
    assert (verdict[13:32] == 0).all()
    result = look("step", 40, 21.0, 1.0)
    for n in (10, 12, 14, 20):
        k = 21.0 - 71.0 * 8 / (40 - n)
        assert result.confidence[MIDDLE, n] == pytest.approx(0.0 if k <= -3.29 else NORMAL.cdf(k), abs=1e-6)


def test_sphere():
    verdict = look("sphere", MIDDLE, 20.0, 0.0).verdict
    ring = 1000.0 * np.sin(np.arccos(1000.0 / 1020.0))
    assert ring == pytest.approx(197.1, abs=0.1)
    assert (verdict[radius() < ring - 10.0] == 2).all()
    assert (verdict[radius() > ring + 10.0] == 0).all()


def test_the_real_dem_is_as_described():
    assert (DATA / "jacksboro.tif").stat().st_size < 2_000_000
    dem = sb.read_dem(str(DATA / "jacksboro.tif"))
    assert dem.shape == (344, 403)
    assert (np.nanmin(dem.heights), np.nanmax(dem.heights)) == (236.0, 1076.0)
    assert dem.geotransform == pytest.approx((-84.41375, 1 / 1200, 0, 36.732916667, 0, -1 / 1200))


def test_observers_stand_on_the_dem_and_see():
    source = ogr.Open(str(DATA / "observers.gpkg"))
    places = [(f.GetGeometryRef().GetX(), f.GetGeometryRef().GetY(), f["eye_height"], f["max_distance"])
              for f in source.GetLayer("observers")]
    assert len(places) == 4
    dem = sb.read_dem(str(DATA / "jacksboro.tif"))
    result = sb.viewshed(dem, [p[:2] for p in places], observer_height=[p[2] for p in places],
                         max_distance=[p[3] for p in places])
    assert all(one["visible_m2"] > 1e6 for one in result.report["observers"])


@pytest.mark.parametrize("field", ["variation_m", "terrain"])
def test_terrain_types_can_be_used(field):
    dem = sb.read_dem(str(DATA / "jacksboro.tif"))
    model = sb.ErrorModel(vertical_rmse=1.0, geologic_variation=1.0, geologic_range=40.0,
                          terrain_types=str(DATA / "terrain_types.gpkg"), terrain_field=field)
    result = sb.viewshed(dem, [(-84.2725, 36.62583)], observer_height=15.0, max_distance=5000.0, error_model=model)
    assert set(np.unique(result.verdict)) >= {0, 1, 2}


def test_the_scenes_come_from_their_script(tmp_path):
    subprocess.run([sys.executable, DATA / "make_analytic_scenes.py", tmp_path], check=True)
    for path in sorted((DATA / "analytic").glob("*.tif")):
        ours, made = gdal.Open(str(path)), gdal.Open(str(tmp_path / path.name))
        assert (ours.ReadAsArray() == made.ReadAsArray()).all()
        assert ours.GetGeoTransform() == made.GetGeoTransform()
