"""Find what stands beside the road."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ....core.common.parallel import ordered_map
from ....core.common.progress import Progress
from ....core.countries.catalogue import country
from ....core.survey.survey import Survey
from ..borders import BorderLayers, RoadBorders
from ..settings import RoadsideSettings
from ..surface_grid import SLICE_LENGTH
from .chains import find_chains, gaps_by_window, judged, pulses_at, things_of
from .ground import GROUND_CELL, find_gutters, level_views, lines_of_sight, local_ground
from .result import Roadside, SideEdges, SideLine, along_faces, told_once
from .uprights import UPRIGHT_SLICE, Uprights, find_poles, find_uprights

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
            chains = find_chains(Uprights.joined(stretches), road, side, settings.max_gap, settings.min_length, into)
            unknown += sum(chain.length for chain in chains if chain.members.above_view.mean() > 0.5)
            if sort == "gutter":
                classified = [("gutter", chain) for chain in chains]
            else:
                classified = along_faces([piece for chain in chains for piece in things_of(chain, settings.min_length)])
            for kind, part in classified:
                roadside.lines.append(SideLine(kind, part, float(np.median(part.members.foot))))
    if unknown:
        roadside.notes.append(f"{unknown:.0f} m of what stands beside the road are as high as the scanner, which sees hardly higher, as heads of "
                              "many beams do. They are left out, for house fronts look the same to it.")
    roadside.lines, roadside.poles = told_once(roadside)
    roadside.lines.sort(key=lambda line: (line.chain.road, -line.chain.side, float(line.chain.s[0])))
    _report(roadside, progress)
    return roadside


def _report(found: Roadside, progress: Progress) -> None:
    """Log what was found, and what was missing for it."""
    lengths: dict[str, float] = {}
    for line in found.lines:
        lengths[line.kind] = lengths.get(line.kind, 0.0) + sum(piece.length for _, piece in line.chain.pieces())
    text = ", ".join(f"{length:.0f} m of {kind.replace('_', ' ')}" for kind, length in sorted(lengths.items())) or "no lines"
    progress.info(f"Beside the road: {text}; {sum(map(len, found.poles.values()))} poles, signs and trunks.")
    if not any(edges.known for edges in found.edges.values()):
        found.notes.append("Without road edges, marking lines, driving lines or lanes everything more than "
                           f"{BEYOND_TRACK:.0f} m from the track counts as beside the road, parked cars "
                           "too, and gutters are not looked for. Give the road edges.")
    for note in found.notes:
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


def _down(d):
    """The next border of a cell of the ground, so that cells are the same in every window."""
    return float(np.floor(d / GROUND_CELL) * GROUND_CELL)


def _above_view(survey, road, uprights, height):
    """(N,) bool, whether uprights are as high as the scanner, m above the road, whose view is level; None is one that sees all round."""
    if height is None:
        return np.zeros(len(uprights), bool)
    s = (uprights.slice + 0.5) * UPRIGHT_SLICE
    return uprights.ground + uprights.top - survey.road_height(road, s) > height


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
    ground = local_ground(s, d, h, wide[0], int(round(wide[1] - wide[0])), (_down(d.min()), float(d.max()) + 1e-3))
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
        result["line", side] = replace(uprights, above_view=_above_view(survey, road, uprights, level.get(nearest)))
        if edges.known:
            result["gutter", side] = find_gutters(survey, road, start, int(round(ROADSIDE_WINDOW / SLICE_LENGTH)), side, partial(edges.of, side))
    return result, sorted(poles, key=lambda pole: (pole.s, pole.d))
