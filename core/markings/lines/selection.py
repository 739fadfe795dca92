"""Which linked paint is a line, and how far it reaches."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ...common.groups import linked_groups, members_of
from ...common.near_pairs import overlapping_pairs
from ...common.parallel import check_cancelled
from ...countries.neutral import NEUTRAL
from ...curves.robust import median
from ..objects.classify import LANE_CLEARANCE
from .dash_pattern import LinePiece, line_pieces, merged_pieces, stretches
from .linking import DOUBLE_LINE_SPACING, MAX_STRAY_OFFSET, StretchLookup, lines_beside
from .strands import LinkedLine

if TYPE_CHECKING:
    from ..objects.marking_objects import MarkingObjects
    from .linking import CommonTrend
    from .strands import Strand

SAME_COURSE_OFFSET = 0.25     # m: a single dash this near the course of a dashed line is one of its dashes
MIN_SHARED_PAINT = 0.6      # of a line's paint that must have its twin beside it in a double line
MIN_TWIN_PAINT = 4.0        # m of paint: a shorter line beside another is its frayed edge, however short the other is there
MAX_FRAYED_SHARE = 0.35     # of a line's length: less paint beside a line than this is no second line but its frayed edge
MIN_SINGLE_DASH = 1.5       # m
MIN_BOUNDING_PAINT = 15.0   # m of paint: enough to bound a road by
MAX_NEIGHBOUR_OFFSET = 8.0  # m across: a line this near starts and ends where this one does
MAX_BAR_LENGTH = 4.0        # m along the road: what is called hatching and is longer is no single bar of it
MAX_BAR_END_OFFSET = 0.35   # m between the end of a bar and the outline
MAX_BAR_PITCH = 3.0         # m from bar to bar along an outline
MAX_BORDER_GAP = 2.0        # m along the road between pieces of one outline that bend off each other
MIN_BARS = 4                # that make an outline
MIN_BARS_OF_STRAND = 2      # that tell which strands of an outline are its own
AT_CROSSING = 0.5           # m across beyond a crossing where a line still leads to it
LEAST_TURN_ASIDE = 0.3      # m from the straight way between two strands: farther than links reach across, a strand is another line


@dataclass
class SelectedLine:
    """A line with its pieces by status and pattern, and the stations it is drawn between."""

    line: LinkedLine
    double: bool
    pieces: list

    def width(self, piece: LinePiece) -> float:
        """Metres of paint across, of its own strands, or of those of the whole line where it has none."""
        strands = self.line.strands_between(piece.first, piece.last)
        own = [max(min(strand.last, piece.last) - max(strand.first, piece.first), 0.0) for strand in strands]
        return float(np.average([strand.width for strand in strands], weights=own)) if sum(own) > 0 else self.line.mean_width

    @property
    def span(self) -> tuple[float, float]:
        return self.pieces[0].first, self.pieces[-1].last


def crossings(markings: MarkingObjects, road: int) -> np.ndarray:
    """(K, 4) first and last station, least and greatest offset of zebra crossings and stop lines of a road."""
    return _extents(markings, road, ("zebra", "stop"))


def hatching_bars(markings: MarkingObjects, road: int) -> np.ndarray:
    """(K, 4) the same of the bars of hatched areas."""
    found = _extents(markings, road, ("hatch",))
    return found[found[:, 1] - found[:, 0] < MAX_BAR_LENGTH]


def _extents(markings, road, kinds):
    shown = (markings.road == road) & np.isin(markings.kind.astype(str), kinds)
    found = markings.extent[shown]
    return found[np.isfinite(found[:, 0])]


def select_lines(lines: list[LinkedLine], trend: CommonTrend, crossed: np.ndarray, min_paint: float, hatched: np.ndarray = np.empty((0, 4)),
                 longest_dash: float = NEUTRAL.longest_dash) -> list[SelectedLine]:
    """The lines worth drawing.

    A line needs paint: `min_paint` metres of it, or two dashes of a pattern, or one dash
    on the course and of the length of a dashed line elsewhere on the road. What runs
    close beside a much longer line is that line's frayed edge; what frames a hatched
    area belongs to that area.

    Parameters
    ----------
    lines : list of LinkedLine
    trend : CommonTrend
    crossed : (K, 4) as `crossings` gives it
    min_paint : metres
    hatched : (K, 4) as `hatching_bars` gives it
    longest_dash : metres, longer paint is solid line

    Returns
    -------
    list of SelectedLine, by station
    """
    if not lines:
        return []
    bars, beside, strands = _Bars(hatched), lines_beside(lines), _StrandsBeside(lines)
    crossings_there = StretchLookup(crossed[:, 0], crossed[:, 1])
    parts = [_without_pairs_at_crossings(stretches(line, longest_dash), line, crossed, crossings_there) for line in lines]
    level = np.array([_level(line, trend) for line in lines])
    patterns = [_dash_patterns(stretch) for stretch in parts]
    painted_to = max(line.last for line in lines)
    painted_from = min(line.first for line in lines)
    frayed, double = _beside(lines, beside, trend, longest_dash)
    outside = _beyond_the_edge(lines, beside, level)
    dashes = _DashesElsewhere(lines, patterns, level)
    found = []
    for k, line in enumerate(lines):
        check_cancelled()
        single = None
        if not patterns[k] and line.painted < longest_dash:
            single = dashes.alike(k)
        if frayed[k] or outside[k] or _frames_hatching(line, bars) or not (line.painted >= min_paint or patterns[k] or single):
            continue
        drawn = line_pieces(parts[k])
        if single is not None:
            drawn = [LinePiece(line.first, line.last, "measured", "dashed")]
        drawn = _extended(drawn, parts[k], single, (painted_from, painted_to), partial(_crossed_there, crossed, crossings_there, line.middle),
                          partial(strands.near, level, k), line)
        found.append(SelectedLine(line, bool(double[k]), drawn))
    return found


def _without_pairs_at_crossings(parts, line, crossed, crossings_there):
    """Stretches, of which two pieces alone are no dashes where a crossing lies between them: that is why there is a gap."""
    found = []
    for part in parts:
        if part.dashes and len(part.intervals) == 2:
            (_, before), (after, _) = part.intervals
            there = _crossed_there(crossed, crossings_there, median(line.near(part.first, part.last)[1]), before, after)
            between = (there[:, 0] < after) & (there[:, 1] > before)
            part = replace(part, dashes=None) if between.any() else part
        found.append(part)
    return found


def _crossed_there(crossed, crossings_there, d, first, last):
    """(M, 4) crossings that reach over an offset or near it, between two stations."""
    near = crossed[crossings_there.between(first, last)]
    return near[(near[:, 2] <= d + AT_CROSSING) & (near[:, 3] >= d - AT_CROSSING)]


class _StrandsBeside:
    """Lookup of the strands of lines by station."""

    def __init__(self, lines):
        self.spans = np.array([(strand.first, strand.last) for line in lines for strand in line.strands]).reshape(-1, 2)
        self.owner = np.repeat(np.arange(len(lines)), [len(line.strands) for line in lines])
        self.lookup = StretchLookup(*self.spans.T)

    def near(self, level, k, first, last):
        """(M, 2) stations between which the lines beside line k are painted, of what is painted between two stations."""
        near = self.lookup.between(first, last)
        of = self.owner[near]
        return self.spans[near[(of != k) & (np.abs(level[of] - level[k]) <= MAX_NEIGHBOUR_OFFSET)]]


def _level(line, trend):
    s, d, *_ = line.places()
    return median(d - trend.at(s))


def _dash_patterns(parts):
    return [part.dashes for part in parts if part.dashes]


class _DashesElsewhere:
    """The dash patterns of the lines of a road, by how far across these lie."""

    def __init__(self, lines, patterns, level):
        self.lines, self.level = lines, level
        found = [(j, pattern) for j, of_line in enumerate(patterns) if len(lines[j].strands) >= 3 for pattern in of_line]
        order = np.argsort([level[j] for j, _ in found], kind="stable").astype(int)
        self.of, self.patterns = np.array([found[n][0] for n in order], int), [found[n][1] for n in order]
        self.dash = np.array([pattern.dash for pattern in self.patterns])
        self.first, self.last = (np.array([getattr(lines[j], end) for j in self.of]) for end in ("first", "last"))

    def alike(self, k):
        """The DashPattern of a dashed line elsewhere on the road, on whose course and of whose dash length line k is; of several the first one's."""
        line = self.lines[k]
        if line.painted < MIN_SINGLE_DASH or len(line.strands) > 2:
            return None
        levels = self.level[self.of]
        near = slice(*np.searchsorted(levels, self.level[k] + SAME_COURSE_OFFSET * np.array([-1.001, 1.001])))
        apart = (self.last[near] < line.first) | (self.first[near] > line.last)
        same = np.abs(levels[near] - self.level[k]) <= SAME_COURSE_OFFSET
        differs = np.abs(line.last - line.first - self.dash[near])
        found = near.start + np.flatnonzero(apart & same & (differs <= np.maximum(0.6, 0.25 * self.dash[near])))
        return self.patterns[found[np.argmin(self.of[found])]] if len(found) else None


def _beside(lines, beside, trend, longest_dash):
    """(N,) frayed: a sliver beside a longer line; (N,) double: one of two equal lines side by side."""
    frayed, double = np.zeros(len(lines), bool), np.zeros(len(lines), bool)
    tracks = []
    for line in lines:
        s, d, *_ = line.places()
        cell = np.floor(s / 0.5).astype(np.int64)
        cells, first = np.unique(cell, return_index=True)
        tracks.append((cells, (d - trend.at(s))[first]))
    for k in range(len(lines)):
        check_cancelled()
        for j in beside.between(lines[k].first, lines[k].last).tolist():
            if j == k:
                continue
            a, b = _shared(tracks[k][0], tracks[j][0])
            if len(a) < 3:
                continue
            away = median(np.abs(tracks[k][1][a] - tracks[j][1][b]))
            share = len(a) / len(tracks[k][0])
            if away <= DOUBLE_LINE_SPACING[1] and share > MIN_SHARED_PAINT:
                # between two junctions both lines of a double are short, and one of them may go on farther beyond
                least = max(MIN_TWIN_PAINT, MIN_SHARED_PAINT * _painted_there(lines[j], lines[k]))
                twin = away >= DOUBLE_LINE_SPACING[0] and lines[k].painted >= least
                if not twin and lines[k].painted < MAX_FRAYED_SHARE * lines[j].painted and lines[k].painted < longest_dash:
                    frayed[k] = True
                elif away >= DOUBLE_LINE_SPACING[0]:
                    double[k] = True
                    double[j] |= len(a) / len(tracks[j][0]) > MAX_FRAYED_SHARE
    return frayed, double


def _shared(one, other):
    """Where in each of two arrays, ascending, the values are that both have."""
    begin, end = max(one[0], other[0]), min(one[-1], other[-1])
    windows = [slice(np.searchsorted(cells, begin), np.searchsorted(cells, end, side="right")) for cells in (one, other)]
    _, a, b = np.intersect1d(one[windows[0]], other[windows[1]], assume_unique=True, return_indices=True)
    return a + windows[0].start, b + windows[1].start


def _painted_there(line, other):
    """Metres of paint of those strands of a line that run beside another."""
    return sum(strand.length for strand in line.strands_between(other.first, other.last) if strand.last > other.first and strand.first < other.last)


def _beyond_the_edge(lines, beside, level):
    """(N,) whether a fragment lies farther out than a long line that bounds the road there: gutter, verge or yard.

    With less than a lane's room between the two, what is much shorter than the edge
    line is no line of its own; farther out, what is short.
    """
    result = np.zeros(len(lines), bool)
    bounds = {j for j, line in enumerate(lines)
              if line.painted >= MIN_BOUNDING_PAINT and _votes(line).get("edge", 0.0) > 0.3 * line.painted}
    for k, line in enumerate(lines):
        for j in beside.between(line.first, line.last).tolist():
            if j not in bounds:
                continue
            # the vehicle drove between the edge lines
            farther = np.sign(lines[j].middle) * (level[k] - level[j])
            shared = min(lines[j].last, line.last) - max(lines[j].first, line.first)
            least = MAX_FRAYED_SHARE * lines[j].painted if farther < LANE_CLEARANCE else 0.0
            if j != k and farther > DOUBLE_LINE_SPACING[0] and shared > 0.5 * (line.last - line.first) \
                    and line.painted < max(least, MIN_BOUNDING_PAINT):
                result[k] = True
    return result


def hatching_borders(lines: list[LinkedLine], hatched: np.ndarray, known: list[Strand]) -> list[Strand]:
    """Strands that frame hatched areas: of those lines that do so as a whole, and those that leave the straight way from strand to strand.

    In a hatched area, up to the tip behind its last bar, there are no other lines that do so than its borders.
    `known` are those found before. What leads from the straight way to one of them is its end, however short.
    """
    bars = _Bars(hatched)
    framing, within = [_frames_hatching(line, bars) for line in lines], _areas(hatched)
    borders = known + [strand for line, frames in zip(lines, framing) if frames for strand in line.strands]
    found = [strand for line, frames in zip(lines, framing) if len(line.strands) > 1
             for k, strand in enumerate(line.strands)
             if frames and _frames_hatching(LinkedLine([strand]), bars, MIN_BARS_OF_STRAND)
             or _aside(line.strands[k - 1:k + 2]) > LEAST_TURN_ASIDE
             and (_frames_hatching(LinkedLine([strand]), bars, MIN_BARS_OF_STRAND) or _lies_within(strand, within))]
    if found:
        return found
    aside = [strand for line in lines for k, strand in enumerate(line.strands) if _aside(line.strands[k - 1:k + 2]) > MAX_STRAY_OFFSET]
    there = StretchLookup(np.array([border.first for border in borders]), np.array([border.last for border in borders]))
    return [strand for strand in aside if any(_meet(strand, borders[k]) for k in there.between(
        strand.first - MAX_BORDER_GAP, strand.last + MAX_BORDER_GAP) if borders[k] is not strand)]


def _aside(strands):
    """Metres by which the second of three strands lies beside the straight way from the end of the first to the beginning of the third."""
    if len(strands) < 3:
        return 0.0
    before, strand, after = strands
    straight = np.interp(strand.s, [before.last, after.first], [before.d[-1], after.d[0]])
    return float(np.median(np.abs(strand.d - straight)))


def _meet(one, other):
    """Whether one strand begins where the other ends."""
    for a, b in ((one, other), (other, one)):
        if abs(b.first - a.last) <= MAX_BORDER_GAP and abs(b.d[0] - a.d[-1]) <= MAX_BAR_END_OFFSET:
            return True
    return False


def _areas(hatched):
    """(A, 4) m, extents of rows of bars; along the road one pitch more, where the borders meet and no bar fits any more."""
    if not len(hatched):
        return np.empty((0, 4))
    first, last, low, high = hatched.T
    a, b = (np.concatenate(found) for found in zip(*overlapping_pairs(first, last, first, last, MAX_BAR_PITCH)))
    beside = (low[a] <= high[b]) & (low[b] <= high[a])
    rows = [hatched[own] for _, own in members_of(linked_groups(a[beside], b[beside], len(hatched))) if len(own) >= MIN_BARS]
    return np.array([[*row[:, [0, 2]].min(0), *row[:, [1, 3]].max(0)] for row in rows]).reshape(-1, 4) + [-MAX_BAR_PITCH, 0, MAX_BAR_PITCH, 0]


def _lies_within(strand, areas):
    """Whether a strand lies in one of the areas, (A, 4) as `_areas` gives them, or on its border."""
    first, low, last, high = areas.T
    return bool(((first <= strand.first) & (strand.last <= last) & (low - MAX_BAR_END_OFFSET <= strand.d.min())
                 & (strand.d.max() <= high + MAX_BAR_END_OFFSET)).any())


class _Bars:
    """Bars of hatched areas, (K, 4) as `hatching_bars` gives them, by the station of their middle."""

    def __init__(self, hatched):
        middle = hatched[:, :2].mean(axis=1)
        order = np.argsort(middle, kind="stable")
        self.middle, (self.low, self.high) = middle[order], hatched[order, 2:].T


def _frames_hatching(line, bars, fewest=MIN_BARS):
    """Whether bars end at a line along most of it; an edge line beside a hatched area goes on after it."""
    inside = slice(*np.searchsorted(bars.middle, [line.first, line.last]))
    middle = bars.middle[inside]
    if len(middle) < fewest:
        return False
    s, d, *_ = line.places()
    at = np.interp(middle, s, d)
    ends = np.minimum(np.abs(bars.low[inside] - at), np.abs(bars.high[inside] - at)) < MAX_BAR_END_OFFSET
    near = middle[ends & (middle > line.first) & (middle < line.last)]
    if len(near) < fewest:
        return False
    steps = np.diff(np.sort(near))
    return steps[steps < MAX_BAR_PITCH].sum() + MAX_BAR_PITCH > MIN_SHARED_PAINT * (line.last - line.first)


def _votes(line):
    """Metres of paint by the class of its markings."""
    votes = {}
    for strand in line.strands:
        for name, length in strand.classes.items():
            votes[name] = votes.get(name, 0.0) + length
    return votes


def _extended(drawn, parts, single, painted, crossed, painted_beside, line):
    """A dashed line ends with a gap: its ends go on by one gap.

    But not past the paint of the road, into a crossing, or past where the lines
    beside it begin or end. `crossed` and `painted_beside` tell crossings and paint between two stations.
    """
    drawn = list(drawn)
    before, after = single or parts[0].dashes, single or parts[-1].dashes
    if before:
        limit = line.first - before.gap
        beside, neighbours = crossed(limit - 1.0, line.first + 1.0), painted_beside(limit - 1.0, line.first + 1.0)
        begun = neighbours[(neighbours[:, 0] > limit) & (neighbours[:, 0] <= line.first), 0]
        running = ((neighbours[:, 0] <= limit) & (neighbours[:, 1] > limit + 1.0)).any()
        start = max(limit, painted[0], *beside[beside[:, 1] < line.first + 0.5, 1],
                    *(begun[:0] if running else begun[np.argsort(begun)[:1]]))
        drawn.insert(0, LinePiece(min(start, line.first), line.first, "measured", "dashed"))
    if after:
        limit = line.last + after.gap
        beside, neighbours = crossed(line.last - 1.0, limit + 1.0), painted_beside(line.last - 1.0, limit + 1.0)
        ended = neighbours[(neighbours[:, 1] < limit) & (neighbours[:, 1] >= line.last), 1]
        running = ((neighbours[:, 1] >= limit) & (neighbours[:, 0] < limit - 1.0)).any()
        end = min(limit, painted[1], *beside[beside[:, 0] > line.last - 0.5, 0],
                  *(ended[:0] if running else ended[np.argsort(-ended)[:1]]))
        drawn.append(LinePiece(line.last, max(end, line.last), "measured", "dashed"))
    return merged_pieces(drawn)
