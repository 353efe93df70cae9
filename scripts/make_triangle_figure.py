# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw docs/images/one_triangle.png: the error volume of one triangle, as in Figure 8 of the paper.

    scripts/build.sh && PYTHONPATH=build/python /usr/bin/python3 scripts/make_triangle_figure.py

Above, its thickness seen from above; below, its voxels along the line from a corner through the middle, at the same scale.
"""

import os
from pathlib import Path

os.environ["QT_QPA_PLATFORM"] = "offscreen"

import numpy
import sightbound as sb
from qgis.PyQt.QtCore import QPointF, QRectF, Qt
from qgis.PyQt.QtGui import QColor, QFont, QGuiApplication, QImage, QPainter, QPen, QPolygonF

TARGET = Path(__file__).resolve().parent.parent / "docs" / "images" / "one_triangle.png"
LENGTH, HEIGHT = 10.0, 100.0
CORNERS = [(0.0, 0.0), (LENGTH, 0.0), (LENGTH / 2, LENGTH * 3**0.5 / 2)]
VARIATIONS = (0.2, 0.4, 0.7, 1.0)
VOXEL, VOXEL_HEIGHT = 0.2, 0.05
PIXELS = 34  # a metre
MARGIN, GAP, SECTION = 24, 60, 120
THIN, THICK = QColor("#f4f7fb"), QColor("#2f2b5f")
THICKEST = 2.4  # metres: the darkest colour


def volume(variation):
    model = sb.ErrorModel(vertical_rmse=0.05, geologic_variation=variation)
    tin = sb.Tin([(*corner, HEIGHT) for corner in CORNERS], [(0, 1, 2)])
    return sb.ErrorVolume.build(tin, model, voxel=VOXEL, voxel_height=VOXEL_HEIGHT).rasters()


def colour(thickness):
    share = min(thickness / THICKEST, 1.0)
    mixed = [round(a + share * (b - a)) for a, b in zip(THIN.getRgb(), THICK.getRgb())]
    return QColor(*mixed)


def from_above(painter, rasters, left, top):
    """Cells by thickness, the triangle's outline."""
    west, step, _, north, _, _ = rasters.geotransform
    side = step * PIXELS
    for row, col in zip(*numpy.nonzero(numpy.isfinite(rasters.thickness))):
        x = left + (west + col * step) * PIXELS
        y = top + (CORNERS[2][1] - north + row * step) * PIXELS
        painter.fillRect(QRectF(x, y, side + 0.5, side + 0.5), colour(float(rasters.thickness[row, col])))
    painter.setPen(QPen(QColor("black"), 1.5))
    outline = [QPointF(left + x * PIXELS, top + (CORNERS[2][1] - y) * PIXELS) for x, y in CORNERS]
    painter.drawPolygon(QPolygonF(outline))


def from_the_side(painter, rasters, left, middle):
    """The columns of voxels along x = LENGTH / 2, from the edge (left) to the corner (right); the triangle as a line."""
    west, step, _, north, _, _ = rasters.geotransform
    col = int((LENGTH / 2 - west) / step)
    wide, high = step * PIXELS, VOXEL_HEIGHT * PIXELS
    painter.setPen(QPen(QColor("#3b6db4"), 0.8))
    for row in numpy.nonzero(numpy.isfinite(rasters.lower[:, col]))[0]:
        x = left + (north - (row + 1) * step) * PIXELS
        for k in range(round(float(rasters.thickness[row, col]) / VOXEL_HEIGHT)):
            bottom = middle - (float(rasters.lower[row, col]) - HEIGHT) * PIXELS - k * high
            painter.drawRect(QRectF(x, bottom - high, wide, high))
    painter.setPen(QPen(QColor("black"), 2.0))
    painter.drawLine(QPointF(left, middle), QPointF(left + CORNERS[2][1] * PIXELS, middle))


def main():
    application = QGuiApplication([])  # for fonts
    panel = LENGTH * PIXELS
    width = round(2 * MARGIN + len(VARIATIONS) * panel + (len(VARIATIONS) - 1) * GAP)
    above = MARGIN + 36
    middle = above + CORNERS[2][1] * PIXELS + 24 + SECTION / 2
    image = QImage(width, round(middle + SECTION / 2), QImage.Format.Format_RGB32)
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setFont(QFont("DejaVu Sans", 15, QFont.Weight.Bold))
    for n, variation in enumerate(VARIATIONS):
        left = MARGIN + n * (panel + GAP)
        rasters = volume(variation)
        painter.setPen(QColor("black"))
        painter.drawText(QPointF(left, MARGIN + 12), f"Δ = {variation:g} m")
        from_above(painter, rasters, left, above)
        from_the_side(painter, rasters, left, middle)
    painter.end()
    image = image.scaledToWidth(width * 3 // 4, Qt.TransformationMode.SmoothTransformation)
    if not image.save(str(TARGET)):
        raise OSError(f"{TARGET} cannot be written")
    application.quit()


if __name__ == "__main__":
    main()
