"""The roadside as found: what is seen from two roads, or from two sides, is told once; layers of lines and points."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import shapely

from ....core.common.features import ROADSIDE, ROADSIDE_OBJECTS, Features
from ....core.survey.frame.road_frame import RoadFrame
from ..settings import RoadsideSettings
from .chains import Chain, along_the_chain
from .uprights import FIRST_BIN, HEIGHT_BIN, Pole, Uprights

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
    """A line beside the road."""

    kind: str   # guard_rail, barrier, wall, fence, hedge or gutter
    chain: Chain   # Chain
    foot: float   # m, lower end of what is seen of it above the ground


@dataclass
class Roadside:
    """What was found beside the roads of a survey."""

    lines: list[SideLine]   # in order of road, side and station
    poles: dict[int, list[Pole]]   # {road: list of Pole}
    edges: dict[int, SideEdges]   # {road: SideEdges}
    frame: RoadFrame
    crs: str
    settings: RoadsideSettings
    notes: list[str] = field(default_factory=list)


def told_once(found: Roadside) -> tuple[list[SideLine], dict]:
    """Lines and poles of all roads without those parts that a road nearer to them has too.

    Returns lines, in the order they had, and poles by road
    """
    return _lines(found), _poles(found)


def _lines(found):
    shapes = [shapely.linestrings(np.stack(found.frame.to_map(line.chain.road, line.chain.s, line.chain.d), axis=1)) for line in found.lines]
    distances = [_away(found, line.chain.road, line.chain.s, line.chain.d, line.chain.side) for line in found.lines]
    kept = []
    for k, line in enumerate(found.lines):
        nearer = [shapes[j] for j, twin in enumerate(found.lines) if twin.kind == line.kind != "gutter" and twin.chain.road != line.chain.road
                  and (distances[j], twin.chain.road) < (distances[k], line.chain.road)]
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
    return [chain.part(stretch) for stretch in rows]


def _poles(found):
    rows = [(road, pole) for road, poles in found.poles.items() for pole in poles]
    if len(found.poles) < 2 or not rows:
        return found.poles
    places = np.array([np.r_[found.frame.to_map(road, np.array([pole.s]), np.array([pole.d]))] for road, pole in rows]).reshape(len(rows), 2)
    distances = np.array([min(_away(found, road, np.array([pole.s]), np.array([pole.d]), side) for side in (1, -1)) for road, pole in rows])
    number = np.array([road for road, _ in rows])
    first, second = shapely.STRtree(shapely.points(places)).query(shapely.points(places), predicate="dwithin", distance=SAME_THING)
    farther = (number[first] != number[second]) & (
        (distances[first] > distances[second]) | (distances[first] == distances[second]) & (number[first] > number[second]))
    twins = set(first[farther].tolist())
    return {road: [pole for k, (pole_road, pole) in enumerate(rows) if pole_road == road and k not in twins] for road in found.poles}


def _away(found, road, s, d, side):
    """m, median distance of places from the edge of a side of a road, however it is known."""
    return float(np.median(np.abs(d - found.edges[road].of(side, s))))


# What is thick and loose, as a hedge, shows uprights on its face and inside it, and may be followed along either: it is told once, by its face.

def along_faces(things: list[tuple[str, Chain]]) -> list[tuple[str, Chain]]:
    """Things of which those of one kind that run beside each other, nearer than two things stand, are one.

    things : kinds and chains of one side of a road
    Returns the same, in order of station; where two are joined, the uprights nearer to the road are kept
    """
    result: list[tuple[str, Chain]] = []
    for kind, chain in sorted(things, key=lambda thing: int(thing[1].members.slice[0])):
        twin = next((k for k, (other_kind, before) in enumerate(result) if other_kind == kind and _beside(before, chain)), None)
        if twin is None:
            result.append((kind, chain))
        else:
            result[twin] = kind, _joined(result[twin][1], chain)
    return result


def _beside(one, other):
    """Whether two chains run beside each other for a while, nearer than two things stand."""
    shared = (other.s >= one.s[0]) & (other.s <= one.s[-1])
    return bool(shared.any()) and float(np.median(np.abs(other.d[shared] - np.interp(other.s[shared], one.s, one.d)))) < SAME_THING


def _joined(one, other):
    """The chain of the uprights of two, without those that stand behind the other's face."""
    parts = [chain.part(np.flatnonzero(~_behind(chain, face, equal))) for chain, face, equal in ((one, other, False), (other, one, True))]
    members = Uprights.join([part.members for part in parts])
    empty = np.concatenate([part.empty for part in parts])
    # the one nearer to the road of two that are left of a slice
    order = np.lexsort((one.side * members.d, members.slice))
    order = order[np.r_[True, np.diff(members.slice[order]) > 0]]
    members, empty = members[order], empty[order]
    # an opening of the one that the other fills is none
    empty = np.minimum(empty, np.diff(members.slice, append=members.slice[-1] + 1) - 1)
    return Chain(one.road, one.side, members, *along_the_chain(members), empty)


def _behind(chain, face, equal):
    """(N,) bool, which uprights of a chain stand behind the face of another, or on it where `equal`."""
    d = np.interp(chain.s, face.s, face.d, left=np.nan, right=np.nan)
    depth = chain.side * (chain.d - d)
    return (depth >= 0.0 if equal else depth > 0.0) & (depth < SAME_THING)


# The roadside as layers: lines along its foot, and points.

DRAWN_TOLERANCE = 0.03   # m to which lines are simplified
ON_GROUND = (FIRST_BIN + 1) * HEIGHT_BIN  # m: what is seen from here down stands on the ground, for grass hides the rest


def roadside_to_features(found: Roadside) -> tuple[Features, Features]:
    """The layers ROADSIDE (the pieces of lines with Z along the foot, on the ground) and ROADSIDE_OBJECTS (points on the ground)."""
    lines, points = Features("LineStringZ", ROADSIDE, crs=found.crs), Features("PointZ", ROADSIDE_OBJECTS, crs=found.crs)
    for number, line in enumerate(found.lines):
        road, side = line.chain.road, line.chain.side
        for status, piece in line.chain.pieces():
            places = np.stack(found.frame.to_map(road, piece.s, piece.d, piece.ground), axis=1)
            if len(places) < 2:  # the slice of a single upright
                continue
            shape = shapely.linestrings(places[_vertices(piece.s, places, found.settings.interval)])
            lines.add(shape, road=road, side=_side(side), line=number, kind=line.kind, status=status, station_m=piece.s[0],
                      end_m=piece.s[-1], offset_m=np.median(piece.d), edge_m=found.edges[road].beyond(side, piece.s, piece.d),
                      height_m=np.median(line.chain.top), foot_m=line.foot if line.foot > ON_GROUND else 0.0, length_m=shape.length)
    for road, poles in found.poles.items():
        for pole in poles:
            x, y, z = found.frame.to_map(road, np.array([pole.s]), np.array([pole.d]), np.array([pole.z]))
            side = 1 if pole.d > float(found.edges[road].middle(np.array([pole.s]))[0]) else -1
            points.add(shapely.Point(x[0], y[0], z[0]), road=road, side=_side(side), kind=pole.kind, station_m=pole.s,
                       offset_m=pole.d, edge_m=found.edges[road].beyond(side, np.array([pole.s]), np.array([pole.d])),
                       height_m=pole.height, diam_m=pole.diameter)
    return lines, points


def _vertices(s, places, interval):
    """Indices of the vertices that a line needs in plan and in height, and of one every interval."""
    needed = np.zeros(len(s), bool)
    for across in (places[:, :2], np.c_[s, places[:, 2]]):
        kept = shapely.get_coordinates(shapely.simplify(shapely.linestrings(across), DRAWN_TOLERANCE))
        needed |= np.isin(across[:, 0] + 1j * across[:, 1], kept[:, 0] + 1j * kept[:, 1])
    return np.flatnonzero(needed | np.r_[True, np.diff(np.floor(s / interval)) > 0])


def _side(side):
    return "left" if side > 0 else "right"
