# SPDX-License-Identifier: GPL-3.0-or-later
"""Simplify TIN: few triangles inside the error volume of any TIN, overhangs and buildings too."""

from qgis.core import (
    QgsProcessing,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProcessingParameterMeshLayer,
    QgsProcessingParameterString,
)

from .. import parameters as blocks
from ..error_block import check_error_block, read_error_block
from ..errors import core_errors
from ..feedback import Progress
from ..places_on_dem import places
from ..places_on_tin import distances_from, lines_of, read_features, read_lines, vertices_under
from ..rasters import read_raster
from ..text import tr
from ..tins import open_mesh, open_tin, open_tin_file, read_mesh, read_tin_file, read_tin_layer, tin_layer
from ..values import given, number_or_none, word
from ..vertex_tolerance import of_attribute, of_raster
from .simplification_base import TinMaker

SOURCES = ("INPUT", "TIN", "FILE")
TOLERANCES = ("TOLERANCE", "TOLERANCE_RASTER", "TOLERANCE_FIELD")


class SimplifyTin(TinMaker):
    NAME = "simplifytin"
    TITLE = "Simplify TIN"
    SUMMARY = "How few triangles can carry a mesh or TIN of any shape without leaving its error, or a tolerance?"
    TAGS = ("tin", "mesh", "simplify", "decimate", "generalise", "tolerance", "error", "3d", "building", "bridge", "overhang")
    NUMBERS = (
        ("TRIANGLES_BEFORE", "Triangles before", "faces_before"),
        ("TRIANGLES", "Triangles after", "faces_after"),
        ("LARGEST_DEVIATION", "Largest deviation anywhere, of a height field (m)", "largest_deviation"),
        ("LARGEST_RATIO", "Largest share of the tolerance that is used, of a height field", "largest_ratio"),
        ("LARGEST_TOLERANCE", "No place is further from the original than (m)", "largest_tolerance"),
        ("BORDER_TOLERANCE_USED", "The outline moves at most (m)", "border_tolerance"),
        ("VOXEL_USED", "Side of the voxels (m)", "voxel"),
        ("FACES_NOT_HELD", "Faces too steep or too well known for the voxels", "faces_not_held"),
    )

    def initAlgorithm(self, configuration=None):
        file = QgsProcessingParameterFile("FILE", tr("File of a TIN: PLY, OBJ, 2DM, LandXML, ..."), optional=True)
        line = [QgsProcessing.SourceType.TypeVectorLine]
        lines = QgsProcessingParameterFeatureSource("BREAK_LINES", tr("Break lines: edges along them stay"), line, None, True)
        field = QgsProcessingParameterString("TOLERANCE_FIELD", tr("Tolerance as an attribute of the vertices"), None, False, True)
        for parameter in (
            [
                QgsProcessingParameterMeshLayer("INPUT", tr("Mesh layer (or a layer or a file below)"), None, True),
                tin_layer("TIN", tr("3D layer: polygons, or points and lines to triangulate")),
                file,
                blocks.metres("TOLERANCE", tr("Tolerance in metres (empty: the error below)")),
                blocks.advanced(blocks.raster("TOLERANCE_RASTER", tr("Tolerance as a raster (metres)"), True)),
                blocks.advanced(field),
                blocks.confidence_parameter(),
            ]
            + blocks.error_block()
            + self.focus_parameters()
            + [
                blocks.advanced(blocks.metres("BORDER_TOLERANCE", tr("How far the outline may move (empty: chosen)"))),
                blocks.advanced(lines),
                blocks.advanced(blocks.metres("BREAK_LINE_TOLERANCE", tr("How far break lines may move"), 0.0)),
                blocks.advanced(places("KEEP", tr("Places to keep at full resolution"))),
            ]
            + self.target_parameters()
            + [
                blocks.advanced(blocks.metres("VOXEL", tr("Side of the voxels (empty: chosen)"))),
                blocks.vertical_unit_parameter(),
                blocks.threads_parameter(),
            ]
        ):
            self.add(parameter)
        self.add_outputs()

    def contradiction(self, parameters, context):
        if sum(given(parameters, name) for name in SOURCES) != 1:
            return tr("INPUT: give a mesh here, or a layer as TIN, or a FILE; one of the three.")
        said = [name for name in TOLERANCES if given(parameters, name)]
        if len(said) > 1:
            return tr("{}: {} says the same thing; give only one of them.").format(said[1], said[0])
        errors = [name for name in ("VERTICAL_ACCURACY", "ERROR_RASTER", "ERROR_MODEL") if given(parameters, name)]
        if bool(said) == bool(errors):
            return tr("TOLERANCE: say how far the TIN may be from the original, here or as VERTICAL_ACCURACY; one of the two.")
        return self.bad_target(parameters) or self.bad_focus(parameters) or self.bad_confidence(parameters, context) or check_error_block(self, parameters, context)

    def read_input(self, parameters, context, feedback):
        self.vertical_unit = word(self, parameters, "VERTICAL_UNIT", context)
        self.field = self.parameterAsString(parameters, "TOLERANCE_FIELD", context)
        self.mesh = read_mesh(self, parameters, "INPUT", context, self.field)
        self.layer = read_tin_layer(self, parameters, "TIN", context, feedback)
        self.file = read_tin_file(self, parameters, "FILE", context)
        self.error = read_error_block(self, parameters, context, feedback, self.mesh or self.layer)
        self.raster = read_raster(self, parameters, "TOLERANCE_RASTER", context, feedback)
        self.lines = read_lines(self, parameters, "BREAK_LINES", context, feedback)
        self.keep, self.focus = (read_features(self, parameters, name, context, feedback) for name in ("KEEP", "FOCUS"))

    def compute(self, sightbound, parameters, context, feedback):
        original = self._original(sightbound, feedback)
        tolerance = self._tolerance(original, parameters, context, feedback)
        made = sightbound.simplify(
            original,
            tolerance=tolerance,
            error_model=self._model(sightbound) if tolerance is None else None,
            confidence=self.parameterAsDouble(parameters, "CONFIDENCE", context),
            border_tolerance=number_or_none(self, parameters, "BORDER_TOLERANCE", context),
            break_lines=lines_of(self.lines, original),
            break_line_tolerance=number_or_none(self, parameters, "BREAK_LINE_TOLERANCE", context) or 0.0,
            keep=vertices_under(self.keep, original, feedback),
            **self.target(parameters, context),
            voxel=number_or_none(self, parameters, "VOXEL", context),
            threads=self.threads(parameters, context),
            progress=Progress(feedback, 10.0, 90.0),
        )
        measured = tr("vertically") if made.report["method"] == "vertical" else tr("as the distance to the nearest place")
        feedback.pushInfo(tr("The tolerance is measured {}.").format(measured))
        results = self.told(made.report, feedback)
        return {**results, **self.write_outputs(made, parameters, context, feedback)}

    def _tolerance(self, original, parameters, context, feedback):
        """One number, or one for each vertex; None when the error says it."""
        if self.raster:
            return of_raster(self.raster, original)
        if self.field:
            return of_attribute(self.field, original)
        if self.focus:
            return self.grown(distances_from(self.focus, original, feedback), parameters, context)
        return number_or_none(self, parameters, "TOLERANCE", context)

    def _model(self, sightbound):
        """What lies between the samples cannot be learnt from a TIN: nothing, unless it is said."""
        self.error.other.setdefault("geologic_variation", 0.0)
        return self.error.model(sightbound)

    def _original(self, sightbound, feedback):
        if self.mesh:
            with core_errors("INPUT"):
                return open_mesh(sightbound, self.mesh, self.vertical_unit, feedback)
        if self.layer:
            with core_errors("TIN"):
                return open_tin(sightbound, self.layer, self.vertical_unit, feedback)
        with core_errors("FILE"):
            return open_tin_file(sightbound, self.file, self.vertical_unit, feedback)
