"""Lanes written as Lanelet2."""

from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..texts import told, tr
from .inputs import add_road_map_layers, fault_table, lanes_with_borders, warn_of_faults

LANELETS = "products.export.lanelet_export:LaneletSettings"
LOCATIONS = ("urban", "nonurban")
LANELET_SETTINGS = (
    SettingSpec("SPEED_LIMIT", LANELETS, "speed_limit", tr("Speed limit (km/h)"),
                tr("Written to every lanelet for vehicles. 0 writes none: the survey does not know it.")),
)


class ExportLanelet2(Algorithm):
    ID, TITLE, GROUP = "exportlanelet2", "Export Lanelet2", "Export"
    SUMMARY = "Writes lanes as a Lanelet2 map for planners such as Autoware: lanelets that share their borders, with heights and centre lines."
    HELP = ("Lanes that are driven, their connectors, bicycle lanes and shoulders become lanelets; parking, hatched areas and medians do not. Where "
            "a lane begins beside another one, both are cut, so that neighbours share their border. Curbs are curbstone high or low, painted borders "
            "line_thin or line_thick, other edges road_border, and what is neither is virtual. Zebra crossings and stop lines come from the "
            "markings. What was inferred or bridged has the tags lanewright:status and lanewright:confidence, and "
            "lanewright:sigma_m is the uncertainty of the lane.\n\n"
            "The file is read back and checked before it is handed over; the report names the transformation to latitude and longitude and what "
            "the heights are. Traffic lights, signs, right of way and regulatory elements are not there.")
    TAGS = ("Lanelet2", "osm", "HD map", "Autoware", "planner")
    NUMBERS = (("LANELETS", tr("Lanelets")), ("WAYS", tr("Ways")), ("NODES", tr("Nodes")), ("SUCCESSORS", tr("Links from one lane to the next")),
               ("FINDINGS", tr("Findings of the check")))

    def declare(self):
        add_road_map_layers(self)
        self.add_settings(LANELET_SETTINGS)
        self.add_input("choice", "LOCATION", tr("Location"), tr("Whether the roads are in a town; planners draw traffic rules from it."),
                       default=LOCATIONS[0], choices=LOCATIONS)
        self.add_input("flag", "LOCAL_COORDINATES", tr("Write local_x and local_y"), tr(
            "Autoware reads these metres within a square of 100 km instead of latitude and longitude."), default=False)
        self.add_output("file", "OUTPUT", tr("Lanelet2 file"), tr("The map."), suffixes=(".osm",), file_filter="Lanelet2 (*.osm)")
        self.add_report()

    def work(self, call, progress):
        from pathlib import Path

        from ...products.export.check.lanelets import check_lanelets
        from ...products.export.lanelet_export import draft_lanelets, lanelet2_text, to_degrees
        from ...products.export.lanelet_map import layers_of_lanelets, node_places, read_lanelet2
        from ...products.report.hd_map import map_export_report

        source = lanes_with_borders(call, progress.part(0.0, 0.2))
        progress.report(0.2)
        draft = draft_lanelets(source, call.settings(LANELET_SETTINGS, location=call.value("LOCATION")))
        degrees = to_degrees(draft.nodes, source.lanes.crs)
        path = call.new_file("OUTPUT")
        Path(path).write_text(lanelet2_text(draft, degrees, call.value("LOCAL_COORDINATES")), encoding="utf-8")
        progress.report(0.6)
        whole = read_lanelet2(path)
        check = check_lanelets(whole, *node_places(whole, source.lanes.crs))
        progress.report(0.8)
        notes = [*source.notes, *(tr("{count} pieces of the type {kind} are no lanelets and were left out.").format(count=count, kind=kind)
                                  for kind, count in draft.skipped.items())]
        if degrees.local:
            notes.append(tr("The layer of lanes has no CRS: the map has local coordinates, and latitudes and longitudes about 0."))
        warn_of_faults(notes, check, progress)
        numbers = {"LANELETS": float(len(draft.lanelets)), "WAYS": float(len(whole.ways)), "NODES": float(len(whole.node_ids)),
                   "SUCCESSORS": float(check.successors), "FINDINGS": float(len(check.found))}
        progress.info(tr("{count} lanelets; latitude and longitude by: {way}.").format(count=len(draft.lanelets), way=told(degrees.way)))
        if call.wants("REPORT"):
            accuracy = f"{degrees.accuracy:g} m" if degrees.accuracy >= 0 else tr("not stated")
            facts = [(tr("Lanelets"), len(draft.lanelets)), (tr("Links from one lane to the next"), check.successors),
                     (tr("Pairs of lanes side by side"), check.neighbours), (tr("Ways"), len(whole.ways)), (tr("Nodes"), len(whole.node_ids)),
                     (tr("Transformation to latitude and longitude"), told(degrees.way)), (tr("Accuracy of the transformation"), accuracy),
                     (tr("Heights"), told(degrees.vertical))]
            call.text("REPORT", map_export_report(tr("Lanelet2 map"), call.layer_name("LANES"), facts, fault_table(check), notes,
                                                  layers_of_lanelets(whole, source.lanes.crs)))
        return numbers
