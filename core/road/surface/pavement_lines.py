"""Edges of the pavement as lines: where a road without a curb was seen to end, smoothed along the road.

A line is drawn where road inside and other ground outside were measured; where something hides both, it is bridged as curbs are. Where height alone
tells them apart, as on a slope that may begin beyond a level verge, it is inferred.
Where nothing tells the pavement from what lies beside it, there is no line.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.interpolate import make_smoothing_spline
from scipy.ndimage import uniform_filter1d

from ...common.arrays import stretch_of
from ...common.progress import Progress
from ...survey.frame.road_frame import RoadFrame
from ...survey.open_survey import Survey
from ..common.tracking import GapLine
from ..edges.fit import EdgeSettings
from ..edges.road_edges import EdgePiece, RoadEdges
from ..weights import EDGE, SURFACE
from .extract import SurfaceSettings, carriageways
from .ground_grid import MeasuredGround
from .pavement_edge import Carriageway, edge_offsets

MIN_OWN_LENGTH = 0.5 * SURFACE.agreeing_length   # derived: m of a line without that curb; which rows begin it is no better known


def with_pavement_edges(survey: Survey, edges: RoadEdges, settings: EdgeSettings = EdgeSettings(),
                        progress: Progress = Progress(), ground: MeasuredGround | None = None) -> RoadEdges:
    """The edges and, where there is no curb, edges of the pavement.

    edges : RoadEdges, of curbs
    settings : EdgeSettings, of which `max_gap` counts
    ground : MeasuredGround of the survey, which keeps what is measured here, or None

    Returns RoadEdges, the given ones first; the others have `what` pavement and no height
    """
    pieces: list[EdgePiece] = []
    for road, carriageway in carriageways(survey, edges, SurfaceSettings(), progress, ground):
        if carriageway is not None:
            pieces += _pavement_pieces(survey.frame, road, carriageway, edges, settings.max_gap, len(pieces))
    if pieces:
        length = {status: sum(piece.length for piece in pieces if piece.status == status) for status in ("measured", "bridged", "inferred")}
        progress.info(f"Edges of the pavement without a curb: {length['measured']:.0f} m measured, {length['bridged']:.0f} m bridged.")
        if length["inferred"]:
            progress.warn(f"Along {length['inferred']:.0f} m neither brightness nor roughness shows where a pavement without a curb ends. Its edges "
                          "are inferred from the slope of the ground and may lie metres beyond it; intensity or denser points tell more.")
    return edges.and_pieces(pieces, survey.frame)


def _pavement_pieces(frame: RoadFrame, road: int, carriageway: Carriageway, edges: RoadEdges, max_gap: float, chain: int = 0) -> list[EdgePiece]:
    """Edges of the pavement of one road.

    carriageway : Carriageway found with the edges
    edges : RoadEdges, where which of a side have an offset nothing is drawn
    max_gap : m, the longest bridged gap
    chain : number of the first line

    Returns a list of EdgePiece, along the road, side by side
    """
    result: list[EdgePiece] = []
    stations = carriageway.cells.stations
    has_road = np.isfinite(carriageway.left) & np.isfinite(carriageway.right)
    curbs = edge_offsets(edges, road, stations)
    for side, grown in carriageway.grown.items():
        curb = curbs[side][0]
        free = has_road & np.isnan(curb)
        # beside a curb that goes on from it the edge is shown, too
        shown = grown.shown & (free | has_road & (np.abs(np.nan_to_num(curb, nan=np.inf) - grown.offset) <= SURFACE.max_row_jump))
        agreeing = uniform_filter1d(shown.astype(float), int(SURFACE.agreeing_length / SURFACE.row_length) | 1, mode="constant") > 0.5
        places = np.array(frame.to_map(road, stations, grown.offset))
        likely = free & grown.likely
        for run in _lines(free & agreeing, agreeing, likely, likely | free & grown.hidden, grown.offset, places, max_gap):
            number = chain + len(result)
            result += [replace(piece, chain=number) for piece in _drawn(frame, road, side, carriageway, grown, run)]
    return result


def _lines(shown, confirmed, likely, possible, offset, places, max_gap):
    """[[(first, last + 1), …], …] rows of runs that are joined to lines; what lies between the runs of a line is bridged.

    `confirmed` : (R,) bool, rows that show the edge, those where a curb goes on from it included
    """
    broken = np.abs(np.diff(offset)) > SURFACE.max_row_jump
    lines: list[list[tuple[int, int]]] = []
    for run in _runs(shown, broken):
        last = lines[-1][-1] if lines else (0, -len(offset))
        gap = slice(last[1], run[0])
        if not lines or not _go_on(offset, gap, possible, places, last, run, max_gap):
            lines.append([run])
        elif likely[gap].mean() >= SURFACE.min_likely_share:
            lines[-1][-1] = (last[0], run[1])
        else:
            lines[-1].append(run)
    confirmed_runs = np.array(_runs(confirmed, broken)).reshape(-1, 2)
    return [line for line in lines if _long_enough(line, confirmed_runs)]


def _long_enough(line, seen):
    """Are the runs of a line long enough, and with the seen runs (K, 2) about them?"""
    first, end = line[0][0], line[-1][1]
    begin, stop = seen[np.searchsorted(seen[:, 0], first, "right") - 1, 0], seen[np.searchsorted(seen[:, 1], end), 1]
    row_count = sum(b - a for a, b in line)
    return row_count * SURFACE.row_length >= MIN_OWN_LENGTH \
        and (row_count + first - begin + stop - end) * SURFACE.row_length >= SURFACE.min_pavement_length


def _runs(rows, broken):
    """[(first, last + 1), …] of rows, ended also where the edge jumps."""
    bounds = np.r_[0, np.flatnonzero((rows[1:] != rows[:-1]) | broken) + 1, len(rows)]
    return [(int(a), int(b)) for a, b in zip(bounds[:-1], bounds[1:]) if rows[a]]


def _go_on(offset, gap, possible, places, last, run, max_gap):
    """Whether a line may go on from its last run to another one after a gap of rows."""
    length = (gap.stop - gap.start) * SURFACE.row_length
    near = 0 < length <= EDGE.in_line_gap_factor * max_gap
    if not near or abs(offset[gap.stop] - offset[gap.start - 1]) > EDGE.max_edge_jump + SURFACE.max_bridged_skew * length:
        return False
    # across a long gap both runs lie on one even bend
    long = min(last[1] - last[0], run[1] - run[0]) * SURFACE.row_length >= SURFACE.agreeing_length
    return possible[gap].mean() >= EDGE.min_hidden_share and (length <= max_gap or long and GapLine(
        places[:, slice(*last)], places[:, slice(*run)], max_degree=2).miss <= SURFACE.max_line_miss)


def _drawn(frame, road, side, carriageway, grown, runs):
    """The pieces of one line, which has no number yet."""
    stations = carriageway.cells.stations
    rows = np.concatenate([np.arange(a, b) for a, b in runs])
    offset, sigma, guess = grown.offset[rows], grown.sigma[rows], np.where(grown.inferred, grown.guess, 0.0)[rows]
    # a place depends on what lies within a few smoothing lengths, and on nothing farther along the line (Silverman 1984)
    curve = make_smoothing_spline(stations[rows], offset, w=sigma**-2.0,
                                  lam=SURFACE.smoothing_length**4 / (np.median(sigma)**2 * SURFACE.row_length))
    residual = offset - curve(stations[rows])
    pieces = []
    for k, (a, b) in enumerate(runs):
        if k:
            pieces.append(("bridged", stations[runs[k - 1][1] - 1], stations[a]))
        # a single row between two gaps is a place where bridges meet, without a length to draw
        bounds = np.r_[a, a + 1 + np.flatnonzero(np.diff(grown.inferred[a:b])), b - 1]
        pieces += [("inferred" if grown.inferred[i] else "measured", stations[i], stations[j]) for i, j in zip(bounds[:-1], bounds[1:]) if j > i]
    result = []
    for status, start, end in pieces:
        s = np.linspace(start, end, max(int(np.ceil((end - start) / EDGE.edge_vertex_spacing)), 1) + 1)
        d = curve(s) if status != "bridged" else np.interp(s, [start, end], curve([start, end]))
        vertices = np.c_[frame.to_map(road, s, d, _height(carriageway, s, d))]
        near = stretch_of(stations[rows], start, end)
        passes = frame.passes_sigma(road, s)
        rmse = float(np.sqrt(np.mean(residual[near] ** 2)))
        # the line is off as far as rows scatter about it, and by a share of what one row is; a bridge may bend as one of a curb: in the mean along it
        # by two thirds of what it bends in its middle
        bend = 0.0 if status != "bridged" else EDGE.bridge_bend * (end - start) ** 3 / 1.5
        variance = float(SURFACE.row_share**2 * np.mean(sigma[near] ** 2) + rmse**2 + bend**2 + np.mean(passes**2) + np.mean(guess[near] ** 2))
        result.append(EdgePiece(vertices, road, side, status, -1, float(start), float(end), rmse=rmse, what="pavement", sigma=variance**0.5))
    return result


def _height(carriageway, s, d):
    """(N,) m, local z of the road at its edge."""
    cells = carriageway.cells
    row = np.clip(s / SURFACE.row_length - cells.first_row - 0.5, 0, len(carriageway.height) - 1)
    column = np.clip(np.floor(d / SURFACE.column_width).astype(int) - cells.first_column, 0, carriageway.height.shape[1] - 1)
    i = np.minimum(row.astype(int), len(carriageway.height) - 2)
    low, high = carriageway.height[i, column], carriageway.height[i + 1, column]
    return low + (row - i) * (high - low)
