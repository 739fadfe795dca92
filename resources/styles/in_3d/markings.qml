<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.40.6-Bratislava" styleCategories="Symbology3D">
 <renderer-3d type="vector">
  <vector-layer-3d-tiling show-bounding-boxes="0" zoom-levels-count="3"/>
  <symbol type="polygon" material_type="phong">
   <data rendered-facade="3" alt-clamping="absolute" add-back-faces="0" invert-normals="0" offset="0.02" extrusion-height="0" alt-binding="vertex" culling-mode="no-culling"/>
   <material shininess="0" opacity="1" kd="1" ambient="255,255,255,255,rgb:1,1,1,1" diffuse="51,51,51,255,rgb:0.20000000000000001,0.20000000000000001,0.20000000000000001,1" ks="1" ka="1" specular="0,0,0,255,rgb:0,0,0,1">
    <data-defined-properties>
     <Option type="Map">
      <Option type="QString" value="" name="name"/>
      <Option name="properties"/>
      <Option type="QString" value="collection" name="type"/>
     </Option>
    </data-defined-properties>
   </material>
   <data-defined-properties>
    <Option type="Map">
     <Option type="QString" value="" name="name"/>
     <Option name="properties"/>
     <Option type="QString" value="collection" name="type"/>
    </Option>
   </data-defined-properties>
   <edges color="0,0,0,255,rgb:0,0,0,1" width="1" enabled="0"/>
  </symbol>
 </renderer-3d>
 <layerGeometryType>2</layerGeometryType>
</qgis>
