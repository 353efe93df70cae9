# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of a result: their values, what they say of themselves, and all of them or none."""
import json
import os
from pathlib import Path

import numpy as np
import pytest
import sightbound as sb
from osgeo import gdal

NORTH_UP = (500.0, 10.0, 0.0, 900.0, 0.0, -10.0)
SOUTH_UP = (500.0, 10.0, 0.0, 600.0, 0.0, 10.0)
MODEL = sb.ErrorModel(0.5, 0, 0)


@pytest.fixture(params=[NORTH_UP, SOUTH_UP], ids=["north up", "south up"])
def result(request):
    z = (np.arange(1200).reshape(30, 40) % 37).astype(np.float32)
    z[2, 3] = np.nan
    return sb.viewshed(sb.Dem(z, request.param), [(655, 755), (605, 705)], observer_height=[2, 3], target_height=1.5, error_model=MODEL,
                       heights=True, refraction=0.2, stand="ground", combine="worst")


def read(path):
    dataset = gdal.Open(str(path))
    band = dataset.GetRasterBand(1)
    labels = band.GetDescription(), band.GetUnitType()
    return dataset.ReadAsArray(), band.GetNoDataValue(), dataset.GetGeoTransform(), dataset.GetMetadata(), labels


def test_all_rasters(result, tmp_path):
    names = dict(confidence="confidence", verdict="verdict", count="count", height="lowest_visible_height", likely_height="likely_visible_height")
    result.write(**{name: tmp_path / f"{name}.tif" for name in names})
    nodata = dict(verdict=255, count=4294967295)
    for name, of_result in names.items():
        values, none, geotransform, metadata, labels = read(tmp_path / f"{name}.tif")
        assert np.array_equal(values, getattr(result, of_result), equal_nan=name not in nodata)
        assert none == nodata[name] if name in nodata else np.isnan(none)
        assert geotransform == pytest.approx(result.geotransform)
        assert labels == (metadata["SIGHTBOUND_QUANTITY"], "m" if "height" in name else "")
    assert sorted(os.listdir(tmp_path)) == sorted(f"{name}.tif" for name in names)


def test_a_file_says_how_it_was_made(result, tmp_path):
    result.write(tmp_path / "c.tif")
    said = read(tmp_path / "c.tif")[3]
    assert said["SIGHTBOUND_VERSION"] == sb.__version__ == result.report["version"]
    assert "pointwise confidence of visibility" in said["SIGHTBOUND_QUANTITY"]
    assert (said["SIGHTBOUND_CONFIDENCE"], said["SIGHTBOUND_REFRACTION"], said["SIGHTBOUND_CURVATURE"]) == ("0.95", "0.2", "yes")
    assert (said["SIGHTBOUND_STAND"], said["SIGHTBOUND_COMBINE"], said["SIGHTBOUND_OBSERVERS"]) == ("ground", "worst", "2")
    assert (said["SIGHTBOUND_OBSERVER_HEIGHT"], said["SIGHTBOUND_TARGET_HEIGHT"]) == ("varies", "1.5")
    assert said["SIGHTBOUND_ERROR_MODEL"] == result.report["error_model"]
    assert json.loads(said["SIGHTBOUND_ERROR_MODEL"]) == json.loads(MODEL.to_json())
    assert "no CRS" in said["SIGHTBOUND_WARNINGS"]


def test_a_written_model_is_read_back(result, tmp_path):
    result.write(tmp_path / "c.tif")
    again = sb.ErrorModel.from_json(read(tmp_path / "c.tif")[3]["SIGHTBOUND_ERROR_MODEL"])
    assert again.to_json() == MODEL.to_json()
    (tmp_path / "model.json").write_text(MODEL.to_json())
    assert sb.ErrorModel.from_json(tmp_path / "model.json").to_json() == MODEL.to_json()


def test_error_surfaces(tmp_path):
    surfaces = sb.error_surfaces(sb.Dem(np.zeros((20, 20)), NORTH_UP), MODEL, confidence=0.9)
    surfaces.write(tmp_path / "sigma.tif", lower=tmp_path / "lower.tif", upper=str(tmp_path / "upper.tif"))
    for name in ("sigma", "lower", "upper"):
        values, _, geotransform, metadata, labels = read(tmp_path / f"{name}.tif")
        assert np.array_equal(values, getattr(surfaces, name)) and geotransform == NORTH_UP
        assert metadata["SIGHTBOUND_CONFIDENCE"] == "0.9" and labels[1] == "m"


def test_one_that_fails_takes_the_others_along(result, tmp_path):
    kept = tmp_path / "verdict.tif"
    kept.write_text("what stood here before")
    with pytest.raises(OSError, match="nowhere"):
        result.write(tmp_path / "c.tif", verdict=kept, count=tmp_path / "nowhere" / "n.tif")
    assert os.listdir(tmp_path) == ["verdict.tif"] and kept.read_text() == "what stood here before"


def test_cancelled_writing_leaves_nothing(result, tmp_path):
    asked = []

    def progress(fraction):
        asked.append(fraction)
        return False

    with pytest.raises(sb.Cancelled):
        result.write(tmp_path / "c.tif", verdict=tmp_path / "v.tif", progress=progress)
    assert asked == [0.0] and os.listdir(tmp_path) == []


def test_progress_of_writing(result, tmp_path):
    heard = []
    result.write(tmp_path / "c.tif", verdict=tmp_path / "v.tif", progress=heard.append)
    assert heard[-1] == 1.0 and heard == sorted(heard)


@pytest.mark.parametrize("options", [{"COMPRESS": "LZW", "TILED": "NO"}, ["COMPRESS=LZW", "TILED=NO"], ("COMPRESS=LZW",)], ids=str)
def test_creation_options(result, tmp_path, options):
    result.write(tmp_path / "c.tif", creation_options=options)
    assert gdal.Open(str(tmp_path / "c.tif")).GetMetadata("IMAGE_STRUCTURE")["COMPRESSION"] == "LZW"


@pytest.mark.parametrize("options", ["COMPRESS=LZW", ["COMPRESS"], [1], 5, ["=LZW"]], ids=str)
def test_wrong_creation_options(result, tmp_path, options):
    with pytest.raises(ValueError, match="creation_options.*COMPRESS"):
        result.write(tmp_path / "c.tif", creation_options=options)


def test_paths_beyond_ascii(result, tmp_path):
    target = tmp_path / "Überhöhung 山.tif"
    result.write(target)
    assert [name.name for name in Path(tmp_path).iterdir()] == [target.name]
    assert sb.read_dem(target).shape == result.shape
