"""The principal points of every profile as a layer: what the curbs were looked for on."""

import numpy as np

from ..features import Features
from ..parallel import in_order
from ..progress import Progress
from ..schemas import HEIGHT, OFFSET, PASS, ROAD, SIDE, STATION
from .curbs import REACH, SECTION, SIDES, Track, _seen_from_beside
from .profiles import pseudo_scan_lines

PRINCIPAL_POINTS = [ROAD, PASS, SIDE, STATION, OFFSET, HEIGHT]


def principal_points(survey, settings, progress=Progress()):
    """One point per occupied cell of every profile.

    Parameters
    ----------
    survey : Survey
    settings : CurbSettings

    Returns
    -------
    Features: PointZ at the middle of the cell, in map coordinates; `height_m` is
    the height above the expected road
    """
    import shapely

    found = Features("PointZ", list(PRINCIPAL_POINTS), crs=survey.crs)
    roads = survey.store.roads()
    for i, road in enumerate(roads):
        part = progress.part(i / len(roads), (i + 1) / len(roads))
        for pass_number, side, s, u, h in _points_of_road(survey, road, settings, part):
            d = SIDES[side] * u
            x, y, z = survey.frame.to_map(road, s, d, h + survey.road_height(road, s))
            found.geometries += list(shapely.points(np.c_[x, y, z]))
            found.rows += [
                {"road": road, "pass": pass_number, "side": side, "station_m": station, "offset_m": offset, "height_m": height}
                for station, offset, height in zip(s.tolist(), d.tolist(), h.tolist())
            ]
    return found


def _points_of_road(survey, road, settings, progress):
    """(pass, side, stations, outward offsets, heights) of one section and side after the other."""
    width = settings.profile_width
    start, end = survey.store.span(road)
    first, last = int(np.floor(start / width)), int(np.ceil(end / width))
    tracks = {side: Track(survey.frame, road, sign) for side, sign in SIDES.items()}
    bounds = np.unique(np.rint(np.linspace(first, last, max(int(np.ceil((end - start) / SECTION)), 1) + 1)).astype(int))

    def work(section):
        points = survey.window(road, section[0] * width, section[1] * width)
        s, d = points.s, points.d
        near = np.flatnonzero(_seen_from_beside(survey, points, s, d))
        points, s, d = points[near], s[near], d[near]
        h = points.z - survey.road_height(road, s)
        return [
            (int(number), side, *_of_side(sign * d[own], s[own], h[own], section, tracks[side], settings))
            for side, sign in SIDES.items()
            for number in np.unique(points.pass_number)
            for own in [points.pass_number == number]
        ]

    for results in in_order(work, list(zip(bounds[:-1], bounds[1:])), progress):
        yield from results


def _of_side(u, s, h, profiles, track, settings):
    width = settings.profile_width
    stations = (np.arange(*profiles) + 0.5) * width
    origin = np.floor(track(stations).min())
    outward = np.flatnonzero((u > origin) & (u < REACH))
    lines = pseudo_scan_lines(
        u[outward], s[outward], h[outward], profiles, width, settings.point_spacing, settings.layer_jump, origin, REACH)
    profile, cell = np.nonzero(np.isfinite(lines.high))
    return stations[profile], lines.offset(cell), lines.high[profile, cell]
