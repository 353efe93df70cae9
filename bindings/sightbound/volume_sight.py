# SPDX-License-Identifier: GPL-3.0-or-later
"""Sight in an error volume: from points and patrol areas, to all places above ground."""

from __future__ import annotations

from collections import namedtuple

from . import _arguments as arguments
from ._loading import core, volume_core
from .hidden_volume import HiddenVolume, core_hidden, wrapped
from .volume import ErrorVolume, core_volume

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any, NamedTuple, Optional, Union

    from . import _volume
    from ._arguments import Numbers, Position, Progress

    View = Union[Position, Sequence[Position], Sequence[Sequence[Position]]]

    class Subtraction(NamedTuple):
        rest: HiddenVolume
        gain: dict[str, Any]

else:
    Subtraction = namedtuple("Subtraction", "rest gain")
    Subtraction.__doc__ = """What a further observer leaves hidden, and what he gains.

    rest: HiddenVolume
    gain: gained_m2, gained_core_m2: ground that hid a thing of the height asked and no longer does; gained_m3: not visible
        before, visible now; gained_core_m3: no longer surely hidden; before, after: HiddenVolume.area() of both.
    """

_DEFAULTS = core.defaults()


def volume_viewshed(
    volume: ErrorVolume,
    views: Sequence[View],
    view_height: Numbers = _DEFAULTS["observer_height"],
    view_height_to: Optional[Numbers] = None,
    target_ceiling: float = _DEFAULTS["target_ceiling"],
    target_spacing: float = _DEFAULTS["target_spacing"],
    target_height_spacing: float | None = None,
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
) -> HiddenVolume:
    """Tells for all places above ground whether they are seen, and how sure that is.

    The arguments marked * take one value for all views, or a sequence with one value for each.

    Args:
        volume: from ErrorVolume.build() or open().
        views: sequence of places (x, y), and of areas, each the corners [(x, y), (x, y), (x, y) ...] of a polygon in which
            the observer may be anywhere, or its rings [[(x, y) ...], [(x, y) ...]]: the outline, then the holes (inside is
            what an odd number of rings goes round); in the volume's CRS.
        view_height: * of the eye, metres above ground (or absolute, see height_reference).
        view_height_to: * upper end of the heights that the eye may have; None for view_height alone.
        target_ceiling: up to which height above ground is asked, metres.
        target_spacing: of the places asked, in plan, metres.
        target_height_spacing: in height; None for the lesser of target_spacing and a quarter of the ceiling.
        confidence: of a claim, between 0 and 1.
        seen_from: "any": a target counts as seen when it is seen from some place of the views; "all": from every place.
        holds_for: what a claim speaks of: "place", the target's centre alone; "voxel", all places within half a voxel of
            the error volume; "target", all of the target's box above ground. Claims that do not hold so far are uncertain.
        view_spacing: between the places of an area, metres; None for an eighth of the area, at least target_spacing. Each
            stands for a cell: hidden means hidden from all of the area, visible seen from one of the places.
        max_distance: metres in plan; None for no limit. Targets beyond are not asked.
        refraction: coefficient of refraction; 0 for none.
        curvature: False for a flat Earth.
        height_reference: "ground" or "absolute", of the views.
        most_lines: more lines of sight are refused, with the spacing that would fit.
        threads: None for all cores. The result does not depend on it.
        memory_budget: bytes; None for three quarters of the memory.
        progress: called with the fraction done, at most ten times a second; False cancels.
        names: what messages call the views; None for their numbers.

    Raises:
        ValueError: a wrong argument, named in the message; a view off the terrain; too many lines.
        MemoryError: the job would exceed the memory budget; nothing was begun.
        Cancelled: progress returned False.
    """
    job = Job(**locals())
    return wrapped(*volume_core().volume_viewshed(job.volume, job.views, job.options, progress))


def estimate_volume_viewshed(
    volume: ErrorVolume,
    views: Sequence[View],
    view_height: Numbers = _DEFAULTS["observer_height"],
    view_height_to: Optional[Numbers] = None,
    target_ceiling: float = _DEFAULTS["target_ceiling"],
    target_spacing: float = _DEFAULTS["target_spacing"],
    target_height_spacing: float | None = None,
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
) -> dict[str, Any]:
    """What volume_viewshed() with these arguments would take: view_places, targets, lines, bytes, seconds (about).

    The seconds come from some lines timed through the volume. Raises what volume_viewshed() raises.
    """
    job = Job(**locals())
    return volume_core().estimate_sight(job.volume, job.views, job.options, progress)


def subtract_observer(
    hidden: HiddenVolume,
    volume: ErrorVolume,
    views: Sequence[View],
    view_height: Numbers = _DEFAULTS["observer_height"],
    view_height_to: Optional[Numbers] = None,
    height: float = 1.8,
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
) -> Subtraction:
    """Takes from a hidden volume what further observers see.

    Args:
        hidden: of volume_viewshed(); its targets and its confidence are asked again.
        volume: the error volume that `hidden` was made with.
        height: of the thing to hide, metres, for the gain in ground.
        views and all others: as for volume_viewshed().

    Raises:
        ValueError: also when `volume` is another one than `hidden` was made with.
    """
    before = core_hidden(hidden)
    lattice = before.lattice()
    given = dict(locals(), target_ceiling=lattice["ceiling"], target_spacing=lattice["spacing"],
                 target_height_spacing=lattice["height_spacing"], confidence=before.confidence)
    for name in ("hidden", "before", "lattice", "height"):
        given.pop(name)
    job = Job(**given)
    found, gain, estimate, warnings = volume_core().subtract_observer(
        before, job.volume, job.views, job.options, arguments.number("height", height), progress
    )
    return Subtraction(wrapped(found, estimate, warnings), gain)


class Job:
    """The arguments, checked, as the core takes them."""

    __slots__ = ("options", "views", "volume")

    def __init__(self, volume: Any, views: Any, names: Any, progress: Any, **given: Any) -> None:
        self.volume = core_volume(volume)
        self.views = _views(views, given["view_height"], given["view_height_to"], names)
        options = volume_core().VolumeSightOptions()
        options.confidence = arguments.number("confidence", given["confidence"])
        options.refraction = arguments.number("refraction", given["refraction"])
        options.curvature = bool(given["curvature"])
        options.seen_from = arguments.word("seen_from", given["seen_from"])
        options.holds_for = arguments.word("holds_for", given["holds_for"])
        options.height_reference = arguments.word("height_reference", given["height_reference"])
        options.max_distance = arguments.limit("max_distance", given["max_distance"])
        for spacing in ("target_spacing", "target_ceiling", "target_height_spacing", "view_spacing"):
            if given.get(spacing) is not None:
                setattr(options, spacing, arguments.number(spacing, given[spacing]))
        options.most_lines = arguments.number("most_lines", given["most_lines"])
        options.threads = arguments.threads(given["threads"])
        options.memory_budget = arguments.memory_budget(given["memory_budget"])
        self.options = options


def _views(views: Any, height: Any, height_to: Any, names: Any) -> list[_volume.ViewVolume]:
    outlines = arguments.listed(views)
    if outlines is None or (outlines and arguments.listed(outlines[0]) is None):
        raise ValueError(f"views is {views!r}; it must be a sequence of (x, y) or of polygons. For one place: [(x, y)].")
    if not outlines:
        raise ValueError("views is empty; give at least one (x, y).")
    count = len(outlines)
    lower = arguments.one_each("view_height", height, count, arguments.number)
    upper = lower if height_to is None else arguments.one_each("view_height_to", height_to, count, arguments.number)
    rows = zip(outlines, lower, upper, arguments.names(names, count))
    return [volume_core().ViewVolume(_rings(i, one), *rest) for i, (one, *rest) in enumerate(rows, 1)]


def _rings(number: int, view: Any) -> list[list[tuple[float, float]]]:
    """One (x, y), the corners of a polygon, or rings of corners."""
    depth, first = 0, view
    while (inner := arguments.listed(first)) and depth < 3:
        depth, first = depth + 1, inner[0]
    rings = [[view]] if depth < 2 else [view] if depth == 2 else view
    name = f"(x, y) of view {number}"
    return [[arguments.pair(name, corner) for corner in arguments.listed(ring) or [ring]] for ring in rings]
