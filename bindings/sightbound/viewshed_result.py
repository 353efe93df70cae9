# SPDX-License-Identifier: GPL-3.0-or-later
"""What viewshed() returns."""

from __future__ import annotations

from . import _arguments as arguments
from ._loading import core

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    import numpy as np
    import numpy.typing as npt

    from ._arguments import CreationOptions, FloatArray, Geotransform, Path, Progress


class ViewshedResult:
    """Rasters of a viewshed, all of one shape (rows, cols), in the row order of the DEM's file or array.

    The arrays share memory with the result, without a copy, and are read-only: copy one to change it.
    """

    __slots__ = ("_core", "_observers", "_options", "_report")

    def __init__(
        self, result: core.ViewshedResult, observers: list[core.Observer], options: core.ViewshedOptions
    ) -> None:
        self._core = result
        self._observers = observers
        self._options = options
        self._report: dict[str, Any] | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, cols)."""
        return self._core.rows, self._core.cols

    @property
    def confidence(self) -> FloatArray:
        """float32: pointwise confidence of visibility p, 0 (surely hidden) to 1 (surely visible).

        NaN: nodata, or no observer was asked.
        """
        return self._core.confidence

    @property
    def verdict(self) -> npt.NDArray[np.uint8]:
        """uint8: 0 hidden, 1 uncertain, 2 visible; 255 nodata or not asked."""
        return self._core.verdict

    @property
    def count(self) -> npt.NDArray[np.uint32]:
        """uint32: number of observers that claim visible; 4294967295 nodata or not asked."""
        return self._core.count

    @property
    def lowest_visible_height(self) -> FloatArray | None:
        """float32: metres above ground from which on a target is certainly visible. None unless heights=True."""
        return self._core.lowest_visible_height

    @property
    def likely_visible_height(self) -> FloatArray | None:
        """float32: metres above ground from which on a target is rather visible than not. None as above."""
        return self._core.likely_visible_height

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
        """What was found and what was used.

        observers: one dict per observer: x, y, name, ground_height, eye_height (absolute, metres), visible_m2,
            uncertain_m2, hidden_m2, status ("ok", or why nothing is seen)
        visible_m2, uncertain_m2, hidden_m2: ground areas of the combined verdict; visible_share, uncertain_share,
            hidden_share: of their sum (0 to 1; nan when it is 0)
        hole_doubt_m2: area in doubt only because sight would cross nodata
        error_model: the model used, as JSON; warnings: list of texts; memory_bytes: planned peak; version
        """
        if self._report is None:
            self._report = _with_shares(self._core.report())
        return self._report

    def write(
        self,
        confidence: Path | None = None,
        verdict: Path | None = None,
        count: Path | None = None,
        height: Path | None = None,
        likely_height: Path | None = None,
        creation_options: CreationOptions = None,
        progress: Progress | None = None,
    ) -> None:
        """Writes rasters as GeoTIFF, with metadata (SIGHTBOUND_...) that say how they were made.

        All of them appear when the last is whole; if one fails, none does, and older files of these names stay.

        Args:
            confidence, verdict, count, height (lowest_visible_height), likely_height: paths; None is not written.
            creation_options: GDAL's for GTiff, {"COMPRESS": "ZSTD"} or ["COMPRESS=ZSTD"]; None: tiled and compressed.
            progress: called with the fraction done; False cancels.

        Raises:
            ValueError: no path, one path twice, heights that were not computed.
            OSError: a file cannot be written.
            Cancelled: progress returned False.
        """
        files = core.ViewshedFiles()
        files.confidence = arguments.path("confidence", confidence)
        files.verdict = arguments.path("verdict", verdict)
        files.count = arguments.path("count", count)
        files.height = arguments.path("height", height)
        files.likely_height = arguments.path("likely_height", likely_height)
        files.creation_options = arguments.creation_options(creation_options)
        core.write_viewshed(self._core, self._observers, self._options, files, progress)

    def __repr__(self) -> str:
        rows, cols = self.shape
        return f"<sightbound.ViewshedResult: {rows} x {cols}, {len(self._observers)} observer(s)>"


def _with_shares(report: dict[str, Any]) -> dict[str, Any]:
    verdicts = ("visible", "uncertain", "hidden")
    total = sum(report[f"{verdict}_m2"] for verdict in verdicts)
    for verdict in verdicts:
        report[f"{verdict}_share"] = report[f"{verdict}_m2"] / total if total else float("nan")
    report["version"] = core.__version__
    return report
