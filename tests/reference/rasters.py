# SPDX-License-Identifier: GPL-3.0-or-later
"""Writers of the raster files that DEMs come in, traps included. Each returns the path as text.

Only GDAL's Python bindings and plain bytes are used; heights are what the file stores, in the file's own row order.
"""
from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pyproj
from osgeo import gdal, osr

gdal.UseExceptions()

GDAL_TYPES = {"uint8": gdal.GDT_Byte, "int16": gdal.GDT_Int16, "uint16": gdal.GDT_UInt16, "int32": gdal.GDT_Int32, "uint32": gdal.GDT_UInt32,
              "float32": gdal.GDT_Float32, "float64": gdal.GDT_Float64}


def wkt_of(crs):
    """GDAL's WKT of anything pyproj takes; '' for None."""
    if crs is None:
        return ""
    reference = osr.SpatialReference()
    reference.SetFromUserInput(crs if isinstance(crs, str) else pyproj.CRS.from_user_input(crs).to_wkt())
    return reference.ExportToWkt()


def memory(values, gt, crs=None, nodata=None, scale=None, offset=None, unit=None):
    """A GDAL dataset in memory."""
    values = np.asarray(values)
    rows, cols = values.shape
    dataset = gdal.GetDriverByName("MEM").Create("", cols, rows, 1, GDAL_TYPES[values.dtype.name])
    dataset.SetGeoTransform(gt)
    if crs is not None:
        dataset.SetProjection(wkt_of(crs))
    _describe(dataset.GetRasterBand(1), nodata, scale, offset, unit)
    dataset.GetRasterBand(1).WriteArray(values)
    return dataset


def geotiff(path, values, gt=None, crs=None, nodata=None, scale=None, offset=None, unit=None, options=(), bands=1):
    """`bands` > 1: the values are the last band, the others are zero."""
    values = np.asarray(values)
    rows, cols = values.shape
    dataset = gdal.GetDriverByName("GTiff").Create(str(path), cols, rows, bands, GDAL_TYPES[values.dtype.name], list(options))
    if gt is not None:
        dataset.SetGeoTransform(gt)
    if crs is not None:
        dataset.SetProjection(wkt_of(crs))
    band = dataset.GetRasterBand(bands)
    _describe(band, nodata, scale, offset, unit)
    band.WriteArray(values)
    band = dataset = None
    return str(path)


def copy(path, driver, values, gt, crs=None, nodata=None, unit=None, options=()):
    """Through another of GDAL's drivers."""
    made = gdal.GetDriverByName(driver).CreateCopy(str(path), memory(values, gt, crs, nodata, unit=unit), 0, list(options))
    made = None
    return str(path)


def _describe(band, nodata, scale, offset, unit):
    if nodata is not None:
        gdal.PushErrorHandler("CPLQuietErrorHandler")   # values that the type cannot hold are meant
        try:
            band.SetNoDataValue(float(nodata))
        finally:
            gdal.PopErrorHandler()
    if scale is not None:
        band.SetScale(scale)
    if offset is not None:
        band.SetOffset(offset)
    if unit is not None:
        band.SetUnitType(unit)


def with_mask(path, values, gt, crs, valid):
    """GeoTIFF whose holes are told by a mask band."""
    gdal.SetConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES")
    dataset = gdal.GetDriverByName("GTiff").Create(str(path), values.shape[1], values.shape[0], 1, GDAL_TYPES[values.dtype.name])
    dataset.SetGeoTransform(gt)
    dataset.SetProjection(wkt_of(crs))
    dataset.CreateMaskBand(gdal.GMF_PER_DATASET)
    dataset.GetRasterBand(1).WriteArray(values)
    dataset.GetRasterBand(1).GetMaskBand().WriteArray(np.uint8(valid) * 255)
    dataset = None
    gdal.SetConfigOption("GDAL_TIFF_INTERNAL_MASK", None)
    return str(path)


def ascii_grid(path, values, x, y, cell, nodata=-9999, prj=None):
    """ESRI ASCII grid, by hand: lower left corner, rows from the north."""
    rows, cols = values.shape
    head = f"ncols {cols}\nnrows {rows}\nxllcorner {x}\nyllcorner {y}\ncellsize {cell}\nNODATA_value {nodata}\n"
    Path(path).write_text(head + "\n".join(" ".join(f"{v:.9g}" for v in row) for row in values) + "\n")
    if prj is not None:
        Path(path).with_suffix(".prj").write_text(pyproj.CRS.from_user_input(prj).to_wkt("WKT1_ESRI"))
    return str(path)


def bil(path, values, x, y, cell, nodata=-9999, prj=None):
    """Band-interleaved int16 with an .hdr beside it, by hand: centre of the upper left cell."""
    rows, cols = values.shape
    Path(path).write_bytes(np.asarray(values, "<i2").tobytes())
    Path(path).with_suffix(".hdr").write_text(
        f"BYTEORDER I\nLAYOUT BIL\nNROWS {rows}\nNCOLS {cols}\nNBANDS 1\nNBITS 16\nPIXELTYPE SIGNEDINT\nULXMAP {x}\nULYMAP {y}\n"
        f"XDIM {cell}\nYDIM {cell}\nNODATA {nodata}\n")
    if prj is not None:
        Path(path).with_suffix(".prj").write_text(pyproj.CRS.from_user_input(prj).to_wkt("WKT1_ESRI"))
    return str(path)


def zipped_hgt(folder, latitude, longitude, values):
    """One 3" SRTM tile (1201 x 1201, big-endian int16) in a zip; returns GDAL's path into it."""
    name = f"{'N' if latitude >= 0 else 'S'}{abs(latitude):02d}{'E' if longitude >= 0 else 'W'}{abs(longitude):03d}"
    archive = Path(folder) / f"{name}.hgt.zip"
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        out.writestr(f"{name}.hgt", np.asarray(values, ">i2").tobytes())
    return f"/vsizip/{archive}/{name}.hgt"


def dted(path, values, longitude, latitude):
    """DTED level 0: 121 x 121 posts from the south-west corner (longitude, latitude) over one degree; rows from the north."""
    step = 1 / 120
    return copy(path, "DTED", np.int16(values), (longitude - step / 2, step, 0, latitude + 1 + step / 2, 0, -step), "EPSG:4326")


def truncated(path, share=0.5):
    """Cuts the file's end off."""
    data = Path(path).read_bytes()
    Path(path).write_bytes(data[: int(len(data) * share)])
    return str(path)
