# SPDX-License-Identifier: GPL-3.0-or-later
"""Features on the grid of an elevation model: the samples whose cells they touch, and how far the others are from them."""

import math

import numpy
from osgeo import gdal
from qgis.core import (
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeature,
    QgsFields,
    QgsProcessing,
    QgsProcessingParameterFeatureSource,
    QgsProcessingUtils,
    QgsUnitTypes,
    QgsVectorFileWriter,
)

from .errors import bad_input
from .feedback import until_cancelled
from .text import tr
from .values import given


def places(name, label, kind=QgsProcessing.SourceType.TypeVectorAnyGeometry):
    return QgsProcessingParameterFeatureSource(name, label, [kind], None, True)


def read_places(algorithm, parameters, name, context, feedback, dem):
    """The path of a copy of the features in the CRS of the DEM; None if it was left empty."""
    if not given(parameters, name):
        return None
    source = algorithm.parameterAsSource(parameters, name, context)
    if source is None:
        raise bad_input(name, tr("the layer {} cannot be read.").format(parameters[name]))
    path = QgsProcessingUtils.generateTempFilename("places.gpkg")
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
        try:
            geometry.transform(to_dem)
        except QgsCsException as error:
            raise bad_input(name, tr("feature {} cannot be brought into the CRS of INPUT.").format(feature.id())) from error
        copy = QgsFeature()
        copy.setGeometry(geometry)
        writer.addFeature(copy)
    del writer  # closes the file
    algorithm.paths[path] = name
    return path


def lines_in(path):
    """Arrays (n, 2) of the lines of read_places(); None without a path. Any thread."""
    if path is None:
        return None
    lines = []

    def collect(geometry):
        if geometry.GetGeometryCount() > 0:
            for part in range(geometry.GetGeometryCount()):
                collect(geometry.GetGeometryRef(part))
        elif geometry.GetPointCount() > 1:
            lines.append(numpy.array(geometry.GetPoints())[:, :2])

    features = gdal.OpenEx(path, gdal.OF_VECTOR)  # its layer lasts as long
    for feature in features.GetLayer(0):
        collect(feature.GetGeometryRef().GetLinearGeometry())
    return lines


def samples_in(path, dem):
    """An array on the DEM's grid, 1 where a feature touches the cell; None without a path. Any thread."""
    return None if path is None else _touched(path, dem, "KEEP").ReadAsArray().astype("float32")


def distances_from(path, dem, name):
    """Metres from each sample to the nearest cell that a feature touches, less a cell's diagonal: never too many. Any thread."""
    touched = _touched(path, dem, name)
    _, across, turn, _, _, down = touched.GetGeoTransform()
    if turn or abs(abs(across) - abs(down)) > 1e-6 * abs(across):
        raise bad_input(name, tr("the cells of INPUT must be square and not rotated; resample it (Warp)."))
    rows, cols = touched.RasterYSize, touched.RasterXSize
    cells = gdal.GetDriverByName("MEM").Create("", cols, rows, 1, gdal.GDT_Float32)
    gdal.ComputeProximity(touched.GetRasterBand(1), cells.GetRasterBand(1), ["VALUES=1", "DISTUNITS=PIXEL"])
    metres = abs(across) * QgsUnitTypes.fromUnitToUnitFactor(dem.crs.mapUnits(), QgsUnitTypes.DistanceUnit.DistanceMeters)
    return numpy.maximum(cells.ReadAsArray() - math.sqrt(2.0), 0.0) * (metres if dem.crs.isValid() else abs(across))


def _touched(path, dem, name):
    heights = gdal.Open(dem.path)
    touched = gdal.GetDriverByName("MEM").Create("", heights.RasterXSize, heights.RasterYSize, 1, gdal.GDT_Byte)
    touched.SetGeoTransform(heights.GetGeoTransform())
    features = gdal.OpenEx(path, gdal.OF_VECTOR)
    gdal.RasterizeLayer(touched, [1], features.GetLayer(0), burn_values=[1], options=["ALL_TOUCHED=TRUE"])
    if not touched.ReadAsArray().any():
        raise bad_input(name, tr("no feature lies on INPUT; check its CRS."))
    return touched
