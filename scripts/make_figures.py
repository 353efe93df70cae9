# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw docs/images/viewshed.png, the README's picture, from a real run on the sample DEM.

    scripts/build.sh && PYTHONPATH=build/python /usr/bin/python3 scripts/make_figures.py

Both viewsheds look from the sample's northern spur at 2 m targets, with the same samples. Sightbound takes the DEM as it is, in degrees,
and estimates its error from itself; an ordinary viewshed needs metres, so it gets the DEM in the equirectangular projection
of its middle latitude, where cells in degrees stay cells and nothing is resampled.
"""

import math
import shutil
import tempfile
from pathlib import Path

import maps
import sightbound as sb
from osgeo import gdal, ogr, osr

gdal.UseExceptions()
ogr.UseExceptions()

ROOT = Path(__file__).resolve().parent.parent
DEM = ROOT / "sample_data" / "jacksboro.tif"
OBSERVERS = ROOT / "sample_data" / "observers.gpkg"
OBSERVER = "Northern spur"
WINDOW = (0.28, 0.42, 0.95, 0.975)  # what the maps show of the DEM
TARGET_HEIGHT = 2.0
REFRACTION = 0.13


def observer():
    """Longitude, latitude, height of the eye above ground."""
    source = ogr.Open(str(OBSERVERS))
    ((lon, lat, eye_height),) = [(f.GetGeometryRef().GetX(), f.GetGeometryRef().GetY(), f["eye_height"])
                                 for f in source.GetLayer(0) if f["name"] == OBSERVER]
    return lon, lat, eye_height


def run_sightbound(folder, lon, lat, eye_height):
    """Shares of visible, uncertain, hidden, and the verdict; the raster is confidence.tif."""
    result = sb.viewshed(sb.read_dem(str(DEM)), [(lon, lat)], observer_height=eye_height, target_height=TARGET_HEIGHT,
                         refraction=REFRACTION)
    result.write(str(folder / "confidence.tif"))
    return [result.report[f"{word}_share"] for word in ("visible", "uncertain", "hidden")], result.verdict


def run_ordinary(folder, lon, lat, eye_height):
    """Which cells are visible; the raster is ordinary.tif, coded like a verdict."""
    degrees = gdal.Open(str(DEM))
    left, width, _, top, _, height = degrees.GetGeoTransform()
    middle = top + 0.5 * degrees.RasterYSize * height
    metres = osr.SpatialReference()
    metres.ImportFromProj4(f"+proj=eqc +lat_ts={middle} +datum=WGS84 +units=m")
    across, down = (math.radians(1.0) * metres.GetSemiMajor() * share for share in (math.cos(math.radians(middle)), 1.0))
    dem = gdal.Translate(str(folder / "metres.tif"), degrees, outputType=gdal.GDT_Float32)
    dem.SetProjection(metres.ExportToWkt())
    dem.SetGeoTransform((left * across, width * across, 0.0, top * down, 0.0, height * down))
    ordinary = gdal.ViewshedGenerate(
        dem.GetRasterBand(1), "GTiff", str(folder / "ordinary.tif"), [], lon * across, lat * down, eye_height,
        TARGET_HEIGHT, 2, 0, 255, 255, 1.0 - REFRACTION, gdal.GVM_Edge, 0.0)
    return ordinary.ReadAsArray() == 2


def draw(folder, shares, verdict, seen):
    styles = ROOT / "qgis_plugin" / "styles"
    relief = maps.hillshade(DEM, folder)
    copy = shutil.copy(OBSERVERS, folder)  # QGIS writes into a GeoPackage even when it only reads
    place = maps.points(copy, "Observer", "name")
    place.setSubsetString(f"name = '{OBSERVER}'")
    confidence = maps.raster(folder / "confidence.tif", "Confidence of being seen", styles / "confidence.qml")
    ordinary = maps.raster(folder / "ordinary.tif", "Ordinary viewshed", styles / "verdict.qml")
    maps.write_page(
        ROOT / "docs" / "images" / "viewshed.png",
        "",
        [
            maps.Panel([place, confidence, relief], "Sightbound",
                       "Surely visible {:.1f} %, in doubt {:.1f} %, surely hidden {:.1f} %.".format(*(100.0 * s for s in shares))),
            maps.Panel([place, ordinary, relief], "An ordinary viewshed",
                       f"Visible {100.0 * seen.mean():.1f} %. That {100.0 * (verdict[seen] != 2).mean():.0f} % of it is in doubt, "
                       "it does not say."),
        ],
        [place, confidence],
        window=WINDOW, width_mm=260.0,
        footer="Terrain: U.S. Geological Survey, public domain. Eye 1.7 m, targets 2 m above ground; 3″ cells.",
    )


def main():
    place = observer()
    application = maps.start()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        draw(folder, *run_sightbound(folder, *place), run_ordinary(folder, *place))
    maps.stop(application)


if __name__ == "__main__":
    main()
