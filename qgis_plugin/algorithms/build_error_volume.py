# SPDX-License-Identifier: GPL-3.0-or-later
"""Build error volume: a terrain, DEM or TIN, with its doubt as a volume of voxels in a .vdb file."""

from qgis.core import (
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterBand,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterMeshLayer,
)

from .. import parameters as blocks
from ..error_block import check_error_block, read_error_block
from ..errors import core_errors
from ..feedback import Progress
from ..log import log_report
from ..rasters import open_dem, read_extent, read_raster
from ..text import tr
from ..tins import open_mesh, open_tin, read_mesh, read_tin_layer, tin_layer
from ..values import given, number_or_none, word
from .volume_base import VolumeAlgorithm

SOURCES = ("INPUT", "MESH", "TIN")
NUMBERS = (
    ("VOXEL_USED", "Side of the voxels (m)"),
    ("VOXEL_HEIGHT_USED", "Height of the voxels (m)"),
    ("VOXELS", "Voxels of the error band"),
    ("MEMORY", "Memory (bytes)"),
    ("FACES_NOT_HELD", "Faces too steep or too well known for the voxels"),
)


class BuildErrorVolume(VolumeAlgorithm):
    NAME = "builderrorvolume"
    TITLE = "Build error volume"
    SUMMARY = "In which space does the true terrain lie? Of an elevation model, a mesh or a 3D layer, as voxels."
    TAGS = (
        "volume",
        "voxel",
        "vdb",
        "openvdb",
        "3d",
        "tin",
        "mesh",
        "dem",
        "error",
        "uncertainty",
        "confidence",
    )

    def initAlgorithm(self, configuration=None):
        largest = blocks.number("LARGEST_CONFIDENCE", tr("Largest confidence that will be asked"), None, 0.0, 1.0)
        estimate = QgsProcessingParameterBoolean(
            "ESTIMATE_ONLY", tr("Only tell size and memory, build nothing"), False, True
        )
        for parameter in (
            [
                blocks.raster("INPUT", tr("Elevation model (or a mesh or a layer below)"), optional=True),
                QgsProcessingParameterBand("BAND", tr("Band"), 1, "INPUT", True),
                QgsProcessingParameterMeshLayer("MESH", tr("Mesh layer"), None, True),
                tin_layer("TIN", tr("3D layer: polygons, or points and lines to triangulate")),
                blocks.metres("VOXEL", tr("Side of the voxels (empty: chosen)")),
                blocks.confidence_parameter(),
            ]
            + blocks.error_block()
            + [
                blocks.advanced(blocks.metres("VOXEL_HEIGHT", tr("Height of the voxels (empty: as the side)"))),
                blocks.advanced(largest),
                blocks.vertical_unit_parameter(),
                blocks.extent_parameter(),
                blocks.threads_parameter(),
                estimate,
            ]
        ):
            self.add(parameter)
        file = QgsProcessingParameterFileDestination("OUTPUT", tr("Error volume"), "OpenVDB (*.vdb)")
        self.add(file, optional=True)
        for name, label in NUMBERS:
            self.addOutput(QgsProcessingOutputNumber(name, tr(label)))
        self.addOutput(QgsProcessingOutputString("ERROR_MODEL_USED", tr("Error model used (JSON)")))

    def contradiction(self, parameters, context):
        if sum(given(parameters, name) for name in SOURCES) != 1:
            return tr("INPUT: give an elevation model here, or a MESH, or a layer as TIN; one of the three.")
        return self.bad_confidence(parameters, context) or check_error_block(self, parameters, context)

    def read_input(self, parameters, context, feedback):
        self.vertical_unit = word(self, parameters, "VERTICAL_UNIT", context)
        self.dem = read_raster(self, parameters, "INPUT", context, feedback, "BAND")
        self.mesh = read_mesh(self, parameters, "MESH", context)
        self.tin = read_tin_layer(self, parameters, "TIN", context, feedback)
        self.error = read_error_block(self, parameters, context, feedback, self.dem or self.mesh or self.tin)
        self.extent = read_extent(self, parameters, context, self.dem) if self.dem else None

    def compute(self, sightbound, parameters, context, feedback):
        arguments = {
            "terrain": self._terrain(sightbound, feedback),
            "error_model": self.error.model(sightbound),
            "voxel": number_or_none(self, parameters, "VOXEL", context),
            "voxel_height": number_or_none(self, parameters, "VOXEL_HEIGHT", context),
            "confidence": self.parameterAsDouble(parameters, "CONFIDENCE", context),
            "largest_confidence": number_or_none(self, parameters, "LARGEST_CONFIDENCE", context),
            "extent": self.extent,
            "threads": self.threads(parameters, context),
        }
        need = sightbound.ErrorVolume.estimate(**arguments, progress=Progress(feedback, 0.0, 10.0))
        results = {
            "VOXEL_USED": need["voxel"],
            "VOXEL_HEIGHT_USED": need["voxel_height"],
            "VOXELS": need["voxels"],
            "MEMORY": need["bytes"],
        }
        feedback.pushInfo(
            tr("Voxels of {:.4g} x {:.4g} m; about {:.3g} of them near the terrain, {:.4g} MB of memory.").format(
                need["voxel"], need["voxel_height"], need["voxels"], need["bytes"] / 1e6
            )
        )
        if self.parameterAsBoolean(parameters, "ESTIMATE_ONLY", context):
            return results
        arguments.update(voxel=need["voxel"], voxel_height=need["voxel_height"])
        volume = sightbound.ErrorVolume.build(**arguments, progress=Progress(feedback, 10.0, 90.0))
        report = volume.report
        log_report(feedback, report)
        feedback.pushInfo(
            tr("Built: {} voxels near the terrain, {:.4g} MB of memory.").format(report["voxels"], report["bytes"] / 1e6)
        )
        results.update(
            VOXELS=report["voxels"],
            MEMORY=report["bytes"],
            FACES_NOT_HELD=report["faces_not_held"],
            ERROR_MODEL_USED=report["error_model"],
        )
        if given(parameters, "OUTPUT"):
            results["OUTPUT"] = self.save_volume(volume, parameters, context, feedback)
        return results

    def _terrain(self, sightbound, feedback):
        if self.dem:
            return open_dem(sightbound, self.dem, self.vertical_unit, feedback)
        name = "MESH" if self.mesh else "TIN"
        with core_errors(name):
            opened = open_mesh if self.mesh else open_tin
            tin = opened(sightbound, self.mesh or self.tin, self.vertical_unit, feedback)
        for note in tin.notes:
            feedback.pushInfo(note)
        return tin
