# SPDX-License-Identifier: GPL-3.0-or-later
"""Verify TIN: is a simplified TIN within its tolerance of the original, everywhere?"""

from pathlib import Path

from qgis.core import (
    QgsProcessing,
    QgsProcessingOutputBoolean,
    QgsProcessingOutputNumber,
    QgsProcessingParameterBand,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterMeshLayer,
)

from .. import parameters as blocks
from ..deviation_points import write_points
from ..errors import bad_input, core_errors
from ..feedback import Progress
from ..rasters import open_dem, read_raster
from ..text import tr, upward
from ..tins import open_mesh, open_tin, read_mesh, read_tin_layer, tin_layer
from ..values import given, number_or_none, word
from ..verify_html import write_report
from .simplification_base import SimplificationAlgorithm

ORIGINALS = ("INPUT", "MESH", "TIN")
SIMPLIFIED = ("SIMPLIFIED", "SIMPLIFIED_TIN")
# output, label, where it stands in the report
NUMBERS = (
    ("LARGEST_DEVIATION", "Largest deviation, certified (m)", ("largest_deviation", "bound")),
    ("LARGEST_RATIO", "Largest deviation / tolerance, certified", ("largest_ratio", "bound")),
    ("RMS_DEVIATION", "Root mean square deviation at the original's vertices (m)", ("rms_deviation",)),
    ("FLIPPED", "Flipped faces", ("flipped", "count")),
    ("FOLDED", "Folded faces", ("folded", "count")),
    ("DEGENERATE", "Degenerate faces", ("degenerate", "count")),
    ("UNCOVERED_AREA", "Ground of the original that is uncovered (m²)", ("uncovered", "m2")),
    ("SURPLUS_AREA", "Area beyond the original (m²)", ("surplus", "m2")),
)
FLAGS = (
    ("WITHIN_TOLERANCE", "Is every place within the tolerance?", "within_tolerance"),
    ("WELL_FORMED", "Is no face flipped, folded or degenerate?", "well_formed"),
)


class VerifyTin(SimplificationAlgorithm):
    NAME = "verifytin"
    TITLE = "Verify TIN"
    SUMMARY = "How far is a simplified TIN from its original, everywhere and not only at the samples?"
    TAGS = ("tin", "mesh", "simplification", "decimation", "quality", "error", "tolerance", "deviation", "dem", "proof")

    def initAlgorithm(self, configuration=None):
        for parameter in [
            blocks.raster("INPUT", tr("Original: elevation model (or a mesh or a layer below)"), optional=True),
            QgsProcessingParameterBand("BAND", tr("Band"), 1, "INPUT", True),
            QgsProcessingParameterMeshLayer("MESH", tr("Original: mesh layer"), None, True),
            tin_layer("TIN", tr("Original: 3D layer")),
            QgsProcessingParameterMeshLayer("SIMPLIFIED", tr("Simplified: mesh layer"), None, True),
            tin_layer("SIMPLIFIED_TIN", tr("Simplified: 3D layer (instead)")),
            blocks.metres("TOLERANCE", tr("Tolerance (or a raster below)"), None, 0.0),
            blocks.raster("TOLERANCE_RASTER", tr("Tolerance as a raster, cell by cell of the elevation model"), True),
            blocks.number("MOST_POINTS", tr("How many deviation points at most"), 1000, 0, None, integer=True),
            blocks.advanced(blocks.metres("RESOLUTION", tr("Resolution of the distances of overhanging TINs (empty: chosen)"))),
            blocks.vertical_unit_parameter(),
            blocks.threads_parameter(),
        ]:
            self.add(parameter)
        file = QgsProcessingParameterFileDestination("OUTPUT_HTML", tr("Report"), "HTML (*.html)")
        self.add(file, optional=True)
        kind = QgsProcessing.SourceType.TypeVectorPoint
        self.add(QgsProcessingParameterFeatureSink("OUTPUT", tr("Deviation points"), kind), optional=True)
        for name, label, _ in NUMBERS:
            self.addOutput(QgsProcessingOutputNumber(name, tr(label)))
        for name, label, _ in FLAGS:
            self.addOutput(QgsProcessingOutputBoolean(name, tr(label)))

    def contradiction(self, parameters, context):
        if sum(given(parameters, name) for name in ORIGINALS) != 1:
            return tr("INPUT: give an elevation model here, or a MESH, or a layer as TIN; one of the three.")
        if sum(given(parameters, name) for name in SIMPLIFIED) != 1:
            return tr("SIMPLIFIED: give a mesh here, or a layer as SIMPLIFIED_TIN; one of the two.")
        if sum(given(parameters, name) for name in ("TOLERANCE", "TOLERANCE_RASTER")) != 1:
            return tr("TOLERANCE: give a number here, or a TOLERANCE_RASTER; one of the two.")
        if given(parameters, "TOLERANCE_RASTER") and not given(parameters, "INPUT"):
            return tr("TOLERANCE_RASTER: goes with an elevation model as INPUT; give a number as TOLERANCE.")
        return ""

    def read_input(self, parameters, context, feedback):
        self.vertical_unit = word(self, parameters, "VERTICAL_UNIT", context)
        self.dem = read_raster(self, parameters, "INPUT", context, feedback, "BAND")
        self.tolerance_raster = read_raster(self, parameters, "TOLERANCE_RASTER", context, feedback)
        self.read = {}
        for mesh, layer in (("MESH", "TIN"), SIMPLIFIED):
            self.read[mesh] = read_mesh(self, parameters, mesh, context)
            self.read[layer] = read_tin_layer(self, parameters, layer, context, feedback)

    def compute(self, sightbound, parameters, context, feedback):
        original = self._original(sightbound, feedback)
        simplified = self._tin(sightbound, SIMPLIFIED, feedback)
        tolerance = self._tolerance(sightbound, original, parameters, context)
        with core_errors("SIMPLIFIED"):
            found = sightbound.verify(
                original,
                simplified,
                tolerance,
                resolution=number_or_none(self, parameters, "RESOLUTION", context),
                threads=self.threads(parameters, context),
                progress=Progress(feedback, 5.0, 90.0),
            )
        results = self._told(found.report, feedback)
        if given(parameters, "OUTPUT_HTML"):
            results["OUTPUT_HTML"] = self.parameterAsFileOutput(parameters, "OUTPUT_HTML", context)
            told = tr("a raster") if self.tolerance_raster else f"{tolerance:g} m"
            with core_errors("OUTPUT_HTML"):
                write_report(Path(results["OUTPUT_HTML"]), found.report, told)
        if given(parameters, "OUTPUT"):
            most = self.parameterAsInt(parameters, "MOST_POINTS", context)
            results["OUTPUT"] = write_points(self, original, simplified, found, tolerance, most, parameters, context)
        feedback.setProgress(100.0)
        return results

    def _original(self, sightbound, feedback):
        if self.dem:
            return open_dem(sightbound, self.dem, self.vertical_unit, feedback)
        return self._tin(sightbound, ("MESH", "TIN"), feedback)

    def _tin(self, sightbound, names, feedback):
        name = next(one for one in names if self.read[one])
        with core_errors(name):
            opened = open_mesh if name == names[0] else open_tin
            tin = opened(sightbound, self.read[name], self.vertical_unit, feedback)
        for note in tin.notes:
            feedback.pushInfo(f"{name}: {note}")
        return tin

    def _tolerance(self, sightbound, original, parameters, context):
        if not self.tolerance_raster:
            return self.parameterAsDouble(parameters, "TOLERANCE", context)
        with core_errors("TOLERANCE_RASTER"):
            raster = sightbound.read_dem(self.tolerance_raster.path, band=self.tolerance_raster.band, vertical_unit="metre")
        apart = (abs(a - b) for a, b in zip(raster.geotransform, original.geotransform))
        if raster.shape != original.shape or max(apart) > 1e-6 * self.dem.cell:
            raise bad_input("TOLERANCE_RASTER", tr("it must have the cells of INPUT; use Align rasters before."))
        return raster.heights

    def _told(self, report, feedback):
        results = {}
        for name, label, keys in NUMBERS:
            value = report
            for key in keys:
                value = value[key]
            results[name] = value
            feedback.pushInfo(f"{tr(label)}: {upward(value)}")
        for name, label, key in FLAGS:
            results[name] = report[key]
            feedback.pushInfo(f"{tr(label)} {tr('yes') if report[key] else tr('no')}")
        return results
