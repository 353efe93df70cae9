# SPDX-License-Identifier: GPL-3.0-or-later
"""Confidence viewshed: how sure is it that each cell of a DEM is seen from the observers?"""

from contextlib import ExitStack
from dataclasses import dataclass

from qgis.core import (
    QgsProcessing,
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterRasterDestination,
)

from .. import observers
from .. import parameters as blocks
from ..defaults import default
from ..error_block import check_error_block, read_error_block
from ..feedback import Progress
from ..log import log_areas, log_report
from ..observer_outputs import observer_rasters, write_observer_table
from ..raster_outputs import write_rasters
from ..rasters import creation_options, open_dem, read_extent, read_raster
from ..text import tr
from ..values import given, word
from .base import SightboundAlgorithm

# output, label, argument of result.write, style, share of the values that the ramp spans (0: as the style says),
# optional, made unless asked not to
RASTERS = (
    ("OUTPUT", "Confidence", "confidence", "confidence", 0.0, False, True),
    ("OUTPUT_VERDICT", "Verdict", "verdict", "verdict", 0.0, True, True),
    ("OUTPUT_COUNT", "Number of observers that surely see", "count", "count", 1.0, True, False),
    ("OUTPUT_HEIGHT", "Lowest visible height, certain", "height", "height", 0.98, True, False),
    ("OUTPUT_HEIGHT_LIKELY", "Lowest visible height, likely", "likely_height", "height", 0.98, True, False),
)
NUMBERS = (
    ("AREA_VISIBLE", "Area visible (m²)", "visible_m2"),
    ("AREA_UNCERTAIN", "Area uncertain (m²)", "uncertain_m2"),
    ("AREA_HIDDEN", "Area hidden (m²)", "hidden_m2"),
    ("SHARE_VISIBLE", "Share visible", "visible_share"),
    ("SHARE_UNCERTAIN", "Share uncertain", "uncertain_share"),
    ("SHARE_HIDDEN", "Share hidden", "hidden_share"),
)


@dataclass
class Job:
    """What was read in the main thread."""

    dem: object
    vertical_unit: str
    ground: object
    error: object
    places: list
    source: object  # of OBSERVERS; None for a single OBSERVER
    arguments: dict  # of the core's viewshed, all but the DEM, the observers and what only a run knows
    options: list


class ConfidenceViewshed(SightboundAlgorithm):
    NAME = "confidenceviewshed"
    TITLE = "Confidence viewshed"
    SUMMARY = "How sure is it that each cell is seen, given the error of the elevation model?"
    TAGS = (
        "viewshed",
        "visibility",
        "visible",
        "line of sight",
        "los",
        "intervisibility",
        "uncertainty",
        "error",
        "confidence",
        "probability",
        "observer",
        "dem",
        "terrain",
    )

    def initAlgorithm(self, configuration=None):
        combine = blocks.choice("COMBINE", tr("Combine observers"), ["best", "worst"], default("combine"))
        for parameter in (
            blocks.dem_block()
            + blocks.observers_block()
            + [blocks.confidence_parameter(), combine]
            + blocks.error_block()
            + blocks.limits_block()
            + blocks.sight_block()
            + [blocks.extent_parameter()]
            + blocks.run_block()
        ):
            self.add(parameter)
        for name, label, _, _, _, optional, by_default in RASTERS:
            self.add(QgsProcessingParameterRasterDestination(name, tr(label)), optional, by_default)
        table = QgsProcessingParameterFeatureSink(
            "OUTPUT_OBSERVERS", tr("Observers with areas"), QgsProcessing.SourceType.TypeVectorPoint
        )
        self.add(table, optional=True, by_default=False)
        folder = QgsProcessingParameterFolderDestination(
            "OUTPUT_FOLDER", tr("Folder for one raster per observer")
        )
        self.add(folder, optional=True, by_default=False)
        for name, label, _ in NUMBERS:
            self.addOutput(QgsProcessingOutputNumber(name, tr(label)))
        self.addOutput(QgsProcessingOutputString("ERROR_MODEL_USED", tr("Error model used (JSON)")))

    def contradiction(self, parameters, context):
        return (
            self.bad_confidence(parameters, context)
            or observers.check_observers(parameters)
            or check_error_block(self, parameters, context)
        )

    def read_input(self, parameters, context, feedback):
        dem = read_raster(self, parameters, "INPUT", context, feedback, "BAND")
        places, source = observers.read_observers(self, parameters, context, feedback, dem)
        self.options = creation_options(self, parameters, context)
        self.job = Job(
            dem=dem,
            vertical_unit=word(self, parameters, "VERTICAL_UNIT", context),
            ground=read_raster(self, parameters, "GROUND", context, feedback),
            error=read_error_block(self, parameters, context, feedback, dem),
            places=places,
            source=source,
            arguments=self._arguments(parameters, context, dem, places),
            options=self.options,
        )

    def _arguments(self, parameters, context, dem, places):
        heights = given(parameters, "OUTPUT_HEIGHT") or given(parameters, "OUTPUT_HEIGHT_LIKELY")
        return {
            **observers.core_arguments(places),
            "confidence": self.parameterAsDouble(parameters, "CONFIDENCE", context),
            "refraction": self.parameterAsDouble(parameters, "REFRACTION", context),
            "curvature": self.parameterAsBoolean(parameters, "CURVATURE", context),
            "stand": word(self, parameters, "STAND", context),
            "combine": word(self, parameters, "COMBINE", context),
            "height_reference": word(self, parameters, "HEIGHT_REFERENCE", context),
            "see_across_nodata": self.parameterAsBoolean(parameters, "SEE_ACROSS_NODATA", context),
            "extent": read_extent(self, parameters, context, dem),
            "heights": heights,
            "threads": self.threads(parameters, context),
        }

    def compute(self, sightbound, parameters, context, feedback):
        job = self.job
        dem = open_dem(sightbound, job.dem, job.vertical_unit, feedback)
        arguments = dict(job.arguments, error_model=job.error.model(sightbound))
        if job.ground is not None:
            arguments["ground"] = job.ground.path
        spots = [(place.x, place.y) for place in job.places]
        rasters_too = given(parameters, "OUTPUT_FOLDER")
        progress = Progress(feedback, 0.0, 50.0 if rasters_too else 95.0)
        result = sightbound.viewshed(dem, spots, progress=progress, **arguments)
        log_report(feedback, result.report)
        log_areas(feedback, result.report, arguments["confidence"])
        results = {}
        with ExitStack() as stack:
            if rasters_too:
                folder = self.parameterAsString(parameters, "OUTPUT_FOLDER", context)
                stack.enter_context(observer_rasters(folder, sightbound, dem, job, arguments, feedback))
                results["OUTPUT_FOLDER"] = folder
            feedback.setProgressText(tr("Writing"))
            results.update(write_rasters(self, result, RASTERS, parameters, context, feedback, first=95.0))
            if given(parameters, "OUTPUT_OBSERVERS"):
                table = write_observer_table(self, job, result.report, parameters, context)
                results["OUTPUT_OBSERVERS"] = table
        results.update({name: result.report[key] for name, _, key in NUMBERS})
        results["ERROR_MODEL_USED"] = result.report["error_model"]
        return results
