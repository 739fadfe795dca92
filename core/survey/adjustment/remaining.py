"""Where passes still differ after they were laid on each other, place by place."""

from __future__ import annotations

import numpy as np

from .register import MAX_OFFSET, PLAN_AXES, WINDOW_LENGTH, PassOffsets

MAX_REMAINING = 0.02   # m in plan that two passes may still differ by: less than a marking's edge is blurred by
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
            rest = np.hypot(rest, np.nan_to_num(getattr(pair, axis) - _applied(pair, corrections, axis)))
        for station, metres in (*zip(pair.stations[rest > MAX_REMAINING], rest[rest > MAX_REMAINING]), *((station, np.inf) for station in pair.far)):
            places[float(station)] = max(places.get(float(station), 0.0), float(metres))
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
    more = f" and at {len(places) - MOST_NAMED} further places" if len(places) > MOST_NAMED else ""
    return (f"Road {road}: its passes do not lie on each other at {', '.join(named)}{more}: curbs and lines may be doubled or blurred there. "
            "Adjust the trajectories of the drives to each other, or process the files of each drive by itself.")
