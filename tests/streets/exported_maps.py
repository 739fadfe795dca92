"""Road maps written in the formats of HD maps and read back."""

from lanewright.products.export.lanelet_export import LaneletSettings, draft_lanelets, lanelet2_text, to_degrees
from lanewright.products.export.lanelet_map import read_lanelet2
from lanewright.products.export.opendrive.exporter import OpenDriveSettings, draft_opendrive
from lanewright.products.export.opendrive.xodr import opendrive_text, read_opendrive
from map_files import written


def as_roads(folder, source, settings=OpenDriveSettings()):
    """(draft, map that is read) of a RoadMapSource as OpenDRIVE."""
    draft = draft_opendrive(source, settings)
    return draft, read_opendrive(written(folder, opendrive_text(draft.map), "out.xodr"))


def as_lanelets(folder, source, settings=LaneletSettings(), local=False, changed=str):
    """(draft, map that is read) of a RoadMapSource as Lanelet2; `changed`: makes the text of the file from that which was written."""
    draft = draft_lanelets(source, settings)
    return draft, read_lanelet2(written(folder, changed(lanelet2_text(draft, to_degrees(draft.nodes, source.lanes.crs), local)), "out.osm"))
