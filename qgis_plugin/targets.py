# SPDX-License-Identifier: GPL-3.0-or-later
"""Listed targets of sight through an error volume: read with their heights, and written with what is said of them."""

import math
from dataclasses import dataclass, field

from qgis.core import QgsCoordinateReferenceSystem, QgsFeature, QgsFeatureSink, QgsFields, QgsGeometry, QgsPointXY, QgsWkbTypes

from .errors import bad_input
from .feedback import until_cancelled
from .fields import add_unique, number_field, text_field
from .styling import style_when_loaded
from .text import tr
from .values import Varying, given
from .views import into_volume

LAYER = "TARGETS"
VERDICTS = ("hidden", "uncertain", "visible")


@dataclass
class Targets:
    """What was read in the main thread: a row for each point, in the CRS of the layer."""

    crs: QgsCoordinateReferenceSystem
    transforms: object
    fields: QgsFields
    points: list = field(default_factory=list)
    heights: list = field(default_factory=list)
    attributes: list = field(default_factory=list)
    labels: list = field(default_factory=list)

    def arguments(self, volume):
        """The core's arguments, in the CRS of the volume. Any thread."""
        move = into_volume(self.crs, self.transforms, volume, LAYER)
        moved = [move(point, label) for point, label in zip(self.points, self.labels)]
        return {"targets": [(point.x(), point.y()) for point in moved], "target_height": self.heights}


def read_targets(algorithm, parameters, context, feedback):
    """The points of TARGETS with their heights; None if it was left empty. Main thread; raises Stopped when cancelled."""
    if not given(parameters, LAYER):
        return None
    source = algorithm.parameterAsSource(parameters, LAYER, context)
    if source is None:
        raise bad_input(LAYER, tr("the layer {} cannot be read.").format(parameters.get(LAYER)))
    named = ""
    if given(parameters, "TARGET_HEIGHT_FIELD"):
        named = algorithm.parameterAsFields(parameters, "TARGET_HEIGHT_FIELD", context)[0]
        if source.fields().lookupField(named) < 0:
            names = ", ".join(one.name() for one in source.fields())
            raise bad_input("TARGET_HEIGHT_FIELD", tr("the layer has no field {!r}; it has {}.").format(named, names))
    expressions = algorithm.createExpressionContext(parameters, context, source)
    height = Varying(algorithm, parameters, "TARGET_HEIGHT", context, expressions, named)
    targets = Targets(source.sourceCrs(), context.transformContext(), source.fields())
    for feature in until_cancelled(source.getFeatures(), feedback):
        label = tr("feature {} of {}").format(feature.id(), LAYER)
        geometry = feature.geometry()
        if geometry.isNull() or geometry.isEmpty():
            raise bad_input(LAYER, tr("{} has no geometry; delete it or select others.").format(label))
        points = geometry.asMultiPoint() if geometry.isMultipart() else [geometry.asPoint()]
        if len(points) > 1:
            raise bad_input(LAYER, tr("{} has {} points; use Multipart to singleparts before.").format(label, len(points)))
        targets.points.append(points[0])
        targets.heights.append(height.value(feature, label))
        targets.attributes.append(feature.attributes())
        targets.labels.append(label)
    if not targets.points:
        raise bad_input(LAYER, tr("the layer holds nothing; add points, or clear the selection."))
    return targets


def write_targets(algorithm, targets, sight, parameters, context):
    """The targets with their attributes, verdict and p, in their own CRS."""
    fields = QgsFields(targets.fields)
    add_unique(fields, text_field, "verdict")
    add_unique(fields, number_field, "p")
    sink, path = algorithm.parameterAsSink(parameters, "OUTPUT", context, fields, QgsWkbTypes.Type.Point, targets.crs)
    if sink is None:
        raise bad_input("OUTPUT", tr("the layer cannot be written."))
    rows = zip(targets.points, targets.attributes, sight.verdict.tolist(), sight.confidence.tolist())
    for point, attributes, verdict, p in rows:
        feature = QgsFeature(fields)
        feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(point)))
        name = VERDICTS[verdict] if verdict < len(VERDICTS) else "unknown"
        feature.setAttributes(attributes + [name, None if math.isnan(p) else p])
        if not sink.addFeature(feature, QgsFeatureSink.Flag.FastInsert):
            raise bad_input("OUTPUT", tr("a feature cannot be written."))
    style_when_loaded(context, path, "critical")
    return path
