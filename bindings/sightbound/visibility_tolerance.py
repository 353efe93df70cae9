# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a simplified terrain may be from a DEM before observers see something else."""

from __future__ import annotations

from . import _arguments as arguments
from ._loading import core
from .dem import Dem, core_dem
from .error_model import ErrorModel, core_model
from .viewshed import observers_of, options_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from ._arguments import FloatArray, Numbers, Positions, Progress

_DEFAULTS = core.defaults()


def visibility_tolerance(
    dem: Dem,
    observers: Positions,
    tolerance: float,
    *,
    observer_height: Numbers = _DEFAULTS["observer_height"],
    target_height: Numbers = _DEFAULTS["target_height"],
    error_model: ErrorModel | None = None,
    confidence: float = _DEFAULTS["confidence"],
    refraction: float = _DEFAULTS["refraction"],
    curvature: bool = _DEFAULTS["curvature"],
    threads: int | None = None,
    memory_budget: int | None = None,
    progress: Progress | None = None,
) -> tuple[FloatArray, dict[str, Any]]:
    """A tolerance for dem_to_tin() that leaves the observers' views as they are.

    What a viewshed with stand="ground", this confidence, refraction and curvature, and these heights above ground calls visible or
    hidden from the DEM is so from the TIN, eye and target that high above it. Samples keep to half of z(confidence) times the least
    standard deviation of all samples, or to the tolerance if that is less; only ground that no line of sight comes near, even when it
    rises by the whole tolerance, has all of it. Without vertical_rmse in the error model all other ground stays exactly as it is.

    Args:
        dem: as read_dem() returns it.
        observers: sequence of (x, y), or array [n, 2], in the DEM's CRS.
        tolerance: metres, where nothing is at stake.
        observer_height, target_height: metres above ground, the target's 0 or more: one value, or one for each observer.
        error_model: None estimates the DEM's error from the DEM.
        confidence: of what must stay, between 0 and 1.
        refraction, curvature: as viewshed() has them.
        threads: None for all cores.
        memory_budget: bytes; None for three quarters of the memory.
        progress: called with the fraction done, at most ten times a second; False cancels.

    Returns:
        float32 array [rows, cols], metres, in the DEM's row order, and a report: free_share (of the samples, those with the whole
        tolerance), error_model (JSON of what was used), warnings.

    Raises:
        ValueError: a wrong argument, named in the message; an observer outside the DEM or on nodata; a DEM in degrees.
        OSError: a file cannot be read.
        MemoryError: the job would exceed the memory budget.
        Cancelled: progress returned False.
    """
    given = {
        "observer_height": observer_height,
        "target_height": target_height,
        "min_distance": _DEFAULTS["min_distance"],
        "max_distance": _DEFAULTS["max_distance"],
        "azimuth": _DEFAULTS["azimuth"],
        "vertical_angle": _DEFAULTS["vertical_angle"],
        "confidence": confidence,
        "refraction": refraction,
        "curvature": curvature,
        "stand": "ground",
        "height_reference": "ground",
        "see_across_nodata": False,
        "ground": None,
    }
    options = options_of(dem, given)
    options.threads = arguments.threads(threads)
    options.memory_budget = arguments.memory_budget(memory_budget)
    places = observers_of(observers, None, given)
    metres = arguments.number("tolerance", tolerance)
    return core.visibility_tolerance(core_dem(dem), places, core_model(error_model, dem), metres, options, progress)
