"""What the points on the vehicle's own track say of a survey: whether its clocks agree, whether it is a road, whether all scanners see brightness.

The road under a vehicle is scanned when the vehicle is near it, and nothing stands on it but what the vehicle drove astride.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..common.arrays import mask_runs
from ..common.parallel import ordered_map
from ..common.progress import Progress
from .weights import READING


class _OwnTrack(NamedTuple):
    """(N,) columns of points sampled on the own track."""

    number: np.ndarray   # of the pass
    ahead: np.ndarray   # m ahead of the vehicle when measured
    speed: np.ndarray   # m/s of the vehicle then
    aside: np.ndarray   # m left of the track, by station
    height: np.ndarray   # m above the road
    scanner: np.ndarray
    intensity: np.ndarray


def check_own_track(survey: Any, progress: Progress = Progress()) -> float:
    """Warn of what points on the own track say against a Survey with times; m that it is known no better than, 0 where nothing speaks against it."""
    keys = [(road, number) for road in survey.store.roads() for number in survey.store.sections(road) if road >= 0]
    sampled = [keys[k] for k in np.unique(np.linspace(0, len(keys) - 1, READING.clock_sections).astype(int))] if keys else []
    # most of the time goes into putting the points of these sections in order
    seen = _OwnTrack(*np.concatenate([np.empty((len(_OwnTrack._fields), 0)), *ordered_map(lambda key: _of_section(survey, key), sampled)], axis=1))
    findings = [check(seen, survey) for check in (_clock, _rails, _dark_scanner)]
    for sentence, _ in findings:
        if sentence:
            progress.warn(sentence)
    return max(metres for _, metres in findings)


def _of_section(survey, key):
    """The columns of one section, (7, N)."""
    points, parts = survey.section(*key), [np.empty((len(_OwnTrack._fields), 0))]
    if len(points) > READING.clock_points_per_section:
        points = points[np.unique(np.linspace(0, len(points) - 1, READING.clock_points_per_section).astype(int))]
    s, time, owner = points.s, points.time, points.pass_number
    for number in np.unique(owner).tolist():
        p = survey.frame.passes[number]
        aside = points.d - p.at_station(s)[0]
        rows = np.flatnonzero((owner == number) & (np.abs(aside) < READING.clock_track_half_width) & (time >= p.time[0]) & (time <= p.time[-1]))
        now, soon = (p.station_at(time[rows] + wait) for wait in (0.0, 0.5))
        parts.append(np.stack([np.full(len(rows), number), p.direction * (s[rows] - now), 2.0 * np.abs(soon - now), aside[rows],
                               points.z[rows] - survey.road_height(key[0], s[rows]), points.scanner[rows], points.intensity[rows]]))
    return np.concatenate(parts, axis=1)


def _by_number(numbers, *columns):
    """{number: columns of its (N,) rows} of those with enough points for a judgement."""
    return {int(one): [column[numbers == one] for column in columns] for one, count in zip(*np.unique(numbers, return_counts=True))
            if count >= READING.min_clock_points}


def _clock(seen, survey):
    """Points measured at times at which the vehicle was elsewhere; m along the road that they fit worst by in any pass."""
    passes = _by_number(seen.number, seen.ahead, seen.speed) or _by_number(0 * seen.number, seen.ahead, seen.speed)
    off = {one: (float(np.median(ahead)), float(np.median(speed))) for one, (ahead, speed) in passes.items()
           if np.percentile(np.abs(ahead), READING.nearest_percentile) >= READING.max_look_ahead}
    if not off:
        return "", 0.0
    distance, fast = max(off.values(), key=lambda one: abs(one[0]))
    seconds = f", about {abs(distance) / fast:.1f} s at its speed" if fast > 1.0 else ""
    drives = "" if len(off) == len(passes) else f" of {len(off)} of {len(survey.frame.passes)} passes"
    return (f"The times of the points{drives} do not seem to fit the trajectory: the road on the vehicle's own way was scanned {abs(distance):.0f} m "
            f"{'before' if distance > 0 else 'past'} that place{seconds}. Check that both are of one drive and count time alike.", abs(distance))


def _rails(seen, survey):
    """Two narrow ridges all along, between which the vehicle drove; m, one sigma of what is taken for the edge of a road there."""
    bins, half = round(2 * READING.clock_track_half_width / READING.rail_cell), READING.clock_track_half_width
    for aside, height in _by_number(seen.number, seen.aside, seen.height).values():
        cell = np.minimum(((aside + half) / READING.rail_cell).astype(int), bins - 1)
        level = np.array([np.median(height[cell == k]) if (cell == k).sum() > READING.least_rail_points else np.nan for k in range(bins)])
        runs = list(mask_runs(level - np.nanmedian(level) > READING.least_rail_height))
        for (first, end), (then, last) in zip(runs[:-1], runs[1:]):
            gauge = (then + last - first - end) / 2 * READING.rail_cell
            if max(end - first, last - then) * READING.rail_cell < READING.widest_rail and READING.gauges[0] < gauge < READING.gauges[1]:
                return (f"The vehicle drove on rails, {gauge:.2f} m apart: this is a railway and no road. Edges, markings and lanes that are found "
                        "here are not those of a road.", READING.rail_verge / 12.0**0.5)
    return "", 0.0


def _dark_scanner(seen, survey):
    """A scanner without intensities among others that have them; what it leaves open is no distance."""
    alike = {one: np.ptp(intensity) == 0 for one, (intensity,) in _by_number(seen.scanner, seen.intensity).items()}
    if all(alike.values()) or not any(alike.values()):
        return "", 0.0
    dark = [one + 1 for one, same in alike.items() if same]
    return (f"Scanner {dark[0]} of {len(survey.scanners)} gives one intensity to all points, which hides paint that the others see. Export it with "
            "its intensities, or leave its points out.", 0.0)
