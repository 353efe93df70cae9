# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts as inline SVG: lines and dots on linear or logarithmic axes, and rasters as small pictures."""

import base64
import html
import math

from qgis.PyQt.QtCore import QBuffer, QByteArray, QIODevice
from qgis.PyQt.QtGui import QImage

from .pages import ticks

_WIDTH, _HEIGHT = 860, 320
_LEFT, _RIGHT, _TOP, _BOTTOM = 80, 640, 16, 262
_LEGEND = 660
_MARGIN = 0.05  # of the span, around the values
_PALE, _DARK = (247, 244, 236), (122, 28, 46)
_LARGEST_PICTURE = 600  # pixels along a side
_SHOWN = 400  # pixels, up to which small ones are enlarged


class Chart:
    """Series are added with a style of pages.css; svg() draws them all. Axes span what was added."""

    def __init__(self, x_label, y_label, log_x=False, log_y=False, from_zero=True):
        self._labels = x_label, y_label
        self._logs = log_x, log_y
        self._from_zero = from_zero
        self._series = []

    def line(self, points, style, name):
        self._series.append(("line", self._drawable(points), style, name))

    def dots(self, points, style, name):
        self._series.append(("dots", self._drawable(points), style, name))

    def svg(self):
        points = [point for _, series, _, _ in self._series for point in series]
        if not points:
            return ""
        x_axis = _Axis([x for x, _ in points], self._logs[0], self._from_zero, _LEFT, _RIGHT)
        y_axis = _Axis([y for _, y in points], self._logs[1], self._from_zero, _BOTTOM, _TOP)
        parts = [f"<svg viewBox='0 0 {_WIDTH} {_HEIGHT}' role='img'>", *self._grid(x_axis, y_axis)]
        for number, (kind, series, style, name) in enumerate(self._series):
            places = [(x_axis.at(x), y_axis.at(y)) for x, y in series]
            parts.append(_drawn(kind, places, style))
            y = _TOP + 14 + 20 * number
            sample = [(_LEGEND, y - 4), (_LEGEND + 24, y - 4)] if kind == "line" else [(_LEGEND + 12, y - 4)]
            parts.append(_drawn(kind, sample, style))
            parts.append(f"<text x='{_LEGEND + 34}' y='{y}'>{html.escape(name)}</text>")
        return "".join(parts) + "</svg>"

    def _drawable(self, points):
        def fits(value, log):
            return math.isfinite(value) and (value > 0 or not log)

        return [(x, y) for x, y in points if fits(x, self._logs[0]) and fits(y, self._logs[1])]

    def _grid(self, x_axis, y_axis):
        for value in y_axis.ticks(6):
            y = y_axis.at(value)
            yield f"<line class='grid' x1='{_LEFT}' x2='{_RIGHT}' y1='{y:.1f}' y2='{y:.1f}'/>"
            yield f"<text x='{_LEFT - 8}' y='{y + 4:.1f}' text-anchor='end'>{value:g}</text>"
        for value in x_axis.ticks(8):
            x = x_axis.at(value)
            yield f"<line class='grid' x1='{x:.1f}' x2='{x:.1f}' y1='{_TOP}' y2='{_BOTTOM}'/>"
            yield f"<text x='{x:.1f}' y='{_BOTTOM + 18}' text-anchor='middle'>{value:g}</text>"
        middle = (_TOP + _BOTTOM) / 2
        yield f"<text x='{(_LEFT + _RIGHT) / 2}' y='{_BOTTOM + 42}' text-anchor='middle'>{html.escape(self._labels[0])}</text>"
        yield (
            f"<text x='20' y='{middle}' text-anchor='middle' transform='rotate(-90 20 {middle})'>"
            f"{html.escape(self._labels[1])}</text>"
        )


class _Axis:
    """Values to drawing units between `start` and `end`."""

    def __init__(self, values, log, from_zero, start, end):
        self._log, self._start, self._end = log, start, end
        scaled = [self._scaled(value) for value in values]
        low, high = min(scaled), max(scaled)
        if from_zero and not log:
            low, high = min(low, 0.0), max(high, 0.0)
        span = (high - low) or abs(high) or 1.0
        self._low = low if from_zero and low == 0.0 else low - _MARGIN * span
        self._high = high + _MARGIN * span

    def at(self, value):
        share = (self._scaled(value) - self._low) / (self._high - self._low)
        return self._start + share * (self._end - self._start)

    def ticks(self, most):
        if not self._log:
            return ticks(self._low, self._high, most)
        steps = [f * 10.0**power for power in range(math.floor(self._low), math.ceil(self._high) + 1) for f in (1, 2, 5)]
        inside = [step for step in steps if self._low <= math.log10(step) <= self._high]
        if len(inside) < 3:
            return [step for step in ticks(10.0**self._low, 10.0**self._high, most) if step > 0]
        return inside if len(inside) <= most + 2 else [step for step in inside if f"{step:e}".startswith("1")]

    def _scaled(self, value):
        return math.log10(value) if self._log else value


def _drawn(kind, places, style):
    if kind == "dots":
        return "".join(f"<circle class='{style}' cx='{x:.1f}' cy='{y:.1f}' r='4'/>" for x, y in places)
    corners = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
    return f"<polyline class='{style}' points='{corners}'/>"


def picture(values, largest):
    """An image of a raster (rows of numbers, NaN = white) from pale at 0 to dark at `largest`, for inside a page."""
    import numpy

    step = max(1, math.ceil(max(values.shape) / _LARGEST_PICTURE))
    shown = values[::step, ::step]
    share = numpy.clip(shown / largest if largest > 0 else numpy.zeros_like(shown), 0.0, 1.0)
    colours = [pale + numpy.nan_to_num(share) * (dark - pale) for pale, dark in zip(_PALE, _DARK)]
    pixels = numpy.stack(colours, axis=-1)
    pixels[numpy.isnan(shown)] = 255
    rows, cols = shown.shape
    held = pixels.round().astype("uint8").tobytes()  # the image only looks at it
    image = QImage(held, cols, rows, 3 * cols, QImage.Format.Format_RGB888)
    data = QByteArray()
    buffer = QBuffer(data)
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    image.save(buffer, "PNG")
    text = base64.b64encode(bytes(data)).decode("ascii")
    zoom = max(1, _SHOWN // max(rows, cols))
    return f"<img class='map' width='{zoom * cols}' height='{zoom * rows}' src='data:image/png;base64,{text}' alt=''/>"
