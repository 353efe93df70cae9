# SPDX-License-Identifier: GPL-3.0-or-later
"""One whole run for timing: run_viewshed.py <dem.tif> <confidence.tif> <verdict.tif> [--estimate].

Observer in the middle of the raster, 2 m up, the whole raster asked. The error is given (1 m RMSE, nothing between the
samples), or with --estimate learnt from the DEM.
"""

import sys

import sightbound as sb


def main():
    paths = [argument for argument in sys.argv[1:] if not argument.startswith("--")]
    model = None if "--estimate" in sys.argv else sb.ErrorModel(vertical_rmse=1.0, geologic_variation=0.0)
    dem = sb.read_dem(paths[0])
    rows, cols = dem.shape
    x0, dx, _, y0, _, dy = dem.geotransform
    middle = (x0 + (cols // 2 + 0.5) * dx, y0 + (rows // 2 + 0.5) * dy)
    result = sb.viewshed(dem, [middle], observer_height=2.0, error_model=model)
    result.write(paths[1], verdict=paths[2])


if __name__ == "__main__":
    main()
