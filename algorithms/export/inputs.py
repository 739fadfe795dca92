"""What the algorithms on map files share."""

from ...core.common.features import DRIVING_LINES, LANES, MARKING_LINES, MARKINGS, ROAD_EDGES
from ..call import existing_file
from ..survey_input import road_points_of
from ..texts import told, tr

OPENDRIVE_FILTER = "OpenDRIVE (*.xodr *.XODR *.xml);;All files (*.*)"
LANELET_FILTER = "Lanelet2 (*.osm *.OSM *.xml);;All files (*.*)"
MAP_LAYERS = (
    ("LANES", tr("Lanes"), tr("An area for each lane and piece, with the lanes that follow it."), LANES, "PolygonZ", "lane_areas"),
    ("DRIVING_LINES", tr("Driving lines"), tr("The middle of every lane that is driven, in the direction of travel."), DRIVING_LINES, "LineStringZ",
     "driving_lines"),
    ("MARKING_LINES", tr("Marking lines"), tr("Borders that are painted."), MARKING_LINES, "LineStringZ", "marking_lines"),
    ("ROAD_EDGES", tr("Road edges"), tr("Curbs and borders of the road."), ROAD_EDGES, "LineStringZ", "road_edges"),
)
MAP_NUMBERS = (("LANE_COUNT", tr("Lanes and pieces")), ("LENGTH", tr("Length of the driven lanes (m)")))


def add_map_file(algorithm, label, text, file_filter):
    algorithm.add_input("file", "INPUT", label, text, file_filter=file_filter)


def add_map_crs(algorithm, text):
    algorithm.add_input("crs", "CRS", tr("CRS of the layers"), text, optional=True)


def add_map_layers(algorithm):
    """The layers that a map is read into."""
    for name, label, text, fields, geometry, _ in MAP_LAYERS:
        algorithm.add_sink(name, label, text, fields=fields, geometry=geometry, optional=True)


def map_file(call):
    return existing_file(call.file("INPUT"), call.label("INPUT"))


def write_map_layers(call, layers, progress):
    """Hand on the MapLayers of a map; returns the numbers."""
    for note in layers.notes:
        progress.warn(note)
    for name, _, _, _, _, make in MAP_LAYERS:
        if call.wants(name):
            call.layer(name, getattr(layers, make)())
    lanes = layers.lanes
    driven = (lanes.type == "driving") | (lanes.type == "connector")
    length = float(lanes.length[driven].sum())
    progress.info(tr("{count} lanes and pieces, {length:.0f} m of driven lanes.").format(count=len(lanes), length=length))
    return {"LANE_COUNT": float(len(lanes)), "LENGTH": length}


LINE_FIELDS = tuple(field for field in DRIVING_LINES if field.name in ("road", "lane", "status", "station_m", "end_m", "sigma_m"))
MARKING_LINE_FIELDS = tuple(field for field in MARKING_LINES if field.name in ("road", "line", "kind", "pattern", "width_m"))
EDGE_FIELDS = tuple(field for field in ROAD_EDGES if field.name in ("road", "height_m", "edge"))
MARKING_FIELDS = tuple(field for field in MARKINGS if field.name in ("road", "class"))


def add_road_map_layers(algorithm):
    """The layers of the road map that an export takes."""
    algorithm.add_input("layer", "LANES", tr("Lanes"), tr("Made by Driving lines or Road map, with its fields and heights."), "PolygonZ")
    algorithm.add_input("layer", "DRIVING_LINES", tr("Driving lines"), tr(
        "Held against the middles of the lanes: the report says how far apart they are. The uncertainty of every lane comes from "
        "them."), "LineStringZ", optional=True)
    algorithm.add_input("layer", "MARKING_LINES", tr("Marking lines"), tr("The widths of the painted borders."), "LineStringZ", optional=True)
    algorithm.add_input("layer", "ROAD_EDGES", tr("Road edges"), tr("The heights of curbs."), "LineStringZ", optional=True)
    algorithm.add_input("layer", "MARKINGS", tr("Markings"), tr("Zebra crossings, stop lines, arrows and hatched areas."), "PolygonZ", optional=True)
    algorithm.add_input("cloud", "ROAD_POINTS", tr("Road points"), tr("With it the borders have the heights of the road's surface."), optional=True)


def road_map_source(call, progress):
    """The layers given, checked, as RoadMapSource."""
    from dataclasses import replace

    from ...core.driving.layers import Lanes
    from ...products.export.sources import RoadMapSource, checked

    source = RoadMapSource(
        Lanes.from_features(call.features("LANES", LANES, "PolygonZ")), call.features("DRIVING_LINES", LINE_FIELDS, "LineStringZ"),
        call.features("MARKING_LINES", MARKING_LINE_FIELDS, "LineStringZ"), call.features("ROAD_EDGES", EDGE_FIELDS, "LineStringZ"),
        call.features("MARKINGS", MARKING_FIELDS, "PolygonZ"))
    source = checked(source)
    if call.cloud("ROAD_POINTS"):
        from ...products.export.sources import with_surface_heights

        road_points = road_points_of(call, "ROAD_POINTS", progress)
        lanes, share = with_surface_heights(source.lanes, road_points)
        road_points.close()
        progress.info(tr("{share:.0f} % of the border vertices have heights of road points.").format(share=100 * share))
        source = replace(source, lanes=lanes)
    return source


def lanes_with_borders(call, progress):
    """The same with ways through junctions, and borders that neighbours share."""
    from ...products.export.inferred_ways import with_inferred_ways
    from ...products.export.shared_borders import with_shared_borders

    return with_shared_borders(with_inferred_ways(road_map_source(call, progress)))


def warn_of_faults(notes, found, progress):
    """Say what a map lacks, and what the check of its file found."""
    for text in (*notes, *(tr("{fault}: {count}").format(fault=told(fault), count=count) for fault, count in found.counts().items())):
        progress.warn(text)


def fault_table(found):
    """The table of a report on what the check of a file found; none where it found nothing."""
    counts = [(told(fault), count) for fault, count in sorted(found.counts().items())]
    return [(tr("Findings of the check"), (tr("Fault"), tr("Count")), counts)] if counts else []
