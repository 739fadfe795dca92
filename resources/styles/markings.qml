<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis simplifyDrawingTol="1" labelsEnabled="0" simplifyLocal="1" autoRefreshMode="Disabled" simplifyDrawingHints="1" simplifyAlgorithm="0" autoRefreshTime="0" simplifyMaxScale="1" symbologyReferenceScale="-1" minScale="2000" version="3.40.6-Bratislava" styleCategories="Symbology|Labeling|Rendering" hasScaleBasedVisibilityFlag="1" maxScale="0">
 <renderer-v2 type="singleSymbol" referencescale="-1" enableorderby="0" forceraster="0" symbollevels="0">
  <symbols>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="0">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{2b575d78-03cc-5018-a46c-21514d987a4f}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="CASE WHEN coalesce(&quot;class&quot;, '') &lt;> 'arrow' THEN with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25))) ELSE with_variable('g', make_valid($geometry), with_variable('signs', array('Polygon ((0.24 0, -0.24 0, -0.24 0.62, -1 0.62, 0 1, 1 0.62, 0.24 0.62, 0.24 0))', 'Polygon ((-0.2 0, 0.2 0, 0.2 0.62, -0.39 0.79, -0.12 0.93, -1 1, -0.76 0.6, -0.59 0.69, -0.2 0.55, -0.2 0))', 'Polygon ((0.2 0, -0.2 0, -0.2 0.62, 0.39 0.79, 0.12 0.93, 1 1, 0.76 0.6, 0.59 0.69, 0.2 0.55, 0.2 0))', 'MULTIPolygon (((0.16 0, 0.16 0.4, 0.16 0.64, 0.42 0.64, 0 1, -0.42 0.64, -0.16 0.64, -0.16 0.53, -0.5 0.66, -0.62 0.54, -0.16 0.33, -0.16 0, 0.16 0)), ((-0.38 0.82, -1 0.8, -0.74 0.48, -0.38 0.82)))', 'MULTIPolygon (((-0.16 0, -0.16 0.4, -0.16 0.64, -0.42 0.64, 0 1, 0.42 0.64, 0.16 0.64, 0.16 0.53, 0.5 0.66, 0.62 0.54, 0.16 0.33, 0.16 0, -0.16 0)), ((0.38 0.82, 1 0.8, 0.74 0.48, 0.38 0.82)))', 'MULTIPolygon (((-0.16 0, -0.16 0.33, -0.62 0.54, -0.5 0.66, -0.16 0.53, -0.16 0.64, -0.42 0.64, 0 1, 0.42 0.64, 0.16 0.64, 0.16 0.53, 0.5 0.66, 0.62 0.54, 0.16 0.33, 0.16 0, -0.16 0)), ((-1 0.8, -0.38 0.82, -0.74 0.48, -1 0.8)), ((0.74 0.48, 0.38 0.82, 1 0.8, 0.74 0.48)))'), with_variable('turns', array_foreach(array(0, 180), eval('with_variable(''d'', main_angle(@g) + @element, with_variable(''h'', rotate(@g, -@d, centroid(@g)), @d + degrees(azimuth(centroid(intersection(@h, bounds(make_line(make_point(x_min(@h), y_min(@h)), make_point(x_max(@h), y_min(@h) + 0.2 * (y_max(@h) - y_min(@h))))))), centroid(intersection(@h, bounds(make_line(make_point(x_min(@h), y_min(@h) + 0.25 * (y_max(@h) - y_min(@h))), make_point(x_max(@h), y_min(@h) + 0.5 * (y_max(@h) - y_min(@h)))))))))))')), with_variable('laid', array_foreach(generate_series(0, 11), eval('with_variable(''t'', geom_from_wkt(@signs[@element % 6]), with_variable(''n'', rotate(@g, -@turns[@element // 6], centroid(@g)), with_variable(''s'', affine_transform(@t, 0, 0, 0, (x_max(@n) - x_min(@n)) / (x_max(@t) - x_min(@t)), y_max(@n) - y_min(@n)), rotate(translate(@s, x_min(@n) - x_min(@s), y_min(@n) - y_min(@s)), @turns[@element // 6], centroid(@g)))))')), with_variable('fits', array_foreach(@laid, area(intersection(@element, @g)) / area(combine(@element, @g))), CASE WHEN array_max(@fits) &gt; 0.55 THEN @laid[array_find(@fits, array_max(@fits))] ELSE eval('with_variable(''box'', oriented_bbox($geometry), if(area($geometry) &gt; 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))') END))))) END"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@0@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{051e74f4-ab20-5c24-abda-843c1ea95326}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="141,146,153,255,rgb:0.55294117647058827,0.5725490196078431,0.59999999999999998,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.06"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties" type="Map">
          <Option name="outlineWidth" type="Map">
           <Option type="bool" name="active" value="true"/>
           <Option type="QString" name="expression" value="if($id is null, 1, 0.06)"/>
           <Option type="int" name="type" value="3"/>
          </Option>
         </Option>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
  </symbols>
  <rotation/>
  <sizescale/>
  <data-defined-properties>
   <Option type="Map">
    <Option type="QString" name="name" value=""/>
    <Option name="properties"/>
    <Option type="QString" name="type" value="collection"/>
   </Option>
  </data-defined-properties>
 </renderer-v2>
 <selection mode="Default">
  <selectionColor invalid="1"/>
 </selection>
 <blendMode>0</blendMode>
 <featureBlendMode>0</featureBlendMode>
 <layerOpacity>1</layerOpacity>
 <layerGeometryType>2</layerGeometryType>
</qgis>
