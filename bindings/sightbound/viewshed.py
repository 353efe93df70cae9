# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be seen from one or many observers, and how sure that is."""

from __future__ import annotations

from . import _arguments as arguments
from ._loading import core
from .dem import Dem, core_dem, ground_dem
from .error_model import ErrorModel, core_model
from .viewshed_result import ViewshedResult

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import Any

    from ._arguments import Box, Limits, Numbers, Path, Positions, Progress, Range, Ranges

_DEFAULTS = core.defaults()


def viewshed(
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
    stand: str = _DEFAULTS["stand"],
    combine: str = _DEFAULTS["combine"],
    height_reference: str = _DEFAULTS["height_reference"],
    ground: Dem | Path | None = None,
    see_across_nodata: bool = _DEFAULTS["see_across_nodata"],
    extent: Box | None = None,
    heights: bool = _DEFAULTS["heights"],
    threads: int | None = None,
    memory_budget: int | None = None,
    progress: Progress | None = None,
    names: Sequence[str] | None = None,
) -> ViewshedResult:
    """Computes for each cell the confidence that it is seen, given the error of the DEM.

    The arguments marked * take one value for all observers, or a sequence with one value for each.

    Args:
        dem: from read_dem() or Dem().
        observers: sequence of (x, y), or array [n, 2], in the DEM's CRS.
        observer_height: * of the eye, metres above ground (or absolute, see height_reference).
        target_height: * of what is to be seen, metres above ground (or absolute).
        error_model: None estimates the DEM's error from the DEM.
        confidence: of a claim, between 0 and 1: a cell is visible when its p is at least (1 + confidence) / 2, hidden
            when it is at most (1 - confidence) / 2, else uncertain.
        min_distance, max_distance: * metres on the ground, inclusive; None for no limit.
        azimuth: * (from, to), degrees clockwise from true north; (350, 10) is the sector across north.
        vertical_angle: * (from, to), degrees above the observer's horizontal.
        refraction: coefficient of refraction; 0 for none.
        curvature: False for a flat Earth.
        stand: "model": eye and target are at exact heights; "ground": they move with the unknown ground.
        combine: "best" keeps for each cell the observer that sees it best, "worst" the one that sees it worst.
        height_reference: "ground" or "absolute".
        ground: for a surface model, the bare ground that heights count from; None for the DEM itself.
        see_across_nodata: True lets sight cross nodata; else what lies behind is at best uncertain.
        extent: (x_min, y_min, x_max, y_max) of the output in the DEM's CRS, snapped to its cells; None for the reach
            of the observers.
        heights: also compute the lowest visible heights.
        threads: None for all cores. The result does not depend on it.
        memory_budget: bytes; None for three quarters of the memory.
        progress: called with the fraction done, at most ten times a second; False cancels.
        names: what messages and reports call the observers; None for their numbers.

    Raises:
        ValueError: a wrong argument, named in the message; an observer outside the DEM or on nodata.
        OSError: a file cannot be read.
        MemoryError: the job would exceed the memory budget; nothing was begun.
        Cancelled: progress returned False.
    """
    job = _Job(**locals())
    result = core.viewshed(job.dem, job.observers, job.model, job.options, progress)
    return ViewshedResult(result, job.observers, job.options)


def viewsheds(
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
    stand: str = _DEFAULTS["stand"],
    combine: str = _DEFAULTS["combine"],
    height_reference: str = _DEFAULTS["height_reference"],
    ground: Dem | Path | None = None,
    see_across_nodata: bool = _DEFAULTS["see_across_nodata"],
    extent: Box | None = None,
    heights: bool = _DEFAULTS["heights"],
    threads: int | None = None,
    memory_budget: int | None = None,
    progress: Progress | None = None,
    names: Sequence[str] | None = None,
) -> Iterator[ViewshedResult]:
    """One viewshed per observer, each cropped to its own reach, computed when it is asked for.

    Takes the arguments of viewshed() and raises what it raises; arguments are checked at once. The DEM's error is
    estimated once, before the first result. `progress` tells the fraction of all observers.
    """
    return _one_by_one(_Job(**locals()), progress)


class _Job:
    """The arguments of viewshed(), checked, as the core takes them."""

    __slots__ = ("dem", "model", "observers", "options")

    def __init__(self, dem: Dem, observers: Any, error_model: Any, names: Any, progress: Any, **given: Any) -> None:
        self.dem = core_dem(dem)
        self.model = core_model(error_model, dem)
        self.observers = observers_of(observers, names, given)
        self.options = options_of(dem, given)
        self.options.combine = arguments.word("combine", given["combine"])
        self.options.extent = arguments.extent(given["extent"])
        self.options.heights = bool(given["heights"])
        self.options.threads = arguments.threads(given["threads"])
        self.options.memory_budget = arguments.memory_budget(given["memory_budget"])


def observers_of(observers: Any, names: Any, given: dict[str, Any]) -> list[core.Observer]:
    """The observers with their heights and limits."""
    places = arguments.positions("observers", observers)
    count = len(places)
    columns = [
        arguments.one_each(name, given[name], count, convert)
        for name, convert in (
            ("observer_height", arguments.number),
            ("target_height", arguments.number),
            ("min_distance", arguments.number),
            ("max_distance", arguments.limit),
            ("azimuth", arguments.pair),
            ("vertical_angle", arguments.pair),
        )
    ]
    rows = zip(*columns, arguments.names(names, count))
    return [core.Observer(x, y, *values) for (x, y), values in zip(places, rows)]


def options_of(dem: Dem, given: dict[str, Any]) -> core.ViewshedOptions:
    """The options that sight has in every job."""
    options = core.ViewshedOptions()
    options.confidence = arguments.number("confidence", given["confidence"])
    options.refraction = arguments.number("refraction", given["refraction"])
    options.curvature = bool(given["curvature"])
    options.stand = arguments.word("stand", given["stand"])
    options.height_reference = arguments.word("height_reference", given["height_reference"])
    options.see_across_nodata = bool(given["see_across_nodata"])
    ground = ground_dem(given["ground"]) or dem._ground
    if ground is not None:
        options.set_ground(ground._core)
    return options


def _one_by_one(job: _Job, progress: Progress | None) -> Iterator[ViewshedResult]:
    steps = len(job.observers) + 1
    model, warnings = core.complete_model(job.dem, job.model, _part(progress, 0, steps))
    for step, observer in enumerate(job.observers, 1):
        observer.number = step  # what messages call it, as in viewshed()
        result = core.viewshed(job.dem, [observer], model, job.options, _part(progress, step, steps))
        result.prepend_warnings(warnings)
        yield ViewshedResult(result, [observer], job.options)


def _part(progress: Progress | None, step: int, steps: int) -> Progress | None:
    """The progress of one step as progress of the whole."""
    return progress and (lambda fraction: progress((step + fraction) / steps))
