<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="1" classificationMin="0" classificationMax="1" opacity="1" alphaBand="-1" nodataColor="">
      <rastershader>
        <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" clip="0" minimumValue="0" maximumValue="1" labelPrecision="2">
          <colorramp type="gradient" name="[source]">
            <Option type="Map">
              <Option name="color1" type="QString" value="68,1,84,0"/>
              <Option name="color2" type="QString" value="253,231,37,190"/>
              <Option name="discrete" type="QString" value="0"/>
              <Option name="rampType" type="QString" value="gradient"/>
              <Option name="stops" type="QString" value="0.02;70,8,92,190:0.25;59,82,139,190:0.5;33,145,140,190:0.75;94,201,98,190"/>
            </Option>
          </colorramp>
            <item value="0" label="0" color="#440154" alpha="0"/>
            <item value="0.02" label="0.02" color="#46085c" alpha="190"/>
            <item value="0.25" label="0.25" color="#3b528b" alpha="190"/>
            <item value="0.5" label="0.5" color="#21918c" alpha="190"/>
            <item value="0.75" label="0.75" color="#5ec962" alpha="190"/>
            <item value="1" label="1" color="#fde725" alpha="190"/>
        </colorrampshader>
      </rastershader>
    </rasterrenderer>
    <brightnesscontrast brightness="0" contrast="0" gamma="1"/>
    <huesaturation grayscaleMode="0" saturation="0" colorizeOn="0"/>
    <rasterresampler zoomedInResampler="" zoomedOutResampler="" maxOversampling="2"/>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
