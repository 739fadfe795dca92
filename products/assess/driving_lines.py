"""Lines against reference lines: completeness, correctness and deviations.

Measures after Heipke et al. (1997) and Wiedemann (2003), evaluated at points 0.1 m apart; a tolerance is the half-width of the buffer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...core.common.errors import RoadExtractionError
from ...core.common.progress import Progress
from ...core.common.setting import check_limits, setting
from ...core.curves.line_segments import SegmentIndex, single_lines
from .matching import LinePoints, constant_runs, cut_runs, sample_lines
from .metrics import NAN, Errors

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
        object.__setattr__(self, "tolerances", checked_tolerances(self.tolerances, self.tolerance, MAX_MATCH_DISTANCE))


def checked_tolerances(tolerances: Sequence[float], one: float, largest: float) -> tuple[float, ...]:
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

    @property
    def rmse(self) -> float:
        return self.lateral.rmse

    @property
    def height_rmse(self) -> float:
        return self.height.rmse


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
            complete[tolerance], correct[tolerance] = _share(matched, reference_length), _share(right, length)
            quality[tolerance] = _share(right, length + reference_length - matched)
            long = self._gaps(tolerance, of_reference)
            gaps[tolerance] = _share(1000.0 * len(long), reference_length)
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
                     np.where(near, nearest.side * nearest.distance, NAN), np.where(near, result_points.z - nearest.z, NAN),
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


def _share(part, whole):
    return float(part / whole) if whole else NAN
