# SPDX-License-Identifier: GPL-3.0-or-later
"""What the algorithms of the group Simplification have in common."""

from qgis.core import (
    QgsProcessingContext,
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterFileDestination,
    QgsProcessingUtils,
)

from .. import parameters as blocks
from ..errors import core_errors, in_our_words
from ..feedback import Progress
from ..log import log_error_model
from ..places_on_dem import places
from ..styling import StyleOnLoad
from ..text import tr
from ..values import given, number_or_none
from .base import SightboundAlgorithm

MESH_FILES = "PLY (*.ply);;UGRID NetCDF (*.nc);;2DM (*.2dm);;OBJ (*.obj);;GeoPackage (*.gpkg)"


class SimplificationAlgorithm(SightboundAlgorithm):
    def group(self):
        return tr("Simplification")

    def groupId(self):
        return "simplification"


class TinMaker(SimplificationAlgorithm):
    """One whose result is a TIN. NUMBERS: (output, label, key of the report)."""

    NUMBERS = ()

    def add_outputs(self):
        self.add(QgsProcessingParameterFileDestination("OUTPUT", tr("TIN (mesh)"), MESH_FILES))
        polygons = QgsProcessingParameterFileDestination(
            "OUTPUT_POLYGONS", tr("TIN as polygons"), "GeoPackage (*.gpkg)"
        )
        self.add(polygons, True, False)
        for name, label, _ in self.NUMBERS:
            self.addOutput(QgsProcessingOutputNumber(name, tr(label)))
        self.addOutput(QgsProcessingOutputString("ERROR_MODEL_USED", tr("Error model used (JSON)")))

    def focus_parameters(self):
        """The tolerance grows with the distance from what matters."""
        growth = blocks.number("FOCUS_GROWTH", tr("Growth of the tolerance, metres for each kilometre"), None, 0.0)
        focus = places("FOCUS", tr("Area of focus: the tolerance grows with the distance from it"))
        return [blocks.advanced(focus), blocks.advanced(growth)]

    def bad_focus(self, parameters):
        if given(parameters, "FOCUS") != given(parameters, "FOCUS_GROWTH"):
            return tr("FOCUS_GROWTH: give it together with FOCUS, or none of the two.")
        if given(parameters, "FOCUS") and not given(parameters, "TOLERANCE"):
            return tr("TOLERANCE: give the tolerance at the FOCUS itself, in metres.")
        return ""

    def grown(self, distances, parameters, context):
        """TOLERANCE, and what the distances from the FOCUS add."""
        growth = self.parameterAsDouble(parameters, "FOCUS_GROWTH", context)
        return self.parameterAsDouble(parameters, "TOLERANCE", context) + growth / 1000.0 * distances

    def target_parameters(self):
        faces = blocks.number("TARGET_TRIANGLES", tr("Stop at so many triangles"), None, 1, None, integer=True)
        size = blocks.number("TARGET_SIZE", tr("Stop at a file of so many megabytes"), None, 0.001)
        return [blocks.advanced(faces), blocks.advanced(size)]

    def bad_target(self, parameters):
        if given(parameters, "TARGET_TRIANGLES") and given(parameters, "TARGET_SIZE"):
            return tr("TARGET_SIZE: TARGET_TRIANGLES says the same thing; give only one of them.")
        return ""

    def target(self, parameters, context):
        """The core's arguments."""
        faces = number_or_none(self, parameters, "TARGET_TRIANGLES", context)
        megabytes = number_or_none(self, parameters, "TARGET_SIZE", context)
        return {
            "target_faces": None if faces is None else int(faces),
            "target_bytes": None if megabytes is None else megabytes * 1e6,
            "target_ending": self.parameterAsFileOutput(parameters, "OUTPUT", context).rpartition(".")[2].lower(),
        }

    def told(self, report, feedback):
        """The numbers of a report, told in the log too."""
        for warning in report["warnings"]:
            feedback.pushWarning(in_our_words(warning))
        results = {name: report[key] for name, _, key in self.NUMBERS if report[key] is not None}
        for name, label, _ in self.NUMBERS:
            if name in results:
                feedback.pushInfo(f"{tr(label)}: {results[name]:.6g}")
        if report["error_model"]:
            log_error_model(feedback, report["error_model"])
            results["ERROR_MODEL_USED"] = report["error_model"]
        return results

    def write_outputs(self, tin, parameters, context, feedback):
        """Writes the TIN and has it loaded; the paths."""
        paths = {}
        for name, first in (("OUTPUT", 90.0), ("OUTPUT_POLYGONS", 95.0)):
            if not given(parameters, name):
                continue
            path = paths[name] = self.parameterAsFileOutput(parameters, name, context)
            with core_errors(name):
                warnings = tin.write(path, progress=Progress(feedback, first, first + 5.0))
            for warning in warnings:  # polygons have no vertices to hold what is known of these
                (feedback.pushWarning if name == "OUTPUT" else feedback.pushInfo)(warning)
            self._load(path, name, context)
        return paths

    def _load(self, path, name, context):
        if context.project() is None or path.endswith(".obj"):  # QGIS reads no OBJ
            return
        polygons = path.endswith(".gpkg")
        hint = QgsProcessingUtils.LayerHint
        details = QgsProcessingContext.LayerDetails(
            tr("TIN"), context.project(), name, hint.Vector if polygons else hint.Mesh
        )
        if not polygons:
            details.setPostProcessor(StyleOnLoad("tin", 1.0))
        context.addLayerToLoadOnCompletion(path, details)
