# SPDX-License-Identifier: GPL-3.0-or-later
"""What the log says of a result, in words."""

import json

from .text import tr


def log_report(feedback, report, words=""):
    """The error model and the warnings, which every result has."""
    log_error_model(feedback, report["error_model"], words)
    for warning in report["warnings"]:
        feedback.pushWarning(warning)


def log_error_model(feedback, text, words=""):
    """Which error model was used: in words, the model's own if none are given, and as JSON on one line."""
    model = json.loads(text)
    feedback.pushInfo(words or f"{_of_samples(model)} {_between_samples(model['geologic_variation'])}")
    feedback.pushInfo(tr("Error model used: {}").format(json.dumps(model)))


def log_areas(feedback, report, confidence):
    """What of a viewshed is visible, uncertain and hidden."""
    areas = [report[f"{verdict}_m2"] for verdict in ("visible", "uncertain", "hidden")]
    whole = sum(areas)
    if whole:
        told = tr("Of {} judged, {} are visible, {} uncertain and {} hidden at a confidence of {:g}.")
        parts = [f"{area(one)} ({one / whole:.1%})" for one in areas]
        feedback.pushInfo(told.format(area(whole), *parts, confidence))


def area(square_metres):
    """Four digits, in the unit that reads best, and never as a power of ten."""
    value, unit = (square_metres / 1e6, "km²") if square_metres >= 1e5 else (square_metres, "m²")
    return f"{float(f'{value:.4g}'):,.12g} {unit}"


def counted(verdicts, confidence):
    """How many lines of sight have which verdict, as a sentence; `verdicts` are words."""
    verdicts = list(verdicts)
    told = tr("{} lines: {} visible, {} uncertain, {} hidden at a confidence of {:g}.")
    return told.format(len(verdicts), *map(verdicts.count, ("visible", "uncertain", "hidden")), confidence)


def _of_samples(model):
    vertical, horizontal = model["vertical_rmse"], model["horizontal_rmse"]
    if isinstance(vertical, float) and isinstance(horizontal, float):
        told = tr("Error of the samples: {:.3g} m upwards, {:.3g} m sideways (RMSE).")
        return told.format(vertical, horizontal)
    return tr("Error of the samples: it differs from place to place.")


def _between_samples(variation):
    if isinstance(variation, float):
        return tr("Between samples the ground rises by at most {:.3g} m (at 95 %).").format(variation)
    typical = variation.get("from_dem", {}).get("typical_m")
    if typical is not None:
        told = tr("Half-way between samples the ground departs by {:.3g} m (one sigma), learnt from the elevation model.")
        return told.format(typical)
    return tr("What the ground does between samples differs from place to place.")
