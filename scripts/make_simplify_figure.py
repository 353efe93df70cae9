# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw docs/images/simplified_tin.png from a real run on the sample DEM.

    scripts/build.sh && PYTHONPATH=build/python /usr/bin/python3 scripts/make_simplify_figure.py

All triangles of a part of the DEM, and those that are enough to stay within TOLERANCE of it everywhere; shaded by their own slopes.
"""

import tempfile
from pathlib import Path

import maps
import numpy
import sightbound as sb
from osgeo import gdal
from qgis.core import QgsMeshDatasetIndex, QgsMeshLayer, QgsPointXY, QgsProject
from qgis.PyQt.QtGui import QColor

gdal.UseExceptions()

ROOT = Path(__file__).resolve().parent.parent
WINDOW = (741000, 4057000, 749000, 4064000)  # UTM zone 16 N
CELL = 80.0  # metres: about the sample's
TOLERANCE = 10.0
FINE = 20.0  # metres: cells of the shading


def run(folder):
    """The full and the simplified TIN, written as full.ply and few.ply."""
    dem = str(folder / "dem.tif")
    gdal.Warp(dem, str(ROOT / "sample_data" / "jacksboro.tif"), dstSRS="EPSG:32616", xRes=CELL, yRes=CELL, outputBounds=WINDOW,
              resampleAlg="cubic", outputType=gdal.GDT_Float32)
    full, few = sb.Tin.from_dem(sb.read_dem(dem)), sb.dem_to_tin(sb.read_dem(dem), tolerance=TOLERANCE)
    full.write(folder / "full.ply")
    few.write(folder / "few.ply")
    checked = sb.verify(full, few, tolerance=TOLERANCE)
    return len(full.faces), len(few.faces), checked.report["largest_deviation"]["bound"]


def edges(path, width):
    """The mesh's edges alone."""
    layer = QgsMeshLayer(str(path), path.stem, "mdal")
    settings = layer.rendererSettings()
    settings.setActiveScalarDatasetGroup(-1)
    lines = settings.nativeMeshSettings()
    lines.setEnabled(True)
    lines.setColor(QColor(40, 60, 110, 190))
    lines.setLineWidth(width)
    settings.setNativeMeshSettings(lines)
    layer.setRendererSettings(settings)
    QgsProject.instance().addMapLayer(layer)
    return layer


def shading(mesh, folder):
    """The surface of the mesh itself, on a fine grid, shaded."""
    mesh.updateTriangularMesh()
    left, bottom, right, top = (edge + shift * CELL for edge, shift in zip(WINDOW, (0.5, 0.5, -0.5, -0.5)))
    xs, ys = numpy.arange(left + FINE / 2, right, FINE), numpy.arange(top - FINE / 2, bottom, -FINE)
    heights = [[mesh.datasetValue(QgsMeshDatasetIndex(0, 0), QgsPointXY(x, y)).scalar() for x in xs] for y in ys]
    path = folder / f"{mesh.name()}.tif"
    out = gdal.GetDriverByName("GTiff").Create(str(path), len(xs), len(ys), 1, gdal.GDT_Float32)
    out.SetGeoTransform((left, FINE, 0, top, 0, -FINE))
    out.SetProjection(mesh.crs().toWkt())
    out.WriteArray(numpy.array(heights, numpy.float32))
    out.FlushCache()
    shade = gdal.DEMProcessing(str(folder / f"{mesh.name()}_shade.tif"), out, "hillshade", zFactor=1.6, computeEdges=True)
    shade.FlushCache()
    layer = maps.raster(folder / f"{mesh.name()}_shade.tif", mesh.name())
    layer.setOpacity(0.75)
    return layer


def main():
    application = maps.start()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        before, after, deviation = run(folder)
        full, few = edges(folder / "full.ply", 0.04), edges(folder / "few.ply", 0.12)
        maps.write_page(
            ROOT / "docs" / "images" / "simplified_tin.png", "",
            [
                maps.Panel([full, shading(full, folder)], f"The elevation model: {before:,} triangles"),
                maps.Panel([few, shading(few, folder)], f"Within {TOLERANCE:g} m everywhere: {after:,} triangles",
                           f"Largest deviation, certified and verified: {deviation:.3f} m. USGS, Jacksboro fault, Tennessee."),
            ],
            [], width_mm=220.0, legend_mm=0.0, window=(0.0, 0.0, 1.0, 1.0), bar_km=1.0)
        maps.stop(application)


if __name__ == "__main__":
    main()
