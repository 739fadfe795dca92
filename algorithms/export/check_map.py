"""The check of an HD map."""

from ...core.common.errors import RoadExtractionError
from ...core.common.features import MAP_FINDINGS
from ..algorithm import Algorithm
from ..texts import told, tr
from .inputs import add_map_file, map_file

MAP_FILTER = "HD maps (*.xodr *.osm *.XODR *.OSM *.xml);;All files (*.*)"
ROWS_IN_LOG, PLACES_IN_LOG = 50, 3   # of findings that the log tells, and of the places of each


class CheckMap(Algorithm):
    ID, TITLE, GROUP = "checkhdmap", "Check HD map", "Export"
    SUMMARY = "Looks for faults of an OpenDRIVE or Lanelet2 map that other validators pass over, and puts them on the map."
    HELP = ("OpenDRIVE: gaps, kinks and steps between geometries, profiles and linked lanes, wrong lengths, lanes narrower than nothing, borders "
            "that fold back in curves, numbering, types, links that lead nowhere or one way only, lanes that end though the road goes on, roads on "
            "one another, words, numbers and orders of records that the standard does not have, a geoReference that is none.\n\n"
            "Lanelet2: missing nodes and members, types and tags that no reader knows, borders that cross, swap sides or lie there twice, lanelets "
            "that meet without sharing their nodes or meet head on, nodes that lie aside, rules of traffic that are not whole or that nobody "
            "obeys.\n\n"
            "The same finding at many places is one row of the report and one line of the log, with its count, its places and the largest; those at "
            "the fewest places come first. A schema validator looks at other things; use both.")
    TAGS = ("OpenDRIVE", "Lanelet2", "HD map", "validation", "topology", "routing")
    LOOKS = {"OUTPUT": "FINDINGS"}
    NUMBERS = (("FINDINGS", tr("Findings")), ("FAULTS", tr("Kinds of faults")), ("LANES", tr("Driven lanes and pieces")),
               ("SUCCESSORS", tr("Links from one lane to the next")), ("NEIGHBOURS", tr("Pairs of lanes side by side")))

    def declare(self):
        add_map_file(self, tr("Map file"), tr("An OpenDRIVE (.xodr) or Lanelet2 (.osm) map; what is in it decides."), MAP_FILTER)
        self.add_input("crs", "CRS", tr("CRS of the findings"), tr(
            "OpenDRIVE: only where the file does not say it. Lanelet2: projected, such as that of the survey; empty takes the UTM zone of the map."),
            optional=True)
        self.add_sink("OUTPUT", tr("Findings"), tr(
            "A point for each finding, with the row of the report in which the same findings are one. Heights are the map's."),
            fields=MAP_FINDINGS, geometry="PointZ")
        self.add_report()

    def work(self, call, progress):
        from ...products.report.hd_map import map_check_report, places_of_findings

        path = map_file(call)
        check, note = (_lanelets if _is_lanelet2(path) else _roads)(path, call.crs(), progress)
        if note:
            progress.warn(note)
        call.layer("OUTPUT", check.to_features())
        if call.wants("REPORT"):
            call.text("REPORT", map_check_report(check, path, [note] if note else []))
        counts = check.counts()
        groups, _ = check.groups()
        for group in groups[:ROWS_IN_LOG]:
            progress.warn(tr("{fault}: {count} ({places}). {text}").format(
                fault=told(group.worst.fault), count=group.count, places=places_of_findings(group, PLACES_IN_LOG), text=told(group.worst.text)))
        if len(groups) > ROWS_IN_LOG:
            progress.warn(tr("The first {shown} of {count}; the layer has all of them.").format(shown=ROWS_IN_LOG, count=len(groups)))
        progress.info(tr("{findings} findings; {lanes} driven lanes and pieces, {successors} links to the next, {neighbours} pairs side by "
                         "side.").format(
            findings=len(check.found), lanes=check.lanes, successors=check.successors, neighbours=check.neighbours))
        return {"FINDINGS": float(len(check.found)), "FAULTS": float(len(counts)), "LANES": float(check.lanes),
                "SUCCESSORS": float(check.successors), "NEIGHBOURS": float(check.neighbours)}


def _is_lanelet2(path):
    """Whether a file begins as maps of OpenStreetMap do."""
    with open(path, "rb") as file:
        head = file.read(4096)
    if b"<osm" not in head and b"<OpenDRIVE" not in head:
        raise RoadExtractionError(
            tr("{path} begins neither as OpenDRIVE nor as Lanelet2 does. Choose a file with the ending .xodr or .osm.").format(path=path))
    return b"<osm" in head


def _roads(path, crs, progress):
    from ...products.export.check.roads import check_opendrive
    from ...products.export.map_layers import crs_of_reference
    from ...products.export.opendrive.xodr import read_opendrive

    whole = read_opendrive(path, progress.part(0.0, 0.4))
    crs, note = crs_of_reference(whole.reference, crs)
    return check_opendrive(whole, crs, progress.part(0.4, 0.95)), note


def _lanelets(path, crs, progress):
    from ...products.export.check.lanelets import check_lanelets
    from ...products.export.lanelet_map import node_places, read_lanelet2

    whole = read_lanelet2(path, progress.part(0.0, 0.4))
    return check_lanelets(whole, *node_places(whole, crs), progress.part(0.4, 0.95)), ""
