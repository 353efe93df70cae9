#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the analytic scenes: small DEMs whose answers are known in closed form (README.md beside this file).

    make_analytic_scenes.py [FOLDER]    default: analytic/ beside this script

All are 65 x 65 samples, 10 m apart, EPSG:32632, with sample (32, 32) at (500000, 5000000) on the central meridian.
"""

import sys
from pathlib import Path

import numpy as np
from osgeo import gdal, osr

gdal.UseExceptions()

SIZE, MIDDLE, CELL = 65, 32, 10.0
GEOTRANSFORM = (500000.0 - (MIDDLE + 0.5) * CELL, CELL, 0.0, 5000000.0 + (MIDDLE + 0.5) * CELL, 0.0, -CELL)

col, row = np.meshgrid(np.arange(SIZE), np.arange(SIZE))
radius = CELL * np.hypot(col - MIDDLE, row - MIDDLE)

SCENES = {
    "plane": np.full((SIZE, SIZE), 100.0),
    "ridge": np.where(col == 40, 120.0, 100.0),
    "cone": 300.0 - 0.5 * radius,
    "step": np.where(col >= MIDDLE, 150.0, 100.0),
    "sphere": np.sqrt(1000.0**2 - radius**2),
}


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent / "analytic"
    folder.mkdir(parents=True, exist_ok=True)
    srs = osr.SpatialReference()
    srs.ImportFromEPSG(32632)
    for name, heights in SCENES.items():
        out = gdal.GetDriverByName("GTiff").Create(
            str(folder / f"{name}.tif"), SIZE, SIZE, 1, gdal.GDT_Float32, ["COMPRESS=DEFLATE", "PREDICTOR=3"])
        out.SetGeoTransform(GEOTRANSFORM)
        out.SetProjection(srs.ExportToWkt())
        band = out.GetRasterBand(1)
        band.SetNoDataValue(-9999)
        band.SetUnitType("m")
        band.WriteArray(heights.astype(np.float32))


if __name__ == "__main__":
    main()
