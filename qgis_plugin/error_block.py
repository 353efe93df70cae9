# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the error block: in the main thread what was said, in the worker the core's ErrorModel of it."""

from dataclasses import dataclass, field
from pathlib import Path

from osgeo import gdal
from qgis.core import (
    QgsCoordinateTransform,
    QgsFeature,
    QgsFields,
    QgsProcessingUtils,
    QgsVectorFileWriter,
    QgsWkbTypes,
)

from .errors import bad_input, core_errors
from .feedback import until_cancelled
from .rasters import read_raster, same_ground
from .text import tr
from .values import given, number_or_none, word

_INPUTS = (
    "VERTICAL_ACCURACY",
    "GEOLOGIC_VARIATION",
    "HORIZONTAL_ACCURACY",
    "ERROR_RASTER",
    "GEOLOGIC_RANGE",
    "GEOLOGIC_RASTER",
    "TERRAIN_TYPES",
    "ERROR_PRODUCT",
    "TAILS",
    "CORRELATION_LENGTH",
    "SHARED_BIAS",
    "SAMPLES_OR_MEANS",
    "RIDGE_GAIN",
)


@dataclass
class ErrorChoice:
    """What the user said. `file` replaces the rest, a `product` stands for what was not said; nothing said at all
    leaves the model to the core's estimate."""

    file: str = ""
    product: str = ""
    accuracy: dict = field(default_factory=dict)
    other: dict = field(default_factory=dict)

    def model(self, sightbound):
        """The core's ErrorModel, or None for its estimate from the DEM."""
        if self.file:
            try:
                return sightbound.ErrorModel.from_json(Path(self.file).read_text(encoding="utf-8"))
            except (ValueError, OSError) as error:
                raise bad_input("ERROR_MODEL", f"{self.file}: {error}") from error
        if self.product:
            with core_errors():
                return sightbound.product_error(self.product, **self.accuracy, **self.other)
        if not self.accuracy and not self.other:
            return None
        with core_errors():
            return sightbound.ErrorModel.from_accuracy(**self.accuracy, **self.other)


def read_error_block(algorithm, parameters, context, feedback, dem):
    if given(parameters, "ERROR_MODEL"):
        return _from_file(algorithm, parameters, context, feedback)
    choice = ErrorChoice()
    _read_accuracy(choice, algorithm, parameters, context, feedback)
    _read_geologic(choice, algorithm, parameters, context, feedback, dem)
    _read_nature(choice, algorithm, parameters, context)
    return choice


def check_error_block(algorithm, parameters, context):
    """The first contradiction in the block, as a sentence; '' if there is none."""
    if given(parameters, "ERROR_MODEL"):
        return ""
    for one, other in (
        ("VERTICAL_ACCURACY", "ERROR_RASTER"),
        ("GEOLOGIC_VARIATION", "GEOLOGIC_RASTER"),
    ):
        if given(parameters, one) and given(parameters, other):
            return tr("{}: {} says the same thing; give only one of them.").format(one, other)
    if given(parameters, "TERRAIN_TYPES") and not given(parameters, "TERRAIN_FIELD"):
        return tr(
            "TERRAIN_FIELD: name the field of TERRAIN_TYPES that holds the terrain type or the rise in metres."
        )
    if word(algorithm, parameters, "GEOLOGIC_MODEL", context) == "step" and not given(
        parameters, "GEOLOGIC_RANGE"
    ):
        return tr("GEOLOGIC_RANGE: GEOLOGIC_MODEL=step needs a range in metres.")
    return ""


def _from_file(algorithm, parameters, context, feedback):
    path = algorithm.parameterAsFile(parameters, "ERROR_MODEL", context)
    if not Path(path).is_file():
        raise bad_input("ERROR_MODEL", tr("there is no file {}.").format(path))
    algorithm.paths[path] = "ERROR_MODEL"
    ignored = [name for name in _INPUTS if _says_something(algorithm, parameters, name)]
    if ignored:
        feedback.pushWarning(tr("ERROR_MODEL replaces {}.").format(", ".join(ignored)))
    return ErrorChoice(file=path)


def _says_something(algorithm, parameters, name):
    return given(parameters, name) and parameters[name] != algorithm.parameterDefinition(name).defaultValue()


def _read_accuracy(choice, algorithm, parameters, context, feedback):
    vertical = number_or_none(algorithm, parameters, "VERTICAL_ACCURACY", context)
    if vertical is not None:
        choice.accuracy[word(algorithm, parameters, "VERTICAL_MEASURE", context).lower()] = vertical
    horizontal = number_or_none(algorithm, parameters, "HORIZONTAL_ACCURACY", context)
    if horizontal:
        measure = word(algorithm, parameters, "HORIZONTAL_MEASURE", context).lower()
        choice.accuracy["horizontal_rmse" if measure == "rmse" else measure] = horizontal
    errors = read_raster(algorithm, parameters, "ERROR_RASTER", context, feedback)
    if errors is not None:
        choice.other["vertical_rmse"] = errors.path


def _read_geologic(choice, algorithm, parameters, context, feedback, dem):
    variation = number_or_none(algorithm, parameters, "GEOLOGIC_VARIATION", context)
    if variation is not None:
        choice.other["geologic_variation"] = variation
    rises = read_raster(algorithm, parameters, "GEOLOGIC_RASTER", context, feedback)
    if rises is not None:
        choice.other["geologic_variation"] = rises.path
    if given(parameters, "TERRAIN_TYPES"):
        choice.other["terrain_types"] = _polygons(algorithm, parameters, context, feedback, dem)
        choice.other["terrain_field"] = algorithm.parameterAsFields(parameters, "TERRAIN_FIELD", context)[0]
        choice.other["terrain_table"] = _terrain_table(algorithm, parameters, context)
    reach = number_or_none(algorithm, parameters, "GEOLOGIC_RANGE", context)
    model = word(algorithm, parameters, "GEOLOGIC_MODEL", context)
    if reach is not None:
        choice.other["geologic_range"] = reach
    if model != algorithm.parameterDefinition("GEOLOGIC_MODEL").defaultValue():
        choice.other["geologic_model"] = model


def _read_nature(choice, algorithm, parameters, context):
    """What errors have in common, what a cell holds, and the product that the rest is known of."""
    product = word(algorithm, parameters, "ERROR_PRODUCT", context)
    choice.product = "" if product == "none" else product
    for name in ("TAILS", "SAMPLES_OR_MEANS"):
        said = word(algorithm, parameters, name, context)
        if said != "auto":
            choice.other[name.lower()] = said
    for name in ("CORRELATION_LENGTH", "SHARED_BIAS"):
        metres = number_or_none(algorithm, parameters, name, context)
        if metres:
            choice.other[name.lower()] = metres
    gain = number_or_none(algorithm, parameters, "RIDGE_GAIN", context)
    if gain is not None:
        choice.other["ridge_gain"] = gain


def _polygons(algorithm, parameters, context, feedback, dem):
    """The path of a file that holds the polygons: the layer's own, or a copy in the CRS of the DEM."""
    source = algorithm.parameterAsSource(parameters, "TERRAIN_TYPES", context)
    if source is None:
        raise bad_input(
            "TERRAIN_TYPES", tr("the layer {} cannot be read.").format(parameters["TERRAIN_TYPES"])
        )
    name = algorithm.parameterAsFields(parameters, "TERRAIN_FIELD", context)[0]
    index = source.fields().lookupField(name)
    if index < 0:
        names = ", ".join(one.name() for one in source.fields())
        raise bad_input("TERRAIN_FIELD", tr("the layer has no field {!r}; it has {}.").format(name, names))
    layer = algorithm.parameterAsVectorLayer(parameters, "TERRAIN_TYPES", context)
    path = _plain_file(layer, source) or _copy_polygons(source, index, dem.crs, context, feedback)
    algorithm.paths[path] = "TERRAIN_TYPES"
    return path


def _plain_file(layer, source):
    """The path of the layer's file if the file alone says the same as the layer: all features, the same CRS."""
    if layer is None or layer.dataProvider().name() != "ogr" or not Path(layer.source()).is_file():
        return ""
    dataset = gdal.OpenEx(layer.source(), gdal.OF_VECTOR)
    if (
        dataset is None
        or dataset.GetLayerCount() != 1
        or source.featureCount() != dataset.GetLayer(0).GetFeatureCount()
    ):
        return ""
    return layer.source() if same_ground(dataset.GetLayer(0).GetSpatialRef(), layer.crs()) else ""


def _copy_polygons(source, index, crs, context, feedback):
    fields = QgsFields()
    fields.append(source.fields().at(index))
    path = QgsProcessingUtils.generateTempFilename("terrain_types.gpkg")
    options = QgsVectorFileWriter.SaveVectorOptions()
    options.driverName = "GPKG"
    writer = QgsVectorFileWriter.create(
        path, fields, QgsWkbTypes.Type.MultiPolygon, crs, context.transformContext(), options
    )
    to_dem = QgsCoordinateTransform(source.sourceCrs(), crs, context.transformContext())
    for feature in until_cancelled(source.getFeatures(), feedback):
        geometry = feature.geometry()
        if geometry.isNull():
            continue
        geometry.convertToStraightSegment()
        geometry.transform(to_dem)
        geometry.convertToMultiType()
        copy = QgsFeature(fields)
        copy.setGeometry(geometry)
        copy.setAttributes([feature.attribute(index)])
        writer.addFeature(copy)
    del writer
    return path


def _terrain_table(algorithm, parameters, context):
    """A dict of class and metres from the table, or the path of a JSON or CSV file given in its place."""
    cells = algorithm.parameterAsMatrix(parameters, "TERRAIN_TABLE", context)
    if len(cells) == 1:
        path = Path(str(cells[0]))
        if not path.is_file():
            raise bad_input(
                "TERRAIN_TABLE", tr("{} is neither a table (class,metres,...) nor a file.").format(path)
            )
        return str(path)
    if len(cells) % 2:
        raise bad_input(
            "TERRAIN_TABLE", tr("each row needs two cells: the terrain type and the rise in metres.")
        )
    table = {}
    for kind, rise in zip(cells[0::2], cells[1::2]):
        try:
            table[str(kind).strip()] = float(rise)
        except (TypeError, ValueError):
            raise bad_input(
                "TERRAIN_TABLE", tr("{!r} is no rise in metres for {!r}.").format(rise, kind)
            ) from None
    return table
