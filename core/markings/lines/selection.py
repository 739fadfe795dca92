"""Which linked paint is a line, how far it reaches, and with what dashes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...common.arrays import linked_groups, members_of, overlapping_pairs
from ...common.parallel import check_cancelled
from ...countries.neutral import NEUTRAL
from ...curves.robust import median
from ..objects.classify import LANE_CLEARANCE
from ..objects.marking_objects import MarkingObjects
from .linking import DOUBLE_LINE_SPACING, MAX_STRAY_OFFSET, CommonTrend, StretchLookup, lines_beside
from .strands import LinkedLine, Strand

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

    A line needs paint: `min_paint` metres of it, or two dashes of a pattern, or one dash on the course and of the length of a dashed line elsewhere
    on the road. What runs close beside a much longer line is that line's frayed edge; what frames a hatched area belongs to that area.

    Parameters
    ----------
    lines : list of LinkedLine
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
    patterns = [[part.dashes for part in stretch if part.dashes] for stretch in parts]
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
        drawn = _line_pieces(parts[k])
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

    With less than a lane's room between the two, what is much shorter than the edge line is no line of its own; farther out, what is short.
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


# Solid or dashed, and with what dash length and period, from the painted intervals of a line.

MAX_WORN_HOLE = 0.8            # m: a shorter hole is wear within a dash
MIN_GAP_PER_DASH = 0.4         # of the dash length: road markings leave gaps of half a dash (6 m and 3 m) or more
DASH_PAIR_LENGTH = (1.5, 8.0)  # m: dashes of which two alone are taken for a dashed line
PERIOD_TOLERANCE = 0.16        # of the period: how evenly dashes must follow each other
STEP_TOLERANCE = 0.2           # m by which the two steps between three pieces of unequal lengths may differ
MIN_SHORT_DASHES = 4           # dashes of about a metre with gaps as long must be so many
SHORT_DASH_TOLERANCE = 0.25    # m: of such dashes, deviation of the length from the median
MAX_UNEVEN_SHARE = 0.25        # of such dashes: those that deviate more
MAX_SOLID_GAP = 2.5            # m: a longer hole in a solid line is bridged, not measured


@dataclass(frozen=True)
class DashPattern:
    """Dashes of one length at one period; metres."""

    dash: float
    period: float

    @property
    def gap(self) -> float:
        return self.period - self.dash


@dataclass(frozen=True)
class Stretch:
    """Part of a line of one pattern, from station `first` to `last`; `find_dash_pattern` is None where it is solid."""

    first: float
    last: float
    dashes: DashPattern | None
    intervals: tuple   # (first, last) of each painted interval

    @property
    def pattern(self) -> str:
        return "dashed" if self.dashes else "solid"


def _painted_intervals(line: LinkedLine) -> np.ndarray:
    """(K, 2) stations between which a line is painted, holes of wear closed."""
    spans = [span for strand in line.strands for span in _painted(strand)]
    found = [list(spans[0])]
    for first, last in spans[1:]:
        if first - found[-1][1] < MAX_WORN_HOLE:
            found[-1][1] = max(found[-1][1], last)
        else:
            found.append([first, last])
    return np.array(found)


def _painted(strand):
    """(first, last) of the parts of a strand: a strand leaps the gaps of short dashes. Where they are uneven they are wear."""
    holes = np.flatnonzero(np.diff(strand.s) > MAX_WORN_HOLE)
    if len(holes) + 1 < MIN_SHORT_DASHES:
        return [(strand.first, strand.last)]
    parts = np.column_stack([np.r_[strand.first, strand.s[holes + 1]], np.r_[strand.s[holes], strand.last]])
    length, steps = np.diff(parts, axis=1)[:, 0], np.diff(parts.mean(axis=1))
    if (np.abs(steps - np.median(steps)) > PERIOD_TOLERANCE * np.median(steps)).mean() > MAX_UNEVEN_SHARE \
            or (np.abs(length - np.median(length)) > SHORT_DASH_TOLERANCE).mean() > MAX_UNEVEN_SHARE:
        return [(strand.first, strand.last)]
    return list(map(tuple, parts.tolist()))


def stretches(line: LinkedLine, longest_dash: float = NEUTRAL.longest_dash) -> list[Stretch]:
    """The stretches of a line: dashed where short intervals follow a dash pattern, solid elsewhere.

    longest_dash : metres, longer paint is solid line; of the catalogue of countries
    """
    spans = _painted_intervals(line)
    long = np.diff(spans, axis=1)[:, 0] > longest_dash
    cuts = np.flatnonzero(np.r_[True, np.diff(long.astype(int)) != 0, True])
    found: list[tuple[np.ndarray, DashPattern | None]] = []
    for a, b in zip(cuts[:-1], cuts[1:]):
        group = spans[a:b]
        # beside solid stretches a few worn pieces look like dashes by chance
        dashes = None if long[a] or long.any() and len(group) < 3 else find_dash_pattern(group, beside_solid=bool(long.any()))
        if found and found[-1][1] is None and dashes is None:
            found[-1] = (np.vstack([found[-1][0], group]), None)
        else:
            found.append((group, dashes))
    return [Stretch(float(group[0, 0]), float(group[-1, 1]), dashes, tuple(map(tuple, group.tolist())))
            for group, dashes in found]


def find_dash_pattern(spans: np.ndarray, beside_solid: bool = False) -> DashPattern | None:
    """The DashPattern of painted intervals (K, 2), or None where they follow none.

    Dashes may be missing: steps between dashes are then whole multiples of the period. Some may be worn at their ends: three of five must have the
    common length. Of three pieces alone all must have it, or their two steps must be equal: by chance one step is soon a multiple of the other. In
    a line that is solid elsewhere (`beside_solid`) all must have it: there three pieces are what wear left of it, and equal steps chance.
    """
    if len(spans) < 2:
        return None
    length, steps = spans[:, 1] - spans[:, 0], np.diff(spans.mean(axis=1))
    # the full dashes tell the length; worn ones are only ever shorter
    dash = float(np.median(length[length >= 0.6 * np.percentile(length, 75)]))
    alike = np.abs(length - dash) <= max(0.5, 0.2 * dash)
    if len(spans) == 2:
        gap = float(spans[1, 0] - spans[0, 1])
        # two pieces may be alike by chance: they must be as long as dashes are, and equally long
        even = np.ptp(length) <= max(0.4, 0.12 * dash) and DASH_PAIR_LENGTH[0] <= dash <= DASH_PAIR_LENGTH[1] \
            and max(MIN_GAP_PER_DASH * dash, 1.5) <= gap <= 13.0
        return DashPattern(dash, float(steps[0])) if even else None
    period = _period(steps)
    if period is None or period - dash < MIN_GAP_PER_DASH * dash or alike.mean() < 0.55:
        return None
    if len(spans) == 3 and not alike.all():
        # a worn dash keeps one of its ends, or its middle
        steps = np.diff(np.column_stack([spans, spans.mean(axis=1)]), axis=0)
        if beside_solid or np.ptp(steps, axis=0).min() > STEP_TOLERANCE:
            return None
    return DashPattern(dash, period)


def _period(steps):
    """The longest period of which most steps are whole multiples (up to 4), or None."""
    best, best_share = None, 0.0
    for start in np.unique(np.round(steps, 1)):
        if start < 2 * MAX_WORN_HOLE:
            continue
        times = np.maximum(np.round(steps / start), 1.0)
        good = (np.abs(steps / start - times) <= PERIOD_TOLERANCE) & (times <= 4)
        share, single = good.mean(), (times[good] == 1).sum()
        # many steps over missing dashes are believed where nearly all fit
        if single < 0.4 * len(steps) and not (single >= 2 and len(steps) >= 5 and share >= 0.85):
            continue
        if share > best_share + 1e-9:
            best, best_share = float(np.sum(steps[good]) / np.sum(times[good])), share
    return best if best_share >= 0.65 else None


def same_dash_pattern(before: LinkedLine, after: LinkedLine, longest_dash: float = NEUTRAL.longest_dash) -> bool:
    """Whether two lines are dashed alike and the gap between them is a whole multiple of the period."""
    ends, begins = stretches(before, longest_dash)[-1], stretches(after, longest_dash)[0]
    if not ends.dashes or not begins.dashes:
        return False
    period = (ends.dashes.period + begins.dashes.period) / 2
    if abs(ends.dashes.period - begins.dashes.period) > PERIOD_TOLERANCE * period \
            or abs(ends.dashes.dash - begins.dashes.dash) > max(0.6, 0.25 * ends.dashes.dash):
        return False
    step = (np.mean(begins.intervals[0]) - np.mean(ends.intervals[-1])) / period
    return abs(step - round(step)) <= PERIOD_TOLERANCE * 1.5


@dataclass(frozen=True)
class LinePiece:
    """Part of a line of one status and pattern, between two stations."""

    first: float
    last: float
    status: str
    pattern: str


def _line_pieces(parts: list[Stretch]) -> list[LinePiece]:
    """Cut a line of some stretches where its status or pattern changes. A hole longer than the line's own gap, or in a solid line longer than
    2.5 m, is bridged."""
    found = []
    for k, part in enumerate(parts):
        gap = part.dashes.gap * 1.25 + 0.8 if part.dashes else MAX_SOLID_GAP
        if k:
            # between two patterns: the dashed one's gap, if there is one
            other = parts[k - 1]
            between = max(gap, other.dashes.gap * 1.25 + 0.8 if other.dashes else MAX_SOLID_GAP)
            measured = part.first - other.last <= between
            found.append(LinePiece(other.last, part.first, "measured" if measured else "bridged",
                               other.pattern if other.dashes else part.pattern))
        spans = part.intervals
        for j, (first, last) in enumerate(spans):
            if j and first - spans[j - 1][1] > gap:
                found.append(LinePiece(spans[j - 1][1], first, "bridged", part.pattern))
            elif j:
                found.append(LinePiece(spans[j - 1][1], first, "measured", part.pattern))
            found.append(LinePiece(first, last, "measured", part.pattern))
    return merged_pieces(found)


def merged_pieces(parts: list[LinePiece]) -> list[LinePiece]:
    """Pieces with equal neighbours put together; empty ones dropped."""
    found: list[LinePiece] = []
    for part in parts:
        if part.last - part.first <= 1e-9:
            continue
        if found and (found[-1].status, found[-1].pattern) == (part.status, part.pattern):
            found[-1] = LinePiece(found[-1].first, part.last, part.status, part.pattern)
        else:
            found.append(part)
    return found
