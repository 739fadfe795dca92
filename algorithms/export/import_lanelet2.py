"""Lanelet2 read into layers."""

from ..algorithm import Algorithm
from ..texts import tr
from .inputs import LANELET_FILTER, MAP_NUMBERS, add_map_crs, add_map_file, add_map_layers, map_file, write_map_layers


class ImportLanelet2(Algorithm):
    ID, TITLE, GROUP = "importlanelet2", "Import Lanelet2", "Export"
    SUMMARY = "Reads a Lanelet2 map into layers like those of the road map, to lay it over a survey and assess it."
    HELP = ("Every lanelet becomes a lane between its two borders, with the lanelets that begin where it ends as successors. Footways, areas and "
            "regulatory elements are not read. Heights are the tag ele of the nodes, as they stand in the file.\n\n"
            "Latitude and longitude are taken as WGS 84. A map with local_x and local_y alone, or whose latitudes and longitudes are all about 0, "
            "gets layers in local coordinates, without CRS.")
    TAGS = ("Lanelet2", "osm", "HD map", "Autoware", "planner")
    NUMBERS = MAP_NUMBERS

    def declare(self):
        add_map_file(self, tr("Lanelet2 file"), tr("A map with the ending .osm."), LANELET_FILTER)
        add_map_crs(self, tr("Projected, such as that of the survey. Empty takes the UTM zone of the map."))
        add_map_layers(self)

    def work(self, call, progress):
        from ...products.export.lanelet_map import layers_of_lanelets, read_lanelet2

        lanelet_map = read_lanelet2(map_file(call), progress.part(0.0, 0.5))
        return write_map_layers(call, layers_of_lanelets(lanelet_map, call.crs(), progress.part(0.5, 0.95)), progress)
