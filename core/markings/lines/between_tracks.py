"""Paint between two tracks of the scan: a line goes on there, and no track was on it.

Far from the vehicle the tracks of the scan lie farther apart than a line is broad. They cross it askew, so that it shows
for some metres on one track, then on none, then on the next. Where it does on none, the tracks on both sides of it are
asphalt: no gap was seen between them. Where a track on its course is asphalt, the line was seen to be worn or to end.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import shapely

from ...common.parallel import check_cancelled
from ...curves.robust import median
from ..cells.scan_tracks import MIN_TRACK_GAP
from ..objects.classify import LINE_KINDS
from ..objects.marking_objects import MarkingObjects, Outlines
from ..paint.morphology import MAX_TRACK_GAP
from .lines_beside import StretchLookup

if TYPE_CHECKING:
    from ...survey.store.road_points import RoadPoints
    from .painted_lines import PaintedLines

STEP = 0.25                # m along a line, over which it is asked what lies on its course and beside it
STEP_REACH = 0.12          # m before and after a step whose points count for it: those of a track lie so near
BESIDE_GAP = 10.0          # m before and after a gap, whose paint tells how bright the line is, and on what tracks it was seen
ON_LINE = 0.15             # m across between a marking and the course of the line that it is of
MIN_SEEN_LENGTH = 4.0      # m of a marking: over so much a track that crosses the line askew shows most of its width
MIN_FREE_SHARE = 0.6       # of the width of a line: it has no room where tracks on asphalt lie nearer to each other
CORE_SHARE = 0.25          # of the width of a line, from its middle: where asphalt lies so near, the course is not just off by a little
MAX_BARE_SHARE = 0.35      # of a gap in which the course is asphalt: wear leaves so much, and with more the line is not there
SHORTEST_UNSEEN = 0.5      # m: less is nothing to draw
UNKNOWN, BARE, FREE = 0, 1, 2


class SeenPaint(NamedTuple):
    """What is known of the paint of a line: the spacing of the tracks that it was seen on, m, its brightness and its width, m."""

    spacing: float
    brightness: float
    width: float


def with_unseen_paint(lines: PaintedLines, markings: MarkingObjects, paint: RoadPoints, road_points: RoadPoints) -> PaintedLines:
    """Lines that know where in their gaps they lie between two tracks of the scan.

    Parameters
    ----------
    lines : PaintedLines
    markings : MarkingObjects they were made of
    paint : RoadPoints of the markings, with `spacing`
    road_points : RoadPoints

    Returns
    -------
    PaintedLines with `unseen`
    """
    unseen = [np.empty((0, 3)) for _ in range(len(lines))]
    if not paint.has_spacing:
        return replace(lines, unseen=unseen)
    marked = _MarkedLines(lines, markings)
    for k in np.flatnonzero((lines.status == "bridged") & (lines.pattern == "solid")).tolist():
        check_cancelled()
        road, (whole, own) = int(lines.course.road[k]), marked.of_piece(k)
        piece = lines.course.s[lines.course.line(k)]
        first, last = float(np.nanmin(piece)), float(np.nanmax(piece))
        course = _between(whole, first - 2 * BESIDE_GAP, last + 2 * BESIDE_GAP)
        seen = _paint_beside(paint, road, course, first, last, _full_width(markings, own))
        if seen is None or seen.spacing < MIN_TRACK_GAP:
            continue
        near = own[(markings.extent[own, 0] <= last) & (markings.extent[own, 1] >= first)]
        gaps = _less(first, last, markings.extent[near, :2])
        steps = [np.linspace(a, b, int(np.ceil((b - a) / STEP)) + 1) for a, b in gaps]
        states = [_states(road_points, road, course, some, seen) for some in steps]
        known = np.concatenate([*states, np.empty(0, int)])
        if np.count_nonzero(known == BARE) <= MAX_BARE_SHARE * np.count_nonzero(known != UNKNOWN):
            found = [run for some, state in zip(steps, states) for run in _runs(some, state == FREE)]
            unseen[k] = np.array([(a, b, seen.width) for a, b in found if b - a >= SHORTEST_UNSEEN]).reshape(-1, 3)
    return replace(lines, unseen=unseen)


class _MarkedLines:
    """The courses of lines and the markings on them, looked up once for each line."""

    def __init__(self, lines, markings):
        self.lines, self.markings, self.found = lines, markings, {}
        self.pieces = {}
        for k, number in enumerate(lines.line.tolist()):
            self.pieces.setdefault(number, []).append(k)
        of_lines = np.flatnonzero(markings.keep & np.isin(markings.kind.astype(str), LINE_KINDS) & np.isfinite(markings.extent[:, 0]))
        self.markings_of = {road: of_lines[markings.road[of_lines] == road] for road in np.unique(lines.course.road).tolist()}
        self.lookup = {road: StretchLookup(*markings.extent[rows, :2].T) for road, rows in self.markings_of.items()}

    def of_piece(self, k):
        """Of the line of a piece: (2, N) stations and offsets by station, and the numbers of the markings that lie on its course."""
        key = int(self.lines.course.road[k]), int(self.lines.line[k])
        if key not in self.found:
            course = self._course(key[1])
            self.found[key] = course, self._own_markings(key[0], course)
        return self.found[key]

    def _course(self, number):
        course = self.lines.course
        rows = np.concatenate([np.arange(course.start[k], course.start[k + 1]) for k in self.pieces[number]])
        rows = rows[np.isfinite(course.s[rows])]
        rows = rows[np.argsort(course.s[rows], kind="stable")]
        return course.s[rows], course.d[rows]

    def _own_markings(self, road, course):
        near = self.markings_of[road][self.lookup[road].between(course[0][0], course[0][-1])]
        first, last, *_ = self.markings.extent[near].T
        away = np.abs(self.markings.offset[near] - np.interp((first + last) / 2, *course))
        return near[(away <= ON_LINE) & (last > course[0][0]) & (first < course[0][-1])]


def _between(course, first, last):
    """The course of a line between two stations, and the places before and after."""
    inside = slice(max(int(np.searchsorted(course[0], first)) - 1, 0), int(np.searchsorted(course[0], last, side="right")) + 1)
    return course[0][inside], course[1][inside]


def _full_width(markings, own):
    """The width of a line: that of the widest of its pieces, as few tracks show less of it and never more; 0 where nothing is known."""
    long = own[markings.length[own] >= MIN_SEEN_LENGTH]
    return float(markings.width[long].max()) if len(long) else 0.0


def _paint_beside(paint, road, course, first, last, width):
    """SeenPaint of a line about a gap; None where there is none."""
    near = paint.window(road, first - BESIDE_GAP, last + BESIDE_GAP)
    on = (near.cluster > 0) & (np.abs(near.d - np.interp(near.s, *course)) <= max(width / 2, MIN_TRACK_GAP / 2))
    if not on.any() or not width:
        return None
    return SeenPaint(median(near.spacing[on].astype(float)), median(near.value[on].astype(float)), width)


def _less(first, last, spans):
    """[(first, last)] of what is left of an interval without some others."""
    left, at = [], first
    for begin, end in sorted(spans.tolist()):
        if begin > at:
            left.append((at, min(begin, last)))
        at = max(at, end)
        if at >= last:
            break
    left.append((at, last))
    return [(a, b) for a, b in left if b - a >= SHORTEST_UNSEEN]


def _states(road_points, road, course, steps, seen):
    """(N,) FREE, BARE or UNKNOWN of each of the N steps of a gap, whose N + 1 stations are given."""
    near = road_points.window(road, steps[0] - STEP_REACH, steps[-1] + STEP_REACH)
    s, away, value = near.s, near.d - np.interp(near.s, *course), near.value
    close = np.abs(away) <= MAX_TRACK_GAP
    s, away, value = s[close], away[close], value[close]
    beside = np.abs(away) > seen.width / 2 + MIN_TRACK_GAP
    if not beside.any():
        return np.full(len(steps) - 1, UNKNOWN)
    dark = value < (median(value[beside].astype(float)) + seen.brightness) / 2
    count = len(steps) - 1
    low, high, painted = np.full(count, -np.inf), np.full(count, np.inf), np.zeros(count, bool)
    # a point counts for the step that it lies in and for those that it lies near
    for reach in (-STEP_REACH, 0.0, STEP_REACH):
        step = np.searchsorted(steps, s + reach, side="right") - 1
        inside = (step >= 0) & (step < count)
        below, above, on = inside & dark & (away <= 0), inside & dark & (away >= 0), inside & ~dark & (np.abs(away) <= seen.width / 2)
        np.maximum.at(low, step[below], away[below])
        np.minimum.at(high, step[above], away[above])
        painted[step[on]] = True
    room, nearest = high - low, np.minimum(high, -low)
    bare = (room < MIN_FREE_SHARE * seen.width) | (nearest < CORE_SHARE * seen.width)
    return np.where(bare, BARE, np.where(painted | (room <= MAX_TRACK_GAP), FREE, UNKNOWN))


def _runs(steps, on):
    """(K, 2) stations that runs of steps begin and end at."""
    change = np.flatnonzero(np.diff(np.r_[False, on, False]))
    return np.column_stack([steps[change[::2]], steps[change[1::2]]]).tolist()


def with_paint_between_tracks(markings: MarkingObjects, lines: PaintedLines) -> MarkingObjects:
    """Markings, and behind them the paint of lines that lies between two tracks of the scan.

    Each stretch has the number and the class of the piece of the line that is nearest along it, and no points.

    Parameters
    ----------
    markings : MarkingObjects
    lines : PaintedLines of `with_unseen_paint`

    Returns
    -------
    MarkingObjects, the same object where there is nothing to add
    """
    like, spans, polygons = [], [], []
    known = _MarkedLines(lines, markings)
    for k, stretches in enumerate(lines.unseen or ()):
        if not len(stretches):
            continue
        own = known.of_piece(k)[1]
        for first, last, width in stretches.tolist() if len(own) else ():
            away = np.maximum(markings.extent[own, 0] - last, first - markings.extent[own, 1])
            like.append(own[np.argmin(away)])
            polygon, offsets = _strip(lines, k, first, last, width)
            polygons.append(polygon)
            spans.append((first, last, offsets.min() - width / 2, offsets.max() + width / 2, median(offsets), width))
    if not polygons:
        return markings
    first, last, _, _, offset, width = np.array(spans).T
    more = replace(markings[np.array(like)], outlines=Outlines.of(polygons), station=first, offset=offset, length=last - first, width=width,
                   elongation=(last - first) / width, points=np.zeros(len(like)), extent=np.array(spans)[:, :4])
    return _together(markings, more)


def _strip(lines, k, first, last, width):
    """The polygon of a stretch of a piece of a line, and the offsets of its middle."""
    course = lines.course
    rows = course.line(k)
    order = np.argsort(course.s[rows], kind="stable")
    s, *columns = (values[rows][order] for values in (course.s, course.x, course.y, course.z, course.d))
    at = np.r_[first, s[(s > first) & (s < last)], last]
    x, y, z, d = (np.interp(at, s, values) for values in columns)
    along = np.gradient(np.column_stack([x, y]), axis=0)
    along /= np.hypot(*along.T)[:, None]
    aside = np.column_stack([-along[:, 1], along[:, 0]]) * width / 2
    sides = [np.column_stack([x, y, z]) + np.column_stack([sign * aside, np.zeros(len(x))]) for sign in (1.0, -1.0)]
    return shapely.Polygon(np.concatenate([sides[0], sides[1][::-1]])), d


def _together(markings, more):
    """Two MarkingObjects as one."""
    polygons = np.concatenate([markings.outlines.polygons(), more.outlines.polygons()])
    columns = {name: np.concatenate([values, getattr(more, name)]) for name, values in vars(markings).items() if isinstance(values, np.ndarray)}
    return replace(markings, **columns, outlines=Outlines.of(polygons))
