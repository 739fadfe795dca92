"""Road boundaries against a reference, in intervals of 2 m and by side.

The protocol of the scanline paper, which gives no tolerance: an interval is correct when
result lines cover at least half of it and four fifths of them lie within the tolerance of the
reference. A line elsewhere is a false one and the reference is missed; a hidden curb is missed
like any other.
"""

from dataclasses import dataclass, field

import numpy as np
import shapely

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..common.setting import check_limits, limits_of, setting
from .driving_lines import checked_tolerances
from .matching import AlongReference, AlongTrajectory, Places, Segments, Stations, pieces_of, places_along, runs_of, single_lines
from .metrics import NAN, Errors, Rates

SIDES = {1: "left", -1: "right", 0: ""}
BIN = 0.1               # m of station in which a line is there or not
SLIGHT = 0.25           # share of an interval without reference that a result must exceed to be a false line
EXCLUDING = 0.15        # share of an interval under an excluded reference that excludes it
BESIDE = 0.30           # m from an excluded reference within which a result is not judged
ERROR_REACH = 0.25      # m from the reference beyond which a place in a correct interval is another line


@dataclass(frozen=True)
class BoundarySettings:
    """How boundaries are judged."""

    tolerances: tuple = (0.05, 0.10, 0.20)   # m
    tolerance: float = setting(0.10, 0.001, 2.0, "The tolerance", "m")  # the one that intervals are drawn for
    interval: float = setting(2.0, 0.5, 100.0, "The interval", "m")  # along the trajectory or the reference
    coverage: float = 0.5                    # share of an interval that lines must cover
    agreement: float = 0.8                   # share of these that must lie within the tolerance
    corridor: float = setting(30.0, 1.0, 200.0, "The corridor", "m")  # either side of the trajectory

    def __post_init__(self):
        check_limits(self)
        object.__setattr__(self, "tolerances", checked_tolerances(self.tolerances, self.tolerance, limits_of(self, "tolerance").maximum))
        for name in ("coverage", "agreement"):
            if not 0 < getattr(self, name) <= 1:
                raise RoadExtractionError(f"The share {name} is {getattr(self, name)}; it must be above 0 and at most 1.")


@dataclass(frozen=True)
class SideAccuracy:
    """Rates in intervals, and the Errors in metres across and in height over the correct intervals."""

    rates: Rates
    lateral: Errors
    height: Errors


@dataclass(frozen=True)
class BoundaryIntervals:
    """One row an interval: unit, side (1, -1, 0) and first station (N,); reference and covered, metres (N,);
    excluded (N,) text, "" where it is judged; hit, false (N, tolerances) bool; lateral (mean, signed), largest and
    height (mean) metres (N,)."""

    unit: np.ndarray
    side: np.ndarray
    station: np.ndarray
    reference: np.ndarray
    covered: np.ndarray
    excluded: np.ndarray
    judged: np.ndarray
    hit: np.ndarray
    false: np.ndarray
    lateral: np.ndarray
    largest: np.ndarray
    height: np.ndarray


@dataclass(frozen=True)
class BoundaryAccuracy:
    """by_side: side ("left", "right", "" untold) to tolerance to SideAccuracy; total: tolerance to SideAccuracy.

    beyond : metres of result farther from the trajectory than the corridor, left out
    """

    by_side: dict
    total: dict
    intervals: BoundaryIntervals
    beyond: float
    settings: BoundarySettings
    along: object
    mine: "_Group" = field(repr=False)
    theirs: "_Group" = field(repr=False)
    others: "_Group" = field(repr=False)
    lateral: np.ndarray = field(repr=False)     # (N,) signed metres of the result's places


@dataclass(frozen=True)
class _Group:
    """Lines with their places, and for each place its station and its interval (-1: none)."""

    lines: list
    owner: np.ndarray
    places: Places
    stations: Stations
    interval: np.ndarray


def assess_boundaries(result, reference, settings=BoundarySettings(), frame=None, excluded=(), reasons=(), area=None, sides=None,
                      progress=Progress()):
    """Judge boundary lines.

    Parameters
    ----------
    result, reference : lists of shapely lines in one metric CRS, multi-part, 2D or 3D, drawn either way;
        one line a side, such as the curb bottoms
    frame : RoadFrame of the trajectory in that CRS; None measures along the reference lines
    excluded, reasons : reference lines where nothing is to be judged, such as dropped curbs, and why
    area : shapely polygon; what lies outside is not judged, or None
    sides : "left", "right" or None of each reference geometry, used where there is no frame

    Returns
    -------
    BoundaryAccuracy
    """
    mine, mine_owner = single_lines(result)
    theirs, theirs_owner = single_lines(reference)
    others, others_owner = single_lines(excluded)
    known = None if sides is None else [{"left": 1, "right": -1}.get(sides[k], 0) for k in theirs_owner]
    known = known if known and any(known) else None
    along = AlongTrajectory(frame, settings.corridor) if frame is not None else AlongReference(theirs, known)
    reference_segments, excluded_segments = Segments(theirs), Segments(others)
    my_places = places_along(mine).inside(area)
    # of excluded lines only what judged ones do not cover counts, so both are looked at together
    aside = excluded_segments.nearest(my_places.xy, progress=progress.part(0.0, 0.2)).distance
    feet = reference_segments.nearest(my_places.xy, progress=progress.part(0.2, 0.4))
    judged = ~((aside < BESIDE) & (aside < feet.distance))
    my_places = my_places.only(judged)
    feet = feet.only(judged)
    their_places, other_places = places_along(theirs).inside(area), places_along(others).inside(area)
    placed = [along.of_result(my_places, feet), along.of_reference(their_places),
              _of_excluded(along, other_places, reference_segments)]
    progress.report(0.6)
    keys, intervals = _intervals(placed, settings.interval)
    groups = [_Group(*group) for group in zip((mine, theirs, others), (mine_owner, theirs_owner, others_owner),
                                              (my_places, their_places, other_places), placed, intervals)]
    signed = np.where(np.isfinite(feet.distance), along.outward(my_places, feet, placed[0]) * feet.distance, NAN)
    table = _judge(keys, groups, feet, signed, settings, reasons)
    progress.report(0.9)
    beyond = float(my_places.length[groups[0].interval < 0].sum())
    by_side, total = _summary(table, groups[0], feet, signed, settings)
    return BoundaryAccuracy(by_side, total, table, beyond, settings, along, *groups, signed)


def _of_excluded(along, places, segments):
    """Excluded lines count where the judged reference beside them is measured."""
    if isinstance(along, AlongTrajectory):
        return along.of_reference(places)
    return along.of_result(places, segments.nearest(places.xy))


def _intervals(placed, step):
    """Unique (unit, side, number) of all places, and for each group the row of every place (-1: nowhere)."""
    sizes = np.cumsum([len(stations.unit) for stations in placed])
    unit, side = (np.concatenate([getattr(stations, name) for stations in placed]) for name in ("unit", "side"))
    station = np.concatenate([stations.station for stations in placed])
    known = (unit >= 0) & np.isfinite(station)
    number = np.where(known, np.floor(np.nan_to_num(station) / step), 0).astype(int)
    keys, inverse = np.unique(np.c_[unit, side, number][known], axis=0, return_inverse=True)
    rows = np.full(len(unit), -1)
    rows[known] = inverse.ravel()
    return keys, np.split(rows, sizes[:-1])


def _judge(keys, groups, feet, signed, settings, reasons):
    mine, theirs, others = groups
    count, step = len(keys), settings.interval
    inside = mine.interval >= 0
    rows = mine.interval[inside]
    number, distance = np.bincount(rows, minlength=count), feet.distance[inside]
    covered = np.bincount(_bins(mine)[0], minlength=count) * BIN
    reference = np.bincount(theirs.interval[theirs.interval >= 0], theirs.places.length[theirs.interval >= 0], count)
    has, partial = reference >= settings.coverage * step, (reference > 0) & (reference < settings.coverage * step)
    why = np.full(count, "", object)
    why[partial] = "the reference covers less than half of the interval"
    left_out, cause = _excluded(theirs, others, count, step)
    for k in np.flatnonzero(left_out):
        reason = reasons[cause[k]] if len(reasons) else ""
        why[k] = f"excluded in the reference{f' ({reason})' if reason else ''}"
    judged = why == ""
    hit, false = np.zeros((count, len(settings.tolerances)), bool), np.zeros((count, len(settings.tolerances)), bool)
    for k, tolerance in enumerate(settings.tolerances):
        within = np.bincount(rows, distance <= tolerance, count)
        good = (covered >= settings.coverage * step - 1e-9) & (within >= settings.agreement * np.maximum(number, 1))
        hit[:, k] = judged & has & good
        false[:, k] = judged & np.where(has, ~good & (number > 0), np.bincount(rows, mine.places.length[inside], count) > SLIGHT * step)
    size = np.abs(signed[inside])
    largest = np.full(count, -np.inf)
    np.maximum.at(largest, rows, np.where(np.isfinite(size), size, -np.inf))
    largest[~np.isfinite(largest)] = NAN
    rise = (mine.places.z - feet.z)[inside]
    return BoundaryIntervals(keys[:, 0], keys[:, 1], keys[:, 2] * step, reference, np.minimum(covered, step), why,
                             judged & has, hit, false, _mean(rows, signed[inside], count), largest, _mean(rows, rise, count))


def _mean(rows, values, count):
    known = np.isfinite(values)
    total = np.bincount(rows[known], values[known], count)
    with np.errstate(invalid="ignore", divide="ignore"):
        return total / np.bincount(rows[known], minlength=count)


def _bins(group):
    """(interval, a place in it) of every tenth of a metre of station in which the group has a place."""
    known = np.flatnonzero(group.interval >= 0)
    pairs = np.c_[group.interval[known], np.floor(group.stations.station[known] / BIN).astype(int)]
    found, first = np.unique(pairs, axis=0, return_index=True) if len(known) else (pairs, known)
    return found[:, 0], found[:, 1], known[first]


def _excluded(theirs, others, count, step):
    """Intervals of which excluded lines cover a share that no judged reference has, and which line does."""
    interval, tenth, place = _bins(others)
    covered = set(zip(*(column.tolist() for column in _bins(theirs)[:2])))
    alone = np.array([pair not in covered for pair in zip(interval.tolist(), tenth.tolist())], bool)
    cause = np.full(count, -1)
    if len(alone):
        cause[interval[alone]] = others.owner[others.places.line[place[alone]]]
    return np.bincount(interval[alone], minlength=count) * BIN > EXCLUDING * step + 1e-9 if len(alone) else np.zeros(count, bool), cause


def _summary(table, mine, feet, signed, settings):
    rise = mine.places.z - feet.z
    sides = [side for side in (1, -1, 0) if (table.side[table.excluded == ""] == side).any()]
    by_side = {SIDES[side]: {} for side in sides}
    total = {}
    for k, tolerance in enumerate(settings.tolerances):
        def accuracy(rows):
            rates = Rates(int(table.hit[rows, k].sum()), int(table.false[rows, k].sum()),
                          int((table.judged & ~table.hit[:, k])[rows].sum()))
            good = np.append(table.hit[:, k] & rows, False)[mine.interval] & (feet.distance <= max(tolerance, ERROR_REACH))
            return SideAccuracy(rates, Errors.of(signed[good], mine.places.length[good]),
                                Errors.of(rise[good], mine.places.length[good]))

        total[tolerance] = accuracy(np.ones(len(table.side), bool))
        for side in sides:
            by_side[SIDES[side]][tolerance] = accuracy(table.side == side)
    return by_side, total


def interval_lines(accuracy, tolerance):
    """The intervals as lines, by outcome at one of the tolerances.

    Yields
    ------
    outcome : "correct", "missed", "excluded" (drawn along the reference) or "false" (along the result)
    interval : row of `accuracy.intervals`
    geometry : LineString or MultiLineString
    """
    table, k = accuracy.intervals, accuracy.settings.tolerances.index(tolerance)
    outcome = np.where(table.excluded != "", "excluded", np.where(table.hit[:, k], "correct", np.where(table.judged, "missed", "")))
    drawn = _by_interval(accuracy.theirs)
    beside = _by_interval(accuracy.others)
    result = _by_interval(accuracy.mine)
    for row in range(len(table.unit)):
        shape = beside.get(row, []) + drawn.get(row, []) if outcome[row] == "excluded" else drawn.get(row, [])
        if outcome[row] and shape:
            yield str(outcome[row]), row, _joined(shape)
        if table.false[row, k] and row in result:
            yield "false", row, _joined(result[row])


def _by_interval(group):
    first, last = runs_of(group.places, group.interval)
    found = {}
    for row, piece in zip(group.interval[first], pieces_of(group.lines, group.places, first, last)):
        if row >= 0:
            found.setdefault(int(row), []).append(piece)
    return found


def _joined(pieces):
    return pieces[0] if len(pieces) == 1 else shapely.MultiLineString(pieces)
