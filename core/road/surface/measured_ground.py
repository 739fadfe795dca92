"""The ground beside the roads of a survey, measured in windows and kept from one stage to the next.

The edges of the pavement and the surface are found in the same ground, which takes longer to measure than to look at.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...survey.frame.road import CORRIDOR
from ..common.sides import ahead_of_vehicle
from .ground_grid import ROW_LENGTH, GroundCells, ground_cells
from .pavement_edge import SurfaceProfiles

if TYPE_CHECKING:
    from ...survey.open_survey import Survey

WINDOW_ROWS = 10              # rows of cells in memory at a time: 5 m
MAX_KEPT_BYTES = 64 * 2**20   # of windows kept for the next stage, some 4 km of road; what is beyond is measured again


class MeasuredGround:
    """Ground cells and surface profiles of windows of WINDOW_ROWS rows.

    Parameters
    ----------
    survey : Survey
    """

    def __init__(self, survey: Survey):
        self.survey = survey
        self._kept: dict[tuple[int, int], tuple[GroundCells, SurfaceProfiles | None]] = {}
        self._bytes = 0

    def windows(self, road: int, rows: Sequence[int], profiled: Sequence[bool],
                progress: Progress = Progress()) -> tuple[GroundCells, list[SurfaceProfiles]]:
        """The ground of consecutive windows of a road.

        Parameters
        ----------
        road : number of the road
        rows : first row of each window
        profiled : whether the profiles of each window are wanted
        progress : Progress

        Returns
        -------
        cells : GroundCells of all windows
        profiles : list of SurfaceProfiles, of the windows where they are wanted
        """
        def measure(item):
            row, wanted = item
            cells, profiles = self._kept.get((road, row), (None, None))
            if cells is not None and (profiles is not None or not wanted):
                return cells, profiles
            points = self.survey.window(road, row * ROW_LENGTH, (row + WINDOW_ROWS) * ROW_LENGTH)
            if wanted:
                profiles = SurfaceProfiles.of(points, row * ROW_LENGTH, WINDOW_ROWS * ROW_LENGTH, CORRIDOR, height, ahead)
            return ground_cells(points, row, WINDOW_ROWS, CORRIDOR, height) if cells is None else cells, profiles

        def height(s):
            return self.survey.road_height(road, s)

        def ahead(points):
            return ahead_of_vehicle(self.survey, points, points.s)

        found = list(ordered_map(measure, list(zip(rows, profiled)), progress))
        for row, part in zip(rows, found):
            self._keep((road, row), part)
        return GroundCells.joined([cells for cells, _ in found]), [part for (_, part), wanted in zip(found, profiled) if wanted and part is not None]

    def _keep(self, key, part):
        """Keep a window, if there is room for it."""
        size = _size(part) - _size(self._kept.get(key, ()))
        if size and self._bytes + size <= MAX_KEPT_BYTES:
            self._kept[key] = part
            self._bytes += size


def _size(parts):
    """Bytes of the arrays of ground cells and profiles."""
    return sum(getattr(part, name).nbytes for part in parts if part is not None for name in part.NAMES)
