<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.40.6-Bratislava" styleCategories="Symbology3D">
 <renderer-3d type="vector">
  <vector-layer-3d-tiling show-bounding-boxes="0" zoom-levels-count="3"/>
  <symbol type="line" material_type="simpleline">
   <data alt-clamping="absolute" width="2" simple-lines="1" offset="0.050000001" extrusion-height="0" alt-binding="vertex"/>
   <material ambient="21,84,176,255,rgb:0.08235294117647059,0.32941176470588235,0.69019607843137254,1">
    <data-defined-properties>
     <Option type="Map">
      <Option type="QString" value="" name="name"/>
      <Option name="properties"/>
      <Option type="QString" value="collection" name="type"/>
     </Option>
    </data-defined-properties>
   </material>
  </symbol>
 </renderer-3d>
 <layerGeometryType>1</layerGeometryType>
</qgis>
