# SPDX-License-Identifier: GPL-3.0-or-later
"""Features over a TIN, seen in plan: the vertices of the faces that they touch, and how far vertices are from them."""

from dataclasses import dataclass

import numpy
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsGeometry,
    QgsLineString,
    QgsPoint,
    QgsTriangle,
    QgsUnitTypes,
)

from .errors import bad_input
from .feedback import until_cancelled
from .text import tr
from .values import given

_MOST_BOXES = 200  # of features that faces are compared with one by one


@dataclass
class Features:
    name: str  # of the parameter
    together: QgsGeometry
    crs: QgsCoordinateReferenceSystem
    transforms: object  # the project's QgsCoordinateTransformContext


def read_features(algorithm, parameters, name, context, feedback):
    """All features of a layer together; None if it was left empty."""
    if not given(parameters, name):
        return None
    source = algorithm.parameterAsSource(parameters, name, context)
    if source is None:
        raise bad_input(name, tr("the layer {} cannot be read.").format(parameters[name]))
    shapes = [feature.geometry() for feature in until_cancelled(source.getFeatures(), feedback)]
    together = QgsGeometry.unaryUnion([shape for shape in shapes if not shape.isEmpty()])
    if together.isEmpty():
        raise bad_input(name, tr("the layer has no features, or invalid ones (Fix geometries)."))
    return Features(name, together, source.sourceCrs(), context.transformContext())


def read_lines(algorithm, parameters, name, context, feedback):
    """The lines of a layer, not dissolved; None if it was left empty."""
    features = read_features(algorithm, parameters, name, context, feedback)
    if features is not None:
        source = algorithm.parameterAsSource(parameters, name, context)
        features.together = QgsGeometry.collectGeometry([one.geometry() for one in source.getFeatures()])
    return features


def lines_of(features, tin):
    """Polylines in the TIN's CRS, with heights where they have some; None without features. Any thread."""
    if features is None:
        return None
    geometry, lines = _over(features, tin), []  # which its parts are not to outlive
    for part in geometry.constParts():
        vertices = list(part.vertices())
        lines.append([(one.x(), one.y(), one.z()) if part.is3D() else (one.x(), one.y()) for one in vertices])
    return lines


def vertices_under(features, tin, feedback):
    """For each vertex 1 where a face around it is touched in plan by a feature, else 0; None without features. Any thread."""
    if features is None:
        return None
    geometry = _over(features, tin)
    engine = _prepared(geometry)
    plan, faces = tin.vertices[:, :2], tin.faces
    candidates = _near(geometry, plan[faces])
    touched = [
        face for face in until_cancelled(candidates.tolist(), feedback) if engine.intersects(_shape(plan[faces[face]]))
    ]
    if not touched:
        raise bad_input(features.name, tr("no feature lies on the TIN; check its CRS."))
    under = numpy.zeros(len(plan))
    under[faces[touched]] = 1.0
    return under


def _near(geometry, corners):
    """The faces whose box meets that of a part of the geometry."""
    boxes = [part.boundingBox() for part in geometry.constParts()]
    if len(boxes) > _MOST_BOXES:
        boxes = [geometry.boundingBox()]
    low, high = corners.min(axis=1), corners.max(axis=1)
    near = numpy.zeros(len(corners), bool)
    for box in boxes:
        near |= (low[:, 0] <= box.xMaximum()) & (high[:, 0] >= box.xMinimum()) & (
            (low[:, 1] <= box.yMaximum()) & (high[:, 1] >= box.yMinimum())
        )
    return numpy.flatnonzero(near)


def _shape(corners):
    """A face in plan; an upright one is a line there."""
    a, b, c = (QgsPoint(x, y) for x, y in corners.tolist())
    (ux, uy), (vx, vy) = corners[1] - corners[0], corners[2] - corners[0]
    return QgsTriangle(a, b, c) if ux * vy != uy * vx else QgsLineString([a, b, c, a])


def distances_from(features, tin, feedback):
    """Metres in plan from each vertex to the nearest feature. Any thread."""
    geometry = _over(features, tin)
    engine = _prepared(geometry)
    units = [engine.distance(QgsPoint(x, y)) for x, y, _ in until_cancelled(tin.vertices.tolist(), feedback)]
    crs = _crs_of(tin)
    metres = QgsUnitTypes.fromUnitToUnitFactor(crs.mapUnits(), QgsUnitTypes.DistanceUnit.DistanceMeters)
    return (metres if crs.isValid() else 1.0) * numpy.array(units)


def _over(features, tin):
    """The features in the TIN's CRS; one of them must lie on it."""
    geometry = QgsGeometry(features.together)
    try:
        geometry.transform(QgsCoordinateTransform(features.crs, _crs_of(tin), features.transforms))
    except QgsCsException as error:
        raise bad_input(features.name, tr("the features cannot be brought into the CRS of the TIN.")) from error
    (west, south, _), (east, north, _) = tin.vertices.min(axis=0), tin.vertices.max(axis=0)
    box = geometry.boundingBox()
    if box.xMaximum() < west or box.xMinimum() > east or box.yMaximum() < south or box.yMinimum() > north:
        raise bad_input(features.name, tr("no feature lies on the TIN; check its CRS."))
    return geometry


def _prepared(geometry):
    engine = QgsGeometry.createGeometryEngine(geometry.constGet())
    engine.prepareGeometry()
    return engine


def _crs_of(tin):
    return QgsCoordinateReferenceSystem.fromWkt(tin.crs_wkt or "")
