# SPDX-License-Identifier: GPL-3.0-or-later
"""Points and polygons become places and patrol areas in the CRS of an error volume."""

from dataclasses import dataclass, field

from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsCsException, QgsWkbTypes

from . import parameters as blocks
from .defaults import default
from .errors import bad_input
from .feedback import until_cancelled
from .text import tr
from .values import Varying, given, word

_LAYER = "OBSERVERS"


@dataclass
class Views:
    """What was read in the main thread: rings of each place or area, in the CRS of the layer."""

    crs: QgsCoordinateReferenceSystem
    transforms: object
    labels: list = field(default_factory=list)
    areas: list = field(default_factory=list)
    heights: list = field(default_factory=list)
    heights_to: list = field(default_factory=list)

    def arguments(self, volume):
        """The core's arguments, in the CRS of the volume. Any thread."""
        move = into_volume(self.crs, self.transforms, volume, _LAYER)
        return {
            "views": [_moved(rings, move, label) for rings, label in zip(self.areas, self.labels)],
            "view_height": self.heights,
            "view_height_to": self.heights_to,
            "names": self.labels,
        }


def into_volume(crs, transforms, volume, layer):
    """A function of a point of `layer` and its label: the point in the CRS of the volume. Any thread."""
    theirs = QgsCoordinateReferenceSystem.fromWkt(volume.crs_wkt) if volume.crs_wkt else None
    transform = QgsCoordinateTransform()
    if theirs is not None and theirs.isValid() and crs.isValid():
        transform = QgsCoordinateTransform(crs, theirs, transforms)

    def move(point, label):
        try:
            return transform.transform(point)
        except QgsCsException:
            raise bad_input(layer, tr("{} cannot be brought into the CRS of the volume.").format(label)) from None

    return move


def _moved(rings, move, label):
    moved = [[move(corner, label) for corner in ring] for ring in rings]
    corners = [[(corner.x(), corner.y()) for corner in ring] for ring in moved]
    return corners if len(corners[0]) > 1 else corners[0][0]


def views_block():
    """Where the observers are, and how sight is computed. Read by read_views() and sight_arguments()."""
    heights = [
        blocks.varying(
            blocks.number(
                "OBSERVER_HEIGHT", tr("Observer height in metres"), default("observer_height"), optional=False
            ),
            _LAYER,
        ),
        blocks.varying(
            blocks.number("OBSERVER_HEIGHT_TO", tr("Up to an observer height of (empty: that height alone)")), _LAYER
        ),
    ]
    fields = blocks.field("OBSERVER_HEIGHT_FIELD", tr("Field with the observer height"), _LAYER, numeric=True)
    return [
        blocks.places(_LAYER, tr("Observers (points, or polygons in which they may be)")),
        *heights,
        blocks.choice("SEEN_FROM", tr("A place counts as seen when seen from"), ["any", "all"], default("seen_from")),
        blocks.advanced(
            blocks.choice("HOLDS_FOR", tr("Claims hold for"), ["place", "voxel", "target"], default("holds_for"))
        ),
        blocks.advanced(fields),
        blocks.advanced(blocks.metres("VIEW_SPACING", tr("Spacing of the places within polygons"))),
        blocks.advanced(blocks.metres("MAX_DISTANCE", tr("Maximum distance (empty: all)"))),
        *blocks.volume_sight_block(),
    ]


def read_views(algorithm, parameters, context, feedback):
    """The points and polygons with their heights. Main thread; raises Stopped when cancelled."""
    source = algorithm.parameterAsSource(parameters, _LAYER, context)
    if source is None:
        raise bad_input(_LAYER, tr("the layer {} cannot be read.").format(parameters.get(_LAYER)))
    expressions = algorithm.createExpressionContext(parameters, context, source)
    named = ""
    if given(parameters, "OBSERVER_HEIGHT_FIELD"):
        named = algorithm.parameterAsFields(parameters, "OBSERVER_HEIGHT_FIELD", context)[0]
        if source.fields().lookupField(named) < 0:
            names = ", ".join(one.name() for one in source.fields())
            sentence = tr("the layer has no field {!r}; it has {}.").format(named, names)
            raise bad_input("OBSERVER_HEIGHT_FIELD", sentence)
    height = Varying(algorithm, parameters, "OBSERVER_HEIGHT", context, expressions, named)
    upper = Varying(algorithm, parameters, "OBSERVER_HEIGHT_TO", context, expressions)
    views = Views(source.sourceCrs(), context.transformContext())
    for feature in until_cancelled(source.getFeatures(), feedback):
        label = tr("feature {} of {}").format(feature.id(), _LAYER)
        low = height.value(feature, label)
        high = upper.value(feature, label)
        high = low if high is None else high
        if high < low:
            raise bad_input("OBSERVER_HEIGHT_TO", tr("{:g} is below OBSERVER_HEIGHT {:g} for {}.").format(high, low, label))
        for rings in _areas(feature, label):
            views.labels.append(label)
            views.areas.append(rings)
            views.heights.append(low)
            views.heights_to.append(high)
    if not views.areas:
        raise bad_input(_LAYER, tr("the layer holds nothing; add points or polygons, or clear the selection."))
    return views


def sight_arguments(algorithm, parameters, context):
    """The core's arguments on how sight is computed."""

    def length(name):
        return algorithm.parameterAsDouble(parameters, name, context) if given(parameters, name) else None

    return {
        "seen_from": word(algorithm, parameters, "SEEN_FROM", context),
        "holds_for": word(algorithm, parameters, "HOLDS_FOR", context),
        "view_spacing": length("VIEW_SPACING"),
        "max_distance": length("MAX_DISTANCE"),
        "height_reference": word(algorithm, parameters, "HEIGHT_REFERENCE", context),
        "refraction": algorithm.parameterAsDouble(parameters, "REFRACTION", context),
        "curvature": algorithm.parameterAsBoolean(parameters, "CURVATURE", context),
        "most_lines": algorithm.parameterAsDouble(parameters, "MOST_LINES", context),
        "threads": algorithm.threads(parameters, context),
    }


def _areas(feature, label):
    """The rings of each part: a point alone, or a polygon's outline and its holes."""
    geometry = feature.geometry()
    if geometry.isNull() or geometry.isEmpty():
        raise bad_input(_LAYER, tr("{} has no geometry; delete it or select others.").format(label))
    if geometry.type() == QgsWkbTypes.GeometryType.PolygonGeometry:
        polygons = geometry.asMultiPolygon() if geometry.isMultipart() else [geometry.asPolygon()]
        return [rings for rings in polygons if rings]
    points = geometry.asMultiPoint() if geometry.isMultipart() else [geometry.asPoint()]
    return [[[point]] for point in points]
