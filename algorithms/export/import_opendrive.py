"""OpenDRIVE read into layers."""

from ..algorithm import Algorithm
from ..texts import tr
from .inputs import MAP_NUMBERS, OPENDRIVE_FILTER, add_map_crs, add_map_file, add_map_layers, map_file, write_map_layers


class ImportOpenDrive(Algorithm):
    ID, TITLE, GROUP = "importopendrive", "Import OpenDRIVE", "Export"
    SUMMARY = "Reads an OpenDRIVE map (1.1 to 1.8) into layers like those of the road map, to lay it over a survey and assess it."
    HELP = ("Lines, arcs, spirals and polynomials of the reference line, elevation, superelevation and shape, lane offsets, widths and borders, road "
            "marks, heights of curbs and the links of lanes are read. Signals, objects, bridges, railways and the lines of their paint are not.\n\n"
            "Lanes of a section are a piece; lanes of roads in a junction are connectors. Sidewalks are no lanes: a road edge is drawn where one "
            "begins, with the height of its curb. Gaps of reference lines, borders that fold back in a tight curve, and widths below 0 are named "
            "with their road; folds are cut off. Files that declare entities, or are not what a map can be, are refused.")
    TAGS = ("OpenDRIVE", "xodr", "HD map", "simulator", "CARLA", "esmini")
    NUMBERS = MAP_NUMBERS

    def declare(self):
        add_map_file(self, tr("OpenDRIVE file"), tr("A map with the ending .xodr."), OPENDRIVE_FILTER)
        add_map_crs(self, tr("Only where the file does not say it in geoReference, or says it wrongly: the coordinates are taken to be in this CRS."))
        add_map_layers(self)

    def work(self, call, progress):
        from ...products.export.map_layers import crs_of_reference
        from ...products.export.opendrive.layers import layers_of_opendrive
        from ...products.export.opendrive.xodr import read_opendrive

        road_map = read_opendrive(map_file(call), progress.part(0.0, 0.5))
        crs, note = crs_of_reference(road_map.reference, call.crs())
        layers = layers_of_opendrive(road_map, crs, progress.part(0.5, 0.95))
        layers.notes += [note] if note else []
        return write_map_layers(call, layers, progress)
