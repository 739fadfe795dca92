"""Strip adjustment: passes over one road are adjusted to each other, where navigation drifted between them.

The correction of each pass is a smooth function of station. It is the least-squares solution for the measured offsets
between passes, with small changes along the road and small corrections as prior. Two passes meet in their middle,
because nothing shows which of them is more accurate.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

from ...common.parallel import ordered_map
from ...common.progress import Progress
from ..store.records import COORDINATE_SCALE, to_units
from ..store.section_store import SectionStore
from .carrying import continued_corrections
from .register import AXES, CORRECTION_STEP, MAX_OFFSET, PassCorrections, PassOffsets, pass_offsets, sigma_of_passes
from .remaining import places_of_one_drive, remaining_places, said_of_one_drive, said_of_places

if TYPE_CHECKING:
    from ..store.columns import Columns

MOVED_COLUMNS = "x", "y", "z", "s", "d"
AGREEMENT_PLAN, AGREEMENT_HEIGHT = 0.020, 0.007    # m: a road stays as measured if nine tenths of its offsets are less
OFFSET_SIGMA = 0.003           # m, sigma of a measured offset
OUTLIER_SCALE = 0.010              # m of residual at which the weight of an offset is one half (Cauchy weights)
REWEIGHTING_ROUNDS = 5                 # iterations of robust weights
DRIFT_CHANGE_SIGMA = 0.010             # m, sigma of the drift from window to window
DRIFT_SIGMA = 0.20                # m, sigma of the drift itself


def adjust_passes(survey: Any, progress: Progress = Progress(), folder: Path | None = None) -> None:
    """Adjust the passes over every road to each other where they measurably disagree.

    Points and tracks are moved in plan and height; the reference lines of the roads stay. Where a drive goes on alone, it is moved on as
    where it left the others, so that it has no step there.

    Parameters
    ----------
    survey : Survey with times; its store and frame are replaced where passes are moved
    progress : Progress
    folder : of the moved points that are not kept in memory; None for a temporary file
    """
    roads = [road for road in survey.store.roads() if len(survey.frame.passes_of(road)) > 1]
    moves: dict[int, tuple[np.ndarray, np.ndarray]] = {}
    compared: list[PassOffsets] = []
    for k, road in enumerate(roads):
        offsets = pass_offsets(survey, road, progress.part(0.5 * k / len(roads), 0.5 * (k + 1) / len(roads)))
        apart = _disagree(offsets)
        if (sigma := sigma_of_passes(offsets)) is not None:
            survey.frame.pass_sigma[road] = sigma
        found = solve_corrections(offsets) if apart else {}
        moves.update(found)
        compared += offsets
        _report_offsets(road, offsets, found, progress)
    if moves:
        corrections = continued_corrections(survey.frame, _map_corrections(survey.frame, moves), compared)
        for road in survey.store.roads():
            if warning := said_of_one_drive(road, places_of_one_drive(survey.frame.passes_of(road), compared, corrections)):
                progress.warn(warning)
        _replace_points(survey, corrections, progress.part(0.5, 1.0), folder)


def solve_corrections(offsets: list[PassOffsets]) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """Corrections of passes from the offsets between them, by least squares with robust weights.

    Parameters
    ----------
    offsets : PassOffsets of one road

    Returns
    -------
    {pass number: ((N,) stations, (3, N) metres along, left and up)}
    """
    numbers = sorted({number for pair in offsets for number in (pair.one, pair.other)})
    first, last = (end(np.concatenate([pair.stations for pair in offsets])) for end in (np.min, np.max))
    stations = np.arange(first, last + CORRECTION_STEP / 2, CORRECTION_STEP)
    count = len(stations)
    rows = np.arange(count - 1)
    step = sparse.coo_matrix((np.r_[-np.ones(count - 1), np.ones(count - 1)], (np.r_[rows, rows], np.r_[rows, rows + 1])), (count - 1, count))
    prior = sparse.kron(sparse.identity(len(numbers)), step.T @ step / DRIFT_CHANGE_SIGMA**2 + sparse.identity(count) / DRIFT_SIGMA**2)
    found = np.zeros((len(numbers), len(AXES), count))
    for k, axis in enumerate(AXES):
        places, measured = [], []
        for pair in offsets:
            known = np.flatnonzero(np.isfinite(getattr(pair, axis)))
            at = np.rint((pair.stations[known] - first) / CORRECTION_STEP).astype(np.int64)
            places.append(np.c_[numbers.index(pair.one) * count + at, numbers.index(pair.other) * count + at])
            measured.append(getattr(pair, axis)[known])
        columns, values = np.concatenate(places), np.concatenate(measured)
        of = np.repeat(np.arange(len(values)), 2)
        between = sparse.csr_matrix((np.tile([-1.0, 1.0], len(values)), (of, columns.ravel())), (len(values), len(numbers) * count))
        weight = np.ones(len(values))
        for _ in range(REWEIGHTING_ROUNDS):
            precision = sparse.diags(weight / OFFSET_SIGMA**2)
            u = spsolve((between.T @ precision @ between + prior).tocsc(), between.T @ (precision @ values))
            weight = 1.0 / (1.0 + ((between @ u - values) / OUTLIER_SCALE) ** 2)
        found[:, k] = u.reshape(len(numbers), count)
    return {number: (stations, found[k]) for k, number in enumerate(numbers)}


def _separations(offsets):
    """(N,) known distances between passes in plan and (M,) in height, m."""
    plan = np.concatenate([np.hypot(np.nan_to_num(pair.along), np.nan_to_num(pair.left))[np.isfinite(pair.left) | np.isfinite(pair.along)]
                           for pair in offsets] or [np.empty(0)])
    up = np.concatenate([np.abs(pair.up[np.isfinite(pair.up)]) for pair in offsets] or [np.empty(0)])
    return plan, up


def _disagree(offsets):
    return any(len(values) and np.percentile(values, 90) > least for values, least in zip(_separations(offsets), (AGREEMENT_PLAN, AGREEMENT_HEIGHT)))


def _report_offsets(road, offsets, found, progress):
    """Log the offsets, and warn of places where passes still differ after the corrections found."""
    if found:
        apart = _separations(offsets)
        plan, up = (f"{100 * np.median(v):.1f} cm (at most {100 * v.max():.1f})" if len(v) else "an unknown distance" for v in apart)
        said = f"Road {road}: its passes lay {plan} beside and {up} above each other"
        if max((float(v.max()) for v in apart if len(v)), default=0.0) > MAX_OFFSET:
            progress.warn(f"{said}, which is more than navigation drifts within a survey. Drives of different years or datums lie so far apart. They "
                          "were laid on each other, each moved by its share. Nothing shows which of them is right, so the map may be off by half of "
                          "that distance. Process the files of each drive by itself, or measure control points.")
        else:
            progress.info(f"{said}, as navigation drifts between two drives. They were laid on each other, each moved by its share.")
    elif all(len(v) for v in _separations(offsets)):
        plan, up = (100 * np.percentile(v, 90) for v in _separations(offsets))
        progress.info(f"Road {road}: nine tenths of its passes lie within {plan:.1f} cm beside and {up:.1f} cm above each other; "
                     "they stay as they were measured.")
    if warning := said_of_places(road, remaining_places(offsets, found)):
        progress.warn(warning)


def _map_corrections(frame, found):
    """PassCorrections of the result of `solve_corrections`."""
    moves = {}
    for number, (stations, (along, left, up)) in found.items():
        heading = frame.road(frame.passes[number].road).heading(stations)
        c, n = np.cos(heading), np.sin(heading)
        moves[number] = float(stations[0]), to_units([along * c - left * n, along * n + left * c, up]).astype(np.int16)
    return PassCorrections(moves)


def _coordinate_changes(frame, moves, number, s, d):
    """Changes of x, y, z, s and d, (N,) metres each, at stations and offsets of a pass."""
    east, north, up = moves.metres(number, s)
    road = frame.road(frame.passes[number].road)
    heading = road.heading(s)
    c, n = np.cos(heading), np.sin(heading)
    return east, north, up, (east * c + north * n) / np.clip(1.0 - road.curvature(s) * d, 0.4, 2.5), north * c - east * n


def _moved_points(frame, moves, records):
    """The Columns of a section with corrected coordinates."""
    moved = {name: np.array(records[name]) for name in MOVED_COLUMNS}
    numbers = records["pass_number"]
    for number in np.unique(numbers).tolist():
        if number in moves.by_pass:
            own = np.flatnonzero(numbers == number)
            change = _coordinate_changes(frame, moves, number, *(records[name].take(own) * COORDINATE_SCALE for name in ("s", "d")))
            for name, metres in zip(MOVED_COLUMNS, change):
                moved[name][own] += to_units(metres)
    return records.with_columns(**moved)


def _moved_track(frame, moves, p):
    """A pass with a corrected track."""
    if p.number not in moves.by_pass:
        return p
    change = _coordinate_changes(frame, moves, p.number, p.s, p.d)
    return replace(p, **{name: getattr(p, name) + metres for name, metres in zip(MOVED_COLUMNS, change)},
                   _by_station=None, _progress=None, _span=None, _by_tick={})


def _replace_points(survey, moves, progress, folder):
    """Replace the store by one of corrected points, and the passes of the frame by corrected ones."""
    frame = survey.frame
    replace_points(survey, lambda records: _moved_points(frame, moves, records), progress, folder)
    survey.moves = moves
    survey.frame = replace(frame, passes=[_moved_track(frame, moves, p) for p in frame.passes])


def replace_points(survey: Any, moved: Callable[[Columns], Columns], progress: Progress = Progress(), folder: Path | None = None) -> None:
    """Replace the store of a survey by one of moved points.

    Parameters
    ----------
    survey : Survey
    moved : gives the Columns of a section with other coordinates
    progress : Progress
    folder : of the moved points that are not kept in memory; None for a temporary file
    """
    before = survey.store
    store = SectionStore(before.dtype, before.section_length, before.memory_limit, folder=folder)

    def part(key):
        records = moved(before.section(*key))
        return store.partition(key[0], records) if len(records) else None

    try:
        for points in ordered_map(part, [(road, number) for road in before.numbers() for number in before.sections(road)], progress):
            if points is not None:
                store.add(points)
    except BaseException:
        store.close()
        raise
    before.close()
    survey.store = store
