# SPDX-License-Identifier: GPL-3.0-or-later
"""Targets in an error volume: listed points, or a raster of points at one height above the ground."""

from qgis.core import (
    QgsProcessing,
    QgsProcessingOutputNumber,
    QgsProcessingParameterFeatureSink,
    QgsProcessingParameterRasterDestination,
)

from .. import parameters as blocks
from ..defaults import default
from ..errors import core_errors
from ..feedback import Progress
from ..rasters import creation_options
from ..styling import style_when_loaded
from ..targets import LAYER, VERDICTS, read_targets, write_targets
from ..text import tr
from ..values import given, is_varying, word
from ..views import read_views, sight_arguments, views_block
from .volume_base import VolumeAlgorithm

# output, label, argument of write (and style)
RASTERS = (
    ("OUTPUT_CONFIDENCE", "Confidence of visibility at the target height", "confidence"),
    ("OUTPUT_VERDICT", "Verdict at the target height", "verdict"),
)


class VolumeTargets(VolumeAlgorithm):
    NAME = "volumetargets"
    TITLE = "Targets in an error volume"
    SUMMARY = "Are these points seen, or all points at one height above the ground, and how sure is that?"
    TAGS = ("visibility", "targets", "points", "volume", "vdb", "raster", "line of sight", "uncertainty", "confidence")

    def initAlgorithm(self, configuration=None):
        height = blocks.number("TARGET_HEIGHT", tr("Target height in metres"), default("target_height"), optional=False)
        words = ["ground", "absolute"]
        reference = blocks.choice(
            "TARGET_HEIGHT_REFERENCE", tr("Heights of TARGETS are above"), words, default("height_reference")
        )
        for parameter in (
            [blocks.vdb("INPUT", tr("Error volume (.vdb)"))]
            + views_block()
            + [
                blocks.points(LAYER, tr("Targets (empty: only rasters)"), optional=True),
                blocks.varying(height, LAYER),
                blocks.metres("TARGET_SPACING", tr("Cell size of the rasters"), default("target_spacing")),
                blocks.confidence_parameter(),
                blocks.advanced(blocks.field("TARGET_HEIGHT_FIELD", tr("Field with the target height"), LAYER, numeric=True)),
                blocks.advanced(reference),
            ]
            + blocks.run_block()
        ):
            self.add(parameter)
        kind = QgsProcessing.SourceType.TypeVectorPoint
        self.add(QgsProcessingParameterFeatureSink("OUTPUT", tr("Targets with verdict"), kind), optional=True)
        for name, label, _ in RASTERS:
            self.add(QgsProcessingParameterRasterDestination(name, tr(label)), True, False)
        for verdict in VERDICTS:
            self.addOutput(QgsProcessingOutputNumber(f"COUNT_{verdict.upper()}", tr(f"Targets {verdict}")))

    def contradiction(self, parameters, context):
        rasters = any(given(parameters, name) for name, *_ in RASTERS)
        if not given(parameters, LAYER) and not rasters:
            return tr("TARGETS: give points, or ask for OUTPUT_CONFIDENCE or OUTPUT_VERDICT.")
        if rasters and (is_varying(parameters.get("TARGET_HEIGHT")) or given(parameters, "TARGET_HEIGHT_FIELD")):
            return tr("TARGET_HEIGHT: rasters are at one height; give a number, or leave the rasters out.")
        if rasters and word(self, parameters, "TARGET_HEIGHT_REFERENCE", context) != "ground":
            return tr("TARGET_HEIGHT_REFERENCE: rasters are at a height above the ground; leave them out.")
        return self.bad_confidence(parameters, context)

    def read_input(self, parameters, context, feedback):
        self.path = self.read_path(parameters, "INPUT", context)
        self.views = read_views(self, parameters, context, feedback)
        self.targets = read_targets(self, parameters, context, feedback)
        self.reference = word(self, parameters, "TARGET_HEIGHT_REFERENCE", context)
        self.options = creation_options(self, parameters, context)
        self.arguments = {
            **sight_arguments(self, parameters, context),
            "confidence": self.parameterAsDouble(parameters, "CONFIDENCE", context),
        }

    def compute(self, sightbound, parameters, context, feedback):
        volume = self.open_volume(sightbound.ErrorVolume, self.path, "INPUT", feedback, 10.0)
        arguments = {**self.arguments, **self.views.arguments(volume)}
        results = {}
        wanted = [row for row in RASTERS if given(parameters, row[0])]
        if self.targets is not None:
            last = 40.0 if wanted else 100.0
            results.update(self._see_targets(sightbound, volume, arguments, last, parameters, context, feedback))
        if wanted:
            results.update(self._see_layer(sightbound, volume, arguments, wanted, parameters, context, feedback))
        return results

    def _see_targets(self, sightbound, volume, arguments, last, parameters, context, feedback):
        with core_errors(LAYER):
            sight = sightbound.volume_targets(
                volume,
                target_height_reference=self.reference,
                progress=Progress(feedback, 10.0, last),
                **arguments,
                **self.targets.arguments(volume),
            )
        _warn(sight.report, feedback)
        verdicts = sight.verdict.tolist()
        results = {f"COUNT_{name.upper()}": verdicts.count(number) for number, name in enumerate(VERDICTS)}
        if given(parameters, "OUTPUT"):
            results["OUTPUT"] = write_targets(self, self.targets, sight, parameters, context)
        return results

    def _see_layer(self, sightbound, volume, arguments, wanted, parameters, context, feedback):
        here = 10.0 if self.targets is None else 40.0
        paths = {row[0]: self.parameterAsOutputLayer(parameters, row[0], context) for row in wanted}
        layer = sightbound.volume_layer(
            volume,
            target_height=self.parameterAsDouble(parameters, "TARGET_HEIGHT", context),
            target_spacing=self.parameterAsDouble(parameters, "TARGET_SPACING", context),
            progress=Progress(feedback, here, 90.0),
            **arguments,
        )
        _warn(layer.report, feedback)
        with core_errors(paths={path: name for name, path in paths.items()}):
            layer.write(
                **{row[2]: paths[row[0]] for row in wanted},
                creation_options=self.options,
                threads=arguments["threads"],
                progress=Progress(feedback, 90.0, 100.0),
            )
        for name, _, style in wanted:
            style_when_loaded(context, paths[name], style)
        return paths


def _warn(report, feedback):
    for warning in report["warnings"]:
        feedback.pushWarning(warning)
