# SPDX-License-Identifier: GPL-3.0-or-later
"""How probable it is that a cell is seen, over terrains that could lie behind a DEM."""

from __future__ import annotations

from . import _arguments as arguments
from ._loading import core
from .dem import Dem, core_dem
from .error_model import ErrorModel, core_model
from .viewshed import observers_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    import numpy as np
    import numpy.typing as npt

    from ._arguments import Box, CreationOptions, Limits, Numbers, Path, Positions, Progress, Range, Ranges

_DEFAULTS = core.defaults()


class ProbableViewshed:
    """Probabilities of being seen; arrays [rows, cols] in the DEM's row order, NaN (verdict 255) where nobody was asked."""

    __slots__ = ("_core", "_observers", "_options", "_report")

    def __init__(
        self, found: core.ProbableViewshed, observers: list[core.Observer], options: core.ProbableOptions
    ) -> None:
        self._core = found
        self._observers = observers
        self._options = options
        self._report = {**found.report(), "version": core.__version__}

    @property
    def probability(self) -> npt.NDArray[np.float32]:
        """That an observer sees the cell, 0 to 1."""
        return self._core.probability

    @property
    def standard_error(self) -> npt.NDArray[np.float32]:
        """Of the probability, one standard deviation, for the number of realisations."""
        return self._core.standard_error

    @property
    def verdict(self) -> npt.NDArray[np.uint8]:
        """0 hidden, 1 uncertain, 2 visible at the confidence, 255 nobody asked. A claim needs the nearer end of the probability's
        interval of 95 % (Wilson 1927) to hold."""
        return self._core.verdict

    @property
    def geotransform(self) -> tuple[float, ...]:
        """Six numbers in GDAL's order."""
        return self._core.geotransform

    @property
    def crs_wkt(self) -> str | None:
        """The DEM's CRS as WKT; None when there is none."""
        return self._core.crs_wkt or None

    @property
    def report(self) -> dict[str, Any]:
        """observers (x, y, name, ground_height, eye_height: on the DEM), realisations, expected_visible_m2 (the sum of the
        probabilities), visible_m2, uncertain_m2, hidden_m2, error_model (JSON of what was used), warnings, version."""
        return self._report

    def write(
        self,
        probability: Path | None = None,
        standard_error: Path | None = None,
        verdict: Path | None = None,
        creation_options: CreationOptions = None,
        progress: Progress | None = None,
    ) -> None:
        """Writes rasters as GeoTIFF, with metadata (SIGHTBOUND_...) that say how they were made: all of them, or none.

        Args and errors as of ViewshedResult.write().
        """
        files = core.ProbableFiles()
        files.probability = arguments.path("probability", probability)
        files.standard_error = arguments.path("standard_error", standard_error)
        files.verdict = arguments.path("verdict", verdict)
        files.creation_options = arguments.creation_options(creation_options)
        core.write_probable(self._core, self._observers, self._options, files, progress)


def probable_viewshed(
    dem: Dem,
    observers: Positions,
    observer_height: Numbers = _DEFAULTS["observer_height"],
    target_height: Numbers = _DEFAULTS["target_height"],
    error_model: ErrorModel | None = None,
    confidence: float = _DEFAULTS["confidence"],
    min_distance: Numbers = _DEFAULTS["min_distance"],
    max_distance: Limits = _DEFAULTS["max_distance"],
    azimuth: Range | Ranges = _DEFAULTS["azimuth"],
    vertical_angle: Range | Ranges = _DEFAULTS["vertical_angle"],
    refraction: float = _DEFAULTS["refraction"],
    curvature: bool = _DEFAULTS["curvature"],
    realisations: int = 1000,
    precision: float = 0.03,
    refinement: int = 1,
    heights: Sequence[float] = (),
    seed: int = 1,
    extent: Box | None = None,
    threads: int | None = None,
    memory_budget: int | None = None,
    progress: Progress | None = None,
    names: Sequence[str] | None = None,
) -> ProbableViewshed:
    """Computes for each cell the probability that it is seen, by conditional simulation.

    Terrains are drawn that could lie behind the DEM: at the samples from what the measurements leave open, half-way between
    samples with the error model's between-sample error. Eye and target stand on the ground of each. Unlike the p of
    viewshed(), which judges one critical place, this is the probability for the whole line; with several observers, that any
    of them sees the cell. What lies behind nodata counts as not seen.

    Args:
        realisations: terrains drawn, 1 to 65535; the standard error is at most 0.5 / sqrt(realisations).
        seed: 0 or more; another one draws other terrains.
        Others as of viewshed().

    Raises:
        As viewshed().
    """
    given = {
        "observer_height": observer_height,
        "target_height": target_height,
        "min_distance": min_distance,
        "max_distance": max_distance,
        "azimuth": azimuth,
        "vertical_angle": vertical_angle,
    }
    options = core.ProbableOptions()
    options.confidence = arguments.number("confidence", confidence)
    options.refraction = arguments.number("refraction", refraction)
    options.curvature = bool(curvature)
    options.realisations = arguments.whole("realisations", realisations, 1, 65535)
    options.precision = arguments.number("precision", precision)
    options.refinement = arguments.whole("refinement", refinement, 0, 1)
    options.heights = [arguments.number("heights", height) for height in heights]
    options.seed = arguments.whole("seed", seed, 0, 2**63 - 1)
    options.extent = arguments.extent(extent)
    options.threads = arguments.threads(threads)
    options.memory_budget = arguments.memory_budget(memory_budget)
    places = observers_of(observers, names, given)
    found = core.probable_viewshed(core_dem(dem), places, core_model(error_model, dem), options, progress)
    return ProbableViewshed(found, places, options)
