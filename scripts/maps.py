# SPDX-License-Identifier: GPL-3.0-or-later
"""Map pages drawn with PyQGIS without a display: what the demo and the README's figure share."""

import os
from dataclasses import dataclass
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from osgeo import gdal
from qgis.core import (
    QgsApplication,
    QgsColorRampLegendNode,
    QgsCoordinateReferenceSystem,
    QgsHillshadeRenderer,
    QgsLayerTree,
    QgsLayout,
    QgsLayoutExporter,
    QgsLayoutItemLabel,
    QgsLayoutItemLegend,
    QgsLayoutItemMap,
    QgsLayoutItemScaleBar,
    QgsLayoutPoint,
    QgsLayoutSize,
    QgsLegendStyle,
    QgsMarkerSymbol,
    QgsMapLayerLegendUtils,
    QgsPalLayerSettings,
    QgsProject,
    QgsRasterLayer,
    QgsRectangle,
    QgsSingleSymbolRenderer,
    QgsTextBufferSettings,
    QgsTextFormat,
    QgsUnitTypes,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
    QgsWkbTypes,
)
from qgis.PyQt.QtCore import QSize, QSizeF, Qt
from qgis.PyQt.QtGui import QColor, QFont

MM = QgsUnitTypes.LayoutUnit.LayoutMillimeters
DPI = 150
RAMP = QSizeF(7.0, 30.0)  # mm, a colour ramp in the legend

gdal.UseExceptions()


@dataclass
class Panel:
    """One map: layers from top to bottom, a headline above it, a sentence below it."""

    layers: list
    headline: str
    caption: str = ""


def start(window=False):
    """A QgsApplication, without a display unless `window`; keep it alive and call stop() at the end."""
    application = QgsApplication([], window)
    application.initQgis()
    return application


def stop(application):
    QgsProject.instance().clear()
    application.exitQgis()


def raster(path, name, style=None):
    layer = QgsRasterLayer(str(path), name)
    if not layer.isValid():
        raise OSError(f"{path} cannot be read as a raster")
    if style:
        _styled(layer, style)
    QgsProject.instance().addMapLayer(layer)
    return layer


def _styled(layer, style):
    name = layer.name()
    message, ok = layer.loadNamedStyle(str(style))
    if not ok:
        raise OSError(f"{style} cannot be used as a style: {message}")
    layer.setName(name)


def hillshade(dem_path, folder, name="Hillshade"):
    """Relief of a DEM, first interpolated onto a finer grid in metres (written into `folder`)."""
    dem = raster(dem_path, "DEM")
    fine = Path(folder) / "relief.tif"
    step = 0.4 * _cell_metres(dem)
    gdal.Warp(str(fine), str(dem_path), dstSRS=utm_of(dem).authid(), xRes=step, yRes=step,
              resampleAlg="cubicspline", outputType=gdal.GDT_Float32, dstNodata=-9999)
    layer = raster(fine, name)
    renderer = QgsHillshadeRenderer(layer.dataProvider(), 1, 315.0, 45.0)
    renderer.setZFactor(1.5)
    layer.setRenderer(renderer)
    layer.brightnessFilter().setBrightness(20)
    layer.setOpacity(0.7)  # pale, so that colours over it keep their meaning
    return layer


def _cell_metres(layer):
    metres_a_unit = 111000.0 if layer.crs().isGeographic() else 1.0
    return layer.rasterUnitsPerPixelY() * metres_a_unit


def vector(path, name, style=None):
    layer = QgsVectorLayer(str(path), name, "ogr")
    if not layer.isValid():
        raise OSError(f"{path} cannot be read as a vector layer")
    if style:
        _styled(layer, style)
    QgsProject.instance().addMapLayer(layer)
    return layer


def points(path, name, label_field=None):
    layer = vector(path, name)
    symbol = QgsMarkerSymbol.createSimple(
        {"name": "triangle", "color": "#ffffff", "outline_color": "#000000", "outline_width": "0.5", "size": "4"}
    )
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))
    if label_field:
        label(layer, label_field)
    return layer


def label(layer, expression):
    settings = QgsPalLayerSettings()
    settings.fieldName, settings.isExpression = expression, True
    if layer.geometryType() == QgsWkbTypes.GeometryType.LineGeometry:
        settings.placement = QgsPalLayerSettings.Placement.Line
    settings.dist = 2.5
    settings.setFormat(text_format(9, bold=True, halo=True))
    layer.setLabeling(QgsVectorLayerSimpleLabeling(settings))
    layer.setLabelsEnabled(True)


def text_format(points_high, bold=False, halo=False):
    form = QgsTextFormat()
    form.setFont(QFont("DejaVu Sans", -1, QFont.Weight.Bold if bold else QFont.Weight.Normal))
    form.setSize(points_high)
    form.setSizeUnit(QgsUnitTypes.RenderUnit.RenderPoints)
    if halo:
        around = QgsTextBufferSettings()
        around.setEnabled(True)
        around.setSize(0.8)
        around.setColor(QColor("white"))
        form.setBuffer(around)
    return form


def utm_of(layer):
    """The UTM zone of a layer's centre, so that a map in degrees is not squashed."""
    if not layer.crs().isGeographic():
        return layer.crs()
    centre = layer.extent().center()
    zone = int((centre.x() + 180.0) // 6.0) + 1
    return QgsCoordinateReferenceSystem.fromEpsgId((32600 if centre.y() >= 0.0 else 32700) + zone)


def write_page(path, title, panels, legend_layers, width_mm=300.0, legend_mm=58.0, footer="", window=(0.025, 0.025, 0.975, 0.975), bar_km=5.0):
    """Panels side by side, the legend at the right, a scale bar below; PNG at `path`. The maps show `window` of the lowest
    layer (left, bottom, right, top as shares of its extent; the slanted edges of a reprojected raster stay outside)."""
    project = QgsProject.instance()
    ground = panels[0].layers[-1]
    crs = ground.crs()
    project.setCrs(crs)
    whole = ground.extent()
    left, bottom, right, top = window
    extent = QgsRectangle(
        whole.xMinimum() + left * whole.width(), whole.yMinimum() + bottom * whole.height(),
        whole.xMinimum() + right * whole.width(), whole.yMinimum() + top * whole.height())

    margin, above, gap = 6.0, 24.0 if title else 14.0, 5.0
    each = (width_mm - 2 * margin - legend_mm - gap * len(panels)) / len(panels)
    high = each * extent.height() / extent.width()
    below = 24.0

    layout = QgsLayout(project)
    layout.initializeDefaults()
    layout.pageCollection().page(0).setPageSize(QgsLayoutSize(width_mm, above + high + below, MM))
    if title:
        _label(layout, title, margin, 4.0, width_mm - 2 * margin, 10.0, 17, bold=True)

    for i, panel in enumerate(panels):
        x = margin + i * (each + gap)
        _label(layout, panel.headline, x, above - 8.0, each, 7.0, 12, bold=True)
        view = QgsLayoutItemMap(layout)
        layout.addLayoutItem(view)
        view.attemptMove(QgsLayoutPoint(x, above, MM))
        view.attemptResize(QgsLayoutSize(each, high, MM))
        view.setCrs(crs)
        view.setExtent(extent)
        view.setLayers(panel.layers)
        view.setFrameEnabled(True)
        if panel.caption:
            _label(layout, panel.caption, x, above + high + 1.5, each, 12.0, 9)
        if i == 0:
            _scale_bar(layout, view, margin, above + high + 12.0, bar_km)
    if footer:
        _label(layout, footer, margin + 0.45 * width_mm, above + high + 15.0, 0.55 * width_mm - 2 * margin, 8.0, 7.5)
    _legend(layout, legend_layers, width_mm - margin - legend_mm, above - 2.0)

    image = QgsLayoutExporter(layout).renderPageToImage(0, QSize(), DPI)
    if not image.save(str(path)):
        raise OSError(f"{path} cannot be written")


def _label(layout, text, x, y, width, height, size, bold=False):
    item = QgsLayoutItemLabel(layout)
    layout.addLayoutItem(item)
    item.setText(text)
    item.setHAlign(Qt.AlignmentFlag.AlignLeft)
    if hasattr(item, "setTextFormat"):  # since 3.24
        item.setTextFormat(text_format(size, bold))
    else:
        font = QFont("DejaVu Sans", -1, QFont.Weight.Bold if bold else QFont.Weight.Normal)
        font.setPointSizeF(size)
        item.setFont(font)
    item.attemptMove(QgsLayoutPoint(x, y, MM))
    item.attemptResize(QgsLayoutSize(width, height, MM))


def _scale_bar(layout, view, x, y, segment_km):
    bar = QgsLayoutItemScaleBar(layout)
    layout.addLayoutItem(bar)
    bar.setLinkedMap(view)
    bar.setStyle("Single Box")
    bar.setUnits(QgsUnitTypes.DistanceUnit.DistanceKilometers)
    bar.setUnitLabel("km")
    bar.setUnitsPerSegment(segment_km)
    bar.setNumberOfSegments(2)
    bar.setNumberOfSegmentsLeft(0)
    bar.setHeight(2.0)
    bar.setTextFormat(text_format(8))
    bar.update()
    bar.attemptMove(QgsLayoutPoint(x, y, MM))


def _legend(layout, layers, x, y):
    legend = QgsLayoutItemLegend(layout)
    layout.addLayoutItem(legend)
    legend.setAutoUpdateModel(False)
    tree = QgsLayerTree()
    for layer in layers:
        tree.addLayer(layer)
    legend.model().setRootGroup(tree)
    for node in tree.findLayers():
        entries = legend.model().layerOriginalLegendNodes(node)
        if isinstance(node.layer(), QgsRasterLayer) and len(entries) > 1:  # the first only names the band
            QgsMapLayerLegendUtils.setLegendNodeOrder(node, list(range(1, len(entries))))
            if isinstance(entries[1], QgsColorRampLegendNode):
                QgsMapLayerLegendUtils.setLegendNodeSymbolSize(node, 1, RAMP)
            legend.model().refreshLayerLegend(node)
    for style, size in (
        (QgsLegendStyle.Style.Subgroup, 10),
        (QgsLegendStyle.Style.SymbolLabel, 9),
    ):
        if hasattr(legend.style(style), "setTextFormat"):  # since 3.30
            legend.rstyle(style).setTextFormat(text_format(size, bold=style == QgsLegendStyle.Style.Subgroup))
        else:
            font = QFont("DejaVu Sans", size, QFont.Weight.Bold if style == QgsLegendStyle.Style.Subgroup else -1)
            legend.setStyleFont(style, font)
    legend.setFrameEnabled(False)
    legend.attemptMove(QgsLayoutPoint(x, y, MM))
    legend.adjustBoxSize()
    layout._legend_tree = tree  # the model does not own it
