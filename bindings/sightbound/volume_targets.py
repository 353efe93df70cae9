# SPDX-License-Identifier: GPL-3.0-or-later
"""Sight in an error volume to targets at one height above all the ground, and to listed ones."""

from __future__ import annotations

from collections import namedtuple

from . import _arguments as arguments
from ._loading import core, volume_core
from .volume_sight import Job

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any, NamedTuple

    import numpy as np
    import numpy.typing as npt

    from . import _volume
    from ._arguments import CreationOptions, FloatArray, Geotransform, Numbers, Path, Positions, Progress
    from .volume import ErrorVolume
    from .volume_sight import View

    class TargetSight(NamedTuple):
        verdict: npt.NDArray[np.uint8]
        confidence: FloatArray
        report: dict[str, Any]

else:
    TargetSight = namedtuple("TargetSight", "verdict confidence report")
    TargetSight.__doc__ = """One element for each target, in their order.

    verdict: uint8: 0 surely hidden, 1 uncertain, 2 visible, 255 none (off the terrain, beneath it, or too far).
    confidence: float32: proven pointwise confidence of visibility p, 0 to 1; nan without a verdict.
    report: view_places, targets, lines; warnings; version.
    """

_DEFAULTS = core.defaults()


class VolumeLayer:
    """What volume_layer() returns: rasters, north up."""

    __slots__ = ("_core",)

    _core: _volume.VolumeLayer

    def __init__(self) -> None:
        raise TypeError("Use volume_layer().")

    @property
    def verdict(self) -> npt.NDArray[np.uint8]:
        """uint8 [rows, cols]: 0 surely hidden, 1 uncertain, 2 visible; 255: no terrain, or too far. Read-only."""
        return self._core.verdict

    @property
    def confidence(self) -> FloatArray:
        """float32: proven pointwise confidence of visibility p, 0 to 1, rounded towards 1/2 to a half float; nan as above."""
        return self._core.confidence

    @property
    def geotransform(self) -> Geotransform:
        """GDAL's six numbers."""
        return self._core.geotransform

    @property
    def crs_wkt(self) -> str | None:
        """The CRS as WKT; None when there is none."""
        return self._core.crs_wkt or None

    @property
    def report(self) -> dict[str, Any]:
        """view_places, targets, lines, bytes; observers, error_model: JSON; warnings; version."""
        return {
            **self._core.counts,
            "observers": self._core.observers,
            "error_model": self._core.error_model,
            "warnings": self._core.warnings,
            "version": core.__version__,
        }

    def write(
        self,
        confidence: Path | None = None,
        verdict: Path | None = None,
        creation_options: CreationOptions = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> None:
        """Writes GeoTIFFs; None is not written.

        Raises:
            ValueError: no path, one path twice. OSError: a file cannot be written. Cancelled: progress returned False.
        """
        paths = arguments.path("confidence", confidence), arguments.path("verdict", verdict)
        self._core.write(
            *paths, arguments.creation_options(creation_options), arguments.threads(threads), progress
        )


def volume_layer(
    volume: ErrorVolume,
    views: Sequence[View],
    target_height: float,
    view_height: Numbers = _DEFAULTS["observer_height"],
    view_height_to: Numbers | None = None,
    target_spacing: float = _DEFAULTS["target_spacing"],
    confidence: float = _DEFAULTS["confidence"],
    seen_from: str = _DEFAULTS["seen_from"],
    holds_for: str = _DEFAULTS["holds_for"],
    view_spacing: float | None = None,
    max_distance: float | None = None,
    refraction: float = _DEFAULTS["refraction"],
    curvature: bool = _DEFAULTS["curvature"],
    height_reference: str = _DEFAULTS["height_reference"],
    most_lines: float = _DEFAULTS["most_lines"],
    threads: int | None = None,
    memory_budget: int | None = None,
    progress: Progress | None = None,
    names: Sequence[str] | None = None,
) -> VolumeLayer:
    """Tells which targets at one height above the ground are seen, as rasters.

    Args:
        target_height: metres above the ground, the highest terrain at each place (on a bridge, its deck); more than 0.
        target_spacing: side of the cells, metres; a target stands over the middle of each.
        holds_for: "place" and "voxel" as for volume_viewshed(); "target": all of the cell, level, at the target's height.
        all others: as for volume_viewshed().

    Raises:
        ValueError, MemoryError, Cancelled: as volume_viewshed().
    """
    given = locals()
    height = arguments.number("target_height", given.pop("target_height"))
    job = Job(**given)
    layer = VolumeLayer.__new__(VolumeLayer)
    layer._core = volume_core().volume_layer(job.volume, job.views, height, job.options, progress)
    return layer


def volume_targets(
    volume: ErrorVolume,
    views: Sequence[View],
    targets: Positions,
    target_height: Numbers = _DEFAULTS["target_height"],
    target_height_reference: str = _DEFAULTS["height_reference"],
    view_height: Numbers = _DEFAULTS["observer_height"],
    view_height_to: Numbers | None = None,
    confidence: float = _DEFAULTS["confidence"],
    seen_from: str = _DEFAULTS["seen_from"],
    holds_for: str = _DEFAULTS["holds_for"],
    view_spacing: float | None = None,
    max_distance: float | None = None,
    refraction: float = _DEFAULTS["refraction"],
    curvature: bool = _DEFAULTS["curvature"],
    height_reference: str = _DEFAULTS["height_reference"],
    most_lines: float = _DEFAULTS["most_lines"],
    threads: int | None = None,
    memory_budget: int | None = None,
    progress: Progress | None = None,
    names: Sequence[str] | None = None,
) -> TargetSight:
    """Tells of each target whether it is seen from the views, all together, and how sure that is.

    Args:
        targets: sequence of places (x, y), in the volume's CRS.
        target_height: metres above the highest terrain there, or absolute; one value, or one for each target.
        target_height_reference: "ground" or "absolute".
        holds_for: "voxel": all places within half a voxel of the target; "place" and "target": the target alone.
        all others: as for volume_viewshed().

    Targets off the terrain or beneath it have no verdict; the report's warnings count them.

    Raises:
        ValueError: also when no target is on the terrain. MemoryError, Cancelled: as volume_viewshed().
    """
    given = locals()
    places = arguments.positions("targets", given.pop("targets"))
    heights = arguments.one_each("target_height", given.pop("target_height"), len(places), arguments.number, "target")
    reference = arguments.word("target_height_reference", given.pop("target_height_reference"))
    job = Job(**given)
    verdict, p, counts, warnings = volume_core().volume_targets(
        job.volume, job.views, places, heights, reference, job.options, progress
    )
    return TargetSight(verdict, p, {**counts, "warnings": warnings, "version": core.__version__})
