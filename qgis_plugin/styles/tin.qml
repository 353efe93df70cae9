<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <mesh-renderer-settings>
    <active-dataset-group scalar="0" vector="-1"/>
    <scalar-settings opacity="1" max-val="1" min-val="0" interpolation-method="none" group="0">
      <colorrampshader maximumValue="1" labelPrecision="2" clip="0" classificationMode="1" colorRampType="INTERPOLATED" minimumValue="0">
        <colorramp name="[source]" type="gradient">
          <Option type="Map">
            <Option name="color1" type="QString" value="47,107,79,255"/>
            <Option name="color2" type="QString" value="244,240,234,255"/>
            <Option name="discrete" type="QString" value="0"/>
            <Option name="rampType" type="QString" value="gradient"/>
            <Option name="stops" type="QString" value="0.25;143,176,106,255:0.5;227,217,161,255:0.75;185,138,90,255"/>
          </Option>
        </colorramp>
        <item label="0" color="#2f6b4f" alpha="255" value="0"/>
        <item label="0.25" color="#8fb06a" alpha="255" value="0.25"/>
        <item label="0.5" color="#e3d9a1" alpha="255" value="0.5"/>
        <item label="0.75" color="#b98a5a" alpha="255" value="0.75"/>
        <item label="1" color="#f4f0ea" alpha="255" value="1"/>
      </colorrampshader>
    </scalar-settings>
    <mesh-settings-native enabled="1" line-width="0.1" line-width-unit="MM" color="60,50,40,150"/>
    <mesh-settings-edge enabled="0" line-width="0.26" line-width-unit="MM" color="128,128,128,255"/>
    <mesh-settings-triangular enabled="0" line-width="0.26" line-width-unit="MM" color="128,128,128,255"/>
  </mesh-renderer-settings>
  <mesh-simplify-settings mesh-resolution="5" reduction-factor="10" enabled="0"/>
  <blendMode>0</blendMode>
</qgis>
