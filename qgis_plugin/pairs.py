# SPDX-License-Identifier: GPL-3.0-or-later
"""Which observer looks at which target. Main thread only."""

from qgis.core import QgsDistanceArea, QgsPointXY

from .errors import bad_input
from .feedback import until_cancelled
from .text import tr
from .values import given, word


def check_pairing(algorithm, parameters, context):
    """A sentence if the pairing cannot work, else ''."""
    if word(algorithm, parameters, "PAIRING", context) == "field":
        for name in ("OBSERVER_FIELD", "TARGET_FIELD"):
            if not given(parameters, name):
                return tr("{}: PAIRING=field pairs equal names; give the field that holds them.").format(name)
    return ""


def find_pairs(observers, targets, by_name, max_distance, crs, context, feedback):
    """Pairs of places in the order of the observers, then of the targets.

    `by_name` pairs places with the same name, else each observer looks at all targets; both within `max_distance`
    (metres on the ellipsoid; None = any). A place does not look at itself. Raises Stopped when cancelled.
    """
    ruler = QgsDistanceArea()
    if crs.isValid():
        ruler.setSourceCrs(crs, context.transformContext())
        ruler.setEllipsoid(crs.ellipsoidAcronym())
    partners = _by_name(targets) if by_name else {}
    pairs, met, too_far = [], set(), 0
    for observer in observers:
        candidates = partners.get(observer.name, []) if by_name else targets
        for target in until_cancelled(candidates, feedback):
            met.update((id(observer), id(target)))
            if (observer.x, observer.y) == (target.x, target.y):
                continue
            if max_distance is not None and _distance(ruler, observer, target) > max_distance:
                too_far += 1
                continue
            pairs.append((observer, target))
    alone = [place.label for place in observers + targets if id(place) not in met]
    if alone:
        feedback.pushWarning(tr("No partner of the same name: {}").format(", ".join(alone)))
    if too_far:
        feedback.pushInfo(tr("{} pairs are farther apart than MAX_DISTANCE and left out.").format(too_far))
    if pairs:
        return pairs
    if too_far:
        raise bad_input(
            "MAX_DISTANCE", tr("no target is that near to an observer; raise it or leave it empty.")
        )
    if by_name:
        raise bad_input("TARGET_FIELD", tr("no target has the name of an observer; check both fields."))
    raise bad_input("TARGETS", tr("all targets lie exactly at the observers; there is no line between them."))


def _by_name(places):
    groups = {}
    for place in places:
        groups.setdefault(place.name, []).append(place)
    return groups


def _distance(ruler, one, other):
    return ruler.measureLine(QgsPointXY(one.x, one.y), QgsPointXY(other.x, other.y))
