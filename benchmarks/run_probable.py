# SPDX-License-Identifier: GPL-3.0-or-later
"""One whole run for timing: run_probable.py ours <dem.tif> <probability.tif> [--refinement 0] [--precision 0.03]
or run_probable.py noise <dem.tif> <copy.tif> <seed>: the DEM with normal errors of 1 m, for gdal_viewshed.

Observer in the middle of the raster, 1.7 m up, targets 1.7 m up, the whole raster asked, 1000 realisations at most, the error
learnt from the DEM.
"""

import argparse

import numpy as np
from osgeo import gdal


def ours(options):
    import sightbound as sb

    dem = sb.read_dem(options.dem)
    rows, cols = dem.shape
    x0, dx, _, y0, _, dy = dem.geotransform
    middle = (x0 + (cols // 2 + 0.5) * dx, y0 + (rows // 2 + 0.5) * dy)
    result = sb.probable_viewshed(dem, [middle], 1.7, 1.7, refinement=options.refinement, precision=options.precision)
    result.write(options.out)


def noise(options):
    source = gdal.Open(options.dem)
    heights = source.ReadAsArray()
    copy = gdal.GetDriverByName("GTiff").Create(options.out, source.RasterXSize, source.RasterYSize, 1, gdal.GDT_Float32)
    copy.SetGeoTransform(source.GetGeoTransform())
    copy.SetProjection(source.GetProjection())
    errors = np.random.default_rng(options.seed).standard_normal(heights.shape, dtype=np.float32)
    copy.GetRasterBand(1).WriteArray(heights + errors)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    kinds = parser.add_subparsers(required=True)
    for kind in (ours, noise):
        one = kinds.add_parser(kind.__name__)
        one.set_defaults(run=kind)
        one.add_argument("dem")
        one.add_argument("out")
        one.add_argument("--refinement", type=int, default=1)
        one.add_argument("--precision", type=float, default=0.03)
        one.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    options.run(options)


if __name__ == "__main__":
    main()
