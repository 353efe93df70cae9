# SPDX-License-Identifier: GPL-3.0-or-later
"""Line of sight profile: is each line clear, how surely, and where is that decided?"""

from dataclasses import dataclass
from pathlib import Path

from qgis.core import (
    QgsProcessing,
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterFileDestination,
)

from .. import parameters as blocks
from ..defaults import default
from ..error_block import check_error_block, log_error_model, read_error_block
from ..errors import core_errors
from ..line_outputs import write_critical_places, write_lines
from ..observers import read_points
from ..pairs import check_pairing, find_pairs
from ..profile_html import write_profiles
from ..rasters import read_raster
from ..text import tr
from ..values import given, number_or_none, word
from .base import SightboundAlgorithm

VERDICTS = ("hidden", "uncertain", "visible")


@dataclass
class SightLine:
    """A pair of places and what the core says of the line between them."""

    observer: object
    target: object
    sight: object

    @property
    def verdict(self):
        return VERDICTS[self.sight.verdict] if self.sight.verdict < len(VERDICTS) else "unknown"


class LineOfSightProfile(SightboundAlgorithm):
    NAME = "lineofsightprofile"
    TITLE = "Line of sight profile"
    SUMMARY = "Is each line of sight clear, how sure is that, and which place decides it?"
    TAGS = (
        "line of sight",
        "los",
        "intervisibility",
        "profile",
        "visibility",
        "uncertainty",
        "confidence",
        "dem",
        "terrain",
    )

    def initAlgorithm(self, configuration=None):
        heights = [
            blocks.varying(
                blocks.number(
                    "OBSERVER_HEIGHT",
                    tr("Observer height in metres"),
                    default("observer_height"),
                    optional=False,
                ),
                "OBSERVERS",
            ),
            blocks.varying(
                blocks.number(
                    "TARGET_HEIGHT", tr("Target height in metres"), default("target_height"), optional=False
                ),
                "TARGETS",
            ),
        ]
        fields = [
            blocks.field("OBSERVER_FIELD", tr("Field that names the observers"), "OBSERVERS"),
            blocks.field("TARGET_FIELD", tr("Field that names the targets"), "TARGETS"),
        ]
        height_fields = [
            blocks.field(
                "OBSERVER_HEIGHT_FIELD", tr("Field with the observer height"), "OBSERVERS", numeric=True
            ),
            blocks.field("TARGET_HEIGHT_FIELD", tr("Field with the target height"), "TARGETS", numeric=True),
        ]
        for parameter in (
            blocks.dem_block()
            + [blocks.points("OBSERVERS", tr("Observers")), blocks.points("TARGETS", tr("Targets"))]
            + [blocks.choice("PAIRING", tr("Lines from each observer to"), ["all", "field"], "all")]
            + fields
            + [blocks.metres("MAX_DISTANCE", tr("Maximum distance (empty: any)"))]
            + heights
            + [blocks.confidence_parameter()]
            + blocks.error_block()
            + [blocks.advanced(one) for one in height_fields]
            + blocks.sight_block()
        ):
            self.add(parameter)
        lines, places = QgsProcessing.SourceType.TypeVectorLine, QgsProcessing.SourceType.TypeVectorPoint
        self.add(QgsProcessingParameterFeatureSink("OUTPUT", tr("Lines of sight"), lines))
        self.add(
            QgsProcessingParameterFeatureSink("OUTPUT_CRITICAL", tr("Critical places"), places), optional=True
        )
        page = QgsProcessingParameterFileDestination("OUTPUT_HTML", tr("Profiles"), "HTML (*.html)")
        self.add(page, optional=True)
        for verdict in VERDICTS:
            self.addOutput(QgsProcessingOutputNumber(f"COUNT_{verdict.upper()}", tr(f"Lines {verdict}")))
        self.addOutput(QgsProcessingOutputString("ERROR_MODEL_USED", tr("Error model used (JSON)")))

    def contradiction(self, parameters, context):
        return (
            self.bad_confidence(parameters, context)
            or check_pairing(self, parameters, context)
            or check_error_block(self, parameters, context)
        )

    def read(self, parameters, context, feedback):
        self.dem = read_raster(self, parameters, "INPUT", context, feedback, "BAND")
        self.vertical_unit = word(self, parameters, "VERTICAL_UNIT", context)
        self.ground = read_raster(self, parameters, "GROUND", context, feedback)
        self.error = read_error_block(self, parameters, context, feedback, self.dem)
        ends = [
            read_points(
                self, parameters, layer, context, self.dem, [height], {height: f"{height}_FIELD"}, naming
            )[0]
            for layer, height, naming in (
                ("OBSERVERS", "OBSERVER_HEIGHT", "OBSERVER_FIELD"),
                ("TARGETS", "TARGET_HEIGHT", "TARGET_FIELD"),
            )
        ]
        by_name = word(self, parameters, "PAIRING", context) == "field"
        reach = number_or_none(self, parameters, "MAX_DISTANCE", context)
        self.pairs = find_pairs(*ends, by_name, reach, self.dem.crs, context, feedback)
        self.arguments = {
            "confidence": self.parameterAsDouble(parameters, "CONFIDENCE", context),
            "refraction": self.parameterAsDouble(parameters, "REFRACTION", context),
            "curvature": self.parameterAsBoolean(parameters, "CURVATURE", context),
            "stand": word(self, parameters, "STAND", context),
            "height_reference": word(self, parameters, "HEIGHT_REFERENCE", context),
            "see_across_nodata": self.parameterAsBoolean(parameters, "SEE_ACROSS_NODATA", context),
        }

    def run(self, sightbound, parameters, context, feedback):
        with core_errors("INPUT"):
            dem = sightbound.read_dem(self.dem.path, band=self.dem.band, vertical_unit=self.vertical_unit)
        model, warnings = self._model(sightbound, dem)
        used = model.to_json()
        log_error_model(feedback, used)
        arguments = dict(self.arguments, error_model=model)
        if self.ground is not None:
            arguments["ground"] = self.ground.path
        lines = []
        for number, (observer, target) in enumerate(self.pairs):
            if feedback.isCanceled():
                raise sightbound.Cancelled()
            lines.append(
                SightLine(observer, target, self._look(sightbound, dem, observer, target, arguments))
            )
            warnings += lines[-1].sight.report["warnings"]
            feedback.setProgress(95.0 * (number + 1) / len(self.pairs))
        for warning in dict.fromkeys(warnings):
            feedback.pushWarning(warning)
        return self._write(lines, used, parameters, context, feedback)

    def _model(self, sightbound, dem):
        """One model for all lines: the estimate looks at the whole DEM, so it is made once."""
        model = self.error.model(sightbound)
        if model is None:
            model = sightbound.estimate_error(dem)
            return model, list(model.report["warnings"])
        return model, []

    def _look(self, sightbound, dem, observer, target, arguments):
        with core_errors("TARGETS", tr("{} to {}").format(observer.label, target.label)):
            return sightbound.line_of_sight(
                dem,
                (observer.x, observer.y),
                (target.x, target.y),
                observer_height=observer.values["OBSERVER_HEIGHT"],
                target_height=target.values["TARGET_HEIGHT"],
                **arguments,
            )

    def _write(self, lines, used, parameters, context, feedback):
        results = {"ERROR_MODEL_USED": used}
        for verdict in VERDICTS:
            results[f"COUNT_{verdict.upper()}"] = sum(line.verdict == verdict for line in lines)
        results["OUTPUT"] = write_lines(self, lines, self.dem, parameters, context)
        if given(parameters, "OUTPUT_CRITICAL"):
            results["OUTPUT_CRITICAL"] = write_critical_places(self, lines, self.dem, parameters, context)
        if given(parameters, "OUTPUT_HTML"):
            results["OUTPUT_HTML"] = self.parameterAsFileOutput(parameters, "OUTPUT_HTML", context)
            write_profiles(Path(results["OUTPUT_HTML"]), lines, self.arguments["confidence"], used)
        feedback.setProgress(100.0)
        return results
