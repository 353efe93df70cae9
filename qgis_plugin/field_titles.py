# SPDX-License-Identifier: GPL-3.0-or-later
"""What the columns of loaded layers are called, with their units, and how many decimals they show."""

from qgis.core import QgsEditorWidgetSetup

from .text import tr

# column: title, decimals (None: as it is)
_TITLES = {
    "p": ("p: clear at the critical place", 3),
    "k": ("k: clearance there, in sigma", 2),
    "distance": ("Distance (m)", 1),
    "azimuth": ("Azimuth (°)", 1),
    "critical_distance": ("Critical place at (m)", 1),
    "critical_share": ("Critical place at (share of the line)", 3),
    "critical_x": ("Critical place, x", None),
    "critical_y": ("Critical place, y", None),
    "critical_clearance": ("Line above ground there (m)", 2),
    "required_height": ("Surely visible from (m above ground)", 1),
    "ground": ("Ground (m)", 1),
    "sigma": ("Sigma (m)", 2),
    "line_height": ("Line of sight (m)", 1),
    "probability": ("P: whole line clear", 3),
    "standard_error": ("Standard error of P", 4),
    "blocked_bound": ("P: blocked, at most", 3),
    "fresnel_clear": ("Least clearance (Fresnel zones)", 2),
    "fresnel_p": ("p: share of the zone clear there", 3),
    "fresnel_distance": ("Least clearance at (m)", 1),
    "fresnel_probability": ("P: share of the zone clear all along", 3),
}


def entitle(layer):
    """Titles and decimals of the columns that a vector layer has; names and values stay as they are."""
    for index, field in enumerate(layer.fields()):
        title, decimals = _TITLES.get(field.name(), ("", None))
        if title:
            layer.setFieldAlias(index, tr(title))
        if decimals is not None:
            layer.setEditorWidgetSetup(index, QgsEditorWidgetSetup("Range", {"Precision": decimals}))
