# SPDX-License-Identifier: GPL-3.0-or-later
"""Error surfaces: one standard deviation of the terrain's error, and the surfaces it lies between."""

from pathlib import Path

from qgis.core import (
    QgsProcessingOutputString,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterRasterDestination,
)

from .. import parameters as blocks
from ..error_block import check_error_block, read_error_block
from ..feedback import Progress
from ..log import log_report
from ..raster_outputs import write_rasters
from ..rasters import creation_options, open_dem, read_extent, read_raster
from ..text import tr
from ..values import given, word
from .base import SightboundAlgorithm

# output, label, argument of write, style
RASTERS = (
    ("OUTPUT_SIGMA", "Sigma: one standard deviation of the error (m)", "sigma", "sigma", 0.98),
    ("OUTPUT_LOWER", "Lower surface", "lower", "surface", 0.98),
    ("OUTPUT_UPPER", "Upper surface", "upper", "surface", 0.98),
)


class ErrorSurfaces(SightboundAlgorithm):
    NAME = "errorsurfaces"
    TITLE = "Error surfaces"
    SUMMARY = "How wrong may the elevation model be, and between which surfaces does the true terrain lie?"
    TAGS = (
        "error",
        "uncertainty",
        "accuracy",
        "rmse",
        "le90",
        "sigma",
        "confidence",
        "dem",
        "terrain",
        "envelope",
    )

    def initAlgorithm(self, configuration=None):
        for parameter in (
            blocks.dem_block()
            + [blocks.confidence_parameter()]
            + blocks.error_block()
            + [blocks.vertical_unit_parameter(), blocks.extent_parameter()]
            + blocks.run_block()
        ):
            self.add(parameter)
        for name, label, *_ in RASTERS:
            self.add(
                QgsProcessingParameterRasterDestination(name, tr(label)), optional=name != "OUTPUT_SIGMA"
            )
        recipe = QgsProcessingParameterFileDestination(
            "OUTPUT_MODEL", tr("Error model file"), "JSON (*.json)"
        )
        self.add(recipe, optional=True, by_default=False)
        self.addOutput(QgsProcessingOutputString("ERROR_MODEL_USED", tr("Error model used (JSON)")))

    def contradiction(self, parameters, context):
        return self.bad_confidence(parameters, context) or check_error_block(self, parameters, context)

    def read_input(self, parameters, context, feedback):
        self.dem = read_raster(self, parameters, "INPUT", context, feedback, "BAND")
        self.vertical_unit = word(self, parameters, "VERTICAL_UNIT", context)
        self.error = read_error_block(self, parameters, context, feedback, self.dem)
        self.extent = read_extent(self, parameters, context, self.dem)
        self.options = creation_options(self, parameters, context)

    def compute(self, sightbound, parameters, context, feedback):
        dem = open_dem(sightbound, self.dem, self.vertical_unit, feedback)
        surfaces = sightbound.error_surfaces(
            dem,
            error_model=self.error.model(sightbound),
            confidence=self.parameterAsDouble(parameters, "CONFIDENCE", context),
            extent=self.extent,
            threads=self.threads(parameters, context),
            progress=Progress(feedback, 0.0, 90.0),
        )
        used = surfaces.report["error_model"]
        log_report(feedback, surfaces.report)
        results = write_rasters(self, surfaces, RASTERS, parameters, context, feedback, first=90.0)
        results["ERROR_MODEL_USED"] = used
        if given(parameters, "OUTPUT_MODEL"):
            results["OUTPUT_MODEL"] = self.parameterAsFileOutput(parameters, "OUTPUT_MODEL", context)
            Path(results["OUTPUT_MODEL"]).write_text(used, encoding="utf-8")
        return results
