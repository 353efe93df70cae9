# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimate error: what a DEM, check points, or a better DEM tell about the DEM's error."""

from pathlib import Path

from qgis.core import (
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterRasterDestination,
)

from .. import parameters as blocks
from ..check_points import read_check_points
from ..error_html import in_words, write_report
from ..errors import core_errors
from ..feedback import Progress
from ..log import log_report
from ..rasters import creation_options, open_dem, read_raster
from ..styling import style_when_loaded
from ..text import tr
from ..values import given, word
from .base import SightboundAlgorithm

METRES_PER = {"metre": 1.0, "foot": 0.3048, "us-foot": 1200.0 / 3937.0}
# output, label, argument of write
MAPS = (
    ("OUTPUT_BETWEEN", "Sigma between samples, half a spacing away (m)", "between"),
    ("OUTPUT_SAMPLING", "Sigma of the samples (m)", "sampling"),
)
# output, label, where it stands in what check points or reference told
NUMBERS = (
    ("BIAS", "Bias: median of model minus truth (m)", ("median",)),
    ("RMSE", "Root mean square error (m)", ("rmse",)),
    ("NMAD", "NMAD: spread deaf to outliers (m)", ("nmad",)),
    ("LE90", "90 % of the errors are smaller (m)", ("le90",)),
    ("CORRELATION_LENGTH", "Correlation length of the errors (m)", ("variogram", "correlation_length")),
    ("SHIFT_X", "Shift along x, model minus truth (m)", ("shift", "dx")),
    ("SHIFT_Y", "Shift along y, model minus truth (m)", ("shift", "dy")),
    ("SHIFT_Z", "Shift upwards, model minus truth (m)", ("shift", "dz")),
)


class EstimateError(SightboundAlgorithm):
    NAME = "estimateerror"
    TITLE = "Estimate error"
    SUMMARY = "How wrong is the elevation model? Learnt from itself, from check points, or from a better model."
    TAGS = (
        "error", "accuracy", "uncertainty", "rmse", "nmad", "le90", "bias", "check points", "validation", "variogram",
        "coregistration", "shift", "nuth", "kaab", "dem", "dod", "difference",
    )  # fmt: skip

    def initAlgorithm(self, configuration=None):
        for parameter in [
            *blocks.dem_block(),
            blocks.points("CHECKPOINTS", tr("Check points"), optional=True),
            blocks.field("ELEVATION_FIELD", tr("Field with the elevation (empty: Z of the points)"), "CHECKPOINTS", numeric=True),
            blocks.raster("REFERENCE", tr("A better elevation model of at least a part"), True),
            blocks.choice("SAMPLES_OR_MEANS", tr("A cell holds"), ["auto", "samples", "means"], "auto"),
            QgsProcessingParameterBoolean("CORRECT_SHIFT", tr("Judge with the shift taken off"), False, True),
            blocks.product_parameter(),
            blocks.advanced(
                blocks.choice("CHECKPOINT_UNIT", tr("Vertical unit of the check points"), list(METRES_PER), "metre")
            ),
            blocks.vertical_unit_parameter(),
            *blocks.run_block(),
        ]:
            self.add(parameter)
        model = QgsProcessingParameterFileDestination("OUTPUT_MODEL", tr("Error model file"), "JSON (*.json)")
        self.add(model, optional=True)
        self.add(QgsProcessingParameterFileDestination("OUTPUT_HTML", tr("Report"), "HTML (*.html)"), optional=True)
        for name, label, _ in MAPS:
            self.add(QgsProcessingParameterRasterDestination(name, tr(label)), optional=True, by_default=name == "OUTPUT_BETWEEN")
        moved = QgsProcessingParameterRasterDestination("OUTPUT_CORRECTED", tr("Elevation model with the shift taken off"))
        self.add(moved, optional=True, by_default=False)
        for name, label, _ in NUMBERS:
            self.addOutput(QgsProcessingOutputNumber(name, tr(label)))
        self.addOutput(QgsProcessingOutputNumber("GROWTH_EXPONENT", tr("Growth exponent H")))
        self.addOutput(QgsProcessingOutputNumber("TYPICAL_SIGMA", tr("Sigma between samples, over all of the model (m)")))
        self.addOutput(QgsProcessingOutputString("ERROR_MODEL_USED", tr("Error model (JSON)")))

    def contradiction(self, parameters, context):
        if given(parameters, "CHECKPOINTS") or given(parameters, "REFERENCE"):
            if word(self, parameters, "ERROR_PRODUCT", context) != "none":
                return tr("ERROR_PRODUCT: CHECKPOINTS and REFERENCE measure what a product only publishes; leave it at none.")
            return ""
        if given(parameters, "OUTPUT_CORRECTED"):
            return tr("OUTPUT_CORRECTED: a shift is seen only against CHECKPOINTS or a REFERENCE; give one of them.")
        return ""

    def read_input(self, parameters, context, feedback):
        self.dem = read_raster(self, parameters, "INPUT", context, feedback, "BAND")
        self.vertical_unit = word(self, parameters, "VERTICAL_UNIT", context)
        self.reference = read_raster(self, parameters, "REFERENCE", context, feedback)
        unit = METRES_PER[word(self, parameters, "CHECKPOINT_UNIT", context)]
        self.checkpoints = read_check_points(self, parameters, context, feedback, self.dem, unit)
        self.options = creation_options(self, parameters, context)

    def compute(self, sightbound, parameters, context, feedback):
        dem = open_dem(sightbound, self.dem, self.vertical_unit, feedback)
        corrected = self.parameterAsBoolean(parameters, "CORRECT_SHIFT", context)
        product = word(self, parameters, "ERROR_PRODUCT", context)
        with core_errors("REFERENCE" if self.reference else "CHECKPOINTS"):
            model = sightbound.estimate_error(
                dem,
                word(self, parameters, "SAMPLES_OR_MEANS", context),
                checkpoints=self.checkpoints,
                reference=self._reference(sightbound, feedback),
                error_model=None if product == "none" else sightbound.product_error(product),
                correct_shift=corrected,
                progress=Progress(feedback, 0.0, 70.0),
            )
        report = model.report
        log_report(feedback, {"error_model": model.to_json(), "warnings": report["warnings"]}, in_words(model))
        results = {
            "ERROR_MODEL_USED": model.to_json(),
            "GROWTH_EXPONENT": report["growth_exponent"],
            "TYPICAL_SIGMA": report["typical_sigma"],
        }
        check = report.get("reference") or report.get("checkpoints")
        results.update(self._told(check, feedback))
        if given(parameters, "OUTPUT_CORRECTED"):
            results["OUTPUT_CORRECTED"] = self._write_corrected(sightbound, dem, check, parameters, context, feedback)
        if given(parameters, "OUTPUT_MODEL"):
            results["OUTPUT_MODEL"] = self.parameterAsFileOutput(parameters, "OUTPUT_MODEL", context)
            with core_errors("OUTPUT_MODEL"):
                Path(results["OUTPUT_MODEL"]).write_text(model.to_json(), encoding="utf-8")
        results.update(self._write_maps(sightbound, dem, model, parameters, context, feedback))
        feedback.setProgress(100.0)
        return results

    def _reference(self, sightbound, feedback):
        if self.reference is None:
            return None
        reference = sightbound.read_dem(self.reference.path)
        for note in reference.notes:
            feedback.pushInfo(f"REFERENCE: {note}")
        return reference

    def _told(self, check, feedback):
        results = {}
        for name, label, keys in NUMBERS if check else ():
            value = check
            for key in keys:
                value = value[key] if value is not None else None
            if value is not None:
                results[name] = value
                feedback.pushInfo(f"{tr(label)}: {value:.6g}")
        return results

    def _write_corrected(self, sightbound, dem, check, parameters, context, feedback):
        path = self.parameterAsOutputLayer(parameters, "OUTPUT_CORRECTED", context)
        if check["shift"] is None:
            feedback.pushWarning(tr("No shift could be told; OUTPUT_CORRECTED only has the bias taken off."))
        if not check["correction"]["taken_off"]:
            feedback.pushWarning(
                tr(
                    "The error model is that of INPUT with its shift and bias, not that of OUTPUT_CORRECTED, from which "
                    "they are taken off. Turn CORRECT_SHIFT on for a model to use with OUTPUT_CORRECTED."
                )
            )
        with core_errors("OUTPUT_CORRECTED"):
            progress = Progress(feedback, 70.0, 80.0)
            sightbound.write_corrected(dem, path, check["correction"], creation_options=self.options, progress=progress)
        style_when_loaded(context, path, "surface", stretch=0.98)
        return path

    def _write_maps(self, sightbound, dem, model, parameters, context, feedback):
        wanted = [row for row in MAPS if given(parameters, row[0])]
        report = given(parameters, "OUTPUT_HTML")
        if not wanted and not report:
            return {}
        maps = sightbound.error_maps(
            dem, model, threads=self.threads(parameters, context), progress=Progress(feedback, 80.0, 90.0)
        )
        results = {row[0]: self.parameterAsOutputLayer(parameters, row[0], context) for row in wanted}
        if wanted:
            with core_errors("OUTPUT_BETWEEN", {path: name for name, path in results.items()}):
                maps.write(
                    **{row[2]: results[row[0]] for row in wanted},
                    creation_options=self.options,
                    progress=Progress(feedback, 90.0, 99.0),
                )
        for path in results.values():
            style_when_loaded(context, path, "sigma", stretch=0.98)
        if report:
            results["OUTPUT_HTML"] = self.parameterAsFileOutput(parameters, "OUTPUT_HTML", context)
            with core_errors("OUTPUT_HTML"):
                write_report(Path(results["OUTPUT_HTML"]), model, sightbound.two_sided_quantile, maps.between + maps.sampling)
        return results
