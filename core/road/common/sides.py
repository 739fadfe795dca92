"""The two sides of a road: from the driven tracks outward, section by section, in profiles."""

import numpy as np

from .decimation import POINTS_PER_LEVEL_CELL, limit_points_per_cell
from .occlusion import MIN_OCCLUDER_HEIGHT
from .pseudo_scanlines import cells_of_points, ground_of_profiles, join_profile_runs

SIDE_SIGNS = {"left": 1, "right": -1}
BLOCK_SECTION_LENGTH = 20.0  # m of road for which the length of blocks is decided
WORK_SECTION_LENGTH = 20.0     # m of road worked at a time
MAX_CURB_OFFSET = 20.0    # m from the reference line beyond which no curb is sought
HEIGHT_NODE_SPACING = 0.25     # m between the nodes of the expected height
MAX_LOOK_ALONG = 4.0    # m along the road, and as much again as across, from which a point is used


class OutermostTrack:
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


def work_sections(survey, road, width):
    """The profiles of a road parted for work: list of (first, last + 1) profile numbers, about 20 m each."""
    start, end = survey.store.span(road)
    first, last = int(np.floor(start / width)), int(np.ceil(end / width))
    count = max(int(np.ceil((end - start) / WORK_SECTION_LENGTH)), 1)
    bounds = np.unique(np.rint(np.linspace(first, last, count + 1)).astype(int))
    return [(int(a), int(b)) for a, b in zip(bounds[:-1], bounds[1:])]


def side_profiles(decimation, road, section, tracks, settings, most=POINTS_PER_LEVEL_CELL):
    """Profiles of one section, for each side and pass apart.

    Parameters
    ----------
    decimation : Crowds of the survey
    section : (first, last + 1) profile numbers
    tracks : dict of side to OutermostTrack
    settings : CurbSettings
    most : points of a cell that are looked at (see `Crowds`); None for all, as far as they tell its layers better

    Yields
    ------
    side, pass number, (u, s, h) of the tall points, PseudoScanLines
    """
    survey, width, spacing = decimation.survey, decimation.width, decimation.spacing
    stations = (np.arange(*section) + 0.5) * width
    origins = {side: np.floor(tracks[side](stations).min()) for side in SIDE_SIGNS}
    runs, tall = {}, {}
    for part in decimation.decimated_points(road, section, most):
        s, d = part.s, part.d
        if not len(s):
            continue
        along = ahead_of_vehicle(survey, part, s)
        near = np.abs(along) < MAX_LOOK_ALONG + np.abs(d)
        h = part.z - expected_height(survey, road, s)
        first = int(np.floor(s[0] / width))
        own = max(first, section[0]), min(int(np.floor(s[-1] / width)) + 1, section[1])
        for side, sign in SIDE_SIGNS.items():
            u = sign * d
            cells = max(int(np.ceil((MAX_CURB_OFFSET - origins[side]) / spacing)), 1)
            for number, seen in _by_pass(part.pass_number, near & (u > origins[side]) & (u < MAX_CURB_OFFSET)):
                key = side, number
                kept, place = cells_of_points(u, s, h, seen, own, cells, width, spacing, origins[side])
                if most is None:
                    few = limit_points_per_cell(place)
                    kept, place = kept[few], place[few]
                runs.setdefault(key, []).append(ground_of_profiles((u, s, h, along), kept, place, own, cells, settings.layer_jump))
                high = seen[h.take(seen) > MIN_OCCLUDER_HEIGHT]
                tall.setdefault(key, []).append([v.take(high) for v in (u, s, h)])
    for side, number in sorted(runs, key=lambda key: (list(SIDE_SIGNS).index(key[0]), key[1])):
        lines = join_profile_runs(runs[side, number], section, width, spacing, origins[side])
        yield side, number, tuple(np.concatenate(column) for column in zip(*tall[side, number])), lines


def _by_pass(numbers, chosen):
    """[(pass number, indices)] of the chosen points."""
    own = np.flatnonzero(chosen)
    if not len(own):
        return []
    if numbers.min() == numbers.max():
        return [(int(numbers[0]), own)]
    numbers = numbers.take(own)
    return [(int(number), own[numbers == number]) for number in np.flatnonzero(np.bincount(numbers))]


def expected_height(survey, road, s):
    """(N,) local z at which the road is expected, from nodes at fixed stations, so that many points cost little."""
    if not len(s):
        return np.empty(0)
    first = int(np.floor(np.min(s) / HEIGHT_NODE_SPACING))
    last = int(np.floor(np.max(s) / HEIGHT_NODE_SPACING)) + 1
    nodes = survey.road_height(road, np.arange(first, last + 1) * HEIGHT_NODE_SPACING)
    at = s * (1.0 / HEIGHT_NODE_SPACING)
    at -= first
    k = at.astype(np.intp)
    at -= k
    h = nodes.take(k)
    h += at * np.diff(nodes).take(k)
    return h


def ahead_of_vehicle(survey, points, s):
    """(N,) metres along the road from the vehicle to the point when it was measured (0 without times).

    What is seen from far behind or ahead lies at a flat angle and carries the drift
    of the positions since; a spinning scanner sees every place from both.
    """
    if not survey.has_time or not len(points):
        return np.zeros(len(points))
    numbers = points.pass_number
    if numbers.min() == numbers.max():
        return s - survey.frame.passes[int(numbers[0])].station_at(points.time)
    along, time = np.empty(len(points)), points.time
    for number in np.flatnonzero(np.bincount(numbers)):
        own = np.flatnonzero(numbers == number)
        along[own] = s[own] - survey.frame.passes[number].station_at(time.take(own))
    return along
