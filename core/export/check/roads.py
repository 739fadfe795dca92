"""The check of an OpenDRIVE map: numbers first, then what is linked to what."""

from __future__ import annotations

import numpy as np
import shapely

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ..map_crs import metric_wkt
from ..opendrive.model import DRIVEN_TYPES, MARK_TYPES, ROAD_LANE_TYPES, MapRoad, OpenDriveMap
from ..opendrive.surface import RoadSurface
from .findings import Findings, metres
from .road_links import check_links
from .statements import statements

MAX_GAP_IN_ROAD = 0.01       # m: simulators of wheels feel more
MAX_KINK = 0.01              # rad between two geometries of one road
MAX_LENGTH_ERROR = 0.01     # m between the s of a geometry and the length before it
MAX_HEIGHT_STEP = 0.02       # m within a road
MAX_WIDTH_STEP = 0.02        # m of a border within a road
LEAST_OVERLAP = 0.3          # share of the smaller of two roads that lies on the other
FARTHEST_BOUND = 50.0        # m by which roads may reach beyond the bounds of the header
FOLD_STEP = 1.0              # m between the places at which borders are held against the curvature


def check_opendrive(whole: OpenDriveMap, crs: str = "", progress: Progress = Progress()) -> Findings:
    """Everything that is wrong with a map.

    Parameters
    ----------
    whole : OpenDriveMap
    crs : WKT of its coordinates, "" where unknown
    progress : told of the share of the roads

    Returns
    -------
    Findings
    """
    report = _RoadCheck(whole, Findings(crs=crs))
    seen: set[str] = set()
    for line, text in whole.problems:
        report.add("unreadable", f"line {line}", text, None, 0.0)
    for count, road in enumerate(whole.roads):
        if road.id in seen:
            report.add("id twice", f"road {road.id}", "There is another road of this id.", road, 0.0)
        seen.add(road.id)
        report.plan(road)
        report.profile(road)
        report.sections(road)
        report.objects(road)
        progress.report(0.6 * (count + 1) / len(whole.roads))
    report.statements()
    report.overlaps()
    check_links(whole, report.findings)
    progress.report(1.0)
    return report.findings


class _RoadCheck:
    """Looks at one road after the other."""

    def __init__(self, whole: OpenDriveMap, findings: Findings) -> None:
        self.whole, self.findings = whole, findings
        self.areas: dict[str, shapely.Geometry] = {}

    def add(self, fault, element, text, road, s):
        place = np.zeros(3)
        if road is not None:
            at = np.array([min(max(s, 0.0), road.plan.length)])
            place = self.whole.placed(np.c_[road.plan.at(at)[0], road.elevation.at(at)])[0]
        self.findings.add(fault, element, text, place)

    def statements(self) -> None:
        """What the file says that the format does not have, and whether its header fits the roads."""
        if self.whole.tree is not None:
            for fault, element, text, road, s in statements(self.whole.tree):
                self.add(fault, element, text, self.whole.road(road), s)
        if self.whole.reference:
            try:
                metric_wkt(self.whole.reference, "The map")
            except RoadExtractionError as problem:
                self.add("reference", "header", str(problem), None, 0.0)
        if self.whole.bounds is not None and self.whole.roads:
            west, south, east, north = self.whole.bounds
            places = np.concatenate([road.plan.at(np.array([0.0, road.plan.length]))[0] for road in self.whole.roads])
            outside = (places < np.array([west, south]) - FARTHEST_BOUND) | (places > np.array([east, north]) + FARTHEST_BOUND)
            if (east > west or north > south) and outside.any():
                x, y = places[np.flatnonzero(outside.any(1))[0]]
                self.add("bounds", "header", f"A road begins or ends at x {x:.1f}, y {y:.1f}, outside of them.", None, 0.0)

    def plan(self, road: MapRoad) -> None:
        name, along, last = f"road {road.id}", 0.0, None
        for element in road.plan.elements:
            if element.length <= 0:
                self.add("station", name, f"A geometry at s = {element.s:g} has the length {element.length:g} m.", road, element.s)
            if abs(element.s - along) > MAX_LENGTH_ERROR:
                self.add("station", name, f"A geometry says s = {element.s:.3f}; before it there are {along:.3f} m.", road, along)
            if last is not None:
                gap = float(np.hypot(element.x - last[0], element.y - last[1]))
                if gap > MAX_GAP_IN_ROAD:
                    self.add("gap", name, f"{metres(gap)} between two geometries at s = {element.s:.2f}.", road, element.s)
                turn = abs(float(wrapped(element.heading - last[2])))
                if turn > MAX_KINK:
                    self.add("kink", name, f"The direction jumps by {turn:.3f} rad at s = {element.s:.2f}.", road, element.s)
            last, along = element.end(), along + element.length
        if abs(road.length - along) > MAX_LENGTH_ERROR:
            self.add("road length", name, f"The road says {road.length:.3f} m; its geometries are {along:.3f} m.", road, along)

    def profile(self, road: MapRoad) -> None:
        for cubics, fault, what in ((road.elevation, "height step", "height"), (road.superelevation, "crossfall step", "crossfall")):
            for s, step in zip(*cubics.steps()):
                if step > MAX_HEIGHT_STEP:
                    self.add(fault, f"road {road.id}", f"The {what} jumps by {step:.3f} at s = {s:.2f}.", road, s)
        if road.rule not in ("RHT", "LHT"):
            self.add("traffic rule", f"road {road.id}", f"The rule is {road.rule!r}.", road, 0.0)

    def sections(self, road: MapRoad) -> None:
        if not road.sections:
            return
        starts = [section.s for section in road.sections]
        if abs(starts[0]) > MAX_LENGTH_ERROR or (np.diff(starts) <= 0).any() or starts[-1] >= road.length:
            self.add("section order", f"road {road.id}", f"Sections begin at {', '.join(f'{s:g}' for s in starts[:8])}.", road, 0.0)
            return
        surface = RoadSurface(road)
        outlines = []
        for number, section in enumerate(road.sections):
            self._numbering(road, section)
            length = road.section_end(number) - section.s
            for lane in section.lanes.values():
                name = f"road {road.id}, section {number}, lane {lane.id}"
                if lane.type not in ROAD_LANE_TYPES:
                    self.add("lane type", name, f"The type is {lane.type!r}.", road, section.s)
                for mark in lane.marks:
                    if mark.type not in MARK_TYPES:
                        self.add("road mark type", name, f"The type is {mark.type!r}.", road, section.s + mark.s)
                if lane.id == 0 or lane.border:
                    continue
                least, where = lane.width.least(length)
                if least < -1e-6:
                    self.add("width below zero", name, f"{least:.3f} m at s = {section.s + where:.2f}.", road, section.s + where)
                for s, step in zip(*lane.width.steps()):
                    if step > MAX_WIDTH_STEP:
                        self.add("width step", name, f"The width jumps by {metres(step)} at s = {section.s + s:.2f}.", road, section.s + s)
            outlines.append(self._borders(road, surface, number))
        for s, step in zip(*road.lane_offset.steps()):
            if step > MAX_WIDTH_STEP and s not in starts:
                self.add("width step", f"road {road.id}", f"The lane offset jumps by {metres(step)} at s = {s:.2f}.", road, s)
        if road.junction == "-1":
            self.areas[road.id] = shapely.union_all([outline for outline in outlines if outline is not None])

    def _numbering(self, road, section):
        name = f"road {road.id}, section at {section.s:g}"
        centre = section.lanes.get(0)
        if centre is None or len(centre.width):
            self.add("centre lane", name, "There is no lane 0." if centre is None else "Lane 0 has a width.", road, section.s)
        ids = [id for id in section.order if id]
        expected = sorted((id for id in ids if id > 0), reverse=True) + sorted((id for id in ids if id < 0), reverse=True)
        left, right = max(ids, default=0), min(ids, default=0)
        if ids != expected or set(ids) != set(range(right, left + 1)) - {0} and ids:
            self.add("lane order", name, f"The lanes are {', '.join(map(str, section.order))}.", road, section.s)
        if len(set(section.order)) != len(section.order):
            self.add("id twice", name, f"The lanes are {', '.join(map(str, section.order))}.", road, section.s)

    def _borders(self, road, surface, number):
        """The outline of a section's driven lanes; whether its borders fold."""
        s = surface.stations(number, FOLD_STEP)
        offsets = surface.offsets(number, s)
        bend = road.plan.at(s)[2]
        for id, t in offsets.items():
            folded = np.flatnonzero(1 - bend * t <= 0)
            if len(folded):
                at = s[folded[0]]
                self.add("border folds", f"road {road.id}, lane {id}",
                         f"{abs(t[folded[0]]):.1f} m beside a curve of {1 / abs(bend[folded[0]]):.1f} m at s = {at:.2f}.", road, at)
                return None
        driven = [id for id in offsets if id and road.sections[number].lanes[id].type in DRIVEN_TYPES]
        if not driven:
            return None
        rings = [np.concatenate([inner, outer[::-1]])[:, :2] for inner, outer in (surface.borders(number, id, s, offsets) for id in driven)]
        return shapely.union_all(shapely.make_valid(np.array([shapely.Polygon(ring) for ring in rings], object)))

    def objects(self, road: MapRoad) -> None:
        for item in road.objects:
            if not -MAX_LENGTH_ERROR <= item["s"] <= road.length + MAX_LENGTH_ERROR:
                self.add("object off the road", f"road {road.id}, object {item['id']}", f"It is at s = {item['s']:.2f} of {road.length:.2f} m.",
                         road, item["s"])

    def overlaps(self) -> None:
        ids, shapes = list(self.areas), np.array(list(self.areas.values()), object)
        if not len(ids):
            return
        tree = shapely.STRtree(shapes)
        for first, second in tree.query(shapes, predicate="intersects").T:
            if first >= second:
                continue
            least = min(shapes[first].area, shapes[second].area)
            common = shapes[first].intersection(shapes[second])
            if least > 0 and common.area > LEAST_OVERLAP * least and abs(self._height(ids[first]) - self._height(ids[second])) < 2.0:
                x, y = common.representative_point().coords[0]
                self.findings.add("two at one place", f"roads {ids[first]} and {ids[second]}", f"They share {common.area:.0f} m².",
                                  self.whole.placed(np.array([[x, y, 0.0]]))[0])

    def _height(self, id):
        road = self.whole.road(id)
        return float(road.elevation.at(road.length / 2)) if road is not None else 0.0


def wrapped(angle: np.ndarray | float) -> np.ndarray:
    """An angle in (-pi, pi]."""
    return (np.asarray(angle) + np.pi) % (2 * np.pi) - np.pi
