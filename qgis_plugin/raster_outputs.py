# SPDX-License-Identifier: GPL-3.0-or-later
"""The rasters of a result that were asked for: written, and styled when QGIS loads them."""

from .errors import core_errors
from .feedback import Progress
from .styling import style_when_loaded
from .values import given

_PROBABILITY = "confidence"  # the style that is shown in classes of claims


def write_rasters(algorithm, result, rows, parameters, context, feedback, first):
    """Paths by output. `rows` begin with output, label, argument of result.write, style, and the share of the values
    that the ramp spans (0: as the style says). Uses algorithm.options, and CONFIDENCE for probabilities; `first` is
    where the progress stands."""
    wanted = [row[:5] for row in rows if given(parameters, row[0])]
    paths = {name: algorithm.parameterAsOutputLayer(parameters, name, context) for name, *_ in wanted}
    with core_errors(rows[0][0], {path: name for name, path in paths.items()}):
        result.write(
            **{argument: paths[name] for name, _, argument, _, _ in wanted},
            creation_options=algorithm.options,
            progress=Progress(feedback, first, 100.0),
        )
    for name, _, _, style, stretch in wanted:
        claims = style == _PROBABILITY
        confidence = algorithm.parameterAsDouble(parameters, "CONFIDENCE", context) if claims else None
        style_when_loaded(context, paths[name], style, stretch, confidence)
    return paths
