<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis simplifyDrawingTol="1" labelsEnabled="0" simplifyLocal="1" autoRefreshMode="Disabled" simplifyDrawingHints="1" simplifyAlgorithm="0" autoRefreshTime="0" simplifyMaxScale="1" symbologyReferenceScale="-1" minScale="2000" version="3.40.6-Bratislava" styleCategories="Symbology|Labeling|Rendering" hasScaleBasedVisibilityFlag="1" maxScale="0">
 <renderer-v2 type="categorizedSymbol" referencescale="-1" enableorderby="0" attr="class" forceraster="0" symbollevels="0">
  <categories>
   <category type="string" symbol="0" uuid="{4b521581-8fd3-54f5-ae82-9d2d0433c34a}" value="edge" render="true" label="Edge line"/>
   <category type="string" symbol="1" uuid="{aef07399-7c69-567b-9aaa-a5211414e8e0}" value="lane" render="true" label="Lane line"/>
   <category type="string" symbol="2" uuid="{eb8abaa0-ff41-5c4b-a753-3282ba579ff3}" value="centre" render="true" label="Centre line"/>
   <category type="string" symbol="3" uuid="{8cbc01b6-4328-5cfb-acee-69bbb4770036}" value="zebra" render="true" label="Zebra crossing"/>
   <category type="string" symbol="4" uuid="{1eb2a098-98f5-55b1-82a6-e511a7a5220e}" value="stop" render="true" label="Stop line"/>
   <category type="string" symbol="5" uuid="{f672ecd5-b03a-59bf-a27d-dab32c788b0a}" value="give_way" render="true" label="Give-way line"/>
   <category type="string" symbol="6" uuid="{16d40e64-4f55-5335-a2f5-41dcafecd222}" value="zigzag" render="true" label="Zigzag line"/>
   <category type="string" symbol="7" uuid="{cece5e9f-d4d5-5c69-9a20-085777903d20}" value="arrow" render="true" label="Arrow"/>
   <category type="string" symbol="8" uuid="{ae85fbe6-f9c8-5418-8eb8-8069259cb016}" value="bicycle" render="true" label="Bicycle symbol"/>
   <category type="string" symbol="9" uuid="{4c1d2a69-fa9a-569a-bf81-795c5d0ca778}" value="bus" render="true" label="Word BUS"/>
   <category type="string" symbol="10" uuid="{51ac9108-847d-5668-9235-9e2550d439a2}" value="symbol" render="true" label="Symbol"/>
   <category type="string" symbol="11" uuid="{1594fd82-ecdf-57f7-a5b0-13c69efe5c3e}" value="hatch" render="true" label="Hatching"/>
   <category type="string" symbol="12" uuid="{b98b9de0-45fe-56db-a7a7-a14570be85b5}" value="" render="true" label="Other paint"/>
  </categories>
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
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
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
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="1">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{f362f283-ff06-5228-bc91-38c80ce19d55}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@1@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{460bf586-5494-50d8-9c92-face2dc691b7}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="10">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{8a0349eb-71bb-59b4-9109-7ecf6f9d221e}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@10@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{6929254b-3c19-52bc-aa1c-0bc26451a3e6}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="11">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{bd55f7e3-18f5-55af-bcef-94bd54a6f5ab}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@11@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{78a5e2ec-6b66-511e-92f2-6841513704f0}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="12">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{82c5fb67-d0e6-5cfb-ba01-92de412b4a44}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@12@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{1f656f83-d64b-552f-b6f8-17cd15bbd5e3}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="2">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{bb1f2e30-e4eb-5d5a-bbc7-d7715a9d1b0d}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@2@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{5379093d-f2c0-5850-b983-1fafb2b45d5f}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="3">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{654ba08c-8066-5775-815f-70c24d4ce9ba}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@3@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{ef4d06d2-824e-5368-ae81-9f5ba8e010c3}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="4">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{a61cdd7a-0834-5dfd-bd04-8219bae1bc13}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@4@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{fce76b2f-51f2-5bf0-9d39-a582cd9532d6}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="5">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{8b4c07cf-4f6b-586a-b174-54d49d0a2627}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@5@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{29c42b47-e035-57eb-bf4b-ed06c1eb6a0e}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="6">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{7a588d76-d23a-50d8-b743-eb3096ae269a}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@6@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{d05158d3-ad12-59ba-ab31-92c5dcc27133}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="7">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{fd5b5394-39c9-5f70-9075-16f91b5e154d}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('g', make_valid($geometry), with_variable('signs', array('Polygon ((0.24 0, -0.24 0, -0.24 0.62, -1 0.62, 0 1, 1 0.62, 0.24 0.62, 0.24 0))', 'Polygon ((-0.2 0, 0.2 0, 0.2 0.62, -0.39 0.79, -0.12 0.93, -1 1, -0.76 0.6, -0.59 0.69, -0.2 0.55, -0.2 0))', 'Polygon ((0.2 0, -0.2 0, -0.2 0.62, 0.39 0.79, 0.12 0.93, 1 1, 0.76 0.6, 0.59 0.69, 0.2 0.55, 0.2 0))', 'MULTIPolygon (((0.16 0, 0.16 0.4, 0.16 0.64, 0.42 0.64, 0 1, -0.42 0.64, -0.16 0.64, -0.16 0.53, -0.5 0.66, -0.62 0.54, -0.16 0.33, -0.16 0, 0.16 0)), ((-0.38 0.82, -1 0.8, -0.74 0.48, -0.38 0.82)))', 'MULTIPolygon (((-0.16 0, -0.16 0.4, -0.16 0.64, -0.42 0.64, 0 1, 0.42 0.64, 0.16 0.64, 0.16 0.53, 0.5 0.66, 0.62 0.54, 0.16 0.33, 0.16 0, -0.16 0)), ((0.38 0.82, 1 0.8, 0.74 0.48, 0.38 0.82)))', 'MULTIPolygon (((-0.16 0, -0.16 0.33, -0.62 0.54, -0.5 0.66, -0.16 0.53, -0.16 0.64, -0.42 0.64, 0 1, 0.42 0.64, 0.16 0.64, 0.16 0.53, 0.5 0.66, 0.62 0.54, 0.16 0.33, 0.16 0, -0.16 0)), ((-1 0.8, -0.38 0.82, -0.74 0.48, -1 0.8)), ((0.74 0.48, 0.38 0.82, 1 0.8, 0.74 0.48)))'), with_variable('turns', array_foreach(array(0, 180), eval('with_variable(''d'', main_angle(@g) + @element, with_variable(''h'', rotate(@g, -@d, centroid(@g)), @d + degrees(azimuth(centroid(intersection(@h, bounds(make_line(make_point(x_min(@h), y_min(@h)), make_point(x_max(@h), y_min(@h) + 0.2 * (y_max(@h) - y_min(@h))))))), centroid(intersection(@h, bounds(make_line(make_point(x_min(@h), y_min(@h) + 0.25 * (y_max(@h) - y_min(@h))), make_point(x_max(@h), y_min(@h) + 0.5 * (y_max(@h) - y_min(@h)))))))))))')), with_variable('laid', array_foreach(generate_series(0, 11), eval('with_variable(''t'', geom_from_wkt(@signs[@element % 6]), with_variable(''n'', rotate(@g, -@turns[@element // 6], centroid(@g)), with_variable(''s'', affine_transform(@t, 0, 0, 0, (x_max(@n) - x_min(@n)) / (x_max(@t) - x_min(@t)), y_max(@n) - y_min(@n)), rotate(translate(@s, x_min(@n) - x_min(@s), y_min(@n) - y_min(@s)), @turns[@element // 6], centroid(@g)))))')), with_variable('fits', array_foreach(@laid, area(intersection(@element, @g)) / area(combine(@element, @g))), CASE WHEN array_max(@fits) &gt; 0.55 THEN @laid[array_find(@fits, array_max(@fits))] ELSE eval('with_variable(''box'', oriented_bbox($geometry), if(area($geometry) &gt; 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))') END)))))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@7@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{b397648a-e036-5deb-8c80-90cb0c5e29a3}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="8">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{9680f3cd-5a5d-590c-aa6e-ed7c11a54ef4}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@8@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{9d48049e-826c-5ff7-803c-2ed630004659}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
         <Option type="QString" name="type" value="collection"/>
        </Option>
       </data_defined_properties>
      </layer>
     </symbol>
    </layer>
   </symbol>
   <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="9">
    <data_defined_properties>
     <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
     </Option>
    </data_defined_properties>
    <layer class="GeometryGenerator" enabled="1" id="{68948562-3742-53a8-a4dd-4b13643c9089}" locked="0" pass="0">
     <Option type="Map">
      <Option type="QString" name="SymbolType" value="Fill"/>
      <Option type="QString" name="geometryModifier" value="with_variable('box', oriented_bbox($geometry), if(area($geometry) > 0.72 * area(@box), @box, smooth(simplify($geometry, 0.04), 1, 0.25)))"/>
      <Option type="QString" name="units" value="MapUnit"/>
     </Option>
     <data_defined_properties>
      <Option type="Map">
       <Option type="QString" name="name" value=""/>
       <Option name="properties"/>
       <Option type="QString" name="type" value="collection"/>
      </Option>
     </data_defined_properties>
     <symbol type="fill" force_rhr="0" clip_to_extent="1" frame_rate="10" alpha="1" is_animated="0" name="@9@0">
      <data_defined_properties>
       <Option type="Map">
        <Option type="QString" name="name" value=""/>
        <Option name="properties"/>
        <Option type="QString" name="type" value="collection"/>
       </Option>
      </data_defined_properties>
      <layer class="SimpleFill" enabled="1" id="{d9b33e75-ae6b-5797-acac-953f9c03dba2}" locked="0" pass="0">
       <Option type="Map">
        <Option type="QString" name="border_width_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="color" value="255,255,255,255,rgb:1,1,1,1"/>
        <Option type="QString" name="joinstyle" value="round"/>
        <Option type="QString" name="offset" value="0,0"/>
        <Option type="QString" name="offset_map_unit_scale" value="3x:0,0,0,0,0,0"/>
        <Option type="QString" name="offset_unit" value="MM"/>
        <Option type="QString" name="outline_color" value="200,204,208,255,rgb:0.78431372549019607,0.80000000000000004,0.81568627450980391,1"/>
        <Option type="QString" name="outline_style" value="solid"/>
        <Option type="QString" name="outline_width" value="0.04"/>
        <Option type="QString" name="outline_width_unit" value="MM"/>
        <Option type="QString" name="style" value="solid"/>
       </Option>
       <data_defined_properties>
        <Option type="Map">
         <Option type="QString" name="name" value=""/>
         <Option name="properties"/>
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
