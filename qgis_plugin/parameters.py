# SPDX-License-Identifier: GPL-3.0-or-later
"""The parameters that the algorithms share: the same names, words and limits wherever they appear.

Each block is a function that returns definitions in the order of the dialog. Rarely used parameters are advanced and
optional, so that a model need not mention them; an optional parameter left empty means its default.
"""

from importlib.util import find_spec

from qgis.core import (
    QgsProcessing,
    QgsProcessingParameterBand,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterDistance,
    QgsProcessingParameterEnum,
    QgsProcessingParameterExtent,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterField,
    QgsProcessingParameterFile,
    QgsProcessingParameterMatrix,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
    QgsProcessingParameterRasterLayer,
    QgsProcessingParameterString,
    QgsPropertyDefinition,
    QgsUnitTypes,
)

from .defaults import default
from .text import tr


def advanced(parameter):
    parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.Flag.FlagAdvanced)
    return parameter


def varying(parameter, layer):
    """Lets a field or an expression over the features of the parameter `layer` give the value."""
    parameter.setIsDynamic(True)
    parameter.setDynamicLayerParameterName(layer)
    parameter.setDynamicPropertyDefinition(
        QgsPropertyDefinition(
            parameter.name(), parameter.description(), QgsPropertyDefinition.StandardPropertyTemplate.Double
        )
    )
    return parameter


def number(name, label, value=None, minimum=None, maximum=None, optional=True, integer=False):
    kind = QgsProcessingParameterNumber.Type.Integer if integer else QgsProcessingParameterNumber.Type.Double
    parameter = QgsProcessingParameterNumber(name, label, kind, value, optional)
    return _limited(parameter, minimum, maximum)


def metres(name, label, value=None, minimum=0.0, optional=True):
    """A distance in metres whatever the CRS of the DEM; the dialog offers other units and converts."""
    parameter = QgsProcessingParameterDistance(name, label, value, "", optional)
    parameter.setDefaultUnit(QgsUnitTypes.DistanceUnit.DistanceMeters)
    return _limited(parameter, minimum, None)


def _limited(parameter, minimum, maximum):
    if minimum is not None:
        parameter.setMinimum(minimum)
    if maximum is not None:
        parameter.setMaximum(maximum)
    return parameter


def choice(name, label, words, value):
    """One of a few words, which scripts give as they are."""
    return QgsProcessingParameterEnum(name, label, words, False, value, True, True)


def raster(name, label, optional=False):
    return QgsProcessingParameterRasterLayer(name, label, optional=optional)


def points(name, label, optional=False):
    kinds = [QgsProcessing.SourceType.TypeVectorPoint]
    return QgsProcessingParameterFeatureSource(name, label, kinds, None, optional)


def places(name, label):
    """Points or polygons."""
    kinds = [QgsProcessing.SourceType.TypeVectorPoint, QgsProcessing.SourceType.TypeVectorPolygon]
    return QgsProcessingParameterFeatureSource(name, label, kinds)


def vdb(name, label):
    """A volume that one of the algorithms wrote."""
    return QgsProcessingParameterFile(name, label, QgsProcessingParameterFile.Behavior.File, "vdb")


def field(name, label, layer, numeric=False):
    kinds = QgsProcessingParameterField.DataType
    kind = kinds.Numeric if numeric else kinds.Any
    return QgsProcessingParameterField(name, label, None, layer, kind, False, True)


def dem_block():
    return [
        raster("INPUT", tr("Elevation model")),
        # Optional, because QGIS 3.22 takes a band with a default for mandatory.
        QgsProcessingParameterBand("BAND", tr("Band"), 1, "INPUT", True),
    ]


def error_block():
    """How wrong the elevation model may be. Read by error_block.py."""
    unset = None
    return [
        number(
            "VERTICAL_ACCURACY", tr("Vertical accuracy in metres (empty: estimate from the DEM)"), unset, 0.0
        ),
        choice("VERTICAL_MEASURE", tr("Vertical accuracy is stated as"), ["RMSE", "LE90", "LE95"], "RMSE"),
        number(
            "GEOLOGIC_VARIATION",
            tr("Largest rise between samples in metres, at 95 % (empty: estimate from the DEM)"),
            unset,
            0.0,
        ),
        advanced(
            number(
                "HORIZONTAL_ACCURACY", tr("Horizontal accuracy in metres"), default("horizontal_rmse"), 0.0
            )
        ),
        advanced(
            choice(
                "HORIZONTAL_MEASURE", tr("Horizontal accuracy is stated as"), ["RMSE", "CE90", "CE95"], "RMSE"
            )
        ),
        advanced(raster("ERROR_RASTER", tr("Vertical accuracy as a raster (RMSE in metres)"), True)),
        advanced(
            choice(
                "GEOLOGIC_MODEL",
                tr("Growth of doubt between samples"),
                ["gaussian", "step"],
                default("geologic_model"),
            )
        ),
        advanced(metres("GEOLOGIC_RANGE", tr("Range of the growth of doubt"))),
        advanced(raster("GEOLOGIC_RASTER", tr("Largest rise between samples as a raster (metres)"), True)),
        advanced(
            QgsProcessingParameterFeatureSource(
                "TERRAIN_TYPES",
                tr("Terrain types (polygons)"),
                [QgsProcessing.SourceType.TypeVectorPolygon],
                None,
                True,
            )
        ),
        advanced(
            field("TERRAIN_FIELD", tr("Field with the terrain type, or the rise in metres"), "TERRAIN_TYPES")
        ),
        advanced(
            QgsProcessingParameterMatrix(
                "TERRAIN_TABLE",
                tr("Largest rise between samples by terrain type"),
                0,
                False,
                [tr("Terrain type"), tr("Rise in metres")],
                _terrain_rows(),
                True,
            )
        ),
        product_parameter(),
        advanced(
            choice("TAILS", tr("Distribution of errors"), ["auto", "normal", "laplace", "student"], "auto")
        ),
        advanced(
            metres(
                "CORRELATION_LENGTH",
                tr("Correlation length of vertical errors"),
                default("correlation_length"),
            )
        ),
        advanced(number("SHARED_BIAS", tr("Bias of all heights in metres"), default("shared_bias"))),
        advanced(choice("SAMPLES_OR_MEANS", tr("Cells hold"), ["auto", "samples", "means"], "auto")),
        advanced(number("RIDGE_GAIN", tr("Ridge gain (empty: estimate from the DEM)"), unset, -2.0, 2.0)),
        advanced(
            QgsProcessingParameterFile(
                "ERROR_MODEL",
                tr("Error model file (replaces all of the above)"),
                QgsProcessingParameterFile.Behavior.File,
                "json",
                None,
                True,
            )
        ),
    ]


def product_parameter():
    label = tr("Elevation product of published accuracy")
    return advanced(choice("ERROR_PRODUCT", label, ["none", *default("error_products")], "none"))


def _terrain_rows():
    """The core's table, from the smoothest terrain to the roughest, as the matrix holds it: cell after cell."""
    rows = sorted(default("terrain_table").items(), key=lambda row: (row[1], row[0]))
    return [cell for row in rows for cell in row]


def observers_block():
    """Exactly one of OBSERVERS and OBSERVER. Read by observers.py."""
    return [
        points("OBSERVERS", tr("Observers (points; or one point below)"), optional=True),
        QgsProcessingParameterPoint("OBSERVER", tr("One observer"), None, True),
        *height_block(),
        varying(metres("MAX_DISTANCE", tr("Maximum distance (empty: the whole DEM)")), "OBSERVERS"),
    ]


def height_block():
    """Of eyes and targets, over the features of OBSERVERS."""
    return [
        varying(
            number(
                "OBSERVER_HEIGHT",
                tr("Observer height in metres"),
                default("observer_height"),
                optional=False,
            ),
            "OBSERVERS",
        ),
        varying(
            number("TARGET_HEIGHT", tr("Target height in metres"), default("target_height"), optional=False),
            "OBSERVERS",
        ),
    ]


def limits_block():
    """What each observer is asked about, beyond MAX_DISTANCE."""
    azimuth, angle = default("azimuth"), default("vertical_angle")
    limits = [
        metres("MIN_DISTANCE", tr("Minimum distance"), default("min_distance")),
        number("AZIMUTH_FROM", tr("Azimuth from (degrees clockwise from north)"), azimuth[0], -360.0, 720.0),
        number("AZIMUTH_TO", tr("Azimuth to (degrees clockwise from north)"), azimuth[1], -360.0, 720.0),
        number("ANGLE_FROM", tr("Vertical angle from (degrees above the horizon)"), angle[0], -90.0, 90.0),
        number("ANGLE_TO", tr("Vertical angle to (degrees above the horizon)"), angle[1], -90.0, 90.0),
    ]
    fields = [
        field("OBSERVER_HEIGHT_FIELD", tr("Field with the observer height"), "OBSERVERS", numeric=True),
        field("TARGET_HEIGHT_FIELD", tr("Field with the target height"), "OBSERVERS", numeric=True),
        field("ID_FIELD", tr("Field that names the observers"), "OBSERVERS"),
    ]
    return [advanced(varying(limit, "OBSERVERS")) for limit in limits] + [advanced(one) for one in fields]


def confidence_parameter():
    return number(
        "CONFIDENCE", tr("Confidence of a claim (0 to 1)"), default("confidence"), 0.0, 1.0, optional=False
    )


def vertical_unit_parameter():
    words = ["auto", "metre", "foot", "us-foot"]
    return advanced(choice("VERTICAL_UNIT", tr("Vertical unit of the DEM"), words, default("vertical_unit")))


def _height_reference():
    words = ["ground", "absolute"]
    return advanced(choice("HEIGHT_REFERENCE", tr("Heights are above"), words, default("height_reference")))


def earth_block():
    """How light and ground bend."""
    curvature = QgsProcessingParameterBoolean(
        "CURVATURE", tr("Curvature of the Earth"), default("curvature"), True
    )
    return [
        advanced(number("REFRACTION", tr("Refraction coefficient"), default("refraction"), -1.0, 1.0)),
        advanced(curvature),
    ]


def volume_sight_block():
    """How sight lines through an error volume are computed, and how many at most."""
    most = number("MOST_LINES", tr("Largest number of lines of sight"), default("most_lines"), 1.0)
    return [_height_reference(), *earth_block(), advanced(most)]


def hide_height_parameter():
    label = tr("Height of what is to be hidden, in metres")
    return number("HIDE_HEIGHT", label, 1.8, 0.001, optional=False)


def sight_block():
    """How sight lines are computed."""
    return [
        _height_reference(),
        advanced(raster("GROUND", tr("Ground under a surface model, for heights above it"), True)),
        vertical_unit_parameter(),
        *earth_block(),
        advanced(choice("STAND", tr("Eye and target stand on"), ["model", "ground"], default("stand"))),
        advanced(
            QgsProcessingParameterBoolean(
                "SEE_ACROSS_NODATA", tr("See across nodata"), default("see_across_nodata"), True
            )
        ),
    ]


def extent_parameter():
    return advanced(QgsProcessingParameterExtent("EXTENT", tr("Extent of the output"), None, True))


def run_block():
    """How the job runs and how it writes."""
    options = QgsProcessingParameterString(
        "CREATION_OPTIONS", tr("Creation options of the GeoTIFFs"), "", False, True
    )
    options.setMetadata({"widget_wrapper": _raster_options_widget()})
    return [threads_parameter(), advanced(options)]


def threads_parameter():
    return advanced(number("THREADS", tr("Threads (empty: all cores)"), None, 1, None, integer=True))


def _raster_options_widget():
    """QGIS's own widget for creation options: a Python class up to 3.40, part of C++ later."""
    module = "processing.algs.gdal.ui.RasterOptionsWidget"
    try:
        found = find_spec(module) is not None
    except ModuleNotFoundError:
        found = False
    return {"class": f"{module}.RasterOptionsWidgetWrapper"} if found else {"widget_type": "rasteroptions"}
