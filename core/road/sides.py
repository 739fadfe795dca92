"""The two sides of a road: from the driven tracks outward, section by section, in profiles."""

import numpy as np

from .profiles import pseudo_scan_lines

SIDES = {"left": 1, "right": -1}
SECTION = 20.0  # m of road worked at a time
REACH = 20.0    # m from the reference line beyond which no curb is sought
NODE = 0.25     # m between the nodes of the expected height
BESIDE = 4.0    # m along the road, and as much again as across, from which a point is used


class Track:
    """Outward offset of the outermost driven track of one side."""

    def __init__(self, frame, road, sign):
        self.passes, self.sign = frame.passes_of(road), sign

    def __call__(self, s):
        s = np.asarray(s, float)
        offsets = np.full(s.shape, -np.inf)
        for p in self.passes:
            first, last = p.span
            there = (s >= first - 5.0) & (s <= last + 5.0)
            offsets = np.where(there, np.maximum(offsets, self.sign * p.at_station(s)[0]), offsets)
        return np.where(np.isfinite(offsets), offsets, 0.0)


def sections_of(survey, road, width):
    """The profiles of a road parted for work: list of (first, last + 1) profile numbers, about 20 m each."""
    start, end = survey.store.span(road)
    first, last = int(np.floor(start / width)), int(np.ceil(end / width))
    count = max(int(np.ceil((end - start) / SECTION)), 1)
    bounds = np.unique(np.rint(np.linspace(first, last, count + 1)).astype(int))
    return [(int(a), int(b)) for a, b in zip(bounds[:-1], bounds[1:])]


def profiles_beside(survey, road, section, tracks, settings):
    """Profiles of one section, for each side and pass apart.

    Parameters
    ----------
    section : (first, last + 1) profile numbers
    tracks : dict of side to Track
    settings : CurbSettings

    Yields
    ------
    side, pass number, (u, s, h) of the points, PseudoScanLines
    """
    width = settings.profile_width
    points = survey.window(road, section[0] * width, section[1] * width)
    s, d = points.s, points.d
    along = ahead_of_vehicle(survey, points, s)
    near = np.flatnonzero(np.abs(along) < BESIDE + np.abs(d))
    points, s, d, along = points[near], s[near], d[near], along[near]
    h = points.z - expected_height(survey, road, s)
    stations = (np.arange(*section) + 0.5) * width
    for side, sign in SIDES.items():
        u = sign * d
        origin = np.floor(tracks[side](stations).min())
        outward = (u > origin) & (u < REACH)
        for number in np.unique(points.pass_number):
            own = np.flatnonzero(outward & (points.pass_number == number))
            beside = u[own], s[own], h[own]
            lines = pseudo_scan_lines(*beside, along[own], section, width, settings.point_spacing,
                                      settings.layer_jump, origin, REACH)
            yield side, int(number), beside, lines


def expected_height(survey, road, s):
    """(N,) local z at which the road is expected, from nodes at fixed stations, so that many points cost little."""
    if not len(s):
        return np.empty(0)
    first = int(np.floor(np.min(s) / NODE))
    last = int(np.floor(np.max(s) / NODE)) + 1
    nodes = survey.road_height(road, np.arange(first, last + 1) * NODE)
    at = s / NODE - first
    k = np.floor(at).astype(np.int64)
    return nodes[k] + (at - k) * (nodes[k + 1] - nodes[k])


def ahead_of_vehicle(survey, points, s):
    """(N,) metres along the road from the vehicle to the point when it was measured (0 without times).

    What is seen from far behind or ahead lies at a flat angle and carries the drift
    of the positions since; a spinning scanner sees every place from both.
    """
    along = np.zeros(len(points))
    if survey.has_time:
        for p in survey.frame.passes:
            own = np.flatnonzero(points.pass_number == p.number)
            along[own] = s[own] - p.station_at(points.time[own])
    return along
