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
from .log import counted
from .pages import page, ticks
from .text import tr

MOST = 50  # drawings on a page
_WIDTH, _HEIGHT = 860, 300
_WHOLE, _DETAIL = (60, 570), (650, 836)  # left and right edge of the two parts
_TOP, _BOTTOM = 16, 260
_DETAIL_SHARE = 0.02  # of the length, to either side of the critical place
_LETTER = 5.9  # drawing units that a letter of the key takes
_DETAIL_PLACES = 12  # judged places to either side that the detail shows at least


def write_profiles(path, lines, confidence, error_model):
    """Writes the page; of more than MOST lines the first are drawn and the number of the others is said."""
    left_out = max(0, len(lines) - MOST)
    parts = [f"<p>{counted((line.verdict for line in lines), confidence)}</p>"]
    if left_out:
        parts.append(f"<p>{tr('The first {} are drawn; {} were left out.').format(MOST, left_out)}</p>")
    parts.append(_key(confidence, radio=any(line.sight.fresnel is not None for line in lines)))
    z = core.load().two_sided_quantile(confidence, json.loads(error_model).get("tails"))
    parts += [_section(line, z) for line in lines[:MOST]]
    parts.append(f"<h2>{tr('Error model used')}</h2><pre>{html.escape(error_model)}</pre>")
    path.write_text(page(tr("Lines of sight"), parts), encoding="utf-8")


def _key(confidence, radio):
    """What the drawings show, above them all."""
    entries = [
        (_line, "ground", tr("elevation model")),
        (_patch, "band", tr("where the ground lies at {:g}").format(confidence)),
        (_line, "sight visible", tr("line of sight")),
        (_ring, "critical", tr("critical place (right: enlarged)")),
    ]
    if radio:
        entries.insert(3, (_patch, "zone", tr("first Fresnel zone")))
    parts, x = [], 0.0
    for draw, style, text in entries:
        parts += [draw(x, style), f"<text x='{x + 30:.0f}' y='16'>{text}</text>"]
        x += 54 + _LETTER * len(text)
    return f"<svg class='key' viewBox='0 0 {_WIDTH} 24' role='img'>{''.join(parts)}</svg>"


def _line(x, style):
    return _shape("polyline", style, [(x, 12), (x + 24, 12)])


def _patch(x, style):
    return _shape("polygon", style, [(x, 6), (x + 24, 6), (x + 24, 18), (x, 18)])


def _ring(x, style):
    return f"<circle class='{style}' cx='{x + 14:.0f}' cy='12' r='5'/>"


def _section(line, z):
    sight = line.sight
    title = f"{html.escape(line.observer.name)} → {html.escape(line.target.name)}"
    verdict = f"<b class='{line.verdict}'>{tr(line.verdict)}</b>"
    facts = [" · ".join([verdict, *_facts(sight)]), " · ".join(_whole_line(sight)), " · ".join(_radio(sight))]
    return f"<h2>{title}</h2>{''.join(f'<p>{one}</p>' for one in facts if one)}{_drawing(line, z)}"


def _facts(sight):
    facts = [tr("p = {:.3f}").format(sight.p), tr("distance {:,.0f} m").format(sight.distance)]
    if math.isfinite(sight.critical_distance):
        facts.append(tr("critical place at {:,.0f} m, k = {:.2f}").format(sight.critical_distance, sight.k))
    if sight.required_height == 0.0:
        facts.append(tr("surely visible from the target's ground up"))
    elif math.isfinite(sight.required_height):
        facts.append(tr("surely visible from {:.1f} m above the target's ground").format(sight.required_height))
    return facts


def _whole_line(sight):
    facts, whole = [], sight.whole_line
    if whole is None:
        return facts
    clear = tr("Whole line: clear with P = {:.3f} ± {:.3f}")
    facts.append(clear.format(whole.probability, whole.standard_error))
    if math.isfinite(whole.blocked_bound):
        facts.append(tr("blocked with {:.2g} at most").format(whole.blocked_bound))
    if math.isfinite(whole.blocked_distance):
        most = tr("most often blocked at {:,.0f} m, in {:.1%} of the terrains drawn")
        facts.append(most.format(whole.blocked_distance, whole.blocked_share))
    return facts


def _radio(sight):
    facts, whole, zone = [], sight.whole_line, sight.fresnel
    if zone is not None and math.isfinite(zone.clear):
        worst = tr("Radio: least clearance {:.0%} of the first Fresnel zone's radius ({:.1f} m), at {:,.0f} m")
        facts.append(worst.format(zone.clear, zone.worst_radius, zone.worst_distance))
        facts.append(tr("the share asked for is clear there with p = {:.3f}").format(zone.p))
    if whole is not None and math.isfinite(whole.fresnel_probability):
        facts.append(tr("all along with P = {:.3f}").format(whole.fresnel_probability))
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
