# SPDX-License-Identifier: GPL-3.0-or-later
"""How far is a simplified TIN from its original, everywhere?"""

from __future__ import annotations

from . import _arguments as arguments
from ._loading import core
from .dem import Dem
from .tin import Tin

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Union

    import numpy.typing as npt

    from ._arguments import FloatArray, Progress

    Tolerance = Union[float, npt.ArrayLike]


class Verification:
    """What verify() found."""

    __slots__ = ("_deviation", "_report")

    _report: dict[str, Any]
    _deviation: FloatArray

    def __init__(self) -> None:
        raise TypeError("Use verify().")

    @property
    def within_tolerance(self) -> bool:
        """Is it certain that no place deviates by more than the tolerance there?"""
        return self._report["within_tolerance"]

    @property
    def well_formed(self) -> bool:
        """Is no face flipped, folded or degenerate?"""
        return self._report["well_formed"]

    @property
    def largest_deviation(self) -> float:
        """No place deviates by more, metres; certified."""
        return self._report["largest_deviation"]["bound"]

    @property
    def largest_ratio(self) -> float:
        """Deviation / tolerance is nowhere more; certified."""
        return self._report["largest_ratio"]["bound"]

    @property
    def vertex_deviation(self) -> FloatArray:
        """float32: simplified less original height (method "distance": the distance) at each vertex of the original, metres.

        One for each vertex of a Tin; of a Dem an array [rows, cols]. NaN where nothing covers it, or there is no sample.
        """
        return self._deviation

    @property
    def report(self) -> dict[str, Any]:
        """All that was found; metres and square metres, places (x, y, z) in the CRS, faces counted from 0.

        method: "vertical", or "distance" where the original is no height field
        largest_deviation, largest_ratio: dicts of bound (certified), measured (at corners of pieces, or at samples), place (on
            the simplified TIN), face (of it)
        within_tolerance, well_formed
        flipped (faces that look down), folded (others lie above or below them), degenerate (without width): dicts of count
            and first; flipped and folded only of method "vertical"
        uncovered (ground of the original under no simplified face), surplus (the other way round): dicts of m2 and place,
            the middle of the face with most of it; only of method "vertical"
        uncovered_vertices: of the original
        resolution: no bound is more above the truth than about that, metres
        faces_before, faces_after (of the original, of the simplified), pieces (of the overlay, or triangles looked at)
        mean_deviation, rms_deviation, histogram (low, high, counts): at the vertices of the original
        warnings: what was repaired when the simplified TIN was read; version
        """
        return self._report

    def __repr__(self) -> str:
        return f"<Verification, largest deviation {self.largest_deviation:.6g} m, ratio {self.largest_ratio:.6g}>"


def verify(
    original: Tin | Dem,
    simplified: Tin,
    tolerance: Tolerance,
    resolution: float | None = None,
    threads: int | None = None,
    memory_budget: int | None = None,
    progress: Progress | None = None,
) -> Verification:
    """Certifies how far a simplified TIN is from its original, whoever made it.

    Of height fields the vertical deviation is looked at on every piece of the overlay of both triangulations, so its largest
    value is known, not sampled; bounds are outward of rounding. Of other TINs distances are taken both ways, on
    triangles that are cut until no bound is more than `resolution` above the truth: they hold everywhere (with a tolerance
    that varies, that of the ratio from the simplified to the original at samples).

    Args:
        original: a Tin, or a Dem: its samples, each square of four split along the NW-SE diagonal, without triangles that have
            a nodata corner.
        simplified: a Tin in the same CRS.
        tolerance: metres, more than 0; one number, or one for each vertex of the original (of a Dem an array [rows, cols]),
            linear between them.
        resolution: of TINs that are no height fields, metres; None for a 64th of the largest distance or of the tolerance. The
            report says what was reached.
        threads: None for all cores. The result does not depend on it.
        memory_budget: bytes; None for three quarters of the memory.
        progress: called with the fraction done, at most ten times a second; False cancels.

    Raises:
        ValueError: two CRSs, no place in common, a tolerance of 0 or of wrong length.
        MemoryError: the job would exceed the memory budget. OSError: the DEM cannot be read.
        Cancelled: progress returned False.
    """
    for name, value, kinds in (("original", original, (Tin, Dem)), ("simplified", simplified, (Tin,))):
        if not isinstance(value, kinds):
            wanted = " or ".join(f"sightbound.{kind.__name__}" for kind in kinds)
            raise TypeError(f"{name} must be a {wanted}; got {type(value).__name__}.")
    is_dem = isinstance(original, Dem)
    metres, values = _tolerance(tolerance, original.shape if is_dem else (original._core.vertex_count,))
    made = Verification.__new__(Verification)
    found, deviation = (core.verify_dem if is_dem else core.verify_tin)(
        original._core,
        simplified._core,
        metres,
        values,
        0.0 if resolution is None else arguments.number("resolution", resolution),
        arguments.threads(threads),
        arguments.memory_budget(memory_budget),
        progress,
    )
    made._deviation = deviation.reshape(original.shape) if is_dem else deviation
    made._report = {**found, "warnings": simplified.notes, "version": core.__version__}
    return made


def _tolerance(value: Any, shape: tuple[int, ...]) -> tuple[float, FloatArray | None]:
    """One number and None, or 0 and one number for each vertex."""
    if not hasattr(value, "__len__") or getattr(value, "shape", None) == ():
        return arguments.number("tolerance", value), None
    values = arguments.float_array(value)
    if values.shape != shape:
        raise ValueError(f"tolerance has the shape {values.shape}; give one number, or an array of {shape}.")
    return 0.0, values.ravel()
