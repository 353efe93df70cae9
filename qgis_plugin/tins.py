# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh layers and 3D vector layers become TINs. Layers are touched in the main thread only."""

from dataclasses import dataclass
from pathlib import Path

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsGeometry,
    QgsMesh,
    QgsPoint,
    QgsProcessing,
    QgsProcessingParameterFeatureSource,
    QgsProcessingUtils,
    QgsVectorFileWriter,
    QgsWkbTypes,
)

from .errors import bad_input
from .feedback import Progress, until_cancelled
from .text import tr
from .values import given


@dataclass
class MeshData:
    vertices: list
    faces: list
    crs: QgsCoordinateReferenceSystem


@dataclass
class TinLayer:
    path: str  # of a copy of the features
    crs: QgsCoordinateReferenceSystem


def tin_layer(name, label):
    kinds = [QgsProcessing.SourceType.TypeVectorAnyGeometry]
    return QgsProcessingParameterFeatureSource(name, label, kinds, None, True)


def read_mesh(algorithm, parameters, name, context):
    """Vertices and faces of a mesh layer, whatever its format; None if it was left empty."""
    if not given(parameters, name):
        return None
    layer = algorithm.parameterAsMeshLayer(parameters, name, context)
    if layer is None or not layer.isValid():
        raise bad_input(name, tr("the mesh {} cannot be read.").format(parameters[name]))
    mesh = QgsMesh()
    layer.dataProvider().populateMesh(mesh)
    if mesh.faceCount() == 0:
        raise bad_input(name, tr("the mesh has no faces."))
    corners = [mesh.vertex(index) for index in range(mesh.vertexCount())]
    faces = [mesh.face(index) for index in range(mesh.faceCount())]
    return MeshData([(one.x(), one.y(), one.z()) for one in corners], faces, layer.crs())


def open_mesh(sightbound, mesh, vertical_unit, feedback):
    """The core's Tin of it. Any thread."""
    width = max(len(face) for face in mesh.faces)
    larger = sum(len(face) > 3 for face in mesh.faces)
    if larger:
        feedback.pushInfo(tr("{} faces of four and more corners were cut into triangles.").format(larger))
    faces = [[*face, *[-1] * (width - len(face))] for face in mesh.faces]
    return sightbound.Tin(mesh.vertices, faces, crs=_text(mesh.crs), vertical_unit=vertical_unit)


def read_tin_layer(algorithm, parameters, name, context, feedback):
    """A copy of the layer's (selected) features; None if it was left empty."""
    if not given(parameters, name):
        return None
    source = algorithm.parameterAsSource(parameters, name, context)
    if source is None:
        raise bad_input(name, tr("the layer {} cannot be read.").format(parameters[name]))
    if not QgsWkbTypes.hasZ(source.wkbType()):
        raise bad_input(name, tr("the layer has no heights (Z); drape it on an elevation model first."))
    path = QgsProcessingUtils.generateTempFilename("tin.gpkg")
    options = QgsVectorFileWriter.SaveVectorOptions()
    options.driverName = "GPKG"
    writer = QgsVectorFileWriter.create(
        path, source.fields(), source.wkbType(), source.sourceCrs(), context.transformContext(), options
    )
    for feature in until_cancelled(source.getFeatures(), feedback):
        feature.setId(-1)
        writer.addFeature(feature)
    if writer.hasError() != QgsVectorFileWriter.WriterError.NoError:
        raise bad_input(name, writer.errorMessage())
    del writer  # closes the file
    algorithm.paths[path] = name
    return TinLayer(path, source.sourceCrs())


def open_tin(sightbound, layer, vertical_unit, feedback):
    """The core's Tin of it. Any thread."""
    return sightbound.read_tin(
        layer.path, crs=_text(layer.crs), vertical_unit=vertical_unit, progress=Progress(feedback, 0.0, 5.0)
    )


def read_tin_file(algorithm, parameters, name, context):
    """The path of a file, which must exist; None if it was left empty."""
    if not given(parameters, name):
        return None
    path = algorithm.parameterAsFile(parameters, name, context)
    if not Path(path).is_file():
        raise bad_input(name, tr("there is no file {}.").format(path))
    algorithm.paths[path] = name
    return path


def open_tin_file(sightbound, path, vertical_unit, feedback):
    """The core's Tin in a file. Any thread."""
    return sightbound.read_tin(path, vertical_unit=vertical_unit, progress=Progress(feedback, 0.0, 5.0))


@dataclass
class Areas:
    together: QgsGeometry
    crs: QgsCoordinateReferenceSystem
    transforms: object  # the project's QgsCoordinateTransformContext


def read_areas(algorithm, parameters, name, context, feedback):
    """All polygons of a layer together; None if it was left empty."""
    if not given(parameters, name):
        return None
    source = algorithm.parameterAsSource(parameters, name, context)
    if source is None:
        raise bad_input(name, tr("the layer {} cannot be read.").format(parameters[name]))
    polygons = [feature.geometry() for feature in until_cancelled(source.getFeatures(), feedback)]
    return Areas(QgsGeometry.unaryUnion(polygons), source.sourceCrs(), context.transformContext())


def vertices_in(areas, tin, name, feedback):
    """For each vertex 1 where it lies in an area, else 0; None without areas. Any thread."""
    if areas is None:
        return None
    geometry = QgsGeometry(areas.together)
    crs = QgsCoordinateReferenceSystem.fromWkt(tin.crs_wkt or "")
    try:
        geometry.transform(QgsCoordinateTransform(areas.crs, crs, areas.transforms))
    except QgsCsException as error:
        raise bad_input(name, tr("the areas cannot be brought into the CRS of the TIN.")) from error
    engine = QgsGeometry.createGeometryEngine(geometry.constGet())
    engine.prepareGeometry()
    box = geometry.boundingBox()
    inside = [
        float(box.contains(x, y) and engine.intersects(QgsPoint(x, y)))
        for x, y, _ in until_cancelled(tin.vertices.tolist(), feedback)
    ]
    if not any(inside):
        raise bad_input(name, tr("no vertex lies in its polygons; check its CRS."))
    return inside


def _text(crs):
    if not crs.isValid():
        return None
    return crs.toWkt(QgsCoordinateReferenceSystem.WktVariant.WKT_PREFERRED_GDAL)
