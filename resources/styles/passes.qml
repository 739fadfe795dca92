<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis simplifyDrawingTol="1" labelsEnabled="0" simplifyLocal="1" autoRefreshMode="Disabled" simplifyDrawingHints="1" simplifyAlgorithm="0" autoRefreshTime="0" simplifyMaxScale="1" symbologyReferenceScale="-1" minScale="2500" version="3.40.6-Bratislava" styleCategories="Symbology|Labeling|Rendering" hasScaleBasedVisibilityFlag="1" maxScale="0">
 <renderer-v2 type="singleSymbol" referencescale="-1" enableorderby="0" forceraster="0" symbollevels="0">
  <symbols>
   <symbol type="line" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="0">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="SimpleLine" enabled="1" id="{146a9030-64a0-5e74-8006-a2687845973b}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="align_dash_pattern" value="0"/>
      <Option type="QString" name="capstyle" value="flat"/>
      <Option type="QString" name="customdash" value="5;1;0.6;1"/>
      <Option type="QString" name="customdash_map_unit_scale" value="3x:0,0,0,0,0,0"/>
      <Option type="QString" name="customdash_unit" value="MM"/>
      <Option type="QString" name="dash_pattern_offset" value="0"/>
      <Option type="QString" name="dash_pattern_offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
      <Option type="QString" name="dash_pattern_offset_unit" value="MM"/>
      <Option type="QString" name="draw_inside_polygon" value="0"/>
      <Option type="QString" name="joinstyle" value="round"/>
      <Option type="QString" name="line_color" value="122,31,61,255,rgb:0.47843137254901963,0.12156862745098039,0.23921568627450981,1"/>
      <Option type="QString" name="line_style" value="solid"/>
      <Option type="QString" name="line_width" value="0.12"/>
      <Option type="QString" name="line_width_unit" value="MM"/>
      <Option type="QString" name="offset" value="0"/>
      <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
      <Option type="QString" name="offset_unit" value="MM"/>
      <Option type="QString" name="ring_filter" value="0"/>
      <Option type="QString" name="trim_distance_end" value="0"/>
      <Option type="QString" name="trim_distance_end_map_unit_scale" value="3x:0,0,0,0,0,0"/>
      <Option type="QString" name="trim_distance_end_unit" value="MM"/>
      <Option type="QString" name="trim_distance_start" value="0"/>
      <Option type="QString" name="trim_distance_start_map_unit_scale" value="3x:0,0,0,0,0,0"/>
      <Option type="QString" name="trim_distance_start_unit" value="MM"/>
      <Option type="QString" name="tweak_dash_pattern_on_corners" value="0"/>
      <Option type="QString" name="use_custom_dash" value="1"/>
      <Option type="QString" name="width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option type="Map" name="properties">
        <Option type="Map" name="outlineWidth">
         <Option type="bool" name="active" value="true"/>
         <Option type="QString" name="expression" value="if(@map_scale > 1200, 0.072, 0.12)"/>
         <Option type="int" name="type" value="3"/>
        </Option>
       </Option>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
    </layer>
    <layer class="GeometryGenerator" enabled="1" id="{9647e196-ee87-55e0-af24-6b91054cf6d5}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Line"/>
      <Option type="QString" name="geometryModifier" value="if(&quot;end_m&quot; - &quot;station_m&quot; = maximum(&quot;end_m&quot; - &quot;station_m&quot;, group_by:=&quot;road&quot;), collect_geometries(array_foreach(generate_series(if(@map_scale &lt;= 1100, 10, 50) * ceil(&quot;station_m&quot; / if(@map_scale &lt;= 1100, 10, 50)), &quot;end_m&quot;, if(@map_scale &lt;= 1100, 10, 50)), with_variable('along', length($geometry) * if(&quot;direction&quot; = -1, &quot;end_m&quot; - @element, @element - &quot;station_m&quot;) / (&quot;end_m&quot; - &quot;station_m&quot;), make_line(project(line_interpolate_point($geometry, @along), 0.8 * @map_scale / 1000 * if(@element % 50 = 0, 2, 1), radians(line_interpolate_angle($geometry, @along) + 90)), project(line_interpolate_point($geometry, @along), 0.8 * @map_scale / 1000 * if(@element % 50 = 0, 2, 1), radians(line_interpolate_angle($geometry, @along) + -90)))))), null)"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="line" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@0@1">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleLine" enabled="1" id="{5db30d87-f0c0-5ced-a47b-449256d1a3a0}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="align_dash_pattern" value="0"/>
        <Option type="QString" name="capstyle" value="flat"/>
        <Option type="QString" name="customdash" value="5;2"/>
        <Option type="QString" name="customdash_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="customdash_unit" value="MM"/>
        <Option type="QString" name="dash_pattern_offset" value="0"/>
        <Option type="QString" name="dash_pattern_offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="dash_pattern_offset_unit" value="MM"/>
        <Option type="QString" name="draw_inside_polygon" value="0"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="line_color" value="122,31,61,255,rgb:0.47843137254901963,0.12156862745098039,0.23921568627450981,1"/>
        <Option type="QString" name="line_style" value="solid"/>
        <Option type="QString" name="line_width" value="0.15"/>
        <Option type="QString" name="line_width_unit" value="MM"/>
        <Option type="QString" name="offset" value="0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="ring_filter" value="0"/>
        <Option type="QString" name="trim_distance_end" value="0"/>
        <Option type="QString" name="trim_distance_end_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="trim_distance_end_unit" value="MM"/>
        <Option type="QString" name="trim_distance_start" value="0"/>
        <Option type="QString" name="trim_distance_start_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="trim_distance_start_unit" value="MM"/>
        <Option type="QString" name="tweak_dash_pattern_on_corners" value="0"/>
        <Option type="QString" name="use_custom_dash" value="0"/>
        <Option type="QString" name="width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option type="Map" name="properties">
          <Option type="Map" name="outlineWidth">
           <Option type="bool" name="active" value="true"/>
           <Option type="QString" name="expression" value="if(@map_scale > 1200, 0.09, 0.15)"/>
           <Option type="int" name="type" value="3"/>
          </Option>
         </Option>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
    <layer class="GeometryGenerator" enabled="1" id="{06b12cf4-4087-5cba-80b6-52390fb09168}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Marker"/>
      <Option type="QString" name="geometryModifier" value="if(&quot;end_m&quot; - &quot;station_m&quot; = maximum(&quot;end_m&quot; - &quot;station_m&quot;, group_by:=&quot;road&quot;), collect_geometries(array_foreach(generate_series(if(@map_scale &lt;= 300, 10, 50) * ceil(&quot;station_m&quot; / if(@map_scale &lt;= 300, 10, 50)), &quot;end_m&quot;, if(@map_scale &lt;= 300, 10, 50)), with_variable('along', length($geometry) * if(&quot;direction&quot; = -1, &quot;end_m&quot; - @element, @element - &quot;station_m&quot;) / (&quot;end_m&quot; - &quot;station_m&quot;), project(line_interpolate_point($geometry, @along), 4 * @map_scale / 1000, radians(line_interpolate_angle($geometry, @along) + 90))))), null)"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="marker" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@0@2">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="FontMarker" enabled="1" id="{3434d835-01c5-5a08-a4c9-67276686f050}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="angle" value="0"/>
        <Option type="QString" name="chr" value="0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="font" value="Open Sans"/>
        <Option type="QString" name="font_style" value=""/>
        <Option type="QString" name="horizontal_anchor_point" value="1"/>
        <Option type="QString" name="joinstyle" value="miter"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="outline_width" value="0.6"/>
        <Option type="QString" name="outline_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="size" value="2"/>
        <Option type="QString" name="size_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="size_unit" value="MM"/>
        <Option type="QString" name="vertical_anchor_point" value="1"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option type="Map" name="properties">
          <Option type="Map" name="angle">
           <Option type="bool" name="active" value="true"/>
           <Option type="QString" name="expression" value="with_variable('element', array_get(generate_series(if(@map_scale &lt;= 300, 10, 50) * ceil(&quot;station_m&quot; / if(@map_scale &lt;= 300, 10, 50)), &quot;end_m&quot;, if(@map_scale &lt;= 300, 10, 50)), @geometry_part_num - 1), with_variable('along', length($geometry) * if(&quot;direction&quot; = -1, &quot;end_m&quot; - @element, @element - &quot;station_m&quot;) / (&quot;end_m&quot; - &quot;station_m&quot;), line_interpolate_angle($geometry, @along))) + if(with_variable('azimuth', with_variable('element', array_get(generate_series(if(@map_scale &lt;= 300, 10, 50) * ceil(&quot;station_m&quot; / if(@map_scale &lt;= 300, 10, 50)), &quot;end_m&quot;, if(@map_scale &lt;= 300, 10, 50)), @geometry_part_num - 1), with_variable('along', length($geometry) * if(&quot;direction&quot; = -1, &quot;end_m&quot; - @element, @element - &quot;station_m&quot;) / (&quot;end_m&quot; - &quot;station_m&quot;), line_interpolate_angle($geometry, @along))), @azimuth > 91 and @azimuth &lt; 271), 180, 0)"/>
           <Option type="int" name="type" value="3"/>
          </Option>
          <Option type="Map" name="char">
           <Option type="bool" name="active" value="true"/>
           <Option type="QString" name="expression" value="with_variable('s', array_get(generate_series(if(@map_scale &lt;= 300, 10, 50) * ceil(&quot;station_m&quot; / if(@map_scale &lt;= 300, 10, 50)), &quot;end_m&quot;, if(@map_scale &lt;= 300, 10, 50)), @geometry_part_num - 1), concat(floor(@s / 1000), '+', lpad(to_string(@s % 1000), 3, '0')))"/>
           <Option type="int" name="type" value="3"/>
          </Option>
         </Option>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
      <layer class="FontMarker" enabled="1" id="{7fea4923-e631-5e46-8ff7-629fa322c995}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="angle" value="0"/>
        <Option type="QString" name="chr" value="0"/>
        <Option type="QString" name="color" value="122,31,61,255,rgb:0.47843137254901963,0.12156862745098039,0.23921568627450981,1"/>
        <Option type="QString" name="font" value="Open Sans"/>
        <Option type="QString" name="font_style" value=""/>
        <Option type="QString" name="horizontal_anchor_point" value="1"/>
        <Option type="QString" name="joinstyle" value="miter"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="122,31,61,255,rgb:0.47843137254901963,0.12156862745098039,0.23921568627450981,1"/>
        <Option type="QString" name="outline_width" value="0"/>
        <Option type="QString" name="outline_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="size" value="2"/>
        <Option type="QString" name="size_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="size_unit" value="MM"/>
        <Option type="QString" name="vertical_anchor_point" value="1"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option type="Map" name="properties">
          <Option type="Map" name="angle">
           <Option type="bool" name="active" value="true"/>
           <Option type="QString" name="expression" value="with_variable('element', array_get(generate_series(if(@map_scale &lt;= 300, 10, 50) * ceil(&quot;station_m&quot; / if(@map_scale &lt;= 300, 10, 50)), &quot;end_m&quot;, if(@map_scale &lt;= 300, 10, 50)), @geometry_part_num - 1), with_variable('along', length($geometry) * if(&quot;direction&quot; = -1, &quot;end_m&quot; - @element, @element - &quot;station_m&quot;) / (&quot;end_m&quot; - &quot;station_m&quot;), line_interpolate_angle($geometry, @along))) + if(with_variable('azimuth', with_variable('element', array_get(generate_series(if(@map_scale &lt;= 300, 10, 50) * ceil(&quot;station_m&quot; / if(@map_scale &lt;= 300, 10, 50)), &quot;end_m&quot;, if(@map_scale &lt;= 300, 10, 50)), @geometry_part_num - 1), with_variable('along', length($geometry) * if(&quot;direction&quot; = -1, &quot;end_m&quot; - @element, @element - &quot;station_m&quot;) / (&quot;end_m&quot; - &quot;station_m&quot;), line_interpolate_angle($geometry, @along))), @azimuth > 91 and @azimuth &lt; 271), 180, 0)"/>
           <Option type="int" name="type" value="3"/>
          </Option>
          <Option type="Map" name="char">
           <Option type="bool" name="active" value="true"/>
           <Option type="QString" name="expression" value="with_variable('s', array_get(generate_series(if(@map_scale &lt;= 300, 10, 50) * ceil(&quot;station_m&quot; / if(@map_scale &lt;= 300, 10, 50)), &quot;end_m&quot;, if(@map_scale &lt;= 300, 10, 50)), @geometry_part_num - 1), concat(floor(@s / 1000), '+', lpad(to_string(@s % 1000), 3, '0')))"/>
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
 <layerGeometryType>1</layerGeometryType>
</qgis>
