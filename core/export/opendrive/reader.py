"""Reads OpenDRIVE 1.1 to 1.8."""

from __future__ import annotations

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ..xml_tree import XmlElement, read_xml
from .geometry import Cubics, PlanElement, PlanView
from .model import Connection, Junction, LaneSection, MapLane, MapRoad, OpenDriveMap, RoadLink, RoadMark

XODR_KIND = "an OpenDRIVE file"
MARK_WIDTH = 0.12    # m, where a road mark has none
LONGEST_ROAD, LONGEST_MAP = 200_000.0, 1_000_000.0   # m of one road, and of all: more is no map but a file that shall fill the memory


def read_opendrive(path: str, progress: Progress = Progress()) -> OpenDriveMap:
    """Read a file.

    Parameters
    ----------
    path : of the .xodr file
    progress : told of the share that was read

    Returns
    -------
    OpenDriveMap; what could not be read of it, such as a road without geometry, is in `problems`

    Raises
    ------
    RoadExtractionError
        If the file is no OpenDRIVE, hostile, or has no road that can be read.
    """
    root = read_xml(path, "OpenDRIVE", XODR_KIND, progress)
    found = opendrive_of(root)
    if not found.roads:
        why = f" Line {found.problems[0][0]}: {found.problems[0][1]}" if found.problems else ""
        raise RoadExtractionError(f"{path} has no road that can be read.{why} Choose a file with roads and their geometry.")
    length = sum(road.plan.length for road in found.roads)
    if length > LONGEST_MAP:
        raise RoadExtractionError(f"The roads of {path} are {length / 1000:,.0f} km long; at most {LONGEST_MAP / 1000:,.0f} km are read at once. "
                                  "Export the map again, or in parts.")
    return found


def opendrive_of(root: XmlElement) -> OpenDriveMap:
    """The map of the element <OpenDRIVE>."""
    found = OpenDriveMap(tree=root)
    header = root.find("header")
    if header is None:
        found.problems.append((root.line, "there is no <header>."))
    else:
        found.version = (int(header.number("revMajor", 1.0)), int(header.number("revMinor", 0.0)))
        found.name = header.get("name")
        sides = [header.number(name, 0.0) for name in ("west", "south", "east", "north") if name in header.attributes]
        found.bounds = (sides[0], sides[1], sides[2], sides[3]) if len(sides) == 4 else None
        reference, offset = header.find("geoReference"), header.find("offset")
        found.reference = reference.text if reference is not None else ""
        if offset is not None:
            found.offset = (offset.number("x", 0.0), offset.number("y", 0.0), offset.number("z", 0.0), offset.number("hdg", 0.0))
    for element in root.all("road"):
        try:
            found.roads.append(_road(element, found.problems))
        except RoadExtractionError as problem:
            found.problems.append((element.line, f"road {element.get('id')} cannot be read: {problem}"))
    for element in root.all("junction"):
        found.junctions.append(_junction(element))
    return found


def _road(element, problems):
    plan = element.find("planView")
    elements = sorted((_geometry(child) for child in (plan.all("geometry") if plan is not None else ())), key=lambda one: one.s)
    if not elements:
        raise RoadExtractionError("it has no geometry.")
    if sum(abs(one.length) for one in elements) > LONGEST_ROAD:
        raise RoadExtractionError(f"it is longer than {LONGEST_ROAD / 1000:g} km.")
    profile, lateral, lanes = element.find("elevationProfile"), element.find("lateralProfile"), element.find("lanes")
    road = MapRoad(
        element.get("id"), element.number("length", sum(one.length for one in elements)), PlanView(tuple(elements)), element.get("name"),
        element.get("junction", "-1"),
        element.get("rule", "RHT"), _link(element.find("link", "predecessor")), _link(element.find("link", "successor")),
        _cubics(profile, "elevation"), _cubics(lateral, "superelevation"), _shape(lateral), _cubics(lanes, "laneOffset"))
    for child in lanes.all("laneSection") if lanes is not None else ():
        road.sections.append(_section(child))
    road.sections.sort(key=lambda section: section.s)
    if not road.sections:
        problems.append((element.line, f"road {road.id} has no lane section."))
    objects = element.find("objects")
    road.objects = [_object(child) for child in (objects.all("object") if objects is not None else ())]
    return road


def _geometry(element):
    place = [element.number(name) for name in ("s", "x", "y", "hdg", "length")]
    for child in element.children:
        if child.tag == "line":
            return PlanElement(*place)
        if child.tag == "arc":
            return PlanElement(*place, "arc", (child.number("curvature"),))
        if child.tag == "spiral":
            return PlanElement(*place, "spiral", (child.number("curvStart"), child.number("curvEnd")))
        if child.tag == "poly3":
            return PlanElement(*place, "poly3", tuple(child.number(name) for name in "abcd"))
        if child.tag == "paramPoly3":
            values = tuple(child.number(name + axis) for axis in "UV" for name in "abcd")
            return PlanElement(*place, "paramPoly3", values, child.get("pRange", "normalized") == "normalized")
    raise RoadExtractionError(f"line {element.line}: a geometry is none of line, arc, spiral, poly3 and paramPoly3.")


def _link(element):
    if element is None:
        return None
    return RoadLink(element.get("elementType"), element.get("elementId"), element.get("contactPoint"))


def _cubics(parent, tag, start="s"):
    rows = [[child.number(start), *(child.number(name) for name in "abcd")] for child in (parent.all(tag) if parent is not None else ())]
    return Cubics(np.array(sorted(rows, key=lambda row: row[0]), float).reshape(-1, 5))


def _shape(parent):
    rows = [[child.number(name) for name in ("s", "t", "a", "b", "c", "d")] for child in (parent.all("shape") if parent is not None else ())]
    return np.array(rows, float).reshape(-1, 6)


def _section(element):
    section = LaneSection(element.number("s"))
    for side in ("left", "center", "right"):
        group = element.find(side)
        for child in group.all("lane") if group is not None else ():
            lane = _lane(child)
            section.order.append(lane.id)
            section.lanes[lane.id] = lane
    return section


def _lane(element):
    number = element.number("id")
    lane = MapLane(int(number), element.get("type"), _cubics(element, "width", "sOffset"))
    if not len(lane.width) and element.find("border") is not None:
        lane.width, lane.border = _cubics(element, "border", "sOffset"), True
    lane.marks = sorted((_mark(child) for child in element.all("roadMark")), key=lambda mark: mark.s)
    link = element.find("link")
    for child in link.children if link is not None else ():
        if child.tag in ("predecessor", "successor"):
            getattr(lane, child.tag + "s").append(int(child.number("id")))
    rows = [[child.number(name, 0.0) for name in ("sOffset", "inner", "outer")] for child in element.all("height")]
    lane.heights = np.array(sorted(rows), float).reshape(-1, 3)
    lane.data = {child.get("code"): child.get("value") for child in element.all("userData")}
    return lane


def _mark(element):
    mark = RoadMark(element.number("sOffset", 0.0), element.get("type", "none"), element.get("color", "standard"),
                    element.number("width", MARK_WIDTH), element.get("weight", "standard"))
    kind = element.find("type")
    lines = list(kind.all("line")) if kind is not None else []
    dashed = next((line for line in lines if line.number("space", 0.0)), None)
    if dashed is not None:
        mark.dash, mark.gap = dashed.number("length", 0.0), dashed.number("space", 0.0)
    if len(lines) == 2:
        mark.apart = abs(lines[0].number("tOffset", 0.0) - lines[1].number("tOffset", 0.0))
    return mark


def _object(element):
    found = {name: element.get(name) for name in ("id", "type", "subtype", "name", "orientation")}
    numbers = {name: element.number(name, 0.0) for name in ("s", "t", "zOffset", "length", "width", "hdg", "height")}
    outline = element.find("outlines", "outline") or element.find("outline")
    corners = [[corner.number(name, 0.0) for name in (("s", "t", "dz") if corner.tag == "cornerRoad" else ("u", "v", "z"))]
               for corner in (outline.children if outline is not None else ()) if corner.tag in ("cornerRoad", "cornerLocal")]
    local = outline is not None and outline.find("cornerLocal") is not None
    return {**found, **numbers, "corners": np.array(corners, float).reshape(-1, 3), "local": local}


def _junction(element):
    junction = Junction(element.get("id"), element.get("name"))
    for child in element.all("connection"):
        links = [(int(link.number("from")), int(link.number("to"))) for link in child.all("laneLink")]
        # a direct junction links roads without a road between
        connecting = child.get("connectingRoad") or child.get("linkedRoad")
        junction.connections.append(Connection(child.get("id"), child.get("incomingRoad"), connecting, child.get("contactPoint"), links))
    return junction
