# SPDX-License-Identifier: GPL-3.0-or-later
"""Elevation models: from a file that GDAL reads, or from an array."""

from __future__ import annotations

from . import _arguments as arguments
from ._loading import core

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    import numpy.typing as npt

    from ._arguments import Box, FloatArray, Geotransform, Path

_DEFAULTS = core.defaults()


class Dem:
    """A regular grid of heights; the terrain runs through its cell centres.

    Args:
        heights: array [rows, cols] of at least 2 x 2 heights. A C-contiguous float32 array is used in place, so do not
            change it while a job runs; anything else is converted once. NaN, infinite and masked heights are nodata.
        geotransform: GDAL's six numbers, from pixel corners to the CRS: x = g[0] + col g[1] + row g[2],
            y = g[3] + col g[4] + row g[5]. Any orientation.
        crs_wkt: the CRS as WKT; None for a plane in metres.
        nodata: the height that stands for no data, besides NaN.
        vertical_unit: unit of `heights`: "metre", "foot" or "us-foot".

    Raises:
        ValueError: wrong shape, type or unit, a geotransform that cannot be inverted.
    """

    __slots__ = ("_core", "_ground", "_vertical_unit")

    _core: core.DemSource
    _ground: Dem | None
    _vertical_unit: str

    def __init__(
        self,
        heights: npt.ArrayLike,
        geotransform: Sequence[float],
        crs_wkt: str | None = None,
        nodata: float | None = None,
        vertical_unit: str = "metre",
    ) -> None:
        if vertical_unit == "auto":
            raise ValueError("vertical_unit is 'auto', which needs a file; an array's is 'metre', 'foot' or 'us-foot'.")
        coefficients = arguments.listed(geotransform)
        if coefficients is None or len(coefficients) != 6:
            raise ValueError(f"geotransform is {geotransform!r}; it must be GDAL's six numbers.")
        self._core = core.array_dem(
            _contiguous(heights),
            [arguments.number("geotransform", one) for one in coefficients],
            crs_wkt or "",
            None if nodata is None else float(nodata),
            arguments.word("vertical_unit", vertical_unit),
        )
        self._ground = None
        self._vertical_unit = vertical_unit

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, cols)."""
        return self._core.rows, self._core.cols

    @property
    def geotransform(self) -> Geotransform:
        """GDAL's six numbers, in the row order of the file or array."""
        return self._core.geotransform

    @property
    def crs_wkt(self) -> str | None:
        """The CRS as WKT; None when there is none."""
        return self._core.crs_wkt or None

    @property
    def vertical_unit(self) -> str:
        """The unit that was asked for: "auto", "metre", "foot" or "us-foot". `heights` are metres whatever it is."""
        return self._vertical_unit

    @property
    def notes(self) -> list[str]:
        """What was assumed or converted when the DEM was opened."""
        return self._core.notes

    @property
    def extent(self) -> Box:
        """(x_min, y_min, x_max, y_max) of the cells' outer edges, in the CRS."""
        rows, cols = self.shape
        g = self.geotransform
        corners = [(col, row) for col in (0, cols) for row in (0, rows)]
        xs = [g[0] + col * g[1] + row * g[2] for col, row in corners]
        ys = [g[3] + col * g[4] + row * g[5] for col, row in corners]
        return min(xs), min(ys), max(xs), max(ys)

    @property
    def heights(self) -> FloatArray:
        """All heights: a new float32 array [rows, cols], metres, NaN for nodata. Reads the whole file each time.

        Raises:
            OSError: the file cannot be read.
        """
        return self._core.heights()

    def __repr__(self) -> str:
        rows, cols = self.shape
        return f"<sightbound.Dem: {rows} x {cols}, extent {self.extent}>"


def read_dem(
    path: Path,
    band: int = _DEFAULTS["band"],
    vertical_unit: str = _DEFAULTS["vertical_unit"],
    ground: Path | Dem | None = None,
) -> Dem:
    """Opens a DEM. Heights are read later, by the jobs, and only where they are needed.

    Args:
        path: any raster that GDAL reads.
        band: the band of heights, from 1.
        vertical_unit: "auto" takes the unit of the CRS or of the band; "metre", "foot" and "us-foot" overrule it.
        ground: for a surface model, the bare ground (a Dem or a path) from which heights above ground count.

    Raises:
        OSError: the file cannot be opened.
        ValueError: no such band, no georeference, degrees without a CRS, an unknown unit.
    """
    if isinstance(band, bool) or not hasattr(band, "__index__"):
        raise ValueError(f"band is {band!r}; it must be a whole number, from 1.")
    dem = Dem.__new__(Dem)
    dem._core = core.open_dem(arguments.path("path", path), band, arguments.word("vertical_unit", vertical_unit))
    dem._ground = ground_dem(ground)
    dem._vertical_unit = vertical_unit
    return dem


def ground_dem(ground: Path | Dem | None) -> Dem | None:
    """The argument `ground` as a Dem."""
    return ground if ground is None or isinstance(ground, Dem) else read_dem(ground)


def core_dem(dem: Any) -> core.DemSource:
    """The compiled side of the argument `dem`."""
    if not isinstance(dem, Dem):
        raise TypeError(f"dem must be a sightbound.Dem, as read_dem() returns it; got {type(dem).__name__}.")
    return dem._core


def _contiguous(heights: Any) -> FloatArray:
    import numpy as np

    given = np.asanyarray(heights)
    if given.ndim != 2:
        raise ValueError(f"heights has shape {given.shape}; it must be a 2-D array [rows, cols].")
    if given.dtype.kind not in "iuf":
        raise ValueError(f"heights has type {given.dtype}; it must be an array of real numbers.")
    return arguments.float_array(given)
