# SPDX-License-Identifier: GPL-3.0-or-later
"""A network of sight lines as a layer of lines and as a table: one row a pair."""

from qgis.core import QgsGeometry, QgsPointXY, QgsWkbTypes

from .feedback import until_cancelled
from .fields import integer_field, number_field, text_field
from .line_extras import extra_columns
from .line_outputs import fields_of, finite, write_features

VERDICTS = {0: "hidden", 1: "uncertain", 2: "visible"}
_NAMES = ((integer_field, "from_fid"), (text_field, "from"), (integer_field, "to_fid"), (text_field, "to"))
_WORDS = ((text_field, "verdict"), (text_field, "status"))
_NUMBERS = ("p", "k", "distance", "azimuth", "critical_distance", "critical_x", "critical_y", "critical_clearance")
_SHARE = "critical_share"


class NetworkRows:
    """The rows of an Intervisibility between places; within one list `there` is `here`."""

    def __init__(self, network, here, there, extras):
        self._network, self._here, self._there = network, here, there
        self._numbers = _NUMBERS + extra_columns(extras)
        self.fields = fields_of(*_NAMES, *_WORDS, *((number_field, name) for name in (*self._numbers, _SHARE)))

    def lines(self, feedback):
        """(straight line between the two, attributes)."""
        for one, other, attributes in self._pairs(feedback):
            ends = [QgsPointXY(one.x, one.y), QgsPointXY(other.x, other.y)]
            yield QgsGeometry.fromPolylineXY(ends), attributes

    def critical(self, feedback):
        """(critical place, attributes) of the pairs that have one."""
        x, y = (self.fields.lookupField(name) for name in ("critical_x", "critical_y"))
        for _, _, attributes in self._pairs(feedback):
            if attributes[x] is not None:
                yield QgsGeometry.fromPointXY(QgsPointXY(attributes[x], attributes[y])), attributes

    def table(self, feedback):
        for _, _, attributes in self._pairs(feedback):
            yield None, attributes

    def _pairs(self, feedback):
        columns = self._network.columns
        words = [columns["a"].tolist(), columns["b"].tolist(), columns["verdict"].tolist(), columns["status"]]
        numbers = [columns[name].tolist() for name in self._numbers]
        for row, (a, b, verdict, status) in enumerate(until_cancelled(zip(*words), feedback)):
            one, other = self._here[a], self._there[b]
            figures = dict(zip(self._numbers, (column[row] for column in numbers)))
            share = figures["critical_distance"] / figures["distance"] if figures["distance"] else float("nan")
            names = [one.feature.id(), one.name, other.feature.id(), other.name]
            told = [VERDICTS.get(verdict, "unknown"), status]
            yield one, other, names + told + [finite(value) for value in (*figures.values(), share)]


def write_network(algorithm, rows, dem, parameters, context, feedback):
    kind = QgsWkbTypes.Type.LineString
    lines = rows.lines(feedback)
    return write_features(algorithm, "OUTPUT", kind, rows.fields, lines, dem, parameters, context, "lines")


def write_critical(algorithm, rows, dem, parameters, context, feedback):
    kind = QgsWkbTypes.Type.Point
    places = rows.critical(feedback)
    return write_features(algorithm, "OUTPUT_CRITICAL", kind, rows.fields, places, dem, parameters, context, "critical")


def write_table(algorithm, rows, dem, parameters, context, feedback):
    kind = QgsWkbTypes.Type.NoGeometry
    table = rows.table(feedback)
    return write_features(algorithm, "OUTPUT_TABLE", kind, rows.fields, table, dem, parameters, context, "")
