# SPDX-License-Identifier: GPL-3.0-or-later
"""Make a fractal DEM for timing: make_fractal_dem.py <cells a side> <out.tif> [seed].

Power-law spectrum with Hurst exponent 0.85, heights from 0 m up with a standard deviation of 150 m, 10 m cells in EPSG:32632,
Float32, tiled, DEFLATE with the floating-point predictor.
"""

import sys

import numpy as np
import scipy.fft
from osgeo import gdal, osr

gdal.UseExceptions()

HURST = 0.85
DEVIATION = 150.0
CELL = 10.0


def fractal(cells, seed):
    """Float32 [cells, cells]: white noise, its spectrum scaled by frequency ** -(HURST + 1)."""
    random = np.random.default_rng(seed)
    shape = (cells, cells // 2 + 1)
    spectrum = np.empty(shape, np.complex64)
    spectrum.real = random.standard_normal(shape, dtype=np.float32)
    spectrum.imag = random.standard_normal(shape, dtype=np.float32)
    along_rows = np.fft.rfftfreq(cells).astype(np.float32) ** 2
    for row, frequency in enumerate(np.fft.fftfreq(cells)):
        squared = along_rows + np.float32(frequency * frequency)
        if row == 0:
            squared[0] = np.inf  # the mean
        spectrum[row] *= squared ** (-0.5 * (HURST + 1.0))
    heights = scipy.fft.irfft2(spectrum, s=(cells, cells), overwrite_x=True, workers=-1)
    heights -= heights.min()
    heights *= DEVIATION / heights.std(dtype=np.float64)
    return heights


def main():
    cells, path = int(sys.argv[1]), sys.argv[2]
    heights = fractal(cells, int(sys.argv[3]) if len(sys.argv) > 3 else 42)
    srs = osr.SpatialReference()
    srs.ImportFromEPSG(32632)
    out = gdal.GetDriverByName("GTiff").Create(
        path, cells, cells, 1, gdal.GDT_Float32, ["TILED=YES", "COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=6"])
    out.SetGeoTransform((500000.0, CELL, 0.0, 5000000.0, 0.0, -CELL))
    out.SetProjection(srs.ExportToWkt())
    out.GetRasterBand(1).SetNoDataValue(-9999)
    out.GetRasterBand(1).WriteArray(heights)


if __name__ == "__main__":
    main()
