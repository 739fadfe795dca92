"""The smooth course of a lane, its pieces by status, and the arcs in it."""

from dataclasses import dataclass

import numpy as np

from ..curves.choice import fit_curve
from .boundaries import STEP
from .track import BRIDGED

SHORT_PIECE = 5.0   # m: a shorter change of status is not worth a piece
MOST_OF_IT = 0.9    # share of a piece that one element must cover to give it its name
LEAST_PLACES = 8


@dataclass
class Course:
    """A lane's line.

    x, y, s : (V,) vertices in local metres and their stations, s rising
    curve : the fitted curve; rmse : of the lane's places to it, metres
    """

    x: np.ndarray
    y: np.ndarray
    s: np.ndarray
    curve: object
    rmse: float


def lane_course(track, s, road):
    """Fit the course of a lane.

    Parameters
    ----------
    track : Track
    s : (K,) grid stations
    road : Road

    Returns
    -------
    Course
    """
    at = s[track.first:track.last + 1]
    x, y = road.to_map(at, track.d)
    known = track.status != BRIDGED
    if known.sum() < LEAST_PLACES:
        known = np.ones(len(at), bool)
    fit = fit_curve(x[known], y[known])
    places = fit.curve.sample(STEP)
    station, _ = road.locate(places[:, 0], places[:, 1])
    good = np.isfinite(station)
    good[good] &= station[good] > np.r_[-np.inf, np.maximum.accumulate(station[good])[:-1]]
    return Course(places[good, 0], places[good, 1], station[good], fit.curve, fit.rmse)


def settled(status):
    """Status along a lane without changes shorter than 5 m: these take the worse of their neighbours."""
    status = status.copy()
    shortest = int(SHORT_PIECE / STEP)
    while True:
        cuts = np.r_[0, np.flatnonzero(np.diff(status)) + 1, len(status)]
        lengths = np.diff(cuts)
        k = int(np.argmin(lengths))
        if len(lengths) == 1 or lengths[k] >= shortest:
            return status
        beside = [status[i] for i in (cuts[k] - 1, cuts[k + 1]) if 0 <= i < len(status)]
        status[cuts[k]:cuts[k + 1]] = max(beside)


def pieces(status, first, s):
    """(status, start station, end station) of the pieces of a lane; ends touch."""
    cuts = np.r_[0, np.flatnonzero(np.diff(status)) + 1, len(status)]
    bounds = s[first + cuts[:-1]]
    ends = np.r_[bounds[1:], s[first + len(status) - 1]]
    return [(int(status[a]), float(b), float(e)) for a, b, e in zip(cuts[:-1], bounds, ends)]


def element_of(elements, start, end):
    """The arc or straight that covers nine tenths of a piece between two stations, or None."""
    for element in elements:
        if min(end, element.end) - max(start, element.start) >= MOST_OF_IT * (end - start):
            return element
    return None
