"""Writes OpenDRIVE 1.7 and 1.8."""

from __future__ import annotations

import numpy as np

from ..xml_tree import XmlElement, xml_text
from .geometry import Cubics, PlanElement
from .model import LaneSection, MapLane, MapRoad, OpenDriveMap, RoadMark

FILLED_BY_PAINT = 8  # of version 1: from there on outlines may be filled by paint
SOLID_LENGTH = 1.0   # m: a stripe without gaps is repeated from any length on


def opendrive_text(whole: OpenDriveMap, vendor: str = "Lanewright") -> str:
    """The file as text."""
    root = XmlElement("OpenDRIVE")
    places = np.concatenate([road.plan.at(np.linspace(0, road.plan.length, max(int(road.plan.length / 5), 1) + 1))[0] for road in whole.roads]) \
        if whole.roads else np.zeros((1, 2))
    (west, south), (east, north) = places.min(0), places.max(0)
    header = root.add("header", revMajor=whole.version[0], revMinor=whole.version[1], name=whole.name, version="1.0", north=_round(north),
                      south=_round(south), east=_round(east), west=_round(west), vendor=vendor)
    if whole.reference:
        header.add("geoReference", whole.reference)
    x, y, z, heading = whole.offset
    header.add("offset", x=x, y=y, z=z, hdg=heading)
    for road in whole.roads:
        root.append(_road(road, whole.version[1]))
    for junction in whole.junctions:
        element = root.add("junction", id=junction.id, name=junction.name, type="default")
        for connection in junction.connections:
            child = element.add("connection", id=connection.id, incomingRoad=connection.incoming, connectingRoad=connection.connecting,
                                contactPoint=connection.contact)
            for start, to in connection.lanes:
                child.append(XmlElement("laneLink", {"from": start, "to": to}))
    return xml_text(root)


def _road(road: MapRoad, minor: int) -> XmlElement:
    element = XmlElement("road", {"name": road.name, "length": float(road.length), "id": road.id, "junction": road.junction, "rule": road.rule})
    if road.predecessor or road.successor:
        link = element.add("link")
        for name, target in (("predecessor", road.predecessor), ("successor", road.successor)):
            if target is not None:
                link.add(name, elementType=target.element, elementId=target.id, contactPoint=target.contact or None)
    element.append(_plan(road.plan.elements))
    _rows(element.add("elevationProfile"), "elevation", road.elevation)
    lateral = element.add("lateralProfile")
    if np.abs(road.superelevation.rows[:, 1:]).max(initial=0.0) > 0:
        _rows(lateral, "superelevation", road.superelevation)
    for s, t, a, b, c, d in road.shape:
        lateral.add("shape", s=s, t=t, a=a, b=b, c=c, d=d)
    lanes = element.add("lanes")
    _rows(lanes, "laneOffset", road.lane_offset)
    for section in road.sections:
        lanes.append(_section(section))
    if road.objects:
        objects = element.add("objects")
        for item in road.objects:
            _add_object(objects, item, minor)
    for code, value in road.data.items():
        element.add("userData", code=code, value=value)
    return element


def _plan(elements: tuple[PlanElement, ...]) -> XmlElement:
    plan = XmlElement("planView")
    for one in elements:
        child = plan.add("geometry", s=one.s, x=one.x, y=one.y, hdg=one.heading, length=one.length)
        if one.kind == "line":
            child.add("line")
        elif one.kind == "arc":
            child.add("arc", curvature=one.values[0])
        elif one.kind == "spiral":
            child.add("spiral", curvStart=one.values[0], curvEnd=one.values[1])
        else:
            names = [name + axis for axis in "UV" for name in "abcd"]
            child.append(XmlElement("paramPoly3", dict(zip(names, one.values)) | {"pRange": "normalized" if one.normalized else "arcLength"}))
    return plan


def _rows(parent: XmlElement, tag: str, cubics: Cubics, start: str = "s") -> None:
    for s, a, b, c, d in cubics.rows:
        parent.append(XmlElement(tag, {start: s, "a": a, "b": b, "c": c, "d": d}))


def _section(section: LaneSection) -> XmlElement:
    element = XmlElement("laneSection", {"s": float(section.s)})
    for side, ids in (("left", [id for id in section.order if id > 0]), ("center", [0]), ("right", [id for id in section.order if id < 0])):
        if ids:
            group = element.add(side)
            for id in ids:
                group.append(_lane(section.lanes[id]))
    return element


def _lane(lane: MapLane) -> XmlElement:
    element = XmlElement("lane", {"id": lane.id, "type": lane.type, "level": "false"})
    if lane.predecessors or lane.successors:
        link = element.add("link")
        for name, ids in (("predecessor", lane.predecessors), ("successor", lane.successors)):
            for id in ids:
                link.add(name, id=id)
    _rows(element, "width", lane.width, "sOffset")
    for mark in lane.marks:
        _add_mark(element, mark)
    for s, inner, outer in lane.heights:
        element.add("height", sOffset=s, inner=inner, outer=outer)
    for code, value in lane.data.items():
        element.add("userData", code=code, value=value)
    return element


def _add_mark(lane: XmlElement, mark: RoadMark) -> None:
    width = mark.width if mark.type != "none" else None
    element = lane.add("roadMark", sOffset=mark.s, type=mark.type, weight=mark.weight, color=mark.colour, width=width, laneChange=None)
    stripes = mark.type.split(" ") if mark.apart else [mark.type] if mark.dash else []
    if stripes:
        kind = element.add("type", name=mark.type, width=mark.width)
        for stripe, t in zip(stripes, (mark.apart / 2, -mark.apart / 2)):
            dash, gap = (mark.dash, mark.gap) if "broken" in stripe else (SOLID_LENGTH, 0.0)
            kind.add("line", length=dash, space=gap, tOffset=t if mark.apart else 0.0, sOffset=0.0, width=mark.width)


def _add_object(objects: XmlElement, item: dict, minor: int) -> None:
    element = objects.add("object", id=item["id"], type=item["type"], name=item["name"], s=item["s"], t=item["t"], zOffset=item["zOffset"],
                          orientation=item["orientation"], length=item["length"], width=item["width"], hdg=item["hdg"])
    outline = element.add("outlines").add("outline", id=0, fillType="paint" if minor >= FILLED_BY_PAINT else None, outer="true", closed="true")
    tag, names = ("cornerLocal", ("u", "v", "z")) if item["local"] else ("cornerRoad", ("s", "t", "dz"))
    for number, corner in enumerate(item["corners"]):
        outline.append(XmlElement(tag, {"id": number} | dict(zip(names, corner)) | {"height": 0.0}))


def _round(value: float) -> float:
    return round(float(value), 3)
