"""To and from the formats of simulators, planners and design offices; the check of HD maps, and the map on paper."""

from collections import Counter, defaultdict
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

from ..core.common.errors import RoadExtractionError
from ..core.common.features import COLOUR, LANES, MAP_FINDINGS, ROAD_ATTRIBUTES
from ..core.common.setting import Limited, choice, setting
from ..core.common.texts import word
from ..core.lazy import shapely
from .algorithm import MAP_LAYERS, Algorithm, settings_of
from .call import existing_file
from .rooms import core, products
from .survey_input import READING_SETTINGS, open_survey_with, road_points_of
from .texts import languages, told, tr
from .vector_source import LINE

READ_LAYERS = ("DRIVING_LINES", "MARKING_LINES", "ROAD_EDGES", "MARKINGS", "SIGNALS")   # that a map is read into beside the lanes


def add_any_map(algorithm):
    """A file of either format, and the CRS that it is read in."""
    algorithm.add_input("file", "INPUT", file_filter="HD maps (*.xodr *.osm *.XODR *.OSM *.xml);;All files (*.*)")
    algorithm.add_input("crs", "CRS", optional=True)


def map_file(call):
    return existing_file(call.file("INPUT"), call.label("INPUT"))


def read_map(call, progress, lanelets):
    """(the map of the file that was given, CRS of its layers, notes), of Lanelet2 if `lanelets`, else of OpenDRIVE."""
    if lanelets:
        return products.export.lanelet_map.read_lanelet2(map_file(call), progress), call.crs(), []
    whole = products.export.opendrive.xodr.read_opendrive(map_file(call), progress)
    crs, note = products.export.sources.crs_of_reference(whole.reference, call.crs())
    return whole, crs, [note] if note else []


def map_layers(call, progress, lanelets):
    """The file that was given as RoadMapSource, not yet checked."""
    whole, crs, notes = read_map(call, progress.part(0.0, 0.5), lanelets)
    layers_of = products.export.lanelet_map.layers_of_lanelets if lanelets else products.export.opendrive.xodr.layers_of_opendrive
    layers = layers_of(whole, crs, progress.part(0.5, 0.95))
    layers.notes += [*notes, *layers.said_left_out()]
    return layers


def write_map_layers(call, layers, progress):
    """Hand on the layers of a map; returns the numbers."""
    progress.warn_all(layers.notes)
    if call.wants("LANES"):
        call.layer("LANES", layers.lane_areas())
    for name in filter(call.wants, READ_LAYERS):
        call.layer(name, getattr(layers, name.lower()))
    lanes = layers.lanes
    driven = (lanes.type == "driving") | (lanes.type == "connector")
    length = float(lanes.length[driven].sum())
    progress.info(tr("{count} lanes and pieces, {length:.0f} m of driven lanes.", count=len(lanes), length=length))
    return {"LANE_COUNT": float(len(lanes)), "LENGTH": length}


# Layers that an export takes beside the lanes -> the fields that are read
EXPORTED_LAYERS = {"DRIVING_LINES": "road lane status station_m end_m sigma_m", "MARKING_LINES": "road line kind pattern width_m colour",
                   "ROAD_EDGES": "road height_m edge", "MARKINGS": "road class"}


def add_road_map_layers(algorithm):
    algorithm.add_map_layer("LANES")
    for name in EXPORTED_LAYERS:
        algorithm.add_map_layer(name, optional=True)
    algorithm.add_input("cloud", "ROAD_POINTS", optional=True)


def road_map_source(call, progress):
    """The layers given, checked, as RoadMapSource."""
    areas = call.features("LANES", LANES + ROAD_ATTRIBUTES, "PolygonZ")
    layers = {name.lower(): call.features(name, [field for field in [*MAP_LAYERS[name].schema, COLOUR] if field.name in read.split()],
                                          MAP_LAYERS[name].geometry) for name, read in EXPORTED_LAYERS.items()}
    sources = products.export.sources
    source = sources.checked(sources.RoadMapSource(core.driving.layers.Lanes.from_features(areas), **layers, signals=call.map_layer("SIGNALS"),
                                                   attributes=sources.known_of_roads(areas)))
    if call.cloud("ROAD_POINTS"):
        road_points = road_points_of(call, "ROAD_POINTS", progress)
        lanes, share = sources.with_surface_heights(source.lanes, road_points)
        road_points.close()
        progress.info(tr("{share:.0f} % of the border vertices have heights of road points.", share=100 * share))
        source = replace(source, lanes=lanes)
    return source


def lanes_with_borders(source):
    """A RoadMapSource with ways through junctions, and borders that neighbours share."""
    return products.export.shared_borders.with_shared_borders(products.export.shared_borders.with_inferred_ways(source))


def warn_of_faults(notes, findings, progress):
    """Say what a map lacks, and what the check of its file found."""
    progress.warn_all((*notes, *(tr("{fault}: {count}", fault=told(fault), count=count) for fault, count in findings.counts().items())))


def fault_table(findings):
    """The table of a report on what the check of a file found; none where it found nothing."""
    counts = [(told(fault), count) for fault, count in sorted(findings.counts().items())]
    return [(tr("Findings of the check"), (tr("Fault"), tr("Count")), counts)] if counts else []


ATTRIBUTE_SETTINGS = settings_of("products.export.road_attributes:AttributeSettings", "CORRIDOR")


class RoadAttributes(Algorithm):
    ID, TITLE, GROUP = "roadattributes", "Attributes of OpenStreetMap", "Export"
    NUMBERS = "LANE_COUNT KNOWN SPEEDS NAMES".split()

    def declare(self):
        self.add_map_layer("LANES")
        self.add_input("file", "OSM_FILE", optional=True, file_filter="OpenStreetMap (*.osm *.OSM *.xml);;All files (*.*)")
        self.add_input("layer", "WAYS", optional=True)
        self.add_settings(ATTRIBUTE_SETTINGS)
        self.add_sink("OUTPUT", fields=LANES + ROAD_ATTRIBUTES, geometry="PolygonZ", look="LANES")

    def work(self, call, progress):
        if bool(call.file("OSM_FILE")) == call.given("WAYS"):
            raise RoadExtractionError(tr("Give either {file} (OSM_FILE) or {layer} (WAYS).", file=call.label("OSM_FILE"), layer=call.label("WAYS")))
        areas = call.features("LANES", LANES + ROAD_ATTRIBUTES, "PolygonZ")
        lanes = core.driving.layers.Lanes.from_features(areas)
        if not len(lanes):
            raise RoadExtractionError(
                tr("The layer of lanes is empty. Run Driving lines or Road map where there are marking lines or road edges."))
        if not lanes.crs:
            raise RoadExtractionError(
                tr("The layer of lanes has no CRS, so its latitude and longitude are unknown. Set the CRS of the layer and run again."))
        if call.file("OSM_FILE"):
            file = existing_file(call.file("OSM_FILE"), call.label("OSM_FILE"))
            ways = products.export.road_attributes.read_osm_ways(file, lanes.crs, progress.part(0.0, 0.5))
        else:
            ways = _ways_of_layer(call.source("WAYS"), lanes.crs)
        known = products.export.road_attributes.attributes_along(lanes, ways, call.settings(ATTRIBUTE_SETTINGS))
        for row in areas.rows:
            row.update(known.get(str(row["lane_id"]), {}))
        if not known:
            progress.warn(tr("No lane lies along a way that says anything. Do the ways cover the survey?"))
        progress.info(tr("{known} of {count} lanes and pieces lie along ways that say something.", known=len(known), count=len(lanes)))
        call.layer("OUTPUT", areas)
        counts = {name: float(sum(row.get(field) is not None for row in areas.rows))
                  for name, field in (("SPEEDS", "speed_kmh"), ("NAMES", "name"))}
        return {"LANE_COUNT": float(len(lanes)), "KNOWN": float(len(known)), **counts}


def _ways_of_layer(source, crs):
    """The roads of a layer of lines in the CRS of the lanes."""
    if source.kind != LINE or not source.stored_crs:
        raise RoadExtractionError(tr("{label} must be a layer of lines with a CRS.", label=source.label))
    lines = [(shapely.get_coordinates(part), dict(zip(source.names, values))) for wkb, values in source.stored_rows() if wkb
             for part in shapely.get_parts(shapely.from_wkb(wkb))]
    return products.export.road_attributes.ways_in(lines, source.stored_crs, crs)


ROADS = "products.export.opendrive.exporter:OpenDriveSettings"
ROAD_SETTINGS = settings_of(ROADS, "TOLERANCE")


def add_road_choices(algorithm):
    algorithm.add_input("choice", "VERSION", default="1.7", choices=("1.7", "1.8"))
    algorithm.add_settings(ROAD_SETTINGS)
    algorithm.add_input("choice", "TRAFFIC_SIDE", default="automatic", choices=("automatic", "right", "left"))


class ExportOpenDrive(Algorithm):
    ID, TITLE, GROUP = "exportopendrive", "Export OpenDRIVE", "Export"
    NUMBERS = "ROADS JUNCTIONS SUCCESSORS BORDER_MAXIMUM HEIGHT_MAXIMUM DRIVING_LINE_P95 FINDINGS".split()

    def declare(self):
        add_road_map_layers(self)
        add_road_choices(self)
        self.add_map_layer("SIGNALS", optional=True)
        self.add_output("file", "OUTPUT", suffixes=(".xodr",), file_filter="OpenDRIVE (*.xodr)")
        self.add_report()

    def work(self, call, progress):
        return write_opendrive(call, lanes_with_borders(road_map_source(call, progress.part(0.0, 0.2))), call.layer_name("LANES"), progress)


def write_opendrive(call, source, name, progress):
    """Write a RoadMapSource with shared borders as OUTPUT, and its report; returns the numbers. `name`: of what it was made of."""
    settings = call.settings(ROAD_SETTINGS, version=call.value("VERSION"), traffic_side=call.value("TRAFFIC_SIDE"))
    sources, xodr = products.export.sources, products.export.opendrive.xodr
    draft = products.export.opendrive.exporter.draft_opendrive(source, settings, progress.part(0.2, 0.7))
    draft.map.reference = sources.reference_of_crs(source.lanes.crs)
    path = call.new_file("OUTPUT")
    Path(path).write_text(xodr.opendrive_text(draft.map), encoding="utf-8")
    whole = xodr.read_opendrive(path)
    shown = xodr.layers_of_opendrive(whole, source.lanes.crs)
    check = products.export.check.roads.check_opendrive(whole, source.lanes.crs, progress.part(0.7, 0.9))
    across, rise = sources.border_misses(source.lanes, shown.lanes)
    driven = sources.driving_line_misses(source.driving_lines, shown.lanes)
    led = source.led_to_middles()
    single = sources.driving_line_misses(source.driving_lines, shown.lanes, apart_from=led) if len(led) else driven
    notes = [*source.notes, *draft.notes]
    if not source.lanes.crs:
        notes.append(tr("The layer of lanes has no CRS: the file has no geoReference."))
    if across.largest > settings.tolerance or rise.largest > settings.tolerance:
        x, y, _ = (across if across.largest > settings.tolerance else rise).worst
        notes.append(tr("Borders lie up to {across:.3f} m beside and {rise:.3f} m above or below those of the survey, more than the tolerance, the "
                        "farthest near x {x:.1f}, y {y:.1f}.", across=across.largest, rise=rise.largest, x=x, y=y))
    warn_of_faults(notes, check, progress)
    progress.info(tr("{roads} roads, {junctions} junctions; borders within {across:.3f} m of the survey's.", roads=len(whole.roads),
                     junctions=len(whole.junctions), across=across.largest))
    if call.wants("REPORT"):
        call.text("REPORT", _report(name, whole, check, shown, (across, rise, driven, single), notes))
    numbers = {"ROADS": len(whole.roads), "JUNCTIONS": len(whole.junctions), "SUCCESSORS": check.successors, "FINDINGS": len(check.found),
               "BORDER_MAXIMUM": across.largest, "HEIGHT_MAXIMUM": rise.largest}
    if driven.places:
        numbers["DRIVING_LINE_P95"] = driven.p95
    return {name: float(value) for name, value in numbers.items()}


def _report(name, whole, network, shown, misses, notes):
    lengths = defaultdict(float)
    for road in whole.roads:
        for element in road.plan.elements:
            lengths[element.kind] += element.length
    facts = [(tr("Roads"), len(whole.roads)), (tr("Junctions"), len(whole.junctions)), (tr("Lanes of sections that are driven"), network.lanes),
             (tr("Links from one lane to the next"), network.successors), (tr("Pairs of lanes side by side"), network.neighbours),
             (tr("False origin"), f"{whole.offset[0]:g}, {whole.offset[1]:g}"), ("geoReference", whole.reference or tr("none"))]
    names = (tr("Borders, across"), tr("Borders, in height"), tr("Driving lines from the middles of lanes (measured)"),
             tr("The same, of lanes beside no double line"))
    tables = [
        (tr("Against the survey"), ("", tr("Mean (m)"), "95 % (m)", tr("Largest (m)"), tr("Places")),
         [(name, round(miss.mean, 4), round(miss.p95, 4), round(miss.largest, 4), miss.places) for name, miss in zip(names, misses) if miss.places]),
        (tr("Elements of the reference lines"), (tr("Element"), tr("Length (m)")),
         [(word(kind, "element"), round(metres, 1)) for kind, metres in sorted(lengths.items())]),
    ]
    return products.report.hd_map.map_export_report(tr("OpenDRIVE map"), name, facts, tables + fault_table(network), notes, shown)


LANELET_SETTINGS = settings_of("products.export.lanelet_export:LaneletSettings", "SPEED_LIMIT")


def add_lanelet_choices(algorithm):
    algorithm.add_settings(LANELET_SETTINGS)
    algorithm.add_input("choice", "LOCATION", default="urban", choices=("urban", "nonurban"))
    algorithm.add_input("flag", "LOCAL_COORDINATES", default=False)


class ExportLanelet2(Algorithm):
    ID, TITLE, GROUP = "exportlanelet2", "Export Lanelet2", "Export"
    NUMBERS = "LANELETS WAYS NODES SUCCESSORS FINDINGS".split()

    def declare(self):
        add_road_map_layers(self)
        add_lanelet_choices(self)
        self.add_map_layer("SIGNALS", optional=True)
        self.add_output("file", "OUTPUT", suffixes=(".osm",), file_filter="Lanelet2 (*.osm)")
        self.add_report()

    def work(self, call, progress):
        return write_lanelet2(call, lanes_with_borders(road_map_source(call, progress.part(0.0, 0.2))), call.layer_name("LANES"), progress)


def write_lanelet2(call, source, name, progress):
    """Write a RoadMapSource with shared borders as OUTPUT, and its report; returns the numbers. `name`: of what it was made of."""
    progress.report(0.2)
    draft = products.export.lanelet_export.draft_lanelets(source, call.settings(LANELET_SETTINGS, location=call.value("LOCATION")))
    degrees = products.export.lanelet_export.to_degrees(draft.nodes, source.lanes.crs)
    path = call.new_file("OUTPUT")
    Path(path).write_text(products.export.lanelet_export.lanelet2_text(draft, degrees, call.value("LOCAL_COORDINATES")), encoding="utf-8")
    progress.report(0.6)
    whole = products.export.lanelet_map.read_lanelet2(path)
    check = products.export.check.lanelets.check_lanelets(whole, *products.export.lanelet_map.node_places(whole, source.lanes.crs))
    progress.report(0.8)
    notes = [*source.notes, *(tr("{count} pieces of the type {kind} are no lanelets and were left out.", count=count, kind=kind)
                              for kind, count in draft.skipped.items())]
    if draft.added:
        notes.append(tr("{count} lanes end where another begins that they are not linked to; in Lanelet2 the one leads to the other.",
                        count=draft.added))
    if draft.unmet:
        notes.append(tr("{count} links of the map join lanes whose ends do not meet; Lanelet2 cannot say them, and they were left out.",
                        count=draft.unmet))
    if degrees.local:
        notes.append(tr("The layer of lanes has no CRS: the map has local coordinates, and latitudes and longitudes about 0."))
    warn_of_faults(notes, check, progress)
    numbers = {"LANELETS": float(len(draft.lanelets)), "WAYS": float(len(whole.ways)), "NODES": float(len(whole.node_ids)),
               "SUCCESSORS": float(check.successors), "FINDINGS": float(len(check.found))}
    progress.info(tr("{count} lanelets; latitude and longitude by: {way}.", count=len(draft.lanelets), way=told(degrees.way)))
    if call.wants("REPORT"):
        accuracy = f"{degrees.accuracy:g} m" if degrees.accuracy >= 0 else tr("not stated")
        facts = [(tr("Lanelets"), len(draft.lanelets)), (tr("Links from one lane to the next"), check.successors),
                 (tr("Pairs of lanes side by side"), check.neighbours), (tr("Ways"), len(whole.ways)), (tr("Nodes"), len(whole.node_ids)),
                 (tr("Transformation to latitude and longitude"), told(degrees.way)), (tr("Accuracy of the transformation"), accuracy),
                 (tr("Heights"), told(degrees.vertical))]
        layers = products.export.lanelet_map.layers_of_lanelets(whole, source.lanes.crs)
        call.text("REPORT", products.report.hd_map.map_export_report(tr("Lanelet2 map"), name, facts, fault_table(check), notes, layers))
    return numbers


SUFFIXES = {"dxf": (".dxf",), "landxml": (".xml", ".landxml")}   # format -> endings
CAD_SETTINGS = settings_of(ROADS, "TOLERANCE")


class ExportCad(Algorithm):
    ID, TITLE, GROUP = "exportcad", "Export CAD", "Export"
    NUMBERS = "LINES ALIGNMENTS MISSED".split()

    def declare(self):
        add_road_map_layers(self)
        self.add_input("choice", "FORMAT", default="dxf", choices=tuple(SUFFIXES))
        self.add_settings(CAD_SETTINGS)
        self.add_output("file", "OUTPUT", suffixes=(".dxf", ".xml", ".landxml"), file_filter="DXF (*.dxf);;LandXML (*.xml *.landxml)")
        self.add_report()

    def work(self, call, progress):
        kind, path = call.value("FORMAT"), call.destination("OUTPUT") or ""
        named = next((name for name, suffixes in SUFFIXES.items() if path.lower().endswith(suffixes)), kind)
        if named != kind and path != "TEMPORARY_OUTPUT":
            raise RoadExtractionError(tr("{path} has the ending of {named}, but FORMAT is {kind}. Change one of them.", path=path, named=named,
                                         kind=kind))
        source = road_map_source(call, progress.part(0.0, 0.2))
        progress.warn_all(source.notes)
        numbers, tables = (_dxf if kind == "dxf" else _landxml)(call, source, progress)
        if call.wants("REPORT"):
            facts = [(tr("Format"), {"dxf": "DXF", "landxml": "LandXML 1.2"}[kind]), (tr("Lines"), int(numbers["LINES"]))]
            call.text("REPORT", products.report.hd_map.map_export_report(
                tr("Road map for CAD"), call.layer_name("LANES"), facts, tables, source.notes))
        return numbers


def _dxf(call, source, progress):
    lines = products.cad.dxf_lines(source)
    products.cad.write_dxf(lines, call.new_file("OUTPUT"), source.lanes.crs)
    counts = Counter(line.layer for line in lines)
    progress.info(tr("{count} polylines in {layers} layers.", count=len(lines), layers=len(counts)))
    return {"LINES": float(len(lines)), "ALIGNMENTS": 0.0, "MISSED": 0.0}, [(tr("Layers"), (tr("Layer"), tr("Polylines")), sorted(counts.items()))]


def _landxml(call, source, progress):
    tolerance = call.value("TOLERANCE")
    alignments = products.cad.alignments_of(source, tolerance)
    text = products.cad.landxml_text(alignments, source.lanes.crs, call.layer_name("LANES"), datetime.now())
    Path(call.new_file("OUTPUT")).write_text(text, encoding="utf-8")
    irregular = sum(alignment.plan is None for alignment in alignments)
    if irregular:
        progress.warn(tr("{count} lines are followed by no elements within the tolerance and are irregular lines.", count=irregular))
    missed = max((alignment.missed for alignment in alignments), default=0.0)
    progress.info(tr("{count} alignments, {length:.0f} m; elements within {missed:.3f} m of their lines.", count=len(alignments),
                     length=sum(alignment.length for alignment in alignments), missed=missed))
    rows = [(one.name, told(one.description), round(one.length, 2), len(one.plan.elements) if one.plan is not None else None, len(one.profile))
            for one in alignments]
    tables = [(tr("Alignments"), (tr("Name"), tr("What it is"), tr("Length (m)"), tr("Elements"), tr("Points of the profile")), rows)]
    return {"LINES": float(len(alignments)), "ALIGNMENTS": float(len(alignments)), "MISSED": missed}, tables


PAPERS = ("A4", "A3", "A2", "A1", "A0")
SCALES = ("1:100", "1:200", "1:250", "1:500", "1:1000", "1:2000", "1:2500", "1:5000")
# Results that are drawn, from above
DRAWN = ("DRIVING_LINES", "ROAD_EDGES", "MARKING_LINES", "CROSS_SECTIONS", "MARKINGS", "LANES", "ROAD_SURFACE")


@dataclass(frozen=True)
class SheetSettings(Limited):
    """What the user chose; what is "" is filled in by the program."""

    title: str = ""
    office: str = ""
    author: str = ""
    heights: str = ""
    credit: str = ""
    paper: str = choice("A3", PAPERS, "The paper")
    orientation: str = choice("landscape", ("landscape", "portrait"), "The orientation")
    scale: str = choice("automatic", ("automatic", *SCALES), "The scale")
    profile: bool = True
    section_interval: float = setting(20.0, 0.0, 10_000.0, "Interval of the cross-sections", "m")


SHEET_SETTINGS = settings_of("algorithms.export:SheetSettings",
    "TITLE OFFICE AUTHOR PAPER ORIENTATION SCALE PROFILE SECTION_INTERVAL HEIGHT_SYSTEM* CREDIT*", HEIGHT_SYSTEM=dict(field="heights"))


class PrintSheets(Algorithm):
    ID, TITLE, GROUP = "printsheets", "Sheets along the road", "Export"
    NUMBERS = "SHEETS PAGES SCALE_NUMBER".split()
    DRAWS = True

    def declare(self):
        # what is printed on every sheet comes first: the layers are chosen already
        self.add_settings(SHEET_SETTINGS)
        for name in DRAWN:
            self.add_map_layer(name, optional=True)
        self.add_input("cloud", "ROAD_POINTS", optional=True)
        self.add_input("painted", "BELOW", optional=True)
        self.add_input("choice", "LANGUAGE", default="automatic", choices=("automatic", *languages()))
        self.add_input("flag", "KEEP", default=True)
        self.add_output("file", "OUTPUT", suffixes=(".pdf",), file_filter="PDF (*.pdf)")

    def work(self, call, progress):
        return call.print_sheets(call.settings(SHEET_SETTINGS), progress)


class ImportOpenDrive(Algorithm):
    ID, TITLE, GROUP = "importopendrive", "Import OpenDRIVE", "Export"
    NUMBERS = "LANE_COUNT LENGTH".split()
    FILES, LANELETS = "OpenDRIVE (*.xodr *.XODR *.xml)", False

    def declare(self):
        self.add_input("file", "INPUT", file_filter=f"{self.FILES};;All files (*.*)")
        self.add_input("crs", "CRS", optional=True)
        self.add_sink("LANES", fields=LANES + ROAD_ATTRIBUTES, geometry="PolygonZ", optional=True)
        for name in READ_LAYERS:
            self.add_map_sink(name, optional=True)

    def work(self, call, progress):
        return write_map_layers(call, map_layers(call, progress, self.LANELETS), progress)


class ImportLanelet2(ImportOpenDrive):
    ID, TITLE, GROUP = "importlanelet2", "Import Lanelet2", "Export"
    FILES, LANELETS = "Lanelet2 (*.osm *.OSM *.xml)", True


class ConvertMap(Algorithm):
    ID, TITLE, GROUP = "converthdmap", "Convert HD map", "Export"
    NUMBERS = "SUCCESSORS FINDINGS SIGNAL_COUNT LEFT_OUT".split()

    def declare(self):
        add_any_map(self)
        add_road_choices(self)
        add_lanelet_choices(self)
        self.add_output("file", "OUTPUT", suffixes=(".osm", ".xodr"), file_filter="Lanelet2 (*.osm);;OpenDRIVE (*.xodr)")
        self.add_report()

    def work(self, call, progress):
        path, output = map_file(call), str(call.output_path("OUTPUT"))
        from_lanelets = _is_lanelet2(path)
        if from_lanelets == output.lower().endswith(".osm"):
            raise RoadExtractionError(tr("{path} is {kind} already, and {output} would be too. Give the result the ending {ending}.", path=path,
                                         output=output, kind="Lanelet2" if from_lanelets else "OpenDRIVE",
                                         ending=".xodr" if from_lanelets else ".osm"))
        layers = map_layers(call, progress.part(0.0, 0.2), from_lanelets)
        source = lanes_with_borders(products.export.sources.checked(layers))
        numbers = (write_opendrive if from_lanelets else write_lanelet2)(call, source, Path(path).name, progress.part(0.2, 1.0))
        return {"SUCCESSORS": numbers["SUCCESSORS"], "FINDINGS": numbers["FINDINGS"], "SIGNAL_COUNT": float(len(layers.signals)),
                "LEFT_OUT": float(sum(layers.left_out.values()))}


ROWS_IN_LOG, PLACES_IN_LOG = 50, 3   # of findings that the log tells, and of the places of each


class CheckMap(Algorithm):
    ID, TITLE, GROUP = "checkhdmap", "Check HD map", "Export"
    NUMBERS = "FINDINGS FAULTS LANES SUCCESSORS NEIGHBOURS".split()

    def declare(self):
        add_any_map(self)
        self.add_sink("OUTPUT", fields=MAP_FINDINGS, geometry="PointZ", look="FINDINGS")
        self.add_report()

    def work(self, call, progress):
        path = map_file(call)
        lanelets = _is_lanelet2(path)
        whole, crs, notes = read_map(call, progress.part(0.0, 0.4), lanelets)
        rest = progress.part(0.4, 0.95)
        if lanelets:
            check = products.export.check.lanelets.check_lanelets(whole, *products.export.lanelet_map.node_places(whole, crs), rest)
        else:
            check = products.export.check.roads.check_opendrive(whole, crs, rest)
        progress.warn_all(notes)
        call.layer("OUTPUT", check.to_features())
        if call.wants("REPORT"):
            call.text("REPORT", products.report.hd_map.map_check_report(check, path, notes))
        counts = check.counts()
        groups, _ = check.groups()
        for group in groups[:ROWS_IN_LOG]:
            places = products.report.hd_map.places_of_findings(group, PLACES_IN_LOG)
            progress.warn(tr("{fault}: {count} ({places}). {text}", fault=told(group.worst.fault), count=group.count, places=places,
                             text=told(group.worst.text)))
        if len(groups) > ROWS_IN_LOG:
            progress.warn(tr("The first {shown} of {count}; the layer has all of them.", shown=ROWS_IN_LOG, count=len(groups)))
        progress.info(tr("{findings} findings; {lanes} driven lanes and pieces, {successors} links to the next, {neighbours} pairs side by side.",
                         findings=len(check.found), lanes=check.lanes, successors=check.successors, neighbours=check.neighbours))
        return {"FINDINGS": float(len(check.found)), "FAULTS": float(len(counts)), "LANES": float(check.lanes),
                "SUCCESSORS": float(check.successors), "NEIGHBOURS": float(check.neighbours)}


def _is_lanelet2(path):
    """Whether a file begins as maps of OpenStreetMap do."""
    with open(path, "rb") as file:
        head = file.read(4096)
    if b"<osm" not in head and b"<OpenDRIVE" not in head:
        raise RoadExtractionError(tr("{path} begins neither as OpenDRIVE nor as Lanelet2 does. Choose a file with the ending .xodr or .osm.",
                                     path=path))
    return b"<osm" in head


# The road map under the names, codes and fields of whoever ordered it.

# Parameters, which are the names of the layers in a template
TEMPLATE_LAYERS = ("ROAD_EDGES", "ROAD_SURFACE", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "LANES", "ROADSIDE", "ROADSIDE_OBJECTS",
                   "CROSS_SECTIONS")


class ExportTemplate(Algorithm):
    ID, TITLE, GROUP = "exporttemplate", "Export by template", "Export"
    NUMBERS = "FEATURES LAYERS LEFT_OUT".split()

    def declare(self):
        self.add_input("file", "TEMPLATE", file_filter="CSV (*.csv *.CSV *.tsv *.txt);;All files (*.*)")
        for name in TEMPLATE_LAYERS:
            self.add_map_layer(name, help=tr("Rows with {name} in the column from are about it.", name=name), optional=True)
        self.add_input("file", "OFFICE", optional=True, file_filter="GeoPackage (*.gpkg *.GPKG);;All files (*.*)")
        self.add_input("connection", "CONNECTION", optional=True)
        self.add_input("schema", "SCHEMA", optional=True, of="CONNECTION")
        self.add_output("file", "OUTPUT", optional=True, suffixes=(".gpkg", ".dxf"), file_filter="GeoPackage (*.gpkg);;DXF (*.dxf)")

    def work(self, call, progress):
        client, schema = products.client_fields, call.value("SCHEMA") or ""
        if bool(schema) != call.given("CONNECTION") or not (schema or call.wants("OUTPUT")):
            raise RoadExtractionError(tr("Nothing says where the map goes. Name a file as {output}, or both {connection} and {schema}.",
                                         output=call.label("OUTPUT"), connection=call.label("CONNECTION"), schema=call.label("SCHEMA")))
        database = client.Database(call.connection("CONNECTION"), schema, call.value("CONNECTION")) if schema else None
        drawing = call.wants("OUTPUT") and str(call.output_path("OUTPUT")).lower().endswith(".dxf")
        office = existing_file(call.file("OFFICE"), call.label("OFFICE")) if call.given("OFFICE") else ""
        if drawing and office:
            raise RoadExtractionError(tr("The client's GeoPackage cannot be filled as a DXF drawing. Leave it out, or name the result .gpkg."))
        known = {name: (MAP_LAYERS[name].schema, MAP_LAYERS[name].geometry) for name in TEMPLATE_LAYERS}
        template = client.read_template(existing_file(call.file("TEMPLATE"), call.label("TEMPLATE")), known, mixed=drawing)
        layers = {name: call.features(name, [replace(field, needed=False) for field in schema], geometry)
                  for name, (schema, geometry) in known.items() if call.given(name)}
        if not layers:
            raise RoadExtractionError(tr("No layer of the road map was given. Choose at least one of those that the template names."))
        for name in sorted({rule.source for rule in template.rules} - set(layers)):
            progress.info(tr("{label} was not given: the rows about it are not used.", label=call.label(name)))
        crs = next((features.crs for features in layers.values() if features.crs), "")
        for name, features in layers.items():
            if features.crs and not core.io.crs.same_crs(core.io.crs.parse_crs(features.crs), core.io.crs.parse_crs(crs)):
                raise RoadExtractionError(tr("{label} is in another CRS than the other layers. Reproject it to theirs and run again.",
                                             label=call.label(name)))
        made = client.apply_template(template, layers, client.layers_of_client(office, crs, template) if office else None)
        stored = client.apply_template(template, layers, client.layers_of_client(database, crs, template), whole=False).layers if database else {}
        if drawing:
            products.cad.write_dxf(products.cad.drawn_layers(made.layers), call.new_file("OUTPUT"), crs)
        elif call.wants("OUTPUT"):
            client.write_client_layers(made.layers, call.new_file("OUTPUT"), office)
        if database:
            client.write_client_layers(stored, database)
        for name, features in made.layers.items():
            progress.info(tr("{name}: {count:,} features", name=name, count=len(features)))
        for what, count in sorted(made.left_out.items()):
            progress.warn(tr("No row of the template takes {count} feature(s) of {what}.", count=count, what=what))
        return {"FEATURES": float(sum(map(len, made.layers.values()))), "LAYERS": float(len(made.layers)),
                "LEFT_OUT": float(sum(made.left_out.values()))}


# The survey's own point clouds, given back with classes and the fields of the road.

CLOUD_SETTINGS = settings_of("products.cloud.classify:CloudSettings", "GROUND_THICKNESS CURB_WIDTH REACH_BESIDE",
    GROUND_THICKNESS=dict(field="ground"), CURB_WIDTH=dict(field="curb"), REACH_BESIDE=dict(field="beside"))
# parameter -> the fields that are read; in the order of CloudLayers
CLOUD_LAYERS = {"ROAD_SURFACE": "road station_m", "ROAD_EDGES": "road station_m height_m edge", "MARKINGS": "road station_m",
                "ROADSIDE": "road station_m kind height_m", "ROADSIDE_OBJECTS": "road station_m kind height_m diam_m"}


class ClassifyCloud(Algorithm):
    ID, TITLE, GROUP = "classifycloud", "Classify point cloud", "Export"
    NUMBERS = "FILES POINTS ROAD_POINTS PAINT_POINTS CURB_POINTS".split()

    def declare(self):
        self.add_survey()
        for name in CLOUD_LAYERS:
            self.add_map_layer(name, optional=True)
        self.add_settings(CLOUD_SETTINGS, advanced=True)
        self.add_settings(READING_SETTINGS)
        self.add_input("flag", "COPC", default=False, advanced=True)
        self.add_output("folder", "OUTPUT")
        self.add_output("folder", "UNROLLED", optional=True, by_default=False)

    def work(self, call, progress):
        classify, PointClass = products.cloud.classify, products.cloud.classify.PointClass
        files = core.survey.las.reader.read_headers(call.point_clouds(), given=call.crs())
        copies = _copies(call, files)
        # what was drawn by hand has no station
        layers = {name: call.features(name, [replace(field, needed=field.needed and field.name != "station_m") for field in MAP_LAYERS[name].schema
                                             if field.name in read.split()], MAP_LAYERS[name].geometry)
                  for name, read in CLOUD_LAYERS.items()}
        survey = open_survey_with(call, layers, progress.part(0.0, 0.4))
        samples = core.survey.las.samples.sample_files(files)
        intensity = core.survey.las.point_fields.intensity_source_of(samples, call.value("INTENSITY_FROM"))[0]
        brightness = {file.path: file.brightness for file in survey.files}
        files = [replace(file, brightness=brightness.get(file.path, 1)) for file in files]
        classifier = classify.PointClassifier(
            survey, classify.CloudLayers(*layers.values()), call.settings(CLOUD_SETTINGS), call.value("CORRIDOR"), intensity)
        total, done, counts = sum(file.count for file in files), 0, Counter()
        for file, copy in zip(files, copies):
            part = progress.part(0.4 + 0.6 * done / total, 0.4 + 0.6 * (done + file.count) / total)
            counts.update(products.cloud.rewrite.classified_copy(file, classifier, *copy, part))
            done += file.count
        for number, count in sorted(counts.items()):
            name = PointClass(number).name.lower().replace("_", " ") if number in set(PointClass) else ""
            progress.info(tr("Class {number} {name}: {count:,} points", number=number, name=name, count=count))
        return {"FILES": float(len(files)), "POINTS": float(done), "ROAD_POINTS": float(counts[PointClass.ROAD_SURFACE]),
                "PAINT_POINTS": float(counts[PointClass.PAINT]), "CURB_POINTS": float(counts[PointClass.CURB])}


def _copies(call, files):
    """(path, path of the unrolled copy) for each of the files, whose names must differ."""
    names = [Path(file.path) for file in files]
    is_copc, waveforms = core.survey.road_points_las.is_copc, (4, 5, 9, 10)
    names = [f"{path.stem}.copc.laz" if call.value("COPC") and not is_copc(path) and file.point_format not in waveforms else path.name
             for file, path in zip(files, names)]
    twice = next((name for k, name in enumerate(names) if name.lower() in {other.lower() for other in names[:k]}), None)
    if twice:
        raise RoadExtractionError(tr("Two of the point clouds would be written to {name}. Rename one, or run once for each folder.", name=twice))
    return [(call.new_file_in("OUTPUT", name), call.new_file_in("UNROLLED", name)) for name in names]
