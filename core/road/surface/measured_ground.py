"""The ground beside the roads of a survey, measured in windows and kept from one stage to the next.

The edges of the pavement and the surface are found in the same ground, which takes longer to measure than to look at.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...common.progress import Progress
from ...execution.phase import Phase
from ...survey.frame.road import CORRIDOR
from ..common.sides import ahead_of_vehicle
from .ground_grid import COLUMN_WIDTH, ROW_LENGTH, GroundCells, ground_cells
from .pavement_edge import SurfaceProfiles

if TYPE_CHECKING:
    from ...survey.open_survey import Survey

WINDOW_ROWS = 10              # rows of cells in memory at a time: 5 m
MEASURED_WINDOWS = 8          # that a worker process is given together: at everyday density a twentieth of a second of its time
MAX_KEPT_BYTES = 64 * 2**20   # of windows kept for the next stage, some 4 km of road; what is beyond is measured again

Wanted = tuple[int, bool, bool]   # first row of a window, and whether its cells and its profiles are to be measured


class MeasuredGround:
    """Ground cells and surface profiles of windows of WINDOW_ROWS rows.

    Parameters
    ----------
    survey : Survey
    """

    def __init__(self, survey: Survey):
        self.survey = survey
        self._cells: dict[tuple[int, int], GroundCells] = {}
        self._profiles: dict[tuple[int, int], SurfaceProfiles] = {}
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
        missing = [(row, (road, row) not in self._cells, wanted and (road, row) not in self._profiles) for row, wanted in zip(rows, profiled)]
        cells, profiles = self._measured(road, [window for window in missing if any(window[1:])], progress)
        for kept, found in ((self._cells, cells), (self._profiles, profiles)):
            self._keep(kept, road, found)
        return (GroundCells.joined([cells[row] if row in cells else self._cells[road, row] for row in rows]),
                [profiles[row] if row in profiles else self._profiles[road, row] for row, wanted in zip(rows, profiled) if wanted])

    def _measured(self, road, windows, progress):
        """{row: GroundCells} and {row: SurfaceProfiles} of windows."""
        executor = self.survey.executor.passing()
        size = MEASURED_WINDOWS if executor.folder else 1
        items = [windows[k:k + size] for k in range(0, len(windows), size)]
        phase = Phase(ground_of_windows, self.survey, (road,), lambda item: self.survey.stretch(
            road, item[0][0] * ROW_LENGTH, (item[-1][0] + WINDOW_ROWS) * ROW_LENGTH))
        cells, profiles = {}, {}
        for item, (ground, stations, offsets, across) in zip(items, executor.run(phase, items, progress)):
            for values, row in zip(ground, [row for row, wanted, _ in item if wanted]):
                cells[row] = GroundCells(row, -(values.shape[2] // 2), ROW_LENGTH, COLUMN_WIDTH, *values)
            for middles, values, row in zip(stations, across, [row for row, _, wanted in item if wanted]):
                profiles[row] = SurfaceProfiles(middles, offsets, *values)
        return cells, profiles

    def _keep(self, kept, road, found):
        """Keep windows, as far as there is room for them."""
        for row, part in found.items():
            size = sum(getattr(part, name).nbytes for name in part.NAMES)
            if self._bytes + size <= MAX_KEPT_BYTES:
                kept[road, row] = part
                self._bytes += size


def ground_of_windows(survey: Survey, windows: Sequence[Wanted], road: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The phase that measures the ground.

    Parameters
    ----------
    survey : Survey
    windows : what is wanted of each window
    road : its number

    Returns
    -------
    cells : (W, 5, R, C) float32, the attributes NAMES of the GroundCells of W windows
    stations, offsets : (V, P), (K,) m, of the SurfaceProfiles of V windows
    profiles : (V, 5, P, K) float32, the attributes NAMES of these
    """
    cells, profiles = [], []

    def height(s):
        return survey.road_height(road, s)

    for row, with_cells, with_profiles in windows:
        points = survey.window(road, row * ROW_LENGTH, (row + WINDOW_ROWS) * ROW_LENGTH)
        if with_profiles:
            profiles.append(SurfaceProfiles.of(points, row * ROW_LENGTH, WINDOW_ROWS * ROW_LENGTH, CORRIDOR, height,
                                               lambda seen: ahead_of_vehicle(survey, seen, seen.s)))
        if with_cells:
            cells.append(ground_cells(points, row, WINDOW_ROWS, CORRIDOR, height))
    offsets = profiles[0].offsets if profiles else np.empty(0)
    return _stacked(cells), np.array([part.stations for part in profiles]), offsets, _stacked(profiles)


def _stacked(parts):
    """The attributes NAMES of each part as one array."""
    return np.array([[getattr(part, name) for name in part.NAMES] for part in parts], np.float32)
