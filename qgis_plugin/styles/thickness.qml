<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="1" classificationMin="0" classificationMax="1" opacity="1" alphaBand="-1" nodataColor="">
      <rastershader>
        <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" clip="0" minimumValue="0" maximumValue="1" labelPrecision="2">
          <colorramp type="gradient" name="[source]">
            <Option type="Map">
              <Option name="color1" type="QString" value="255,255,255,0"/>
              <Option name="color2" type="QString" value="47,43,95,235"/>
              <Option name="discrete" type="QString" value="0"/>
              <Option name="rampType" type="QString" value="gradient"/>
              <Option name="stops" type="QString" value="0.02;223,230,240,150:0.25;179,194,218,190:0.5;130,147,184,215:0.75;91,98,148,225"/>
            </Option>
          </colorramp>
            <item value="0" label="0" color="#ffffff" alpha="0"/>
            <item value="0.02" label="0.02" color="#dfe6f0" alpha="150"/>
            <item value="0.25" label="0.25" color="#b3c2da" alpha="190"/>
            <item value="0.5" label="0.5" color="#8293b8" alpha="215"/>
            <item value="0.75" label="0.75" color="#5b6294" alpha="225"/>
            <item value="1" label="1" color="#2f2b5f" alpha="235"/>
        </colorrampshader>
      </rastershader>
    </rasterrenderer>
    <brightnesscontrast brightness="0" contrast="0" gamma="1"/>
    <huesaturation grayscaleMode="0" saturation="0" colorizeOn="0"/>
    <rasterresampler zoomedInResampler="" zoomedOutResampler="" maxOversampling="2"/>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
