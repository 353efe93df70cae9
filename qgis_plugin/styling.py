# SPDX-License-Identifier: GPL-3.0-or-later
"""Styles outputs when QGIS loads them, with the QML files that lie in styles/."""

import math
from pathlib import Path

from qgis.core import (
    QgsBasicNumericFormat,
    QgsColorRampLegendNodeSettings,
    QgsColorRampShader,
    QgsGradientColorRamp,
    QgsMeshDatasetIndex,
    QgsMeshLayer,
    QgsMeshRendererScalarSettings,
    QgsProcessingLayerPostProcessorInterface,
    QgsRasterLayer,
    QgsSingleBandPseudoColorRenderer,
    QgsVectorLayer,
)
from qgis.PyQt.QtGui import QColor

from .field_titles import entitle
from .text import tr

_STYLES = Path(__file__).parent / "styles"
_PROBABILITIES = (0.1, 0.3, 0.5, 0.7, 0.9)  # borders of classes between the claims


def style_path(style):
    return str(_STYLES / f"{style}.qml")


class StyleOnLoad(QgsProcessingLayerPostProcessorInterface):
    """Gives a loaded layer a style, and titles to its columns. `stretch` fits the colour ramp to that share of the
    layer's values, 0 leaves it; `confidence` shows a probability in classes, see class_claims; `flat` takes the 3D part
    of the style away. Without a style ('') only the columns are entitled.

    One instance for each layer: the context deletes it. It does not keep the Python half alive, so this class does.
    """

    _alive = []

    def __init__(self, style, stretch=0.0, flat=False, confidence=None):
        super().__init__()
        self.style = style
        self.stretch = stretch
        self.flat = flat
        self.confidence = confidence
        self._alive.append(self)

    def postProcessLayer(self, layer, context, feedback):
        if self.style:
            message, loaded = layer.loadNamedStyle(style_path(self.style))
            if not loaded:
                feedback.pushWarning(message)
        if isinstance(layer, QgsVectorLayer):
            entitle(layer)
        if self.confidence is not None:
            class_claims(layer, self.confidence)
        if self.stretch and isinstance(layer, QgsRasterLayer):
            stretch_ramp(layer, self.stretch)
        if self.stretch and isinstance(layer, QgsMeshLayer):
            stretch_mesh(layer)
        if self.flat:
            layer.setRenderer3D(None)
        layer.triggerRepaint()


def stretch_ramp(layer, share):
    """Moves the stops of the layer's colour ramp, in proportion, to span the values that the layer holds.

    `share` of the values are spanned; the few that lie far above have the last colour.
    """
    renderer = layer.renderer()
    if not isinstance(renderer, QgsSingleBandPseudoColorRenderer):
        return
    least, largest = layer.dataProvider().cumulativeCut(1, 0.0, share, layer.extent(), 250000)
    shader = renderer.shader().rasterShaderFunction()
    low, high = shader.minimumValue(), shader.maximumValue()
    if not largest > least or not high > low:
        return
    _stretch(shader, least, largest)
    _round_labels(shader, largest - least)
    renderer.setClassificationMin(least)
    renderer.setClassificationMax(largest)
    layer.rendererChanged.emit()  # the legend was made before


def class_claims(layer, confidence):
    """Shows a probability in classes of the layer's colour ramp. The outermost are what may be claimed at that
    confidence: hidden up to (1 - c) / 2, visible from (1 + c) / 2 on."""
    shader = layer.renderer().shader().rasterShaderFunction()
    low, high = 0.5 * (1.0 - confidence), 0.5 * (1.0 + confidence)
    borders = [low, *(border for border in _PROBABILITIES if low < border < high), high]

    def colour(value):
        _, *rgba = shader.shade(value)
        return QColor(*rgba)

    hidden = tr("{:.4g} % and less: almost surely hidden").format(100.0 * low)
    nothing = QColor(255, 255, 255, 0)  # white, for legends on paper leave transparency out
    items = [QgsColorRampShader.ColorRampItem(low, nothing, hidden)]
    for lower, upper in zip(borders, borders[1:]):
        label = f"{100.0 * lower:.4g} – {100.0 * upper:.4g} %"
        below = math.nextafter(upper, 0.0) if upper == high else upper  # a class holds its upper border
        items.append(QgsColorRampShader.ColorRampItem(below, colour(0.5 * (lower + upper)), label))
    visible = tr("{:.4g} % and more: almost surely visible").format(100.0 * high)
    items.append(QgsColorRampShader.ColorRampItem(math.inf, colour(1.0), visible))
    shader.setColorRampType(QgsColorRampShader.Type.Discrete)
    shader.setColorRampItemList(items)
    layer.rendererChanged.emit()


def stretch_mesh(layer):
    """The same for the dataset group that a mesh layer shows; all values are spanned. Its other groups, which a style cannot know,
    get a ramp from 0 to their largest value, so that each can be shown."""
    settings = layer.rendererSettings()
    for group in layer.datasetGroupsIndexes():
        if group != settings.activeScalarDatasetGroup():
            settings.setScalarSettings(group, _from_zero(layer.datasetGroupMetadata(QgsMeshDatasetIndex(group))))
    layer.setRendererSettings(settings)
    group = settings.activeScalarDatasetGroup()
    if group < 0:
        return
    values = layer.datasetGroupMetadata(QgsMeshDatasetIndex(group))
    if not values.maximum() > values.minimum():
        return
    scalar = settings.scalarSettings(group)
    shader = scalar.colorRampShader()
    _stretch(shader, values.minimum(), values.maximum())
    scalar.setColorRampShader(shader)
    scalar.setClassificationMinimumMaximum(values.minimum(), values.maximum())
    settings.setScalarSettings(group, scalar)
    layer.setRendererSettings(settings)


def _from_zero(values):
    largest = values.maximum() if values.maximum() > 0.0 else 1.0
    ramp = QgsGradientColorRamp(QColor(247, 244, 236), QColor(122, 28, 46))
    shader = QgsColorRampShader(0.0, largest, ramp)
    shader.classifyColorRamp(5)
    scalar = QgsMeshRendererScalarSettings()
    scalar.setColorRampShader(shader)
    scalar.setClassificationMinimumMaximum(0.0, largest)
    return scalar


def _stretch(shader, least, largest):
    low, high = shader.minimumValue(), shader.maximumValue()
    items = shader.colorRampItemList()
    for item in items:
        item.value = least + (item.value - low) / (high - low) * (largest - least)
        item.label = f"{item.value:.4g}"
    shader.setColorRampItemList(items)
    shader.setMinimumValue(least)
    shader.setMaximumValue(largest)


def _round_labels(shader, span):
    """Has the legend write three digits of what the ramp spans, not six decimals."""
    decimals = QgsBasicNumericFormat()
    decimals.setNumberDecimalPlaces(max(0, 2 - math.floor(math.log10(span))))
    settings = QgsColorRampLegendNodeSettings(shader.legendSettings() or QgsColorRampLegendNodeSettings())
    settings.setNumericFormat(decimals)
    shader.setLegendSettings(settings)


def style_when_loaded(context, output, style, stretch=0.0, confidence=None):
    """Asks QGIS to style `output` (a path or a sink's id) if it will be loaded; see StyleOnLoad."""
    if context.willLoadLayerOnCompletion(output):
        details = context.layerToLoadOnCompletionDetails(output)
        details.setPostProcessor(StyleOnLoad(style, stretch, confidence=confidence))
