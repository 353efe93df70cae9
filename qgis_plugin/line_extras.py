# SPDX-License-Identifier: GPL-3.0-or-later
"""What may be asked of a line of sight beside p: the probability of the whole line, and a radio link's Fresnel zone."""

from qgis.core import QgsProcessingParameterBoolean

from . import parameters as blocks
from .defaults import default
from .text import tr
from .values import given, number_or_none, word

# Columns of outputs, and when they are there.
_WHOLE = ("probability", "standard_error", "blocked_bound")
_RADIO = ("fresnel_clear", "fresnel_p", "fresnel_distance")
_BOTH = ("fresnel_probability",)


def extras_block():
    """Advanced and optional, every one."""
    asked = QgsProcessingParameterBoolean(
        "PROBABILITY", tr("Probability of the whole line (draws terrains)"), False, True
    )
    stands = ["ground", "model"]
    return [
        blocks.advanced(one)
        for one in (
            asked,
            blocks.number(
                "REALISATIONS", tr("Number of terrains drawn"), default("realisations"), 1, 65535, integer=True
            ),
            blocks.number("SEED", tr("Seed of the draws"), default("seed"), 0, None, integer=True),
            blocks.choice(
                "PROBABILITY_STAND", tr("In each terrain the ends stand on"), stands, default("probability_stand")
            ),
            blocks.number("FREQUENCY", tr("Radio frequency in MHz (empty: no radio)"), None, 1.0, 1e6),
            blocks.number(
                "FRESNEL_SHARE", tr("Share of the first Fresnel zone to be clear"), default("fresnel_share"), 0.0, 1.0
            ),
        )
    ]


def read_extras(algorithm, parameters, context):
    """As sightbound takes them."""

    def number(name):
        found = number_or_none(algorithm, parameters, name, context)
        return default(name.lower()) if found is None else found

    return {
        "probability": given(parameters, "PROBABILITY")
        and algorithm.parameterAsBoolean(parameters, "PROBABILITY", context),
        "realisations": int(number("REALISATIONS")),
        "seed": int(number("SEED")),
        "probability_stand": word(algorithm, parameters, "PROBABILITY_STAND", context),
        "frequency": number_or_none(algorithm, parameters, "FREQUENCY", context),
        "fresnel_share": number("FRESNEL_SHARE"),
    }


def extra_columns(extras):
    """Names of the columns that are asked for."""
    whole, radio = bool(extras["probability"]), extras["frequency"] is not None
    return whole * _WHOLE + radio * _RADIO + (whole and radio) * _BOTH


def extra_values(sight):
    """Of one line of sight, by column."""
    whole, zone = sight.whole_line, sight.fresnel
    values = {}
    if whole is not None:
        values.update((name, getattr(whole, name)) for name in _WHOLE + _BOTH)
    if zone is not None:
        values.update(fresnel_clear=zone.clear, fresnel_p=zone.p, fresnel_distance=zone.worst_distance)
    return values
