# SPDX-License-Identifier: GPL-3.0-or-later
"""Volume viewshed: what cannot be seen, in three dimensions."""

from qgis.core import QgsProcessingParameterFileDestination

from .. import parameters as blocks
from ..defaults import default
from ..feedback import Progress
from ..hidden_outputs import add_outputs, write_outputs
from ..rasters import creation_options
from ..text import tr
from ..values import given, number_or_none
from ..views import read_views, sight_arguments, views_block
from .volume_base import VolumeAlgorithm


class VolumeViewshed(VolumeAlgorithm):
    NAME = "volumeviewshed"
    TITLE = "Volume viewshed"
    SUMMARY = "Where, and up to which height above ground, could something hide from the observers?"
    TAGS = (
        "viewshed",
        "visibility",
        "hidden",
        "volume",
        "voxel",
        "vdb",
        "3d",
        "fog",
        "patrol",
        "uncertainty",
        "confidence",
    )

    def initAlgorithm(self, configuration=None):
        height_spacing = blocks.metres("TARGET_HEIGHT_SPACING", tr("Spacing of the targets in height (empty: chosen)"))
        for parameter in (
            [blocks.vdb("INPUT", tr("Error volume (.vdb)"))]
            + views_block()
            + [
                blocks.metres("TARGET_CEILING", tr("Targets up to this height above ground"), default("target_ceiling")),
                blocks.metres("TARGET_SPACING", tr("Spacing of the targets"), default("target_spacing")),
                blocks.confidence_parameter(),
                blocks.hide_height_parameter(),
                blocks.advanced(height_spacing),
            ]
            + blocks.run_block()
        ):
            self.add(parameter)
        file = QgsProcessingParameterFileDestination("OUTPUT", tr("Hidden volume"), "OpenVDB (*.vdb)")
        self.add(file, optional=True)
        add_outputs(self)

    def contradiction(self, parameters, context):
        return self.bad_confidence(parameters, context)

    def read_input(self, parameters, context, feedback):
        self.path = self.read_path(parameters, "INPUT", context)
        self.views = read_views(self, parameters, context, feedback)
        self.options = creation_options(self, parameters, context)
        self.arguments = {
            **sight_arguments(self, parameters, context),
            "confidence": self.parameterAsDouble(parameters, "CONFIDENCE", context),
            "target_ceiling": self.parameterAsDouble(parameters, "TARGET_CEILING", context),
            "target_spacing": self.parameterAsDouble(parameters, "TARGET_SPACING", context),
            "target_height_spacing": number_or_none(self, parameters, "TARGET_HEIGHT_SPACING", context),
        }

    def compute(self, sightbound, parameters, context, feedback):
        volume = self.open_volume(sightbound.ErrorVolume, self.path, "INPUT", feedback, 5.0)
        arguments = {**self.arguments, **self.views.arguments(volume)}
        need = sightbound.estimate_volume_viewshed(volume, **arguments)
        feedback.pushInfo(
            tr("{} view places, {} targets, {:.3g} lines of sight, {:.4g} MB of memory; about {:.3g} s.").format(
                need["view_places"], need["targets"], need["lines"], need["bytes"] / 1e6, need["seconds"]
            )
        )
        hidden = sightbound.volume_viewshed(volume, **arguments, progress=Progress(feedback, 5.0, 85.0))
        for warning in hidden.report["warnings"]:
            feedback.pushWarning(warning)
        results = write_outputs(self, hidden, parameters, context, feedback)
        if given(parameters, "OUTPUT"):
            results["OUTPUT"] = self.save_volume(hidden, parameters, context, feedback)
        return results
