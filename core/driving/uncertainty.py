"""How uncertain the place of a driving line is: one sigma across it.

What adds up as squares: how well the borders of the lane are placed, and how well the line follows the lane.

A painted border is found to a millimetre however many points show it, and worse with the spacing of the points; and it is off by a share of
the scatter of its paint about its curve, most of which averages out along the curve. How much these are was found on simulated streets with truth
(docs/accuracy.md). More is added with the distance to its next paint, where it is bridged. The border of a hatched area is known as well as the
outline of its bars. Between two borders the middle takes half of the error of each; where two lanes lie
between them with nothing painted in the middle of the road, it takes three quarters of one and one quarter of the other. Beside one border alone
it takes all of it, and what the width of lanes is off by.

The line is off by most of what the places of its lane lie beside it on average over some metres: the borders show the lane there and the line
passes it. Where the curvature changes, as from a straight into a hairpin bend, places and line are as good as an arc over some metres, which lies
beside the lane. A place that is a guess is off by what the guess may be: as far as the lane was moved from where its own borders show it, and, where
a second reading of the road is almost as probable, as far as the lanes of that one lie beside, with its probability. What passes differ by that
were laid on each other comes last.

A piece of a line says the mean along it, and a line is cut where it changes much. It holds against the points of the survey: what they are off
as a whole, with their trajectory, is in it only where the accuracy of the trajectory was told, since one pass does not show it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import distance_transform_edt, gaussian_filter1d, uniform_filter1d

from ..markings.cross_section.sections import STATION_STEP
from ..markings.cross_section.weights import HATCHING, OUTSIDE
from .lane_track import MEASURED

if TYPE_CHECKING:
    from ..markings.cross_section.roads import EstimatedRoad
    from ..survey.frame.road_frame import Road
    from .alignment import Course
    from .lane_track import LaneTrack

BORDER_SHARE = 0.13            # of the RMS distance of a border's paint from its curve, that the border is off by
USUAL_SCATTER = 0.010          # m, of paint about its curve, where no border says it
BORDER_SIGMA = 0.0008          # m, of a painted border, however many points show it
SPACING_SHARE = 0.028          # of the spacing of the points, that a painted border is off by
USUAL_SPACING = 0.03           # m, where there are no points to say it
GAP_SHARE = 0.003              # m per m to the next place where a border is painted, or, without borders, where the lane is measured
HATCHING_SIGMA = 0.03          # m, of a hatched area's border: outlines are of image cells, and its line's breadth is not known
WIDTH_SIGMA = 0.007            # m, of the middle of a lane beside one border alone: half of what its width is off by
BETWEEN_BORDERS, OWN_BORDER, FAR_BORDER = 0.5, 0.75, 0.25   # of the error of a border, that the middle of a lane is off by
MAX_GAP_DISTANCE = 50.0        # m, beyond which a painted place says nothing
MISFIT_WINDOW = 2.5            # m along the lane, over which its places are averaged
MISFIT_SHARE = 0.8             # of the RMS of what they lie beside the line over
MISFIT_REACH = 5.0             # m either way: where the line passes what was measured, which of the two is off is open, and so is how far beyond
ARC_REACH = 3.9                # m, either way, over which the line is as good as an arc
CURVATURE_SIGMA = 1.0          # m, of the Gaussian that smooths heading and curvature
CURVATURE_WINDOW = 10.0        # m along the lane, of the RMS of the change of curvature


def lane_sigma(track: LaneTrack, course: Course, road: Road, known: EstimatedRoad, paint: dict[int, float], passes: np.ndarray | float = 0.0,
               spacing: np.ndarray | None = None) -> np.ndarray:
    """One sigma across a driving line at each place of its lane.

    Parameters
    ----------
    track : LaneTrack of N places
    course : Course of the lane
    road : Road
    known : EstimatedRoad of the road's lines, on whose stations the track runs, and of its boundaries, between which it lies
    paint : {number of a line: m, RMS distance of its paint from its curve}
    passes : m, one sigma of the middle of the passes, see `RoadFrame.pass_sigma`: one for all, or (N,)
    spacing : (K,) m between points at the stations of `known`, NaN where unknown; None if nothing says it

    Returns
    -------
    (N,) m
    """
    lines = known.lines
    apart = np.full(len(track), np.nan) if spacing is None else spacing[track.first:track.last + 1]
    apart = np.where(np.isnan(apart), USUAL_SPACING, apart)
    return np.sqrt(_mean_square_of_borders(track, known, paint, apart) + _mean_square_misfit(track, course, road, lines)
                   + _mean_square_bias(track, course, lines) + _mean_square_guess(track) + passes**2)


def _mean_square_of_borders(track, known, paint, spacing):
    """(N,) m², of the middle of a lane from what its borders are off by."""
    lines, made_of = known.lines, np.append(known.boundaries.made_of, OUTSIDE)
    painted, square, away = (np.stack(both) for both in zip(*(_border(track, lines, paint, rows) for rows in (track.left, track.right))))
    hatched = np.stack([made_of[rows] == HATCHING for rows in (track.left, track.right)])
    bounding = painted | hatched
    told = np.isfinite(square)
    mean = np.where(told, square, 0.0).sum(axis=0) / np.maximum(told.sum(axis=0), 1)
    usual = np.median(mean[told.any(axis=0)]) if told.any() else USUAL_SCATTER**2
    scatter = np.where(told, square, np.where(told.any(axis=0), mean, usual))
    seen = BORDER_SIGMA**2 + (SPACING_SHARE * spacing) ** 2 + BORDER_SHARE**2 * scatter
    off = np.where(hatched, HATCHING_SIGMA**2, seen + (GAP_SHARE * away) ** 2)
    share = np.where(bounding.sum(axis=0) == 1, np.where(bounding, OWN_BORDER, FAR_BORDER), BETWEEN_BORDERS)
    share = np.where(track.offset & bounding.any(axis=0), bounding / np.maximum(bounding.sum(axis=0), 1), share)
    measured = track.status == MEASURED
    unbounded = np.where(bounding.any(axis=0), 0.0, GAP_SHARE * _distance_to(measured))
    beside = np.where(~measured & track.offset, WIDTH_SIGMA, 0.0)
    return (share**2 * off).sum(axis=0) + unbounded**2 + beside**2


def _mean_square_misfit(track, course, road, lines):
    """(N,) m², of the smooth line from the mean of the lane's places over MISFIT_WINDOW, over MISFIT_REACH either way."""
    s = lines.s[track.first:track.last + 1]
    drawn = road.locate(np.interp(s, course.s, course.x), np.interp(s, course.s, course.y), s)[1]
    beside = uniform_filter1d(np.nan_to_num(drawn - track.d), int(MISFIT_WINDOW / STATION_STEP), mode="nearest")
    return MISFIT_SHARE**2 * uniform_filter1d(beside**2, int(2 * MISFIT_REACH / STATION_STEP), mode="nearest")


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


def _mean_square_guess(track):
    """(N,) m², of a place that is a guess: from where its borders show the lane, and from the lanes of a second reading, about the place drawn."""
    square, doubt = track.aside**2, track.in_doubt()
    for k in np.flatnonzero(doubt).tolist():
        second = track.second[k]
        if second is not None and second.lanes:
            square[k] += min(abs(d - track.d[k]) for d, _, _ in second.lanes) ** 2 / (1.0 + np.exp(second.nats))
    return square


def _border(track, lines, paint, rows):
    """Of one side of a lane, (N,) each: is its border painted; m², mean square scatter of its paint, NaN where unknown; m to its next paint."""
    columns = np.arange(track.first, track.last + 1)
    painted = (rows >= 0) & (rows < len(lines.d))
    if not painted.any():
        return painted, np.full(len(track), np.nan), np.zeros(len(track))
    names, of = np.unique(np.where(painted, lines.number[np.where(painted, rows, 0), columns], -1), return_inverse=True)
    square = np.array([paint.get(one, np.nan) ** 2 if one >= 0 else np.nan for one in names.tolist()])[of]
    away = np.zeros(len(track))
    for begin, end in zip(*_runs(np.where(painted, rows, -1))):
        if painted[begin]:
            away[begin:end] = _distance_to_paint(lines.seen, int(rows[begin]), track.first + begin, track.first + end)
    return painted, square, away


def _runs(values):
    """Lists of where runs of equal values begin and end (exclusive)."""
    cuts = np.r_[0, np.flatnonzero(np.diff(values)) + 1, len(values)].tolist()
    return cuts[:-1], cuts[1:]


def _distance_to_paint(seen, row, first, end):
    """(N,) m from the stations `first` to `end` (exclusive) to the nearest one at which a line is seen, as `_distance_to`."""
    if not seen.row(row).any():
        return np.zeros(end - first)
    low = max(first - int(MAX_GAP_DISTANCE / STATION_STEP), 0)
    known = seen[row, low:end + int(MAX_GAP_DISTANCE / STATION_STEP)]
    away = _distance_to(known) if known.any() else np.full(len(known), MAX_GAP_DISTANCE)
    return away[first - low:end - low]


def _distance_to(known):
    """(N,) m to the nearest of the grid stations that are known, MAX_GAP_DISTANCE at most; 0 where none is."""
    if not known.any():
        return np.zeros(len(known))
    return np.minimum(distance_transform_edt(~known) * STATION_STEP, MAX_GAP_DISTANCE)
