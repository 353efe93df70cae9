# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments as the compiled core takes them. Every complaint is a ValueError that names the argument and the remedy.

numpy is not imported here: a script that touches no array does not wait for it.
"""

from __future__ import annotations

import os
from math import inf, isfinite

from ._loading import core

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import Any, Optional, Union

    import numpy as np
    import numpy.typing as npt

    Path = Union[str, "os.PathLike[str]"]
    FloatArray = npt.NDArray[np.float32]
    Doubles = npt.NDArray[np.float64]
    Position = tuple[float, float]
    Positions = Union[Sequence[Position], npt.NDArray[Any]]
    Numbers = Union[float, Sequence[float], npt.NDArray[Any]]
    Limits = Union[None, float, Sequence[Optional[float]], npt.NDArray[Any]]
    Range = tuple[float, float]
    Ranges = Union[Range, Sequence[Range], npt.NDArray[Any]]
    Box = tuple[float, float, float, float]
    Geotransform = tuple[float, float, float, float, float, float]
    Progress = Callable[[float], Optional[bool]]
    CreationOptions = Union[None, Mapping[str, Any], Sequence[str]]

MOST_THREADS = 1024


def number(name: str, value: Any) -> float:
    """A finite number."""
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        found = float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name} is {value!r}; it must be a number.") from None
    if not isfinite(found):
        raise ValueError(f"{name} is {found}; it must be a finite number.")
    return found


def limit(name: str, value: Any) -> float:
    """A number, or None for no limit."""
    return inf if value is None or value == inf else number(name, value)


def pair(name: str, value: Any) -> tuple[float, float]:
    """Two finite numbers."""
    values = listed(value)
    if values is None or len(values) != 2:
        raise ValueError(f"{name} is {value!r}; it must be a pair of numbers.")
    return number(name, values[0]), number(name, values[1])


def listed(value: Any) -> Sequence[Any] | None:
    """The elements of a list, tuple, array or other iterable; None for a single value."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return value
    if isinstance(value, (str, bytes)) or not hasattr(value, "__iter__"):
        return None
    return list(value)


def positions(name: str, value: Any) -> list[tuple[float, float]]:
    """At least one (x, y)."""
    places = listed(value)
    if places is None or (len(places) == 2 and listed(places[0]) is None):
        raise ValueError(f"{name} is {value!r}; it must be a sequence of (x, y). For a single place write [(x, y)].")
    if not places:
        raise ValueError(f"{name} is empty; give at least one (x, y).")
    kind = name.rstrip("s")
    return [pair(f"(x, y) of {kind} {i}", place) for i, place in enumerate(places, 1)]


def one_each(
    name: str, value: Any, count: int, convert: Callable[[str, Any], Any], of: str = "observer"
) -> list[Any]:
    """`count` values, from one for all or from one per observer (or whatever they are of)."""
    values = listed(value)
    if values is None or (convert is pair and len(values) == 2 and listed(values[0]) is None):
        return [convert(name, value)] * count
    if len(values) != count:
        raise ValueError(
            f"{name} has {len(values)} values for {count} {of}{'s' * (count > 1)}; "
            "give one value for all, or one for each."
        )
    return [convert(f"{name} of {of} {i}", one) for i, one in enumerate(values, 1)]


def names(value: Any, count: int) -> list[str]:
    """What messages and reports call the observers; empty names stand for their numbers."""
    if value is None:
        return [""] * count
    found = [str(one) for one in value]
    if len(found) != count:
        raise ValueError(f"names has {len(found)} values for {count} observers; give one for each.")
    return found


def extent(value: Any) -> core.Extent | None:
    """(x_min, y_min, x_max, y_max), or None."""
    if value is None:
        return None
    box = listed(value)
    if box is None or len(box) != 4:
        raise ValueError(f"extent is {value!r}; it must be (x_min, y_min, x_max, y_max).")
    return core.Extent(*(number("extent", side) for side in box))


def threads(value: Any) -> int:
    """1 or more, or None for all cores (the core's 0)."""
    if value is None:
        return 0
    if not hasattr(value, "__index__") or not 1 <= value <= MOST_THREADS:
        raise ValueError(f"threads is {value!r}; allowed are 1 to {MOST_THREADS}, or None for all cores.")
    return int(value)


def whole(name: str, value: Any, least: int, most: int) -> int:
    """A whole number within limits."""
    if isinstance(value, bool) or not hasattr(value, "__index__") or not least <= value <= most:
        raise ValueError(f"{name} is {value!r}; it must be a whole number from {least} to {most}.")
    return int(value)


def memory_budget(value: Any) -> int:
    """Bytes, or None for the core's own choice (its 0)."""
    if value is None:
        return 0
    found = number("memory_budget", value)
    if not 1 <= found < 2**63:
        raise ValueError(f"memory_budget is {value!r}; it must be a positive number of bytes, or None.")
    return int(found)


def float_array(value: Any) -> FloatArray:
    """C-contiguous float32: the same memory where it is so already, else a copy. Masked becomes NaN."""
    import numpy as np

    if hasattr(value, "mask"):
        value = value.astype(np.float32).filled(np.nan)
    return np.ascontiguousarray(value, dtype=np.float32)


def polylines(name: str, value: Any) -> list[Any]:
    """Arrays (n, 2) of float64 from sequences of two places (x, y) or more; of (x, y, z) z does not count. None for no line."""
    import numpy as np

    lines = [] if value is None else listed(value)
    if lines is None:
        raise ValueError(f"{name} is {value!r}; it must be a sequence of lines, each a sequence of (x, y).")
    found = []
    for number, line in enumerate(lines, 1):
        try:
            places = np.ascontiguousarray(line, dtype=np.float64)
        except (TypeError, ValueError):
            raise ValueError(f"{name}: line {number} is {line!r}; it must be a sequence of (x, y).") from None
        if places.ndim != 2 or places.shape[1] not in (2, 3) or len(places) < 2:
            raise ValueError(
                f"{name}: line {number} has shape {places.shape}; it must be a sequence of two (x, y) or more. For one line write [line]."
            )
        found.append(np.ascontiguousarray(places[:, :2]))
    return found


def word(name: str, value: Any) -> str:
    """One of the core's words, which the core checks."""
    if not isinstance(value, str):
        raise ValueError(f"{name} is {value!r}; it must be a text.")
    return value


def path(name: str, value: Any) -> str:
    """A path as text; '' for None."""
    if value is None:
        return ""
    try:
        found = os.fsdecode(value)
    except TypeError:
        raise ValueError(f"{name} is {value!r}; it must be a path.") from None
    if not found:
        raise ValueError(f"{name} is an empty path; name a file.")
    return found


def creation_options(value: CreationOptions) -> list[str]:
    """KEY=VALUE texts from a dict or a sequence of them."""
    if value is None:
        return []
    if hasattr(value, "items"):
        return [f"{key}={setting}" for key, setting in value.items()]
    options = listed(value)
    if options is None or not all(isinstance(one, str) and "=" in one[1:] for one in options):
        raise ValueError(f"creation_options is {value!r}; write for example {{'COMPRESS': 'ZSTD'}}.")
    return list(options)
