# SPDX-License-Identifier: GPL-3.0-or-later
"""write(): right GeoTIFFs, whole or not at all."""
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import rasters
import sightbound as sb
import terrains
from osgeo import gdal

UTM, UTM_GT = "EPSG:32633", (612340.0, 10.0, 0.0, 5538120.0, 0.0, -10.0)
EYE = [(612645.0, 5537815.0)]


@pytest.fixture(scope="module")
def result():
    dem = sb.Dem(terrains.with_holes(terrains.fractal((60, 70), 161), 162, 0.01, keep=(30, 30)), UTM_GT, rasters.wkt_of(UTM))
    return sb.viewshed(dem, EYE, observer_height=8.0, heights=True, max_distance=250, confidence=0.9, refraction=0.2,
                       error_model=sb.ErrorModel(vertical_rmse=0.5, geologic_variation=1.0, geologic_range=5.0))


def read(path):
    dataset = gdal.Open(str(path))
    return dataset, dataset.GetRasterBand(1), dataset.ReadAsArray()


def test_five_rasters(result, tmp_path):
    paths = {name: tmp_path / f"{name}.tif" for name in ("confidence", "verdict", "count", "height", "likely_height")}
    result.write(**paths)
    arrays = dict(confidence=result.confidence, verdict=result.verdict, count=result.count, height=result.lowest_visible_height,
                  likely_height=result.likely_visible_height)
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(p.name for p in paths.values())
    for name, array in arrays.items():
        dataset, band, values = read(paths[name])
        assert values.dtype == array.dtype and np.array_equal(values, array, equal_nan=values.dtype.kind == "f")
        assert dataset.GetGeoTransform() == result.geotransform
        assert dataset.GetSpatialRef().GetAuthorityCode(None) == "32633"
        nodata = band.GetNoDataValue()
        assert np.isnan(nodata) if array.dtype == np.float32 else nodata == {"verdict": 255, "count": 4294967295}[name]
        items = dataset.GetMetadata()
        assert items["SIGHTBOUND_VERSION"] == sb.__version__ and float(items["SIGHTBOUND_CONFIDENCE"]) == 0.9
        assert float(items["SIGHTBOUND_REFRACTION"]) == 0.2 and items["SIGHTBOUND_STAND"] == "model"
        assert sb.ErrorModel.from_json(items["SIGHTBOUND_ERROR_MODEL"]).vertical_rmse == 0.5
        assert band.GetDescription()
    assert "pointwise" in read(paths["confidence"])[0].GetMetadata()["SIGHTBOUND_QUANTITY"].lower()


def test_without_a_crs_and_south_up(tmp_path):
    dem = sb.Dem(terrains.fractal((30, 40), 163), (0, 10, 0, 0, 0, 10))
    result = sb.viewshed(dem, [(205, 155)], error_model=sb.ErrorModel(0.5, 0, 0))
    result.write(tmp_path / "a.tif")
    dataset, _, values = read(tmp_path / "a.tif")
    assert dataset.GetGeoTransform() == (0, 10, 0, 0, 0, 10) and not dataset.GetProjection()
    assert np.array_equal(values, result.confidence)


def test_creation_options(result, tmp_path):
    result.write(tmp_path / "a.tif", creation_options={"COMPRESS": "LZW", "TILED": "NO"})
    result.write(tmp_path / "b.tif", creation_options=["COMPRESS=NONE"])
    result.write(tmp_path / "c.tif")
    compression = [gdal.Open(str(tmp_path / n)).GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE") for n in ("a.tif", "b.tif", "c.tif")]
    assert compression[0] == "LZW" and compression[1] is None and compression[2] in ("ZSTD", "DEFLATE")
    with pytest.raises((ValueError, OSError), match="NONSENSE"):
        result.write(tmp_path / "d.tif", creation_options={"COMPRESS": "NONSENSE"})
    assert not (tmp_path / "d.tif").exists()


def test_replaces_the_old_file(result, tmp_path):
    target = tmp_path / "a.tif"
    target.write_bytes(b"old")
    Path(str(target) + ".aux.xml").write_text("<PAMDataset/>")
    result.write(target)
    assert np.array_equal(read(target)[2], result.confidence, equal_nan=True)
    assert [p.name for p in tmp_path.iterdir()] == ["a.tif"]


def test_cancelled_keeps_the_old_file(result, tmp_path):
    target = tmp_path / "a.tif"
    target.write_bytes(b"old")
    with pytest.raises(sb.Cancelled):
        result.write(target, verdict=tmp_path / "b.tif", progress=lambda fraction: False)
    assert target.read_bytes() == b"old" and [p.name for p in tmp_path.iterdir()] == ["a.tif"]


def test_all_or_none(result, tmp_path):
    """The second file cannot be written: the first does not appear."""
    (tmp_path / "b.tif").mkdir()
    with pytest.raises(OSError, match="b.tif"):
        result.write(tmp_path / "a.tif", verdict=tmp_path / "b.tif")
    assert [p.name for p in tmp_path.iterdir()] == ["b.tif"]


def test_full_disk(tmp_path):
    """A limit on the size of files stands in for a full disk (the same failing write to GDAL)."""
    (tmp_path / "a.tif").write_bytes(b"old")
    script = f"""
import resource, signal, sys
sys.path.insert(0, {str(Path(sb.__file__).resolve().parent.parent)!r})
import numpy as np, sightbound as sb
z = np.random.default_rng(0).uniform(0, 90, (900, 900)).astype(np.float32)
result = sb.viewshed(sb.Dem(z, (0, 10, 0, 9000, 0, -10)), [(4505, 4505)], observer_height=500.0, error_model=sb.ErrorModel(40.0, 0, 0))
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))
try:
    result.write({str(tmp_path / 'a.tif')!r}, verdict={str(tmp_path / 'b.tif')!r}, creation_options=dict(COMPRESS='NONE'))
except OSError as error:
    print('OSError', error)
"""
    out = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=True).stdout
    assert out.startswith("OSError") and "a.tif" in out
    assert [p.name for p in tmp_path.iterdir()] == ["a.tif"] and (tmp_path / "a.tif").read_bytes() == b"old"


def test_killed_in_the_middle_leaves_no_target(tmp_path):
    """However a run ends, nothing half-written bears the target's name."""
    script = f"""
import os, sys
sys.path.insert(0, {str(Path(sb.__file__).resolve().parent.parent)!r})
import numpy as np, sightbound as sb
z = np.random.default_rng(0).uniform(0, 90, (1500, 1500)).astype(np.float32)
result = sb.viewshed(sb.Dem(z, (0, 10, 0, 15000, 0, -10)), [(7505, 7505)], observer_height=500.0, error_model=sb.ErrorModel(40.0, 0, 0))
calls = []
def progress(fraction):
    calls.append(fraction)
    if fraction > 0.2: os._exit(3)
result.write({str(tmp_path / 'a.tif')!r}, progress=progress, creation_options=dict(COMPRESS='DEFLATE', ZLEVEL='9'))
"""
    code = subprocess.run([sys.executable, "-c", script], timeout=60).returncode
    assert code in (0, 3)
    assert (tmp_path / "a.tif").exists() == (code == 0)


def test_error_surfaces(tmp_path):
    dem = sb.Dem(terrains.fractal((30, 40), 164), UTM_GT, rasters.wkt_of(UTM))
    surfaces = sb.error_surfaces(dem, sb.ErrorModel(0.5, 0, 0))
    surfaces.write(sigma=tmp_path / "s.tif", lower=tmp_path / "l.tif", upper=tmp_path / "u.tif")
    for name, array in (("s", surfaces.sigma), ("l", surfaces.lower), ("u", surfaces.upper)):
        dataset, band, values = read(tmp_path / f"{name}.tif")
        assert np.array_equal(values, array) and np.isnan(band.GetNoDataValue()) and "SIGHTBOUND_ERROR_MODEL" in dataset.GetMetadata()
    with pytest.raises(ValueError, match="(?i)nothing to write"):
        surfaces.write()
