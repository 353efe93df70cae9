# SPDX-License-Identifier: GPL-3.0-or-later
"""Sightbound: what can be seen from here, and how sure are we?

    import sightbound as sb

    dem = sb.read_dem("dem.tif")
    result = sb.viewshed(dem, [(x, y)], observer_height=1.7, max_distance=5000)
    result.write("confidence.tif", verdict="verdict.tif")

Heights and distances are metres, angles degrees, positions coordinates of the DEM's CRS. Wrong arguments raise
ValueError, files that cannot be read or written OSError, jobs larger than the memory budget MemoryError, a stopped
job Cancelled. Jobs leave the interpreter to other threads while they run, and Ctrl-C stops them.
"""

from ._loading import core as _core
from .dem import Dem, read_dem
from .error_estimate import ErrorMaps, error_maps, estimate_error, write_corrected
from .error_model import ErrorModel, product_error, products, terrain_table, two_sided_quantile
from .error_surfaces import ErrorSurfaces, error_surfaces
from .hidden_volume import HiddenRasters, HiddenVolume
from .intervisibility import Intervisibility, intervisibility
from .line_of_sight import Fresnel, LineOfSight, WholeLine, line_of_sight, lines_of_sight
from .probable_viewshed import ProbableViewshed, probable_viewshed
from .simplify import SimplifiedTin, dem_to_tin, dem_to_tins, simplify
from .tin import Tin, read_tin, tin_layers
from .verification import Verification, verify
from .viewshed import viewshed, viewsheds
from .viewshed_result import ViewshedResult
from .visibility_tolerance import visibility_tolerance
from .volume import CoverRasters, ErrorVolume
from .volume_sight import Subtraction, estimate_volume_viewshed, subtract_observer, volume_viewshed
from .volume_targets import TargetSight, VolumeLayer, volume_layer, volume_targets

Cancelled = _core.Cancelled
defaults = _core.defaults
__version__: str = _core.__version__


def gdal_version() -> str:
    """The version of the GDAL library in use, such as "3.6.2"."""
    return _core.gdal_versions()[1]


__all__ = [
    "Cancelled",
    "CoverRasters",
    "Dem",
    "ErrorMaps",
    "ErrorModel",
    "ErrorSurfaces",
    "ErrorVolume",
    "Fresnel",
    "HiddenRasters",
    "HiddenVolume",
    "Intervisibility",
    "LineOfSight",
    "ProbableViewshed",
    "SimplifiedTin",
    "Subtraction",
    "TargetSight",
    "Tin",
    "Verification",
    "ViewshedResult",
    "VolumeLayer",
    "WholeLine",
    "defaults",
    "dem_to_tin",
    "dem_to_tins",
    "error_maps",
    "error_surfaces",
    "estimate_error",
    "estimate_volume_viewshed",
    "gdal_version",
    "intervisibility",
    "line_of_sight",
    "lines_of_sight",
    "probable_viewshed",
    "product_error",
    "products",
    "read_dem",
    "read_tin",
    "simplify",
    "subtract_observer",
    "terrain_table",
    "tin_layers",
    "two_sided_quantile",
    "verify",
    "viewshed",
    "viewsheds",
    "visibility_tolerance",
    "volume_layer",
    "volume_targets",
    "volume_viewshed",
    "write_corrected",
]
