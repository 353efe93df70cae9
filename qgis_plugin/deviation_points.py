# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a simplified TIN deviates from its original, as points in the CRS of the original."""

from qgis.core import QgsCoordinateReferenceSystem, QgsFeature, QgsFeatureSink, QgsFields, QgsGeometry, QgsPoint, QgsWkbTypes

from .errors import bad_input
from .fields import number_field, text_field
from .styling import style_when_loaded
from .text import tr


def write_points(algorithm, original, simplified, found, tolerance, most, parameters, context):
    """First the places of the certified extremes and of the largest gaps, then the vertices of the original that deviate most.

    `most` of the latter at most, those with the largest deviation / tolerance first.
    """
    fields = QgsFields()
    fields.append(text_field("kind"))
    for name in ("deviation_m", "ratio"):
        fields.append(number_field(name))
    crs = QgsCoordinateReferenceSystem.fromWkt(original.crs_wkt or simplified.crs_wkt or "")
    sink, path = algorithm.parameterAsSink(parameters, "OUTPUT", context, fields, QgsWkbTypes.Type.PointZ, crs)
    if sink is None:
        raise bad_input("OUTPUT", tr("the layer cannot be written."))
    for place, *attributes in [*_extremes(found.report), *_vertices(original, found, tolerance, most)]:
        feature = QgsFeature(fields)
        feature.setGeometry(QgsGeometry(QgsPoint(*place)))
        feature.setAttributes(attributes)
        if not sink.addFeature(feature, QgsFeatureSink.Flag.FastInsert):
            raise bad_input("OUTPUT", tr("a feature cannot be written."))
    style_when_loaded(context, path, "deviation")
    return path


def _extremes(report):
    deviation, ratio = report["largest_deviation"], report["largest_ratio"]
    rows = [
        (deviation["place"], "largest deviation", deviation["bound"], None),
        (ratio["place"], "largest ratio", None, ratio["bound"]),
    ]
    rows += [(report[name]["place"], name, None, None) for name in ("uncovered", "surplus") if report[name]["m2"] > 0]
    return rows


def _vertices(original, found, tolerance, most):
    import numpy

    deviation = found.vertex_deviation.ravel()
    ratio = numpy.abs(deviation) / numpy.ravel(tolerance)
    known = numpy.flatnonzero(numpy.isfinite(ratio))
    chosen = known[numpy.argsort(-ratio[known], kind="stable")[:most]]
    for place, number in zip(_places(original, chosen), chosen):
        yield place, "vertex", float(deviation[number]), float(ratio[number])


def _places(original, numbers):
    if not hasattr(original, "heights"):
        return original.vertices[numbers].tolist()
    import numpy

    g = original.geotransform
    rows, cols = numpy.divmod(numbers, original.shape[1])
    x = g[0] + (cols + 0.5) * g[1] + (rows + 0.5) * g[2]
    y = g[3] + (cols + 0.5) * g[4] + (rows + 0.5) * g[5]
    return numpy.column_stack([x, y, original.heights.ravel()[numbers]]).tolist()
