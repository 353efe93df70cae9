# SPDX-License-Identifier: GPL-3.0-or-later
"""What the algorithms have in common: identity, help, the check for the core, errors and cancelling."""

from pathlib import Path

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingOutputLayerDefinition,
    QgsProcessingParameterDefinition,
)
from qgis.PyQt.QtGui import QIcon

from .. import core
from ..errors import bad_input, core_errors
from ..feedback import Stopped
from ..text import algorithm_help, parameter_help, tr
from ..values import given

_FOLDER = Path(__file__).parent.parent
_HOME = "https://github.com/sightbound/sightbound"


class SightboundAlgorithm(QgsProcessingAlgorithm):
    """An algorithm gives NAME, TITLE, SUMMARY, TAGS, and two steps:

    read_input(parameters, context, feedback) in the main thread, the only one that touches layers, and
    compute(sightbound, parameters, context, feedback) in a worker thread, which returns the results.
    """

    NAME = TITLE = SUMMARY = ""
    TAGS = ()

    def __init__(self):
        super().__init__()
        self.paths = {}  # of input files -> parameter, for messages
        self._failure = None

    def createInstance(self):
        return type(self)()

    def name(self):
        return self.NAME

    def displayName(self):
        return tr(self.TITLE)

    def group(self):
        return tr("Visibility")

    def groupId(self):
        return "visibility"

    def tags(self):
        return [tr(tag) for tag in self.TAGS]

    def shortDescription(self):
        return tr(self.SUMMARY)

    def shortHelpString(self):
        return algorithm_help(self.NAME)

    def helpUrl(self):
        return f"{_HOME}/blob/main/docs/qgis.md#{self.NAME}"

    def icon(self):
        return QIcon(self.svgIconPath())

    def svgIconPath(self):
        return str(_FOLDER / "icons" / f"{self.NAME}.svg")

    def canExecute(self):
        problem = core.problem()
        return not problem, problem

    def add(self, parameter, optional=False, by_default=True):
        """Adds a parameter with its help; the last two are for outputs."""
        parameter.setHelp(parameter_help(self.NAME, parameter.name()))
        if parameter.isDestination():
            parameter.setCreateByDefault(by_default)
            if optional:
                parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.Flag.FlagOptional)
        self.addParameter(parameter)

    def contradiction(self, parameters, context):
        """What contradicts itself in the parameters, as a sentence; '' if nothing does."""
        return ""

    def checkParameterValues(self, parameters, context):
        fine, message = super().checkParameterValues(parameters, context)
        message = self.contradiction(parameters, context) if fine else message
        return not message, message

    def bad_confidence(self, parameters, context):
        confidence = self.parameterAsDouble(parameters, "CONFIDENCE", context)
        if 0.0 < confidence < 1.0:
            return ""
        return tr("CONFIDENCE: {:g} is not between 0 and 1; 0.95 is usual.").format(confidence)

    def threads(self, parameters, context):
        return self.parameterAsInt(parameters, "THREADS", context) if given(parameters, "THREADS") else None

    def prepareAlgorithm(self, parameters, context, feedback):
        """Reads the input.

        What is wrong with it is raised by processAlgorithm: raised here, QGIS would write it to the log and tell a
        script only that there was an error.
        """
        try:
            self._require_core()
            message = self.contradiction(parameters, context)  # models do not check
            if message:
                raise QgsProcessingException(message)
            self._check_folders(parameters)
            self.read_input(parameters, context, feedback)
        except (QgsProcessingException, Stopped) as error:
            self._failure = error
        return True

    def processAlgorithm(self, parameters, context, feedback):
        try:
            if self._failure is not None:
                raise self._failure
            return self._computed(parameters, context, feedback)
        except Stopped:
            feedback.pushInfo(tr("Cancelled: nothing was written."))
            return {}

    def _computed(self, parameters, context, feedback):
        sightbound = self._require_core()
        try:
            with core_errors(paths=self.paths):
                return self.compute(sightbound, parameters, context, feedback)
        except sightbound.Cancelled as cancelled:
            raise Stopped from cancelled

    def _require_core(self):
        try:
            return core.load()
        except core.CoreUnavailable as error:
            raise QgsProcessingException(str(error)) from error

    def _check_folders(self, parameters):
        """A missing folder is told before the work, not after."""
        for definition in self.destinationParameterDefinitions():
            value = parameters.get(definition.name())
            if isinstance(value, QgsProcessingOutputLayerDefinition):
                value = value.sink.staticValue()
            if (
                not isinstance(value, str)
                or not Path(value).is_absolute()
                or definition.type() == "folderDestination"
            ):
                continue
            folder = Path(value).parent
            if not folder.is_dir():
                raise bad_input(definition.name(), tr("there is no folder {}; make it first.").format(folder))
