# SPDX-License-Identifier: GPL-3.0-or-later
"""Quantities of the error model: numbers, rasters and arrays; accuracies turned into standard deviations."""

from __future__ import annotations

import os

from . import _arguments as arguments
from ._loading import core

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any, Union

    import numpy.typing as npt

    from ._arguments import FloatArray, Path

    Quantity = Union[None, float, Path, tuple[Path, int], npt.ArrayLike]

# accuracy -> the core's conversion to one standard deviation (along one axis)
_CONVERSIONS = {
    "le90": core.vertical_sigma_of_le90,
    "le95": core.vertical_sigma_of_le95,
    "ce90": core.horizontal_sigma_of_ce90,
    "ce95": core.horizontal_sigma_of_ce95,
}


def is_path(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def is_array(value: Any) -> bool:
    return isinstance(value, (list, tuple)) or getattr(value, "ndim", 0) > 0


def from_argument(field: str, value: Quantity) -> Any:
    """None, a float, (path, band), or a float32 array [rows, cols]."""
    if value is None:
        return None
    if is_path(value):
        return arguments.path(field, value), 1
    if isinstance(value, tuple) and len(value) == 2 and is_path(value[0]):
        return arguments.path(field, value[0]), int(value[1])
    if is_array(value):
        return _array(field, value)
    return arguments.number(field, value)


def only_one(**accuracies: Any) -> tuple[str, Any] | None:
    """The name and value of the accuracy that was given, if any."""
    given = [(name, value) for name, value in accuracies.items() if value is not None]
    if len(given) > 1:
        raise ValueError(f"{' and '.join(name for name, _ in given)} say the same thing; give one of them.")
    return given[0] if given else None


def standard_deviation(name: str, value: Any) -> Any:
    """The accuracy `name` as one standard deviation: of a number, or of each value of an array."""
    convert = _CONVERSIONS.get(name)
    if convert is None:
        return value
    if is_path(value):
        raise ValueError(
            f"{name} is a path; only a number or an array can be converted. Give a raster of rmse as rmse."
        )
    if is_array(value):
        return _array(name, value) * convert(1.0)
    return convert(arguments.number(name, value))


def class_table(value: Mapping[str, float] | Path | None) -> dict[str, float]:
    """terrain_table as a dict; empty stands for the default."""
    if value is None:
        return {}
    if hasattr(value, "items"):
        return {str(name): arguments.number(f"terrain_table[{name!r}]", metres) for name, metres in value.items()}
    return core.read_terrain_table(arguments.path("terrain_table", value))


def _array(field: str, value: Any) -> FloatArray:
    values = arguments.float_array(value)
    if values.ndim != 2:
        raise ValueError(f"{field} has shape {values.shape}; it must be a number, a raster, or an array [rows, cols].")
    return values
