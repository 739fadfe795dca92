"""What the algorithms on map files share."""

from ...core.common.schemas import DRIVING_LINES, LANES, MARKING_LINES, ROAD_EDGES
from ..call import existing_file
from ..parameters import CrsSpec, FileSpec
from ..texts import tr

OPENDRIVE_FILTER = "OpenDRIVE (*.xodr *.XODR *.xml);;All files (*.*)"
LANELET_FILTER = "Lanelet2 (*.osm *.OSM *.xml);;All files (*.*)"
MAP_LAYERS = (
    ("LANES", tr("Lanes"), tr("An area for each lane and piece, with the lanes that follow it."), LANES, "PolygonZ", "lane_areas"),
    ("DRIVING_LINES", tr("Driving lines"), tr("The middle of every lane that is driven, in the direction of travel."), DRIVING_LINES, "LineStringZ",
     "driving_lines"),
    ("MARKING_LINES", tr("Marking lines"), tr("Borders that are painted."), MARKING_LINES, "LineStringZ", "marking_lines"),
    ("ROAD_EDGES", tr("Road edges"), tr("Curbs and borders of the road."), ROAD_EDGES, "LineStringZ", "road_edges"),
)


def add_map_file(algorithm, label, text, file_filter):
    algorithm.add(FileSpec("INPUT", label, text, file_filter=file_filter))


def add_map_crs(algorithm, text):
    algorithm.add(CrsSpec("CRS", tr("CRS of the layers"), text, optional=True))


def add_map_layers(algorithm):
    """The layers that a map is read into."""
    for name, label, text, fields, geometry, _ in MAP_LAYERS:
        algorithm.add_sink(name, label, text, fields=fields, geometry=geometry, optional=True)
    algorithm.add_number("LANE_COUNT", tr("Lanes and pieces"))
    algorithm.add_number("LENGTH", tr("Length of the driven lanes (m)"))


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
