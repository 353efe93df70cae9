# SPDX-License-Identifier: GPL-3.0-or-later
"""Is one line of sight clear, how sure is that, and where is it decided?"""

from __future__ import annotations

from collections import namedtuple

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


class WholeLine(
    namedtuple(
        "WholeLine",
        "probability standard_error interval verdict blocked_bound blocked_at blocked_distance blocked_share "
        "fresnel_probability realisations seed places",
    )
):
    """The probability that a whole line is clear, over terrains that could lie behind the DEM.

    probability: share of the realisations in which the line is nowhere below the ground.
    standard_error: of that, one standard deviation.
    interval: (low, high), of 95 % for the probability (Wilson 1927).
    verdict: 0 hidden, 1 uncertain, 2 visible; a claim needs the nearer end of the interval to hold.
    blocked_bound: the probability of being blocked is no larger, however many terrains were drawn; nan where what is drawn is no
        sum of independent normal numbers: other tails, errors that are correlated, steps that count.
    blocked_at: (x, y) of the place where most realisations block the line; nan where none does.
    blocked_distance: of it from the observer, metres.
    blocked_share: of the realisations that block the line there.
    fresnel_probability: that fresnel_share of the first Fresnel zone is clear too; nan without a frequency.
    realisations, seed: what was drawn.
    places: arrays distance, x, y and blocked (share of the realisations that block the line there).
    """

    __slots__ = ()


class Fresnel(namedtuple("Fresnel", "clear worst worst_distance worst_radius middle_radius k p verdict")):
    """The first Fresnel zone of a radio link, of radius sqrt(wavelength d1 d2 / D).

    clear: least clearance of the DEM in radii of the zone; 0.6 is nearly as good as free space.
    worst, worst_distance, worst_radius: (x, y) of the place with it, metres from the observer, the zone's radius there.
    middle_radius: half-way, metres.
    k, p, verdict: as of LineOfSight, for a line lowered by fresnel_share of the radius: the pointwise confidence that this
        share of the zone is clear.
    """

    __slots__ = ()


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
        clearance ((line - ground) / sigma); with a frequency also fresnel (radius of the first Fresnel zone, metres).
        """
        return self._core.profile()

    @property
    def critical_clearance(self) -> float:
        """Height of the line above the ground at the critical place, metres; negative below it."""
        return self._core.critical_clearance

    @property
    def whole_line(self) -> WholeLine | None:
        """What terrains drawn behind the DEM say of the whole line; None unless probability=True."""
        found = self._core.whole_line()
        return None if found is None else WholeLine(**found)

    @property
    def probability(self) -> float | None:
        """That the whole line is clear; None unless probability=True."""
        found = self._core.whole_line()
        return None if found is None else found["probability"]

    @property
    def fresnel(self) -> Fresnel | None:
        """Clearance of the first Fresnel zone; None without a frequency."""
        found = self._core.fresnel()
        return None if found is None else Fresnel(**found)

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
    probability: bool = False,
    realisations: int = _DEFAULTS["realisations"],
    seed: int = _DEFAULTS["seed"],
    probability_stand: str = _DEFAULTS["probability_stand"],
    frequency: float | None = None,
    fresnel_share: float = _DEFAULTS["fresnel_share"],
) -> LineOfSight:
    """Judges the line from `observer` to `target`, both (x, y) in the DEM's CRS.

    The target need not be a cell's centre; at one, the answer is that of viewshed(). The other arguments, and what is
    raised, are those of viewshed().

    Args:
        probability: also draw terrains that could lie behind the DEM, those of probable_viewshed(), and count in how many the
            whole line is clear: LineOfSight.whole_line.
        realisations: terrains drawn, 1 to 65535.
        seed: 0 or more; another one draws other terrains.
        probability_stand: "ground": in each of them both ends stand on its ground; "model": they are at the heights that the
            DEM gives. Absolute heights never move.
        frequency: of a radio link, MHz (1 to 1,000,000): LineOfSight.fresnel. Radio is usually planned with refraction=0.25
            (4/3 of the Earth's radius); the default, 0.13, is that of light.
        fresnel_share: of the first Fresnel zone's radius that is to be clear.
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
    probability: bool = False,
    realisations: int = _DEFAULTS["realisations"],
    seed: int = _DEFAULTS["seed"],
    probability_stand: str = _DEFAULTS["probability_stand"],
    frequency: float | None = None,
    fresnel_share: float = _DEFAULTS["fresnel_share"],
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
    options, extras = options_of(dem, given), extras_of(given)
    lines = core.lines_of_sight(source, observers, targets, model, options, extras, given["progress"])
    return [LineOfSight(line) for line in lines]


def extras_of(given: dict[str, Any]) -> core.LineExtras:
    """What is asked beside p."""
    extras = core.LineExtras()
    if given["probability"]:
        extras.set_whole_line(
            arguments.whole("realisations", given["realisations"], 1, 65535),
            arguments.whole("seed", given["seed"], 0, 2**63 - 1),
            arguments.word("probability_stand", given["probability_stand"]),
        )
    if given["frequency"] is not None:
        share = arguments.number("fresnel_share", given["fresnel_share"])
        extras.set_radio(arguments.number("frequency", given["frequency"]), share)
    return extras
