"""The smooth course of a lane, its pieces by status, and the arcs in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..curves.model_selection import fit_curves
from ..markings.cross_section.sections import STATION_STEP
from .lane_track import BRIDGED
from .settings import MIN_PLACES_PER_FIT

if TYPE_CHECKING:
    from ..survey.frame.road import Road
    from .alignment import Element
    from .lane_track import LaneTrack

MIN_STATUS_LENGTH = 5.0     # m: a shorter change of status is not worth a piece
MIN_ELEMENT_SHARE = 0.9     # share of a piece that one element must cover to give it its name
ARC_BLEND_LENGTH = 5.0      # m at its ends over which an arc passes into what comes before and after
MAX_SHARED_ARC_RMSE = 0.02  # m: RMSE below which a lane is taken to be the arc it shares with its neighbours


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


def lane_courses(tracks: list[LaneTrack], s: np.ndarray, road: Road, elements: list[list[Element]]) -> list[Course]:
    """Fit the courses of the lanes of a road, together.

    Parameters
    ----------
    tracks : list of LaneTrack
    s : (K,) grid stations
    road : Road
    elements : Elements of each lane; on them the course is the arc or straight itself, so
        that lanes of one bend are concentric

    Returns
    -------
    list of Course
    """
    fits = fit_curves([_known_places(track, s, road) for track in tracks])
    drawn = [fit.curve.sample(STATION_STEP) for fit in fits]
    stations = road.locate(*np.concatenate(drawn).T)[0] if drawn else np.empty(0)
    found, first = [], 0
    for fit, places, of_lane in zip(fits, drawn, elements):
        station = stations[first:first + len(places)]
        first += len(places)
        good = np.isfinite(station)
        good[good] &= station[good] > np.r_[-np.inf, np.maximum.accumulate(station[good])[:-1]]
        places, station = places[good], station[good]
        for element in of_lane:
            if element.rmse < MAX_SHARED_ARC_RMSE:
                places = _drawn_to(element, places, station)
        found.append(Course(places[:, 0], places[:, 1], station, fit.curve, fit.rmse))
    return found


def _known_places(track, s, road):
    """x, y of a lane where it is not bridged, of all of it where little is known."""
    known = track.status != BRIDGED
    if known.sum() < MIN_PLACES_PER_FIT:
        known = np.ones(len(track), bool)
    return road.to_map(s[track.first:track.last + 1][known], track.d[known])


def _drawn_to(element, places, station):
    """Places moved onto an element, less and less towards its ends unless the lane ends there."""
    inside = (station >= element.start) & (station <= element.end)
    if not inside.any():
        return places
    share = np.ones(inside.sum())
    at = station[inside]
    if element.start - station[0] > STATION_STEP:
        share = np.minimum(share, (at - element.start) / ARC_BLEND_LENGTH)
    if station[-1] - element.end > STATION_STEP:
        share = np.minimum(share, (element.end - at) / ARC_BLEND_LENGTH)
    u, e = element.arc.project(places[inside, 0], places[inside, 1])
    heading = element.arc.heading(u)
    moved = places.copy()
    moved[inside] -= (np.clip(share, 0.0, 1.0) * e)[:, None] * np.c_[-np.sin(heading), np.cos(heading)]
    return moved


def without_short_status(status: np.ndarray) -> np.ndarray:
    """Status along a lane without changes shorter than 5 m: these take the worse of their neighbours."""
    status = status.copy()
    shortest = int(MIN_STATUS_LENGTH / STATION_STEP)
    while True:
        cuts = np.r_[0, np.flatnonzero(np.diff(status)) + 1, len(status)]
        lengths = np.diff(cuts)
        k = int(np.argmin(lengths))
        if len(lengths) == 1 or lengths[k] >= shortest:
            return status
        beside = [status[i] for i in (cuts[k] - 1, cuts[k + 1]) if 0 <= i < len(status)]
        status[cuts[k]:cuts[k + 1]] = max(beside)


def status_pieces(status: np.ndarray, first: int, s: np.ndarray) -> list[tuple[int, float, float]]:
    """(status, start station, end station) of the pieces of a lane; ends touch."""
    cuts = np.r_[0, np.flatnonzero(np.diff(status)) + 1, len(status)]
    bounds = s[first + cuts[:-1]]
    ends = np.r_[bounds[1:], s[first + len(status) - 1]]
    return [(int(status[a]), float(b), float(e)) for a, b, e in zip(cuts[:-1], bounds, ends)]


def element_of(elements: list[Element], start: float, end: float) -> Element | None:
    """The arc or straight that covers nine tenths of a piece between two stations, or None."""
    for element in elements:
        if min(end, element.end) - max(start, element.start) >= MIN_ELEMENT_SHARE * (end - start):
            return element
    return None
