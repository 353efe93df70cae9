<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology|Symbology3D">
  <renderer-3d type="mesh">
    <symbol type="mesh">
      <data alt-clamping="absolute" height="0" add-back-faces="1"/>
      <material ambient="124,138,170,255" diffuse="150,164,196,255" specular="40,40,40,255" shininess="0" opacity="0.55"/>
      <advanced-settings renderer-3d-enabled="1" texture-type="0" texture-single-color="130,147,184,140" smoothed-triangle="1" wireframe-enabled="0" wireframe-line-width="1" wireframe-line-color="128,128,128,255" level-of-detail="-99" vertical-scale="1" vertical-group-index="0" vertical-relative="0" arrows-enabled="0" arrows-spacing="25" arrows-fixed-size="0" min-color-ramp-shader="0" max-color-ramp-shader="1">
      <colorrampshader maximumValue="1" labelPrecision="2" clip="0" classificationMode="1" colorRampType="INTERPOLATED" minimumValue="0">
        <colorramp name="[source]" type="gradient">
          <Option type="Map">
            <Option name="color1" type="QString" value="47,43,95,215"/>
            <Option name="color2" type="QString" value="223,230,240,110"/>
            <Option name="discrete" type="QString" value="0"/>
            <Option name="rampType" type="QString" value="gradient"/>
            <Option name="stops" type="QString" value="0.25;91,98,148,200:0.5;130,147,184,180:0.75;179,194,218,150"/>
          </Option>
        </colorramp>
        <item label="0" color="#2f2b5f" alpha="215" value="0"/>
        <item label="0.25" color="#5b6294" alpha="200" value="0.25"/>
        <item label="0.5" color="#8293b8" alpha="180" value="0.5"/>
        <item label="0.75" color="#b3c2da" alpha="150" value="0.75"/>
        <item label="1" color="#dfe6f0" alpha="110" value="1"/>
      </colorrampshader>
      </advanced-settings>
    </symbol>
  </renderer-3d>
  <mesh-renderer-settings>
    <active-dataset-group scalar="1" vector="-1"/>
    <scalar-settings opacity="1" max-val="1" min-val="0" interpolation-method="none" group="1">
      <colorrampshader maximumValue="1" labelPrecision="2" clip="0" classificationMode="1" colorRampType="INTERPOLATED" minimumValue="0">
        <colorramp name="[source]" type="gradient">
          <Option type="Map">
            <Option name="color1" type="QString" value="47,43,95,215"/>
            <Option name="color2" type="QString" value="223,230,240,110"/>
            <Option name="discrete" type="QString" value="0"/>
            <Option name="rampType" type="QString" value="gradient"/>
            <Option name="stops" type="QString" value="0.25;91,98,148,200:0.5;130,147,184,180:0.75;179,194,218,150"/>
          </Option>
        </colorramp>
        <item label="0" color="#2f2b5f" alpha="215" value="0"/>
        <item label="0.25" color="#5b6294" alpha="200" value="0.25"/>
        <item label="0.5" color="#8293b8" alpha="180" value="0.5"/>
        <item label="0.75" color="#b3c2da" alpha="150" value="0.75"/>
        <item label="1" color="#dfe6f0" alpha="110" value="1"/>
      </colorrampshader>
    </scalar-settings>
    <mesh-settings-native enabled="0" line-width="0.26" line-width-unit="MM" color="128,128,128,255"/>
    <mesh-settings-edge enabled="0" line-width="0.26" line-width-unit="MM" color="128,128,128,255"/>
    <mesh-settings-triangular enabled="0" line-width="0.26" line-width-unit="MM" color="128,128,128,255"/>
  </mesh-renderer-settings>
  <mesh-simplify-settings mesh-resolution="5" reduction-factor="10" enabled="0"/>
  <blendMode>0</blendMode>
</qgis>
