# SPDX-License-Identifier: GPL-3.0-or-later
"""A tolerance for each vertex of a TIN: from a raster, or from an attribute of the vertices. Any thread."""

import math

import numpy
from osgeo import gdal, osr

from .errors import bad_input
from .text import tr


def of_raster(raster, tin):
    """Bilinear between the middles of the raster's cells, which may lie in any CRS."""
    name = "TOLERANCE_RASTER"
    data = gdal.Open(raster.path)
    across, down = _cells(data, _in_crs_of(data, tin, name))
    inside = (across >= 0) & (down >= 0) & (across < data.RasterXSize) & (down < data.RasterYSize)
    if not inside.any():
        raise bad_input(name, tr("it does not lie under the TIN; check its CRS."))
    # Beyond the middles of the outermost cells their values hold.
    across = numpy.clip(across - 0.5, 0, data.RasterXSize - 1)
    down = numpy.clip(down - 0.5, 0, data.RasterYSize - 1)
    col, row = (numpy.floor(numpy.minimum(one, most - 1)).clip(0).astype(int)
                for one, most in ((across, data.RasterXSize - 1), (down, data.RasterYSize - 1)))
    values, first_col, first_row = _read(data, raster.band, col[inside], row[inside])
    last_row, last_col = values.shape[0] - 1, values.shape[1] - 1
    found = numpy.full(len(across), math.nan)
    right, below = (across - col)[inside], (down - row)[inside]
    c, r = col[inside] - first_col, row[inside] - first_row
    total = numpy.zeros(len(c))
    for dr, of_row in ((0, 1 - below), (1, below)):
        for dc, of_col in ((0, 1 - right), (1, right)):
            weight = of_row * of_col
            here = values[numpy.minimum(r + dr, last_row), numpy.minimum(c + dc, last_col)]
            total += numpy.where(weight > 0, weight * here, 0.0)
    found[inside] = total
    return _whole(found, name, tr("it has no value"))


def of_attribute(name, tin):
    """The attribute of that name, which joined vertices and triangulated points keep."""
    values = tin.vertex_attributes.get(name)
    if values is None:
        there = ", ".join(sorted(tin.vertex_attributes)) or tr("none")
        raise bad_input("TOLERANCE_FIELD", tr("the vertices have no attribute {!r}; they have: {}.").format(name, there))
    return _whole(numpy.asarray(values, dtype=float), "TOLERANCE_FIELD", tr("it is empty"))


def _whole(values, name, what):
    empty = int(numpy.isnan(values).sum())
    if empty:
        raise bad_input(name, tr("{} at {} of {} vertices of the TIN.").format(what, empty, len(values)))
    if (values < 0).any():
        raise bad_input(name, tr("it is negative ({:g}) somewhere; give metres.").format(values.min()))
    return values


def _in_crs_of(data, tin, name):
    """x and y of the vertices in the raster's CRS."""
    x, y = tin.vertices[:, 0], tin.vertices[:, 1]
    theirs = data.GetSpatialRef()
    if theirs is None or not tin.crs_wkt:
        if theirs is None and not tin.crs_wkt:
            return x, y
        raise bad_input(name, tr("either it or the TIN has no CRS; set it in the layer's properties."))
    ours = osr.SpatialReference(tin.crs_wkt)
    for system in (ours, theirs):
        system.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        if system.IsCompound():
            system.StripVertical()
    if ours.IsSame(theirs):
        return x, y
    moved = osr.CoordinateTransformation(ours, theirs).TransformPoints(numpy.column_stack([x, y]).tolist())
    return numpy.array([one[0] for one in moved]), numpy.array([one[1] for one in moved])


def _cells(data, places):
    """Columns and rows, counted from the raster's corner."""
    x, y = places
    back = gdal.InvGeoTransform(data.GetGeoTransform())
    return back[0] + back[1] * x + back[2] * y, back[3] + back[4] * x + back[5] * y


def _read(data, band, cols, rows):
    """The part of the raster that is needed, nodata as NaN, and where it begins."""
    first_col, first_row = int(cols.min()), int(rows.min())
    width = min(int(cols.max()) + 2, data.RasterXSize) - first_col
    height = min(int(rows.max()) + 2, data.RasterYSize) - first_row
    source = data.GetRasterBand(band)
    values = source.ReadAsArray(first_col, first_row, width, height).astype(float)
    nothing = source.GetMaskBand().ReadAsArray(first_col, first_row, width, height) == 0
    values[nothing] = math.nan
    scale, offset = source.GetScale(), source.GetOffset()
    return values * (1.0 if scale is None else scale) + (offset or 0.0), first_col, first_row
