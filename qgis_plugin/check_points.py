# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads check points: a layer's points with their elevations, in the CRS of the DEM. Main thread only."""

import math

from qgis.core import QgsCoordinateTransform, QgsCsException, QgsGeometry, QgsWkbTypes

from .errors import bad_input
from .feedback import until_cancelled
from .text import tr
from .values import given, is_null


def read_check_points(algorithm, parameters, context, feedback, dem, metres_per_unit):
    """A list of (x, y, elevation in metres); None if CHECKPOINTS was left empty."""
    if not given(parameters, "CHECKPOINTS"):
        return None
    source = algorithm.parameterAsSource(parameters, "CHECKPOINTS", context)
    if source is None:
        raise bad_input("CHECKPOINTS", tr("the layer {} cannot be read.").format(parameters["CHECKPOINTS"]))
    index = _elevation_index(algorithm, parameters, context, source)
    to_dem = QgsCoordinateTransform(source.sourceCrs(), dem.crs, context.transformContext())
    places, empty = [], 0
    for feature in until_cancelled(source.getFeatures(), feedback):
        geometry = feature.geometry()
        height = feature.attribute(index) if index >= 0 else None
        if geometry.isNull() or (index >= 0 and is_null(height)):
            empty += 1
            continue
        for point in _points_of(geometry, feature):
            z = float(height) if index >= 0 else point.z()
            if not math.isfinite(z):
                raise bad_input("CHECKPOINTS", tr("feature {} has no elevation.").format(feature.id()))
            try:
                place = QgsGeometry(point.clone())
                place.transform(to_dem)
            except QgsCsException as error:
                message = tr("feature {} cannot be brought into the CRS of INPUT.").format(feature.id())
                raise bad_input("CHECKPOINTS", message) from error
            moved = place.constGet()
            places.append((moved.x(), moved.y(), z * metres_per_unit))
    if empty:
        feedback.pushInfo(tr("CHECKPOINTS: {} features without place or elevation were left out.").format(empty))
    if not places:
        raise bad_input("CHECKPOINTS", tr("the layer is empty; it needs points with elevations."))
    return places


def _elevation_index(algorithm, parameters, context, source):
    """The column of the elevations; -1 for Z of the geometry."""
    if given(parameters, "ELEVATION_FIELD"):
        name = algorithm.parameterAsFields(parameters, "ELEVATION_FIELD", context)[0]
        index = source.fields().lookupField(name)
        if index < 0:
            names = ", ".join(one.name() for one in source.fields())
            raise bad_input("ELEVATION_FIELD", tr("the layer has no field {!r}; it has {}.").format(name, names))
        return index
    if not QgsWkbTypes.hasZ(source.wkbType()):
        raise bad_input("ELEVATION_FIELD", tr("the points of CHECKPOINTS have no Z; name the field of their elevations."))
    return -1


def _points_of(geometry, feature):
    shape = geometry.constGet()
    if QgsWkbTypes.flatType(shape.wkbType()) == QgsWkbTypes.Type.Point:
        return [shape]
    return [shape.geometryN(number) for number in range(shape.numGeometries())]
