"""Check that points and trajectory use the same clock: the road on the own track is scanned when the vehicle is near it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..common.parallel import ordered_map
from ..common.progress import Progress

if TYPE_CHECKING:
    from .survey import Survey

CLOCK_TRACK_HALF_WIDTH = 2.0     # m either side of the own track
MAX_LOOK_AHEAD = 6.5        # m along the road: every scanner measures road nearer than this in each rotation
NEAREST_PERCENTILE = 10           # percentile of the distances that must be less than MAX_LOOK_AHEAD
CLOCK_SECTIONS, CLOCK_POINTS_PER_SECTION = 20, 5000  # sampled, evenly over the survey
MIN_CLOCK_POINTS = 500         # sampled points that a judgement needs


def check_clock(survey: Survey, progress: Progress = Progress()) -> None:
    """Warn if points were measured at times at which the vehicle was elsewhere.

    Parameters
    ----------
    survey : Survey with times
    progress : receives the warning
    """
    ahead, speed = _look_ahead(survey)
    if len(ahead) < MIN_CLOCK_POINTS or np.percentile(np.abs(ahead), NEAREST_PERCENTILE) < MAX_LOOK_AHEAD:
        return
    away, fast = float(np.median(ahead)), float(np.median(speed))
    seconds = f", about {abs(away) / fast:.1f} s at its speed" if fast > 1.0 else ""
    progress.warn(f"The times of the points do not seem to fit the trajectory: the road on the vehicle's own way was scanned when it was "
                  f"{abs(away):.0f} m {'before' if away > 0 else 'past'} that place{seconds}, and scanners see road nearer than that in every turn. "
                  "The map is blurred where passes are mixed up for it. Check that cloud and trajectory are of one drive and count time alike "
                  "(leap seconds, a lag of the recorder).")


def _look_ahead(survey):
    """Of sampled points on the own track: metres ahead of the vehicle when measured, and its speed then (m/s)."""
    keys = [(road, number) for road in survey.store.roads() for number in survey.store.sections(road)]
    sampled = [keys[k] for k in np.unique(np.linspace(0, len(keys) - 1, CLOCK_SECTIONS).astype(int))] if keys else []
    # most of the time goes into putting the points of these sections in order
    found = [part for parts in ordered_map(lambda key: _look_ahead_in_section(survey, key), sampled) for part in parts]
    ahead, speed = zip(*found) if found else ([np.empty(0)], [np.empty(0)])
    return np.concatenate(ahead), np.concatenate(speed)


def _look_ahead_in_section(survey, key):
    """The same of one section, by pass: list of (ahead, speed)."""
    points, found = survey.section(*key), []
    if len(points) > CLOCK_POINTS_PER_SECTION:
        points = points[np.unique(np.linspace(0, len(points) - 1, CLOCK_POINTS_PER_SECTION).astype(int))]
    s, d, time, owner = points.s, points.d, points.time, points.pass_number
    for number in np.unique(owner).tolist():
        p = survey.frame.passes[number]
        on_track = np.abs(d - p.at_station(s)[0]) < CLOCK_TRACK_HALF_WIDTH
        own = np.flatnonzero((owner == number) & on_track & (time >= p.time[0]) & (time <= p.time[-1]))
        here, soon = (p.station_at(time[own] + wait) for wait in (0.0, 0.5))
        found.append((p.direction * (s[own] - here), 2.0 * np.abs(soon - here)))
    return found
