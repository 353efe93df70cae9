# SPDX-License-Identifier: GPL-3.0-or-later
"""Sight lines as drawings: one HTML page with an inline SVG for each profile.

A drawing shows the terrain, the band in which it lies at the confidence asked for, the line of sight (which sags with
the Earth's curve, so that terrain keeps its heights) with the first Fresnel zone of a radio link, and the critical place,
whose surroundings are drawn once more beside it.
"""

import html
import json
import math
from typing import NamedTuple

from . import core
from .line_outputs import critical_index
from .pages import page, ticks
from .text import tr

MOST = 50  # drawings on a page
_WIDTH, _HEIGHT = 860, 300
_WHOLE, _DETAIL = (60, 570), (650, 850)  # left and right edge of the two parts
_TOP, _BOTTOM = 16, 260
_DETAIL_SHARE = 0.02  # of the length, to either side of the critical place
_DETAIL_PLACES = 12  # judged places to either side that the detail shows at least


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
    parts = [f"<p>{summary.format(len(lines), confidence=confidence, **counts)}</p>"]
    if left_out:
        parts.append(f"<p>{tr('The first {} are drawn; {} were left out.').format(MOST, left_out)}</p>")
    z = core.load().two_sided_quantile(confidence, json.loads(error_model).get("tails"))
    parts += [_section(line, z) for line in lines[:MOST]]
    parts.append(f"<h2>{tr('Error model used')}</h2><pre>{html.escape(error_model)}</pre>")
    path.write_text(page(tr("Lines of sight"), parts), encoding="utf-8")


def _section(line, z):
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
    facts += _extra_facts(sight)
    return f"<h2>{title}</h2><p>{' · '.join(facts)}</p>{_drawing(line, z)}"


def _extra_facts(sight):
    facts, whole, zone = [], sight.whole_line, sight.fresnel
    if whole is not None:
        clear = tr("the whole line is clear with P = {:.3f} ± {:.3f}")
        facts.append(clear.format(whole.probability, whole.standard_error))
    if whole is not None and math.isfinite(whole.blocked_bound):
        facts.append(tr("blocked with {:.2g} at most").format(whole.blocked_bound))
    if whole is not None and math.isfinite(whole.blocked_distance):
        most = tr("most often at {:.0f} m, in {:.1%} of the terrains drawn")
        facts.append(most.format(whole.blocked_distance, whole.blocked_share))
    if zone is not None and math.isfinite(zone.clear):
        worst = tr("least clearance {:.0%} of the first Fresnel zone ({:.1f} m) at {:.0f} m, p = {:.3f} for its share")
        facts.append(worst.format(zone.clear, zone.worst_radius, zone.worst_distance, zone.p))
    if whole is not None and math.isfinite(whole.fresnel_probability):
        facts.append(tr("that share is clear with P = {:.3f}").format(whole.fresnel_probability))
    return facts


def _drawing(line, z):
    """The whole profile, and beside it the surroundings of the critical place, where the band can be seen."""
    profile = line.sight.profile
    columns = [profile[name] for name in ("distance", "ground", "sigma", "line")]
    columns.append(profile.get("fresnel", [0.0] * len(columns[0])))
    places = [
        _Place(float(distance), float(ground), z * float(sigma), float(sight), float(zone))
        for distance, ground, sigma, sight, zone in zip(*columns)
    ]
    if not any(math.isfinite(place.ground) for place in places):
        return f"<p>{tr('Nothing is known between the two ends.')}</p>"
    critical = critical_index(line.sight) if math.isfinite(line.sight.critical_distance) else None
    parts = [f"<svg viewBox='0 0 {_WIDTH} {_HEIGHT}' role='img'>"]
    parts += _part(places, critical, _WHOLE, line.verdict)
    if critical is not None:
        parts += _part(*_around(places, critical), _DETAIL, line.verdict)
    return "".join(parts) + "</svg>"


class _Place(NamedTuple):
    distance: float
    ground: float  # NaN where unknown
    band: float  # half its width
    sight: float
    zone: float  # radius of the first Fresnel zone; 0 without radio


def _around(places, critical):
    """The places near the critical one, and its index among them."""
    reach = _DETAIL_SHARE * places[-1].distance
    first, last = max(0, critical - _DETAIL_PLACES), min(len(places), critical + _DETAIL_PLACES + 1)
    while first > 0 and places[critical].distance - places[first - 1].distance < reach:
        first -= 1
    while last < len(places) and places[last].distance - places[critical].distance < reach:
        last += 1
    return places[first:last], critical - first


def _part(places, critical, edges, verdict):
    known = [place for place in places if math.isfinite(place.ground)] or places
    low = min(min(place.ground - place.band, place.sight - place.zone) for place in known)
    high = max(max(place.ground + place.band, place.sight + place.zone) for place in known)
    margin = 0.06 * max(high - low, 1.0)
    frame = _Frame(edges, places[0].distance, places[-1].distance, low - margin, high + margin)
    parts = [frame.axes()]
    for stretch in _stretches(places):
        stretch = _thinned(stretch, frame)
        ground = [frame.at(place.distance, place.ground) for place in stretch]
        upper = [frame.at(place.distance, place.ground + place.band) for place in stretch]
        lower = [frame.at(place.distance, place.ground - place.band) for place in stretch]
        bottom = [frame.at(stretch[-1].distance, frame.low), frame.at(stretch[0].distance, frame.low)]
        parts.append(_shape("polygon", "terrain", ground + bottom))
        parts.append(_shape("polygon", "band", upper + lower[::-1]))
        parts.append(_shape("polyline", "ground", ground))
    along = _thinned(places, frame)
    if any(place.zone for place in along):
        above = [frame.at(place.distance, place.sight + place.zone) for place in along]
        below = [frame.at(place.distance, place.sight - place.zone) for place in along]
        parts.append(_shape("polygon", "zone", above + below[::-1]))
    sight = [frame.at(place.distance, place.sight) for place in along]
    parts.append(_shape("polyline", f"sight {verdict}", sight))
    if critical is not None:
        place = places[critical]
        x, y = frame.at(place.distance, place.ground if math.isfinite(place.ground) else place.sight)
        parts.append(f"<circle class='critical' cx='{x:.1f}' cy='{y:.1f}' r='5'/>")
    return parts


class _Frame:
    """Metres to drawing units between two edges, and the axes."""

    def __init__(self, edges, start, end, low, high):
        self.left, self.right = edges
        self.start, self.end = start, max(end, start + 1e-6)
        self.low, self.high = low, high

    def at(self, distance, height):
        x = self.left + (distance - self.start) / (self.end - self.start) * (self.right - self.left)
        y = _TOP + (self.high - height) / (self.high - self.low) * (_BOTTOM - _TOP)
        return x, y

    def axes(self):
        parts = []
        for height in ticks(self.low, self.high, 5):
            _, y = self.at(self.start, height)
            parts.append(f"<line class='grid' x1='{self.left}' x2='{self.right}' y1='{y:.1f}' y2='{y:.1f}'/>")
            parts.append(f"<text x='{self.left - 8}' y='{y + 4:.1f}' text-anchor='end'>{height:g} m</text>")
        kilometres = self.end >= 5000.0
        for distance in ticks(self.start, self.end, (self.right - self.left) // 60):
            x, _ = self.at(distance, self.low)
            label = f"{distance / 1000.0:g} km" if kilometres else f"{distance:g} m"
            parts.append(f"<text x='{x:.1f}' y='{_BOTTOM + 18}' text-anchor='middle'>{label}</text>")
        return "".join(parts)


def _stretches(places):
    """The profile without its holes."""
    runs, run = [], []
    for place in places:
        if math.isfinite(place.ground):
            run.append(place)
        elif run:
            runs.append(run)
            run = []
    return [one for one in [*runs, run] if one]


def _thinned(places, frame):
    """At most four places for each drawing unit of width: the first and the last, the lowest and the highest."""
    columns = {}
    for place in places:
        columns.setdefault(int(frame.at(place.distance, 0.0)[0]), []).append(place)
    kept = []
    for column in columns.values():
        by_height = sorted(column, key=lambda place: place.ground)
        kept += sorted({column[0], column[-1], by_height[0], by_height[-1]})
    return kept


def _shape(element, style, points):
    return f"<{element} class='{style}' points='{' '.join(f'{x:.1f},{y:.1f}' for x, y in points)}'/>"
