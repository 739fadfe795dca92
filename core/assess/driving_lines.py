"""Lines against reference lines: how much was found, how much is right, how far off.

Measures after Heipke et al. (1997) and Wiedemann (2003), evaluated in places 0.1 m apart;
a tolerance is the half-width of the buffer.
"""

from dataclasses import dataclass, field

import numpy as np

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..common.setting import check_limits, setting
from .matching import Places, Segments, pieces_of, places_along, runs_of, single_lines
from .metrics import NAN, Errors

ASSOCIATED = 0.75   # m: farther apart, two lines are not the same line
LEAST_GAP = 0.5     # m of reference without a result that count as a gap


@dataclass(frozen=True)
class LineSettings:
    """How two sets of lines are compared."""

    tolerances: tuple = (0.05, 0.10, 0.15, 0.20)  # m, half-widths of the buffer
    tolerance: float = setting(0.10, 0.001, ASSOCIATED, "The tolerance", "m")  # the one that pieces are drawn for
    # between the directions of two lines that may match; 90 = any
    max_angle: float = setting(15.0, 1.0, 90.0, "The largest angle between matching lines", "°")

    def __post_init__(self):
        check_limits(self)
        object.__setattr__(self, "tolerances", checked_tolerances(self.tolerances, self.tolerance, ASSOCIATED))


def checked_tolerances(tolerances, one, largest):
    """All tolerances and the one shown, in order; refuses what is not a length from a millimetre to `largest` metres."""
    found = tuple(sorted({*tolerances, one}))
    if not all(0.001 <= t <= largest for t in found):
        said = ", ".join(f"{t:g}" for t in found)
        raise RoadExtractionError(
            f"The tolerances are {said}; give lengths in metres from 0.001 to {largest:g}, such as 0.05, 0.10, 0.20.")
    return found


@dataclass(frozen=True)
class LineAccuracy:
    """Shares are 0 to 1, keyed by tolerance (half-width of the buffer, metres); NaN where nothing was to compare.

    completeness : share of the reference's length within the tolerance of the result
    correctness : share of the result's length within the tolerance of the reference
    miscoding : 1 - correctness, as the driving-line thesis reports it (its buffer is put about the
        reference here: about the result, as printed, it would not be a share of wrong lines)
    quality : matched result / (result + unmatched reference)
    gaps_per_km, mean_gap : stretches of at least 0.5 m of reference without a result, and their mean length in metres
    lateral, height : Errors in metres over result places within 0.75 m of the reference; lateral is positive
        left of the reference as drawn
    """

    completeness: dict
    correctness: dict
    quality: dict
    gaps_per_km: dict
    mean_gap: dict
    lateral: Errors
    height: Errors
    reference_length: float
    result_length: float

    @property
    def miscoding(self):
        return {tolerance: 1.0 - share for tolerance, share in self.correctness.items()}

    @property
    def rmse(self):
        return self.lateral.rmse

    @property
    def height_rmse(self):
        return self.height.rmse


@dataclass(frozen=True)
class LineMatch:
    """Two sets of lines with the distance of every place from the other set.

    mine, theirs : Places along the result and the reference; to_reference, to_result : (N,) metres, inf where
    nothing matches; lateral (signed, left of the reference as drawn) and height : (N,) metres of the result's
    places, NaN beyond 0.75 m; nearest_reference : (N,) the reference line each result place is nearest to, or -1.
    """

    result: list
    reference: list
    result_owner: np.ndarray
    reference_owner: np.ndarray
    mine: Places
    theirs: Places
    to_reference: np.ndarray = field(repr=False)
    to_result: np.ndarray = field(repr=False)
    lateral: np.ndarray = field(repr=False)
    height: np.ndarray = field(repr=False)
    nearest_reference: np.ndarray = field(repr=False)

    def accuracy(self, tolerances, mine=None, theirs=None):
        """LineAccuracy of all places, or of those in the masks."""
        mine = np.ones(len(self.mine), bool) if mine is None else mine
        theirs = np.ones(len(self.theirs), bool) if theirs is None else theirs
        length, reference_length = self.mine.length[mine].sum(), self.theirs.length[theirs].sum()
        complete, correct, quality, gaps, mean_gap = {}, {}, {}, {}, {}
        for tolerance in tolerances:
            right = self.mine.length[mine & (self.to_reference <= tolerance)].sum()
            found = self.theirs.length[theirs & (self.to_result <= tolerance)].sum()
            complete[tolerance], correct[tolerance] = _share(found, reference_length), _share(right, length)
            quality[tolerance] = _share(right, length + reference_length - found)
            long = self._gaps(tolerance, theirs)
            gaps[tolerance] = _share(1000.0 * len(long), reference_length)
            mean_gap[tolerance] = float(np.mean(long)) if len(long) else 0.0
        return LineAccuracy(complete, correct, quality, gaps, mean_gap, Errors.of(self.lateral[mine], self.mine.length[mine]),
                            Errors.of(self.height[mine], self.mine.length[mine]), float(reference_length), float(length))

    def per_reference_line(self, tolerances):
        """LineAccuracy of each reference line with the result that lies nearest to it, within 0.75 m."""
        return [self.accuracy(tolerances, self.nearest_reference == k, self.theirs.line == k) for k in range(len(self.reference))]

    def _gaps(self, tolerance, theirs):
        """Lengths of the gaps in the reference's places of the mask."""
        missing = np.where(theirs, (self.to_result > tolerance).astype(int), -1)
        first, last = runs_of(self.theirs, missing)
        cumulated = np.r_[0.0, np.cumsum(self.theirs.length)]
        length = cumulated[last + 1] - cumulated[first]
        return length[(missing[first] == 1) & (length >= LEAST_GAP)] if len(first) else np.empty(0)

    def pieces(self, tolerance):
        """The lines cut by outcome.

        Yields
        ------
        outcome : "correct" or "false" for the result, "missed" for the reference
        owner : index of the geometry given
        geometry : the stretch
        first, last : indices of its places, of the result's or the reference's
        """
        wrong = (self.to_reference > tolerance).astype(int)
        first, last = runs_of(self.mine, wrong)
        for k, geometry in enumerate(pieces_of(self.result, self.mine, first, last)):
            yield "false" if wrong[first[k]] else "correct", self.result_owner[self.mine.line[first[k]]], geometry, first[k], last[k]
        missed = (self.to_result > tolerance).astype(int)
        first, last = runs_of(self.theirs, missed)
        first, last = first[missed[first] == 1], last[missed[first] == 1]
        for k, geometry in enumerate(pieces_of(self.reference, self.theirs, first, last)):
            yield "missed", self.reference_owner[self.theirs.line[first[k]]], geometry, first[k], last[k]


def match_lines(result, reference, area=None, max_angle=90.0, progress=Progress()):
    """Set two groups of lines against each other in plan.

    Parameters
    ----------
    result, reference : lists of shapely lines (multi-part ones and polygons' outlines too), with Z or
        without, in one metric CRS; the direction they are drawn in does not matter
    area : shapely polygon; what lies outside is left out of both, or None
    max_angle : degrees; lines that cross at more do not match

    Returns
    -------
    LineMatch
    """
    result, result_owner = single_lines([g for g in result if g is not None])
    reference, reference_owner = single_lines([g for g in reference if g is not None])
    mine, theirs = places_along(result).inside(area), places_along(reference).inside(area)
    feet = _feet(mine, reference, max_angle, progress.part(0.0, 0.5))
    back = _feet(theirs, result, max_angle, progress.part(0.5, 1.0))
    near = feet.distance <= ASSOCIATED
    return LineMatch(result, reference, result_owner, reference_owner, mine, theirs, feet.distance, back.distance,
                     np.where(near, feet.side * feet.distance, NAN), np.where(near, mine.z - feet.z, NAN),
                     np.where(near, feet.line, -1))


def compare_lines(result, reference, tolerances=LineSettings.tolerances, area=None, max_angle=90.0):
    """LineAccuracy of two sets of lines: `match_lines` and its `accuracy`, for those who need no layer."""
    return match_lines(result, reference, area, max_angle).accuracy(tolerances)


def _feet(places, lines, max_angle, progress):
    # the nearest line counts where any direction will do, however far: then the distance is known
    if max_angle >= 90.0:
        return Segments(lines).nearest(places.xy, progress=progress)
    return Segments(lines).nearest(places.xy, places.heading, np.radians(max_angle), ASSOCIATED, progress)


def _share(part, whole):
    return float(part / whole) if whole else NAN
