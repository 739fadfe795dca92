"""Where on the road a sentence of the core is about: written and read in one way, so that a window can go there."""

from __future__ import annotations

import re
from dataclasses import dataclass

NUMBER = r"(-?\d+(?:\.\d+)?)"
PLACE = re.compile(rf"road (\d+)(?:, (left|right) side)?, station {NUMBER}(?: to {NUMBER})? m")


@dataclass(frozen=True)
class RoadPlace:
    """A stretch of a road, m along it; both ends are the same where it is one place. `side` is left, right or ""."""

    road: int
    start: float
    end: float
    side: str = ""

    def __str__(self) -> str:
        side = f", {self.side} side" if self.side else ""
        stretch = f"{self.start:.0f} to {self.end:.0f}" if self.end > self.start else f"{self.start:.1f}"
        return f"road {self.road}{side}, station {stretch} m"


def places_in(text: str) -> list[RoadPlace]:
    """The places that a sentence names, such as "road 0, left side, station 90 to 120 m"."""
    return [RoadPlace(int(road), float(start), float(end or start), side or "") for road, side, start, end in PLACE.findall(text)]
