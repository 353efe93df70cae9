# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the core become QgsProcessingExceptions that name the parameter as the user knows it."""

import re
from contextlib import contextmanager

from qgis.core import QgsProcessingException

from .text import tr

# The core's arguments in its messages -> the parameters of the algorithms.
_PARAMETER_OF = {
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
    "vertical_angle": "ANGLE_FROM/ANGLE_TO",
    "vertical_unit": "VERTICAL_UNIT",
    "height_reference": "HEIGHT_REFERENCE",
    "creation_options": "CREATION_OPTIONS",
    "see_across_nodata": "SEE_ACROSS_NODATA",
    "error_model": "ERROR_MODEL",
    "target_ceiling": "TARGET_CEILING",
    "target_spacing": "TARGET_SPACING",
    "target_height_spacing": "TARGET_HEIGHT_SPACING",
    "view_height": "OBSERVER_HEIGHT",
    "view_height_to": "OBSERVER_HEIGHT_TO",
    "view_spacing": "VIEW_SPACING",
    "seen_from": "SEEN_FROM",
    "holds_for": "HOLDS_FOR",
    "most_lines": "MOST_LINES",
    "of_vertices": "TOLERANCE_RASTER",
    "target_height_reference": "TARGET_HEIGHT_REFERENCE",
    "voxel_m": "VOXEL",
    "break_lines": "BREAK_LINES",
    "break_line_tolerance": "BREAK_LINE_TOLERANCE",
    "border_tolerance": "BORDER_TOLERANCE",
    "target_faces": "TARGET_TRIANGLES",
    "target_bytes": "TARGET_SIZE",
    "voxel_height": "VOXEL_HEIGHT",
    "voxel_height_m": "VOXEL_HEIGHT",
    "largest_confidence": "LARGEST_CONFIDENCE",
}
# Arguments that are ordinary words too: they count only where a sentence starts with them.
_WORD_OF = {
    "azimuth": "AZIMUTH_FROM/AZIMUTH_TO",
    "confidence": "CONFIDENCE",
    "extent": "EXTENT",
    "refraction": "REFRACTION",
    "threads": "THREADS",
    "ground": "GROUND",
    "combine": "COMBINE",
    "stand": "STAND",
    "band": "BAND",
    "tolerance": "TOLERANCE",
    "resolution": "RESOLUTION",
    "height": "HIDE_HEIGHT",
    "views": "OBSERVERS",
    "voxel": "VOXEL",
}
# Labels of features hold the name of their layer's parameter.
_LAYERS = ("OBSERVERS", "OBSERVER", "TARGETS")
_NAMES = re.compile(r"\b(" + "|".join(_PARAMETER_OF) + r")\b")
_WORDS = re.compile(r"^(" + "|".join(_WORD_OF) + r")(?= is | \(| of | must )")
_PARAMETERS = re.compile(r"\b(" + "|".join([*_PARAMETER_OF.values(), *_WORD_OF.values(), *_LAYERS]) + r")\b")


def bad_input(parameter, sentence):
    """The exception for a bad value: what is wrong with it, and the remedy."""
    return QgsProcessingException(f"{parameter}: {sentence}")


def in_our_words(message):
    """A message of the core with the names of the parameters in it."""
    message = _NAMES.sub(lambda found: _PARAMETER_OF[found.group(1)], message)
    return _WORDS.sub(lambda found: _WORD_OF[found.group(1)], message)


@contextmanager
def core_errors(parameter=None, paths=None, rename=None):
    """Turns what the core raises into QgsProcessingExceptions.

    The parameter to blame is that of the file which the message names (`paths`: path -> parameter), else the one of
    the core's arguments that it names, else `parameter`. `rename` changes the message first.
    """
    try:
        yield
    except (ValueError, OSError) as error:
        message = rename(str(error)) if rename else str(error)
        raise _blamed(message, parameter, paths or {}) from error
    except MemoryError as error:
        what = in_our_words(str(error)) or tr("Not enough memory.")
        advice = tr("Reduce MAX_DISTANCE or EXTENT, or close other programs.")
        raise QgsProcessingException(f"{what} {advice}") from error
    except ImportError as error:  # a part of the core that is loaded when first needed
        raise QgsProcessingException(str(error)) from error
    except RuntimeError as error:
        advice = tr("This is a fault of Sightbound: please report it with the log of this run.")
        raise QgsProcessingException(f"{error} {advice}") from error


def _blamed(message, parameter, paths):
    for path, its_parameter in paths.items():
        if path in message:
            return bad_input(its_parameter, message)
    message = in_our_words(message)
    named = _PARAMETERS.search(message)
    if named and named.start() == 0:
        return QgsProcessingException(message)
    if not named and message.startswith("The DEM"):
        parameter = "INPUT"
    parameter = named.group(0) if named else parameter
    return bad_input(parameter, message) if parameter else QgsProcessingException(message)
