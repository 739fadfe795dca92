"""Findings of a check, and their layer."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
import shapely

from ....core.common.features import MAP_FINDINGS, Features

# what may be found -> what it means
FAULTS = {
    "unreadable": "a part of the file cannot be read, or an id is not a number",
    "id twice": "two elements have one id",
    "station": "a geometry does not begin where the one before it ends along the road",
    "gap": "a geometry does not begin where the one before it ends in plan",
    "kink": "the direction jumps between two geometries",
    "road length": "the length of a road is not the sum of its geometries",
    "height step": "the height of a road jumps",
    "crossfall step": "the crossfall of a road jumps",
    "width below zero": "a lane is narrower than nothing",
    "width step": "the border of a lane jumps",
    "border folds": "a border lies beyond the centre of the curve and folds back",
    "lane order": "lanes are not numbered without gaps from the middle, or not in that order in the file",
    "centre lane": "a section has no lane 0, or lane 0 has a width",
    "section order": "sections do not begin at 0 and go on from there within the road",
    "lane type": "a type of lane that the format does not have",
    "road mark type": "a type of road mark that the format does not have",
    "traffic rule": "a traffic rule that is neither RHT nor LHT",
    "lane link": "a lane is linked to one that is not there",
    "one-sided link": "a lane or road is linked to another that is not linked back",
    "road link": "a road is linked to a road or junction that is not there, or to no end of it",
    "gap at a link": "linked lanes do not touch in plan",
    "kink at a link": "the direction jumps between linked lanes",
    "height step at a link": "the height jumps between linked lanes",
    "direction at a link": "linked lanes are driven against each other",
    "connection": "a connection of a junction names a road or lane that is not there or not part of it",
    "unused junction road": "a road belongs to a junction that has no connection to it",
    "dead end": "a driven lane ends although its road goes on",
    "no way in": "a driven lane begins although its road comes from somewhere",
    "two at one place": "two roads or lanes lie on each other",
    "object off the road": "an object lies beyond the end of its road",
    "value": "a word or number that the format does not have",
    "record order": "records do not begin at the start, go back, or lie beyond the end",
    "two at once": "an element states two things that exclude each other",
    "reference": "the geoReference is no CRS in metres",
    "bounds": "the bounds of the header are not those of the roads",
    "missing node": "a way has a node that is not there",
    "missing member": "a relation has a member that is not there",
    "short way": "a way has fewer than two nodes",
    "repeated node": "a way has one node twice in a row, or two at one place",
    "way type": "a way has no type, or one that the format does not have",
    "way subtype": "a painted line or curb has no subtype, or one that the format does not have",
    "lanelet tag": "a tag of a lanelet is missing or has a value that the format does not have",
    "border missing": "a lanelet has not one left and one right border",
    "border crosses": "a border crosses itself or the other border",
    "sides swapped": "left and right of a lanelet look swapped",
    "head on": "two lanelets end, or begin, at the same place, driven against each other",
    "not joined": "a lanelet begins where another ends, but they do not share their nodes",
    "border twice": "neighbours have two ways at one place instead of a shared one",
    "lane width": "a lane is narrower or wider than any lane",
    "centre line outside": "the centre line of a lanelet leaves it",
    "spike": "one node of a border lies beside it, or above or below it",
    "centre line": "a centre line runs against its lanelet, or there is more than one",
    "regulatory element": "a rule of traffic has no kind or no members that it needs, or nobody obeys it",
    "way tag": "a tag of a way has a value that the format does not have",
    "id not positive": "ids of 0 or below, which other programs give out anew",
    "local coordinates": "some nodes have local_x and local_y, others not",
    "open area": "the outline of an area does not come back to its beginning",
    "missing height": "a node has no height although others have",
}


@dataclass(frozen=True)
class Finding:
    """fault : key of FAULTS; element : what it is about, such as "road 12, lane -1"; text : what was seen; place : (3,) map coordinates."""

    fault: str
    element: str
    text: str
    place: tuple[float, float, float]


# what differs in the texts of one finding at several places
VARYING = re.compile(r"\b(?:road|lane|junction|node|way|relation|lanelet) [^ ,.;]+|\b(?:start|end)\b|-?\d+(?:\.\d+)?", re.IGNORECASE)
NUMBER = re.compile(r"\d+(?:\.\d+)?")


@dataclass(frozen=True)
class SameFindings:
    """One finding at one or more places. worst : the Finding whose text has the largest number first; elements : names, each once, in order."""

    worst: Finding
    elements: tuple[str, ...]
    count: int


@dataclass
class Findings:
    """All findings of one map, and what the map has."""

    found: list[Finding] = field(default_factory=list)
    lanes: int = 0   # lanes, successors, neighbours: driven lanes (of a section), links from one to the next, pairs side by side
    successors: int = 0
    neighbours: int = 0
    crs: str = ""   # WKT, "" where unknown

    def add(self, fault: str, element: str, text: str, place: np.ndarray) -> None:
        """Append one; the place may lack a height."""
        if fault not in FAULTS:
            raise KeyError(fault)
        x, y, *z = (float(value) for value in place)
        self.found.append(Finding(fault, element, text, (x, y, z[0] if z else 0.0)))

    def counts(self) -> dict[str, int]:
        """How many of each fault there are."""
        return dict(Counter(finding.fault for finding in self.found))

    def groups(self) -> tuple[list[SameFindings], list[int]]:
        """(the same findings as one each, those at the fewest places first; the row of every finding in them).

        What is wrong everywhere is a habit of the program that wrote the map; slips are at few places.
        """
        same: dict[tuple[str, str], list[int]] = {}
        for k, finding in enumerate(self.found):
            same.setdefault((finding.fault, VARYING.sub("#", finding.text)), []).append(k)
        groups, row_of = [], [0] * len(self.found)
        for number, rows in enumerate(sorted(same.values(), key=len)):
            members = [self.found[k] for k in rows]
            groups.append(SameFindings(max(members, key=_first_number), tuple(dict.fromkeys(member.element for member in members)), len(members)))
            for k in rows:
                row_of[k] = number
        return groups, row_of

    def to_features(self) -> Features:
        """The layer MAP_FINDINGS of points, each with its row of `groups`, counted from 1."""
        layer = Features("PointZ", MAP_FINDINGS, crs=self.crs)
        groups, row_of = self.groups()
        for finding, row in zip(self.found, row_of):
            layer.add(shapely.Point(finding.place), fault=finding.fault, element=finding.element, text=finding.text, row=row + 1,
                      places=groups[row].count)
        return layer


def _first_number(finding):
    digits = NUMBER.search(finding.text)
    return float(digits[0]) if digits else 0.0


def metres(value: float) -> str:
    """A distance as messages have it."""
    return f"{value:.3f} m" if value < 1 else f"{value:.2f} m"
