"""Findings of a check, and their layer."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
import shapely

from ....core.common.features import MAP_FINDINGS, Features

FAULTS, _WORDS = (dict(re.findall("(.+?): (.+)", Path(__file__).with_name(name).read_text(encoding="utf-8"))) for name in ("faults.txt", "words.txt"))
WORDS = {what: tuple(words.split(", ")) for what, words in _WORDS.items()}   # that the formats have; of FAULTS the meanings


class Finding(NamedTuple):
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
        def size(finding: Finding) -> float:
            digits = NUMBER.search(finding.text)
            return float(digits[0]) if digits else 0.0

        groups, row_of = [], [0] * len(self.found)
        for number, rows in enumerate(sorted(same.values(), key=len)):
            members = [self.found[k] for k in rows]
            groups.append(SameFindings(max(members, key=size), tuple(dict.fromkeys(member.element for member in members)), len(members)))
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


def metres(value: float) -> str:
    """A distance as messages have it."""
    return f"{value:.3f} m" if value < 1 else f"{value:.2f} m"
