"""What an OpenDRIVE file states, held against what the format allows: words, ranges of numbers, order of records, what excludes what.

References
----------
ASAM OpenDRIVE 1.7 and 1.8, the tables of attributes and the rules at the end of each section.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...common.errors import RoadExtractionError
from ..xml_tree import XmlElement

MINORS = range(9)                # of version 1
STATED_NEAR = 0.01               # m by which a record may lie beyond its end
FARTHEST_OBJECT = 100.0          # m beside the reference line
PI_HALF = np.pi / 2
POSITIVE, NOT_NEGATIVE = (0.0, np.inf, False), (0.0, np.inf, True)   # least, most, whether least itself may be
MARK_COLOURS = ("standard", "blue", "green", "red", "white", "yellow", "orange", "violet", "black")
ROAD_TYPES = ("unknown", "rural", "motorway", "town", "lowSpeed", "pedestrian", "bicycle", "townExpressway", "townCollector", "townArterial",
              "townPrivate", "townLocal", "townPlayStreet")
OBJECT_TYPES = ("", "-1", "none", "obstacle", "car", "pole", "tree", "vegetation", "barrier", "building", "parkingSpace", "patch", "railing",
                "trafficIsland", "crosswalk", "streetLamp", "gantry", "soundBarrier", "van", "bus", "trailer", "bike", "motorbike", "tram", "train",
                "pedestrian", "wind", "roadMark", "roadSurface")
ORIENTATIONS = ("+", "-", "none")
PLAN_SHAPES = ("line", "spiral", "arc", "poly3", "paramPoly3")
# (tag, attribute) -> the words allowed; what is not stated has a default
WORDS = {
    ("type", "type"): ROAD_TYPES, ("speed", "unit"): ("m/s", "mph", "km/h"), ("paramPoly3", "pRange"): ("arcLength", "normalized"),
    ("roadMark", "color"): MARK_COLOURS, ("roadMark", "weight"): ("standard", "bold"),
    ("roadMark", "laneChange"): ("increase", "decrease", "both", "none"), ("object", "type"): OBJECT_TYPES,
    ("object", "orientation"): ORIENTATIONS, ("signal", "orientation"): ORIENTATIONS, ("signal", "dynamic"): ("yes", "no"),
}
# (tag, attribute) -> (least, most, whether the least itself is allowed)
RANGES = {
    ("roadMark", "width"): NOT_NEGATIVE, ("line", "length"): POSITIVE, ("line", "space"): NOT_NEGATIVE, ("line", "width"): NOT_NEGATIVE,
    ("object", "length"): POSITIVE, ("object", "width"): POSITIVE, ("object", "height"): NOT_NEGATIVE, ("object", "radius"): NOT_NEGATIVE,
    ("signal", "s"): NOT_NEGATIVE, ("superelevation", "a"): (-PI_HALF, PI_HALF, True), ("width", "a"): (-1.0, 50.0, True),
}
# (tag, attribute) -> the minor version from which the range holds; earlier ones have any number there
RANGE_SINCE = {("object", "length"): 7, ("object", "width"): 7, ("object", "height"): 7, ("object", "radius"): 7}
NEEDED_ATTRIBUTES = {"object": ("id", "s", "t"), "signal": ("id", "s", "t"), "lane": ("id", "type"), "connection": ("id",)}


class Statement(NamedTuple):
    """A fault of FAULTS, what it is about, what was seen, and where: the id of a road, "" for none, and metres along it."""

    fault: str
    element: str
    text: str
    road: str
    s: float


def statements(root: XmlElement) -> Iterator[Statement]:
    """Every statement of a file that the format does not allow.

    Parameters
    ----------
    root : the element <OpenDRIVE>
    """
    header = root.find("header")
    if header is not None:
        yield from _header(header)
    minor = _number(header, "revMinor", MINORS[-1]) if header is not None else MINORS[-1]
    seen: dict[str, set[str]] = {"object": set(), "signal": set()}
    for road in root.all("road"):
        yield from _road(road, seen, minor)
    for junction in root.all("junction"):
        yield from _junction(junction)


def _header(header):
    try:
        major, minor = header.number("revMajor"), header.number("revMinor")
    except RoadExtractionError as problem:
        yield Statement("value", "header", str(problem), "", 0.0)
    else:
        if major != 1 or minor not in MINORS:
            yield Statement("value", "header", f"The version is {major:g}.{minor:g}; there are 1.0 to 1.{MINORS[-1]}.", "", 0.0)
    south, north, west, east = (_number(header, name, 0.0) for name in ("south", "north", "west", "east"))
    if south > north or west > east:
        yield Statement("bounds", "header", f"South {south:g} to north {north:g}, west {west:g} to east {east:g}.", "", 0.0)


def _road(road, seen, minor):
    id, length = road.get("id"), _number(road, "length", 0.0)
    name = f"road {id}"

    def found(fault, what, text, s=0.0):
        return Statement(fault, f"{name}, {what}" if what else name, text, id, s)

    for tag, parent, zero in (("type", road, False), ("geometry", road.find("planView"), True), ("elevation", road.find("elevationProfile"), True),
                              ("superelevation", road.find("lateralProfile"), True), ("laneOffset", road.find("lanes"), True)):
        for text in _order(parent, tag, "s", length, zero) if parent is not None else ():
            yield found("record order", tag, text)
    yield from (found(*one) for one in _plan(road.find("planView")))
    shapes = [(_number(one, "s", 0.0), _number(one, "t", 0.0)) for one in _all(road.find("lateralProfile"), "shape")]
    if shapes != sorted(shapes):
        yield found("record order", "shape", "The shapes do not go on from s to s and from t to t.")
    sections = list(_all(road.find("lanes"), "laneSection"))
    starts = [*(_number(section, "s", 0.0) for section in sections), length]
    numbers: set[int] = set()
    for section, start, end in zip(sections, starts[:-1], starts[1:]):
        for side in ("left", "center", "right"):
            for lane in _all(section.find(side), "lane"):
                numbers.add(int(_number(lane, "id", 0.0)))
                what = f"section at {start:g}, lane {lane.get('id')}"
                yield from (found(fault, what, text, start) for fault, text in _lane(lane, end - start))
    for kind, group in (("object", road.find("objects")), ("signal", road.find("signals"))):
        for one in _all(group, kind):
            yield from (found(fault, f"{kind} {one.get('id')}", text, s) for fault, text, s in _beside(one, kind, length, numbers, seen[kind]))
    for one in _within(road):
        yield from (found("value", "", text) for text in _values(one, minor))


def _plan(plan):
    """(fault, what, text, s) of the geometries."""
    for one in _all(plan, "geometry"):
        shapes = [child for child in one.children if child.tag in PLAN_SHAPES]
        s = _number(one, "s", 0.0)
        if len(shapes) > 1:
            yield "two at once", "geometry", f"The geometry at s = {s:g} is {' and '.join(child.tag for child in shapes)}.", s
        for child in shapes:
            if child.tag == "arc" and _number(child, "curvature", 1.0) == 0:
                yield "value", "geometry", f"The arc at s = {s:g} has no curvature; it is a line.", s


def _lane(lane, length):
    """(fault, text) of a lane of a section of some length."""
    for tag, zero in (("width", True), ("border", True), ("roadMark", False), ("height", False), ("speed", False)):
        for text in _order(lane, tag, "sOffset", length, zero):
            yield "record order", f"{tag}: {text}"
    if lane.find("width") is not None and lane.find("border") is not None:
        yield "two at once", "It has widths and borders; only the widths are read."
    if _number(lane, "id", 0.0) % 1:
        yield "value", f"Its number is {lane.get('id')}."


def _beside(one, kind, length, numbers, seen):
    """(fault, text, s) of an object or signal."""
    s, t = _number(one, "s", 0.0), _number(one, "t", 0.0)
    if one.get("id") in seen:
        yield "id twice", f"There is another {kind} of this id.", s
    seen.add(one.get("id"))
    if abs(t) > FARTHEST_OBJECT:
        yield "object off the road", f"It is {abs(t):.0f} m beside the reference line.", s
    if kind == "signal" and not -STATED_NEAR <= s <= length + STATED_NEAR:
        yield "object off the road", f"It is at s = {s:.2f} of {length:.2f} m.", s
    for validity in one.all("validity"):
        first, last = _number(validity, "fromLane", 0.0), _number(validity, "toLane", 0.0)
        if first > last or first not in numbers or last not in numbers:
            yield "lane link", f"It is valid from lane {first:g} to lane {last:g}, which the road does not have.", s
    for outline in [*_all(one.find("outlines"), "outline"), *one.all("outline")]:
        corners = sum(child.tag in ("cornerRoad", "cornerLocal") for child in outline.children)
        if 0 < corners < 3 and outline.get("closed", "true") != "false":
            yield "value", f"Its outline has {corners} corners.", s


def _junction(junction):
    name, seen = f"junction {junction.get('id')}", set()
    for one in junction.all("connection"):
        what = f"{name}, connection {one.get('id')}"
        if one.get("id") in seen:
            yield Statement("id twice", what, "There is another connection of this id.", one.get("connectingRoad"), 0.0)
        seen.add(one.get("id"))
        links = [(link.get("from"), link.get("to")) for link in one.all("laneLink")]
        if len(set(links)) < len(links):
            yield Statement("connection", what, "It links the same lanes twice.", one.get("connectingRoad"), 0.0)


def _order(parent, tag, key, length, zero):
    """Sentences on records that begin late, go back, or lie beyond the end."""
    at = [_number(one, key, 0.0) for one in parent.all(tag)]
    if not at:
        return
    if zero and at[0] > STATED_NEAR:
        yield f"The first begins at {at[0]:g} m."
    if any(later < earlier for earlier, later in zip(at[:-1], at[1:])):
        yield f"They begin at {', '.join(f'{one:g}' for one in at[:8])} m."
    if min(at) < -STATED_NEAR or max(at) > length + STATED_NEAR:
        yield f"One begins at {max(at) if max(at) > length else min(at):g} m of {length:g} m."


def _values(one, minor):
    """Sentences on words and numbers of an element of a file of version 1.minor."""
    for (tag, name), words in WORDS.items():
        if one.tag == tag and name in one.attributes and one.get(name) not in words and not (tag == "type" and "s" not in one.attributes):
            yield f"Line {one.line}: {name} of <{tag}> is {one.get(name)[:40]!r}."
    for (tag, name), (least, most, itself) in RANGES.items():
        if one.tag == tag and name in one.attributes and not minor < RANGE_SINCE.get((tag, name), 0):
            value = _number(one, name, np.nan)
            if not (least <= value <= most) or not itself and value == least:
                yield f"Line {one.line}: {name} of <{tag}> is {one.get(name)[:40]!r}."
    for name in NEEDED_ATTRIBUTES.get(one.tag, ()):
        if name not in one.attributes:
            yield f"Line {one.line}: <{one.tag}> has no {name}."
    if one.tag == "speed" and one.get("max") not in ("no limit", "undefined") and not _number(one, "max", 0.0) >= 0:
        yield f"Line {one.line}: max of <speed> is {one.get('max')[:40]!r}."


def _within(element):
    """The elements within an element, at any depth, but for the user's own."""
    stack = list(element.children)
    while stack:
        one = stack.pop()
        if one.tag != "userData":
            yield one
            stack += one.children


def _all(parent, tag):
    return parent.all(tag) if parent is not None else ()


def _number(element, name, missing):
    """A number, NaN where it is none."""
    try:
        return element.number(name, missing)
    except RoadExtractionError:
        return np.nan
