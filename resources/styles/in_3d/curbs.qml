<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.40.6-Bratislava" styleCategories="Symbology3D">
 <renderer-3d type="vector">
  <vector-layer-3d-tiling show-bounding-boxes="0" zoom-levels-count="3"/>
  <symbol type="polygon" material_type="phong">
   <data rendered-facade="3" alt-clamping="absolute" add-back-faces="0" invert-normals="0" offset="0" extrusion-height="0" alt-binding="vertex" culling-mode="no-culling"/>
   <material shininess="0" opacity="1" kd="1" ambient="216,210,196,255,rgb:0.84705882352941175,0.82352941176470584,0.7686274509803922,1" diffuse="43,42,39,255,rgb:0.16940566109712368,0.16470588235294117,0.15371938658731976,1" ks="1" ka="1" specular="0,0,0,255,rgb:0,0,0,1">
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
     <Option type="Map" name="properties">
      <Option type="Map" name="extrusionHeight">
       <Option type="bool" value="true" name="active"/>
       <Option type="QString" value="height_m" name="field"/>
       <Option type="int" value="2" name="type"/>
      </Option>
     </Option>
     <Option type="QString" value="collection" name="type"/>
    </Option>
   </data-defined-properties>
   <edges color="0,0,0,255,rgb:0,0,0,1" width="1" enabled="0"/>
  </symbol>
 </renderer-3d>
 <layerGeometryType>2</layerGeometryType>
</qgis>
