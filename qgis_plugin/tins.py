# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh layers and 3D vector layers become TINs. Layers are touched in the main thread only."""

from dataclasses import dataclass
from pathlib import Path

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsMesh,
    QgsMeshDatasetGroupMetadata,
    QgsMeshDatasetIndex,
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
    attributes: dict  # name -> a number for each vertex


@dataclass
class TinLayer:
    path: str  # of a copy of the features
    crs: QgsCoordinateReferenceSystem


def tin_layer(name, label):
    kinds = [QgsProcessing.SourceType.TypeVectorAnyGeometry]
    return QgsProcessingParameterFeatureSource(name, label, kinds, None, True)


def read_mesh(algorithm, parameters, name, context, attribute=""):
    """Vertices and faces of a mesh layer, whatever its format, and one dataset of its vertices; None if it was left empty."""
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
    attributes = {attribute: _dataset(layer, attribute, len(corners))} if attribute else {}
    return MeshData([(one.x(), one.y(), one.z()) for one in corners], faces, layer.crs(), attributes)


def _dataset(layer, name, vertices):
    """The first dataset of that name; NaN where it has no value."""
    there = [QgsMeshDatasetIndex(group, 0) for group in layer.datasetGroupsIndexes()]
    on_vertices = [
        index for index in there
        if layer.datasetGroupMetadata(index).dataType() == QgsMeshDatasetGroupMetadata.DataType.DataOnVertices
    ]
    names = {layer.datasetGroupMetadata(index).name(): index for index in reversed(on_vertices)}
    if name not in names:
        told = ", ".join(names) or tr("none")
        raise bad_input("TOLERANCE_FIELD", tr("the mesh has no dataset {!r} on its vertices; it has: {}.").format(name, told))
    block = layer.datasetValues(names[name], 0, vertices)
    return [block.value(index).scalar() for index in range(vertices)]


def open_mesh(sightbound, mesh, vertical_unit, feedback):
    """The core's Tin of it. Any thread."""
    width = max(len(face) for face in mesh.faces)
    larger = sum(len(face) > 3 for face in mesh.faces)
    if larger:
        feedback.pushInfo(tr("{} faces of four and more corners were cut into triangles.").format(larger))
    faces = [[*face, *[-1] * (width - len(face))] for face in mesh.faces]
    return sightbound.Tin(
        mesh.vertices,
        faces,
        crs=_text(mesh.crs),
        vertex_attributes=mesh.attributes,
        vertical_unit=vertical_unit,
    )


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


def _text(crs):
    if not crs.isValid():
        return None
    return crs.toWkt(QgsCoordinateReferenceSystem.WktVariant.WKT_PREFERRED_GDAL)
