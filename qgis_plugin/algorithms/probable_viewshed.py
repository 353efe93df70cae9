# SPDX-License-Identifier: GPL-3.0-or-later
"""Probable viewshed: in how many of the terrains that could lie behind a DEM is each cell seen?"""

from qgis.core import (
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterRasterDestination,
    QgsProcessingParameterString,
)

from .. import observers
from .. import parameters as blocks
from ..defaults import default
from ..error_block import check_error_block, read_error_block
from ..errors import bad_input
from ..feedback import Progress
from ..log import area, log_areas, log_report
from ..raster_outputs import write_rasters
from ..rasters import creation_options, open_dem, read_extent, read_raster
from ..text import tr
from ..values import given, number_or_none, word
from .base import SightboundAlgorithm

# output, label, argument of result.write, style, share of the values that the ramp spans, optional
RASTERS = (
    ("OUTPUT", "Probability of being seen", "probability", "confidence", 0.0, False),
    ("OUTPUT_VERDICT", "Verdict", "verdict", "verdict", 0.0, True),
    ("OUTPUT_ERROR", "Standard error of the probability", "standard_error", "sigma", 1.0, True),
    ("OUTPUT_HEIGHTS", "Probability at the further heights, a band each", "at_heights", "confidence", 0.0, True),
)
SHOWN = ("OUTPUT", "OUTPUT_VERDICT")  # unless the user says otherwise
NUMBERS = (
    ("AREA_EXPECTED", "Visible area to be expected (m²)", "expected_visible_m2"),
    ("AREA_VISIBLE", "Area visible (m²)", "visible_m2"),
    ("AREA_UNCERTAIN", "Area uncertain (m²)", "uncertain_m2"),
    ("AREA_HIDDEN", "Area hidden (m²)", "hidden_m2"),
    ("LARGEST_ERROR", "Largest standard error of a probability", "largest_standard_error"),
)


class ProbableViewshed(SightboundAlgorithm):
    NAME = "probableviewshed"
    TITLE = "Probable viewshed"
    SUMMARY = "How probable is it that each cell is seen, over the terrains that could lie behind the elevation model?"
    TAGS = (
        "viewshed",
        "visibility",
        "probability",
        "probable",
        "fuzzy",
        "monte carlo",
        "simulation",
        "uncertainty",
        "error",
        "observer",
        "dem",
        "terrain",
    )

    def initAlgorithm(self, configuration=None):
        heights = QgsProcessingParameterString(
            "HEIGHTS", tr("Further target heights, in metres (as: 0.5, 2, 30)"), "", False, True
        )
        draws = blocks.number(
            "REALISATIONS", tr("Largest number of terrains drawn"), default("realisations"), 1, 65535, integer=True
        )
        for parameter in (
            blocks.dem_block()
            + blocks.observers_block()
            + [heights, blocks.confidence_parameter(), draws]
            + blocks.error_block()
            + blocks.limits_block()
            + [blocks.vertical_unit_parameter(), *blocks.earth_block(), *self._drawing(), blocks.extent_parameter()]
            + blocks.run_block()
        ):
            self.add(parameter)
        for name, label, _, _, _, optional in RASTERS:
            self.add(QgsProcessingParameterRasterDestination(name, tr(label)), optional, name in SHOWN)
        for name, label, _ in NUMBERS:
            self.addOutput(QgsProcessingOutputNumber(name, tr(label)))
        self.addOutput(QgsProcessingOutputString("ERROR_MODEL_USED", tr("Error model used (JSON)")))

    def _drawing(self):
        """How terrains are drawn, and when enough of them."""
        return [
            blocks.advanced(parameter)
            for parameter in (
                blocks.number("PRECISION", tr("Precision of a probability (0: draw all)"), default("precision"), 0.0, 0.5),
                blocks.choice("METHOD", tr("Terrains"), ["conditional", "perturb"], default("method")),
                blocks.number("REFINEMENT", tr("Refinement near eye and target"), default("refinement"), 0, 1, integer=True),
                blocks.number("SEED", tr("Seed of the draws"), default("seed"), 0, None, integer=True),
            )
        ]

    def contradiction(self, parameters, context):
        return (
            self.bad_confidence(parameters, context)
            or observers.check_observers(parameters)
            or check_error_block(self, parameters, context)
        )

    def read_input(self, parameters, context, feedback):
        self.dem = read_raster(self, parameters, "INPUT", context, feedback, "BAND")
        self.places, _ = observers.read_observers(self, parameters, context, feedback, self.dem)
        self.vertical_unit = word(self, parameters, "VERTICAL_UNIT", context)
        self.error = read_error_block(self, parameters, context, feedback, self.dem)
        self.extent = read_extent(self, parameters, context, self.dem)
        self.heights = self._heights(parameters, context)
        self.options = creation_options(self, parameters, context)

    def compute(self, sightbound, parameters, context, feedback):
        result = sightbound.probable_viewshed(
            open_dem(sightbound, self.dem, self.vertical_unit, feedback),
            [(place.x, place.y) for place in self.places],
            **observers.core_arguments(self.places),
            error_model=self.error.model(sightbound),
            confidence=self.parameterAsDouble(parameters, "CONFIDENCE", context),
            refraction=self.parameterAsDouble(parameters, "REFRACTION", context),
            curvature=self.parameterAsBoolean(parameters, "CURVATURE", context),
            realisations=self._whole(parameters, "REALISATIONS", context),
            seed=self._whole(parameters, "SEED", context),
            precision=self._number(parameters, "PRECISION", context),
            heights=self.heights,
            method=word(self, parameters, "METHOD", context),
            refinement=self._whole(parameters, "REFINEMENT", context),
            extent=self.extent,
            threads=self.threads(parameters, context),
            progress=Progress(feedback, 0.0, 95.0),
        )
        report = result.report
        self._log(report, parameters, context, feedback)
        results = write_rasters(self, result, RASTERS, parameters, context, feedback, first=95.0)
        results.update({name: report[key] for name, _, key in NUMBERS})
        results["ERROR_MODEL_USED"] = report["error_model"]
        return results

    def _log(self, report, parameters, context, feedback):
        log_report(feedback, report)
        log_areas(feedback, report, self.parameterAsDouble(parameters, "CONFIDENCE", context))
        feedback.pushInfo(tr("Visible area to be expected: {}.").format(area(report["expected_visible_m2"])))
        told = tr("Up to {} terrains were drawn for the {} that may differ; a probability is known to ± {:.2g}.")
        drawn = report["realisations"], area(report["in_doubt_m2"]), report["largest_standard_error"]
        feedback.pushInfo(told.format(*drawn))

    def _number(self, parameters, name, context):
        number = number_or_none(self, parameters, name, context)
        return self.parameterDefinition(name).defaultValue() if number is None else number

    def _whole(self, parameters, name, context):
        return int(self._number(parameters, name, context))

    def _heights(self, parameters, context):
        """Numbers between commas; between semicolons a comma is a decimal one."""
        text = self.parameterAsString(parameters, "HEIGHTS", context) or ""
        try:
            parts = text.replace(",", ".").split(";") if ";" in text else text.split(",")
            heights = [float(one) for one in parts if one.strip()]
        except ValueError:
            raise bad_input("HEIGHTS", tr("is “{}”; give metres above ground, as 0.5, 2, 30.").format(text)) from None
        if given(parameters, "OUTPUT_HEIGHTS") and not heights:
            raise bad_input("OUTPUT_HEIGHTS", tr("needs HEIGHTS: give at least one."))
        return heights
