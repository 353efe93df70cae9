<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="1" classificationMin="0" classificationMax="1" opacity="1" alphaBand="-1" nodataColor="">
      <rastershader>
        <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" clip="0" minimumValue="0" maximumValue="1" labelPrecision="2">
          <colorramp type="gradient" name="[source]">
            <Option type="Map">
              <Option name="color1" type="QString" value="253,231,169,0"/>
              <Option name="color2" type="QString" value="20,14,54,220"/>
              <Option name="discrete" type="QString" value="0"/>
              <Option name="rampType" type="QString" value="gradient"/>
              <Option name="stops" type="QString" value="0.02;253,222,160,126:0.1;254,191,132,150:0.25;250,129,95,195:0.5;192,58,118,220:0.75;104,28,129,220"/>
            </Option>
          </colorramp>
            <item value="0" label="0" color="#fde7a9" alpha="0"/>
            <item value="0.02" label="0.02" color="#fddea0" alpha="126"/>
            <item value="0.1" label="0.1" color="#febf84" alpha="150"/>
            <item value="0.25" label="0.25" color="#fa815f" alpha="195"/>
            <item value="0.5" label="0.5" color="#c03a76" alpha="220"/>
            <item value="0.75" label="0.75" color="#681c81" alpha="220"/>
            <item value="1" label="1" color="#140e36" alpha="220"/>
        </colorrampshader>
      </rastershader>
    </rasterrenderer>
    <brightnesscontrast brightness="0" contrast="0" gamma="1"/>
    <huesaturation grayscaleMode="0" saturation="0" colorizeOn="0"/>
    <rasterresampler zoomedInResampler="" zoomedOutResampler="" maxOversampling="2"/>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
