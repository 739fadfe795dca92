"""What stands between two roads, or where they meet, is seen from both: it is told once, by the road that it stands nearer to."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import shapely

from ...survey.frame.road_frame import RoadFrame
from ..settings import RoadsideSettings
from .chains import Chain
from .uprights import Pole

SAME_THING = 0.5       # m within which what two roads see is one thing: half of what two rails of a median are apart


@dataclass(frozen=True)
class SideEdges:
    """Offsets of the carriageway's edges along a road, interpolated between places EDGE_LOOK_UP apart."""

    s: np.ndarray
    right: np.ndarray
    left: np.ndarray
    known: bool

    def of(self, side: int, s: np.ndarray) -> np.ndarray:
        """(N,) m, offset of the edge of a side."""
        return np.interp(s, self.s, self.left if side > 0 else self.right)

    def middle(self, s: np.ndarray) -> np.ndarray:
        """(N,) m, offset of the middle between the edges."""
        return 0.5 * (self.of(1, s) + self.of(-1, s))

    def beyond(self, side: int, s: np.ndarray, d: np.ndarray) -> float:
        """m, median distance of (N,) places beyond the edge of a side; NaN where no layer says where it is."""
        return float(np.median(side * (d - self.of(side, s)))) if self.known else np.nan


@dataclass(frozen=True)
class SideLine:
    """A line beside the road.

    kind : guard_rail, barrier, wall, fence, hedge or gutter
    chain : Chain
    foot : m, lower end of what is seen of it above the ground
    from_edge : m from the carriageway's edge, outward positive; NaN where no layer says where it is
    """

    kind: str
    chain: Chain
    foot: float
    from_edge: float


@dataclass
class Roadside:
    """What was found beside the roads of a survey.

    lines : in order of road, side and station
    poles : {road: list of Pole}
    edges : {road: SideEdges}
    """

    lines: list[SideLine]
    poles: dict[int, list[Pole]]
    edges: dict[int, SideEdges]
    frame: RoadFrame
    crs: str
    settings: RoadsideSettings
    notes: list[str] = field(default_factory=list)


def told_once(found: Roadside) -> tuple[list[SideLine], dict]:
    """Lines and poles of all roads without those parts that a road nearer to them has too.

    Parameters
    ----------
    found : Roadside

    Returns
    -------
    lines, in the order they had, and poles by road
    """
    return _lines(found), _poles(found)


def _lines(found):
    shapes = [shapely.linestrings(np.stack(found.frame.to_map(line.chain.road, line.chain.s, line.chain.d), axis=1)) for line in found.lines]
    away = [_away(found, line.chain.road, line.chain.s, line.chain.d, line.chain.side) for line in found.lines]
    kept = []
    for k, line in enumerate(found.lines):
        nearer = [shapes[j] for j, other in enumerate(found.lines) if other.kind == line.kind != "gutter" and other.chain.road != line.chain.road
                  and (away[j], other.chain.road) < (away[k], line.chain.road)]
        if nearer:
            free = shapely.distance(shapely.points(shapely.get_coordinates(shapes[k])), shapely.union_all(nearer)) > SAME_THING
            kept += [replace(line, chain=part) for part in _parts(line.chain, free, found.settings.min_length)]
        else:
            kept.append(line)
    return kept


def _parts(chain, free, min_length):
    """The stretches of a chain where it is free, as long as a line must be."""
    if free.all():
        return [chain]
    cuts = np.r_[0, np.flatnonzero(np.diff(free.astype(int))) + 1, len(free)]
    rows = [np.arange(a, b) for a, b in zip(cuts[:-1], cuts[1:]) if free[a] and chain.s[b - 1] - chain.s[a] >= min_length]
    return [chain.part(own) for own in rows]


def _poles(found):
    rows = [(road, pole) for road, poles in found.poles.items() for pole in poles]
    if len(found.poles) < 2 or not rows:
        return found.poles
    place = np.array([np.r_[found.frame.to_map(road, np.array([pole.s]), np.array([pole.d]))] for road, pole in rows]).reshape(len(rows), 2)
    away = np.array([min(_away(found, road, np.array([pole.s]), np.array([pole.d]), side) for side in (1, -1)) for road, pole in rows])
    number = np.array([road for road, _ in rows])
    one, other = shapely.STRtree(shapely.points(place)).query(shapely.points(place), predicate="dwithin", distance=SAME_THING)
    farther = (number[one] != number[other]) & ((away[one] > away[other]) | (away[one] == away[other]) & (number[one] > number[other]))
    twins = set(one[farther].tolist())
    return {road: [pole for k, (own, pole) in enumerate(rows) if own == road and k not in twins] for road in found.poles}


def _away(found, road, s, d, side):
    """m, median distance of places from the edge of a side of a road, however it is known."""
    return float(np.median(np.abs(d - found.edges[road].of(side, s))))
