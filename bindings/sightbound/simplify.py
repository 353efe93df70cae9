# SPDX-License-Identifier: GPL-3.0-or-later
"""Few triangles that never leave the terrain's error."""

from __future__ import annotations

from . import _arguments as arguments
from . import _quantities as quantities
from ._loading import core, volume_core
from .dem import Dem, core_dem
from .error_model import ErrorModel, core_model
from .tin import Tin, core_tin
from .volume import model_of_tin, optional_length

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from typing import Any

    import numpy as np
    import numpy.typing as npt

    from collections.abc import Sequence

    from ._arguments import Box, Doubles, FloatArray, Progress
    from ._quantities import Quantity

_DEFAULTS = core.defaults()
_LARGEST = 10000.0  # metres, of tolerances as of errors


class SimplifiedTin(Tin):
    """A TIN with a `report` on how it was made."""

    __slots__ = ("_coarser", "_report")

    _report: dict[str, Any]
    _coarser: npt.NDArray[np.int32] | None

    @property
    def report(self) -> dict[str, Any]:
        """method ("vertical" or "distance": how the tolerance is measured); faces_before, faces_after; least_tolerance, largest_tolerance
        (metres, at the samples); largest_deviation (metres) and largest_ratio (of deviation to tolerance), certified: nowhere more, also
        inside triangles (None by distance, where the tolerance is what is certified); error_model (JSON of what was used, None with a
        tolerance); warnings; version. verify() uses the same words.

        Of simplify() also: border_tolerance (metres), voxel (metres; 0 where there are none), faces_not_held (of the original, too well
        known for the voxels: little goes there), fixed_vertices (where the surface is not manifold)."""
        return self._report

    @property
    def coarser_vertex(self) -> npt.NDArray[np.int32] | None:
        """For each vertex the one of the next coarser TIN that it was drawn into (dem_to_tins()), shape (vertices,). Faces whose
        corners become three different ones are the faces of that TIN; the others have vanished. None where there is no coarser
        one."""
        return self._coarser


def dem_to_tin(
    dem: Dem,
    *,
    tolerance: Quantity = None,
    error_model: ErrorModel | None = None,
    confidence: float = _DEFAULTS["confidence"],
    extent: Box | None = None,
    keep: npt.ArrayLike | None = None,
    keep_border: bool = False,
    border_tolerance: float = 0.0,
    break_lines: Iterable[Any] | None = None,
    break_line_tolerance: float | None = None,
    target_faces: int | None = None,
    target_bytes: float | None = None,
    target_ending: str = "ply",
    threads: int | None = None,
    memory_budget: float | None = None,
    progress: Progress | None = None,
) -> SimplifiedTin:
    """Makes the smallest TIN that stays within a tolerance of the DEM, or within its error, at every place.

    The original is the surface that viewsheds use: all samples, every square of four split along its NW-SE diagonal. At every
    place, inside triangles as well as at samples, |height of the TIN - height of the original| <= tolerance there. The outline,
    holes and islands of nodata stay. The same bytes for any number of threads.

    Attributes of faces: "deviation", the largest on that face, metres, and "bound_used", the largest deviation / tolerance there, both
    rounded up. Of vertices: "tolerance", metres, and "deviation_around", the largest of the faces around.

    Args:
        dem: as read_dem() returns it, in a projected CRS or none.
        tolerance: metres: a number, the path of a raster (or (path, band)) of any grid and CRS, or an array on the DEM's grid, in its
            row order; between samples it is linear on each triangle.
        error_model: instead of a tolerance: the TIN stays within z(confidence) times sigma of the samples, which never leaves the error
            volume. Its vertical_rmse says how much the measured heights may be wrong; an estimate from the DEM cannot.
        confidence: of the error, between 0 and 1.
        extent: (x_min, y_min, x_max, y_max) in the DEM's CRS, snapped outward to its cells; None for the whole DEM.
        keep: array [rows, cols] on the DEM's grid, in its row order: samples that stay vertices, at their own height, where above 0.
        keep_border: keep all samples of the outline and of holes, so that neighbouring tiles fit.
        border_tolerance: metres by which the outline, and that of holes, may move in plan (both ways); its vertices stay samples, the
            corners of the DEM stay. Where it advances over nodata, heights are those of the triangles beside.
        break_lines: polylines, each a sequence of (x, y) in the DEM's CRS, that stay edges of the TIN. Each follows the samples nearest
            to it, at most a cell away; ends and junctions stay vertices.
        break_line_tolerance: metres by which the edges may stray from these samples in plan; None for the longer side of a cell.
        target_faces: stop at that many faces (give or take one), the cheapest removed first; still within the tolerance, so that more
            may be left: a warning tells. None to remove all that can be.
        target_bytes: instead: stop as soon as the file that `write` makes of the TIN takes no more bytes; a warning tells when the
            tolerance does not let it.
        target_ending: of that file. Sizes are exact for "ply"; those of "nc", "gpkg", "2dm" and "obj" are estimated from above.
        threads: None for all cores.
        memory_budget: bytes; None for three quarters of the memory.
        progress: called with the fraction done, at most ten times a second; False cancels.

    Raises:
        ValueError: neither or both of tolerance and error_model, a wrong argument, a CRS in degrees.
        OSError: a file cannot be read.
        MemoryError: the job would exceed the memory budget.
        Cancelled: progress returned False.
    """
    options = _options(
        dem, tolerance, error_model, extent, keep, keep_border, border_tolerance, break_lines, break_line_tolerance, threads, memory_budget
    )
    options.levels = [1.0] if error_model is None else [arguments.number("confidence", confidence)]
    _set_target(options, target_faces, target_bytes, target_ending)
    return _made(dem, tolerance, error_model, options, progress)[0]


def dem_to_tins(
    dem: Dem,
    *,
    tolerance: Quantity = None,
    factors: Sequence[float] | None = None,
    error_model: ErrorModel | None = None,
    confidences: Sequence[float] | None = None,
    extent: Box | None = None,
    keep: npt.ArrayLike | None = None,
    keep_border: bool = False,
    border_tolerance: float = 0.0,
    break_lines: Iterable[Any] | None = None,
    break_line_tolerance: float | None = None,
    threads: int | None = None,
    memory_budget: float | None = None,
    progress: Progress | None = None,
) -> list[SimplifiedTin]:
    """Makes a hierarchy of TINs in one run, from the finest to the coarsest, each of the one before by collapses alone.

    Each stays within its own tolerance of the DEM as dem_to_tin() promises, and its `coarser_vertex` says which vertex of the next
    one each of its vertices was drawn into. All take some 1.1 times the triangles of a run of their own.

    Args:
        tolerance: as of dem_to_tin(), of the finest.
        factors: with a tolerance: by which those of the TINs are larger; they ascend and begin with 1. None for 1, 2 and 4.
        confidences: with an error model: one for each TIN, ascending. None for 0.5, 0.8 and 0.95.
        dem, error_model, extent, keep, keep_border, border_tolerance, break_lines, break_line_tolerance, threads, memory_budget,
            progress: as of dem_to_tin().

    Raises:
        As dem_to_tin().
    """
    options = _options(
        dem, tolerance, error_model, extent, keep, keep_border, border_tolerance, break_lines, break_line_tolerance, threads, memory_budget
    )
    if (factors if error_model is not None else confidences) is not None:
        raise ValueError("factors go with a tolerance, confidences with an error model.")
    name, given = ("factors", factors) if error_model is None else ("confidences", confidences)
    if given is None:
        given = (1.0, 2.0, 4.0) if error_model is None else (0.5, 0.8, 0.95)
    levels = arguments.listed(given)
    if not levels:
        raise ValueError(f"{name} is {given!r}; give a number for each TIN.")
    options.levels = [arguments.number(name, level) for level in levels]
    if error_model is None and options.levels[0] != 1:
        raise ValueError(f"factors is {given!r}; it must begin with 1: the tolerance is that of the finest TIN.")
    if any(finer >= coarser for finer, coarser in zip(options.levels, options.levels[1:])):
        raise ValueError(f"{name} is {given!r}; each must be larger than the one before.")
    return _made(dem, tolerance, error_model, options, progress)


def simplify(
    tin: Tin,
    *,
    tolerance: float | npt.ArrayLike | None = None,
    error_model: ErrorModel | None = None,
    confidence: float = _DEFAULTS["confidence"],
    border_tolerance: float | None = None,
    break_lines: Sequence[npt.ArrayLike] | None = None,
    break_line_tolerance: float = 0.0,
    keep: npt.ArrayLike | None = None,
    target_faces: int | None = None,
    target_bytes: float | None = None,
    target_ending: str = "ply",
    voxel: float | None = None,
    threads: int | None = None,
    memory_budget: float | None = None,
    progress: Progress | None = None,
) -> SimplifiedTin:
    """Makes a TIN of few triangles that stays within a tolerance of any TIN, or within its error: overhangs and buildings too.

    At every place of the result, inside triangles as well as at vertices, the distance from the original is within the tolerance,
    and at every place of the original that from the result: vertically for height fields, else to the nearest place. Topology stays:
    parts, holes, tunnels. The same bytes for any number of threads.

    Height fields use the whole tolerance. For others it is kept in voxels (of voxel), which costs some of it. From a DEM,
    dem_to_tin() is faster and leaves fewer triangles.

    Args:
        tin: what to simplify. Attributes are left out; where it is not manifold it stays as it is.
        tolerance: metres, one for all places; or an array, one for each vertex, linear on each face (by distance: that of the
            nearest place of the original).
        error_model: instead of a tolerance: the result stays in the error volume. Numbers only, as for ErrorVolume.build().
        confidence: of the error, between 0 and 1.
        border_tolerance: metres that the outline, also of holes, may move: in plan for height fields (not at all where a part would then
            lie over another), else in space; its vertices
            stay or go, its corners (60 degrees and more) stay. None: for height fields 0, or z(confidence) times the model's
            horizontal error; for others the least tolerance.
        break_lines: arrays [k, 2] or [k, 3], polylines that run along edges of the TIN (over more vertices than their own, if need be)
            and still do in the result: each place of a line has an edge within break_line_tolerance, and the other way round. In the
            CRS; heights count, and are needed, where the TIN is no height field.
        break_line_tolerance: metres that break lines may move, measured as the outline's; their vertices stay or go, ends, corners (60
            degrees and more) and where they meet stay. 0: only vertices within straight pieces go.
        keep: array, one for each vertex: those that stay where above 0.
        target_faces: stop at that many faces (give or take one), the cheapest removed first; still within the tolerance, so that more
            may be left: a warning tells. None to remove all that can be.
        target_bytes: instead: stop as soon as the file that `write` makes of the TIN takes no more bytes.
        target_ending: of that file, as for dem_to_tin().
        voxel: metres; smaller voxels keep more of the tolerance, and take more time and memory. None to choose it.
        threads: for the voxels; None for all cores. The collapses take one.
        memory_budget: bytes; None for three quarters of the memory.
        progress: called with the fraction done, at most ten times a second; False cancels.

    Raises:
        ValueError: neither or both of tolerance and error_model, a wrong argument.
        MemoryError: the job would exceed the memory budget; a larger voxel helps.
        Cancelled: progress returned False.
    """
    if (tolerance is None) == (error_model is None):
        raise ValueError("give either tolerance (metres) or error_model with vertical_rmse: how far the TIN may be from the original.")
    job = volume_core().SimplifyTinJob()
    if tolerance is not None:
        _set_tolerance(job, tolerance)
    else:
        job.model = model_of_tin(error_model)
    job.confidence = arguments.number("confidence", confidence)
    if border_tolerance is not None:
        job.border_tolerance = arguments.number("border_tolerance", border_tolerance)
    if break_lines is not None:
        job.set_break_lines(core_tin(tin), [_line(number, line) for number, line in enumerate(break_lines, 1)])
    job.break_line_tolerance = arguments.number("break_line_tolerance", break_line_tolerance)
    if keep is not None:
        job.set_keep(_kept(keep, core_tin(tin).vertex_count))
    _set_target(job, target_faces, target_bytes, target_ending)
    job.voxel = optional_length("voxel", voxel)
    job.threads = arguments.threads(threads)
    job.memory_budget = arguments.memory_budget(memory_budget)
    made, report = volume_core().simplify_tin(core_tin(tin), job, progress)
    report["error_model"] = report["error_model"] or None
    report["version"] = core.__version__
    return _wrapped(made, report)


def _options(
    dem: Dem,
    tolerance: Quantity,
    error_model: ErrorModel | None,
    extent: Box | None,
    keep: npt.ArrayLike | None,
    keep_border: bool,
    border_tolerance: float,
    break_lines: Iterable[Any] | None,
    break_line_tolerance: float | None,
    threads: int | None,
    memory_budget: float | None,
) -> core.DemToTinOptions:
    if (tolerance is None) == (error_model is None):
        raise ValueError("give either tolerance (metres) or error_model with vertical_rmse: how far the TIN may be from the DEM.")
    options = core.DemToTinOptions()
    options.error_is_tolerance = tolerance is not None
    options.extent = arguments.extent(extent)
    if keep is not None:
        options.set_keep(_like("keep", keep, dem), core_dem(dem).flipped)
    options.keep_border = bool(keep_border)
    options.border_tolerance = arguments.number("border_tolerance", border_tolerance)
    for line in arguments.polylines("break_lines", break_lines):
        options.add_break_line(line)
    if break_line_tolerance is not None:
        options.break_line_tolerance = arguments.number("break_line_tolerance", break_line_tolerance)
    options.threads = arguments.threads(threads)
    options.memory_budget = arguments.memory_budget(memory_budget)
    return options


def _made(
    dem: Dem, tolerance: Quantity, error_model: ErrorModel | None, options: core.DemToTinOptions, progress: Progress | None
) -> list[SimplifiedTin]:
    model = error_model if tolerance is None else _as_model(tolerance, dem)
    try:
        levels = core.dem_to_tin(core_dem(dem), core_model(model, dem), options, progress)
    except (ValueError, OSError) as error:
        if tolerance is None:
            raise
        raise type(error)(_of_tolerance(str(error))) from None
    tins = []
    for made, report, coarser in levels:
        if tolerance is not None:
            report["error_model"] = None
            report["warnings"] = [_of_tolerance(warning) for warning in report["warnings"]]
        report["version"] = core.__version__
        tins.append(_wrapped(made, report, coarser))
    return tins


def _set_tolerance(job: Any, given: Any) -> None:
    if not quantities.is_array(given):
        job.tolerance = arguments.number("tolerance", given)
        return
    values = arguments.float_array(given)
    if values.ndim != 1:
        raise ValueError(f"tolerance has shape {values.shape}; give one number, or an array with one for each vertex.")
    job.set_tolerances(values)


def _line(number: int, given: Any) -> Doubles:
    import numpy as np

    try:
        line = np.ascontiguousarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"line {number} of break_lines must be an array [k, 2] or [k, 3] of numbers.") from None
    if line.ndim != 2 or line.shape[1] not in (2, 3):
        raise ValueError(f"line {number} of break_lines has shape {line.shape}; give [k, 2] (x, y) or [k, 3] (x, y, height).")
    return line if line.shape[1] == 3 else np.column_stack([line, np.full(len(line), np.nan)])


def _kept(given: Any, vertices: int) -> Any:
    values = arguments.float_array(given)
    if values.shape != (vertices,):
        raise ValueError(f"keep has shape {values.shape}, the TIN has {vertices} vertices; give one value for each.")
    return (values > 0).astype("uint8")


def _as_model(tolerance: Quantity, dem: Dem) -> ErrorModel:
    """An error that is the tolerance: rasters and arrays are then aligned as errors are."""
    value = quantities.from_argument("tolerance", tolerance)
    if hasattr(value, "shape"):
        if (_like("tolerance", value, dem) != value).all():
            raise ValueError("tolerance is NaN at every cell; give metres.")
    if isinstance(value, float) and not 0 <= value <= _LARGEST:
        raise ValueError(f"tolerance is {value:g}; give metres, 0 to {_LARGEST:g}.")
    return ErrorModel(vertical_rmse=tolerance, horizontal_rmse=0, geologic_variation=0)


def _like(name: str, given: Any, dem: Dem) -> FloatArray:
    values = arguments.float_array(given)
    if values.shape != dem.shape:
        raise ValueError(f"{name} has shape {values.shape}, the DEM has {dem.shape}; give one value per cell.")
    return values


def _of_tolerance(message: str) -> str:
    """The core knows a tolerance as an error."""
    message = message.replace("Give the accuracy of the heights (vertical_rmse), or a tolerance.", "Give a larger tolerance there.")
    return message.replace("vertical_rmse", "tolerance").replace("The error raster", "The tolerance raster")


def _set_target(options: Any, faces: Any, bytes_: Any, ending: Any) -> None:
    if faces is not None and bytes_ is not None:
        raise ValueError("target_bytes and target_faces say the same thing; give only one of them.")
    options.set_target(
        0 if faces is None else _count(faces),
        0.0 if bytes_ is None else _bytes(bytes_),
        arguments.word("target_ending", ending).lower().lstrip("."),
    )


def _count(faces: Any) -> int:
    whole = not isinstance(faces, bool) and hasattr(faces, "__index__") or isinstance(faces, float) and faces.is_integer()
    if not whole or not 1 <= faces < 2**31:
        raise ValueError(f"target_faces is {faces!r}; it must be a whole number of 1 or more.")
    return int(faces)


def _bytes(target: Any) -> float:
    bytes_ = arguments.number("target_bytes", target)
    if not 0 < bytes_ < 2**53:
        raise ValueError(f"target_bytes is {target!r}; it must be more than 0.")
    return bytes_


def _wrapped(made: core.Tin, report: dict[str, Any], coarser: npt.NDArray[np.int32] | None = None) -> SimplifiedTin:
    tin = SimplifiedTin.__new__(SimplifiedTin)
    tin._core = made
    tin._report = report
    tin._coarser = coarser
    return tin
