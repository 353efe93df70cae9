# SPDX-License-Identifier: GPL-3.0-or-later
"""Who sees whom: lines of sight between many points, and how sure each is."""

from __future__ import annotations

from math import nan

from . import _arguments as arguments
from ._loading import core
from .dem import Dem, core_dem
from .error_model import ErrorModel, core_model
from .line_of_sight import extras_of
from .viewshed import options_of

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    import numpy as np
    import numpy.typing as npt

    from ._arguments import Numbers, Path, Positions, Progress

_DEFAULTS = core.defaults()


class Intervisibility:
    """A network of sight lines: one row a pair, each column an array; nan (verdict 255) where a pair has no value."""

    __slots__ = ("_columns", "_core")

    def __init__(self, found: core.Intervisibility) -> None:
        self._core = found
        self._columns = found.columns()

    @property
    def columns(self) -> dict[str, npt.NDArray[Any] | list[str]]:
        """The table.

        a, b: the points, counted from 0. status: "ok", "outside" (an end is outside the DEM) or "nodata" (an end stands
        where it has no height). verdict: 0 hidden, 1 uncertain, 2 visible. p, k, distance, azimuth, critical_x, critical_y,
        critical_distance, critical_clearance (height of the line above the ground at the critical place, metres): as of
        LineOfSight. With probability=True also probability, standard_error, blocked_bound (WholeLine); with a frequency
        fresnel_clear, fresnel_p, fresnel_distance (Fresnel: clear, p, worst_distance); with both fresnel_probability.
        """
        return self._columns

    def __len__(self) -> int:
        return len(self._columns["status"])

    def __getitem__(self, column: str) -> Any:
        return self._columns[column]

    def matrix(self, column: str = "verdict") -> npt.NDArray[np.float64]:
        """A column as a table of points against points, nan where there is no pair. Within one list it is symmetric."""
        import numpy as np

        a, b = self._columns["a"], self._columns["b"]
        rows, cols = self._core.shape
        table = np.full((rows, cols or rows), nan)
        table[a, b] = self._columns[column]
        if not cols:
            table[b, a] = self._columns[column]
        return table

    @property
    def report(self) -> dict[str, Any]:
        """too_far (pairs left out: farther apart than max_distance), error_model (JSON), warnings, version."""
        return {
            "too_far": self._core.too_far,
            "error_model": self._core.error_model,
            "warnings": self._core.warnings,
            "version": core.__version__,
        }

    def __repr__(self) -> str:
        return f"<sightbound.Intervisibility: {len(self)} pairs>"


def intervisibility(
    dem: Dem,
    points_a: Positions,
    points_b: Positions | None = None,
    height_a: Numbers = _DEFAULTS["observer_height"],
    height_b: Numbers | None = None,
    max_distance: float | None = None,
    error_model: ErrorModel | None = None,
    confidence: float = _DEFAULTS["confidence"],
    refraction: float = _DEFAULTS["refraction"],
    curvature: bool = _DEFAULTS["curvature"],
    stand: str = _DEFAULTS["stand"],
    height_reference: str = _DEFAULTS["height_reference"],
    ground: Dem | Path | None = None,
    see_across_nodata: bool = _DEFAULTS["see_across_nodata"],
    probability: bool = False,
    realisations: int = _DEFAULTS["realisations"],
    seed: int = _DEFAULTS["seed"],
    probability_stand: str = _DEFAULTS["probability_stand"],
    frequency: float | None = None,
    fresnel_share: float = _DEFAULTS["fresnel_share"],
    threads: int | None = None,
    memory_budget: int | None = None,
    progress: Progress | None = None,
) -> Intervisibility:
    """Judges the lines of sight between many points.

    Args:
        dem: from read_dem() or Dem().
        points_a, points_b: sequences of (x, y), or arrays [n, 2], in the DEM's CRS. Each of `points_a` with each of
            `points_b`; without these each two of `points_a` once, since both ways are the same. Points outside the DEM or
            over nodata get a status, and two in one place are no pair.
        height_a, height_b: metres above ground (or absolute, see height_reference); one value for all, or one for each;
            height_b None takes height_a, which must then be one value.
        max_distance: metres on the ground, inclusive; pairs farther apart are left out. None for no limit.
        Others as of line_of_sight() and viewshed().

    Raises:
        As viewshed().
    """
    given = locals()
    a = _stations("points_a", points_a, "height_a", height_a)
    if points_b is None:
        if height_b is not None:
            raise ValueError("height_b is given without points_b; height_a is that of all points.")
        b = a[:0]
    else:
        b = _stations("points_b", points_b, "height_b", height_a if height_b is None else height_b)
    options = options_of(dem, given)
    options.threads = arguments.threads(threads)
    options.memory_budget = arguments.memory_budget(memory_budget)
    reach = arguments.limit("max_distance", max_distance)
    model = core_model(error_model, dem)
    found = core.intervisibility(core_dem(dem), a, b, model, options, extras_of(given), reach, progress)
    return Intervisibility(found)


def _stations(name: str, points: Any, height_name: str, heights: Any) -> npt.NDArray[np.float64]:
    """Array [n, 3] of x, y and height."""
    import numpy as np

    places = arguments.positions(name, points)
    each = arguments.one_each(height_name, heights, len(places), arguments.number, of="point")
    return np.array([(x, y, height) for (x, y), height in zip(places, each)])
