<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis simplifyDrawingTol="1" maxScale="0" autoRefreshTime="0" simplifyLocal="1" symbologyReferenceScale="-1" styleCategories="Symbology|Labeling|Rendering" labelsEnabled="0" version="3.40.6-Bratislava" simplifyDrawingHints="1" simplifyMaxScale="1" simplifyAlgorithm="0" minScale="2000" autoRefreshMode="Disabled" hasScaleBasedVisibilityFlag="1">
 <renderer-v2 attr="class" referencescale="-1" forceraster="0" symbollevels="0" type="categorizedSymbol" enableorderby="0">
  <categories>
   <category symbol="0" label="Edge line" value="edge" uuid="{4b521581-8fd3-54f5-ae82-9d2d0433c34a}" type="string" render="true"/>
   <category symbol="1" label="Lane line" value="lane" uuid="{aef07399-7c69-567b-9aaa-a5211414e8e0}" type="string" render="true"/>
   <category symbol="2" label="Centre line" value="centre" uuid="{eb8abaa0-ff41-5c4b-a753-3282ba579ff3}" type="string" render="true"/>
   <category symbol="3" label="Zebra crossing" value="zebra" uuid="{8cbc01b6-4328-5cfb-acee-69bbb4770036}" type="string" render="true"/>
   <category symbol="4" label="Stop line" value="stop" uuid="{1eb2a098-98f5-55b1-82a6-e511a7a5220e}" type="string" render="true"/>
   <category symbol="5" label="Give-way line" value="give_way" uuid="{f672ecd5-b03a-59bf-a27d-dab32c788b0a}" type="string" render="true"/>
   <category symbol="6" label="Zigzag line" value="zigzag" uuid="{16d40e64-4f55-5335-a2f5-41dcafecd222}" type="string" render="true"/>
   <category symbol="7" label="Arrow" value="arrow" uuid="{cece5e9f-d4d5-5c69-9a20-085777903d20}" type="string" render="true"/>
   <category symbol="8" label="Bicycle symbol" value="bicycle" uuid="{ae85fbe6-f9c8-5418-8eb8-8069259cb016}" type="string" render="true"/>
   <category symbol="9" label="Word BUS" value="bus" uuid="{4c1d2a69-fa9a-569a-bf81-795c5d0ca778}" type="string" render="true"/>
   <category symbol="10" label="Symbol" value="symbol" uuid="{51ac9108-847d-5668-9235-9e2550d439a2}" type="string" render="true"/>
   <category symbol="11" label="Hatching" value="hatch" uuid="{1594fd82-ecdf-57f7-a5b0-13c69efe5c3e}" type="string" render="true"/>
   <category symbol="12" label="Other paint" value="" uuid="{b98b9de0-45fe-56db-a7a7-a14570be85b5}" type="string" render="true"/>
  </categories>
  <symbols>
   <symbol frame_rate="10" force_rhr="0" name="0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{2b575d78-03cc-5018-a46c-21514d987a4f}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@0@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{051e74f4-ab20-5c24-abda-843c1ea95326}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="1" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{f362f283-ff06-5228-bc91-38c80ce19d55}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@1@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{460bf586-5494-50d8-9c92-face2dc691b7}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="10" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{8a0349eb-71bb-59b4-9109-7ecf6f9d221e}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@10@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{6929254b-3c19-52bc-aa1c-0bc26451a3e6}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="11" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{bd55f7e3-18f5-55af-bcef-94bd54a6f5ab}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@11@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{78a5e2ec-6b66-511e-92f2-6841513704f0}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="12" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{82c5fb67-d0e6-5cfb-ba01-92de412b4a44}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@12@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{1f656f83-d64b-552f-b6f8-17cd15bbd5e3}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="2" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{bb1f2e30-e4eb-5d5a-bbc7-d7715a9d1b0d}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@2@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{5379093d-f2c0-5850-b983-1fafb2b45d5f}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="3" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{654ba08c-8066-5775-815f-70c24d4ce9ba}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@3@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{ef4d06d2-824e-5368-ae81-9f5ba8e010c3}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="4" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{a61cdd7a-0834-5dfd-bd04-8219bae1bc13}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@4@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{fce76b2f-51f2-5bf0-9d39-a582cd9532d6}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="5" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{8b4c07cf-4f6b-586a-b174-54d49d0a2627}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@5@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{29c42b47-e035-57eb-bf4b-ed06c1eb6a0e}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="6" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{7a588d76-d23a-50d8-b743-eb3096ae269a}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@6@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{d05158d3-ad12-59ba-ab31-92c5dcc27133}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="7" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{fd5b5394-39c9-5f70-9075-16f91b5e154d}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@7@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{b397648a-e036-5deb-8c80-90cb0c5e29a3}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="8" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{9680f3cd-5a5d-590c-aa6e-ed7c11a54ef4}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@8@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{9d48049e-826c-5ff7-803c-2ed630004659}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol frame_rate="10" force_rhr="0" name="9" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
    <data_defined_properties>
     <Option type="Map">
      <Option value="" name="name" type="QString"/>
      <Option name="properties"/>
      <Option value="collection" name="type" type="QString"/>
     </Option>
    </data_defined_properties>
    <layer id="{68948562-3742-53a8-a4dd-4b13643c9089}" locked="0" class="GeometryGenerator" enabled="1" pass="0">
     <Option type="Map">
      <Option value="Fill" name="SymbolType" type="QString"/>
      <Option value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))" name="geometryModifier" type="QString"/>
      <Option value="MapUnit" name="units" type="QString"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option value="" name="name" type="QString"/>
       <Option name="properties"/>
       <Option value="collection" name="type" type="QString"/>
      </Option>
     </data_defined_properties>
     <symbol frame_rate="10" force_rhr="0" name="@9@0" alpha="1" clip_to_extent="1" type="fill" is_animated="0">
      <data_defined_properties>
       <Option type="Map">
        <Option value="" name="name" type="QString"/>
        <Option name="properties"/>
        <Option value="collection" name="type" type="QString"/>
       </Option>
      </data_defined_properties>
      <layer id="{d9b33e75-ae6b-5797-acac-953f9c03dba2}" locked="0" class="SimpleFill" enabled="1" pass="0">
       <Option type="Map">
        <Option value="3x:0,0,0,0,0,0" name="border_width_map_unit_scale" type="QString"/>
        <Option value="255,255,255,255,rgb:1,1,1,1" name="color" type="QString"/>
        <Option value="round" name="joinstyle" type="QString"/>
        <Option value="0,0" name="offset" type="QString"/>
        <Option value="3x:0,0,0,0,0,0" name="offset_map_unit_scale" type="QString"/>
        <Option value="MM" name="offset_unit" type="QString"/>
        <Option value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1" name="outline_color" type="QString"/>
        <Option value="solid" name="outline_style" type="QString"/>
        <Option value="0.04" name="outline_width" type="QString"/>
        <Option value="MM" name="outline_width_unit" type="QString"/>
        <Option value="solid" name="style" type="QString"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option value="" name="name" type="QString"/>
         <Option name="properties"/>
         <Option value="collection" name="type" type="QString"/>
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
    <Option value="" name="name" type="QString"/>
    <Option name="properties"/>
    <Option value="collection" name="type" type="QString"/>
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
