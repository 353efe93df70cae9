# SPDX-License-Identifier: GPL-3.0-or-later
"""The Processing provider: its algorithms, and the models that lie in models/."""

from pathlib import Path

from qgis.core import QgsProcessingModelAlgorithm, QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from . import core
from .algorithms.build_error_volume import BuildErrorVolume
from .algorithms.confidence_viewshed import ConfidenceViewshed
from .algorithms.dem_to_tin import DemToTin
from .algorithms.error_surfaces import ErrorSurfaces
from .algorithms.estimate_error import EstimateError
from .algorithms.intervisibility import IntervisibilityNetwork
from .algorithms.line_of_sight_profile import LineOfSightProfile
from .algorithms.probable_viewshed import ProbableViewshed
from .algorithms.simplify_tin import SimplifyTin
from .algorithms.subtract_observer import SubtractObserver
from .algorithms.verify_tin import VerifyTin
from .algorithms.volume_targets import VolumeTargets
from .algorithms.volume_to_raster import VolumeToRaster
from .algorithms.volume_viewshed import VolumeViewshed

_FOLDER = Path(__file__).parent
_ALGORITHMS = (
    ConfidenceViewshed,
    ProbableViewshed,
    ErrorSurfaces,
    EstimateError,
    LineOfSightProfile,
    IntervisibilityNetwork,
    BuildErrorVolume,
    VolumeViewshed,
    VolumeTargets,
    SubtractObserver,
    VolumeToRaster,
    DemToTin,
    SimplifyTin,
    VerifyTin,
)


class SightboundProvider(QgsProcessingProvider):
    def id(self):
        return "sightbound"

    def name(self):
        return "Sightbound"

    def longName(self):
        return self.name()

    def versionInfo(self):
        return core.plugin_version()

    def warningMessage(self):
        return core.problem()

    def icon(self):
        return QIcon(self.svgIconPath())

    def svgIconPath(self):
        return str(_FOLDER / "icons" / "sightbound.svg")

    def loadAlgorithms(self):
        for algorithm in _ALGORITHMS:
            self.addAlgorithm(algorithm())
        for path in sorted((_FOLDER / "models").glob("*.model3")):
            model = QgsProcessingModelAlgorithm()
            if model.fromFile(str(path)):
                self.addAlgorithm(model)

    def supportedOutputRasterLayerExtensions(self):
        """The core writes GeoTIFF."""
        return ["tif", "tiff"]

    def defaultRasterFileExtension(self):
        return "tif"

    def supportsNonFileBasedOutput(self):
        return True
