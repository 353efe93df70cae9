# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw docs/images/fog.png and docs/images/hidden_volume.png from a real run on the sample DEM.

    scripts/build.sh && PYTHONPATH=build/python xvfb-run -a /usr/bin/python3 scripts/make_volume_figures.py

Two sentries on towers look over the middle of the sample; all places up to 100 m above ground are asked. The fog is drawn by a 3D map in
a layout: this needs OpenGL, hence a display (llvmpipe under Xvfb will do). QGIS 3.22 draws the fog as a net of lines of one
pixel; drawn FINE times as large and reduced, it is what the eye sees on a screen from some way off.
"""

import os
import sys
import tempfile
from pathlib import Path

os.environ["QT_QPA_PLATFORM"] = "xcb"

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import maps
import numpy
import sightbound as sb
from osgeo import gdal, ogr
from qgis._3d import (
    Qgs3D,
    Qgs3DMapSettings,
    QgsCameraPose,
    QgsLayoutItem3DMap,
    QgsPhongMaterialSettings,
    QgsPoint3DSymbol,
    QgsVectorLayer3DRenderer,
)
from qgis.core import (
    QgsLayout,
    QgsLayoutExporter,
    QgsLayoutPoint,
    QgsLayoutSize,
    QgsMeshLayer,
    QgsProject,
    QgsReadWriteContext,
    QgsVector3D,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtGui import QColor, QMatrix4x4
from qgis.PyQt.QtXml import QDomDocument
from qgis_plugin.styling import stretch_ramp

gdal.UseExceptions()
ogr.UseExceptions()

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
STYLES = ROOT / "qgis_plugin" / "styles"
SENTRIES = ("Fire tower", "Northern spur")
EYE_HEIGHT = 15.0
WINDOW = (739000, 4053000, 754000, 4067000)  # UTM zone 16 N
CELL = 80.0  # metres: about the sample's
CEILING, SPACING = 100.0, 50.0
FINE = 3

SCENE = """<qgis3d>
  <terrain exaggeration="1" texture-size="1024" max-terrain-error="1" max-ground-error="1" terrain-rendering-enabled="1">
    <generator type="dem" layer="{dem}" resolution="32" skirt-height="80"/>
  </terrain>
  <lights><directional-lights>
    <directional-light x="0.5" y="-0.8" z="0.3" color="255,255,255,255" intensity="1"/>
  </directional-lights></lights>
</qgis3d>"""


def run(folder):
    """Rasters, mesh, fog and sentries in `folder`; what the run tells."""
    sample = str(ROOT / "sample_data" / "jacksboro.tif")
    dem = str(folder / "dem.tif")
    gdal.Warp(dem, sample, dstSRS="EPSG:32616", xRes=CELL, yRes=CELL, outputBounds=WINDOW, resampleAlg="cubic",
              outputType=gdal.GDT_Float32)
    sentries = str(folder / "sentries.gpkg")
    gdal.VectorTranslate(sentries, str(ROOT / "sample_data" / "observers.gpkg"), dstSRS="EPSG:32616", reproject=True,
                         where=f"name IN {SENTRIES}")
    source = ogr.Open(sentries)
    places = [(f.GetGeometryRef().GetX(), f.GetGeometryRef().GetY()) for f in source.GetLayer(0)]
    volume = sb.ErrorVolume.build(sb.read_dem(dem))
    # Of voxels as large as these (8 m) little is surely seen whole near the ground.
    hidden = sb.volume_viewshed(
        volume, places, view_height=EYE_HEIGHT, target_ceiling=CEILING, target_spacing=SPACING, holds_for="place"
    )
    hidden.write(height=folder / "height.tif", thickness=folder / "thickness.tif", core_thickness=folder / "core.tif",
                 top=folder / "top.ply", fog=folder / "fog.gpkg")
    return hidden


def coloured_relief(folder):
    """The terrain as it is draped over itself: colours by height, shaded."""
    ramp = folder / "ramp.txt"
    ramp.write_text("0% 122 148 96\n35% 176 182 122\n65% 190 160 112\n100% 236 226 208\n")
    dem = gdal.Open(str(folder / "dem.tif"))
    colours = gdal.DEMProcessing(str(folder / "colours.tif"), dem, "color-relief", colorFilename=str(ramp))
    shade = gdal.DEMProcessing(str(folder / "shade.tif"), dem, "hillshade", zFactor=1.5, computeEdges=True)
    light = 0.5 + 0.7 * shade.ReadAsArray() / 255.0
    path = str(folder / "relief.tif")
    relief = gdal.GetDriverByName("GTiff").CreateCopy(path, colours)
    relief.WriteArray(numpy.clip(colours.ReadAsArray() * light, 0, 255).astype(numpy.uint8))
    return path


def styled(layer, style):
    if not layer.isValid():
        raise OSError(f"{layer.source()} cannot be read")
    message, ok = layer.loadNamedStyle(str(STYLES / f"{style}.qml"))
    if not ok:
        raise OSError(message)
    QgsProject.instance().addMapLayer(layer)
    return layer


def stand_up(sentries):
    """Sentries as red balls over the terrain."""
    symbol = QgsPoint3DSymbol()
    symbol.setShape(QgsPoint3DSymbol.Shape.Sphere)
    symbol.setShapeProperties({"radius": 130.0})
    material = QgsPhongMaterialSettings()
    material.setDiffuse(QColor("#d53e4f"))
    material.setAmbient(QColor("#801020"))
    symbol.setMaterial(material)
    above = QMatrix4x4()
    above.translate(0.0, 130.0, 0.0)
    symbol.setTransform(above)
    sentries.setRenderer3D(QgsVectorLayer3DRenderer(symbol))


def draw_fog(path, dem, layers, distance, pitch, heading):
    """A 3D map of the layers over the DEM, as PNG."""
    project = QgsProject.instance()
    project.setCrs(dem.crs())
    scene = QDomDocument()
    scene.setContent(SCENE.format(dem=dem.id()))
    settings = Qgs3DMapSettings()
    settings.readXml(scene.documentElement(), QgsReadWriteContext())
    settings.setCrs(dem.crs())
    settings.setTransformContext(project.transformContext())
    settings.resolveReferences(project)
    centre = dem.extent().center()
    settings.setOrigin(QgsVector3D(centre.x(), centre.y(), 0.0))
    settings.setBackgroundColor(QColor("white"))
    settings.setLayers(layers)

    layout = QgsLayout(project)
    layout.initializeDefaults()
    size = QgsLayoutSize(200.0, 92.0, maps.MM)
    layout.pageCollection().page(0).setPageSize(size)
    view = QgsLayoutItem3DMap(layout)
    layout.addLayoutItem(view)
    view.attemptMove(QgsLayoutPoint(0.0, 0.0, maps.MM))
    view.attemptResize(size)
    view.setMapSettings(settings)
    camera = QgsCameraPose()
    camera.setCenterPoint(QgsVector3D(0.0, 400.0, 0.0))
    camera.setDistanceFromCenterPoint(distance)
    camera.setPitchAngle(pitch)
    camera.setHeadingAngle(heading)
    view.setCameraPose(camera)
    image = QgsLayoutExporter(layout).renderPageToImage(0, QSize(), maps.DPI * FINE)
    image = image.scaled(image.size() / FINE, Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation)
    if not image.save(str(path)):
        raise OSError(f"{path} cannot be written")


def draw_maps(path, folder, hidden, sentries, relief):
    """The rasters and the top of the hidden volume as QGIS shows them when they are loaded."""
    thickness = maps.raster(folder / "thickness.tif", "Hidden, metres above ground", STYLES / "thickness.qml")
    core = maps.raster(folder / "core.tif", "Surely hidden", STYLES / "thickness.qml")
    height = maps.raster(folder / "height.tif", "Lowest visible height (m)", STYLES / "height.qml")
    for layer in (thickness, core, height):
        stretch_ramp(layer, 0.98)
    top = styled(QgsMeshLayer(str(folder / "top.ply"), "Hidden volume: least p", "mdal"), "fog")
    area = hidden.area(1.8)
    share = 100.0 / area["asked_m2"]
    maps.write_page(
        path,
        "",
        [
            maps.Panel([sentries, height, relief], "Lowest visible height",
                       f"Surely seen from this height on; nothing up to {CEILING:.0f} m is where the map is bare."),
            maps.Panel([sentries, thickness, relief], "Thickness of the hidden layer",
                       f"{share * area['hidden_m2']:.0f} % of the ground hides a man, {share * area['core_m2']:.0f} % surely."),
            maps.Panel([sentries, top, relief], "Top of the hidden volume", "The darker, the surer hidden."),
        ],
        [sentries, height, thickness],
    )


def main():
    application = maps.start(window=True)
    Qgs3D.initialize()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(scratch)
        hidden = run(folder)
        dem = maps.raster(folder / "dem.tif", "Terrain")
        relief = maps.raster(coloured_relief(folder), "Relief")
        fog = styled(QgsVectorLayer(str(folder / "fog.gpkg"), "Fog", "ogr"), "fog_net")
        sentries = maps.points(folder / "sentries.gpkg", "Sentries", "name")
        stand_up(sentries)
        draw_fog(IMAGES / "fog.png", dem, [sentries, fog, relief], 12500.0, 62.0, 20.0)
        draw_maps(IMAGES / "hidden_volume.png", folder, hidden, sentries, relief)
    sys.stdout.flush()
    os._exit(0)  # Qt's 3D threads do not always end


if __name__ == "__main__":
    main()
