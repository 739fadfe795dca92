"""Corners where the curb is dropped for a crossing: arcs between the ends of edges that bend towards each other.

At a crossing the curb is lowered to a centimetre or two, which no scan shows as a step. The edge of the road goes on there all the
same: around a corner it leaves the one curb along its tangent, bends evenly, and meets the other along its tangent. Where it has to
go farther on the one tangent than on the other it goes straight there first: a corner is an arc that two lines touch. A gap between two
ends that point straight at each other may as well be the mouth of a street, and stays open.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...common.parallel import check_cancelled
from ...survey.frame.placement import COORDINATE_DECIMALS
from ...survey.frame.road_frame import RoadFrame
from .road_edges import EdgePiece

MAX_DROPPED_GAP = 8.0         # m of dropped curb around a corner
MIN_DROPPED_GAP = 0.3         # m
MIN_ARC_TURN, MAX_ARC_TURN = np.radians(12.0), np.radians(100.0)   # from end to end
BEND_LENGTH = 3.0             # m at the end of an edge that tell how it bends
MIN_BEND_TURN = np.radians(8.0)   # within this length: the end belongs to a corner
MAX_RADIUS_RATIO = 2.5        # of the arc in the gap over the bend at its end, and the other way
DIRECTION_LENGTH = 1.0        # m at the end of an edge that give its direction
MAX_END_STEP, MAX_END_GRADE = 0.03, 0.08   # m, and m per m, that both ends may differ in height
MEETING_DISTANCE = 0.05             # m within which two ends meet
ARC_VERTEX_SPACING = 0.25     # m


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

    Parameters
    ----------
    pieces : measured and bridged edges of all roads
    frame : RoadFrame
    number : of the first new line
    """
    lines = [(piece, _uphill_right(piece)) for piece in pieces if piece.kind != "island" and piece.status != "inferred" and piece.part == "bottom"]
    tails, heads = ([_end(piece, line[::step]) for piece, line in lines] for step in (1, -1))
    places = np.array([end.place[:2] for end in tails + heads]).reshape(-1, 2)
    free = cKDTree(places).query_ball_point(places, MEETING_DISTANCE, return_length=True) == 1
    begin, end = np.flatnonzero(free[:len(tails)]), np.flatnonzero(free[len(tails):])
    near = cKDTree(places[begin]).query_ball_tree(cKDTree(places[len(tails) + end]), MAX_DROPPED_GAP + MEETING_DISTANCE)
    found = []
    for i, ahead in zip(begin.tolist(), near):
        check_cancelled()
        for j in end[ahead].tolist():
            if i != j and _is_corner(tails[i], heads[j]):
                found.append((float(np.hypot(*(heads[j].place - tails[i].place)[:2])), i, j))
    arcs: list[EdgePiece] = []
    used: set[tuple[str, int]] = set()
    for _, i, j in sorted(found):
        if not used & {("tail", i), ("head", j)}:
            used |= {("tail", i), ("head", j)}
            arcs.append(_arc(tails[i], heads[j], frame, number + len(arcs)))
    return arcs


def _uphill_right(piece):
    """(V, 3) the vertices of a piece, in the direction that has the sidewalk on its right."""
    # main edges run along the road, all others have it there already
    return piece.vertices[::-1] if piece.kind == "main" and piece.side == "left" else piece.vertices


def _end(piece, line):
    """The last vertex of a line as _End."""
    away = np.hypot(*(line[:, :2] - line[-1, :2]).T)

    def back(length):
        far = np.flatnonzero(away >= length)
        return int(far[-1]) if len(far) else 0

    near, first = back(DIRECTION_LENGTH), back(BEND_LENGTH)
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
    """Do two ends bend towards each other about the sidewalk, which lies right of the way from tail to head?"""
    chord = head.place - tail.place
    gap = float(np.hypot(*chord[:2]))
    if not MIN_DROPPED_GAP <= gap <= MAX_DROPPED_GAP or abs(chord[2]) > MAX_END_STEP + MAX_END_GRADE * gap:
        return False
    first, last = _turns(tail, head)
    if min(first, last) <= 0.0 or not MIN_ARC_TURN <= first + last <= MAX_ARC_TURN:
        return False
    radius = _radius(gap, first, last)
    # seen from its own piece a head bends the other way
    for bend, length in ((-tail.turn, tail.length), (head.turn, head.length)):
        if bend >= MIN_BEND_TURN and 1 / MAX_RADIUS_RATIO <= radius * bend / length <= MAX_RADIUS_RATIO:
            return True
    return False


def _turns(tail, head):
    """Radians to the right, from the direction of a tail to the chord of the gap, and from the chord to the direction of the head."""
    chord = (head.place - tail.place)[:2]
    return -_angle(tail.out, chord), -_angle(chord, -head.out)


def _tangents(gap, first, last):
    """m from both ends of a gap to the place where their directions meet, which are off its chord by these angles, radians."""
    turn = np.sin(first + last)
    return gap * np.sin(last) / turn, gap * np.sin(first) / turn


def _radius(gap, first, last):
    """m, of the largest arc in a gap that touches the directions of both ends, which are off its chord by these angles, radians."""
    return min(_tangents(gap, first, last)) / np.tan(0.5 * (first + last))


def _arc(tail, head, frame, number):
    """The piece of edge from a tail to a head: straight on as far as the one tangent is longer than the other, and the arc that both touch."""
    chord = head.place - tail.place
    gap = float(np.hypot(*chord[:2]))
    first, last = _turns(tail, head)
    before, behind = _tangents(gap, first, last)
    radius, turn = _radius(gap, first, last), first + last
    straight, bend = max(before - behind, 0.0), radius * turn
    length = straight + bend + max(behind - before, 0.0)
    along = np.linspace(0.0, length, int(np.ceil(length / ARC_VERTEX_SPACING)) + 1)
    angle = np.clip(along - straight, 0.0, bend) / radius
    ahead = np.minimum(along, straight) + radius * np.sin(angle)
    aside = radius * (1.0 - np.cos(angle))
    rest = np.maximum(along - straight - bend, 0.0)
    ahead, aside = ahead + rest * np.cos(turn), aside + rest * np.sin(turn)
    plan = tail.place[:2] + ahead[:, None] * tail.out + aside[:, None] * np.array([tail.out[1], -tail.out[0]])
    vertices = np.round(np.c_[plan, tail.place[2] + along / length * chord[2]], COORDINATE_DECIMALS)
    vertices[0], vertices[-1] = tail.place, head.place
    piece = tail.piece
    s, _ = frame.road(piece.road).locate(*(vertices[:, :2] - frame.origin[:2]).T)
    s = s[np.isfinite(s)] if np.isfinite(s).any() else np.array([piece.end])
    return EdgePiece(vertices, piece.road, piece.side, "bridged", number, float(s.min()), float(s.max()),
                     float(np.hypot(*np.diff(vertices[:, :2], axis=0).T).sum()), kind="corner")
