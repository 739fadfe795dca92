"""The principal points of every profile as a layer: the ground on which curbs are looked for."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from typing import TYPE_CHECKING

import numpy as np

from ...common.features import HEIGHT, OFFSET, PASS, ROAD, SIDE, STATION, Features
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ..common.decimation import PointDecimation
from ..common.sides import SIDE_SIGNS, OutermostTrack, expected_height, side_profiles, work_sections

if TYPE_CHECKING:
    from ...survey.open_survey import Survey
    from ..common.curb_limits import CurbSettings

PRINCIPAL_POINTS = [ROAD, PASS, SIDE, STATION, OFFSET, HEIGHT]


def find_principal_points(survey: Survey, settings: CurbSettings, progress: Progress = Progress()) -> Features:
    """One point per occupied cell of every profile.

    Parameters
    ----------
    survey : Survey
    settings : CurbSettings
    progress : Progress

    Returns
    -------
    Features PRINCIPAL_POINTS: PointZ at the middle of the cell, in map coordinates; `height_m` is
    the height above the expected road
    """
    import shapely

    found = Features("PointZ", list(PRINCIPAL_POINTS), crs=survey.crs)
    roads = survey.store.roads()
    for i, road in enumerate(roads):
        part = progress.part(i / len(roads), (i + 1) / len(roads))
        for pass_number, side, s, u, h in _points_of_road(survey, road, settings, part):
            d = SIDE_SIGNS[side] * u
            x, y, z = survey.frame.to_map(road, s, d, h + expected_height(survey, road, s))
            found.geometries += list(shapely.points(np.c_[x, y, z]))
            found.rows += [
                {"road": road, "pass": pass_number, "side": side, "station_m": station, "offset_m": offset, "height_m": height}
                for station, offset, height in zip(s.tolist(), d.tolist(), h.tolist())
            ]
    return found


def _points_of_road(survey: Survey, road: int, settings: CurbSettings,
                    progress: Progress) -> Iterator[tuple[int, str, np.ndarray, np.ndarray, np.ndarray]]:
    """(pass, side, stations, outward offsets, heights) of one section and side after the other."""
    tracks = {side: OutermostTrack(survey.frame, road, sign) for side, sign in SIDE_SIGNS.items()}

    def work(section):
        found = []
        for side, number, _, lines in side_profiles(decimation, road, section, tracks, settings):
            profile, cell = np.nonzero(np.isfinite(lines.high))
            stations = (lines.first + profile + 0.5) * lines.width
            found.append((number, side, stations, lines.offset(cell), lines.high[profile, cell]))
        return found

    with closing(PointDecimation(survey, settings.profile_width, settings.point_spacing)) as decimation:
        for results in ordered_map(work, work_sections(survey, road, settings.profile_width), progress):
            yield from results
