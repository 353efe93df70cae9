# SPDX-License-Identifier: GPL-3.0-or-later
"""numpy in and out: no copies where layouts allow, nothing dangling, memory as planned."""
import gc
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import rasters
import sightbound as sb
import terrains

GT = (0.0, 10.0, 0.0, 3000.0, 0.0, -10.0)
EYE = [(1505.0, 1505.0)]
MODEL = dict(error_model=sb.ErrorModel(0.5, 0, 0), observer_height=10.0)


@pytest.fixture
def z():
    return terrains.fractal((300, 300), 171, 150.0)


def test_a_float32_array_is_used_in_place(z):
    dem = sb.Dem(z, GT)
    z[7, 9] = 1234.5
    assert dem.heights[7, 9] == 1234.5
    references = sys.getrefcount(z)
    del dem
    gc.collect()
    assert sys.getrefcount(z) == references - 1


@pytest.mark.parametrize("convert", [np.float64, np.asfortranarray, lambda v: v[::1, ::1].copy()[:, :], lambda v: np.ma.masked_array(v, False),
                                     lambda v: v.tolist(), lambda v: np.require(v, requirements="O").astype(">f4")],
                         ids=["double", "fortran", "slice", "masked", "list", "big-endian"])
def test_any_layout_gives_the_same(z, convert):
    a, b = sb.viewshed(sb.Dem(z, GT), EYE, **MODEL), sb.viewshed(sb.Dem(convert(z), GT), EYE, **MODEL)
    assert a.confidence.tobytes() == b.confidence.tobytes()


def test_strided_views(z):
    part = z[10:200:3, 20:250:2]
    gt = (0.0, 20.0, 0.0, 3000.0, 0.0, -30.0)
    a, b = (sb.viewshed(sb.Dem(v, gt), EYE, **MODEL) for v in (part, part.copy()))
    assert a.confidence.tobytes() == b.confidence.tobytes()


def test_integers_and_nodata(z):
    whole = np.int16(z)
    whole[3, 4] = -999
    dem = sb.Dem(whole, GT, nodata=-999)
    assert np.isnan(dem.heights[3, 4]) and np.isnan(dem.heights).sum() == 1
    masked = sb.Dem(np.ma.masked_equal(whole, -999), GT)
    assert np.isnan(masked.heights[3, 4])
    infinite = z.copy()
    infinite[5, 5] = np.inf
    assert np.isnan(sb.viewshed(sb.Dem(infinite, GT), EYE, **MODEL).confidence[5, 5])


def test_feet(z):
    dem = sb.Dem(z, GT, vertical_unit="foot")
    np.testing.assert_allclose(dem.heights, z * 0.3048, rtol=1e-6)
    assert dem.vertical_unit == "foot"


def test_results_share_memory_and_are_read_only(z):
    result = sb.viewshed(sb.Dem(z, GT), EYE, heights=True, **MODEL)
    for name in ("confidence", "verdict", "lowest_visible_height", "likely_visible_height"):
        first, second = getattr(result, name), getattr(result, name)
        assert np.shares_memory(first, second) and not first.flags.owndata and first.flags.c_contiguous
        with pytest.raises(ValueError, match="read-only"):
            first[0, 0] = 1
    kept = result.confidence
    copy = kept.copy()
    del result
    gc.collect()
    np.random.default_rng(0).random((2000, 2000))   # would overwrite freed memory
    assert np.array_equal(kept, copy, equal_nan=True)


def test_read_only_input(z):
    z.flags.writeable = False
    assert sb.viewshed(sb.Dem(z, GT), EYE, **MODEL).confidence.shape == (300, 300)


def test_observers_as_arrays(z):
    dem = sb.Dem(z, GT)
    eyes = np.array([[1505.0, 1505.0], [205.0, 305.0]])
    a = sb.viewshed(dem, eyes, observer_height=np.array([3.0, 9.0]), error_model=sb.ErrorModel(0.5, 0, 0))
    b = sb.viewshed(dem, [tuple(e) for e in eyes], observer_height=[3, 9], error_model=sb.ErrorModel(0.5, 0, 0))
    assert a.confidence.tobytes() == b.confidence.tobytes()


def test_properties_of_a_dem(z):
    dem = sb.Dem(z, GT)
    assert dem.shape == (300, 300) and dem.geotransform == GT and dem.crs_wkt is None
    assert dem.extent == (0.0, 0.0, 3000.0, 3000.0) and "300 x 300" in repr(dem)


def test_errors_as_arrays_follow_the_row_order(z):
    """A sigma raster of a south-up DEM lies on the DEM's own rows."""
    sigma = terrains.noise((300, 300), 172, 3.0)
    north = sb.viewshed(sb.Dem(z, GT), EYE, observer_height=10.0, error_model=sb.ErrorModel(vertical_rmse=sigma, geologic_variation=0))
    south = sb.viewshed(sb.Dem(z[::-1].copy(), (0, 10, 0, 0, 0, 10)), EYE, observer_height=10.0,
                        error_model=sb.ErrorModel(vertical_rmse=sigma[::-1].copy(), geologic_variation=0))
    assert np.array_equal(north.confidence, south.confidence[::-1])


# ---- memory ------------------------------------------------------------------------------------------------------------


def test_over_budget_is_refused_before_anything_is_begun(z):
    dem = sb.Dem(z, GT)
    calls = []
    with pytest.raises(MemoryError, match="(?s)300 x 300.*(max_distance|memory_budget)"):
        sb.viewshed(dem, EYE, memory_budget=100_000, progress=calls.append, **MODEL)
    with pytest.raises(MemoryError, match="(?i)memory.budget"):
        sb.error_surfaces(dem, memory_budget=100_000)
    enough = sb.viewshed(dem, EYE, **MODEL).report["memory_bytes"]
    assert sb.viewshed(dem, EYE, memory_budget=enough, **MODEL).report["memory_bytes"] <= enough


def test_observers_apart_fit_where_all_at_once_do_not():
    """Two observers at opposite ends of a large DEM are taken one after the other."""
    z = np.tile(terrains.fractal((500, 500), 173, 100.0), (4, 4))
    dem = sb.Dem(z, (0.0, 10.0, 0.0, 20000.0, 0.0, -10.0))
    eyes, options = [(505.0, 505.0), (19505.0, 19505.0)], dict(max_distance=400, **MODEL)
    free = sb.viewshed(dem, eyes, extent=(0, 0, 20000, 20000), **options)
    tight = sb.viewshed(dem, eyes, extent=(0, 0, 20000, 20000), memory_budget=int(free.report["memory_bytes"]), **options)
    assert free.confidence.tobytes() == tight.confidence.tobytes()
    assert free.report["memory_bytes"] < 4_000_000 * 20


@pytest.mark.parametrize("how, side", [("", 2000), ("heights=True", 400), ("stand='ground'", 2000), ("threads=8", 2000),
                                       ("error_model=sb.ErrorModel(1.0, 1.0, 2.0, 5.0)", 2000), ("error_model=sb.ErrorModel(1.0, 0.0, 0.0)", 2000)])
def test_the_planned_peak_is_kept(tmp_path, how, side):
    """A whole process: what the job takes is at most what the report planned, and a few MB of buffers and allocator; nor is the
    plan a mere fright. (Linux: the peak is reset before the job.)"""
    tiles = side // 200
    rasters.geotiff(tmp_path / "dem.tif", np.tile(terrains.fractal((200, 200), 174, 100.0), (tiles, tiles)), (0, 10, 0, 10 * side, 0, -10), "EPSG:32633")
    script = f"""
import sys
sys.path.insert(0, {str(Path(sb.__file__).resolve().parent.parent)!r})
import numpy, sightbound as sb
def status(field):
    return next(int(line.split()[1]) * 1024 for line in open('/proc/self/status') if line.startswith(field))
dem = sb.read_dem({str(tmp_path / 'dem.tif')!r})
sb.viewshed(dem, [({5 * side}, {5 * side})], max_distance=300, observer_height=30, {how})
open('/proc/self/clear_refs', 'w').write('5')
before = status('VmRSS')
result = sb.viewshed(dem, [({5 * side}, {5 * side})], observer_height=30, {how})
print(status('VmHWM') - before, result.report['memory_bytes'])
"""
    out = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=120).stdout
    used, planned = map(int, out.split())
    assert used <= planned * 1.05 + 16e6, f"{used / 1e6:.0f} MB used, {planned / 1e6:.0f} MB planned"
    assert planned <= 2 * used + 16e6, f"{planned / 1e6:.0f} MB planned, only {used / 1e6:.0f} MB used"
