# SPDX-License-Identifier: GPL-3.0-or-later
"""Sight lines and their critical places as vector layers, in the CRS of the DEM."""

import math

from qgis.core import (
    QgsFeature,
    QgsFeatureSink,
    QgsFields,
    QgsGeometry,
    QgsPointXY,
    QgsWkbTypes,
)

from .errors import bad_input
from .feedback import until_cancelled
from .fields import integer_field, number_field, text_field
from .line_extras import extra_columns, extra_values
from .styling import style_when_loaded
from .text import tr

_STRAIGHT = 0.05  # cells: a line that bends less in the CRS of the DEM is drawn with its two ends


def _names_of(line):
    observer, target = line.observer, line.target
    return [observer.feature.id(), observer.name, target.feature.id(), target.name]


_NAME_FIELDS = (
    (integer_field, "observer_fid"),
    (text_field, "observer"),
    (integer_field, "target_fid"),
    (text_field, "target"),
)


def write_lines(algorithm, lines, dem, parameters, context, extras, feedback):
    numbers = ("p", "k", "distance", "azimuth", "critical_distance", "required_height")
    more = extra_columns(extras)
    fields = fields_of(*_NAME_FIELDS, (text_field, "verdict"), *((number_field, name) for name in numbers + more))

    def attributes(line):
        told = extra_values(line.sight)
        figures = [getattr(line.sight, name) for name in numbers] + [told[name] for name in more]
        return [*_names_of(line), line.verdict, *map(finite, figures)]

    rows = ((_line(line, dem), attributes(line)) for line in until_cancelled(lines, feedback))
    kind = QgsWkbTypes.Type.LineString
    return write_features(algorithm, "OUTPUT", kind, fields, rows, dem, parameters, context, "lines")


def write_critical_places(algorithm, lines, dem, parameters, context):
    """The place that decides each line; lines too short to have one are left out."""
    numbers = ("p", "k", "critical_distance", "ground", "sigma", "line_height")
    fields = fields_of(*_NAME_FIELDS, (text_field, "verdict"), *((number_field, name) for name in numbers))
    rows = []
    for line in lines:
        sight = line.sight
        if not math.isfinite(sight.critical_distance):
            continue
        at = critical_index(sight)
        heights = [finite(sight.profile[name][at]) for name in ("ground", "sigma", "line")]
        attributes = _names_of(line) + [line.verdict, sight.p, sight.k, sight.critical_distance] + heights
        rows.append((QgsGeometry.fromPointXY(QgsPointXY(*sight.critical)), attributes))
    kind = QgsWkbTypes.Type.Point
    return write_features(
        algorithm, "OUTPUT_CRITICAL", kind, fields, rows, dem, parameters, context, "critical"
    )


def critical_index(sight):
    """Where in the profile the critical place is."""
    distances = sight.profile["distance"]
    return min(range(len(distances)), key=lambda i: abs(distances[i] - sight.critical_distance))


def _line(line, dem):
    """The geodesic between the ends, with as many vertices as its bend in the CRS of the DEM asks for."""
    profile = line.sight.profile
    inner = [QgsPointXY(x, y) for x, y in zip(profile["x"], profile["y"])]
    ends = QgsPointXY(line.observer.x, line.observer.y), QgsPointXY(line.target.x, line.target.y)
    return QgsGeometry.fromPolylineXY([ends[0], *inner, ends[1]]).simplify(_STRAIGHT * dem.cell)


def finite(value):
    """NULL for what the core leaves open (NaN)."""
    return float(value) if math.isfinite(value) else None


def fields_of(*makers):
    fields = QgsFields()
    for make, name in makers:
        fields.append(make(name))
    return fields


def write_features(algorithm, output, kind, fields, rows, dem, parameters, context, style):
    """Writes rows of (geometry, attributes) to the sink `output`; titles alone for the style ''."""
    sink, target = algorithm.parameterAsSink(parameters, output, context, fields, kind, dem.crs)
    if sink is None:
        raise bad_input(output, tr("the layer cannot be written."))
    for geometry, attributes in rows:
        feature = QgsFeature(fields)
        if geometry is not None:
            feature.setGeometry(geometry)
        feature.setAttributes(attributes)
        if not sink.addFeature(feature, QgsFeatureSink.Flag.FastInsert):
            raise bad_input(output, tr("a feature cannot be written."))
    style_when_loaded(context, target, style)
    return target
