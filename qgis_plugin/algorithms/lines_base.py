# SPDX-License-Identifier: GPL-3.0-or-later
"""What the algorithms for lines of sight between points have in common."""

from ..error_block import read_error_block
from ..line_extras import read_extras
from ..rasters import open_dem, read_raster
from ..values import word
from .base import SightboundAlgorithm


class LinesAlgorithm(SightboundAlgorithm):
    def read_terrain(self, parameters, context, feedback):
        """The elevation model, its error, the ground under it, and how lines over it are judged."""
        self.dem = read_raster(self, parameters, "INPUT", context, feedback, "BAND")
        self.vertical_unit = word(self, parameters, "VERTICAL_UNIT", context)
        self.ground = read_raster(self, parameters, "GROUND", context, feedback)
        self.error = read_error_block(self, parameters, context, feedback, self.dem)
        self.extras = read_extras(self, parameters, context)
        self.confidence = self.parameterAsDouble(parameters, "CONFIDENCE", context)
        self.arguments = {
            **self.extras,
            "confidence": self.confidence,
            "refraction": self.parameterAsDouble(parameters, "REFRACTION", context),
            "curvature": self.parameterAsBoolean(parameters, "CURVATURE", context),
            "stand": word(self, parameters, "STAND", context),
            "height_reference": word(self, parameters, "HEIGHT_REFERENCE", context),
            "see_across_nodata": self.parameterAsBoolean(parameters, "SEE_ACROSS_NODATA", context),
        }

    def open_terrain(self, sightbound, feedback):
        """The core's Dem, and the arguments of its functions."""
        dem = open_dem(sightbound, self.dem, self.vertical_unit, feedback)
        arguments = dict(self.arguments, error_model=self.error.model(sightbound))
        if self.ground is not None:
            arguments["ground"] = self.ground.path
        return dem, arguments
