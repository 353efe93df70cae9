# SPDX-License-Identifier: GPL-3.0-or-later
"""Places that a simplified TIN keeps at full resolution: features become the samples whose cells they touch."""

from osgeo import gdal
from qgis.core import (
    QgsCoordinateTransform,
    QgsFeature,
    QgsFields,
    QgsProcessing,
    QgsProcessingParameterFeatureSource,
    QgsProcessingUtils,
    QgsVectorFileWriter,
)

from .errors import bad_input
from .feedback import until_cancelled
from .text import tr
from .values import given

NAME = "KEEP"


def keep_parameter():
    kinds = [QgsProcessing.SourceType.TypeVectorAnyGeometry]
    return QgsProcessingParameterFeatureSource(NAME, tr("Places to keep at full resolution"), kinds, None, True)


def read_keep(algorithm, parameters, context, feedback, dem):
    """The path of a copy of the features in the CRS of the DEM; None if it was left empty."""
    if not given(parameters, NAME):
        return None
    source = algorithm.parameterAsSource(parameters, NAME, context)
    if source is None:
        raise bad_input(NAME, tr("the layer {} cannot be read.").format(parameters[NAME]))
    path = QgsProcessingUtils.generateTempFilename("keep.gpkg")
    options = QgsVectorFileWriter.SaveVectorOptions()
    options.driverName = "GPKG"
    writer = QgsVectorFileWriter.create(
        path, QgsFields(), source.wkbType(), dem.crs, context.transformContext(), options
    )
    to_dem = QgsCoordinateTransform(source.sourceCrs(), dem.crs, context.transformContext())
    for feature in until_cancelled(source.getFeatures(), feedback):
        geometry = feature.geometry()
        if geometry.isNull():
            continue
        geometry.transform(to_dem)
        copy = QgsFeature()
        copy.setGeometry(geometry)
        writer.addFeature(copy)
    del writer  # closes the file
    algorithm.paths[path] = NAME
    return path


def samples_in(path, dem):
    """An array on the DEM's grid, 1 where a feature touches the cell; None without a path. Any thread."""
    if path is None:
        return None
    heights = gdal.Open(dem.path)
    touched = gdal.GetDriverByName("MEM").Create("", heights.RasterXSize, heights.RasterYSize, 1, gdal.GDT_Byte)
    touched.SetGeoTransform(heights.GetGeoTransform())
    features = gdal.OpenEx(path, gdal.OF_VECTOR)
    gdal.RasterizeLayer(touched, [1], features.GetLayer(0), burn_values=[1], options=["ALL_TOUCHED=TRUE"])
    return touched.ReadAsArray().astype("float32")
