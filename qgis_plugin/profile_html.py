# SPDX-License-Identifier: GPL-3.0-or-later
"""Sight lines as drawings: one HTML page with an inline SVG for each profile.

A drawing shows the terrain, the band in which it lies at the confidence asked for, the line of sight (which sags with
the Earth's curve, so that terrain keeps its heights), and the critical place.
"""

import html
import math
from pathlib import Path
from statistics import NormalDist

from .line_outputs import critical_index
from .text import tr

MOST = 50  # drawings on a page
_WIDTH, _HEIGHT = 860, 300
_LEFT, _RIGHT, _TOP, _BOTTOM = 64, 16, 16, 40
_STYLE = Path(__file__).parent / "styles" / "profiles.css"


def write_profiles(path, lines, confidence, error_model):
    """Writes the page; of more than MOST lines the first are drawn and the number of the others is said."""
    left_out = max(0, len(lines) - MOST)
    counts = {
        verdict: sum(line.verdict == verdict for line in lines)
        for verdict in ("visible", "uncertain", "hidden")
    }
    summary = tr(
        "{} lines: {visible} visible, {uncertain} uncertain, {hidden} hidden at a confidence of {confidence:g}."
    )
    title = tr("Lines of sight")
    style = _STYLE.read_text(encoding="utf-8")
    parts = [
        "<!DOCTYPE html>",
        f"<html><head><meta charset='utf-8'><title>{title}</title><style>{style}</style></head><body>",
        f"<h1>{title}</h1>",
        f"<p>{summary.format(len(lines), confidence=confidence, **counts)}</p>",
    ]
    if left_out:
        parts.append(f"<p>{tr('The first {} are drawn; {} were left out.').format(MOST, left_out)}</p>")
    parts += [_section(line, confidence) for line in lines[:MOST]]
    parts.append(f"<h2>{tr('Error model used')}</h2><pre>{html.escape(error_model)}</pre></body></html>")
    path.write_text("\n".join(parts), encoding="utf-8")


def _section(line, confidence):
    sight = line.sight
    title = f"{html.escape(line.observer.name)} → {html.escape(line.target.name)}"
    facts = [
        f"<b class='{line.verdict}'>{tr(line.verdict)}</b>",
        tr("p = {:.3f}").format(sight.p),
        tr("distance {:.0f} m").format(sight.distance),
    ]
    if math.isfinite(sight.critical_distance):
        facts.append(tr("critical place at {:.0f} m, k = {:.2f}").format(sight.critical_distance, sight.k))
    if math.isfinite(sight.required_height):
        facts.append(
            tr("surely visible from {:.1f} m above the target's ground").format(sight.required_height)
        )
    return f"<h2>{title}</h2><p>{' · '.join(facts)}</p>{_drawing(line, confidence)}"


def _drawing(line, confidence):
    z = NormalDist().inv_cdf((1.0 + confidence) / 2.0)
    places = [
        (float(d), float(g), float(s), float(h))
        for d, g, s, h in zip(*(line.sight.profile[name] for name in ("distance", "ground", "sigma", "line")))
    ]
    known = [place for place in places if math.isfinite(place[1])]
    if not known:
        return f"<p>{tr('Nothing lies between the two ends.')}</p>"
    low = min(min(g - z * s, h) for _, g, s, h in known)
    high = max(max(g + z * s, h) for _, g, s, h in known)
    margin = 0.06 * max(high - low, 1.0)
    frame = _Frame(line.sight.distance, low - margin, high + margin)
    parts = [f"<svg viewBox='0 0 {_WIDTH} {_HEIGHT}' role='img'>", frame.axes()]
    for stretch in _stretches(places):
        stretch = _thinned(stretch, frame)
        ground = [frame.at(d, g) for d, g, _, _ in stretch]
        upper = [frame.at(d, g + z * s) for d, g, s, _ in stretch]
        lower = [frame.at(d, g - z * s) for d, g, s, _ in stretch]
        bottom = [frame.at(stretch[-1][0], frame.low), frame.at(stretch[0][0], frame.low)]
        parts.append(_shape("polygon", "terrain", ground + bottom))
        parts.append(_shape("polygon", "band", upper + lower[::-1]))
        parts.append(_shape("polyline", "ground", ground))
    parts.append(
        _shape(
            "polyline", f"sight {line.verdict}", [frame.at(d, h) for d, _, _, h in _thinned(places, frame)]
        )
    )
    if math.isfinite(line.sight.critical_distance):
        d, g, _, h = places[critical_index(line.sight)]
        x, y = frame.at(d, g if math.isfinite(g) else h)
        parts.append(f"<circle class='critical' cx='{x:.1f}' cy='{y:.1f}' r='5'/>")
    return "".join(parts) + "</svg>"


class _Frame:
    """Metres to drawing units, and the axes."""

    def __init__(self, length, low, high):
        self.length, self.low, self.high = max(length, 1e-6), low, high

    def at(self, distance, height):
        x = _LEFT + distance / self.length * (_WIDTH - _LEFT - _RIGHT)
        y = _TOP + (self.high - height) / (self.high - self.low) * (_HEIGHT - _TOP - _BOTTOM)
        return x, y

    def axes(self):
        parts = []
        for height in _ticks(self.low, self.high, 5):
            x, y = self.at(0.0, height)
            parts.append(
                f"<line class='grid' x1='{_LEFT}' x2='{_WIDTH - _RIGHT}' y1='{y:.1f}' y2='{y:.1f}'/>"
            )
            parts.append(f"<text x='{_LEFT - 8}' y='{y + 4:.1f}' text-anchor='end'>{height:g} m</text>")
        kilometres = self.length >= 5000.0
        for distance in _ticks(0.0, self.length, 8):
            x, _ = self.at(distance, self.low)
            label = f"{distance / 1000.0:g} km" if kilometres else f"{distance:g} m"
            parts.append(
                f"<text x='{x:.1f}' y='{_HEIGHT - _BOTTOM + 18}' text-anchor='middle'>{label}</text>"
            )
        return "".join(parts)


def _ticks(low, high, most):
    """Round numbers between low and high, at most `most` steps."""
    raw = (high - low) / most
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(power * factor for factor in (1, 2, 5, 10) if power * factor >= raw)
    first, last = math.ceil(low / step), math.floor(high / step)
    return [round(index * step, 10) for index in range(first, last + 1)]


def _stretches(places):
    """The profile without its holes."""
    runs, run = [], []
    for place in places:
        if math.isfinite(place[1]):
            run.append(place)
        elif run:
            runs.append(run)
            run = []
    return [one for one in runs + [run] if one]


def _thinned(places, frame):
    """At most four places for each drawing unit of width: those that are lowest and highest, first and last."""
    columns = {}
    for place in places:
        columns.setdefault(int(frame.at(place[0], 0.0)[0]), []).append(place)
    kept = []
    for column in columns.values():
        best = {
            column[0],
            column[-1],
            min(column, key=lambda one: one[1]),
            max(column, key=lambda one: one[1]),
        }
        kept += sorted(best)
    return kept


def _shape(element, style, points):
    return f"<{element} class='{style}' points='{' '.join(f'{x:.1f},{y:.1f}' for x, y in points)}'/>"
