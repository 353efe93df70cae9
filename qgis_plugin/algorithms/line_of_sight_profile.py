# SPDX-License-Identifier: GPL-3.0-or-later
"""Line of sight profile: is each line clear, how surely, and where is that decided?"""

import re
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
from ..error_block import check_error_block
from ..errors import core_errors
from ..feedback import Progress
from ..line_extras import extras_block
from ..line_outputs import write_critical_places, write_lines
from ..log import counted, log_report
from ..observers import read_points
from ..pairs import check_pairing, find_pairs
from ..profile_html import write_profiles
from ..text import tr
from ..values import given, number_or_none, word
from .lines_base import LinesAlgorithm

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


class LineOfSightProfile(LinesAlgorithm):
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
        "probability",
        "radio",
        "fresnel",
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
            + extras_block()
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

    def read_input(self, parameters, context, feedback):
        self.read_terrain(parameters, context, feedback)
        ends = [
            read_points(
                self,
                parameters,
                layer,
                context,
                feedback,
                self.dem,
                [height],
                {height: f"{height}_FIELD"},
                naming,
            )[0]
            for layer, height, naming in (
                ("OBSERVERS", "OBSERVER_HEIGHT", "OBSERVER_FIELD"),
                ("TARGETS", "TARGET_HEIGHT", "TARGET_FIELD"),
            )
        ]
        by_name = word(self, parameters, "PAIRING", context) == "field"
        reach = number_or_none(self, parameters, "MAX_DISTANCE", context)
        self.pairs = find_pairs(*ends, by_name, reach, self.dem.crs, context, feedback)

    def compute(self, sightbound, parameters, context, feedback):
        dem, arguments = self.open_terrain(sightbound, feedback)
        eyes, targets = zip(*self.pairs)
        with core_errors(paths=self.paths, rename=self._with_labels):
            sights = sightbound.lines_of_sight(
                dem,
                [(place.x, place.y) for place in eyes],
                [(place.x, place.y) for place in targets],
                observer_height=[place.values["OBSERVER_HEIGHT"] for place in eyes],
                target_height=[place.values["TARGET_HEIGHT"] for place in targets],
                progress=Progress(feedback, 0.0, 95.0),
                **arguments,
            )
        lines = [SightLine(*pair, sight) for pair, sight in zip(self.pairs, sights)]
        used = sights[0].report["error_model"]
        warnings = dict.fromkeys(text for sight in sights for text in sight.report["warnings"])
        log_report(feedback, {"error_model": used, "warnings": warnings})
        feedback.pushInfo(counted((line.verdict for line in lines), self.confidence))
        return self._write(lines, used, parameters, context, feedback)

    def _with_labels(self, message):
        """The core counts the ends of the lines; users know them as features of two layers."""

        def label(found):
            number = int(found.group(2)) - 1
            if number >= len(self.pairs):
                return found.group(0)
            return self.pairs[number][found.group(1).lower() == "target"].label

        return re.sub(r"\b([Oo]bserver|[Tt]arget) (\d+)\b", label, message)

    def _write(self, lines, used, parameters, context, feedback):
        results = {"ERROR_MODEL_USED": used}
        for verdict in VERDICTS:
            results[f"COUNT_{verdict.upper()}"] = sum(line.verdict == verdict for line in lines)
        results["OUTPUT"] = write_lines(
            self, lines, self.dem, parameters, context, self.extras, feedback
        )
        if given(parameters, "OUTPUT_CRITICAL"):
            results["OUTPUT_CRITICAL"] = write_critical_places(self, lines, self.dem, parameters, context)
        if given(parameters, "OUTPUT_HTML"):
            results["OUTPUT_HTML"] = self.parameterAsFileOutput(parameters, "OUTPUT_HTML", context)
            write_profiles(Path(results["OUTPUT_HTML"]), lines, self.confidence, used)
        feedback.setProgress(100.0)
        return results
