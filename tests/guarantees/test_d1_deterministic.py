# SPDX-License-Identifier: GPL-3.0-or-later
"""D1 deterministic: the same bytes for any number of threads, any window, any company of observers."""
import numpy as np
import pytest
import sightbound as sb
import terrains
from judge import Scene, placed
from sight_oracle import Errors

UTM = dict(gt=(612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0), crs="EPSG:32633")
DEGREES = dict(gt=(10.0, 1e-3, 0.0, 66.0, 0.0, -1e-3), crs="EPSG:4326")
SHAPE = (140, 170)
ERRORS = Errors(vertical=0.5, horizontal=0.4, delta=2.0, range=6.0)


def scene(earth, **more):
    relief = 150.0 if earth is UTM else 900.0
    z = terrains.with_holes(terrains.fractal(SHAPE, 101, relief), 102, 0.0003)
    return Scene("d1", z, **earth, **{"errors": ERRORS, "observer": (70.4, 61.7), "observer_height": 15.0, **more})


def arrays(result):
    return {"confidence": result.confidence, "verdict": result.verdict, "count": result.count}


@pytest.mark.parametrize("earth", [UTM, DEGREES], ids=["UTM", "degrees"])
@pytest.mark.parametrize("how", [{}, {"stand": "ground"}, {"heights": True}, {"error_model": None}], ids=["model", "ground", "heights", "estimate"])
def test_threads(earth, how):
    results = [scene(earth).viewshed(threads=n, **how) for n in (1, 2, 8)]
    for other in results[1:]:
        for name, array in arrays(results[0]).items():
            assert array.tobytes() == arrays(other)[name].tobytes(), name
        if how.get("heights"):
            assert results[0].lowest_visible_height.tobytes() == other.lowest_visible_height.tobytes()
            assert results[0].likely_visible_height.tobytes() == other.likely_visible_height.tobytes()


def same_where_asked(part, whole, scene, least):
    """Every cell of the part that was asked has the whole's bytes."""
    asked = 0
    for name in ("confidence", "verdict"):
        a, b = placed(part, arrays(part)[name], scene), placed(whole, arrays(whole)[name], scene)
        there = ~np.isnan(placed(part, part.confidence, scene))
        asked = there.sum()
        different = np.argwhere(there & (a != b))
        assert different.size == 0, f"{name}: {len(different)} of {asked} cells differ, the first at {different[0]}: {a[tuple(different[0])]} " \
                                    f"in the part, {b[tuple(different[0])]} in the whole"
    assert asked >= least


@pytest.mark.parametrize("earth", [UTM, DEGREES], ids=["UTM", "degrees"])
@pytest.mark.parametrize("model", ["given", "estimate"])
def test_extent(earth, model):
    one = scene(earth)
    how = {} if model == "given" else {"error_model": None}
    whole, oracle = one.viewshed(**how), one.oracle()
    for left, top, right, bottom in ((60, 50, 90, 80), (0, 0, 20, 30), (100, 90, 169, 139)):
        corners = [oracle.frame.xy(left, bottom), oracle.frame.xy(right, top)]
        extent = tuple(float(v) for corner in corners for v in corner)
        part = one.viewshed(extent=extent, **how)
        assert part.confidence.shape[0] <= bottom - top + 3 and part.confidence.shape[1] <= right - left + 3
        same_where_asked(part, whole, one, 0.9 * (right - left) * (bottom - top))


@pytest.mark.parametrize("earth", [UTM, DEGREES], ids=["UTM", "degrees"])
def test_max_distance(earth):
    one = scene(earth)
    whole = one.viewshed()
    side = 10.0 if earth is UTM else 45.0
    for distance in (12 * side, 30 * side, 55 * side):
        part = one.viewshed(max_distance=distance)
        same_where_asked(part, whole, one, 150)


def test_company():
    """Many observers at once are the best and the worst of each alone."""
    one = scene(UTM)
    oracle = one.oracle()
    eyes = [tuple(float(v) for v in oracle.frame.xy(c, r)) for c, r in ((20.0, 30.0), (120.5, 90.2), (70.0, 61.0), (160.0, 10.0))]
    options = dict(error_model=one.model, observer_height=15.0)
    alone = [sb.viewshed(one.dem, [eye], **options) for eye in eyes]
    best, worst = (sb.viewshed(one.dem, eyes, combine=combine, **options) for combine in ("best", "worst"))
    confidence = np.stack([r.confidence for r in alone])
    verdict = np.stack([r.verdict for r in alone])
    assert np.array_equal(best.confidence, confidence.max(0), equal_nan=True)
    assert np.array_equal(worst.confidence, confidence.min(0), equal_nan=True)
    assert np.array_equal(best.verdict, verdict.max(0)) and np.array_equal(worst.verdict, verdict.min(0))
    count = np.where(verdict[0] == 255, 4294967295, (verdict == 2).sum(0))
    assert np.array_equal(best.count, count) and np.array_equal(worst.count, count)
    again = sb.viewshed(one.dem, eyes[::-1], **options)
    assert again.confidence.tobytes() == best.confidence.tobytes()


def test_line_of_sight_is_the_viewshed_of_one_cell():
    for earth in (UTM, DEGREES):
        one = scene(earth)
        oracle, whole = one.oracle(), one.viewshed()
        xy, rng = one.xy(oracle), np.random.default_rng(103)
        for _ in range(40):
            row, col = (int(rng.integers(0, n)) for n in SHAPE)
            if np.isnan(one.z[row, col]):
                continue
            target = tuple(float(v) for v in oracle.frame.xy(col, row))
            line = sb.line_of_sight(one.dem, xy, target, observer_height=15.0, error_model=one.model)
            assert line.p == pytest.approx(float(whole.confidence[row, col]), abs=1e-3)
            if abs(abs(line.k) - 1.96) > 1e-3:
                assert line.verdict == whole.verdict[row, col]


def test_file_or_array(tmp_path):
    import rasters
    one = scene(UTM)
    path = rasters.geotiff(tmp_path / "dem.tif", one.z, one.gt, one.crs, nodata=-9999)
    xy = one.xy(one.oracle())
    options = dict(error_model=one.model, observer_height=15.0)
    file, array = sb.viewshed(sb.read_dem(path), [xy], **options), sb.viewshed(one.dem, [xy], **options)
    assert file.confidence.tobytes() == array.confidence.tobytes()
