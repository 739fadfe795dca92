"""Lanes and lines written for the design office."""

from ...core.common.errors import RoadExtractionError
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..texts import told, tr
from .inputs import add_road_map_layers, road_map_source

ROADS = "products.export.opendrive.exporter:OpenDriveSettings"
FORMATS = ("dxf", "landxml")
SUFFIXES = {"dxf": (".dxf",), "landxml": (".xml", ".landxml")}
CAD_SETTINGS = (
    SettingSpec("TOLERANCE", ROADS, "tolerance", tr("Tolerance (m)"),
                tr("LandXML: how far a line may be missed by its elements, in plan and in height. DXF has every vertex.")),
)


class ExportCad(Algorithm):
    ID, TITLE, GROUP = "exportcad", "Export CAD", "Export"
    SUMMARY = "Writes the road map for the design office: 3D polylines as DXF, or alignments of lines, curves and spirals with profile as LandXML."
    HELP = ("DXF: lane borders, driving lines, marking lines, road edges and outlines of markings as 3D polylines, each class in a layer of its own "
            "with a colour. LandXML 1.2: the axis of every road and every driving line as an alignment of the fitted lines, curves and spirals, "
            "with a profile of tangents; a line that no elements follow within the tolerance is an irregular line.\n\n"
            "DXF has no place for the CRS; LandXML names it. Both have the units of the layers' CRS, such as US "
            "survey feet. Surfaces and texts are not there; Cross-sections draws sections as DXF.")
    TAGS = ("DXF", "LandXML", "CAD", "alignment", "profile")
    NUMBERS = (("LINES", tr("Lines")), ("ALIGNMENTS", tr("Alignments")), ("MISSED", tr("Largest distance of a line from its elements (m)")))

    def declare(self):
        add_road_map_layers(self)
        self.add_input("choice", "FORMAT", tr("Format"), tr("dxf is drawn by every CAD program, landxml is taken over by programs for road design."),
                       default=FORMATS[0], choices=FORMATS)
        self.add_settings(CAD_SETTINGS)
        self.add_output("file", "OUTPUT", tr("CAD file"), tr("With the ending .dxf, or .xml for LandXML."),
                        suffixes=(".dxf", ".xml", ".landxml"), file_filter="DXF (*.dxf);;LandXML (*.xml *.landxml)")
        self.add_report()

    def work(self, call, progress):
        from ...products.report.hd_map import map_export_report

        kind = call.value("FORMAT")
        self._check_name(call, kind)
        source = road_map_source(call, progress.part(0.0, 0.2))
        for note in source.notes:
            progress.warn(note)
        numbers, tables = (_dxf if kind == "dxf" else _landxml)(call, source, progress)
        if call.wants("REPORT"):
            facts = [(tr("Format"), {"dxf": "DXF", "landxml": "LandXML 1.2"}[kind]), (tr("Lines"), int(numbers["LINES"]))]
            call.text("REPORT", map_export_report(tr("Road map for CAD"), call.layer_name("LANES"), facts, tables, source.notes))
        return numbers

    def _check_name(self, call, kind):
        path = call.destination("OUTPUT") or ""
        named = next((name for name, suffixes in SUFFIXES.items() if path.lower().endswith(suffixes)), kind)
        if named != kind and path != "TEMPORARY_OUTPUT":
            raise RoadExtractionError(tr("{path} has the ending of {named}, but FORMAT is {kind}. Change one of them.").format(
                path=path, named=named, kind=kind))


def _dxf(call, source, progress):
    from collections import Counter

    from ...products.cad import dxf_lines, write_dxf

    lines = dxf_lines(source)
    write_dxf(lines, call.new_file("OUTPUT"), source.lanes.crs)
    counts = Counter(line.layer for line in lines)
    progress.info(tr("{count} polylines in {layers} layers.").format(count=len(lines), layers=len(counts)))
    return {"LINES": float(len(lines)), "ALIGNMENTS": 0.0, "MISSED": 0.0}, [(tr("Layers"), (tr("Layer"), tr("Polylines")), sorted(counts.items()))]


def _landxml(call, source, progress):
    from datetime import datetime
    from pathlib import Path

    from ...products.cad import alignments_of, landxml_text

    tolerance = call.value("TOLERANCE")
    alignments = alignments_of(source, tolerance)
    now = datetime.now()
    text = landxml_text(alignments, source.lanes.crs, call.layer_name("LANES"), now.strftime("%Y-%m-%d"), now.strftime("%H:%M:%S"))
    Path(call.new_file("OUTPUT")).write_text(text, encoding="utf-8")
    irregular = sum(alignment.plan is None for alignment in alignments)
    if irregular:
        progress.warn(tr("{count} lines are followed by no elements within the tolerance and are irregular lines.").format(count=irregular))
    missed = max((alignment.missed for alignment in alignments), default=0.0)
    progress.info(tr("{count} alignments, {length:.0f} m; elements within {missed:.3f} m of their lines.").format(
        count=len(alignments), length=sum(alignment.length for alignment in alignments), missed=missed))
    rows = [(alignment.name, told(alignment.description), round(alignment.length, 2),
             len(alignment.plan.elements) if alignment.plan is not None else None, len(alignment.profile))
            for alignment in alignments]
    tables = [(tr("Alignments"), (tr("Name"), tr("What it is"), tr("Length (m)"), tr("Elements"), tr("Points of the profile")), rows)]
    return {"LINES": float(len(alignments)), "ALIGNMENTS": float(len(alignments)), "MISSED": missed}, tables
