"""Strip adjustment: passes over one road are adjusted to each other, where navigation drifted between them.

The correction of each pass is a smooth function of station. It is the least-squares solution for the measured offsets between passes, with small
changes along the road and small corrections as prior. Two passes meet in their middle, because nothing shows which of them is more accurate.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import shapely
from scipy import sparse
from scipy.sparse.linalg import spsolve

from ...common.parallel import ordered_map
from ...common.progress import Progress
from ..frame.road_frame import Pass, RoadFrame
from ..frame.row_table import SigmaAlong
from ..store.columns import Columns
from ..store.records import COORDINATE_SCALE, to_units
from ..weights import ADJUST, FRAME, REGISTER
from .register import AXES, PLAN_AXES, WINDOW_LENGTH, PassCorrections, PassOffsets, Strips, height_offset, pass_offsets, sigma_of_passes

MOVED_COLUMNS = "x", "y", "z", "s", "d"


def adjust_passes(survey: Any, progress: Progress = Progress()) -> None:
    """Adjust the passes over every road to each other where they measurably disagree.

    Points and tracks are moved in plan and height; the reference lines of the roads stay. Where a drive goes on alone, it is moved on as
    where it left the others, so that it has no step there.

    survey : Survey with times; its store and frame are replaced where passes are moved
    """
    roads = [road for road in survey.store.roads() if len(survey.frame.passes_of(road)) > 1]
    moves: dict[int, tuple[np.ndarray, np.ndarray]] = {}
    compared: list[PassOffsets] = []
    for k, road in enumerate(roads):
        offsets = pass_offsets(survey, road, progress.part(0.5 * k / len(roads), 0.5 * (k + 1) / len(roads)))
        disagree = _disagree(offsets)
        if (sigma := sigma_of_passes(offsets)) is not None:
            survey.frame.pass_sigma[road] = sigma
        solved = solve_corrections(offsets) if disagree else {}
        moves.update(solved)
        compared += offsets
        _report_offsets(road, offsets, solved, progress)
    if moves:
        corrections = continued_corrections(survey.frame, _map_corrections(survey.frame, moves), compared)
        for road in survey.store.roads():
            if warning := warning_of_one_drive(road, places_of_one_drive(survey.frame.passes_of(road), compared, corrections)):
                progress.warn(warning)
        frame = survey.frame
        replace_points(survey, corrections, progress.part(0.5, 1.0))
        survey.moves = corrections
        survey.frame = replace(frame, passes=[_moved_track(frame, corrections, p) for p in frame.passes])


def solve_corrections(offsets: list[PassOffsets]) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """Corrections of passes from the offsets between them on one road, by least squares with robust weights.

    Returns {pass number: ((N,) stations, (3, N) metres along, left and up)}.
    """
    numbers = sorted({number for pair in offsets for number in (pair.one, pair.other)})
    first, last = (end(np.concatenate([pair.stations for pair in offsets])) for end in (np.min, np.max))
    stations = np.arange(first, last + REGISTER.correction_step / 2, REGISTER.correction_step)
    count = len(stations)
    step = sparse.diags([-1.0, 1.0], [0, 1], (count - 1, count))
    prior = sparse.kron(sparse.identity(len(numbers)), step.T @ step / ADJUST.drift_change_sigma**2 + sparse.identity(count) / ADJUST.drift_sigma**2)
    corrections = np.zeros((len(numbers), len(AXES), count))
    for k, axis in enumerate(AXES):
        places, measured = [], []
        for pair in offsets:
            windows = np.flatnonzero(np.isfinite(getattr(pair, axis)))
            nodes = np.rint((pair.stations[windows] - first) / REGISTER.correction_step).astype(np.int64)
            places.append(np.c_[numbers.index(pair.one) * count + nodes, numbers.index(pair.other) * count + nodes])
            measured.append(getattr(pair, axis)[windows])
        columns, values = np.concatenate(places), np.concatenate(measured)
        of = np.repeat(np.arange(len(values)), 2)
        between = sparse.csr_matrix((np.tile([-1.0, 1.0], len(values)), (of, columns.ravel())), (len(values), len(numbers) * count))
        weight = np.ones(len(values))
        for _ in range(ADJUST.reweighting_rounds):
            precision = sparse.diags(weight / ADJUST.offset_sigma**2)
            u = spsolve((between.T @ precision @ between + prior).tocsc(), between.T @ (precision @ values))
            weight = 1.0 / (1.0 + ((between @ u - values) / ADJUST.outlier_scale) ** 2)
        corrections[:, k] = u.reshape(len(numbers), count)
    return {number: (stations, corrections[k]) for k, number in enumerate(numbers)}


def _separations(offsets):
    """(N,) known distances between passes in plan and (M,) in height, m."""
    plan = np.concatenate([np.hypot(np.nan_to_num(pair.along), np.nan_to_num(pair.left))[np.isfinite(pair.left) | np.isfinite(pair.along)]
                           for pair in offsets] or [np.empty(0)])
    up = np.concatenate([np.abs(pair.up[np.isfinite(pair.up)]) for pair in offsets] or [np.empty(0)])
    return plan, up


def _disagree(offsets):
    limits = ADJUST.agreement_plan, ADJUST.agreement_height
    return any(len(values) and np.percentile(values, 90) > least for values, least in zip(_separations(offsets), limits))


def _report_offsets(road, offsets, corrections, progress):
    """Log the offsets, and warn of places where passes still differ after the corrections found."""
    if corrections:
        separations = _separations(offsets)
        plan, up = (f"{100 * np.median(v):.1f} cm (at most {100 * v.max():.1f})" if len(v) else "an unknown distance" for v in separations)
        message = f"Road {road}: its passes lay {plan} beside and {up} above each other"
        if any(np.percentile(v, 90) > REGISTER.most_drift or v.max() > REGISTER.max_offset for v in separations if len(v)):
            progress.warn(f"{message}, more than navigation drifts. Each was moved by its share, and nothing shows which is right. Process the files "
                          "of each drive by itself, or measure control points.")
        else:
            progress.info(f"{message}, as navigation drifts between two drives. They were laid on each other, each moved by its share.")
    elif all(len(v) for v in _separations(offsets)):
        plan, up = (100 * np.percentile(v, 90) for v in _separations(offsets))
        progress.info(f"Road {road}: nine tenths of its passes lie within {plan:.1f} cm beside and {up:.1f} cm above each other; "
                     "they stay as they were measured.")
    for warning in filter(None, (warning_of_places(road, remaining_places(offsets, corrections)), _warning_of_rebuilt(road, offsets))):
        progress.warn(warning)


def _map_corrections(frame, corrections):
    """PassCorrections of the result of `solve_corrections`."""
    moves = {}
    for number, (stations, (along, left, up)) in corrections.items():
        heading = frame.road(frame.passes[number].road).heading(stations)
        c, n = np.cos(heading), np.sin(heading)
        moves[number] = float(stations[0]), to_units([along * c - left * n, along * n + left * c, up]).astype(np.int16)
    return PassCorrections(moves)


def _changes(road, s, d, metres):
    """Changes of x, y, z, s and d, (N,) metres each, of places on a road that are moved by (N,) metres east, north and up."""
    east, north, up = metres
    heading = road.heading(s)
    c, n = np.cos(heading), np.sin(heading)
    return east, north, up, (east * c + north * n) / np.clip(1.0 - road.curvature(s) * d, *FRAME.bend_stretch), north * c - east * n


def _moved_track(frame, moves, p):
    """A pass with a corrected track."""
    if p.number not in moves.by_pass:
        return p
    change = _changes(frame.road(p.road), p.s, p.d, moves.metres(p.number, p.s))
    return replace(p, **{name: getattr(p, name) + metres for name, metres in zip(MOVED_COLUMNS, change)})


@dataclass(frozen=True)
class _Moves:
    """Moves points of a survey: `of_points` of `moves` gives MovedPoints of records, and `reach` how far in plan, m, at most."""

    frame: RoadFrame
    moves: Any

    @property
    def reach(self) -> float:
        """m of station, at most."""
        return self.moves.reach / FRAME.bend_stretch[0] + COORDINATE_SCALE

    def moved(self, records: Columns) -> Columns:
        """The records of points where they are moved to."""
        moved = {name: np.array(records[name]) for name in MOVED_COLUMNS}
        for number, rows, metres in self.moves.of_points(records):
            s, d = (records[name].take(rows) * COORDINATE_SCALE for name in "sd")
            for name, change in zip(MOVED_COLUMNS, _changes(self.frame.road(self.frame.passes[number].road), s, d, metres)):
                moved[name][rows] += to_units(change)
        return records.with_columns(**moved)


def replace_points(survey: Any, moves: Any, progress: Progress = Progress()) -> None:
    """Move the points of a Survey within its store; `moves` : as of `_Moves`."""
    survey.put_in_order(survey.store.folder, survey.executor, progress, _Moves(survey.frame, moves))


# A drive that was laid on others goes on where it measures alone: it is moved on as where it left them, not back to where it was measured.


def continued_corrections(frame: RoadFrame, moves: PassCorrections, compared: list[PassOffsets]) -> PassCorrections:
    """Corrections of passes with those of the passes that follow or precede them in the same drive and could be compared with no other.

    Navigation drifts slowly, by centimetres over kilometres, so what a drive is off by at the end of a road is what it is off by at the start of
    the next. Between two that were moved the correction changes evenly. Two passes meet in their middle, so what one was moved by across the road
    is also the sigma of where they meet; `frame.pass_sigma` of roads without one says so. Passes that were compared and found to lie as the others
    do are not moved, and those beside them less and less.
    """
    known = {number for pair in compared for number in (pair.one, pair.other)} | moves.by_pass.keys()
    passes, by_pass = sorted(frame.passes, key=lambda p: float(p.time[0])), dict(moves.by_pass)
    seams = [k for k, (p, after) in enumerate(zip(passes, passes[1:]), 1) if after.time[0] - p.time[-1] > ADJUST.max_seam]
    for first, end in zip([0, *seams], [*seams, len(passes)]):
        for p, nodes in _of_drive(passes[first:end], moves, known):
            by_pass[p.number] = nodes
            frame.pass_sigma.setdefault(p.road, SigmaAlong.everywhere(_moved_across(frame, PassCorrections(by_pass), p)))
    return PassCorrections(by_pass)


def _of_drive(drive, moves, known):
    """Yield the passes of a drive that could be compared with no other, and how they are moved; none where nothing of the drive was moved."""
    fixed = [p for p in drive if p.number in known]
    if moves.by_pass.keys() & {p.number for p in fixed}:
        times = np.concatenate([p.time[[0, -1]] for p in fixed])
        metres = np.concatenate([moves.metres(p.number, p.s[[0, -1]]) if p.number in moves.by_pass else np.zeros((3, 2)) for p in fixed], axis=1)
        for p in drive:
            if p.number not in known:
                yield p, _led_on(p, np.array([np.interp(p.time[[0, -1]], times, axis) for axis in metres]))


def _moved_across(frame, moves, p):
    """RMS metres by which a pass is moved across its road."""
    s = np.linspace(*p.span, max(int(np.ptp(p.span) / REGISTER.correction_step), 2))
    east, north, _ = moves.metres(p.number, s)
    heading = frame.road(p.road).heading(s)
    return float(np.sqrt(np.mean((north * np.cos(heading) - east * np.sin(heading)) ** 2)))


def _led_on(p, metres):
    """(station of the first node, (3, N) int16 in 0.1 mm) of a pass that is moved by (3, 2) m at its beginning and its end."""
    first, last = p.span
    nodes = first + REGISTER.correction_step * np.arange(int(np.ceil((last - first) / REGISTER.correction_step)) + 1)
    share = np.interp(nodes, [first, last], [0.0, 1.0] if p.s[-1] > p.s[0] else [1.0, 0.0])
    return first, to_units(metres[:, :1] + share * (metres[:, 1:] - metres[:, :1])).astype(np.int16)


# Where passes still differ after they were laid on each other, and where one was moved that no other confirms, place by place.


def remaining_places(offsets: list[PassOffsets], corrections: dict[int, tuple[np.ndarray, np.ndarray]]) -> list[tuple[float, float, float]]:
    """Stretches of a road along which two of its passes still differ, by their PassOffsets and the result of `solve_corrections`.

    Returns list of (start, end, metres that they differ by at most), by station; infinite where they lie farther apart than can be measured.
    """
    places: list[tuple[float, float]] = []
    for pair in offsets:
        rest = np.zeros(len(pair.stations))
        for axis in PLAN_AXES:
            # what is unknown does not remain: it is bridged by what is known around it
            applied = _applied(pair, corrections, axis)
            left = np.abs(np.nan_to_num(getattr(pair, axis) - applied))
            rest = np.hypot(rest, np.maximum(left, _evened_out(pair.stations, applied)))
        remains = rest > ADJUST.max_remaining
        places += [*zip(pair.stations[remains].tolist(), rest[remains].tolist()), *((station, np.inf) for station in pair.far.tolist())]
    return _stretches_of(places)


def places_of_one_drive(passes: list[Pass], offsets: list[PassOffsets], corrections: PassCorrections) -> list[tuple[float, float, float]]:
    """Stretches along which a pass over a road was moved in plan and was compared with no other, there or as near as drift changes little.

    Returns list of (start, end, metres that the pass was moved by at most), by station.
    """
    places: list[tuple[float, float]] = []
    for p in passes:
        if p.number not in corrections.by_pass:
            continue
        compared = np.concatenate([pair.stations[np.isfinite(pair.left) | np.isfinite(pair.along)] for pair in offsets
                                   if p.number in (pair.one, pair.other)] or [np.empty(0)])
        first, last = np.floor(np.array(p.span) / WINDOW_LENGTH).astype(int)
        stations = (np.arange(first, last + 1) + 0.5) * WINDOW_LENGTH
        distance = np.abs(stations[:, None] - compared).min(axis=1, initial=np.inf)
        moved = np.hypot(*corrections.metres(p.number, stations)[:2])
        uncompared = (distance > REGISTER.pooling_sigma) & (moved > ADJUST.max_remaining)
        places += zip(stations[uncompared].tolist(), moved[uncompared].tolist())
    return _stretches_of(places)


def _evened_out(stations, applied):
    """(N,) m of a jump that remain in the windows it lies between, as corrections change evenly from one to the next; 0 where there is none."""
    remaining = np.zeros(len(stations))
    change = np.abs(np.diff(applied))
    for k in np.flatnonzero((change > ADJUST.max_change) & (np.diff(stations) < 1.5 * WINDOW_LENGTH)).tolist():
        remaining[k:k + 2] = np.maximum(remaining[k:k + 2], change[k] / 2)
    return remaining


def _stretches_of(places: Iterable[tuple[float, float]]) -> list[tuple[float, float, float]]:
    """[(start, end, largest metres)] of (middle of a window, metres), windows that touch in one; infinite ones apart from the others."""
    stretches: list[tuple[float, float, float]] = []
    for station, metres in dict(sorted(places)).items():   # of each window the largest, which comes last
        start, end = station - WINDOW_LENGTH / 2, station + WINDOW_LENGTH / 2
        if stretches and start <= stretches[-1][1] and np.isinf(metres) == np.isinf(stretches[-1][2]):
            stretches[-1] = stretches[-1][0], end, max(metres, stretches[-1][2])
        else:
            stretches.append((start, end, metres))
    return stretches


def _applied(pair, corrections, axis):
    """(N,) metres along an axis by which the second pass of a pair was moved against the first."""
    if pair.one not in corrections:
        return np.zeros(len(pair.stations))
    first, second = (np.interp(pair.stations, corrections[number][0], corrections[number][1][AXES.index(axis)]) for number in (pair.one, pair.other))
    return second - first


def warning_of_places(road: int, places: list[tuple[float, float, float]]) -> str:
    return (f"Road {road}: its passes do not lie on each other at {_named_places(places, 'up to {:.1f} cm remain')}: lines may be doubled there. "
            "Adjust the trajectories to each other, or process each drive by itself.") if places else ""


def warning_of_one_drive(road: int, places: list[tuple[float, float, float]]) -> str:
    return (f"Road {road}: one drive alone shows what lies at {_named_places(places)}. It was moved as beside the others: "
            "measure a control point there if these centimetres matter.") if places else ""


def _warning_of_rebuilt(road: int, offsets: list[PassOffsets]) -> str:
    """What to tell where curbs stand elsewhere in one pass than in another, along two windows and more; "" where they do not."""
    places = _stretches_of((station, metres) for pair in offsets for station, metres in np.broadcast(pair.stations, pair.rebuilt) if metres > 0.0)
    places = [place for place in places if place[1] - place[0] > WINDOW_LENGTH]
    return (f"Road {road}: its drives show other ground at {_named_places(places, 'on a strip of up to {:.0f} cm')}: the street seems to have been "
            "rebuilt between them. Process the files of each drive by itself.") if places else ""


def _named_places(places: list[tuple[float, float, float]], what: str = "by up to {:.1f} cm") -> str:
    named = [f"{start:.0f} to {end:.0f} m (more than {100 * REGISTER.max_offset:.0f} cm apart, too far to lay them on each other)" if np.isinf(metres)
             else f"{start:.0f} to {end:.0f} m ({what.format(100 * metres)})" for start, end, metres in places[:ADJUST.most_named]]
    further = len(places) - len(named)
    return "; ".join([*named, f"and at {further} further places"] if further else named)


# Carriageways that were driven one by one, as of a motorway: whether their drives agree on the ground between them, place by place.
#
# Such roads share no pass, so nothing lays them on each other. What both drives see is the strip between the two tracks. Its flat places give the
# difference in height to millimetres. Across they tell nothing: of a guard rail each drive sees its own side, and rails hide the paint behind them.


class Beside(NamedTuple):
    """Two roads, `one` and `other`, that run beside each other."""

    one: int
    other: int
    stations: np.ndarray   # stations, places: (N,) m on the first, middles of windows of `correction_step`, and on the second
    places: np.ndarray
    apart: np.ndarray   # (N,) m of offset, left positive, from the first to the second


def compare_carriageways(survey: Any, progress: Progress = Progress()) -> None:
    """Tell how far roads of a Survey lie apart in height that run beside each other and share no pass, after its passes were adjusted."""
    for pair in roads_beside(survey.frame):
        up = np.array(list(ordered_map(partial(_height_apart, survey, pair), range(len(pair.stations)))))
        message, warns = _message_of_carriageways(pair, up)
        (progress.warn if warns else progress.info)(message)


def roads_beside(frame: Any) -> list[Beside]:
    """Pairs of roads that run beside each other for `shortest_beside` and more on one level."""
    pairs = []
    for road, other_road, s, places, offset, rise in _parallel(frame):
        rows = np.flatnonzero(np.abs(rise) < FRAME.level_separation)
        if len(rows) * REGISTER.correction_step >= ADJUST.shortest_beside:
            way = np.sign(np.cos(frame.road(road).heading(s[rows]) - frame.road(other_road).heading(places[rows])))
            pairs.append(Beside(road, other_road, s[rows], places[rows], -way * offset[rows]))
    return pairs


def warnings_of_levels(frame: Any) -> list[str]:
    """Warnings about roads that were driven along each other at another height, always by the same: one road, with heights of two kinds.

    A bridge or a second deck climbs to its height somewhere, and roads on a slope lie farther apart.
    """
    messages = []
    for road, other_road, s, _, offset, rise in _parallel(frame):
        rows = np.flatnonzero((np.abs(offset) < FRAME.same_carriageway) & (np.abs(rise) >= FRAME.level_separation))
        length = min(np.ptp([p.span for p in frame.passes_of(number)]) for number in (road, other_road))
        if len(rows) * REGISTER.correction_step < max(ADJUST.shortest_beside, ADJUST.share_along * length):
            continue
        middle = float(np.median(rise[rows]))
        if np.quantile(np.abs(rise[rows] - middle), ADJUST.share_along) < ADJUST.even_rise:
            first, last = s[rows].min() - REGISTER.correction_step / 2, s[rows].max() + REGISTER.correction_step / 2
            messages.append(f"Roads {road} and {other_road}: one lies {abs(middle):.2f} m above the other all along stations {first:.0f} to "
                            f"{last:.0f} m, as no bridge does. They seem to be one road with heights of two kinds: bring them to one.")
    return messages


def _parallel(frame):
    """Yield (road, other road, stations, places, offsets and m that the first lies higher) where roads run beside or above each other."""
    tracks = [shapely.linestrings(np.c_[p.x, p.y]) for p in frame.passes]
    near = shapely.STRtree(tracks).query(tracks, predicate="dwithin", distance=ADJUST.farthest_beside).T
    roads = np.array([p.road for p in frame.passes])
    for road, other_road in sorted({(int(a), int(b)) for a, b in roads[near] if a < b}):
        spans = np.array([p.span for p in frame.passes_of(road)])
        step = REGISTER.correction_step
        s = np.arange(np.floor(spans.min() / step), np.ceil(spans.max() / step)) * step + step / 2
        x, y = frame.road(road).to_map(s, np.zeros(len(s)))
        places, offset = frame.road(other_road).locate(x, y, corridor=ADJUST.farthest_beside)
        rows = np.flatnonzero(np.isfinite(offset))
        rows = rows[np.abs(np.cos(frame.road(road).heading(s[rows]) - frame.road(other_road).heading(places[rows]))) > ADJUST.least_parallel]
        rise = frame.track_height(road, s[rows]) - frame.track_height(other_road, places[rows])
        yield road, other_road, s[rows], places[rows], offset[rows], rise


def _height_apart(survey, pair, k):
    """m by which the second road's points lie higher in one window; NaN where too little is seen of both."""
    road, half = survey.frame.road(pair.one), REGISTER.correction_step / 2
    sides, strips = np.sort(pair.apart[k] * np.array(ADJUST.share_between)), []
    for number, station in ((pair.one, pair.stations[k]), (pair.other, pair.places[k])):
        points = survey.window(number, station - 1.5 * half, station + 1.5 * half)
        between = np.flatnonzero(np.abs(np.abs(points.d) - 0.5 * abs(pair.apart[k])) < np.ptp(sides) / 2 + 1.0)
        s, d = road.locate(points.x[between], points.y[between], corridor=ADJUST.farthest_beside)
        size = round(2 * half / REGISTER.row_cell), round(np.ptp(sides) / REGISTER.lag_cell)
        strips.append(Strips.of(d - sides[0], s - pair.stations[k] + half, points.z[between], np.zeros(len(between)), size))
    return -height_offset(*strips, 0)


def _message_of_carriageways(pair: Beside, up: np.ndarray) -> tuple[str, bool]:
    """What is said of two roads beside each other, and whether it is a warning.

    up : (N,) m by which the points of the second lie higher, NaN where both hardly see the same
    """
    measured = np.isfinite(up)
    far = measured & (np.abs(up) > ADJUST.max_height_apart)
    intro = (f"Road {pair.other} runs beside road {pair.one} at its stations {pair.stations.min() - REGISTER.correction_step / 2:.0f} to "
             f"{pair.stations.max() + REGISTER.correction_step / 2:.0f} m, and no drive measured both")
    if far.any():
        return (f"{intro}. Their drives differ in height at "
                f"{_named_places(_stretches_of(zip(pair.stations[far].tolist(), np.abs(up[far]).tolist())))}. "
                "They stay as measured: adjust the trajectories to each other, or measure control points on both, if these centimetres matter.", True)
    if not measured.any():
        return f"{intro}: nothing that both see shows how far they lie apart.", False
    return (f"{intro}: in height they agree within {100 * np.abs(up[measured]).max():.1f} cm; "
            "how far they lie apart across is not known.", False)
