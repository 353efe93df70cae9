# SPDX-License-Identifier: GPL-3.0-or-later
"""What a DEM itself tells about its error."""

from __future__ import annotations

from ._loading import core
from .dem import Dem, core_dem
from .error_model import ErrorModel, core_model

_QUANTILES = ("places", "median", "q683", "q90", "q95", "q99")  # of errors over predicted sd

TYPE_CHECKING = False
if TYPE_CHECKING:
    from ._arguments import Progress


def estimate_error(
    dem: Dem,
    error_model: ErrorModel | None = None,
    progress: Progress | None = None,
    *,
    samples_or_means: str = "auto",
) -> ErrorModel:
    """Learns from the DEM alone what its samples do not tell: what error_model=None does in every job.

    Every other sample is left out to see how far the surface through the others misses it; how that grows from one
    spacing to the next tells what to expect between the samples. Heights rounded to a step add the step's error.

    Args:
        dem: the DEM; some blocks spread over it are read.
        error_model: what is already known; only what it leaves None is estimated.
        progress: called with the fraction done; False cancels.
        samples_or_means: what a cell holds: "samples" (the height of its middle), "means" (over the cell), or "auto":
            whichever the growth of residuals looks like.

    Returns:
        A complete model. Its `report` holds growth_exponent, typical_sigma and rounding (metres), and warnings.

    Raises:
        OSError: the file cannot be read.
        Cancelled: progress returned False.
    """
    source = core_dem(dem)
    given = error_model if error_model is not None else ErrorModel()
    core_model(given, dem)
    asked = given._core.samples_or_means if samples_or_means == "auto" else samples_or_means
    found = core.estimate(source, asked, progress)
    report = {
        "growth_exponent": found.growth_exponent,
        "typical_sigma": found.typical_m,
        "rounding": found.rounding_m,
        "rms_of_spacing": found.rms_of_spacing,
        "samples_or_means": found.samples_or_means,
        "means_score": found.means_score,
        "ridge_gain": found.ridge_gain,
        "tails": found.tails,
        "local_scale": found.local_scale,
        "self_check": {name: getattr(found.self_check, name) for name in _QUANTILES},
        "warnings": found.warnings,
    }
    return ErrorModel._of(core.with_estimate(given._core, found), given._arrays, report)
