#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the real sample DEM, its observers and its terrain types (origin and licence: README.md beside this file).

    make_sample_data.py [FOLDER]        default: the folder of this script

The heights come from jacksboro_fault_dem.npz, which matplotlib ships as sample data (Debian: python-matplotlib-data).
The files are committed; run this only to see how they came about, or to make them again.
"""

import os
import sys
from pathlib import Path

os.environ["OGR_CURRENT_DATE"] = "2026-01-01T00:00:00.000Z"  # GeoPackage: same bytes at every run

import matplotlib.cbook
import numpy as np
from osgeo import gdal, ogr, osr

gdal.UseExceptions()

# Longitude, latitude, name, height of the eye above ground in metres, how far one looks in metres.
OBSERVERS = [
    (-84.23083, 36.48500, "Summit", 1.7, 20000.0),  # 1076 m, the highest sample
    (-84.27250, 36.62583, "Fire tower", 15.0, 20000.0),
    (-84.17583, 36.69667, "Northern spur", 1.7, 12000.0),
    (-84.15500, 36.52500, "Valley road", 1.7, 8000.0),
]
BLOCK = 16  # samples; terrain types are told apart block by block
MOUNTAIN_RELIEF = 150.0  # metres between the highest and the lowest sample of a block


def wgs84():
    srs = osr.SpatialReference()
    srs.ImportFromEPSG(4326)
    srs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return srs


def read_jacksboro():
    """Heights (int16, metres, row 0 in the north) and geotransform; the npz's bounds are edges of cells and its
    `ymin` is the northern one."""
    data = matplotlib.cbook.get_sample_data("jacksboro_fault_dem.npz", np_load=True)
    heights = data["elevation"]
    rows, cols = heights.shape
    west, north = float(data["xmin"]), max(float(data["ymin"]), float(data["ymax"]))
    east, south = float(data["xmax"]), min(float(data["ymin"]), float(data["ymax"]))
    return heights, (west, (east - west) / cols, 0.0, north, 0.0, (south - north) / rows)


def write_dem(path, heights, geotransform):
    rows, cols = heights.shape
    out = gdal.GetDriverByName("GTiff").Create(
        str(path), cols, rows, 1, gdal.GDT_Int16, ["COMPRESS=DEFLATE", "PREDICTOR=2", "ZLEVEL=9", "TILED=YES"])
    out.SetGeoTransform(geotransform)
    out.SetProjection(wgs84().ExportToWkt())
    out.SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", "Elevation around the Jacksboro fault, Tennessee. USGS, public domain.")
    band = out.GetRasterBand(1)
    band.SetNoDataValue(-32768)
    band.SetUnitType("m")
    band.SetDescription("elevation")
    band.WriteArray(heights)


def write_observers(path):
    path.unlink(missing_ok=True)
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = source.CreateLayer("observers", wgs84(), ogr.wkbPoint)
    for name, kind in (("name", ogr.OFTString), ("eye_height", ogr.OFTReal), ("max_distance", ogr.OFTReal)):
        layer.CreateField(ogr.FieldDefn(name, kind))
    for lon, lat, name, eye_height, max_distance in OBSERVERS:
        feature = ogr.Feature(layer.GetLayerDefn())
        feature["name"], feature["eye_height"], feature["max_distance"] = name, eye_height, max_distance
        point = ogr.Geometry(ogr.wkbPoint)
        point.AddPoint_2D(lon, lat)
        feature.SetGeometry(point)
        layer.CreateFeature(feature)


def variation_between_samples(heights, where):
    """Delta (metres, at 95 %) of the samples in `where`: leave out every other sample of the rows, interpolate it from
    its neighbours, and halve the error seen, since it grows about in proportion to the spacing."""
    z = heights.astype(float)
    residual = z[:, 1:-1] - 0.5 * (z[:, :-2] + z[:, 2:])
    return round(float(0.5 * 1.96 * np.sqrt(np.mean(residual[where[:, 1:-1]] ** 2))), 1)


def write_terrain_types(path, heights, geotransform):
    rows, cols = heights.shape
    classes = np.zeros((rows, cols), np.uint8)
    for r in range(0, rows, BLOCK):
        for c in range(0, cols, BLOCK):
            block = heights[r:r + BLOCK, c:c + BLOCK]
            classes[r:r + BLOCK, c:c + BLOCK] = 2 if np.ptp(block) > MOUNTAIN_RELIEF else 1
    variation = {code: variation_between_samples(heights, classes == code) for code in (1, 2)}
    names = {1: "grassland", 2: "craggy"}

    raster = gdal.GetDriverByName("MEM").Create("", cols, rows, 1, gdal.GDT_Byte)
    raster.SetGeoTransform(geotransform)
    raster.SetProjection(wgs84().ExportToWkt())
    raster.GetRasterBand(1).WriteArray(classes)
    path.unlink(missing_ok=True)
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = source.CreateLayer("terrain_types", wgs84(), ogr.wkbPolygon)
    layer.CreateField(ogr.FieldDefn("code", ogr.OFTInteger))
    layer.CreateField(ogr.FieldDefn("terrain", ogr.OFTString))
    layer.CreateField(ogr.FieldDefn("variation_m", ogr.OFTReal))
    gdal.Polygonize(raster.GetRasterBand(1), None, layer, 0)
    for feature in layer:
        feature["terrain"], feature["variation_m"] = names[feature["code"]], variation[feature["code"]]
        layer.SetFeature(feature)


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent
    folder.mkdir(parents=True, exist_ok=True)
    heights, geotransform = read_jacksboro()
    write_dem(folder / "jacksboro.tif", heights, geotransform)
    write_observers(folder / "observers.gpkg")
    write_terrain_types(folder / "terrain_types.gpkg", heights, geotransform)


if __name__ == "__main__":
    main()
