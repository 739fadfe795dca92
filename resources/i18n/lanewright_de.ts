<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
    <context>
        <name>Lanewright</name>
        <message>
            <location filename="../../desktop/manual.py" />
            <source>Lanewright manual</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/manual.py" />
            <source>Contents</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/manual.py" />
            <source>Back</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/manual.py" />
            <source>Forward</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Road map…</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>From a survey to driving lines in one call</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Run the sample survey</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>A made street through the whole chain, into this project</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Print layout of the road map</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>A map of the layers that Lanewright made</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>Manual</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>What every algorithm does, and a walk through a first survey</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/menu.py" />
            <source>There is no road map in this project yet: run Road map first.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/sample_run.py" />
            <source>The sample survey is being made and mapped; its layers appear when they are ready.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/sample_run.py" />
            <source>The sample survey is already on its way.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/sample_run.py" />
            <source>The road map of the sample survey is in the project; its files are in {folder}.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/sample_run.py" />
            <source>The sample survey was not mapped: {reason}</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../desktop/sample_run.py" />
            <source>cancelled</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Survey</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Road</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Markings</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Driving</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Road map</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Assessment</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Orthoimages</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>LAS, LAZ or COPC files of one survey. Files may overlap and come in any order.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Where the vehicle drove: a point or line layer with heights, a table with columns time, x, y, z, or the path of a CSV, TXT or SBET file. Made with Import trajectory it needs no further care.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Only for point clouds that carry no CRS of their own; it is written into everything made from them.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Report</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>A page with the numbers of every step and a picture.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Point clouds</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Trajectory</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>CRS of the point clouds</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Cancelled</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Not enough memory for this step; close other programs or process fewer files at once.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>while writing</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/algorithm.py" />
            <source>Fields: {fields}.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/call.py" />
            <source>{label} names {path}, which is not a file. Choose the LAS or LAZ file itself.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/call.py" />
            <source>{label}: there is no file {path}. Check the name and the folder.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/call.py" />
            <source>{label}: the CRS {given} is not known. Give it as EPSG:number.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/call.py" />
            <source>{first} and {second} would both be written to {path}, and one would be lost. Give each a file of its own, or name the layers in one GeoPackage: ogr:dbname='map.gpkg' table="road_edges" (geom).</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source> (in the OSGeo4W Shell)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source> (in a terminal)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source>The packages go into a folder of your QGIS profile that only Lanewright looks into, after everything QGIS brings. The QPIP plugin can install them as well: it reads the requirements.txt of Lanewright.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source>Missing Python package(s): {names}. To install: {command} Then start QGIS again.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/dependencies.py" />
            <source>shapely {version} is installed and version 2 or newer is needed. To install: {command} Then start QGIS again.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/destinations.py" />
            <source>{label} was to be written to {path}, but it is written as {kinds} only. Name the file so.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/destinations.py" />
            <source>{label} was to be written to {path}, but there is no folder {folder}. Create it or choose another.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/destinations.py" />
            <source>{label} was to be written to {path}, which is a folder. Name a file in it.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/destinations.py" />
            <source>{label} cannot be written to {path}: {reason}. Choose another place, or close the program that holds it.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/destinations.py" />
            <source> or </source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Driving lines</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Draws the line to drive in every lane, in the direction of travel, and tabulates the elements of its curves.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>lane</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>centre line</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>hd map</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>curve elements</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>radius</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Lane width, 0 = as seen on the road (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Where only the outer lines are painted, the number of lanes follows from their distance and this width. Wider makes fewer lanes.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Distance from a line without partner, 0 = half a lane (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>How far beside a painted line the driving line runs where the lane has no second line.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Side of traffic</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>The side one drives on; it gives the driving lines their direction. Automatic goes by the lane the vehicle itself used.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Longest gap of all lines bridged (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Longer leads lanes through wider crossings; shorter leaves them open.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Longest gap beside other lines closed (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Where another line of the road goes on, a lane is led along it through a gap up to this length.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Shortest driving line (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Shorter keeps stubs at the ends of the survey.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Marking lines</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>The layer written by Fit marking lines.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>With it a lane is led through zebra crossings and past stop lines, and gaps are told apart.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Road edges</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>With it lanes without an outer line end at the edge.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Road points</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>With it heights are the road's own.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/driving_lines.py" />
            <source>Curve elements</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>From a survey to driving lines in one call: edges, surface, intensity image, markings, lines and curve elements.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>The same stages as the single algorithms, handed on in memory. Every output is optional.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>driving line</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>road marking</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>curb</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>Road surface</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>Evens out range, incidence and the difference between scanners. Switch it off for clouds whose intensity was corrected already.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>Curb points</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>Class 11, with the fields the single stages need.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>Intensity image</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/driving/road_map.py" />
            <source>Correct intensity first</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/layers.py" />
            <source>{label} lacks the field(s) {fields}. Use the layer that Lanewright wrote.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/layers.py" />
            <source>{label} holds geometries of the kind {found}; {needed} is needed. Use the layer that Lanewright wrote.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/layers.py" />
            <source>The result could not be written: {reason}. Is the disk full or the file open elsewhere?</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/layers.py" />
            <source>the sink refused the features</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/layers.py" />
            <source>{label} has geometries without heights (Z). Use the layer that Lanewright wrote.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>Cluster markings</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>Gathers paint into markings, measures them and tells lines from crossings, arrows and the rest.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>cluster</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>zebra crossing</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>stop line</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>arrow</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>Distance that joins points (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>Larger joins worn paint into one marking, but also neighbouring markings; smaller keeps them apart.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>Fewest points of a marking (points)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>Fewer keeps tiny remains of paint, and specks that are none.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>Marking points</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>The file written by Remove outliers or Extract markings.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>Clustered points</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/cluster_markings.py" />
            <source>The points with the extra field cluster.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/correct_intensity.py" />
            <source>Correct intensity</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/correct_intensity.py" />
            <source>Evens out the fall of intensity with range and incidence, scanner by scanner, from the road's own asphalt.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/correct_intensity.py" />
            <source>The raw intensity stays as it was; the corrected one is the extra field intensity_corrected, which later stages prefer.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/correct_intensity.py" />
            <source>intensity</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/correct_intensity.py" />
            <source>range correction</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/correct_intensity.py" />
            <source>calibration</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/correct_intensity.py" />
            <source>Scale of the intensities</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/correct_intensity.py" />
            <source>Linear ones are multiplied, logarithmic ones added to. Automatic goes by the spread of asphalt; choose one when the report names the wrong one.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/correct_intensity.py" />
            <source>The file written by Extract road surface.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/correct_intensity.py" />
            <source>Corrected road points</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>Extract markings</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>Tells paint from asphalt by thresholds of the intensity image and takes the points of it.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>threshold</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>otsu</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>Method</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>Multi-threshold sets a threshold for every strip along the road, so that paint far from the scanner is found too.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>Least distance of paint from asphalt (σ)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>How many spreads of asphalt the paint of a strip must lie above it before the strip counts as painted. Lower finds fainter paint, but also gutters, patches and noise.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>Shortest run of paint along the road (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>Longer removes specks, but also worn remains of dashes.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>Gap in paint closed along the road (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>Longer joins worn paint, but also neighbouring bars and letters.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>The file that the intensity image was made from.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>The GeoTIFF written by Intensity image.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>Marking mask</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/extract_markings.py" />
            <source>1 where a pixel is paint, 0 where it is not.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Fit marking lines</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Links dashes along the road and fits a curve to every painted line.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>lane line</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>curve fitting</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>circle</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>clothoid</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>spline</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Curve fitted to marking lines</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Automatic takes the simplest curve that fits (Bayesian information criterion). Choose one to force it on every line.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Degree of the polynomial (0-9)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Used with polynomial only. Higher follows more bends, but swings between its points.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Longest gap between dashes linked (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Longer links dashes that stand far apart, but also lines that end and begin anew.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Longest gap linked by rhythm (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Up to here a line goes on where its own rhythm of dashes or a line beside it carries over; flagged as bridged.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Least paint of a line (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>Less makes lines of short remains, and of marks that are none.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>The file written by Cluster markings.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/fit_marking_lines.py" />
            <source>The layer written by Cluster markings together with the points.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>Interpolates the intensity of road points into a GeoTIFF: near and bright points count more.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>image</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>raster</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>orthophoto</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>Cell size (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>Smaller shows narrow lines more sharply while the cloud is dense enough; larger fills gaps and makes smaller files.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>Power of the distance (0-9)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>Higher lets the nearest point decide, lower averages more.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>Share of the weight that follows brightness (0-1)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>0 is plain inverse distance; higher lets bright points count more and fattens paint by up to half a cell.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>Reach of a point (cells)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>Larger fills sparse far pixels, but blurs.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>The file written by Correct intensity, or by Extract road surface for the raw intensity.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>Intensity image, 8 bit</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/intensity_image.py" />
            <source>The same for viewing: stretched to 256 grey values, for programs that show no floating-point images.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>Remove outliers</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>Statistical outlier removal: points that lie farther from their neighbours than is usual go.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>outlier</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>noise</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>sor</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>Nearest points looked at (points)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>More judges by a wider neighbourhood and removes small clumps too; fewer removes single points only.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>Allowed distance above the mean (σ)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>Smaller removes more, first where points are sparse; larger keeps far paint, and some noise with it.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>Statistics over</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>All compares every point with the whole file, as PCL does, and eats sparse paint far from the scanner; windows compares it with its own stretch of the road.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>The file written by Extract markings.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/markings/remove_outliers.py" />
            <source>Marking points without outliers</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Search width across a step (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>The height must change within this width. Wider finds rounded and bevelled curbs, but also ramps.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Trajectory above the road, 0 = from the data (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Give it where little road was scanned under the vehicle; otherwise the data know better.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Height above the road that is looked at (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Higher keeps curbs on steeply banked roads, but also low walls and the sills of cars.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Reach of a plane across the road (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Points this far to either side of a step give its planes. Longer is steadier, shorter keeps to narrow gutters and curb stones.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Reach of a plane along the road (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Longer is steadier where points are sparse, shorter follows sharp corners.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Points of a plane lie within (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Larger for noisy scanners; where points scatter more, 1.5 sigma of the plane is taken anyway.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Least angle of a curb face's normal from the vertical (°)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>90 is upright. Lower accepts bevelled and mountable curbs (40 for a slope of 45°), but also banks.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Largest angle of road's and sidewalk's normal from the vertical (°)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Larger accepts sloping ground behind the curb.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Least height of a step (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Lower finds dropped curbs, but also tar seams and the edges of manholes.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Longest gap connected (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Corners farther apart along the road are not joined. Longer passes driveways and parked cars, and says so.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Least height of a step on scanlines (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/boundaries_from_scanlines.py" />
            <source>Lower finds dropped curbs, but also tar seams. Profiles have a minimum curb height of their own.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_boundaries.py" />
            <source>Detect road boundaries</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_boundaries.py" />
            <source>Road edges straight from the point clouds: one door to every way of finding them.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_boundaries.py" />
            <source>kerb</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_boundaries.py" />
            <source>road edge</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_boundaries.py" />
            <source>boundary</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_boundaries.py" />
            <source>scanline</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_boundaries.py" />
            <source>Boundary method</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_boundaries.py" />
            <source>Profiles looks for the curb in slices across the road; scanlines meets the planes of road, curb face and sidewalk; both lets the two check each other: at every place the one that measures better is drawn, agree_cm says how far apart they are, and it takes as long as the two together.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Detect curbs</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Finds the curb nearest to the driven track on each side, on profiles across the road.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Where there is no curb none is made up; a curb hidden behind parked cars becomes a point of status occluded.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Block length along the road, 0 = automatic (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Automatic takes 0.5 m in sharp curves and up to 2 m on straights. Shorter follows a bend more closely but has fewer points to go by.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Profile width along the road (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Wider finds curbs far from the scanner, where points are sparse, but blurs them in bends.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Cell across the road (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Finer places the curb more exactly; coarser fills gaps in sparse clouds, but misses low curbs.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Height gap between layers (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Points of a cell this far apart in height belong to different things: the road and a car above it. Smaller cuts the curb off grass and cars, but also splits noisy ground.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Smallest slope of the curb face (°)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Lower accepts bevelled and worn curbs, but also verges and ramps.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Minimum curb height (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Lower finds dropped curbs at driveways, but also tar seams and gutters.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Maximum curb height (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Higher accepts platforms and low walls as the road's edge.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>Principal points</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/detect_curbs.py" />
            <source>The highest point of the lowest layer of every cell: what the curbs were looked for on.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/extract_road_surface.py" />
            <source>Extract road surface</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/extract_road_surface.py" />
            <source>Keeps the points of the road surface: between the road edges, or as far as the ground stays smooth.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/extract_road_surface.py" />
            <source>road surface</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/extract_road_surface.py" />
            <source>ground</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/extract_road_surface.py" />
            <source>Farthest surface from the trajectory (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/extract_road_surface.py" />
            <source>On a side without an edge the surface grows outward while it stays smooth, at most this far. Wider reaches the far lanes of a broad road, but also yards and forecourts.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/extract_road_surface.py" />
            <source>Height about the road's own surface (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/extract_road_surface.py" />
            <source>Wider keeps noisy points and ruts, but also the feet of cars and curbs; where the scanner's noise allows, less is taken.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/extract_road_surface.py" />
            <source>The layer written by Fit road edges. Without it the surface is grown on both sides.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/extract_road_surface.py" />
            <source>Class 11, with the extra fields road, pass, station_m, offset_m and half_width for the stages that follow.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/fit_road_edges.py" />
            <source>Fit road edges</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/fit_road_edges.py" />
            <source>Draws the road edges through curb points as smoothing splines, bridging short gaps and saying so.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/fit_road_edges.py" />
            <source>Longest gap bridged (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/fit_road_edges.py" />
            <source>Longer carries the edge past rows of parked cars, flagged as bridged; shorter breaks it there.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/fit_road_edges.py" />
            <source>Assumed road width where no curb is seen, 0 = none (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/fit_road_edges.py" />
            <source>0 draws no edge where none was found. A width draws one at half of it either side of the road's reference line, flagged as inferred.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/road/fit_road_edges.py" />
            <source>The layer written by Detect curbs.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>Import trajectory</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>Reads the driven trajectory from a CSV or TXT file, an Applanix SBET, or a point or line layer.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>Columns may come in any order, with or without a header, in degrees or radians. Rows are sorted by time; repeated and unusable rows are dropped and counted.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>trajectory</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>sbet</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>applanix</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>csv</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>gps time</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>A CSV or TXT file, an SBET (.out), or a layer of points or lines with heights.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>Where the file does not say it. An SBET is in WGS 84 unless another is chosen.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>That of the point clouds. Empty takes it from the point clouds below, or leaves the trajectory as it is.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>With them the time system is told apart, and the trajectory is written on the clouds' clock.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>Imported trajectory</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>Positions</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>Trajectory file or layer</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>CRS of the trajectory</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/import_trajectory.py" />
            <source>CRS to bring it to</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Inspect survey</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Tells what point clouds and trajectory hold, and whether they fit together, before work is done on them.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>What the road map would stumble over, such as a geographic CRS or two clocks, is said with a way on.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>density</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>report</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>las</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>header</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>overlap</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Cell of the density raster (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Smaller shows single scan lines, larger the broad picture.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Cube that the density in space is counted in (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>1 gives points per cubic metre as they are published; smaller ones follow surfaces more closely.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Points</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Points per m², mean of occupied cells</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Points per m³, mean of occupied cubes</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>First gps_time (s)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Last gps_time (s)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Scanners</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Points near the trajectory (%)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Scan time covered by the trajectory (%)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Point density</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/inspect_survey.py" />
            <source>Points per m² in every cell.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Sample survey</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Makes a mobile laser scanning survey of a street that exists only on paper, together with the truth about it.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Every pulse of two scanners is followed to what it meets first. Figures reached on it are figures on simulated data.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>sample</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>simulation</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>test data</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Scene</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Street is a curved two-lane road with curbs and parked cars, rural has verges instead of curbs, urban is broader with more lanes and gutters.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Length of the road (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Longer takes longer to make and to work through, in proportion.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Seed of the random numbers (whole number)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Another seed gives another street with other cars, wear and noise; the same seed gives the same points.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Speed of the vehicle (km/h)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Faster spreads the scan lines wider apart.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Pulses of each scanner (per second)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>More gives a denser cloud and a larger file.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Scan lines of each scanner (per second)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>More brings the lines closer together, with fewer points on each.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Radius of the bends (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Smaller makes sharper bends.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Height of the curbs (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Lower is harder to find.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Width of a concrete gutter along the curbs (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>A gutter is as bright as paint and is not to be taken for it; 0 leaves it out.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>True road boundaries</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>True markings</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>True driving lines</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>True road surface</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>A projected CRS in metres. The coordinates are the same in each; it only says where on earth they are.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>Point cloud</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>CRS of the survey</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey/sample_survey.py" />
            <source>{count} points of a {length:.0f} m road.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey_input.py" />
            <source>Corridor either side of the trajectory (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey_input.py" />
            <source>Points farther out are left unread. Wider reaches the far side of a broad avenue, but takes longer and brings in the neighbouring street.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey_input.py" />
            <source>Field that tells the scanners apart</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey_input.py" />
            <source>Automatic takes scanner_channel where it is used and point_source_id where it interleaves in time. Name one when the report counts the wrong number of scanners.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey_input.py" />
            <source>Time of the trajectory</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey_input.py" />
            <source>How its clock counts: gps (since 1980), adjusted (the same less a billion), week or day. Automatic compares with the point clouds and says what it chose.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey_input.py" />
            <source>The points</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey_input.py" />
            <source>The trajectory says no CRS; its coordinates are taken to be those of the target CRS as they are.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey_input.py" />
            <source>{path} has no intensity (all values are 0), so paint cannot be told from asphalt. Road edges and surface need none; for markings, export the point clouds with intensity.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/survey_input.py" />
            <source>{label} holds no points: no paint was found on this road.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/trajectory_source.py" />
            <source>{label} has no rows. Choose the layer that holds the driven positions.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../processing_provider/trajectory_source.py" />
            <source>{label} is a table with the columns {names}; {missing} cannot be found among them. Name them time, x, y, z, roll, pitch, heading.</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Pass</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Side (left/right)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Status</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Station (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Offset, left positive (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Height (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Part (bottom/top)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Agreement of the two methods (cm)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Length (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Width (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Radius (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>RMSE of the fit (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>End station (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Chain along the road</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Residual (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Supporting points</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Area (m²)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Cluster</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Class</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Use (keep/other)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Elongation</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Scanning distance (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Line</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Kind (edge/lane/centre)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Pattern</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Curve</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Fitted function (JSON)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Lane</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Kind</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Direction (1 along, -1 against the road)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Source (pair/offset)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Turn (left/right)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>R (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>R (ft)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Δ (°)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>D (° per 100 ft)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>D (° per 100 m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>L (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>L (ft)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>T (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>T (ft)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>M (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>M (ft)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>LC (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>LC (ft)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>E (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>E (ft)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>PC x</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>PC y</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>PT x</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>PT y</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>PI x</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>PI y</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>RMSE of the arc (m)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Highest design speed allowed (km/h)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Design code check</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Time (s)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Roll (°)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Pitch (°)</source>
            <translation type="unfinished" />
        </message>
        <message>
            <location filename="../../core/schemas.py" />
            <source>Heading (°, clockwise from grid north)</source>
            <translation type="unfinished" />
        </message>
    </context>
</TS>
