"""The smooth course of a lane, its pieces by status, and the arcs in it."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from typing import TYPE_CHECKING

import numpy as np

from ..common.parallel import check_cancelled
from ..curves.model_selection import fit_curves
from ..markings.cross_section.sections import STATION_STEP
from .lane_track import BRIDGED, LANE_STATUS
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
                _draw_to(element, places, station)
        check_cancelled()
        found.append(Course(places[:, 0], places[:, 1], station, fit.curve, fit.rmse))
    return found


def _known_places(track, s, road):
    """x, y of a lane where it is not bridged, of all of it where little is known."""
    known = track.status != BRIDGED
    if known.sum() < MIN_PLACES_PER_FIT:
        known = np.ones(len(track), bool)
    return road.to_map(s[track.first:track.last + 1][known], track.d[known])


def _draw_to(element, places, station):
    """Move places onto an element, less and less towards its ends unless the lane ends there."""
    inside = slice(np.searchsorted(station, element.start), np.searchsorted(station, element.end, side="right"))
    at = station[inside]
    if not len(at):
        return
    share = np.ones(len(at))
    if element.start - station[0] > STATION_STEP:
        share = np.minimum(share, (at - element.start) / ARC_BLEND_LENGTH)
    if station[-1] - element.end > STATION_STEP:
        share = np.minimum(share, (element.end - at) / ARC_BLEND_LENGTH)
    u, e = element.arc.project(places[inside, 0], places[inside, 1])
    heading = element.arc.heading(u)
    places[inside] -= (np.clip(share, 0.0, 1.0) * e)[:, None] * np.c_[-np.sin(heading), np.cos(heading)]


def without_short_status(status: np.ndarray) -> np.ndarray:
    """Status along a lane without changes shorter than 5 m: these take the worse of their neighbours."""
    status = status.copy()
    cuts = [0, *(np.flatnonzero(np.diff(status)) + 1).tolist(), len(status)]
    ends = dict(zip(cuts[:-1], cuts[1:]))       # of the pieces, by where they begin,
    begins = dict(zip(cuts[1:], cuts[:-1]))     # and the other way
    # the shortest first; a piece that has grown since is there again
    queue = [(end - begin, begin) for begin, end in ends.items()]
    heapify(queue)
    while len(ends) > 1:
        length, begin = heappop(queue)
        if ends.get(begin, -1) - begin != length:
            continue
        if length >= int(MIN_STATUS_LENGTH / STATION_STEP):
            break
        end = ends.pop(begin)
        beside = [status[k] for k in (begin - 1, end) if 0 <= k < len(status)]
        status[begin:end] = max(beside)
        if begin and status[begin - 1] == status[begin]:
            begin = begins[begin]
        if end < len(status) and status[end] == status[begin]:
            end = ends.pop(end)
        ends[begin], begins[end] = end, begin
        heappush(queue, (end - begin, begin))
    return status


def track_pieces(track: LaneTrack, s: np.ndarray) -> list[tuple[int, float, float]]:
    """(status, start station, end station) of the pieces of a lane, cut where its status changes and where doubt begins or ends; ends touch."""
    kinds = len(LANE_STATUS)
    found = status_pieces(without_short_status(track.status + kinds * track.in_doubt()), track.first, s)
    return [(code % kinds, start, end) for code, start, end in found]


def status_pieces(status: np.ndarray, first: int, s: np.ndarray) -> list[tuple[int, float, float]]:
    """(status, start station, end station) of the pieces of a lane; ends touch."""
    cuts = np.r_[0, np.flatnonzero(np.diff(status)) + 1, len(status)]
    bounds = s[first + cuts[:-1]]
    ends = np.r_[bounds[1:], s[first + len(status) - 1]]
    return [(int(status[a]), float(b), float(e)) for a, b, e in zip(cuts[:-1], bounds, ends)]


def element_of(elements: list[Element], start: float, end: float) -> Element | None:
    """The arc or straight that covers nine tenths of a piece between two stations, or None."""
    for element in elements[bisect_left([one.end for one in elements], start):]:
        if element.start > end:
            break
        if min(end, element.end) - max(start, element.start) >= MIN_ELEMENT_SHARE * (end - start):
            return element
    return None
