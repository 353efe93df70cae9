# SPDX-License-Identifier: GPL-3.0-or-later
"""Intervisibility network: which points see each other, and how surely?"""

import re

from qgis.core import (
    QgsProcessing,
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
    QgsProcessingParameterFeatureSink,
)

from .. import parameters as blocks
from ..defaults import default
from ..error_block import check_error_block
from ..errors import core_errors
from ..feedback import Progress
from ..line_extras import extras_block
from ..log import counted, log_report
from ..network_outputs import VERDICTS, NetworkRows, write_critical, write_network, write_table
from ..observers import read_points
from ..text import tr
from ..values import given, number_or_none
from .lines_base import LinesAlgorithm

COUNTS = (
    ("COUNT_VISIBLE", "Pairs visible", 2),
    ("COUNT_UNCERTAIN", "Pairs uncertain", 1),
    ("COUNT_HIDDEN", "Pairs hidden", 0),
    ("COUNT_UNKNOWN", "Pairs that could not be judged", 255),
)


class IntervisibilityNetwork(LinesAlgorithm):
    NAME = "intervisibility"
    TITLE = "Intervisibility network"
    SUMMARY = "Which points see each other, how sure is that, and where is it decided?"
    TAGS = (
        "intervisibility",
        "network",
        "line of sight",
        "los",
        "many to many",
        "radio",
        "fresnel",
        "towers",
        "visibility",
        "probability",
        "uncertainty",
        "confidence",
        "dem",
        "terrain",
    )

    def initAlgorithm(self, configuration=None):
        height = default("observer_height")
        layers = [
            blocks.points("POINTS_A", tr("Points")),
            blocks.points("POINTS_B", tr("Other points (empty: each two of the points)"), optional=True),
        ]
        heights = [
            blocks.varying(
                blocks.number("HEIGHT_A", tr("Height of the points in metres"), height, optional=False), "POINTS_A"
            ),
            blocks.varying(
                blocks.number("HEIGHT_B", tr("Height of the other points in metres"), height), "POINTS_B"
            ),
        ]
        fields = [
            blocks.field("FIELD_A", tr("Field that names the points"), "POINTS_A"),
            blocks.field("FIELD_B", tr("Field that names the other points"), "POINTS_B"),
        ]
        height_fields = [
            blocks.field("HEIGHT_A_FIELD", tr("Field with the height of the points"), "POINTS_A", numeric=True),
            blocks.field("HEIGHT_B_FIELD", tr("Field with the height of the other points"), "POINTS_B", numeric=True),
        ]
        for parameter in (
            blocks.dem_block()
            + layers
            + fields
            + [blocks.metres("MAX_DISTANCE", tr("Maximum distance (empty: any)"))]
            + heights
            + [blocks.confidence_parameter()]
            + blocks.error_block()
            + [blocks.advanced(one) for one in height_fields]
            + blocks.sight_block()
            + extras_block()
            + [blocks.threads_parameter()]
        ):
            self.add(parameter)
        kinds = QgsProcessing.SourceType
        self.add(QgsProcessingParameterFeatureSink("OUTPUT", tr("Network"), kinds.TypeVectorLine))
        for name, label, kind in (
            ("OUTPUT_CRITICAL", tr("Critical places"), kinds.TypeVectorPoint),
            ("OUTPUT_TABLE", tr("Table of pairs"), kinds.TypeVector),
        ):
            self.add(QgsProcessingParameterFeatureSink(name, label, kind), optional=True, by_default=False)
        for name, label, _ in COUNTS:
            self.addOutput(QgsProcessingOutputNumber(name, tr(label)))
        self.addOutput(QgsProcessingOutputString("ERROR_MODEL_USED", tr("Error model used (JSON)")))

    def contradiction(self, parameters, context):
        for name in ("FIELD_B", "HEIGHT_B_FIELD"):
            if given(parameters, name) and not given(parameters, "POINTS_B"):
                return tr("{}: a field needs the layer POINTS_B.").format(name)
        return self.bad_confidence(parameters, context) or check_error_block(self, parameters, context)

    def read_input(self, parameters, context, feedback):
        self.read_terrain(parameters, context, feedback)

        def points(which):
            height, naming = f"HEIGHT_{which}", f"FIELD_{which}"
            heights = {height: f"{height}_FIELD"}
            layer = f"POINTS_{which}"
            return read_points(
                self, parameters, layer, context, feedback, self.dem, [height], heights, naming, outside=True
            )[0]

        self.here = points("A")
        self.there = points("B") if given(parameters, "POINTS_B") else None
        self.arguments["max_distance"] = number_or_none(self, parameters, "MAX_DISTANCE", context)
        self.arguments["threads"] = self.threads(parameters, context)

    def compute(self, sightbound, parameters, context, feedback):
        dem, arguments = self.open_terrain(sightbound, feedback)
        if self.there is not None:
            arguments["points_b"] = [(place.x, place.y) for place in self.there]
            arguments["height_b"] = [place.values["HEIGHT_B"] for place in self.there]
        with core_errors(paths=self.paths, rename=self._with_labels):
            network = sightbound.intervisibility(
                dem,
                [(place.x, place.y) for place in self.here],
                height_a=[place.values["HEIGHT_A"] for place in self.here],
                progress=Progress(feedback, 0.0, 80.0),
                **arguments,
            )
        report = network.report
        log_report(feedback, report)
        if report["too_far"]:
            left_out = tr("{} pairs are farther apart than MAX_DISTANCE and left out.")
            feedback.pushInfo(left_out.format(report["too_far"]))
        return self._write(network, report["error_model"], parameters, context, feedback)

    def _with_labels(self, message):
        """The core counts points; users know them as features of layers."""

        def label(found):
            places = self.here if found.group(2) == "points_a" else self.there
            return places[int(found.group(1)) - 1].label

        return re.sub(r"[Pp]oint (\d+) of (points_[ab])", label, message)

    def _write(self, network, used, parameters, context, feedback):
        verdicts = network["verdict"]
        results = {name: int((verdicts == verdict).sum()) for name, _, verdict in COUNTS}
        results["ERROR_MODEL_USED"] = used
        feedback.pushInfo(counted((VERDICTS.get(one, "unknown") for one in verdicts.tolist()), self.confidence))
        if results["COUNT_UNKNOWN"]:
            unknown = tr("{} pairs could not be judged: an end lies outside INPUT, or over nodata (see status).")
            feedback.pushWarning(unknown.format(results["COUNT_UNKNOWN"]))
        rows = NetworkRows(network, self.here, self.here if self.there is None else self.there, self.extras)
        results["OUTPUT"] = write_network(self, rows, self.dem, parameters, context, feedback)
        for name, write in (("OUTPUT_CRITICAL", write_critical), ("OUTPUT_TABLE", write_table)):
            if given(parameters, name):
                results[name] = write(self, rows, self.dem, parameters, context, feedback)
        feedback.setProgress(100.0)
        return results
