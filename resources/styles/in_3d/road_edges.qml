<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.40.6-Bratislava" styleCategories="Symbology3D">
 <renderer-3d type="vector">
  <vector-layer-3d-tiling show-bounding-boxes="0" zoom-levels-count="3"/>
  <symbol type="line" material_type="simpleline">
   <data alt-clamping="absolute" width="2" simple-lines="1" offset="0.02" extrusion-height="0" alt-binding="vertex"/>
   <material ambient="38,40,43,255,rgb:0.14901960784313725,0.15686274509803921,0.16862745098039217,1">
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
