# SPDX-License-Identifier: GPL-3.0-or-later
"""What a DEM itself tells about its error, and what check points or a better DEM do."""

from __future__ import annotations

from . import _arguments as arguments
from . import _quantities as quantities
from ._loading import core
from .dem import Dem, core_dem, read_dem
from .error_model import ErrorModel, core_model

_QUANTILES = ("places", "median", "q683", "q90", "q95", "q99")  # of errors over predicted sd

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Union

    import numpy.typing as npt

    from ._arguments import CreationOptions, FloatArray, Path, Progress

    CheckPoints = Union[Path, npt.ArrayLike]

_CONTENTS = ("auto", "samples", "means")


def estimate_error(
    dem: Dem,
    samples_or_means: str | ErrorModel = "auto",
    checkpoints: CheckPoints | None = None,
    reference: Dem | Path | None = None,
    *,
    error_model: ErrorModel | None = None,
    correct_shift: bool = False,
    elevation_field: str | None = None,
    layer: str | None = None,
    checkpoint_unit: str = "auto",
    progress: Progress | None = None,
) -> ErrorModel:
    """Learns a DEM's error: from the DEM alone, and from places where the truth is known.

    From the DEM alone (what error_model=None does in every job): every other sample is left out to see how far the
    surface through the others misses it; how that grows from one spacing to the next tells what to expect between the
    samples. Heights rounded to a step add the step's error.

    Check points, or a better DEM of a part, tell what no DEM knows of itself: the error of its samples, its growth with
    slope, how far neighbouring errors are alike, the bias, the kind of tails, and whether the DEM lies sideways. Where
    both are given the reference tells all of it but the bias.

    Args:
        dem: the DEM; some blocks spread over it are read.
        samples_or_means: what a cell holds, "samples" (the height of its middle) or "means" (the mean over it); "auto":
            with which the reference agrees better, else what the growth of residuals looks like. (An ErrorModel here is
            taken as `error_model`.)
        checkpoints: the path of points with elevations (any vector file, any CRS), or an array [n, 3] of x, y in the
            DEM's CRS and z in metres. At least ten.
        reference: a better DEM of at least a part, any CRS and cell size: a Dem or a path.
        error_model: what is already known (with correct_shift: of the corrected DEM); only what it leaves None (or 0) is
            learnt.
        correct_shift: judge as if the DEM's shift, sideways and upwards, had been taken off: the model is then that of
            the DEM which write_corrected() makes of the report's "correction", and of no other. Without it the model is
            that of `dem`. Where both are given the reference tells the correction, and check points what bias is left.
        elevation_field: the attribute of `checkpoints` that holds the elevations; None for Z of the points.
        layer: the layer of `checkpoints`; None for the only one.
        checkpoint_unit: unit of the elevations in a file: "auto" as its CRS says, else metres; "metre", "foot",
            "us-foot".
        progress: called with the fraction done; False cancels.

    Returns:
        A complete model. Its `report` holds growth_exponent, typical_sigma, rounding and rms_of_spacing (metres), more of
        what the DEM told of itself, and warnings; with checkpoints and reference also what they told, under these names,
        as dicts: see docs/concepts/error_model.md.

    Raises:
        ValueError: a wrong argument; fewer than ten places with both heights; no overlap.
        OSError: a file cannot be read.
        Cancelled: progress returned False.
    """
    if isinstance(samples_or_means, ErrorModel):
        error_model, samples_or_means = samples_or_means, "auto"
    if samples_or_means not in _CONTENTS:
        raise ValueError(f"samples_or_means is {samples_or_means!r}; allowed are 'auto', 'samples' and 'means'.")
    source = core_dem(dem)
    given = error_model if error_model is not None else ErrorModel()
    core_model(given, dem)
    learnt = given._core.copy()
    if samples_or_means != "auto":
        learnt.samples_or_means = samples_or_means
    before = None
    parts = _Parts(progress, 1 + (checkpoints is not None) + 2 * (reference is not None))
    better = reference if isinstance(reference, Dem) or reference is None else read_dem(reference)
    if better is not None:
        seen = core.content_seen(source, core_dem(better), parts.next())
        if learnt.samples_or_means is None:
            learnt.samples_or_means = seen
    found = core.estimate(source, learnt.samples_or_means, parts.next())
    if given.tails is None and given.level_tail is None and given.geologic_variation is None and (found.level_tail or found.step_tail):
        # Before check points tell the tails of the samples' error: these are of what lies between.
        learnt.level_tail, learnt.step_tail = found.level_tail, found.step_tail
    report: dict[str, Any] = {
        "growth_exponent": found.growth_exponent,
        "typical_sigma": found.typical_m,
        "rounding": found.rounding_m,
        "rms_of_spacing": found.rms_of_spacing,
        "samples_or_means": found.samples_or_means,
        "means_score": found.means_score,
        "ridge_gain": found.ridge_gain,
        "tails": found.tails,
        "local_scale": found.local_scale,
        "level_variance": found.level_variance,
        "step_variance": found.step_variance,
        "level_tail": found.level_tail,
        "step_tail": found.step_tail,
        "self_check": {name: getattr(found.self_check, name) for name in _QUANTILES},
        "warnings": list(found.warnings),
    }
    if better is not None:
        content = found.samples_or_means
        if seen is not None and seen != content:
            report["warnings"].append(f"The reference agrees better with a DEM whose cells hold {seen}, not {content}.")
        if learnt.samples_or_means is None:
            report["warnings"].append(
                f"Whether a cell holds samples or means is not told by the reference; {content} is what the DEM itself looks like."
            )
        before = core.check_with_reference(source, core_dem(better), content, bool(correct_shift), parts.next())
        learnt = core.with_check(learnt, before)
        report["reference"] = {**before.details(source), "samples_or_means": seen or "not told"}
    if checkpoints is not None:
        places, notes = _places(source, checkpoints, layer, elevation_field, checkpoint_unit)
        completed = core.with_estimate(given._on(dem), found)
        check = core.check_with_points(source, completed, places, bool(correct_shift), before, parts.next())
        report["checkpoints"] = check.details(source)
        if better is not None and given.shared_bias == 0:
            learnt.shared_bias = report["checkpoints"]["median"]
        learnt = core.with_check(learnt, check)
        report["warnings"] += notes
    for name in ("reference", "checkpoints"):
        report["warnings"] += report.get(name, {}).get("warnings", [])
    return ErrorModel._of(core.with_estimate(learnt, found), given._arrays, report)


def write_corrected(
    dem: Dem,
    path: Path,
    shift: dict[str, Any] | tuple[float, float, float],
    creation_options: CreationOptions = None,
    progress: Progress | None = None,
) -> None:
    """Writes a DEM with a shift taken off, as GeoTIFF: its georeference moved, its heights (in metres) lowered.

    Args:
        dem: the DEM.
        path: the file to write.
        shift: (dx, dy, dz) in metres along the axes of the CRS and upwards, DEM minus truth; or what estimate_error
            reports as "correction": the shift, or the bias alone where no shift could be told. The model of what is
            written is the one estimated with correct_shift=True; that of `dem` has a bias which it has no more.
        creation_options: of GDAL's GeoTIFF driver, as a dict or KEY=VALUE texts.
        progress: called with the fraction done; False cancels.

    Raises:
        ValueError: no such shift.
        OSError: the file cannot be written.
        Cancelled: progress returned False.
    """
    steps = [shift.get(name) for name in ("dx", "dy", "dz")] if hasattr(shift, "get") else arguments.listed(shift)
    if steps is None or len(steps) != 3:
        raise ValueError(f"shift is {shift!r}; it must be (dx, dy, dz) in metres.")
    dx, dy, dz = (arguments.number("shift", one) for one in steps)
    options = arguments.creation_options(creation_options)
    core.write_corrected_dem(arguments.path("path", path), core_dem(dem), dx, dy, dz, options, progress)


class ErrorMaps:
    """The two parts of a DEM's error as float32 arrays [rows, cols], metres, in the DEM's row order; read-only."""

    __slots__ = ("_core",)

    def __init__(self, maps: core.ErrorMaps) -> None:
        self._core = maps

    @property
    def between(self) -> FloatArray:
        """Standard deviation of the ground half a spacing from the sample."""
        return self._core.between

    @property
    def sampling(self) -> FloatArray:
        """Standard deviation of the sample's own height."""
        return self._core.sampling

    def write(
        self,
        between: Path | None = None,
        sampling: Path | None = None,
        creation_options: CreationOptions = None,
        progress: Progress | None = None,
    ) -> None:
        """Writes the rasters whose paths are given as GeoTIFF.

        Raises:
            ValueError: no path, one path twice.
            OSError: a file cannot be written.
            Cancelled: progress returned False.
        """
        if between is None and sampling is None:
            raise ValueError("between and sampling are None; name a file.")
        paths = arguments.path("between", between), arguments.path("sampling", sampling)
        core.write_error_maps(self._core, *paths, arguments.creation_options(creation_options), 0, progress)


def error_maps(
    dem: Dem, error_model: ErrorModel | None = None, threads: int | None = None, progress: Progress | None = None
) -> ErrorMaps:
    """The error of each sample, and of the ground half a spacing from it.

    Raises:
        ValueError: a wrong argument.
        OSError: a file cannot be read.
        MemoryError: the rasters would exceed the memory.
        Cancelled: progress returned False.
    """
    return ErrorMaps(core.error_maps(core_dem(dem), core_model(error_model, dem), arguments.threads(threads), progress))


class _Parts:
    """Shares one progress among the parts of a job."""

    def __init__(self, progress: Progress | None, count: int) -> None:
        self._progress, self._count, self._done = progress, count, 0

    def next(self) -> Progress | None:
        progress, count, done = self._progress, self._count, self._done
        self._done += 1
        return None if progress is None else lambda fraction: progress((done + fraction) / count)


def _places(source: core.DemSource, checkpoints: Any, layer: Any, field: Any, unit: str) -> tuple[Any, list[str]]:
    if quantities.is_path(checkpoints):
        path = arguments.path("checkpoints", checkpoints)
        return core.read_check_points(source, path, layer or "", field or "", arguments.word("checkpoint_unit", unit), None)
    import numpy as np

    try:
        places = np.ascontiguousarray(checkpoints, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"checkpoints is {type(checkpoints).__name__}; it must be a path or an array [n, 3].") from None
    if places.ndim != 2 or places.shape[1] != 3:
        raise ValueError(f"checkpoints has shape {places.shape}; it must be a path or an array [n, 3] of x, y, z.")
    if not np.isfinite(places).all():
        raise ValueError("checkpoints holds values that are not finite; leave these points out.")
    return places, []
