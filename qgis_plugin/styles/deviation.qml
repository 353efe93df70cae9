<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology|Labeling" labelsEnabled="1">
  <renderer-v2 type="RuleRenderer" symbollevels="1" enableorderby="0" forceraster="0">
    <rules key="deviation">
      <rule filter="&quot;kind&quot; = 'vertex'" label="deviation at a vertex (blue above, red below the original)" symbol="0" key="vertex"/>
      <rule filter="&quot;kind&quot; &lt;> 'vertex'" label="largest deviation, ratio, gap" symbol="1" key="extreme"/>
    </rules>
    <symbols>
      <symbol type="marker" name="0" alpha="1" clip_to_extent="1" force_rhr="0">
        <layer class="SimpleMarker" enabled="1" pass="0" locked="0">
          <prop k="color" v="200,200,200,255"/>
          <prop k="name" v="circle"/>
          <prop k="size" v="1.6"/>
          <prop k="size_unit" v="MM"/>
          <prop k="outline_color" v="255,255,255,128"/>
          <prop k="outline_style" v="solid"/>
          <prop k="outline_width" v="0.1"/>
          <prop k="outline_width_unit" v="MM"/>
          <data_defined_properties>
            <Option type="Map">
              <Option type="QString" name="name" value=""/>
              <Option type="Map" name="properties">
                <Option type="Map" name="fillColor">
                  <Option type="bool" name="active" value="true"/>
                  <Option type="QString" name="expression" value="ramp_color('RdBu', 0.5 + if(&quot;deviation_m&quot; > 0, 0.5, -0.5) * sqrt(abs(&quot;deviation_m&quot;) / maximum(abs(&quot;deviation_m&quot;))))"/>
                  <Option type="int" name="type" value="3"/>
                </Option>
              </Option>
              <Option type="QString" name="type" value="collection"/>
            </Option>
          </data_defined_properties>
        </layer>
      </symbol>
      <symbol type="marker" name="1" alpha="1" clip_to_extent="1" force_rhr="0">
        <layer class="SimpleMarker" enabled="1" pass="1" locked="0">
          <prop k="color" v="255,255,255,0"/>
          <prop k="name" v="circle"/>
          <prop k="size" v="4"/>
          <prop k="size_unit" v="MM"/>
          <prop k="outline_color" v="193,18,31,255"/>
          <prop k="outline_style" v="solid"/>
          <prop k="outline_width" v="0.6"/>
          <prop k="outline_width_unit" v="MM"/>
        </layer>
      </symbol>
    </symbols>
  </renderer-v2>
  <labeling type="simple">
    <settings>
      <text-style fieldName="if(&quot;kind&quot; = 'vertex', '', &quot;kind&quot;)" isExpression="1" fontSize="8" fontSizeUnit="Point" textColor="193,18,31,255" textOpacity="1" fontFamily="Sans">
        <text-buffer bufferDraw="1" bufferSize="0.8" bufferSizeUnits="MM" bufferColor="255,255,255,255"/>
      </text-style>
      <placement placement="0" dist="1.5" distUnits="MM"/>
      <rendering displayAll="1" obstacle="0"/>
    </settings>
  </labeling>
</qgis>
