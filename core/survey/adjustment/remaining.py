"""Where passes still differ after they were laid on each other, and where one was moved that no other confirms, place by place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .register import MAX_OFFSET, PLAN_AXES, POOLING_SIGMA, WINDOW_LENGTH, PassOffsets

if TYPE_CHECKING:
    from ..frame.passes import Pass
    from .register import PassCorrections

MAX_REMAINING = 0.02   # m in plan that two passes may still differ by: less than a marking's edge is blurred by
MAX_CHANGE = 0.04      # m to the next window that a correction changes by: navigation drifts more slowly, so a pass jumped somewhere between
MOST_NAMED = 12        # places that a message names


def remaining_places(offsets: list[PassOffsets], corrections: dict[int, tuple[np.ndarray, np.ndarray]]) -> list[tuple[float, float, float]]:
    """Stretches of a road along which two of its passes still differ.

    Parameters
    ----------
    offsets : PassOffsets of the road
    corrections : of `solve_corrections`; empty where nothing was moved

    Returns
    -------
    list of (start, end, metres that they differ by at most), by station; infinite where they lie farther apart than can be measured
    """
    places: dict[float, float] = {}
    for pair in offsets:
        rest = np.zeros(len(pair.stations))
        for axis in PLAN_AXES:
            # what is unknown does not remain: it is bridged by what is known around it
            applied = _applied(pair, corrections, axis)
            left = np.abs(np.nan_to_num(getattr(pair, axis) - applied))
            rest = np.hypot(rest, np.maximum(left, _evened_out(pair.stations, applied)))
        for station, metres in (*zip(pair.stations[rest > MAX_REMAINING], rest[rest > MAX_REMAINING]), *((station, np.inf) for station in pair.far)):
            places[float(station)] = max(places.get(float(station), 0.0), float(metres))
    return stretches_of(places)


def places_of_one_drive(passes: list[Pass], offsets: list[PassOffsets], corrections: PassCorrections) -> list[tuple[float, float, float]]:
    """Stretches of a road along which a pass was moved in plan and was compared with no other, there or as near as drift changes little.

    Parameters
    ----------
    passes : of the road
    offsets : PassOffsets of all roads
    corrections : PassCorrections, as they are applied

    Returns
    -------
    list of (start, end, metres that the pass was moved by at most), by station
    """
    places: dict[float, float] = {}
    for p in passes:
        if p.number not in corrections.by_pass:
            continue
        known = np.concatenate([pair.stations[np.isfinite(pair.left) | np.isfinite(pair.along)] for pair in offsets
                                if p.number in (pair.one, pair.other)] or [np.empty(0)])
        first, last = np.floor(np.array(p.span) / WINDOW_LENGTH).astype(int)
        stations = (np.arange(first, last + 1) + 0.5) * WINDOW_LENGTH
        away = np.abs(stations[:, None] - known).min(axis=1, initial=np.inf)
        moved = np.hypot(*corrections.metres(p.number, stations)[:2])
        for station, metres in zip(*(values[(away > POOLING_SIGMA) & (moved > MAX_REMAINING)].tolist() for values in (stations, moved))):
            places[station] = max(places.get(station, 0.0), metres)
    return stretches_of(places)


def _evened_out(stations, applied):
    """(N,) m of a jump that remain in the windows it lies between, as corrections change evenly from one to the next; 0 where there is none."""
    found = np.zeros(len(stations))
    change = np.abs(np.diff(applied))
    for k in np.flatnonzero((change > MAX_CHANGE) & (np.diff(stations) < 1.5 * WINDOW_LENGTH)).tolist():
        found[k:k + 2] = np.maximum(found[k:k + 2], change[k] / 2)
    return found


def stretches_of(places: dict[float, float]) -> list[tuple[float, float, float]]:
    """[(start, end, largest metres)] of {middle of a window: metres}, windows that touch in one; infinite ones apart from the others."""
    found: list[tuple[float, float, float]] = []
    for station, metres in sorted(places.items()):
        start, end = station - WINDOW_LENGTH / 2, station + WINDOW_LENGTH / 2
        if found and start <= found[-1][1] and np.isinf(metres) == np.isinf(found[-1][2]):
            found[-1] = found[-1][0], end, max(metres, found[-1][2])
        else:
            found.append((start, end, metres))
    return found


def _applied(pair, corrections, axis):
    """(N,) metres along an axis by which the second pass of a pair was moved against the first."""
    if pair.one not in corrections:
        return np.zeros(len(pair.stations))
    row = ("along", "left", "up").index(axis)
    one, other = (np.interp(pair.stations, stations, moved[row]) for stations, moved in (corrections[pair.one], corrections[pair.other]))
    return other - one


def said_of_places(road: int, places: list[tuple[float, float, float]]) -> str:
    """The warning about places that remain; "" where there is none."""
    if not places:
        return ""
    named = [f"{start:.0f} to {end:.0f} m (" + (f"more than {100 * MAX_OFFSET:.0f} cm apart, too far to lay them on each other)" if np.isinf(metres)
                                                else f"up to {100 * metres:.1f} cm remain)") for start, end, metres in places[:MOST_NAMED]]
    more = _further(places)
    return (f"Road {road}: its passes do not lie on each other at {', '.join(named)}{more}: curbs and lines may be doubled or blurred there. "
            "Adjust the trajectories of the drives to each other, or process the files of each drive by itself.")


def said_of_one_drive(road: int, places: list[tuple[float, float, float]]) -> str:
    """The warning about places where one drive alone was moved; "" where there is none."""
    if not places:
        return ""
    return (f"Road {road}: one drive alone shows what lies at {named_places(places, 'by up to {:.1f} cm')}. It was moved there as where it last "
            "lay beside the others, and nothing shows how well that fits: measure a control point there if these centimetres matter.")


def named_places(places: list[tuple[float, float, float]], size: str) -> str:
    """Places by station with what is said of their metres in cm, those beyond MOST_NAMED as a number."""
    return ", ".join(f"{start:.0f} to {end:.0f} m ({size.format(100 * metres)})" for start, end, metres in places[:MOST_NAMED]) + _further(places)


def _further(places):
    return f" and at {len(places) - MOST_NAMED} further places" if len(places) > MOST_NAMED else ""
