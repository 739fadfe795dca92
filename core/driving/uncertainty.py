"""How uncertain the place of a driving line is: one sigma across it.

What adds up as squares: how well the painted lines of a lane are placed, a share of the scatter of their paint about their curves, since its
errors go on over metres and do not average out; more where a border was not seen, where the lane lies beside one line only, or is bridged; the
distance of the smooth line from the lane's places; the distance to where the lane was last measured (a lane that was measured nowhere is not
led on from anywhere: its borders hold it all along); and what passes differ by that were laid on each other. A piece of a line says the mean
along it. The shares were found on simulated streets with truth (docs/accuracy.md). What the trajectory is off as a whole is not in it, since
one pass does not show it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import uniform_filter1d

from ..markings.cross_section.sections import STATION_STEP
from .lane_track import BRIDGED, MEASURED

if TYPE_CHECKING:
    from ..markings.cross_section.sections import CrossSections
    from ..survey.frame.road_frame import Road
    from .centreline import Course
    from .lane_track import LaneTrack

SEEN_SHARE, UNSEEN_SHARE = 0.3, 0.45   # of the RMS distance of the paint of both borders from their curves, where both are seen and where not
USUAL_SCATTER = 0.010          # m, of paint about its curve, where neither border says it
BESIDE_SIGMA, BRIDGED_SIGMA = 0.015, 0.015     # m; beside: placed from one line only
SCATTER_SHARE = 0.7            # of the RMS distance of the line from the lane's places
DISTANCE_SHARE = 0.0001        # m per m to the nearest measured place, where the lane is not measured but is elsewhere
MAX_MEASURED_DISTANCE = 50.0   # m, beyond which a measured place says nothing
SCATTER_WINDOW = 20.0          # m along the lane, of the RMS


def lane_sigma(track: LaneTrack, course: Course, road: Road, lines: CrossSections, paint: dict[int, float], passes: float = 0.0) -> np.ndarray:
    """One sigma across a driving line at each place of its lane.

    Parameters
    ----------
    track : LaneTrack of N places
    course : Course of the lane
    road : Road
    lines : CrossSections of the road's painted lines, on whose stations the track runs
    paint : {number of a line: m, RMS distance of its paint from its curve}
    passes : m, one sigma of the middle of the passes, see `RoadFrame.pass_sigma`

    Returns
    -------
    (N,) m
    """
    s = lines.s[track.first:track.last + 1]
    drawn = road.locate(np.interp(s, course.s, course.x), np.interp(s, course.s, course.y), s)[1]
    scatter = uniform_filter1d(np.nan_to_num(drawn - track.d) ** 2, int(SCATTER_WINDOW / STATION_STEP) + 1, mode="nearest")
    measured = track.status == MEASURED
    known, places = np.flatnonzero(measured), np.arange(len(track))
    after = np.searchsorted(known, places)
    around = np.r_[-np.inf, known, np.inf]
    away = np.minimum(np.minimum(places - around[after], around[after + 1] - places) * STATION_STEP, MAX_MEASURED_DISTANCE)
    away = away if len(known) else np.zeros(len(track))
    placed = np.select([track.status == BRIDGED, ~measured & track.offset], [BRIDGED_SIGMA, BESIDE_SIGMA], 0.0)
    share = np.where(measured, SEEN_SHARE, UNSEEN_SHARE)
    return np.sqrt(share**2 * _paint_scatter(track, lines, paint) + placed**2 + SCATTER_SHARE**2 * scatter + (DISTANCE_SHARE * away) ** 2 + passes**2)


def _paint_scatter(track, lines, paint):
    """(N,) m², mean square scatter of the paint of the borders of a lane; that of the lane elsewhere, or the usual one, where they have none."""
    columns = np.arange(track.first, track.last + 1)
    squares = np.full((2, len(track)), np.nan)
    for square, rows in zip(squares, (track.left, track.right)):
        painted = (rows >= 0) & (rows < len(lines.d))
        number = np.where(painted, lines.number[np.where(painted, rows, 0), columns], -1)
        for one in np.unique(number[number >= 0]).tolist():
            square[number == one] = paint.get(one, np.nan) ** 2
    known = np.isfinite(squares)
    count = known.sum(axis=0)
    mean = np.where(known, squares, 0.0).sum(axis=0) / np.maximum(count, 1)
    return np.where(count > 0, mean, np.median(mean[count > 0]) if count.any() else USUAL_SCATTER**2)
