"""Lanes written as OpenDRIVE."""

from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..texts import tr
from .inputs import add_road_map_layers, fault_table, lanes_with_borders, warn_of_faults

ROADS = "products.export.opendrive.exporter:OpenDriveSettings"
VERSIONS, SIDES = ("1.7", "1.8"), ("automatic", "right", "left")
ROAD_SETTINGS = (
    SettingSpec("TOLERANCE", ROADS, "tolerance", tr("Tolerance (m)"),
                tr("How far borders may be missed, across and in height. Smaller follows the survey more closely with more and shorter elements.")),
)


class ExportOpenDrive(Algorithm):
    ID, TITLE, GROUP = "exportopendrive", "Export OpenDRIVE", "Export"
    SUMMARY = "Writes lanes as an OpenDRIVE map for simulators: roads with a reference line, lane sections, heights, road marks and junctions."
    HELP = ("The reference line is made of lines, arcs and spirals, where the tolerance allows none of them of parametric cubics. Lanes beside each "
            "other are one road; a section begins where a lane begins or ends, and a junction where lanes part. Beside a double line lanes reach to "
            "its middle, where the mark of both stripes is. Widths are cubics, heights an elevation with superelevation or, on a crowned road, the "
            "shape of the cross-section. Connectors are the roads of junctions. Curbs are narrow lanes with their height; zebra crossings, stop "
            "lines, arrows and hatched areas are objects. What was inferred or bridged, and the uncertainty of every lane, is said in userData.\n\n"
            "The file is read back and checked before it is handed over: the report says how far its borders lie from the survey's. OpenDRIVE "
            "stores no line to drive on; the report also says how far the middles of the lanes are from the driving lines. Signals, signs, "
            "speed limits and buildings are not there.")
    TAGS = ("OpenDRIVE", "xodr", "HD map", "simulator", "CARLA", "esmini")
    NUMBERS = (("ROADS", tr("Roads")), ("JUNCTIONS", tr("Junctions")), ("SUCCESSORS", tr("Links from one lane to the next")),
               ("BORDER_MAXIMUM", tr("Largest distance of a border from the survey's (m)")),
               ("HEIGHT_MAXIMUM", tr("Largest difference in height of a border (m)")),
               ("DRIVING_LINE_P95", tr("95th percentile of the distance of driving lines from the middles of lanes (m)")),
               ("FINDINGS", tr("Findings of the check")))

    def declare(self):
        add_road_map_layers(self)
        self.add_input("choice", "VERSION", tr("Version"), tr("Of the format; older simulators read 1.7."), default=VERSIONS[0], choices=VERSIONS)
        self.add_settings(ROAD_SETTINGS)
        self.add_input("choice", "TRAFFIC_SIDE", tr("Side of traffic"), tr(
            "Automatic takes it from roads with lanes in both directions; choose it where all roads are one-way."), default=SIDES[0], choices=SIDES)
        self.add_output("file", "OUTPUT", tr("OpenDRIVE file"), tr("The map."), suffixes=(".xodr",), file_filter="OpenDRIVE (*.xodr)")
        self.add_report()

    def work(self, call, progress):
        from pathlib import Path

        from ...products.export.check.roads import check_opendrive
        from ...products.export.map_layers import border_misses, driving_line_misses, reference_of_crs
        from ...products.export.opendrive.exporter import draft_opendrive
        from ...products.export.opendrive.layers import layers_of_opendrive
        from ...products.export.opendrive.xodr import opendrive_text, read_opendrive

        source = lanes_with_borders(call, progress.part(0.0, 0.2))
        settings = call.settings(ROAD_SETTINGS, version=call.value("VERSION"), traffic_side=call.value("TRAFFIC_SIDE"))
        draft = draft_opendrive(source, settings, progress.part(0.2, 0.7))
        draft.map.reference = reference_of_crs(source.lanes.crs)
        path = call.new_file("OUTPUT")
        Path(path).write_text(opendrive_text(draft.map), encoding="utf-8")
        whole = read_opendrive(path)
        shown, check = layers_of_opendrive(whole, source.lanes.crs), check_opendrive(whole, source.lanes.crs, progress.part(0.7, 0.9))
        across, rise = border_misses(source.lanes, shown.lanes)
        driven = driving_line_misses(source.driving_lines, shown.lanes)
        led = source.led_to_middles()
        single = driving_line_misses(source.driving_lines, shown.lanes, apart_from=led) if len(led) else driven
        notes = [*source.notes, *draft.notes]
        if not source.lanes.crs:
            notes.append(tr("The layer of lanes has no CRS: the file has no geoReference."))
        if across.largest > settings.tolerance or rise.largest > settings.tolerance:
            x, y, _ = (across if across.largest > settings.tolerance else rise).worst
            notes.append(tr("Borders lie up to {across:.3f} m beside and {rise:.3f} m above or below those of the survey, more than the "
                            "tolerance, the farthest near x {x:.1f}, y {y:.1f}.").format(across=across.largest, rise=rise.largest, x=x, y=y))
        warn_of_faults(notes, check, progress)
        progress.info(tr("{roads} roads, {junctions} junctions; borders within {across:.3f} m of the survey's.").format(
            roads=len(whole.roads), junctions=len(whole.junctions), across=across.largest))
        if call.wants("REPORT"):
            call.text("REPORT", _report(call, whole, check, shown, (across, rise, driven, single), notes))
        numbers = {"ROADS": len(whole.roads), "JUNCTIONS": len(whole.junctions), "SUCCESSORS": check.successors, "FINDINGS": len(check.found),
                   "BORDER_MAXIMUM": across.largest, "HEIGHT_MAXIMUM": rise.largest}
        if driven.places:
            numbers["DRIVING_LINE_P95"] = driven.p95
        return {name: float(value) for name, value in numbers.items()}


def _report(call, whole, found, shown, misses, notes):
    from collections import defaultdict

    from ...core.common.texts import word
    from ...products.report.hd_map import map_export_report

    lengths = defaultdict(float)
    for road in whole.roads:
        for element in road.plan.elements:
            lengths[element.kind] += element.length
    facts = [(tr("Roads"), len(whole.roads)), (tr("Junctions"), len(whole.junctions)), (tr("Lanes of sections that are driven"), found.lanes),
             (tr("Links from one lane to the next"), found.successors), (tr("Pairs of lanes side by side"), found.neighbours),
             (tr("False origin"), f"{whole.offset[0]:g}, {whole.offset[1]:g}"), ("geoReference", whole.reference or tr("none"))]
    names = (tr("Borders, across"), tr("Borders, in height"), tr("Driving lines from the middles of lanes (measured)"),
             tr("The same, of lanes beside no double line"))
    tables = [
        (tr("Against the survey"), ("", tr("Mean (m)"), "95 % (m)", tr("Largest (m)"), tr("Places")),
         [(name, round(miss.mean, 4), round(miss.p95, 4), round(miss.largest, 4), miss.places) for name, miss in zip(names, misses) if miss.places]),
        (tr("Elements of the reference lines"), (tr("Element"), tr("Length (m)")),
         [(word(kind, "element"), round(metres, 1)) for kind, metres in sorted(lengths.items())]),
    ]
    return map_export_report(tr("OpenDRIVE map"), call.layer_name("LANES"), facts, tables + fault_table(found), notes, shown)
