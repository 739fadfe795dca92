"""The two sides of a road: from the driven tracks outward, section by section, in profiles."""

import numpy as np

from .decimation import FEW
from .occlusion import TALL
from .pseudo_scanlines import crowds_thinned, joined_runs, places, run_of_profiles

SIDES = {"left": 1, "right": -1}
SECTION = 20.0  # m of road for which the length of blocks is decided
WORK = 20.0     # m of road worked at a time
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
    count = max(int(np.ceil((end - start) / WORK)), 1)
    bounds = np.unique(np.rint(np.linspace(first, last, count + 1)).astype(int))
    return [(int(a), int(b)) for a, b in zip(bounds[:-1], bounds[1:])]


def profiles_beside(crowds, road, section, tracks, settings, most=FEW):
    """Profiles of one section, for each side and pass apart.

    Parameters
    ----------
    crowds : Crowds of the survey
    section : (first, last + 1) profile numbers
    tracks : dict of side to Track
    settings : CurbSettings
    most : points of a cell that are looked at (see `Crowds`); None for all, as far as they tell its layers better

    Yields
    ------
    side, pass number, (u, s, h) of the tall points, PseudoScanLines
    """
    survey, width, spacing = crowds.survey, crowds.width, crowds.spacing
    stations = (np.arange(*section) + 0.5) * width
    origins = {side: np.floor(tracks[side](stations).min()) for side in SIDES}
    runs, tall = {}, {}
    for part in crowds.few_of_every_cell(road, section, most):
        s, d = part.s, part.d
        if not len(s):
            continue
        along = ahead_of_vehicle(survey, part, s)
        near = np.abs(along) < BESIDE + np.abs(d)
        h = part.z - expected_height(survey, road, s)
        first = int(np.floor(s[0] / width))
        own = max(first, section[0]), min(int(np.floor(s[-1] / width)) + 1, section[1])
        for side, sign in SIDES.items():
            u = sign * d
            cells = max(int(np.ceil((REACH - origins[side]) / spacing)), 1)
            for number, seen in _by_pass(part.pass_number, near & (u > origins[side]) & (u < REACH)):
                key = side, number
                kept, place = places(u, s, h, seen, own, cells, width, spacing, origins[side])
                if most is None:
                    few = crowds_thinned(place)
                    kept, place = kept[few], place[few]
                runs.setdefault(key, []).append(run_of_profiles((u, s, h, along), kept, place, own, cells, settings.layer_jump))
                high = seen[h.take(seen) > TALL]
                tall.setdefault(key, []).append([v.take(high) for v in (u, s, h)])
    for side, number in sorted(runs, key=lambda key: (list(SIDES).index(key[0]), key[1])):
        lines = joined_runs(runs[side, number], section, width, spacing, origins[side])
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
    first = int(np.floor(np.min(s) / NODE))
    last = int(np.floor(np.max(s) / NODE)) + 1
    nodes = survey.road_height(road, np.arange(first, last + 1) * NODE)
    at = s * (1.0 / NODE)
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
