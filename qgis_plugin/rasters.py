# SPDX-License-Identifier: GPL-3.0-or-later
"""Raster layers become paths that the core can open. Main thread only, but for open_dem."""

from dataclasses import dataclass

from osgeo import gdal, osr
from qgis.core import QgsCoordinateReferenceSystem, QgsProcessingUtils, QgsRectangle

from .errors import bad_input, core_errors
from .text import tr
from .values import given


@dataclass
class Raster:
    path: str
    band: int
    crs: QgsCoordinateReferenceSystem
    extent: QgsRectangle
    cell: float  # the smaller side of a cell, in units of the CRS


def read_raster(algorithm, parameters, name, context, feedback, band_name=None):
    """What the core needs of a raster parameter; None if it was left empty."""
    if not given(parameters, name):
        return None
    layer = algorithm.parameterAsRasterLayer(parameters, name, context)
    if layer is None or not layer.isValid():
        raise bad_input(name, tr("the raster {} cannot be read.").format(parameters[name]))
    path = _path(layer, name)
    band = 1
    if band_name and given(parameters, band_name):
        band = algorithm.parameterAsInt(parameters, band_name, context)
    if not 1 <= band <= layer.bandCount():
        raise bad_input(
            band_name or name, tr("there is no band {}; the raster has {}.").format(band, layer.bandCount())
        )
    cell = min(abs(layer.rasterUnitsPerPixelX()), abs(layer.rasterUnitsPerPixelY()))
    path = _with_crs_of(layer, path, name, feedback)
    algorithm.paths[path] = name
    return Raster(path, band, layer.crs(), layer.extent(), cell)


def open_dem(sightbound, raster, vertical_unit, feedback):
    """The core's Dem; what it assumed or converted goes to the log. Any thread."""
    with core_errors("INPUT"):
        dem = sightbound.read_dem(raster.path, band=raster.band, vertical_unit=vertical_unit)
    for note in dem.notes:
        feedback.pushInfo(note)
    return dem


def read_extent(algorithm, parameters, context, dem):
    """EXTENT as (xmin, ymin, xmax, ymax) in the CRS of the DEM; None if it was left empty."""
    if not given(parameters, "EXTENT"):
        return None
    asked = algorithm.parameterAsExtent(parameters, "EXTENT", context, dem.crs)
    if asked.isEmpty() or not asked.intersects(dem.extent):
        raise bad_input("EXTENT", tr("it does not meet the extent of INPUT; check its CRS."))
    return asked.xMinimum(), asked.yMinimum(), asked.xMaximum(), asked.yMaximum()


def _path(layer, name):
    if layer.dataProvider().name() != "gdal":
        kind = layer.dataProvider().name()
        remedy = tr("save it as a GeoTIFF (Export > Save As) and use that.")
        raise bad_input(name, tr("the layer comes from {}, not from a file; {}").format(kind, remedy))
    path = layer.source().split("|option:")[0]
    if path.startswith(("MEM:", "/vsimem/")):
        remedy = tr("save it as a GeoTIFF (Export > Save As) and use that.")
        raise bad_input(name, tr("the layer lies in memory; {}").format(remedy))
    return path


def _with_crs_of(layer, path, name, feedback):
    """The path itself, or that of a small VRT when the user gave the layer another CRS than the file states."""
    if not layer.crs().isValid():
        return path
    stated = gdal.Open(path)
    if stated is None:
        raise bad_input(name, tr("GDAL cannot open {}.").format(path))
    if same_ground(stated.GetSpatialRef(), layer.crs()):
        return path
    wkt = _wkt(layer.crs())
    feedback.pushInfo(tr("{}: the CRS set in QGIS ({}) is used.").format(name, layer.crs().authid() or wkt))
    copy = QgsProcessingUtils.generateTempFilename(f"{name.lower()}.vrt")
    gdal.Translate(copy, stated, format="VRT", outputSRS=wkt)
    return copy


def same_ground(stated, crs):
    """Does a file's CRS (as GDAL has it) equal that of a layer, heights aside?"""
    if stated is None or not crs.isValid():
        return stated is None and not crs.isValid()
    pair = [stated.Clone(), osr.SpatialReference(_wkt(crs))]
    for system in pair:
        if system.IsCompound():
            system.StripVertical()
    options = ["IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", "CRITERION=EQUIVALENT"]
    return bool(pair[0].IsSame(pair[1], options))


def _wkt(crs):
    return crs.toWkt(QgsCoordinateReferenceSystem.WktVariant.WKT_PREFERRED_GDAL)


def creation_options(algorithm, parameters, context):
    """`KEY=VALUE` strings from the text that the dialog makes (KEY=VALUE|KEY=VALUE)."""
    if not given(parameters, "CREATION_OPTIONS"):
        return None
    options = [
        one for one in algorithm.parameterAsString(parameters, "CREATION_OPTIONS", context).split("|") if one
    ]
    for option in options:
        if "=" not in option:
            raise bad_input(
                "CREATION_OPTIONS",
                tr("{!r} is no KEY=VALUE; write for example COMPRESS=ZSTD|ZLEVEL=9.").format(option),
            )
    return options
