<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology|Symbology3D">
  <renderer-v2 type="nullSymbol"/>
  <renderer-3d type="rulebased" layer="">
    <vector-layer-3d-tiling show-bounding-boxes="0" zoom-levels-count="3"/>
    <rules key="{fog}">
      <rule key="{surely}" description="surely hidden" filter="p &lt; 0.05">
        <symbol type="polygon" material_type="phong">
          <data alt-clamping="absolute" alt-binding="vertex" height="0" extrusion-height="0" culling-mode="no-culling" add-back-faces="0" invert-normals="0" rendered-facade="0"/>
          <material ambient="42,46,67,255" diffuse="84,92,134,255" specular="0,0,0,255" shininess="0" opacity="0.6"/>
          <edges enabled="1" width="1" color="84,92,134,255"/>
        </symbol>
      </rule>
      <rule key="{likely}" description="rather hidden" filter="p &gt;= 0.05 AND p &lt; 0.5">
        <symbol type="polygon" material_type="phong">
          <data alt-clamping="absolute" alt-binding="vertex" height="0" extrusion-height="0" culling-mode="no-culling" add-back-faces="0" invert-normals="0" rendered-facade="0"/>
          <material ambient="64,69,88,255" diffuse="128,138,176,255" specular="0,0,0,255" shininess="0" opacity="0.45"/>
          <edges enabled="1" width="1" color="128,138,176,255"/>
        </symbol>
      </rule>
      <rule key="{maybe}" description="in doubt" filter="p &gt;= 0.5">
        <symbol type="polygon" material_type="phong">
          <data alt-clamping="absolute" alt-binding="vertex" height="0" extrusion-height="0" culling-mode="no-culling" add-back-faces="0" invert-normals="0" rendered-facade="0"/>
          <material ambient="93,98,111,255" diffuse="186,197,222,255" specular="0,0,0,255" shininess="0" opacity="0.3"/>
          <edges enabled="1" width="1" color="186,197,222,255"/>
        </symbol>
      </rule>
    </rules>
  </renderer-3d>
</qgis>
