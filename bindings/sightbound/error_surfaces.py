# SPDX-License-Identifier: GPL-3.0-or-later
"""The error volume of a DEM as rasters."""

from __future__ import annotations

from . import _arguments as arguments
from ._loading import core
from .dem import Dem, core_dem
from .error_model import ErrorModel, core_model

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from ._arguments import Box, CreationOptions, FloatArray, Geotransform, Path, Progress

_DEFAULTS = core.defaults()


class ErrorSurfaces:
    """float32 arrays [rows, cols], metres, NaN for nodata, in the row order of the DEM's file or array; read-only."""

    __slots__ = ("_core", "_options")

    def __init__(self, result: core.ErrorSurfaces, options: core.ErrorSurfacesOptions) -> None:
        self._core = result
        self._options = options

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, cols)."""
        return self._core.rows, self._core.cols

    @property
    def sigma(self) -> FloatArray:
        """The largest standard deviation within half a cell of the sample."""
        return self._core.sigma

    @property
    def lower(self) -> FloatArray:
        """Height - z sigma: with the asked confidence no ground of the cell lies lower."""
        return self._core.lower

    @property
    def upper(self) -> FloatArray:
        """Height + z sigma."""
        return self._core.upper

    @property
    def geotransform(self) -> Geotransform:
        """GDAL's six numbers of these rasters."""
        return self._core.geotransform

    @property
    def crs_wkt(self) -> str | None:
        """The DEM's CRS as WKT; None when there is none."""
        return self._core.crs_wkt or None

    @property
    def report(self) -> dict[str, Any]:
        """error_model (the model used, as JSON), warnings (list of texts), version."""
        return {
            "error_model": self._core.error_model,
            "warnings": self._core.warnings,
            "version": core.__version__,
        }

    def write(
        self,
        sigma: Path | None = None,
        lower: Path | None = None,
        upper: Path | None = None,
        creation_options: CreationOptions = None,
        progress: Progress | None = None,
    ) -> None:
        """Writes the rasters whose paths are given as GeoTIFF: all of them, or none if one fails.

        Raises:
            ValueError: no path, one path twice.
            OSError: a file cannot be written.
            Cancelled: progress returned False.
        """
        files = core.ErrorSurfaceFiles()
        files.sigma = arguments.path("sigma", sigma)
        files.lower = arguments.path("lower", lower)
        files.upper = arguments.path("upper", upper)
        files.creation_options = arguments.creation_options(creation_options)
        core.write_error_surfaces(self._core, self._options, files, progress)

    def __repr__(self) -> str:
        rows, cols = self.shape
        return f"<sightbound.ErrorSurfaces: {rows} x {cols}>"


def error_surfaces(
    dem: Dem,
    error_model: ErrorModel | None = None,
    confidence: float = _DEFAULTS["confidence"],
    extent: Box | None = None,
    threads: int | None = None,
    memory_budget: int | None = None,
    progress: Progress | None = None,
) -> ErrorSurfaces:
    """Computes the standard deviation of each cell, and the surfaces between which the ground lies.

    Args:
        dem: from read_dem() or Dem().
        error_model: None estimates the DEM's error from the DEM.
        confidence: that the ground at a place lies between lower and upper, between 0 and 1.
        extent: (x_min, y_min, x_max, y_max) in the DEM's CRS, snapped to its cells; None for the whole DEM.
        threads: None for all cores.
        memory_budget: bytes; None for three quarters of the memory.
        progress: called with the fraction done, at most ten times a second; False cancels.

    Raises:
        ValueError: a wrong argument.
        OSError: a file cannot be read.
        MemoryError: the job would exceed the memory budget.
        Cancelled: progress returned False.
    """
    options = core.ErrorSurfacesOptions()
    options.confidence = arguments.number("confidence", confidence)
    options.extent = arguments.extent(extent)
    options.threads = arguments.threads(threads)
    options.memory_budget = arguments.memory_budget(memory_budget)
    return ErrorSurfaces(core.error_surfaces(core_dem(dem), core_model(error_model, dem), options, progress), options)
