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
from ..opendrive.xodr import GEOMETRIES
from ..xml_tree import XmlElement

MINORS = range(9)                # of version 1
STATED_NEAR = 0.01               # m by which a record may lie beyond its end
FARTHEST_OBJECT = 100.0          # m beside the reference line


class Allowed(NamedTuple):
    """What an attribute may be: words, or numbers from `least` to `most`, `least` itself or not; numbers count since version 1.since."""

    words: tuple[str, ...] = ()
    least: float = np.inf
    most: float = np.inf
    itself: bool = True
    since: int = 0

    def holds(self, element: XmlElement, name: str, minor: float) -> bool:
        """Whether the attribute of this name is allowed in a file of version 1.minor."""
        if element.get(name) in self.words or minor < self.since:
            return True
        value = _number(element, name, np.nan)
        return bool(self.least < value <= self.most or self.itself and value == self.least)


POSITIVE, NOT_NEGATIVE = Allowed(least=0.0, itself=False), Allowed(least=0.0)
MARK_COLOURS = ("standard", "blue", "green", "red", "white", "yellow", "orange", "violet", "black")
ROAD_TYPES = ("unknown", "rural", "motorway", "town", "lowSpeed", "pedestrian", "bicycle", "townExpressway", "townCollector", "townArterial",
              "townPrivate", "townLocal", "townPlayStreet")
OBJECT_TYPES = ("", "-1", "none", "obstacle", "car", "pole", "tree", "vegetation", "barrier", "building", "parkingSpace", "patch", "railing",
                "trafficIsland", "crosswalk", "streetLamp", "gantry", "soundBarrier", "van", "bus", "trailer", "bike", "motorbike", "tram", "train",
                "pedestrian", "wind", "roadMark", "roadSurface")
ORIENTATIONS = ("+", "-", "none")
# tag -> attribute -> what it may be; what is not stated has a default
ATTRIBUTES = {
    "type": {"type": Allowed(ROAD_TYPES)},
    "speed": {"unit": Allowed(("m/s", "mph", "km/h")), "max": Allowed(("no limit", "undefined"), 0.0)},
    "paramPoly3": {"pRange": Allowed(("arcLength", "normalized"))},
    "roadMark": {"color": Allowed(MARK_COLOURS), "weight": Allowed(("standard", "bold")),
                 "laneChange": Allowed(("increase", "decrease", "both", "none")), "width": NOT_NEGATIVE},
    "line": {"length": POSITIVE, "space": NOT_NEGATIVE, "width": NOT_NEGATIVE},
    # before 1.7 the sizes of objects are any numbers
    "object": {"type": Allowed(OBJECT_TYPES), "orientation": Allowed(ORIENTATIONS), "length": POSITIVE._replace(since=7),
               "width": POSITIVE._replace(since=7), "height": NOT_NEGATIVE._replace(since=7), "radius": NOT_NEGATIVE._replace(since=7)},
    "signal": {"orientation": Allowed(ORIENTATIONS), "dynamic": Allowed(("yes", "no")), "s": NOT_NEGATIVE},
    "superelevation": {"a": Allowed(least=-np.pi / 2, most=np.pi / 2)},
    "width": {"a": Allowed(least=-1.0, most=50.0)},
}
NEEDED_ATTRIBUTES = {"object": ("id", "s", "t"), "signal": ("id", "s", "t"), "lane": ("id", "type"), "connection": ("id",)}
# (where they are in a road or lane, whether the first must be at 0) of records that go on from s to s
ROAD_RECORDS = ((("type",), False), (("planView", "geometry"), True), (("elevationProfile", "elevation"), True),
                (("lateralProfile", "superelevation"), True), (("lanes", "laneOffset"), True))
LANE_RECORDS = (("width", True), ("border", True), ("roadMark", False), ("height", False), ("speed", False))


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
    lanes = list(_lanes(road, length))
    for found in (_records(road, length), _plan(road), _of_lanes(lanes), _of_objects(road, length, lanes, seen),
                  (("value", "", text, 0.0) for one in _within(road) for text in _values(one, minor))):
        for fault, what, text, s in found:
            yield Statement(fault, f"road {id}, {what}" if what else f"road {id}", text, id, s)


# The statements of a road, each (fault, what, text, s).

def _records(road, length):
    for path, zero in ROAD_RECORDS:
        for text in _order(road, path, "s", length, zero):
            yield "record order", path[-1], text, 0.0
    shapes = [(_number(one, "s", 0.0), _number(one, "t", 0.0)) for one in road.all("lateralProfile", "shape")]
    if shapes != sorted(shapes):
        yield "record order", "shape", "The shapes do not go on from s to s and from t to t.", 0.0


def _lanes(road, length):
    """(start of the section, its length, lane) of every lane."""
    sections = list(road.all("lanes", "laneSection"))
    starts = [*(_number(section, "s", 0.0) for section in sections), length]
    for section, start, end in zip(sections, starts[:-1], starts[1:]):
        for side in ("left", "center", "right"):
            for lane in section.all(side, "lane"):
                yield start, end - start, lane


def _of_lanes(lanes):
    for start, length, lane in lanes:
        for fault, text in _lane(lane, length):
            yield fault, f"section at {start:g}, lane {lane.get('id')}", text, start


def _of_objects(road, length, lanes, seen):
    numbers = {int(_number(lane, "id", 0.0)) for _, _, lane in lanes}
    for kind in seen:
        for one in road.all(f"{kind}s", kind):
            for fault, text, s in _beside(one, kind, length, numbers, seen[kind]):
                yield fault, f"{kind} {one.get('id')}", text, s


def _plan(road):
    for one in road.all("planView", "geometry"):
        shapes = [child for child in one.children if child.tag in GEOMETRIES]
        s = _number(one, "s", 0.0)
        if len(shapes) > 1:
            yield "two at once", "geometry", f"The geometry at s = {s:g} is {' and '.join(child.tag for child in shapes)}.", s
        for child in shapes:
            if child.tag == "arc" and _number(child, "curvature", 1.0) == 0:
                yield "value", "geometry", f"The arc at s = {s:g} has no curvature; it is a line.", s


def _lane(lane, length):
    """(fault, text) of a lane of a section of some length."""
    for tag, zero in LANE_RECORDS:
        for text in _order(lane, (tag,), "sOffset", length, zero):
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
        if first > last or not numbers.issuperset((first, last)):
            yield "lane link", f"It is valid from lane {first:g} to lane {last:g}, which the road does not have.", s
    for corners in _corners(one):
        if 0 < corners < 3:
            yield "value", f"Its outline has {corners} corners.", s


def _corners(one):
    """How many corners each closed outline of an object has."""
    for outline in [*one.all("outlines", "outline"), *one.all("outline")]:
        if outline.get("closed", "true") != "false":
            yield sum(child.tag in ("cornerRoad", "cornerLocal") for child in outline.children)


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


def _order(parent, path, key, length, zero):
    """Sentences on records that begin late, go back, or lie beyond the end."""
    at = [_number(one, key, 0.0) for one in parent.all(*path)]
    if not at:
        return
    if zero and at[0] > STATED_NEAR:
        yield f"The first begins at {at[0]:g} m."
    if (np.diff(at) < 0).any():
        yield f"They begin at {', '.join(f'{one:g}' for one in at[:8])} m."
    if min(at) < -STATED_NEAR or max(at) > length + STATED_NEAR:
        yield f"One begins at {max(at) if max(at) > length else min(at):g} m of {length:g} m."


def _values(one, minor):
    """Sentences on words and numbers of an element of a file of version 1.minor."""
    if one.tag != "type" or "s" in one.attributes:   # a road mark has a type too
        for name, allowed in ATTRIBUTES.get(one.tag, {}).items():
            if name in one.attributes and not allowed.holds(one, name, minor):
                yield f"Line {one.line}: {name} of <{one.tag}> is {one.get(name)[:40]!r}."
    for name in NEEDED_ATTRIBUTES.get(one.tag, ()):
        if name not in one.attributes:
            yield f"Line {one.line}: <{one.tag}> has no {name}."


def _within(element):
    """The elements within an element, at any depth, but for the user's own."""
    stack = list(element.children)
    while stack:
        one = stack.pop()
        if one.tag != "userData":
            yield one
            stack += one.children


def _number(element, name, missing):
    """A number, NaN where it is none."""
    try:
        return element.number(name, missing)
    except RoadExtractionError:
        return np.nan
