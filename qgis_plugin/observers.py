# SPDX-License-Identifier: GPL-3.0-or-later
"""Point features become observers in the CRS of the DEM, each with its own heights and limits. Main thread only."""

import re
from dataclasses import dataclass, field

from qgis.core import (
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
)

from .errors import bad_input
from .feedback import until_cancelled
from .text import tr
from .values import Varying, given, is_null

HEIGHTS = ("OBSERVER_HEIGHT", "TARGET_HEIGHT")
LIMITS = ("MIN_DISTANCE", "MAX_DISTANCE", "AZIMUTH_FROM", "AZIMUTH_TO", "ANGLE_FROM", "ANGLE_TO")


@dataclass
class Place:
    """One point of a layer (or the clicked one): where it is in the CRS of the DEM, and what was said about it."""

    label: str  # how messages call it
    name: str  # from the naming field, else the feature's id
    x: float
    y: float
    feature: QgsFeature  # as in the layer
    point: QgsGeometry  # as in the layer; one point of a multipoint
    values: dict = field(default_factory=dict)  # parameter name -> number or None


def read_observers(algorithm, parameters, context, feedback, dem):
    """The places of OBSERVERS or OBSERVER, and the source (None for a single OBSERVER)."""
    names = HEIGHTS + LIMITS
    if given(parameters, "OBSERVERS"):
        fields = {name: f"{name}_FIELD" for name in HEIGHTS}
        return read_points(
            algorithm, parameters, "OBSERVERS", context, feedback, dem, names, fields, "ID_FIELD"
        )
    expressions = algorithm.createExpressionContext(parameters, context)
    values = [Varying(algorithm, parameters, name, context, expressions) for name in names]
    point = algorithm.parameterAsPoint(parameters, "OBSERVER", context, dem.crs)
    feature = QgsFeature(1)
    feature.setGeometry(QgsGeometry.fromPointXY(point))
    place = Place("OBSERVER", "1", point.x(), point.y(), feature, feature.geometry())
    place.values = {one.name: one.value(None, place.label) for one in values}
    _check(place, "OBSERVER", dem)
    return [place], None


def read_points(
    algorithm, parameters, name, context, feedback, dem, varying, fields, name_field, outside=False
):
    """The points of the layer `name` in the CRS of the DEM. Raises Stopped when cancelled.

    `varying` are the parameters to evaluate for each; `fields` names the field parameter that may stand in for one.
    With `outside` points may lie outside the DEM.
    """
    source = algorithm.parameterAsSource(parameters, name, context)
    if source is None:
        raise bad_input(name, tr("the layer {} cannot be read.").format(parameters.get(name)))
    expressions = algorithm.createExpressionContext(parameters, context, source)
    values = [
        Varying(
            algorithm,
            parameters,
            one,
            context,
            expressions,
            _field(algorithm, parameters, fields.get(one), source, context),
        )
        for one in varying
    ]
    naming = _field(algorithm, parameters, name_field, source, context)
    to_dem = _transform(source.sourceCrs(), dem.crs, context)
    places = []
    for feature in until_cancelled(source.getFeatures(), feedback):
        label = tr("feature {} of {}").format(feature.id(), name)
        title = feature.attribute(naming) if naming else feature.id()
        evaluated = {one.name: one.value(feature, label) for one in values}
        for point in until_cancelled(_points_of(feature, name, label), feedback):
            x, y = _moved(point, to_dem, name, label)
            title = feature.id() if is_null(title) else title
            place = Place(label, str(title), x, y, feature, QgsGeometry.fromPointXY(point), dict(evaluated))
            if not outside:
                _check(place, name, dem)
            places.append(place)
    if not places:
        raise bad_input(name, tr("the layer holds no points; add some, or clear the selection."))
    return places, source


def check_observers(parameters):
    """Exactly one of OBSERVERS and OBSERVER; a sentence if not."""
    if given(parameters, "OBSERVERS") == given(parameters, "OBSERVER"):
        return tr(
            "OBSERVERS: give either a point layer here or one point as OBSERVER, not both and not neither."
        )
    for height in HEIGHTS:
        if given(parameters, f"{height}_FIELD") and not given(parameters, "OBSERVERS"):
            return tr("{}_FIELD: a field needs the layer OBSERVERS.").format(height)
    return ""


def core_arguments(places):
    """Names for messages, and the heights and limits, as the core takes them: one value per observer."""

    def column(name):
        return [place.values[name] for place in places]

    return {
        "names": [place.label for place in places],
        "observer_height": column("OBSERVER_HEIGHT"),
        "target_height": column("TARGET_HEIGHT"),
        "min_distance": column("MIN_DISTANCE"),
        "max_distance": column("MAX_DISTANCE"),
        "azimuth": list(zip(column("AZIMUTH_FROM"), column("AZIMUTH_TO"))),
        "vertical_angle": list(zip(column("ANGLE_FROM"), column("ANGLE_TO"))),
    }


def file_names(places):
    """One safe file name (no suffix) per place; names that would meet are numbered."""
    names, taken = [], set()
    for place in places:
        stem = re.sub(r"[^\w.-]+", "_", place.name).strip("._") or f"observer_{place.feature.id()}"
        name, count = stem, 1
        while name.lower() in taken:
            count += 1
            name = f"{stem}_{count}"
        taken.add(name.lower())
        names.append(name)
    return names


def _field(algorithm, parameters, parameter, source, context):
    """The field that a field parameter names, '' if it was left empty."""
    if not parameter or not given(parameters, parameter):
        return ""
    name = algorithm.parameterAsFields(parameters, parameter, context)[0]
    if source.fields().lookupField(name) < 0:
        names = ", ".join(one.name() for one in source.fields())
        raise bad_input(parameter, tr("the layer has no field {!r}; it has {}.").format(name, names))
    return name


def _transform(layer_crs, dem_crs, context):
    if not layer_crs.isValid() or not dem_crs.isValid():
        return QgsCoordinateTransform()
    return QgsCoordinateTransform(layer_crs, dem_crs, context.transformContext())


def _points_of(feature, name, label):
    geometry = feature.geometry()
    if geometry.isNull() or geometry.isEmpty():
        raise bad_input(name, tr("{} has no point; delete it or select others.").format(label))
    return [QgsPointXY(vertex) for vertex in geometry.vertices()]


def _moved(point, to_dem, name, label):
    try:
        moved = to_dem.transform(point)
    except QgsCsException:
        raise bad_input(name, tr("{} cannot be brought into the CRS of INPUT.").format(label)) from None
    return moved.x(), moved.y()


def _check(place, name, dem):
    if not dem.extent.contains(QgsPointXY(place.x, place.y)):
        remedy = tr("move it, or check the CRS of both layers.")
        where = tr("lies outside INPUT, at ({:.8g}, {:.8g}) in its CRS; {}").format(place.x, place.y, remedy)
        raise bad_input(name, where if place.label == name else f"{place.label} {where}")
    far, near = place.values.get("MAX_DISTANCE"), place.values.get("MIN_DISTANCE")
    if far is not None and near is not None and near >= far:
        sentence = tr("{:g} is not below MAX_DISTANCE {:g} for {}.").format(near, far, place.label)
        raise bad_input("MIN_DISTANCE", sentence)
