"""Road edges: smooth lines through the curb points of each side, cut by what was measured and what was bridged."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import splev, splprep, splrep

from ...common.arrays import stretch_of
from ...common.parallel import check_cancelled
from ...common.progress import Progress
from ...common.setting import Limited, setting
from ...curves.robust import MAD_TO_SIGMA
from ...execution.phase import THREADS, Executor, NoSource, Phase
from ...survey.frame.road_frame import RoadFrame
from ..common.curb_points import CurbPoints
from ..common.tracking import IN_LINE_TURN, is_lowered, line_across, without_outliers
from ..weights import CURBS, EDGE
from .corner_edges import curb_return_lines, draw_curb_returns, dropped_corners
from .road_edges import EdgePiece, RoadEdges, edge_sigma, joined_pieces


@dataclass(frozen=True)
class EdgeSettings(Limited):
    """How curb points become lines.

    max_gap : m that are bridged where something hides the curb; up to three times as long where both parts lie in one line. Longer ones stay open
    fallback_width : m between the edges that are drawn where no curb was found; 0 draws none
    """

    max_gap: float = setting(15.0, 0.0, 100.0, "The longest bridged gap", "m")
    fallback_width: float = setting(0.0, 2.0, 50.0, "The fallback width", "m", "for none")


def fit_road_edges(curb_points: CurbPoints, frame: RoadFrame, settings: EdgeSettings = EdgeSettings(),
                   progress: Progress = Progress(), executor: Executor = THREADS) -> RoadEdges:
    """Fit a smoothing cubic B-spline through the curb points of each side.

    curb_points : CurbPoints (those of part `top` are not used)
    executor : who fits each side

    Returns RoadEdges, along the road, one piece for each stretch of one status. Pieces of one
    edge share their end vertices and `chain`.
    """
    pieces: list[EdgePiece] = []
    of_edges = np.isin(curb_points.status, ("measured", "bridged", "occluded"))
    points = curb_points[curb_points.of_main_curb & (curb_points.part == "bottom") & of_edges]
    table, returns = point_table(points, frame), curb_return_lines(curb_points, frame)
    lines, of_table = 0, np.ascontiguousarray(table["road"])
    items = [(road.number, side, rows[rows["side"] == side]) for road in frame.roads
             for rows in (table[stretch_of(of_table, road.number, road.number)],) for side in ("left", "right")]
    phase = Phase(_edges_of_side, NoSource(), (frame, settings.max_gap), lambda item: f"road {item[0]}, {item[1]} side")
    fitted = iter(list(executor.run(phase, items)))
    for road in frame.roads:
        of_road: list[EdgePiece] = []
        for side in ("left", "right"):
            drawn = [replace(piece, chain=piece.chain + lines) for piece in next(fitted)]
            of_road += drawn
            lines = drawn[-1].chain + 1 if drawn else lines
            if settings.fallback_width:
                lines = _draw_fallback(of_road, frame, road, side, drawn, settings.fallback_width, lines)
        lines = draw_curb_returns(of_road, road.number, returns.get(road.number, []), lines, frame)
        pieces += of_road
    pieces += dropped_corners(pieces, frame, lines)
    edges = joined_pieces(pieces, frame, curb_points.crs)
    length = {status: edges.length[edges.status == status].sum() for status in ("measured", "bridged")}
    if len(edges):
        progress.info(f"Road edges: {length['measured']:.0f} m measured, {length['bridged']:.0f} m bridged.")
    else:
        progress.warn("No curb was found along this road, so there are no road edges at curbs. A verge is not a curb; a lower minimum curb "
                      "height finds low curbs, and an assumed road width draws edges without curbs.")
    progress.report(1.0)
    return edges


def point_table(points: CurbPoints, frame: RoadFrame) -> np.ndarray:
    """(N,) structured array of curb points in map coordinates, sorted by road, side and station; an unknown height is 0."""
    table = np.empty(len(points), dtype=[("road", int), ("side", "U5"), ("status", "U8"), ("s", float), ("d", float), ("x", float),
                                         ("y", float), ("z", float), ("height", float), ("chain", int), ("support", int), ("sigma", float)])
    places = points.map_places(frame)
    for name, values in dict(road=points.road, side=points.side, status=points.status, s=points.station, d=points.offset,
                             x=places[:, 0], y=places[:, 1], z=places[:, 2], height=np.nan_to_num(points.height), chain=points.chain,
                             support=points.support, sigma=np.nan_to_num(points.sigma)).items():
        table[name] = values
    return table[np.lexsort((table["d"], table["s"], table["side"], table["road"]))]


def _pieces(rows, max_gap):
    """Curb points of one side divided into edges: list of (points, is it bridged from each to the next, and is the curb lowered there?)."""
    hidden = rows["s"][rows["status"] == "occluded"]
    points = np.sort(np.append(without_outliers(rows[rows["status"] == "measured"]), rows[rows["status"] == "bridged"]), order="s")
    if len(points) < 2:
        return []
    gap = np.diff(points["s"])
    across = np.abs(np.diff(points["d"]))
    joined = (gap <= CURBS.max_joined_gap) & (across <= EDGE.max_edge_jump + EDGE.max_edge_skew * gap)
    start, end = points["s"][:-1], points["s"][1:]
    covered = CURBS.hidden_point_spacing * (np.searchsorted(hidden, end) - np.searchsorted(hidden, start, side="right"))
    bridged = (gap > CURBS.max_joined_gap) & (gap <= EDGE.in_line_gap_factor * max_gap) \
        & (covered >= EDGE.hidden_curb_share * (gap - EDGE.gap_end_allowance)) & (across <= EDGE.max_edge_jump + 0.1 * gap)
    # the longer a gap is, the better both parts must show the direction of one line; a bus in the mouth of a street hides a part of the mouth
    s = np.ascontiguousarray(points["s"])
    for k in np.flatnonzero(bridged & (gap > max_gap)):
        open_part = np.diff(np.r_[start[k], hidden[(hidden > start[k]) & (hidden < end[k])], end[k]]).max()
        bridged[k] = line_across(points, s, k)[0] * gap[k] <= EDGE.max_edge_jump and open_part <= EDGE.max_open_part
    breaks = np.flatnonzero(~(joined | bridged)) + 1
    inferred, low = points["status"] == "bridged", is_lowered(points, s)
    # what the ground shows in a gap may be a curb of full height as well; behind a lowered one the ramp to the sidewalk counts with its step
    lowered = inferred & (points["height"] <= (1.0 + EDGE.lowered_share) / 2 * points["height"].max())
    inferred, lowered, low = inferred[:-1] | inferred[1:], lowered[:-1] | lowered[1:], low[:-1] & low[1:]
    pieces = []
    for a, b in zip(np.r_[0, breaks], np.r_[breaks, len(points)]):
        if b - a >= 2 and s[b - 1] - s[a] >= EDGE.min_edge_length:
            gaps = slice(a, b - 1)
            pieces.append((points[a:b], (bridged | inferred)[gaps], (lowered | low & ~bridged)[gaps]))
    return pieces


def _with_bridges(points, bridged, frame, road):
    """Points of an edge with places of its bridges between them, as a GapLine leads, and the numbers that the points have among them.

    Also the longest bridge without such a line, m.
    """
    parts, begin, before, longest = [], 0, np.zeros(len(points), int), 0.0
    s = np.ascontiguousarray(points["s"])
    for k in np.flatnonzero(bridged):
        turn, line, axes = line_across(points, s, k)
        if turn > IN_LINE_TURN:
            longest = max(longest, s[k + 1] - s[k])
            continue
        places = line.between(EDGE.bridge_spacing)
        places = np.array(places if axes == "xy" else frame.to_map(road, *places, np.zeros(places.shape[1]))[:2])
        bridge = np.repeat(points[k:k + 1], places.shape[1])
        bridge["x"], bridge["y"] = places
        share = np.arange(1, len(bridge) + 1) / (len(bridge) + 1)
        bridge["z"] += share * (points["z"][k + 1] - points["z"][k])
        parts += [points[begin:k + 1], bridge]
        begin, before[k + 1] = k + 1, len(bridge)
    return np.concatenate([*parts, points[begin:]]), np.arange(len(points)) + np.cumsum(before), longest


class EdgeCurve:
    """A parametric smoothing cubic B-spline through curb points, by chord length.

    The smoothing follows from the noise of the points, so that their weighted squared residuals
    have the expected sum (Dierckx 1993, Curve and Surface Fitting with Splines).

    points : (N,) structured array with the fields `x`, `y`, `z`, `d` (m)
    longest_gap : m that the curve bridges by itself; the longer it is, the stiffer the curve, since the last points before a gap may give a
        poor direction
    measured : numbers of the points whose scatter is that of all; None for all of them

    t : (N,) m, chord length at the points
    residual : (N,) m, distance in plan of the points from the curve
    """

    def __init__(self, points: np.ndarray, longest_gap: float = 0.0, measured: np.ndarray | None = None):
        x, y, z = points["x"], points["y"], points["z"]
        self.middle = np.array([x.mean(), y.mean(), z.mean()])
        x, y, z = x - self.middle[0], y - self.middle[1], z - self.middle[2]
        self.t = np.r_[0.0, np.cumsum(np.maximum(np.hypot(np.diff(x), np.diff(y)), 1e-3))]
        order = min(3, len(x) - 1)
        rows = np.arange(len(x)) if measured is None else measured
        across, up = (max(_noise(self.t[rows], points[name][rows]), EDGE.gap_sigma * longest_gap) for name in ("d", "z"))
        # the noise across divides between x and y: N points have the sum N sigma²
        # where points that lie close together disagree, a fit may swing far out between its points: with more smoothing it does not
        fine = np.linspace(self.t[:-1], self.t[1:], EDGE.swing_places, axis=1)
        for factor in 4.0 ** np.arange(EDGE.max_refits):
            self.plan, _ = splprep([x, y], u=self.t, k=order, s=factor * len(x) * across**2)
            self.height = splrep(self.t, z, k=order, s=factor * len(x) * up**2)
            curve = self.at(fine.ravel()).reshape(*fine.shape, 3)
            if (np.linalg.norm(np.diff(curve, axis=1), axis=2).sum(1) <= EDGE.max_stretch * np.diff(self.t) + EDGE.max_swing).all():
                break
        fx, fy = splev(self.t, self.plan)
        self.residual = np.hypot(fx - x, fy - y)

    def at(self, t: np.ndarray) -> np.ndarray:
        """(K, 3) m, map coordinates at (K,) m of chord length."""
        x, y = splev(t, self.plan)
        return np.c_[x, y, splev(t, self.height)] + self.middle


def _noise(t, values):
    """Scatter of single points about a smooth line, from their distances to the chord of their neighbours."""
    if len(values) < 4:
        return EDGE.min_point_sigma
    left, right = np.diff(t)[:-1], np.diff(t)[1:]
    f = left / (left + right)
    off = values[1:-1] - ((1 - f) * values[:-2] + f * values[2:])
    return max(float(np.median(np.abs(off) / np.sqrt(1 + f**2 + (1 - f) ** 2))) * MAD_TO_SIGMA, EDGE.min_point_sigma)


def stretches_of(points: np.ndarray, t: np.ndarray, residual: np.ndarray, changes: np.ndarray) -> Iterator[tuple[int, np.ndarray, dict[str, Any]]]:
    """The stretches of a line, each of one kind.

    points, t, residual : as of EdgeCurve, N points
    changes : (N - 2,) bool, does the kind change at each point but the first and the last?

    Yields number of the first point, m of chord length at the vertices, and attributes of the EdgePiece: station, end, height and rmse
    """
    bounds = np.r_[0, np.flatnonzero(changes) + 1, len(points) - 1]
    for i, j in zip(bounds[:-1], bounds[1:]):
        check_cancelled()
        rows, count = points[i:j + 1], max(int(np.ceil((t[j] - t[i]) / EDGE.edge_vertex_spacing)), 1) + 1
        yield int(i), np.linspace(t[i], t[j], count), dict(station=float(rows["s"][0]), end=float(rows["s"][-1]),
                                                           height=float(np.median(rows["height"])),
                                                           rmse=float(np.sqrt(np.mean(residual[i:j + 1] ** 2))))


def _edges_of_side(source: NoSource, item: tuple[int, str, np.ndarray], frame: RoadFrame, max_gap: float) -> list[EdgePiece]:
    """The phase that fits the edges of one side, numbered from 0; item : number of the road, side, and its rows of `point_table`."""
    (road, side, rows), pieces = item, []
    for number, (points, bridged, lowered) in enumerate(_pieces(rows, max_gap)):
        measured = points["status"] == "measured"
        with_bridges, places, longest = _with_bridges(points, np.diff(points["s"]) > CURBS.max_joined_gap, frame, road)
        curve = EdgeCurve(with_bridges, longest, places[measured])
        t, residual = curve.t[places], curve.residual[places]
        for i, along, known in stretches_of(points, t, residual, np.diff(bridged) | np.diff(lowered)):
            passes = frame.passes_sigma(road, np.interp(along, t, points["s"]))
            sigma = edge_sigma(along, t[measured], residual[measured], points["support"][measured],
                               foot=EDGE.faint_foot * lowered[i], passes=passes, shared=np.interp(along, t[measured], points["sigma"][measured]))
            # a bridge is one guess
            pieces.append(EdgePiece(curve.at(along), road, side, "bridged" if bridged[i] else "measured", number, **known,
                                    what="dropped" if lowered[i] else "curb", sigma=float(sigma.mean()) if bridged[i] else sigma))
    return pieces


def _draw_fallback(pieces, frame, road, side, drawn, width, number):
    """Add lines at half the width beside the middle of the driven tracks where no edge was found."""
    passes = frame.passes_of(road.number)
    start, end = min(p.span[0] for p in passes), max(p.span[1] for p in passes)
    free, station = [], max(start, 0.0)
    for a, b in sorted((piece.station, piece.end) for piece in drawn):
        free.append((station, a))
        station = max(station, b)
    free.append((station, end))
    for a, b in free:
        if b - a < CURBS.max_joined_gap:
            continue
        s = np.linspace(a, b, max(int(np.ceil((b - a) / EDGE.edge_vertex_spacing)), 1) + 1)
        tracks = np.array([p.at_station(s)[0] for p in passes])
        offset = 0.5 * (tracks.min(0) + tracks.max(0)) + (0.5 if side == "left" else -0.5) * width
        x, y, z = frame.to_map(road.number, s, offset, frame.track_height(road.number, s))
        pieces.append(EdgePiece(np.c_[x, y, z], road.number, side, "inferred", number, float(a), float(b)))
        number += 1
    return number
