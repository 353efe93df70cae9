<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="1" classificationMin="0" classificationMax="1" opacity="1" alphaBand="-1" nodataColor="">
      <rastershader>
        <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" clip="0" minimumValue="0" maximumValue="1" labelPrecision="2">
          <colorramp type="gradient" name="[source]">
            <Option type="Map">
              <Option name="color1" type="QString" value="68,1,84,0"/>
              <Option name="color2" type="QString" value="253,231,37,200"/>
              <Option name="discrete" type="QString" value="0"/>
              <Option name="rampType" type="QString" value="gradient"/>
              <Option name="stops" type="QString" value="0.005;68,1,84,110:0.1;72,36,117,132:0.2;65,68,135,139:0.3;53,95,141,146:0.4;42,120,142,153:0.5;33,145,140,160:0.6;34,168,132,167:0.7;68,191,112,174:0.8;122,209,81,181:0.9;189,223,38,188"/>
            </Option>
          </colorramp>
            <item value="0" label="surely hidden" color="#440154" alpha="0"/>
            <item value="0.005" label="0.5 %" color="#440154" alpha="110"/>
            <item value="0.1" label="10 %" color="#482475" alpha="132"/>
            <item value="0.2" label="20 %" color="#414487" alpha="139"/>
            <item value="0.3" label="30 %" color="#355f8d" alpha="146"/>
            <item value="0.4" label="40 %" color="#2a788e" alpha="153"/>
            <item value="0.5" label="50 %" color="#21918c" alpha="160"/>
            <item value="0.6" label="60 %" color="#22a884" alpha="167"/>
            <item value="0.7" label="70 %" color="#44bf70" alpha="174"/>
            <item value="0.8" label="80 %" color="#7ad151" alpha="181"/>
            <item value="0.9" label="90 %" color="#bddf26" alpha="188"/>
            <item value="1" label="surely visible" color="#fde725" alpha="200"/>
          <rampLegendSettings useContinuousLegend="1" orientation="2" direction="0" minimumLabel="0: surely hidden" maximumLabel="1: surely visible" prefix="" suffix="">
            <numericFormat id="basic"><Option type="Map"/></numericFormat>
          </rampLegendSettings>
        </colorrampshader>
      </rastershader>
    </rasterrenderer>
    <brightnesscontrast brightness="0" contrast="0" gamma="1"/>
    <huesaturation grayscaleMode="0" saturation="0" colorizeOn="0"/>
    <rasterresampler zoomedInResampler="" zoomedOutResampler="" maxOversampling="2"/>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
