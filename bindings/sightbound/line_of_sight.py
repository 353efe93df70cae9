# SPDX-License-Identifier: GPL-3.0-or-later
"""Is one line of sight clear, how sure is that, and where is it decided?"""

from __future__ import annotations

from . import _arguments as arguments
from ._loading import core
from .dem import Dem, core_dem
from .error_model import ErrorModel, core_model
from .viewshed import observers_of, options_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from ._arguments import Doubles, Numbers, Path, Position, Positions, Progress

_DEFAULTS = core.defaults()
_LIMITS = ("min_distance", "max_distance", "azimuth", "vertical_angle")


class LineOfSight:
    """The answer for one observer and one target. Heights are absolute metres unless said otherwise."""

    __slots__ = ("_core",)

    def __init__(self, result: core.LineOfSight) -> None:
        self._core = result

    @property
    def p(self) -> float:
        """Pointwise confidence of visibility, 0 (surely hidden) to 1 (surely visible)."""
        return self._core.p

    @property
    def k(self) -> float:
        """The critical clearance ratio: least clearance of the line over the terrain, in standard deviations."""
        return self._core.k

    @property
    def verdict(self) -> int:
        """0 hidden, 1 uncertain, 2 visible; 255 where the target's ground is unknown."""
        return self._core.verdict

    @property
    def critical(self) -> Position:
        """(x, y) of the place that decides, in the DEM's CRS; nan where the two are too near for any."""
        return self._core.critical

    @property
    def critical_distance(self) -> float:
        """Its distance from the observer on the ground, metres."""
        return self._core.critical_distance

    @property
    def distance(self) -> float:
        """From observer to target on the ground, metres."""
        return self._core.distance

    @property
    def azimuth(self) -> float:
        """Of the target at the observer, degrees clockwise from true north."""
        return self._core.azimuth

    @property
    def required_height(self) -> float:
        """Metres above ground from which on a target there is certainly visible."""
        return self._core.required_height

    @property
    def likely_height(self) -> float:
        """Metres above ground from which on a target there is rather visible than not."""
        return self._core.likely_height

    @property
    def profile(self) -> dict[str, Doubles]:
        """All judged places by distance: read-only float64 arrays of one length.

        distance (metres from the observer), x, y (the DEM's CRS), ground (height of the terrain, metres, nan unknown),
        sigma (metres), line (height of the line of sight over the same datum, Earth's curve and refraction included),
        clearance ((line - ground) / sigma).
        """
        return self._core.profile()

    @property
    def report(self) -> dict[str, Any]:
        """observer_ground, eye_height, target_ground, target_top (metres), error_model (JSON), warnings, version."""
        return {
            "observer_ground": self._core.observer_ground,
            "eye_height": self._core.eye_height,
            "target_ground": self._core.target_ground,
            "target_top": self._core.target_top,
            "error_model": self._core.error_model,
            "warnings": self._core.warnings,
            "version": core.__version__,
        }

    def __repr__(self) -> str:
        return f"<sightbound.LineOfSight: p={self.p:.4f}, k={self.k:.3f}, {self.distance:.1f} m>"


def line_of_sight(
    dem: Dem,
    observer: Position,
    target: Position,
    observer_height: float = _DEFAULTS["observer_height"],
    target_height: float = _DEFAULTS["target_height"],
    error_model: ErrorModel | None = None,
    confidence: float = _DEFAULTS["confidence"],
    refraction: float = _DEFAULTS["refraction"],
    curvature: bool = _DEFAULTS["curvature"],
    stand: str = _DEFAULTS["stand"],
    height_reference: str = _DEFAULTS["height_reference"],
    ground: Dem | Path | None = None,
    see_across_nodata: bool = _DEFAULTS["see_across_nodata"],
    progress: Progress | None = None,
) -> LineOfSight:
    """Judges the line from `observer` to `target`, both (x, y) in the DEM's CRS.

    The target need not be a cell's centre; at one, the answer is that of viewshed(). The other arguments, and what is
    raised, are those of viewshed().
    """
    given = locals()
    given["observers"] = [arguments.pair("observer", observer)]
    given["targets"] = [arguments.pair("target", target)]
    return _judge(given)[0]


def lines_of_sight(
    dem: Dem,
    observers: Positions,
    targets: Positions,
    observer_height: Numbers = _DEFAULTS["observer_height"],
    target_height: Numbers = _DEFAULTS["target_height"],
    error_model: ErrorModel | None = None,
    confidence: float = _DEFAULTS["confidence"],
    refraction: float = _DEFAULTS["refraction"],
    curvature: bool = _DEFAULTS["curvature"],
    stand: str = _DEFAULTS["stand"],
    height_reference: str = _DEFAULTS["height_reference"],
    ground: Dem | Path | None = None,
    see_across_nodata: bool = _DEFAULTS["see_across_nodata"],
    progress: Progress | None = None,
) -> list[LineOfSight]:
    """Judges many lines, the i-th from observers[i] to targets[i]: line_of_sight() for each, the error estimated once.

    observer_height and target_height take one value for all lines, or one for each.
    """
    return _judge(locals())


def _judge(given: dict[str, Any]) -> list[LineOfSight]:
    dem = given["dem"]
    source, model = core_dem(dem), core_model(given["error_model"], dem)
    targets = arguments.positions("targets", given["targets"])
    observers = observers_of(given["observers"], None, {**given, **{name: _DEFAULTS[name] for name in _LIMITS}})
    if len(observers) != len(targets):
        counts = f"observers has {len(observers)} places, targets has {len(targets)}"
        raise ValueError(f"{counts}; a line needs one of each.")
    lines = core.lines_of_sight(source, observers, targets, model, options_of(dem, given), given["progress"])
    return [LineOfSight(line) for line in lines]
