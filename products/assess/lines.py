"""Road boundaries and driving lines against a reference."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely

from ...core.common.errors import RoadExtractionError
from ...core.common.progress import Progress
from ...core.common.setting import check_limits, setting
from ...core.curves.line_segments import SegmentIndex, single_lines
from .matching import Errors, LinePoints, Rates, ReferenceStationing, Stations, TrajectoryStationing, constant_runs, cut_runs, sample_lines, share_of

# Lines against reference lines: completeness, correctness and deviations.
#
# Measures after Heipke et al. (1997) and Wiedemann (2003), evaluated at points 0.1 m apart; a tolerance is the half-width of the buffer.

MAX_MATCH_DISTANCE = 0.75  # m; farther apart, two lines are different lines
MIN_REFERENCE_GAP = 0.5    # m of reference without a result that count as a gap


@dataclass(frozen=True)
class LineAccuracySettings:
    """How two sets of lines are compared."""

    tolerances: tuple[float, ...] = (0.05, 0.10, 0.15, 0.20)  # m, half-widths of the buffer
    tolerance: float = setting(0.10, 0.001, MAX_MATCH_DISTANCE, "The tolerance", "m")  # the one that pieces are drawn for
    # between the directions of two lines that may match; 90 = any
    max_angle: float = setting(15.0, 1.0, 90.0, "The largest angle between matching lines", "°")

    def __post_init__(self) -> None:
        check_limits(self)
        object.__setattr__(self, "tolerances", _checked_tolerances(self.tolerances, self.tolerance, MAX_MATCH_DISTANCE))


def _checked_tolerances(tolerances: Sequence[float], one: float, largest: float) -> tuple[float, ...]:
    """All tolerances with the one that is drawn, sorted, metres; RoadExtractionError where one is below a millimetre or above `largest`."""
    checked = tuple(sorted({*tolerances, one}))
    if not all(0.001 <= t <= largest for t in checked):
        text = ", ".join(f"{t:g}" for t in checked)
        raise RoadExtractionError(f"The tolerances are {text}; give lengths in metres from 0.001 to {largest:g}, such as 0.05, 0.10, 0.20.")
    return checked


@dataclass(frozen=True)
class LineAccuracy:
    """The accuracy of lines. Shares are 0 to 1, by tolerance (half-width of the buffer, metres); NaN if there was nothing to compare.

    miscoding : 1 - correctness, as the driving-line thesis reports it (here the buffer is about the
        reference; about the result, as printed there, it would not be a share of wrong lines)
    gaps_per_km, mean_gap : stretches of at least 0.5 m of reference without a result, and their mean length in metres
    lateral, height : Errors in metres over result points within 0.75 m of the reference; lateral is positive left of the reference as drawn
    """

    completeness: dict[float, float]   # share of the reference's length within the tolerance of the result
    correctness: dict[float, float]   # share of the result's length within the tolerance of the reference
    quality: dict[float, float]   # matched result / (result + unmatched reference)
    gaps_per_km: dict[float, float]
    mean_gap: dict[float, float]
    lateral: Errors
    height: Errors
    reference_length: float   # reference_length, result_length: metres
    result_length: float

    @property
    def miscoding(self) -> dict[float, float]:
        return {tolerance: 1.0 - share for tolerance, share in self.correctness.items()}


@dataclass(frozen=True)
class LineMatch:
    """Two sets of lines with the distance of every point from the other set.

    lateral, height : (N,) deviations of the result's points, metres, NaN beyond 0.75 m; lateral is signed, positive left of the reference as drawn
    """

    result: Sequence[Any]   # result, reference: lists of LineString
    reference: Sequence[Any]
    result_owner: np.ndarray   # result_owner, reference_owner: index of the input geometry of each line
    reference_owner: np.ndarray
    result_points: LinePoints   # result_points, reference_points: points along the lines
    reference_points: LinePoints
    to_reference: np.ndarray = field(repr=False)   # to_reference, to_result: (N,) and (M,) metres, inf where nothing matches
    to_result: np.ndarray = field(repr=False)
    lateral: np.ndarray = field(repr=False)
    height: np.ndarray = field(repr=False)
    nearest_reference: np.ndarray = field(repr=False)   # (N,) index of the nearest reference line of each result point, or -1

    def accuracy(self, tolerances: Sequence[float], of_result: np.ndarray | None = None,
                 of_reference: np.ndarray | None = None) -> LineAccuracy:
        """LineAccuracy of all points, or of those in the masks of_result (N,) and of_reference (M,)."""
        of_result = np.ones(len(self.result_points), bool) if of_result is None else of_result
        of_reference = np.ones(len(self.reference_points), bool) if of_reference is None else of_reference
        lengths = self.result_points.length[of_result]
        length, reference_length = lengths.sum(), self.reference_points.length[of_reference].sum()
        complete, correct, quality, gaps, mean_gap = {}, {}, {}, {}, {}
        for tolerance in tolerances:
            right = self.result_points.length[of_result & (self.to_reference <= tolerance)].sum()
            matched = self.reference_points.length[of_reference & (self.to_result <= tolerance)].sum()
            complete[tolerance], correct[tolerance] = share_of(matched, reference_length), share_of(right, length)
            quality[tolerance] = share_of(right, length + reference_length - matched)
            long = self._gaps(tolerance, of_reference)
            gaps[tolerance] = share_of(1000.0 * len(long), reference_length)
            mean_gap[tolerance] = float(np.mean(long)) if len(long) else 0.0
        return LineAccuracy(complete, correct, quality, gaps, mean_gap, Errors.of(self.lateral[of_result], lengths),
                            Errors.of(self.height[of_result], lengths), float(reference_length), float(length))

    def per_reference_line(self, tolerances: Sequence[float]) -> list[LineAccuracy]:
        """LineAccuracy of each reference line with the result that lies nearest to it, within 0.75 m."""
        return [self.accuracy(tolerances, self.nearest_reference == k, self.reference_points.line == k) for k in range(len(self.reference))]

    def _gaps(self, tolerance, of_reference):
        """Lengths of the gaps in the reference's points of the mask."""
        missing = np.where(of_reference, (self.to_result > tolerance).astype(int), -1)
        first, last = constant_runs(self.reference_points, missing)
        cumulated = np.r_[0.0, np.cumsum(self.reference_points.length)]
        length = cumulated[last + 1] - cumulated[first]
        return length[(missing[first] == 1) & (length >= MIN_REFERENCE_GAP)] if len(first) else np.empty(0)

    def pieces(self, tolerance: float) -> Iterator[tuple[str, int, Any, int, int]]:
        """(outcome, index of the input geometry, piece, indices of its first and last point) of the lines cut by outcome.

        The outcome is correct or false for pieces of the result, missed for those of the reference.
        """
        wrong = (self.to_reference > tolerance).astype(int)
        first, last = constant_runs(self.result_points, wrong)
        for k, geometry in enumerate(cut_runs(self.result, self.result_points, first, last)):
            yield "false" if wrong[first[k]] else "correct", self.result_owner[self.result_points.line[first[k]]], geometry, first[k], last[k]
        missed = (self.to_result > tolerance).astype(int)
        first, last = constant_runs(self.reference_points, missed)
        first, last = first[missed[first] == 1], last[missed[first] == 1]
        for k, geometry in enumerate(cut_runs(self.reference, self.reference_points, first, last)):
            yield "missed", self.reference_owner[self.reference_points.line[first[k]]], geometry, first[k], last[k]


def match_lines(result: Sequence[Any], reference: Sequence[Any], area: Any = None, max_angle: float = 90.0,
                progress: Progress = Progress()) -> LineMatch:
    """Match two sets of lines in plan.

    result, reference : lists of shapely lines (also multi-part, and outlines of polygons), with Z or
        without, in one metric CRS; the direction in which they are drawn is ignored
    area : shapely polygon; what lies outside is left out of both, or None
    max_angle : degrees; lines that cross at a larger angle do not match
    """
    result, result_owner = single_lines([g for g in result if g is not None])
    reference, reference_owner = single_lines([g for g in reference if g is not None])
    result_points, reference_points = sample_lines(result).inside(area), sample_lines(reference).inside(area)
    nearest = _nearest_points(result_points, reference, max_angle, progress.part(0.0, 0.5))
    back = _nearest_points(reference_points, result, max_angle, progress.part(0.5, 1.0))
    near = nearest.distance <= MAX_MATCH_DISTANCE
    return LineMatch(result, reference, result_owner, reference_owner, result_points, reference_points, nearest.distance, back.distance,
                     np.where(near, nearest.side * nearest.distance, np.nan), np.where(near, result_points.z - nearest.z, np.nan),
                     np.where(near, nearest.line, -1))


def compare_lines(result: Sequence[Any], reference: Sequence[Any], tolerances: Sequence[float] = LineAccuracySettings.tolerances, area: Any = None,
                  max_angle: float = 90.0) -> LineAccuracy:
    """The LineAccuracy of two sets of lines, matched by `match_lines`."""
    return match_lines(result, reference, area, max_angle).accuracy(tolerances)


def _nearest_points(points, lines, max_angle, progress):
    # without a limit of the angle the nearest line counts at any distance, so the distance is always known
    if max_angle >= 90.0:
        return SegmentIndex(lines).nearest(points.xy, progress=progress)
    return SegmentIndex(lines).nearest(points.xy, points.heading, np.radians(max_angle), MAX_MATCH_DISTANCE, progress)


# Road boundaries in intervals of 2 m and by side: the protocol of the scanline paper, completed by the tolerance that it does not state. An
# interval is correct if result lines cover at least half of it and four fifths of them lie within the tolerance of the reference. Otherwise the
# line is false and the reference is missed; an occluded curb that was not found is missed like any other.

SIDE_NAMES = {1: "left", -1: "right", 0: ""}
COVERAGE_BIN = 0.1         # m of station in which a line is present or not
MIN_FALSE_SHARE = 0.25     # share of an interval without reference that a result must exceed to be a false line
MIN_EXCLUDED_SHARE = 0.15  # share of an interval along an excluded reference that excludes the interval
EXCLUDED_DISTANCE = 0.30   # m from an excluded reference within which a result is not judged
MAX_TOLERANCE = 2.0        # m
MAX_ERROR_DISTANCE = 0.25  # m; a result farther from the reference in a correct interval is another line


@dataclass(frozen=True)
class BoundaryAccuracySettings:
    tolerances: tuple[float, ...] = (0.05, 0.10, 0.20)   # m
    tolerance: float = setting(0.10, 0.001, MAX_TOLERANCE, "The tolerance", "m")  # the one that intervals are drawn for
    interval: float = setting(2.0, 0.5, 100.0, "The interval", "m")  # along the trajectory or the reference
    coverage: float = 0.5                    # share of an interval that lines must cover
    agreement: float = 0.8                   # share of these that must lie within the tolerance
    corridor: float = setting(30.0, 1.0, 200.0, "The corridor", "m")  # either side of the trajectory

    def __post_init__(self) -> None:
        check_limits(self)
        object.__setattr__(self, "tolerances", _checked_tolerances(self.tolerances, self.tolerance, MAX_TOLERANCE))
        for name in ("coverage", "agreement"):
            if not 0 < getattr(self, name) <= 1:
                raise RoadExtractionError(f"The share {name} is {getattr(self, name)}; it must be above 0 and at most 1.")


@dataclass(frozen=True)
class _SideAccuracy:
    """Rates in intervals, and the lateral and height Errors, metres, over the correct intervals."""

    rates: Rates
    lateral: Errors
    height: Errors


@dataclass(frozen=True)
class _BoundaryIntervals:
    """A table with one row per interval."""

    unit: np.ndarray   # (N,) index of the road or reference line
    side: np.ndarray   # (N,) 1 left, -1 right, 0 unknown
    station: np.ndarray   # (N,) start of the interval, metres
    reference: np.ndarray   # reference, covered: (N,) metres of reference and of result in it
    covered: np.ndarray
    excluded: np.ndarray   # (N,) text, why it is not judged; "" if it is
    judged: np.ndarray   # (N,) bool, whether it is judged and has a reference
    hit: np.ndarray   # hit, false: (N, T) bool, by tolerance
    false: np.ndarray
    lateral: np.ndarray   # (N,) signed mean of the deviations across, metres
    largest: np.ndarray   # (N,) largest absolute deviation across, metres
    height: np.ndarray   # (N,) mean deviation in height, metres


@dataclass(frozen=True)
class BoundaryAccuracy:
    by_side: dict[str, dict[float, _SideAccuracy]]   # side ("left", "right", "" unknown) to tolerance to _SideAccuracy
    total: dict[float, _SideAccuracy]   # tolerance to _SideAccuracy
    intervals: _BoundaryIntervals   # the table of all intervals
    beyond: float   # metres of result farther from the trajectory than the corridor, not judged
    settings: BoundaryAccuracySettings
    along: TrajectoryStationing | ReferenceStationing   # TrajectoryStationing or ReferenceStationing
    result_group: _LineGroup = field(repr=False)   # result_group, reference_group, excluded_group: lines with their points and intervals
    reference_group: _LineGroup = field(repr=False)
    excluded_group: _LineGroup = field(repr=False)
    lateral: np.ndarray = field(repr=False)   # (N,) signed deviations of the result's points, metres


@dataclass(frozen=True)
class _LineGroup:
    """Lines with their points, and for each point its station and its interval (-1: none)."""

    lines: list[Any]
    owner: np.ndarray
    points: LinePoints
    stations: Stations
    interval: np.ndarray


def assess_boundaries(result: Sequence[Any], reference: Sequence[Any], settings: BoundaryAccuracySettings = BoundaryAccuracySettings(),
                      frame: Any = None, excluded: Sequence[Any] = (), reasons: Sequence[str] = (), area: Any = None,
                      sides: Sequence[str | None] | None = None, progress: Progress = Progress()) -> BoundaryAccuracy:
    """Assess boundary lines against reference lines.

    result, reference : lists of shapely lines in one metric CRS, single or multi-part, 2D or 3D, drawn in either
        direction; one line per side, such as the curb bottoms
    frame : RoadFrame of the trajectory in that CRS; None measures along the reference lines
    excluded, reasons : reference lines along which nothing is judged, such as dropped curbs, and why
    area : shapely polygon; what lies outside is not judged, or None
    sides : "left", "right" or None of each reference geometry, used without a frame
    """
    result_lines, result_owner = single_lines(result)
    reference_lines, reference_owner = single_lines(reference)
    excluded_lines, excluded_owner = single_lines(excluded)
    signs = None if sides is None else [{"left": 1, "right": -1}.get(sides[k] or "", 0) for k in reference_owner]
    signs = signs if signs and any(signs) else None
    along = TrajectoryStationing(frame, settings.corridor) if frame is not None else ReferenceStationing(reference_lines, signs)
    reference_index, excluded_index = SegmentIndex(reference_lines), SegmentIndex(excluded_lines)
    result_points = sample_lines(result_lines).inside(area)
    # an excluded line counts only where no judged line is nearer, so both are searched
    excluded_distance = excluded_index.nearest(result_points.xy, progress=progress.part(0.0, 0.2)).distance
    nearest = reference_index.nearest(result_points.xy, progress=progress.part(0.2, 0.4))
    judged = ~((excluded_distance < EXCLUDED_DISTANCE) & (excluded_distance < nearest.distance))
    result_points = result_points[judged]
    nearest = nearest[judged]
    reference_points, excluded_points = sample_lines(reference_lines).inside(area), sample_lines(excluded_lines).inside(area)
    # excluded lines are stationed along the judged reference beside them
    stations = [along.of_result(result_points, nearest), along.of_reference(reference_points),
                along.of_result(excluded_points, reference_index.nearest(excluded_points.xy))]
    progress.report(0.6)
    keys, intervals = _intervals(stations, settings.interval)
    groups = [_LineGroup(*group) for group in zip((result_lines, reference_lines, excluded_lines), (result_owner, reference_owner, excluded_owner),
                                                  (result_points, reference_points, excluded_points), stations, intervals)]
    signed = np.where(np.isfinite(nearest.distance), along.outward(result_points, nearest, stations[0]) * nearest.distance, np.nan)
    table = _judge(keys, groups, nearest, signed, settings, reasons)
    progress.report(0.9)
    beyond = float(result_points.length[groups[0].interval < 0].sum())
    by_side, total = _summary(table, groups[0], nearest, signed, settings)
    return BoundaryAccuracy(by_side, total, table, beyond, settings, along, groups[0], groups[1], groups[2], signed)


def _intervals(placed, step):
    """Unique (unit, side, number) of all points, and for each group the row of every point (-1: none)."""
    sizes = np.cumsum([len(stations.unit) for stations in placed])
    unit, side = (np.concatenate([getattr(stations, name) for stations in placed]) for name in ("unit", "side"))
    station = np.concatenate([stations.station for stations in placed])
    valid = (unit >= 0) & np.isfinite(station)
    number = np.where(valid, np.floor(np.nan_to_num(station) / step), 0).astype(int)
    keys, inverse = np.unique(np.c_[unit, side, number][valid], axis=0, return_inverse=True)
    rows = np.full(len(unit), -1)
    rows[valid] = inverse.ravel()
    return keys, np.split(rows, sizes[:-1])


def _judge(keys, groups, nearest, signed, settings, reasons):
    result_group, reference_group, excluded_group = groups
    count, step = len(keys), settings.interval
    inside = result_group.interval >= 0
    rows = result_group.interval[inside]
    number, distance = np.bincount(rows, minlength=count), nearest.distance[inside]
    covered = np.bincount(_bins(result_group)[0], minlength=count) * COVERAGE_BIN
    valid = reference_group.interval >= 0
    reference = np.bincount(reference_group.interval[valid], reference_group.points.length[valid], count)
    enough, partial = reference >= settings.coverage * step, (reference > 0) & (reference < settings.coverage * step)
    why = np.full(count, "", object)
    why[partial] = "the reference covers less than half of the interval"
    left_out, cause = _excluded(reference_group, excluded_group, count, step)
    for k in np.flatnonzero(left_out):
        reason = reasons[cause[k]] if len(reasons) else ""
        why[k] = f"excluded in the reference{f' ({reason})' if reason else ''}"
    judged = why == ""
    hit, false = np.zeros((count, len(settings.tolerances)), bool), np.zeros((count, len(settings.tolerances)), bool)
    for k, tolerance in enumerate(settings.tolerances):
        within = np.bincount(rows, distance <= tolerance, count)
        good = (covered >= settings.coverage * step - 1e-9) & (within >= settings.agreement * np.maximum(number, 1))
        hit[:, k] = judged & enough & good
        long = np.bincount(rows, result_group.points.length[inside], count) > MIN_FALSE_SHARE * step
        false[:, k] = judged & np.where(enough, ~good & (number > 0), long)
    size = np.abs(signed[inside])
    largest = np.full(count, -np.inf)
    np.maximum.at(largest, rows, np.where(np.isfinite(size), size, -np.inf))
    largest[~np.isfinite(largest)] = np.nan
    rise = (result_group.points.z - nearest.z)[inside]
    return _BoundaryIntervals(keys[:, 0], keys[:, 1], keys[:, 2] * step, reference, np.minimum(covered, step), why,
                             judged & enough, hit, false, _mean(rows, signed[inside], count), largest, _mean(rows, rise, count))


def _mean(rows, values, count):
    finite = np.isfinite(values)
    total = np.bincount(rows[finite], values[finite], count)
    with np.errstate(invalid="ignore", divide="ignore"):
        return total / np.bincount(rows[finite], minlength=count)


def _bins(group):
    """(interval, a point in it) of every tenth of a metre of station in which the group has a point."""
    rows = np.flatnonzero(group.interval >= 0)
    pairs = np.c_[group.interval[rows], np.floor(group.stations.station[rows] / COVERAGE_BIN).astype(int)]
    cells, first = np.unique(pairs, axis=0, return_index=True) if len(rows) else (pairs, rows)
    return cells[:, 0], cells[:, 1], rows[first]


def _excluded(reference_group, excluded_group, count, step):
    """Intervals of which excluded lines cover a share that no judged reference has, and which line does."""
    interval, tenth, point = _bins(excluded_group)
    covered = set(zip(*(column.tolist() for column in _bins(reference_group)[:2])))
    alone = np.array([pair not in covered for pair in zip(interval.tolist(), tenth.tolist())], bool)
    cause = np.full(count, -1)
    if not len(alone):
        return np.zeros(count, bool), cause
    cause[interval[alone]] = excluded_group.owner[excluded_group.points.line[point[alone]]]
    return np.bincount(interval[alone], minlength=count) * COVERAGE_BIN > MIN_EXCLUDED_SHARE * step + 1e-9, cause


def _summary(table, result_group, nearest, signed, settings):
    rise = result_group.points.z - nearest.z
    sides = [side for side in (1, -1, 0) if (table.side[table.excluded == ""] == side).any()]
    by_side = {SIDE_NAMES[side]: {} for side in sides}
    total = {}
    for k, tolerance in enumerate(settings.tolerances):
        def accuracy(rows):
            rates = Rates(int(table.hit[rows, k].sum()), int(table.false[rows, k].sum()),
                          int((table.judged & ~table.hit[:, k])[rows].sum()))
            good = np.append(table.hit[:, k] & rows, False)[result_group.interval] & (nearest.distance <= max(tolerance, MAX_ERROR_DISTANCE))
            return _SideAccuracy(rates, Errors.of(signed[good], result_group.points.length[good]),
                                Errors.of(rise[good], result_group.points.length[good]))

        total[tolerance] = accuracy(np.ones(len(table.side), bool))
        for side in sides:
            by_side[SIDE_NAMES[side]][tolerance] = accuracy(table.side == side)
    return by_side, total


def interval_lines(accuracy: BoundaryAccuracy, tolerance: float) -> Iterator[tuple[str, int, Any]]:
    """(outcome, row of `accuracy.intervals`, LineString or MultiLineString) of the intervals at one of the tolerances of its settings, m.

    The outcome is correct, missed, excluded (drawn along the reference) or false (along the result).
    """
    table, k = accuracy.intervals, accuracy.settings.tolerances.index(tolerance)
    outcome = np.where(table.excluded != "", "excluded", np.where(table.hit[:, k], "correct", np.where(table.judged, "missed", "")))
    drawn, excluded, result = map(_by_interval, (accuracy.reference_group, accuracy.excluded_group, accuracy.result_group))
    for row in range(len(table.unit)):
        shape = excluded.get(row, []) + drawn.get(row, []) if outcome[row] == "excluded" else drawn.get(row, [])
        if outcome[row] and shape:
            yield str(outcome[row]), row, _joined(shape)
        if table.false[row, k] and row in result:
            yield "false", row, _joined(result[row])


def _by_interval(group):
    first, last = constant_runs(group.points, group.interval)
    pieces = {}
    for row, piece in zip(group.interval[first], cut_runs(group.lines, group.points, first, last)):
        if row >= 0:
            pieces.setdefault(int(row), []).append(piece)
    return pieces


def _joined(pieces):
    return pieces[0] if len(pieces) == 1 else shapely.MultiLineString(pieces)
