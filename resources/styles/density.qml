<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis styleCategories="Symbology" version="3.40.6-Bratislava">
  <pipe-data-defined-properties>
    <Option type="Map">
      <Option type="QString" name="name" value=""/>
      <Option name="properties"/>
      <Option type="QString" name="type" value="collection"/>
    </Option>
  </pipe-data-defined-properties>
  <pipe>
    <provider>
      <resampling zoomedInResamplingMethod="nearestNeighbour" maxOversampling="2" zoomedOutResamplingMethod="nearestNeighbour" enabled="false"/>
    </provider>
    <rasterrenderer classificationMin="0" type="singlebandpseudocolor" classificationMax="3000" band="1" opacity="1" nodataColor="" alphaBand="-1">
      <minMaxOrigin>
        <limits>CumulativeCut</limits>
        <extent>WholeRaster</extent>
        <statAccuracy>Estimated</statAccuracy>
        <cumulativeCutLower>0.02</cumulativeCutLower>
        <cumulativeCutUpper>0.98</cumulativeCutUpper>
        <stdDevFactor>2</stdDevFactor>
      </minMaxOrigin>
      <rastershader>
        <colorrampshader classificationMode="1" maximumValue="3000" colorRampType="INTERPOLATED" minimumValue="0" clip="0" labelPrecision="6">
          <colorramp type="gradient" name="[source]">
            <Option type="Map">
              <Option type="QString" name="color1" value="68,1,84,255,rgb:0.26666666666666666,0.00392156862745098,0.32941176470588235,1"/>
              <Option type="QString" name="color2" value="253,231,37,255,rgb:0.99215686274509807,0.90588235294117647,0.14509803921568629,1"/>
              <Option type="QString" name="direction" value="ccw"/>
              <Option type="QString" name="discrete" value="0"/>
              <Option type="QString" name="rampType" value="gradient"/>
              <Option type="QString" name="spec" value="rgb"/>
              <Option type="QString" name="stops" value="0.0196078;70,8,92,255,rgb:0.27450980392156865,0.03137254901960784,0.36078431372549019,1;rgb;ccw:0.0392157;71,16,99,255,rgb:0.27843137254901962,0.06274509803921569,0.38823529411764707,1;rgb;ccw:0.0588235;72,23,105,255,rgb:0.28235294117647058,0.09019607843137255,0.41176470588235292,1;rgb;ccw:0.0784314;72,29,111,255,rgb:0.28235294117647058,0.11372549019607843,0.43529411764705883,1;rgb;ccw:0.0980392;72,36,117,255,rgb:0.28235294117647058,0.14117647058823529,0.45882352941176469,1;rgb;ccw:0.117647;71,42,122,255,rgb:0.27843137254901962,0.16470588235294117,0.47843137254901963,1;rgb;ccw:0.137255;70,48,126,255,rgb:0.27450980392156865,0.18823529411764706,0.49411764705882355,1;rgb;ccw:0.156863;69,55,129,255,rgb:0.27058823529411763,0.21568627450980393,0.50588235294117645,1;rgb;ccw:0.176471;67,61,132,255,rgb:0.2627450980392157,0.23921568627450981,0.51764705882352946,1;rgb;ccw:0.196078;65,66,135,255,rgb:0.25490196078431371,0.25882352941176473,0.52941176470588236,1;rgb;ccw:0.215686;63,72,137,255,rgb:0.24705882352941178,0.28235294117647058,0.53725490196078429,1;rgb;ccw:0.235294;61,78,138,255,rgb:0.23921568627450981,0.30588235294117649,0.54117647058823526,1;rgb;ccw:0.254902;58,83,139,255,rgb:0.22745098039215686,0.32549019607843138,0.54509803921568623,1;rgb;ccw:0.27451;56,89,140,255,rgb:0.2196078431372549,0.34901960784313724,0.5490196078431373,1;rgb;ccw:0.294118;53,94,141,255,rgb:0.20784313725490197,0.36862745098039218,0.55294117647058827,1;rgb;ccw:0.313725;51,99,141,255,rgb:0.20000000000000001,0.38823529411764707,0.55294117647058827,1;rgb;ccw:0.333333;49,104,142,255,rgb:0.19215686274509805,0.40784313725490196,0.55686274509803924,1;rgb;ccw:0.352941;46,109,142,255,rgb:0.1803921568627451,0.42745098039215684,0.55686274509803924,1;rgb;ccw:0.372549;44,113,142,255,rgb:0.17254901960784313,0.44313725490196076,0.55686274509803924,1;rgb;ccw:0.392157;42,118,142,255,rgb:0.16470588235294117,0.46274509803921571,0.55686274509803924,1;rgb;ccw:0.411765;41,123,142,255,rgb:0.16078431372549021,0.4823529411764706,0.55686274509803924,1;rgb;ccw:0.431373;39,128,142,255,rgb:0.15294117647058825,0.50196078431372548,0.55686274509803924,1;rgb;ccw:0.45098;37,132,142,255,rgb:0.14509803921568629,0.51764705882352946,0.55686274509803924,1;rgb;ccw:0.470588;35,137,142,255,rgb:0.13725490196078433,0.53725490196078429,0.55686274509803924,1;rgb;ccw:0.490196;33,142,141,255,rgb:0.12941176470588237,0.55686274509803924,0.55294117647058827,1;rgb;ccw:0.509804;32,146,140,255,rgb:0.12549019607843137,0.5725490196078431,0.5490196078431373,1;rgb;ccw:0.529412;31,151,139,255,rgb:0.12156862745098039,0.59215686274509804,0.54509803921568623,1;rgb;ccw:0.54902;30,156,137,255,rgb:0.11764705882352941,0.61176470588235299,0.53725490196078429,1;rgb;ccw:0.568627;31,161,136,255,rgb:0.12156862745098039,0.63137254901960782,0.53333333333333333,1;rgb;ccw:0.588235;33,165,133,255,rgb:0.12941176470588237,0.6470588235294118,0.52156862745098043,1;rgb;ccw:0.607843;36,170,131,255,rgb:0.14117647058823529,0.66666666666666663,0.51372549019607838,1;rgb;ccw:0.627451;40,174,128,255,rgb:0.15686274509803921,0.68235294117647061,0.50196078431372548,1;rgb;ccw:0.647059;46,179,124,255,rgb:0.1803921568627451,0.70196078431372544,0.48627450980392156,1;rgb;ccw:0.666667;53,183,121,255,rgb:0.20784313725490197,0.71764705882352942,0.47450980392156861,1;rgb;ccw:0.686275;61,188,116,255,rgb:0.23921568627450981,0.73725490196078436,0.45490196078431372,1;rgb;ccw:0.705882;70,192,111,255,rgb:0.27450980392156865,0.75294117647058822,0.43529411764705883,1;rgb;ccw:0.72549;80,196,106,255,rgb:0.31372549019607843,0.7686274509803922,0.41568627450980394,1;rgb;ccw:0.745098;90,200,100,255,rgb:0.35294117647058826,0.78431372549019607,0.39215686274509803,1;rgb;ccw:0.764706;101,203,94,255,rgb:0.396078431372549,0.79607843137254897,0.36862745098039218,1;rgb;ccw:0.784314;112,207,87,255,rgb:0.4392156862745098,0.81176470588235294,0.3411764705882353,1;rgb;ccw:0.803922;124,210,80,255,rgb:0.48627450980392156,0.82352941176470584,0.31372549019607843,1;rgb;ccw:0.823529;137,213,72,255,rgb:0.53725490196078429,0.83529411764705885,0.28235294117647058,1;rgb;ccw:0.843137;149,216,64,255,rgb:0.58431372549019611,0.84705882352941175,0.25098039215686274,1;rgb;ccw:0.862745;162,218,55,255,rgb:0.63529411764705879,0.85490196078431369,0.21568627450980393,1;rgb;ccw:0.882353;176,221,47,255,rgb:0.69019607843137254,0.8666666666666667,0.18431372549019609,1;rgb;ccw:0.901961;189,223,38,255,rgb:0.74117647058823533,0.87450980392156863,0.14901960784313725,1;rgb;ccw:0.921569;202,225,31,255,rgb:0.792156862745098,0.88235294117647056,0.12156862745098039,1;rgb;ccw:0.941176;216,226,25,255,rgb:0.84705882352941175,0.88627450980392153,0.09803921568627451,1;rgb;ccw:0.960784;229,228,25,255,rgb:0.89803921568627454,0.89411764705882357,0.09803921568627451,1;rgb;ccw:0.980392;241,229,29,255,rgb:0.94509803921568625,0.89803921568627454,0.11372549019607843,1;rgb;ccw"/>
            </Option>
          </colorramp>
          <item label="0" alpha="255" value="0" color="#440154"/>
          <item label="58.82" alpha="255" value="58.82340000000001" color="#46085c"/>
          <item label="117.6" alpha="255" value="117.6471" color="#471063"/>
          <item label="176.5" alpha="255" value="176.47050000000002" color="#481769"/>
          <item label="235.3" alpha="255" value="235.2942" color="#481d6f"/>
          <item label="294.1" alpha="255" value="294.11760000000004" color="#482475"/>
          <item label="352.9" alpha="255" value="352.94100000000003" color="#472a7a"/>
          <item label="411.8" alpha="255" value="411.765" color="#46307e"/>
          <item label="470.6" alpha="255" value="470.589" color="#453781"/>
          <item label="529.4" alpha="255" value="529.413" color="#433d84"/>
          <item label="588.2" alpha="255" value="588.234" color="#414287"/>
          <item label="647.1" alpha="255" value="647.058" color="#3f4889"/>
          <item label="705.9" alpha="255" value="705.8820000000001" color="#3d4e8a"/>
          <item label="764.7" alpha="255" value="764.706" color="#3a538b"/>
          <item label="823.5" alpha="255" value="823.53" color="#38598c"/>
          <item label="882.4" alpha="255" value="882.3539999999999" color="#355e8d"/>
          <item label="941.2" alpha="255" value="941.175" color="#33638d"/>
          <item label="1000" alpha="255" value="999.999" color="#31688e"/>
          <item label="1059" alpha="255" value="1058.823" color="#2e6d8e"/>
          <item label="1118" alpha="255" value="1117.6470000000002" color="#2c718e"/>
          <item label="1176" alpha="255" value="1176.471" color="#2a768e"/>
          <item label="1235" alpha="255" value="1235.295" color="#297b8e"/>
          <item label="1294" alpha="255" value="1294.119" color="#27808e"/>
          <item label="1353" alpha="255" value="1352.94" color="#25848e"/>
          <item label="1412" alpha="255" value="1411.7640000000001" color="#23898e"/>
          <item label="1471" alpha="255" value="1470.588" color="#218e8d"/>
          <item label="1529" alpha="255" value="1529.412" color="#20928c"/>
          <item label="1588" alpha="255" value="1588.2359999999999" color="#1f978b"/>
          <item label="1647" alpha="255" value="1647.06" color="#1e9c89"/>
          <item label="1706" alpha="255" value="1705.881" color="#1fa188"/>
          <item label="1765" alpha="255" value="1764.705" color="#21a585"/>
          <item label="1824" alpha="255" value="1823.529" color="#24aa83"/>
          <item label="1882" alpha="255" value="1882.3529999999998" color="#28ae80"/>
          <item label="1941" alpha="255" value="1941.1770000000001" color="#2eb37c"/>
          <item label="2000" alpha="255" value="2000.001" color="#35b779"/>
          <item label="2059" alpha="255" value="2058.825" color="#3dbc74"/>
          <item label="2118" alpha="255" value="2117.646" color="#46c06f"/>
          <item label="2176" alpha="255" value="2176.47" color="#50c46a"/>
          <item label="2235" alpha="255" value="2235.2940000000003" color="#5ac864"/>
          <item label="2294" alpha="255" value="2294.118" color="#65cb5e"/>
          <item label="2353" alpha="255" value="2352.942" color="#70cf57"/>
          <item label="2412" alpha="255" value="2411.766" color="#7cd250"/>
          <item label="2471" alpha="255" value="2470.587" color="#89d548"/>
          <item label="2529" alpha="255" value="2529.411" color="#95d840"/>
          <item label="2588" alpha="255" value="2588.235" color="#a2da37"/>
          <item label="2647" alpha="255" value="2647.059" color="#b0dd2f"/>
          <item label="2706" alpha="255" value="2705.883" color="#bddf26"/>
          <item label="2765" alpha="255" value="2764.707" color="#cae11f"/>
          <item label="2824" alpha="255" value="2823.5280000000002" color="#d8e219"/>
          <item label="2882" alpha="255" value="2882.352" color="#e5e419"/>
          <item label="2941" alpha="255" value="2941.176" color="#f1e51d"/>
          <item label="3000" alpha="255" value="3000" color="#fde725"/>
          <rampLegendSettings maximumLabel="" useContinuousLegend="1" prefix="" suffix="" direction="0" orientation="2" minimumLabel="">
            <numericFormat id="basic">
              <Option type="Map">
                <Option type="invalid" name="decimal_separator"/>
                <Option type="int" name="decimals" value="6"/>
                <Option type="int" name="rounding_type" value="0"/>
                <Option type="bool" name="show_plus" value="false"/>
                <Option type="bool" name="show_thousand_separator" value="true"/>
                <Option type="bool" name="show_trailing_zeros" value="false"/>
                <Option type="invalid" name="thousand_separator"/>
              </Option>
            </numericFormat>
          </rampLegendSettings>
        </colorrampshader>
      </rastershader>
    </rasterrenderer>
    <brightnesscontrast brightness="0" contrast="0" gamma="1"/>
    <huesaturation colorizeOn="0" invertColors="0" colorizeRed="255" colorizeBlue="128" saturation="0" grayscaleMode="0" colorizeGreen="128" colorizeStrength="100"/>
    <rasterresampler maxOversampling="2"/>
    <resamplingStage>resamplingFilter</resamplingStage>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
