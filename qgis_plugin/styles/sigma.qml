<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="1" classificationMin="0" classificationMax="1" opacity="1" alphaBand="-1" nodataColor="">
      <rastershader>
        <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" clip="0" minimumValue="0" maximumValue="1" labelPrecision="2">
          <colorramp type="gradient" name="[source]">
            <Option type="Map">
              <Option name="color1" type="QString" value="0,34,78,220"/>
              <Option name="color2" type="QString" value="254,232,56,220"/>
              <Option name="discrete" type="QString" value="0"/>
              <Option name="rampType" type="QString" value="gradient"/>
              <Option name="stops" type="QString" value="0.25;67,78,108,220:0.5;125,124,120,220:0.75;188,174,108,220"/>
            </Option>
          </colorramp>
            <item value="0" label="0" color="#00224e" alpha="220"/>
            <item value="0.25" label="0.25" color="#434e6c" alpha="220"/>
            <item value="0.5" label="0.5" color="#7d7c78" alpha="220"/>
            <item value="0.75" label="0.75" color="#bcae6c" alpha="220"/>
            <item value="1" label="1" color="#fee838" alpha="220"/>
        </colorrampshader>
      </rastershader>
    </rasterrenderer>
    <brightnesscontrast brightness="0" contrast="0" gamma="1"/>
    <huesaturation grayscaleMode="0" saturation="0" colorizeOn="0"/>
    <rasterresampler zoomedInResampler="" zoomedOutResampler="" maxOversampling="2"/>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
