# SPDX-License-Identifier: GPL-3.0-or-later
"""HTML pages with drawings: what they have in common."""

import math
from pathlib import Path

_STYLE = Path(__file__).parent / "styles" / "pages.css"


def page(title, parts):
    """The text of a page; `parts` is what stands in its body."""
    style = _STYLE.read_text(encoding="utf-8")
    head = f"<html><head><meta charset='utf-8'><title>{title}</title><style>{style}</style></head><body>"
    return "\n".join(["<!DOCTYPE html>", head, f"<h1>{title}</h1>", *parts, "</body></html>"])


def ticks(low, high, most):
    """Round numbers between low and high, at most `most` steps."""
    raw = (high - low) / most
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(power * factor for factor in (1, 2, 5, 10) if power * factor >= raw)
    first, last = math.ceil(low / step), math.floor(high / step)
    return [round(index * step, 10) for index in range(first, last + 1)]
