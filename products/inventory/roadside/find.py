"""Find what stands beside the road."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
import shapely

from ....core.common.arrays import mask_runs
from ....core.common.features import ROADSIDE, ROADSIDE_OBJECTS, Features
from ....core.common.parallel import ordered_map
from ....core.common.progress import Progress
from ....core.countries.catalogue import country
from ....core.survey.frame.road_frame import RoadFrame
from ....core.survey.survey import Survey
from ..borders import BorderLayers, RoadBorders, RoadsideSettings
from ..surface_grid import SLICE_LENGTH
from .chains import Chain, along_the_chain, find_chains, gaps_by_window, judged, pulses_at, things_of
from .uprights import ON_GROUND, UPRIGHT_SLICE, Pole, Uprights, find_gutters, find_poles, find_uprights, level_views, lines_of_sight, local_ground

ROADSIDE_WINDOW = 20.0            # m of road looked at at a time; results do not depend on it
ROADSIDE_MARGIN = 5.0      # m before and after it, for the ground
FURTHER = 2.0            # m beyond the reach that are read, for the ground
INSIDE_EDGE = 0.20       # m inside the carriageway's edge from which things count as beside it
LEAST_ACROSS = 0.5       # m across between a scanner and what stands beside the road
ABOUT_POLE = 1.0         # m farther inside that are looked at, for a pole stands free and the corner of a vehicle does not
BEYOND_TRACK = 2.0       # m from the track that count as carriageway where no layer says where it ends
BEFORE_EDGE = 3.0        # m inside the carriageway's edge where what hides things beside the road stands: parked vehicles
MAX_EDGE_GAP = 30.0      # m along the road over which an edge is taken to go on
EDGE_LOOK_UP = 5.0          # m along the road between the places where the edge is looked up


def find_roadside(survey: Survey, layers: BorderLayers = BorderLayers(), settings: RoadsideSettings = RoadsideSettings(),
                  progress: Progress = Progress()) -> Roadside:
    """Lines of rails, barriers, walls, fences and hedges beside every road.

    layers : BorderLayers; without them what is more than 2 m from a track counts as beside the road
    """
    borders = RoadBorders(layers, survey.frame, country(settings.country))
    roadside = Roadside([], {}, {}, survey.frame, survey.crs, settings)
    level = level_views(survey)
    unknown = 0.0
    roads = survey.store.roads()
    for k, road in enumerate(roads):
        edges = roadside.edges[road] = _edges_of(survey, road, borders)
        roadside.poles[road] = []
        parts: dict[tuple[str, int], list[Uprights]] = {}
        first, last = survey.store.span(road)
        windows = np.arange(np.floor(first / ROADSIDE_WINDOW), np.ceil(last / ROADSIDE_WINDOW))

        def look(window, road=road, edges=edges):
            return _look(survey, road, window * ROADSIDE_WINDOW, edges, settings, level)

        for uprights, poles in ordered_map(look, windows.tolist(), progress.part(k / len(roads), (k + 1) / len(roads))):
            roadside.poles[road] += poles
            for key, stretches in uprights.items():
                parts.setdefault(key, []).append(stretches)
        for (sort, side), stretches in sorted(parts.items()):
            into = partial(_look_into, survey, road, side, edges, settings.reach) if sort == "line" else None
            whole = Uprights.join(stretches)
            chains = find_chains(whole[np.lexsort((whole.d, whole.slice))], road, side, settings.max_gap, settings.min_length, into)
            unknown += sum(chain.length for chain in chains if chain.members.above_view.mean() > 0.5)
            if sort == "gutter":
                classified = [("gutter", chain) for chain in chains]
            else:
                classified = _along_faces([piece for chain in chains for piece in things_of(chain, settings.min_length)])
            for kind, part in classified:
                roadside.lines.append(SideLine(kind, part, float(np.median(part.members.foot))))
    if unknown:
        roadside.notes.append(f"{unknown:.0f} m of what stands beside the road are as high as the scanner, which sees hardly higher, as heads of "
                              "many beams do. They are left out, for house fronts look the same to it.")
    roadside.lines, roadside.poles = told_once(roadside)
    roadside.lines.sort(key=lambda line: (line.chain.road, -line.chain.side, float(line.chain.s[0])))
    _report(roadside, progress)
    return roadside


def _report(roadside: Roadside, progress: Progress) -> None:
    """Log what was found, and what was missing for it."""
    lengths: dict[str, float] = {}
    for line in roadside.lines:
        lengths[line.kind] = lengths.get(line.kind, 0.0) + sum(piece.length for _, piece in line.chain.pieces())
    text = ", ".join(f"{length:.0f} m of {kind.replace('_', ' ')}" for kind, length in sorted(lengths.items())) or "no lines"
    progress.info(f"Beside the road: {text}; {sum(map(len, roadside.poles.values()))} poles, signs and trunks.")
    if not any(edges.known for edges in roadside.edges.values()):
        roadside.notes.append(f"Without road edges, marking lines, driving lines or lanes everything more than {BEYOND_TRACK:.0f} m from the track "
                           "counts as beside the road, parked cars too, and gutters are not looked for. Give the road edges.")
    for note in roadside.notes:
        progress.warn(note)


def _edges_of(survey, road, borders):
    first, last = survey.store.span(road)
    s = np.arange(first, last + EDGE_LOOK_UP, EDGE_LOOK_UP)
    track = [p.at_station(s)[0] for p in survey.frame.passes_of(road)]
    widest = np.min(track, axis=0) - BEYOND_TRACK, np.max(track, axis=0) + BEYOND_TRACK
    sides = []
    for offsets, beyond in zip(np.array([borders.outer(road, float(station)) for station in s]).T, widest):
        finite = np.isfinite(offsets)
        if finite.any():
            # an edge goes on where it is not drawn for a while
            distance = np.abs(s[:, None] - s[finite]).min(axis=1)
            sides.append(np.where(distance < MAX_EDGE_GAP, np.interp(s, s[finite], offsets[finite]), beyond))
        else:
            sides.append(beyond)
    return SideEdges(s, *sides, borders.given)


def _seen(survey, road, start, side, edges, number, rows):
    """(number of the pass that drove nearest to a side of a window, those of the rows that it measured; all where it measured none)."""
    middle = np.array([start + 0.5 * ROADSIDE_WINDOW])
    nearest = int(survey.frame.nearest_pass(road, middle, edges.of(side, middle))[0])
    measured = rows[number[rows] == nearest]
    return nearest, measured if len(measured) else rows


def _look_into(survey, road, side, edges, reach, gaps):
    """Gaps of a side of a road with what the pulses tell of them that reached them, or would have."""
    base = survey.road_height(road, np.stack([gaps.first - 0.5, gaps.last + 1.5], axis=1).ravel() * UPRIGHT_SLICE).reshape(-1, 2)
    above = replace(gaps, low=gaps.low - base, high=gaps.high - base)

    windows = gaps_by_window(gaps, ROADSIDE_WINDOW)

    def look(window):
        start = window * ROADSIDE_WINDOW
        points = survey.window(road, start, start + ROADSIDE_WINDOW)
        beyond = side * (points.d - edges.of(side, points.s))
        number, rows = _seen(survey, road, start, side, edges, points.pass_number, np.flatnonzero((beyond > -BEFORE_EDGE) & (beyond < reach)))
        s, d = points.s[rows], points.d[rows]
        h = points.z[rows] - survey.road_height(road, s)
        sight = lines_of_sight(survey, road, number, s, d, h, points.time[rows])
        return windows[window], pulses_at(above[windows[window]], side, s, d, h, *sight)

    return judged(gaps, ordered_map(look, sorted(windows)))


def _look(survey, road, start, edges, settings, level):
    """({(what, side): Uprights}, list of Pole) of one window."""
    wide = start - ROADSIDE_MARGIN, start + ROADSIDE_WINDOW + ROADSIDE_MARGIN
    points = survey.window(road, *wide)
    s, d, z = points.s, points.d, points.z
    near = np.flatnonzero((d > edges.of(-1, s) - settings.reach - FURTHER) & (d < edges.of(1, s) + settings.reach + FURTHER))
    if not len(near):
        return {}, []
    s, d, z, number, time = s[near], d[near], z[near], points.pass_number[near], points.time[near]
    h = z - survey.road_height(road, s)
    ground = local_ground(s, d, h, wide[0], int(round(wide[1] - wide[0])))
    above = h - ground.at(s, d)
    result, poles = {}, []
    slices = int(round(start / UPRIGHT_SLICE)), int(round((start + ROADSIDE_WINDOW) / UPRIGHT_SLICE))
    for side in (1, -1):
        beyond = side * (d - edges.of(side, s))
        within = (beyond < settings.reach) & np.isfinite(above)
        around = np.flatnonzero(within & (beyond > -INSIDE_EDGE - ABOUT_POLE))
        upright = find_poles(s[around], d[around], above[around], (z - above)[around], (start, start + ROADSIDE_WINDOW), settings.min_pole_height)
        poles += [pole for pole in upright if side * (pole.d - float(edges.of(side, np.array(pole.s)))) > -INSIDE_EDGE]
        outside = np.flatnonzero(within & (beyond > -INSIDE_EDGE))
        window_rows = outside[(s[outside] >= start) & (s[outside] < start + ROADSIDE_WINDOW)]
        nearest, rows = _seen(survey, road, start, side, edges, number, window_rows)
        across, up = lines_of_sight(survey, road, nearest, s[rows], d[rows], h[rows], time[rows])
        sight = up / np.maximum(-side * across[1], LEAST_ACROSS)
        uprights = find_uprights(s[rows], d[rows], above[rows], (z - above)[rows], slices, side, sight, settings.min_height)
        # as high as a scanner whose view is level; others see all round
        tops = uprights.ground + uprights.top - survey.road_height(road, (uprights.slice + 0.5) * UPRIGHT_SLICE)
        result["line", side] = replace(uprights, above_view=tops > level.get(nearest, np.inf))
        if edges.known:
            result["gutter", side] = find_gutters(survey, road, start, int(round(ROADSIDE_WINDOW / SLICE_LENGTH)), side, partial(edges.of, side))
    return result, sorted(poles, key=lambda pole: (pole.s, pole.d))


# The roadside as found: what is seen from two roads, or from two sides, is told once; layers of lines and points.

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

    def beyond(self, side: int, s: np.ndarray, d: np.ndarray) -> float:
        """m, median distance of (N,) places beyond the edge of a side; NaN where no layer says where it is."""
        return float(np.median(side * (d - self.of(side, s)))) if self.known else np.nan


@dataclass(frozen=True)
class SideLine:
    kind: str   # guard_rail, barrier, wall, fence, hedge or gutter
    chain: Chain
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


def told_once(roadside: Roadside) -> tuple[list[SideLine], dict]:
    """Lines of all roads, in their order, and poles by road, without those parts that a road nearer to them has too."""
    return _lines(roadside), _poles(roadside)


def _lines(roadside):
    shapes = [shapely.linestrings(np.stack(roadside.frame.to_map(line.chain.road, line.chain.s, line.chain.d), axis=1)) for line in roadside.lines]
    distances = [_away(roadside, line.chain.road, line.chain.s, line.chain.d, line.chain.side) for line in roadside.lines]
    kept = []
    for k, line in enumerate(roadside.lines):
        nearer = [shapes[j] for j, twin in enumerate(roadside.lines) if twin.kind == line.kind != "gutter" and twin.chain.road != line.chain.road
                  and (distances[j], twin.chain.road) < (distances[k], line.chain.road)]
        if nearer:
            free = shapely.distance(shapely.points(shapely.get_coordinates(shapes[k])), shapely.union_all(nearer)) > SAME_THING
            kept += [replace(line, chain=part) for part in _parts(line.chain, free, roadside.settings.min_length)]
        else:
            kept.append(line)
    return kept


def _parts(chain, free, min_length):
    """The stretches of a chain where it is free, as long as a line must be."""
    if free.all():
        return [chain]
    return [chain.part(np.arange(a, b)) for a, b in mask_runs(free) if chain.s[b - 1] - chain.s[a] >= min_length]


def _poles(roadside):
    rows = [(road, pole) for road, poles in roadside.poles.items() for pole in poles]
    if len(roadside.poles) < 2 or not rows:
        return roadside.poles
    places = np.array([np.r_[roadside.frame.to_map(road, np.array([pole.s]), np.array([pole.d]))] for road, pole in rows]).reshape(len(rows), 2)
    distances = np.array([min(_away(roadside, road, np.array([pole.s]), np.array([pole.d]), side) for side in (1, -1)) for road, pole in rows])
    number = np.array([road for road, _ in rows])
    first, second = shapely.STRtree(shapely.points(places)).query(shapely.points(places), predicate="dwithin", distance=SAME_THING)
    farther = (number[first] != number[second]) & (
        (distances[first] > distances[second]) | (distances[first] == distances[second]) & (number[first] > number[second]))
    twins = set(first[farther].tolist())
    return {road: [pole for k, (pole_road, pole) in enumerate(rows) if pole_road == road and k not in twins] for road in roadside.poles}


def _away(roadside, road, s, d, side):
    """m, median distance of places from the edge of a side of a road, however it is known."""
    return float(np.median(np.abs(d - roadside.edges[road].of(side, s))))


# What is thick and loose, as a hedge, shows uprights on its face and inside it, and may be followed along either: it is told once, by its face.

def _along_faces(things: list[tuple[str, Chain]]) -> list[tuple[str, Chain]]:
    """Kinds and chains of one side of a road in order of station; those of one kind that run nearer beside each other than two things stand are one.

    Where two are joined, the uprights nearer to the road are kept.
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


def roadside_to_features(roadside: Roadside) -> tuple[Features, Features]:
    """The layers ROADSIDE (the pieces of lines with Z along the foot, on the ground) and ROADSIDE_OBJECTS (points on the ground)."""
    lines, points = Features("LineStringZ", ROADSIDE, crs=roadside.crs), Features("PointZ", ROADSIDE_OBJECTS, crs=roadside.crs)
    for number, line in enumerate(roadside.lines):
        road, side = line.chain.road, line.chain.side
        for status, piece in line.chain.pieces():
            places = np.stack(roadside.frame.to_map(road, piece.s, piece.d, piece.ground), axis=1)
            if len(places) < 2:  # the slice of a single upright
                continue
            shape = shapely.linestrings(places[_vertices(piece.s, places, roadside.settings.interval)])
            lines.add(shape, road=road, side="left" if side > 0 else "right", line=number, kind=line.kind, status=status, station_m=piece.s[0],
                      end_m=piece.s[-1], offset_m=np.median(piece.d), edge_m=roadside.edges[road].beyond(side, piece.s, piece.d),
                      height_m=np.median(line.chain.top), foot_m=line.foot if line.foot > ON_GROUND else 0.0, length_m=shape.length)
    for road, poles in roadside.poles.items():
        for pole in poles:
            x, y, z = roadside.frame.to_map(road, np.array([pole.s]), np.array([pole.d]), np.array([pole.z]))
            side = 1 if pole.d > 0.5 * float(sum(roadside.edges[road].of(side, np.array([pole.s]))[0] for side in (1, -1))) else -1
            points.add(shapely.Point(x[0], y[0], z[0]), road=road, side="left" if side > 0 else "right", kind=pole.kind, station_m=pole.s,
                       offset_m=pole.d, edge_m=roadside.edges[road].beyond(side, np.array([pole.s]), np.array([pole.d])),
                       height_m=pole.height, diam_m=pole.diameter)
    return lines, points


def _vertices(s, places, interval):
    """Indices of the vertices that a line needs in plan and in height, and of one every interval."""
    needed = np.zeros(len(s), bool)
    for across in (places[:, :2], np.c_[s, places[:, 2]]):
        kept = shapely.get_coordinates(shapely.simplify(shapely.linestrings(across), DRAWN_TOLERANCE))
        needed |= np.isin(across[:, 0] + 1j * across[:, 1], kept[:, 0] + 1j * kept[:, 1])
    return np.flatnonzero(needed | np.r_[True, np.diff(np.floor(s / interval)) > 0])
