# SPDX-License-Identifier: GPL-3.0-or-later
"""What users read: translation, and the help texts that lie in help/."""

import json
from decimal import ROUND_CEILING, Context, Decimal
from functools import lru_cache
from math import isfinite
from pathlib import Path

from qgis.PyQt.QtCore import QCoreApplication

_HELP = Path(__file__).parent / "help"


def tr(sentence):
    return QCoreApplication.translate("Sightbound", sentence)


def upward(value):
    """A bound with six digits, none of which is below it."""
    return f"{Decimal(value).normalize(Context(prec=6, rounding=ROUND_CEILING)):f}" if isfinite(value) else str(value)


@lru_cache(maxsize=None)
def _parameter_texts():
    return json.loads((_HELP / "parameters.json").read_text(encoding="utf-8"))


def parameter_help(algorithm, parameter):
    """The help of a parameter; `algorithm.PARAMETER` goes before the shared text of `PARAMETER`."""
    texts = _parameter_texts()
    return tr(texts.get(f"{algorithm}.{parameter}", texts.get(parameter, "")))


@lru_cache(maxsize=None)
def algorithm_help(algorithm):
    """One line: QGIS turns every line break into one on the screen."""
    return tr(" ".join((_HELP / f"{algorithm}.html").read_text(encoding="utf-8").split()))
