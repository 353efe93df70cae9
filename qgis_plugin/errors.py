# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the core become QgsProcessingExceptions that name the parameter as the user knows it."""

import re
from contextlib import contextmanager

from qgis.core import QgsProcessingException

from .text import tr

# The core's argument -> the parameter of the algorithms. A longer name goes before one that it contains.
PARAMETER_OF = {
    "vertical_rmse": "VERTICAL_ACCURACY",
    "horizontal_rmse": "HORIZONTAL_ACCURACY",
    "geologic_variation": "GEOLOGIC_VARIATION",
    "geologic_range": "GEOLOGIC_RANGE",
    "geologic_model": "GEOLOGIC_MODEL",
    "terrain_types": "TERRAIN_TYPES",
    "terrain_field": "TERRAIN_FIELD",
    "terrain_table": "TERRAIN_TABLE",
    "observer_height": "OBSERVER_HEIGHT",
    "target_height": "TARGET_HEIGHT",
    "min_distance": "MIN_DISTANCE",
    "max_distance": "MAX_DISTANCE",
    "azimuth": "AZIMUTH_FROM",
    "vertical_angle": "ANGLE_FROM",
    "refraction": "REFRACTION",
    "confidence": "CONFIDENCE",
    "vertical_unit": "VERTICAL_UNIT",
    "height_reference": "HEIGHT_REFERENCE",
    "extent": "EXTENT",
    "threads": "THREADS",
    "ground": "GROUND",
    "combine": "COMBINE",
    "stand": "STAND",
    "creation_options": "CREATION_OPTIONS",
}
_NAMES = re.compile(r"\b(" + "|".join(PARAMETER_OF) + r")\b")


def bad_input(parameter, sentence):
    """The exception for a bad value: what is wrong with it, and the remedy."""
    return QgsProcessingException(f"{parameter}: {sentence}")


def parameter_named_in(message):
    """The parameter that a message of the core is about, or None."""
    found = _NAMES.search(message)
    return PARAMETER_OF[found.group(1)] if found else None


@contextmanager
def core_errors(parameter=None, about=""):
    """Turns what the core raises into QgsProcessingExceptions.

    `parameter` is blamed when the message names none of the core's arguments; `about` tells which feature was at
    work.
    """
    try:
        yield
    except ValueError as error:
        raise _named(str(error), parameter, about) from error
    except OSError as error:
        raise _named(str(error), parameter, about) from error
    except MemoryError as error:
        advice = tr("Reduce MAX_DISTANCE or EXTENT, or close other programs.")
        raise QgsProcessingException(f"{error or tr('Not enough memory.')} {advice}") from error
    except RuntimeError as error:
        if type(error).__name__ == "Cancelled":
            raise
        advice = tr("This is a fault of Sightbound: please report it with the log of this run.")
        raise QgsProcessingException(f"{error} {advice}") from error


def _named(message, parameter, about):
    parameter = parameter_named_in(message) or parameter
    parts = [part for part in (parameter, about, message) if part]
    return QgsProcessingException(": ".join(parts))
