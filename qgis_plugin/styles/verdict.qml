<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="paletted" band="1" opacity="1" alphaBand="-1" nodataColor="">
      <colorPalette>
        <paletteEntry value="2" label="visible" color="#0072b2" alpha="190"/>
        <paletteEntry value="1" label="uncertain" color="#f0a30a" alpha="190"/>
        <paletteEntry value="0" label="hidden" color="#3b3b3b" alpha="60"/>
      </colorPalette>
    </rasterrenderer>
    <brightnesscontrast brightness="0" contrast="0" gamma="1"/>
    <huesaturation grayscaleMode="0" saturation="0" colorizeOn="0"/>
    <rasterresampler zoomedInResampler="" zoomedOutResampler="" maxOversampling="2"/>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
