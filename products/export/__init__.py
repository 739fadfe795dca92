"""From the road map to the formats of simulators, planners and design offices, back again, and their check.

In: `Lanes` with the layers of the road map, or a file of OpenDRIVE or Lanelet2. Out: such a file, DXF or LandXML; lanes and lines like
ours; findings on a map.
"""

from ...core.lazy import public

__getattr__, __all__ = public(__name__, {
    "lanelet_map": (
        "Degrees", "Lanelet", "LaneletDraft", "LaneletMap", "LaneletNetwork", "LaneletSettings", "Way", "draft_lanelets", "lanelet2_text",
        "layers_of_lanelets", "read_lanelet2", "to_degrees"),
    "shared_borders": ("SharedBorders", "meet_lanes", "share_borders", "with_inferred_ways", "with_shared_borders"),
    "sources": (
        "MapLayers", "MapLine", "Misses", "RoadMapSource", "border_misses", "checked", "driving_line_misses", "stop_lines",
        "walked_crossings", "with_surface_heights"),
    "xml_tree": ("XmlElement", "read_xml", "xml_text"),
})
