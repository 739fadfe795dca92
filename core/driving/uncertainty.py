"""How uncertain the place of a driving line is: one sigma across it.

What adds up as squares: how well the painted borders of a lane are placed, a share of the scatter of their paint about their curves, since its
errors go on over metres and do not average out; how far along a border its next paint is, where it is bridged; more where the lane lies beside
one line only; and what passes differ by that were laid on each other. Between two painted borders the middle takes half of the error of each;
where two lanes lie between them with nothing painted in the middle of the road, it takes three quarters of one and one quarter of the other.
The distance of the smooth line from the lane's places counts as far as it is more than the error of the borders, which makes the places scatter
and is counted already. Where the curvature changes, as from a straight into a hairpin bend, a line that is as good as an arc over some metres
lies beside the lane. A piece of a line says the mean along it. The shares were found on simulated streets with truth (docs/accuracy.md). What the
trajectory is off as a whole is not in it, since one pass does not show it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import distance_transform_edt, gaussian_filter1d, uniform_filter1d

from ..markings.cross_section.sections import STATION_STEP
from .lane_track import MEASURED

if TYPE_CHECKING:
    from ..markings.cross_section.sections import CrossSections
    from ..survey.frame.road_frame import Road
    from .centreline import Course
    from .lane_track import LaneTrack

BORDER_SHARE = 0.45            # of the RMS distance of a border's paint from its curve, that the border is off by
USUAL_SCATTER = 0.010          # m, of paint about its curve, where neither border says it
GAP_SHARE = 0.004              # m per m to the next place where a border is painted, or, without borders, where the lane is measured
BESIDE_SIGMA = 0.012           # m; beside: placed from one line only
BETWEEN_BORDERS, NO_MIDDLE_LINE = 0.5, 0.625   # of the mean square error of its borders, that the middle of a lane is off by
MAX_GAP_DISTANCE = 50.0        # m, beyond which a painted place says nothing
SCATTER_SHARE = 0.3            # of the RMS distance of the line from the lane's places, beyond the error of the borders
SCATTER_WINDOW = 20.0          # m along the lane, of that RMS
ARC_REACH = 3.7                # m, either way, over which the line is as good as an arc
CURVATURE_SIGMA = 1.0          # m, of the Gaussian that smooths heading and curvature
CURVATURE_WINDOW = 10.0        # m along the lane, of the RMS of the change of curvature


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
    measured = track.status == MEASURED
    painted, square, away = (np.stack(both) for both in zip(*(_border(track, lines, paint, rows) for rows in (track.left, track.right))))
    count = painted.sum(axis=0)
    known = np.isfinite(square)
    mean = np.where(known, square, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    usual = np.median(mean[known.any(axis=0)]) if known.any() else USUAL_SCATTER**2
    scatter = np.where(known.any(axis=0), mean, usual)
    gap = np.where(count > 0, (away**2).sum(axis=0) / 4.0, _distance_to(measured) ** 2)
    beside = np.where(~measured & track.offset, BESIDE_SIGMA, 0.0)
    borders = np.where(count == 2, BETWEEN_BORDERS, NO_MIDDLE_LINE) * BORDER_SHARE**2 * scatter
    wander = np.maximum(_mean_square_distance(track, course, road, lines) - borders, 0.0)
    return np.sqrt(borders + GAP_SHARE**2 * gap + beside**2 + SCATTER_SHARE**2 * wander + _mean_square_bias(track, course, lines) + passes**2)


def _mean_square_distance(track, course, road, lines):
    """(N,) m², of the smooth line from the lane's places, over SCATTER_WINDOW."""
    s = lines.s[track.first:track.last + 1]
    drawn = road.locate(np.interp(s, course.s, course.x), np.interp(s, course.s, course.y), s)[1]
    return uniform_filter1d(np.nan_to_num(drawn - track.d) ** 2, int(SCATTER_WINDOW / STATION_STEP) + 1, mode="nearest")


def _mean_square_bias(track, course, lines):
    """(N,) m², of what an arc over ARC_REACH either way misses of a line whose curvature changes.

    Where it changes by c per metre, the line leaves its arc by c u³ / 6 at u metres. The best parabola over -L to L leaves of that the third
    Legendre polynomial, with an RMS of c L³ / (15 sqrt 7).
    """
    s = lines.s[track.first:track.last + 1]
    if len(s) < 3:
        return np.zeros(len(s))
    dx, dy = (np.gradient(np.interp(s, course.s, places)) for places in (course.x, course.y))
    step = np.maximum(np.hypot(dx, dy), 0.1 * STATION_STEP)
    smooth = CURVATURE_SIGMA / STATION_STEP
    heading = gaussian_filter1d(np.unwrap(np.arctan2(dy, dx)), smooth, mode="nearest")
    change = np.gradient(gaussian_filter1d(np.gradient(heading) / step, smooth, mode="nearest")) / step
    square = np.maximum(uniform_filter1d(change**2, int(CURVATURE_WINDOW / STATION_STEP) + 1, mode="nearest"), 0.0)
    return square * (ARC_REACH**3 / (15.0 * np.sqrt(7.0))) ** 2


def _border(track, lines, paint, rows):
    """Of one side of a lane, (N,) each: is its border painted; m², mean square scatter of its paint, NaN where unknown; m to its next paint."""
    columns = np.arange(track.first, track.last + 1)
    painted = (rows >= 0) & (rows < len(lines.d))
    number = np.where(painted, lines.number[np.where(painted, rows, 0), columns], -1)
    square, away = np.full(len(track), np.nan), np.zeros(len(track))
    for one in np.unique(number[number >= 0]).tolist():
        square[number == one] = paint.get(one, np.nan) ** 2
    for row in np.unique(rows[painted]).tolist():
        own = painted & (rows == row)
        away[own] = _distance_to(lines.seen[row] & np.isfinite(lines.d[row]))[columns[own]]
    return painted, square, away


def _distance_to(known):
    """(N,) m to the nearest of the grid stations that are known, MAX_GAP_DISTANCE at most; 0 where none is."""
    if not known.any():
        return np.zeros(len(known))
    return np.minimum(distance_transform_edt(~known) * STATION_STEP, MAX_GAP_DISTANCE)
