<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.40.6-Bratislava" styleCategories="Symbology3D">
 <renderer-3d type="vector">
  <vector-layer-3d-tiling show-bounding-boxes="0" zoom-levels-count="3"/>
  <symbol type="polygon" material_type="phong">
   <data rendered-facade="3" alt-clamping="absolute" add-back-faces="0" invert-normals="0" offset="0" extrusion-height="0" alt-binding="vertex" culling-mode="no-culling"/>
   <material shininess="0" opacity="1" kd="1" ambient="141,146,153,255,rgb:0.55294117647058827,0.5725490196078431,0.59999999999999998,1" diffuse="28,29,31,255,rgb:0.11058213168535896,0.11450370031280994,0.11999694819562066,1" ks="1" ka="1" specular="0,0,0,255,rgb:0,0,0,1">
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
