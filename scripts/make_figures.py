# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw docs/images/viewshed.png, the README's picture, from a real run on the sample DEM.

    scripts/build.sh && PYTHONPATH=build/python /usr/bin/python3 scripts/make_figures.py

Both viewsheds look from the sample's fire tower at ground level over 12 km, on the sample DEM brought to UTM (an ordinary
viewshed needs metres); the error of the DEM is estimated from the DEM itself.
"""

import tempfile
from pathlib import Path

import maps
import sightbound as sb
from osgeo import gdal, ogr, osr

gdal.UseExceptions()
ogr.UseExceptions()

ROOT = Path(__file__).resolve().parent.parent
UTM = "EPSG:32616"
CELL = 80.0  # metres: the sample's 3" are 74 x 92 m
OBSERVER = "Fire tower"
REACH = 12000.0
TARGET_HEIGHT = 2.0
REFRACTION = 0.13


def observer_in_utm():
    """x, y in UTM, height of the eye above ground."""
    source = ogr.Open(str(ROOT / "sample_data" / "observers.gpkg"))
    layer = source.GetLayer(0)
    utm = osr.SpatialReference()
    utm.ImportFromEPSG(int(UTM.split(":")[1]))
    (feature,) = [f for f in layer if f["name"] == OBSERVER]
    point = feature.GetGeometryRef().Clone()
    point.TransformTo(utm)
    return point.GetX(), point.GetY(), feature["eye_height"]


def write_observer(path, x, y):
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    utm = osr.SpatialReference()
    utm.ImportFromEPSG(int(UTM.split(":")[1]))
    layer = source.CreateLayer("observer", utm, ogr.wkbPoint)
    layer.CreateField(ogr.FieldDefn("name", ogr.OFTString))
    feature = ogr.Feature(layer.GetLayerDefn())
    feature["name"] = OBSERVER
    point = ogr.Geometry(ogr.wkbPoint)
    point.AddPoint_2D(x, y)
    feature.SetGeometry(point)
    layer.CreateFeature(feature)


def main():
    styles = ROOT / "qgis_plugin" / "styles"
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        dem_path = folder / "dem.tif"
        gdal.Warp(str(dem_path), str(ROOT / "sample_data" / "jacksboro.tif"), dstSRS=UTM, xRes=CELL, yRes=CELL,
                  resampleAlg="cubicspline", outputType=gdal.GDT_Float32, dstNodata=-9999)
        x, y, eye_height = observer_in_utm()

        result = sb.viewshed(sb.read_dem(dem_path), [(x, y)], observer_height=eye_height, target_height=TARGET_HEIGHT,
                             max_distance=REACH, refraction=REFRACTION)
        result.write(folder / "confidence.tif", verdict=folder / "verdict.tif")
        gdal.ViewshedGenerate(
            gdal.Open(str(dem_path)).GetRasterBand(1), "GTiff", str(folder / "ordinary.tif"), [], x, y, eye_height,
            TARGET_HEIGHT, 2, 0, 255, 255, 1.0 - REFRACTION, gdal.GVM_Edge, REACH)
        write_observer(folder / "observer.gpkg", x, y)

        application = maps.start()
        relief = maps.hillshade(dem_path, folder)
        observer = maps.points(folder / "observer.gpkg", "Observer", "name")
        confidence = maps.raster(folder / "confidence.tif", "Confidence of being seen", styles / "confidence.qml")
        ordinary = maps.raster(folder / "ordinary.tif", "Ordinary viewshed", styles / "verdict.qml")
        visible, uncertain = (100.0 * result.report[f"{word}_share"] for word in ("visible", "uncertain"))
        maps.write_page(
            ROOT / "docs" / "images" / "viewshed.png",
            "",
            [
                maps.Panel([observer, relief], "The ground"),
                maps.Panel([observer, confidence, relief], "Sightbound",
                           f"Surely visible {visible:.1f} %, in doubt {uncertain:.1f} % (at 95 %)."),
                maps.Panel([observer, ordinary, relief], "An ordinary viewshed",
                           f"Visible {100.0 * visible_share(folder / 'ordinary.tif'):.1f} %, nothing in doubt."),
            ],
            [observer, confidence],
            extent=maps.around(x, y, REACH), footer="Terrain: U.S. Geological Survey, public domain. "
            "12 km around a fire tower on the Cumberland Mountains, Tennessee; target 2 m high.",
        )
        maps.stop(application)


def visible_share(path):
    values = gdal.Open(str(path)).ReadAsArray()
    return float((values == 2).sum()) / float((values != 255).sum())


if __name__ == "__main__":
    main()
