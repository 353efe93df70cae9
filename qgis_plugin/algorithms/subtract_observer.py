# SPDX-License-Identifier: GPL-3.0-or-later
"""Subtract observer: what a further observer leaves hidden, and what he gains."""

from qgis.core import QgsProcessingOutputNumber, QgsProcessingParameterFileDestination

from .. import parameters as blocks
from ..feedback import Progress
from ..hidden_outputs import add_outputs, write_outputs
from ..rasters import creation_options
from ..text import tr
from ..values import given
from ..views import read_views, sight_arguments, views_block
from .volume_base import VolumeAlgorithm

GAINS = (
    ("GAIN_AREA", "Ground that no longer hides a thing of the height asked (m²)", "gained_m2"),
    ("GAIN_AREA_CORE", "Ground that no longer surely hides it (m²)", "gained_core_m2"),
    ("GAIN_VOLUME", "Volume that became surely visible (m³)", "gained_m3"),
    ("GAIN_VOLUME_CORE", "Volume that is no longer surely hidden (m³)", "gained_core_m3"),
)


class SubtractObserver(VolumeAlgorithm):
    NAME = "subtractobserver"
    TITLE = "Subtract observer"
    SUMMARY = "What does one more observer take away from what is hidden?"
    TAGS = ("viewshed", "visibility", "hidden", "volume", "vdb", "3d", "fog", "coverage", "observer", "difference")

    def initAlgorithm(self, configuration=None):
        for parameter in (
            [blocks.vdb("HIDDEN", tr("Hidden volume (.vdb)")), blocks.vdb("INPUT", tr("Error volume (.vdb)"))]
            + views_block()
            + [blocks.hide_height_parameter()]
            + blocks.run_block()
        ):
            self.add(parameter)
        file = QgsProcessingParameterFileDestination("OUTPUT", tr("Rest of the hidden volume"), "OpenVDB (*.vdb)")
        self.add(file, optional=True)
        add_outputs(self)
        for name, label, _ in GAINS:
            self.addOutput(QgsProcessingOutputNumber(name, tr(label)))

    def read_input(self, parameters, context, feedback):
        self.hidden_path = self.read_path(parameters, "HIDDEN", context)
        self.path = self.read_path(parameters, "INPUT", context)
        self.views = read_views(self, parameters, context, feedback)
        self.options = creation_options(self, parameters, context)
        self.arguments = sight_arguments(self, parameters, context)

    def compute(self, sightbound, parameters, context, feedback):
        hidden = self.open_volume(sightbound.HiddenVolume, self.hidden_path, "HIDDEN", feedback, 3.0)
        volume = self.open_volume(sightbound.ErrorVolume, self.path, "INPUT", feedback, 6.0)
        rest, gain = sightbound.subtract_observer(
            hidden,
            volume,
            **self.arguments,
            **self.views.arguments(volume),
            height=self.parameterAsDouble(parameters, "HIDE_HEIGHT", context),
            progress=Progress(feedback, 6.0, 85.0),
        )
        for warning in rest.report["warnings"]:
            feedback.pushWarning(warning)
        results = write_outputs(self, rest, parameters, context, feedback)
        for name, label, key in GAINS:
            results[name] = gain[key]
            feedback.pushInfo(f"{tr(label)}: {gain[key]:.6g}")
        if given(parameters, "OUTPUT"):
            results["OUTPUT"] = self.save_volume(rest, parameters, context, feedback)
        return results
