"""How uncertain the place of a driving line is: one sigma across it.

What adds up as squares: how well the lines of a lane are placed where it was measured, inferred or bridged; the distance of the smooth line
from the lane's places; a width that differs from that of the lane around it, since a border is then not what it was; the distance to
where the lane was last measured; and what passes differ by that were laid on each other. The shares were found on simulated streets with
truth (docs/accuracy.md). What the trajectory is off as a whole is not in it, since one pass does not show it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import uniform_filter1d

from ..markings.cross_section.sections import STATION_STEP
from .lane_track import BRIDGED, INFERRED, MEASURED

if TYPE_CHECKING:
    from ..survey.frame.road import Road
    from .centreline import Course
    from .lane_track import LaneTrack

MEASURED_SIGMA, INFERRED_SIGMA, BESIDE_SIGMA, BRIDGED_SIGMA = 0.0035, 0.006, 0.008, 0.012   # m; beside: inferred from one line only
SCATTER_SHARE = 0.9            # of the RMS distance of the line from the lane's places
WIDTH_SHARE = 0.4              # of the width's difference from its mean around
DISTANCE_SHARE = 0.0003        # m per m to the nearest measured place, where the lane is not measured
MAX_MEASURED_DISTANCE = 50.0   # m, beyond which a measured place says nothing
SCATTER_WINDOW = 20.0          # m along the lane, of the RMS and of the mean width


def lane_sigma(track: LaneTrack, course: Course, s: np.ndarray, road: Road, passes: float = 0.0) -> np.ndarray:
    """One sigma across a driving line at each place of its lane.

    Parameters
    ----------
    track : LaneTrack of N places
    course : Course of the lane
    s : (N,) m, stations of the track
    road : Road
    passes : m, one sigma of the middle of the passes, see `RoadFrame.pass_sigma`

    Returns
    -------
    (N,) m
    """
    drawn = road.locate(np.interp(s, course.s, course.x), np.interp(s, course.s, course.y), s)[1]
    window = int(SCATTER_WINDOW / STATION_STEP) + 1
    scatter = uniform_filter1d(np.nan_to_num(drawn - track.d) ** 2, window, mode="nearest")
    uneven = track.width - uniform_filter1d(track.width, window, mode="nearest")
    known, places = np.flatnonzero(track.status == MEASURED), np.arange(len(track))
    after = np.searchsorted(known, places)
    around = np.r_[-np.inf, known, np.inf]
    away = np.minimum(np.minimum(places - around[after], around[after + 1] - places) * STATION_STEP, MAX_MEASURED_DISTANCE)
    placed = np.select([track.status == BRIDGED, (track.status == INFERRED) & track.offset, track.status == INFERRED],
                       [BRIDGED_SIGMA, BESIDE_SIGMA, INFERRED_SIGMA], MEASURED_SIGMA)
    return np.sqrt(placed**2 + SCATTER_SHARE**2 * scatter + (WIDTH_SHARE * uneven) ** 2 + (DISTANCE_SHARE * away) ** 2 + passes**2)
