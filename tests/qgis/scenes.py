# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes for the QGIS tests: a hilly DEM of 40 x 30 cells of 10 m, and points on it."""

import math

import numpy
from osgeo import gdal, ogr, osr
from qgis.core import QgsProcessingFeedback

gdal.UseExceptions()
ogr.UseExceptions()

UTM = 32633
WEST, NORTH, CELL, COLS, ROWS = 500000.0, 5000000.0, 10.0, 40, 30
FIRST, SECOND = (WEST + 105.0, NORTH - 95.0), (WEST + 300.0, NORTH - 201.0)


class Log(QgsProcessingFeedback):
    """Keeps what an algorithm tells; cancels once `cancel_at` per cent are done."""

    def __init__(self, cancel_at=None):
        super().__init__(False)
        self.infos, self.warnings, self.errors, self.fractions = [], [], [], []
        self._cancel_at = cancel_at
        self.progressChanged.connect(self._progressed)

    def _progressed(self, percent):
        self.fractions.append(percent)
        if self._cancel_at is not None and percent >= self._cancel_at:
            self.cancel()

    def pushInfo(self, text):
        self.infos.append(text)

    def pushWarning(self, text):
        self.warnings.append(text)

    def reportError(self, text, fatalError=False):
        self.errors.append(text)


def reference(code):
    system = osr.SpatialReference()
    system.ImportFromEPSG(code)
    system.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    return system


def hills():
    row, col = numpy.mgrid[0:ROWS, 0:COLS]
    return (100.0 + 10.0 * numpy.sin(col / 4.0) + 8.0 * numpy.cos(row / 5.0)).astype("float32")


def write_raster(path, values, geotransform, crs, nodata=None):
    kind = {"float32": gdal.GDT_Float32, "uint8": gdal.GDT_Byte}[str(values.dtype)]
    dataset = gdal.GetDriverByName("GTiff").Create(str(path), values.shape[1], values.shape[0], 1, kind)
    dataset.SetGeoTransform(geotransform)
    if crs is not None:
        dataset.SetProjection(reference(crs).ExportToWkt())
    if nodata is not None:
        dataset.GetRasterBand(1).SetNoDataValue(nodata)
    dataset.GetRasterBand(1).WriteArray(values)
    dataset = None
    return path


def write_dem(path, values=None, crs=UTM):
    values = hills() if values is None else values
    return write_raster(path, values, (WEST, CELL, 0.0, NORTH, 0.0, -CELL), crs, -9999.0)


def write_dem_in_degrees(path, latitude=60.0):
    """The hills with cells of 10 m at `latitude`, in EPSG:4326."""
    step = CELL / 111320.0
    width = step / math.cos(math.radians(latitude))
    return write_raster(path, hills(), (10.0, width, 0.0, latitude, 0.0, -step), 4326, -9999.0)


def write_points(path, rows, fields, crs=UTM, layer="points"):
    """rows: (x, y, {field: value}); fields: {name: ogr type}."""
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    made = source.CreateLayer(layer, reference(crs), ogr.wkbPoint)
    for name, kind in fields.items():
        made.CreateField(ogr.FieldDefn(name, kind))
    for x, y, values in rows:
        feature = ogr.Feature(made.GetLayerDefn())
        point = ogr.Geometry(ogr.wkbPoint)
        point.AddPoint_2D(x, y)
        feature.SetGeometry(point)
        for name, value in values.items():
            if value is not None:
                feature.SetField(name, value)
        made.CreateFeature(feature)
    source = None
    return path


def write_observers(path, heights=(1.7, 8.0), names=("tower a/b", "hut"), places=(FIRST, SECOND), crs=UTM):
    fields = {"name": ogr.OFTString, "eye": ogr.OFTReal, "reach": ogr.OFTReal}
    rows = [
        (*place, {"name": name, "eye": height, "reach": 60.0 * (number + 1)})
        for number, (place, name, height) in enumerate(zip(places, names, heights))
    ]
    return write_points(path, rows, fields, crs)


def write_terrain_types(path, kinds=("grassland", "craggy"), crs=UTM):
    """Two polygons: the western and the eastern half of the DEM."""
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(path))
    layer = source.CreateLayer("types", reference(crs), ogr.wkbPolygon)
    layer.CreateField(ogr.FieldDefn("kind", ogr.OFTString))
    east, south, middle = WEST + COLS * CELL, NORTH - ROWS * CELL, WEST + COLS * CELL / 2.0
    for kind, (left, right) in zip(kinds, ((WEST, middle), (middle, east))):
        ring = f"({left} {south}, {right} {south}, {right} {NORTH}, {left} {NORTH}, {left} {south})"
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(ogr.CreateGeometryFromWkt(f"POLYGON ({ring})"))
        feature.SetField("kind", kind)
        layer.CreateFeature(feature)
    source = None
    return path


def read(path):
    """(array, dataset) of a raster's first band."""
    dataset = gdal.Open(str(path))
    return dataset.ReadAsArray(), dataset


def rows_of(path, layer=0):
    """The features of a vector file as dictionaries."""
    source = ogr.Open(str(path))
    return [feature.items() for feature in source.GetLayer(layer)]
