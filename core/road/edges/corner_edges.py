"""Edges of corners, side streets and islands: smooth lines along the curb's own course, from the end of the main edge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import Akima1DInterpolator
from scipy.spatial import cKDTree

from ...common.parallel import check_cancelled
from ...survey.frame.placement import COORDINATE_DECIMALS
from ...survey.frame.road_frame import RoadFrame
from ..common.curb_points import CurbPoints
from ..common.pseudo_scanlines import expand_ranges
from ..weights import CURBS, EDGE
from .road_edges import EdgePiece, edge_sigma


def curb_return_lines(curb_points: CurbPoints, frame: RoadFrame) -> dict[int, list[tuple[CurbPoints, np.ndarray]]]:
    """The measured curb points that are not of a main curb, by road and chain, in order along each chain.

    Returns a dict road -> list of (points, (N, 3) map coordinates), chains ascending
    """
    points = curb_points[~curb_points.of_main_curb & (curb_points.status == "measured") & (curb_points.part == "bottom")]
    points = points[np.lexsort((points.along, points.chain, points.road))]
    cuts = np.flatnonzero((np.diff(points.road) != 0) | (np.diff(points.chain) != 0)) + 1
    lines: dict[int, list[tuple[CurbPoints, np.ndarray]]] = {}
    for rows in np.split(np.arange(len(points)), cuts):
        if len(rows) > 1:
            lines.setdefault(int(points.road[rows[0]]), []).append((points[rows], points[rows].map_places(frame)))
    return lines


def draw_curb_returns(edges: list[EdgePiece], road: int, lines: list[tuple[CurbPoints, np.ndarray]], number: int,
                      frame: RoadFrame | None = None) -> int:
    """Add the edges of corners, side streets and islands of one road.

    A corner begins with the vertex at which the main edge ends, so that the two touch.

    edges : pieces of the main edges, to which these are added
    lines : of this road, from `curb_return_lines`
    number : of the first line
    frame : RoadFrame, which says how far the middle of the passes may be off; None if nothing does

    Returns The next free line number
    """
    ends = _main_ends(edges, road)
    tree = cKDTree(ends[:, :2])
    for points, places in lines:
        first, last = _ends_met(places, points.kind[0], ends, tree)
        passes = 0.0 if frame is None else float(np.sqrt(np.mean(frame.passes_sigma(road, points.station) ** 2)))
        edges.append(_edge_of(points, places, first, last, passes, road, number))
        number += 1
    return number


def _ends_met(places, kind, ends, tree):
    """The ends of main edges, (1, 3) each or (0, 3), at which a line begins and ends; one end alone where both are the same."""
    if kind == "island":
        return places[:0], places[:0]
    first, last = (_nearest(ends, tree, places[k]) for k in (0, -1))
    if len(first) and len(last) and np.array_equal(first, last):
        distance = np.hypot(*(places[[0, -1], :2] - first[0, :2]).T)
        return (first, last[:0]) if distance[0] <= distance[1] else (first[:0], last)
    return first, last


def _edge_of(points, places, first, last, passes, road, number):
    """The piece of one line, from and to the ends of main edges, (1, 3) or (0, 3), that it meets; `passes` : m, one sigma of their middle."""
    kind = points.kind[0]
    closed = kind == "island" and np.hypot(*(places[0, :2] - places[-1, :2])) <= EDGE.same_place_distance
    # the main edge's own end is a place of the curve, so that an arc stays one where the curb was not seen for a metre
    places = np.concatenate([first, places, last])
    smooth = _smoothed(places)
    vertices, residual = _through(smooth), np.hypot(*(smooth - places)[:, :2].T)
    along, shared = _chord_length(*places.T[:2]), np.nan_to_num(points.sigma)
    shared = np.concatenate([shared[:len(first)], shared, shared[len(shared) - len(last):]])
    vertices = np.round(vertices, COORDINATE_DECIMALS)
    if closed:
        vertices[-1] = vertices[0]
    vertices[:len(first)], vertices[len(vertices) - len(last):] = first, last
    vertices = vertices[np.r_[True, np.hypot(*np.diff(vertices[:, :2], axis=0).T) > 0]]
    sigma = edge_sigma(along, along, residual, foot=EDGE.faint_foot, passes=passes, shared=shared)
    # where the returns thin out a line is cut; elsewhere one number speaks for all of it
    vertex_lengths = _chord_length(*vertices.T[:2])
    sigma = np.interp(vertex_lengths * along[-1] / vertex_lengths[-1], along, sigma) if shared.any() else np.full(len(vertex_lengths), sigma.mean())
    return EdgePiece(vertices, road, points.side[0], "measured", number, float(points.station.min()), float(points.station.max()),
                     height=float(np.median(points.height)), rmse=float(np.sqrt(np.mean(residual**2))), kind=kind, sigma=sigma)


def _smoothed(places):
    """Places moved onto the parabolas fitted to their neighbours within EDGE.smoothing_half_length, which keeps arcs (local regression)."""
    t = _chord_length(places[:, 0], places[:, 1])
    owner, index = expand_ranges(np.searchsorted(t, t - EDGE.smoothing_half_length), np.searchsorted(t, t + EDGE.smoothing_half_length, side="right"))
    u = t[index] - t[owner]
    weight = 1.0 - (u / (EDGE.smoothing_half_length * 1.1)) ** 2
    count = np.bincount(owner, minlength=len(t))
    powers = [np.bincount(owner, weight * u**k, len(t)) for k in range(5)]
    # the small term keeps the equations of few neighbours solvable
    normal = np.array([[powers[i + j] for j in range(3)] for i in range(3)]).transpose(2, 0, 1) + 1e-9 * np.eye(3)
    right = np.array([[np.bincount(owner, weight * u**k * (places[index, c] - places[owner, c]), len(t)) for c in range(3)]
                      for k in range(3)]).transpose(2, 0, 1)
    moved = places + np.linalg.solve(normal, right)[:, 0]
    # the ends keep their places, since other lines begin there
    moved[[0, -1]] = places[[0, -1]]
    return np.where((count >= 4)[:, None], moved, places)


def _through(places):
    """(M, 3) vertices of an Akima curve through places, EDGE.return_vertex_spacing apart."""
    if len(places) < 3:
        return places
    t = _chord_length(places[:, 0], places[:, 1])
    return Akima1DInterpolator(t, places)(np.linspace(0.0, t[-1], int(np.ceil(t[-1] / EDGE.return_vertex_spacing)) + 1))


def _chord_length(x, y):
    """(N,) metres along a polyline at its vertices; no two are the same."""
    return np.r_[0.0, np.cumsum(np.maximum(np.hypot(np.diff(x), np.diff(y)), 1e-3))]


def _main_ends(edges, road):
    """(K, 3) end vertices of the main edges of a road, except those where two pieces touch."""
    ends = [np.round(piece.vertices[k], COORDINATE_DECIMALS) for piece in edges if piece.road == road and piece.kind == "main" for k in (0, -1)]
    ends = np.array(ends).reshape(-1, 3)
    return ends[cKDTree(ends[:, :2]).query_ball_point(ends[:, :2], EDGE.same_place_distance, return_length=True) == 1]


def _nearest(ends, tree, place):
    """(1, 3) the end within CURBS.max_joined_gap of a place, (0, 3) where there is none; `tree` : cKDTree of the ends in plan."""
    distance, k = tree.query(place[:2])
    return ends[k:k + 1] if distance <= CURBS.max_joined_gap else ends[:0]


# Corners where the curb is dropped for a crossing: arcs between the ends of edges that bend towards each other.
#
# At a crossing the curb is lowered to a centimetre or two, which no scan shows as a step. The edge of the road goes on there all the same: around a
# corner it leaves the one curb along its tangent, bends evenly, and meets the other along its tangent. Where it has to go farther on the one
# tangent than on the other it goes straight there first: a corner is an arc that two lines touch. Where two ends point straight at each other the
# curb of a side street goes straight on. Of the road's own curb such a gap may as well be the mouth of a street, and stays open.


@dataclass
class _End:
    """The end of a piece of edge: place (3,), unit vector out of the piece, radians turned to the left over its last metres, their length."""

    piece: EdgePiece
    place: np.ndarray
    out: np.ndarray
    turn: float
    length: float


def dropped_corners(pieces: Sequence[EdgePiece], frame: RoadFrame, number: int) -> list[EdgePiece]:
    """Arcs across dropped corners, as pieces of status bridged and kind corner.

    pieces : measured and bridged edges of all roads
    number : of the first new line
    """
    # the sidewalk lies right of lines: main edges run along the road, all others have it there already
    lines = [(piece, piece.vertices[::-1] if piece.kind == "main" and piece.side == "left" else piece.vertices)
             for piece in pieces if piece.kind != "island" and piece.status != "inferred" and piece.part == "bottom"]
    tails, heads = ([_end(piece, line[::step]) for piece, line in lines] for step in (1, -1))
    places = np.array([end.place[:2] for end in tails + heads]).reshape(-1, 2)
    free = cKDTree(places).query_ball_point(places, EDGE.meeting_distance, return_length=True) == 1
    begin, end = np.flatnonzero(free[:len(tails)]), np.flatnonzero(free[len(tails):])
    near = cKDTree(places[begin]).query_ball_tree(cKDTree(places[len(tails) + end]), EDGE.max_dropped_gap + EDGE.meeting_distance)
    gaps = []
    for i, ahead in zip(begin.tolist(), near):
        check_cancelled()
        for j in end[ahead].tolist():
            if i != j and _is_corner(tails[i], heads[j]):
                gaps.append((float(np.hypot(*(heads[j].place - tails[i].place)[:2])), i, j))
    arcs: list[EdgePiece] = []
    used: set[tuple[str, int]] = set()
    for _, i, j in sorted(gaps):
        if not used & {("tail", i), ("head", j)}:
            used |= {("tail", i), ("head", j)}
            arcs.append(_arc(tails[i], heads[j], frame, number + len(arcs)))
    return arcs


def _end(piece, line):
    """The last vertex of a line as _End."""
    distance = np.hypot(*(line[:, :2] - line[-1, :2]).T)

    def back(length):
        far = np.flatnonzero(distance >= length)
        return int(far[-1]) if len(far) else 0

    near, first = back(EDGE.direction_length), back(EDGE.bend_length)
    out = line[-1, :2] - line[near, :2]
    middle = line[(first + len(line) - 1) // 2, :2]
    before, after = middle - line[first, :2], line[-1, :2] - middle
    # the turn between the chords of both halves is half of that from end to end
    turn = 2.0 * _angle(before, after) if min(np.hypot(*before), np.hypot(*after)) > 0.2 else 0.0
    # on an arc the chord to the end lags behind the tangent by half of its turn
    length = max(float(np.hypot(*before) + np.hypot(*after)), 1e-9)
    lag = 0.5 * turn * min(float(np.hypot(*out)) / length, 1.0)
    unit = out / max(np.hypot(*out), 1e-9)
    unit = np.array([unit[0] * np.cos(lag) - unit[1] * np.sin(lag), unit[0] * np.sin(lag) + unit[1] * np.cos(lag)])
    return _End(piece, line[-1], unit, turn, length)


def _angle(a, b):
    """Radians from one vector to another, to the left positive."""
    return float(np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b))


def _is_corner(tail, head):
    """Do two ends bend towards each other about the sidewalk, which lies right of the way from tail to head, or lead straight to each other?"""
    chord = head.place - tail.place
    gap = float(np.hypot(*chord[:2]))
    if not EDGE.min_dropped_gap <= gap <= EDGE.max_dropped_gap or abs(chord[2]) > EDGE.max_end_step + EDGE.max_end_grade * gap:
        return False
    met = _tangents(tail, head)
    if met is None:
        # of a road's own curb the ground tells whether it goes straight on; on its other side the street opposite begins
        return "main" not in (tail.piece.kind, head.piece.kind) and (tail.piece.road, tail.piece.side) == (head.piece.road, head.piece.side) \
            and max(map(abs, _turns(tail, head))) < 0.5 * EDGE.min_arc_turn
    # seen from its own piece a head bends the other way
    return any(bend >= EDGE.min_bend_turn and 1 / EDGE.max_radius_ratio <= met[-1] * bend / length <= EDGE.max_radius_ratio
               for bend, length in ((-tail.turn, tail.length), (head.turn, head.length)))


def _turns(tail, head):
    """Radians to the right from the way out of a tail to the straight way to a head, and from there to the way into the head."""
    chord = (head.place - tail.place)[:2]
    return -_angle(tail.out, chord), -_angle(chord, -head.out)


def _tangents(tail, head):
    """How the directions of two ends meet: radians to the right from tail to head, m from both to the place where they meet, and m of radius.

    The radius is that of the largest arc in the gap that touches both directions. Nothing where they do not turn to the right, or too little or much.
    """
    first, last = _turns(tail, head)
    turn, gap = first + last, float(np.hypot(*(head.place - tail.place)[:2]))
    if min(first, last) <= 0.0 or not EDGE.min_arc_turn <= turn <= EDGE.max_arc_turn:
        return None
    before, behind = gap * np.sin(last) / np.sin(turn), gap * np.sin(first) / np.sin(turn)
    return turn, before, behind, min(before, behind) / np.tan(0.5 * turn)


def _arc(tail, head, frame, number):
    """The piece of edge from a tail to a head: straight on as far as the one tangent is longer than the other, and the arc that both touch."""
    way = (head.place - tail.place)[:2]
    gap = float(np.hypot(*way))
    met = _tangents(tail, head)
    turn, before, behind, radius = met or (0.0, gap, 0.0, gap)
    out = tail.out if met else way / gap
    straight, bend = max(before - behind, 0.0), radius * turn
    length = straight + bend + max(behind - before, 0.0)
    along = np.linspace(0.0, length, int(np.ceil(length / EDGE.arc_vertex_spacing)) + 1)
    angle = np.clip(along - straight, 0.0, bend) / radius
    ahead = np.minimum(along, straight) + radius * np.sin(angle)
    sideways = radius * (1.0 - np.cos(angle))
    after_arc = np.maximum(along - straight - bend, 0.0)
    ahead, sideways = ahead + after_arc * np.cos(turn), sideways + after_arc * np.sin(turn)
    plan = tail.place[:2] + ahead[:, None] * out + sideways[:, None] * np.array([out[1], -out[0]])
    vertices = np.round(np.c_[plan, tail.place[2] + along / length * (head.place - tail.place)[2]], COORDINATE_DECIMALS)
    vertices[0], vertices[-1] = tail.place, head.place
    piece = tail.piece
    s, _ = frame.road(piece.road).locate(*(vertices[:, :2] - frame.origin[:2]).T)
    s = s[np.isfinite(s)] if np.isfinite(s).any() else np.array([piece.end])
    # as uncertain as what it joins, and a guess between
    sigma = np.hypot(max(float(np.mean(np.nan_to_num(end.piece.sigma))) for end in (tail, head)), EDGE.arc_sigma * length)
    return EdgePiece(vertices, piece.road, piece.side, "bridged", number, float(s.min()), float(s.max()), kind="corner", sigma=float(sigma))
