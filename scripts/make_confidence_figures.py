# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw docs/images/probable_viewshed.png, intervisibility.png and error_report.png from runs of the QGIS algorithms.

    scripts/build.sh && PYTHONPATH=build/python:build/qgis_plugins /usr/bin/python3 scripts/make_confidence_figures.py

The terrain is the sample DEM. The error report is that of its means over 3 x 3 samples, with some of the samples as
check points; QtWebKit, which comes with QGIS, renders it.
"""

import shutil
import tempfile
from pathlib import Path

import maps
from osgeo import gdal, ogr
from qgis.core import QgsProcessingContext, QgsProcessingFeedback, QgsProject
from qgis.PyQt.QtCore import QEventLoop, QSize, Qt, QUrl
from qgis.PyQt.QtGui import QImage, QPainter
from qgis.PyQt.QtWebKitWidgets import QWebPage

gdal.UseExceptions()
ogr.UseExceptions()

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
DEM = ROOT / "sample_data" / "jacksboro.tif"
FOOTER = "Terrain: U.S. Geological Survey, public domain. Its error was estimated from the DEM itself."
TOWER = "-84.2725,36.62583 [EPSG:4326]"  # the sample's fire tower
TOWER_HEIGHT, TARGET_HEIGHT = 15.0, 2.0
WINDOW = (0.15, 0.25, 0.95, 0.975)  # what the maps of the viewshed show of the DEM
MAST_HEIGHT = 12.0
MEANS_OVER = 3  # samples along a side
CHECKED = 7  # one sample in so many along a side is a check point
REPORT_WIDTH, HEADLINE = 940, 50  # pixels


def run(provider, name, **parameters):
    context = QgsProcessingContext()
    context.setProject(QgsProject.instance())
    results, done = provider.algorithm(name).create().run(parameters, context, QgsProcessingFeedback())
    if not done:
        raise RuntimeError(f"{name} stopped")
    return results


def draw_probable_viewshed(provider, folder, relief):
    from sightbound_qgis.styling import class_claims, style_path

    files = {"OUTPUT": str(folder / "p.tif"), "OUTPUT_VERDICT": str(folder / "verdict.tif")}
    results = run(provider, "probableviewshed", INPUT=str(DEM), OBSERVER=TOWER, OBSERVER_HEIGHT=TOWER_HEIGHT,
                  TARGET_HEIGHT=TARGET_HEIGHT, **files)
    probability = maps.raster(files["OUTPUT"], "Probability of being seen", style_path("confidence"))
    class_claims(probability, 0.95)
    verdict = maps.raster(files["OUTPUT_VERDICT"], "Verdict at 95 %", style_path("verdict"))
    areas = {word: results[f"AREA_{word.upper()}"] / 1e6 for word in ("expected", "visible", "uncertain", "hidden")}
    maps.write_page(
        IMAGES / "probable_viewshed.png", "",
        [
            maps.Panel([probability, relief], "Probability P",
                       "To be expected visible: {expected:.0f} km².".format(**areas)),
            maps.Panel([verdict, relief], "Verdict", "Visible {visible:.0f} km², uncertain {uncertain:.0f} km², "
                       "hidden {hidden:.0f} km².".format(**areas)),
        ],
        [probability, verdict], window=WINDOW, width_mm=270.0, legend_mm=72.0,
        footer=f"Eye {TOWER_HEIGHT:g} m, targets {TARGET_HEIGHT:g} m above ground; 3″ cells. {FOOTER}")


def draw_network(provider, folder, relief):
    from sightbound_qgis.styling import style_path

    # A copy, for QGIS writes into a GeoPackage even when it only reads.
    masts = shutil.copy(ROOT / "sample_data" / "observers.gpkg", folder)
    files = {"OUTPUT": str(folder / "links.gpkg"), "OUTPUT_CRITICAL": str(folder / "critical.gpkg")}
    run(provider, "intervisibility", INPUT=str(DEM), POINTS_A=masts, FIELD_A="name", HEIGHT_A=MAST_HEIGHT,
        PROBABILITY=True, **files)
    links = maps.vector(files["OUTPUT"], "Lines of sight", style_path("lines"))
    critical = maps.vector(files["OUTPUT_CRITICAL"], "Critical places", style_path("critical"))
    maps.label(links, "'P = ' || format_number(probability, 2)")
    places = maps.points(masts, "Mast", "name")
    maps.write_page(
        IMAGES / "intervisibility.png", "",
        [maps.Panel([places, critical, links, relief], "Which masts see each other?",
                    f"Masts of {MAST_HEIGHT:g} m; P: the whole line is clear.")],
        [places, links, critical], width_mm=190.0, footer=FOOTER)


def draw_report(provider, folder):
    page = folder / "error.html"
    coarse, checks = coarse_dem_and_checks(folder)
    run(provider, "estimateerror", INPUT=coarse, CHECKPOINTS=checks, OUTPUT_HTML=str(page))
    rendered(page, up_to="pre").save(str(IMAGES / "error_report.png"))


def coarse_dem_and_checks(folder):
    """Paths of the means, and of the samples that check them."""
    source = gdal.Open(str(DEM))
    left, width, _, top, _, height = source.GetGeoTransform()
    samples = source.ReadAsArray()
    rows, cols = (size // MEANS_OVER for size in samples.shape)
    blocks = samples[: MEANS_OVER * rows, : MEANS_OVER * cols].reshape(rows, MEANS_OVER, cols, MEANS_OVER)
    out = gdal.GetDriverByName("GTiff").Create(str(folder / "coarse.tif"), cols, rows, 1, gdal.GDT_Float32)
    out.SetGeoTransform((left, MEANS_OVER * width, 0, top, 0, MEANS_OVER * height))
    out.SetProjection(source.GetProjection())
    out.WriteArray(blocks.mean(axis=(1, 3)))
    checks = ogr.GetDriverByName("GPKG").CreateDataSource(str(folder / "checks.gpkg"))
    layer = checks.CreateLayer("checks", source.GetSpatialRef(), ogr.wkbPoint25D)
    for row in range(CHECKED, samples.shape[0] - CHECKED, CHECKED):
        for col in range(CHECKED, samples.shape[1] - CHECKED, CHECKED):
            point, feature = ogr.Geometry(ogr.wkbPoint25D), ogr.Feature(layer.GetLayerDefn())
            point.AddPoint(left + (col + 0.5) * width, top + (row + 0.5) * height, float(samples[row, col]))
            feature.SetGeometry(point)
            layer.CreateFeature(feature)
    return out.GetDescription(), checks.GetDescription()


def rendered(path, up_to):
    """A page up to the first element `up_to` and its headline."""
    page, waiting = QWebPage(), QEventLoop()
    page.setViewportSize(QSize(REPORT_WIDTH, 1000))
    page.loadFinished.connect(waiting.quit)
    page.mainFrame().load(QUrl.fromLocalFile(str(path)))
    waiting.exec()
    end = page.mainFrame().findFirstElement(up_to).geometry().top()
    size = QSize(REPORT_WIDTH, end - HEADLINE)
    page.setViewportSize(size)
    page.mainFrame().setScrollBarPolicy(Qt.Orientation.Vertical, Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    image = QImage(size, QImage.Format.Format_RGB32)
    image.fill(0xFFFFFF)
    painter = QPainter(image)
    page.mainFrame().render(painter)
    painter.end()
    return image


def main():
    application = maps.start(window=True)
    from sightbound_qgis.plugin import SightboundPlugin

    plugin = SightboundPlugin(None)
    plugin.initProcessing()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        relief = maps.hillshade(DEM, folder)
        draw_probable_viewshed(plugin.provider, folder, relief)
        draw_network(plugin.provider, folder, relief)
        draw_report(plugin.provider, folder)
        plugin.unload()
        maps.stop(application)


if __name__ == "__main__":
    main()
