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
        """Of the probability, one standard deviation, for the number of realisations; 0 where all terrains agree."""
        return self._core.standard_error

    @property
    def realisations(self) -> npt.NDArray[np.uint16]:
        """That the probability comes from: a settled cell is left early; 0 where nobody was asked."""
        return self._core.realisations

    def probability_at(self, height: float) -> npt.NDArray[np.float32]:
        """That a target of another height (one of `heights`) is seen, 0 to 1: that the lowest visible height there is no more
        than this. The probability that a needed height is exceeded is 1 minus it."""
        heights = self._report["heights"]
        if height not in heights:
            raise ValueError(f"height is {height!r}; the viewshed was computed for {heights}.")
        return self._core.at_height(heights.index(height))

    @property
    def verdict(self) -> npt.NDArray[np.uint8]:
        """0 hidden, 1 uncertain, 2 visible at the confidence, 255 nobody asked. A claim needs the nearer end of the probability's
        interval of 95 % (Wilson 1927) to hold, or that it is the same in all terrains that could be drawn."""
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
        """observers (x, y, name, ground_height, eye_height: on the DEM), realisations (the most of a cell), heights,
        largest_standard_error, in_doubt_m2 (not the same in all terrains), expected_visible_m2 (the sum of the probabilities),
        visible_m2, uncertain_m2, hidden_m2, error_model (JSON of what was used), warnings, version."""
        return self._report

    def write(
        self,
        probability: Path | None = None,
        standard_error: Path | None = None,
        verdict: Path | None = None,
        creation_options: CreationOptions = None,
        progress: Progress | None = None,
        at_heights: Path | None = None,
    ) -> None:
        """Writes rasters as GeoTIFF, with metadata (SIGHTBOUND_...) that say how they were made: all of them, or none.

        `at_heights` has a band for each of the heights, in their order.

        Args and errors as of ViewshedResult.write().
        """
        files = core.ProbableFiles()
        files.probability = arguments.path("probability", probability)
        files.standard_error = arguments.path("standard_error", standard_error)
        files.verdict = arguments.path("verdict", verdict)
        files.at_heights = arguments.path("at_heights", at_heights)
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
    realisations: int = _DEFAULTS["realisations"],
    seed: int = _DEFAULTS["seed"],
    extent: Box | None = None,
    threads: int | None = None,
    memory_budget: int | None = None,
    progress: Progress | None = None,
    names: Sequence[str] | None = None,
    precision: float = _DEFAULTS["precision"],
    heights: Sequence[float] = (),
    method: str = _DEFAULTS["method"],
    refinement: int = _DEFAULTS["refinement"],
) -> ProbableViewshed:
    """Computes for each cell the probability that it is seen, by conditional simulation.

    Terrains are drawn that could lie behind the DEM: at the samples from what the measurements leave open, half-way between
    samples with the error model's between-sample error. Eye and target stand on the ground of each. Unlike the p of
    viewshed(), which judges one critical place, this is the probability for the whole line; with several observers, that any
    of them sees the cell. Behind nodata half of what known ground leaves is seen: no claim.

    Args:
        realisations: terrains drawn at most, 1 to 65535; the standard error is at most 0.5 / sqrt(realisations).
        seed: 0 or more; another one draws other terrains.
        precision: a cell is left early when its probability is known within this (95 %, whatever the number of looks) and its
            claim is clear, 0 to 0.5; 0 = never.
        heights: of further targets above ground, metres, at most 15, on the same terrains: see probability_at().
        method: "conditional": terrains that agree with the DEM as far as it can be trusted; "perturb": the DEM with an error
            of vertical_rmse (and slope) added to each sample, straight between them. That is what is usually done and not
            calibrated: the DEM has its error once already, and what lies between its samples is left out.
        refinement: 0: ground has nodes half a cell apart; 1: finer ones as well, near the eye and before each target.
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
    options.method = arguments.word("method", method)
    options.heights = [arguments.number("heights", height) for height in heights]
    options.seed = arguments.whole("seed", seed, 0, 2**63 - 1)
    options.extent = arguments.extent(extent)
    options.threads = arguments.threads(threads)
    options.memory_budget = arguments.memory_budget(memory_budget)
    places = observers_of(observers, names, given)
    found = core.probable_viewshed(core_dem(dem), places, core_model(error_model, dem), options, progress)
    return ProbableViewshed(found, places, options)
