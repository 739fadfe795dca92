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
from ...survey.store.spill_file import SpillFile, StoredColumn
from ..common.sides import ahead_of_vehicle
from .ground_grid import COLUMN_WIDTH, PROFILE_COLUMN, PROFILE_ROW, ROW_LENGTH, GroundCells, SurfaceProfiles, ground_cells, ground_columns

if TYPE_CHECKING:
    from ...survey.open_survey import Survey

WINDOW_ROWS = 10              # rows of cells in memory at a time: 5 m
MEASURED_WINDOWS = 8          # that a worker process is given together: at everyday density a twentieth of a second of its time
PROFILES_PER_WINDOW = round(WINDOW_ROWS * ROW_LENGTH / PROFILE_ROW)
CELL_NAMES = ("height", "rough", "count")   # what is known of the cells: the brightness of ground is that of its profiles

Wanted = tuple[int, bool, bool]   # first row of a window, and whether its cells and its profiles are to be measured


class MeasuredGround:
    """Ground cells and surface profiles of windows of WINDOW_ROWS rows, kept in a temporary file, however long the road is.

    Parameters
    ----------
    survey : Survey
    """

    def __init__(self, survey: Survey):
        self.survey = survey
        self._file: SpillFile | None = None
        self._kept: tuple[dict[tuple[int, int], StoredColumn], ...] = {}, {}   # of cells and of profiles, by road and first row

    def windows(self, road: int, rows: Sequence[int], profiled: Sequence[bool],
                progress: Progress = Progress()) -> tuple[GroundCells, SurfaceProfiles | None]:
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
        profiles : SurfaceProfiles of the windows where they are wanted; None where they are wanted nowhere
        """
        self._measure(road, rows, profiled, progress)
        half = ground_columns(CORRIDOR, COLUMN_WIDTH)
        cells = np.empty((len(CELL_NAMES), WINDOW_ROWS * len(rows), 2 * half), np.float32)
        for place, row in enumerate(rows):
            self._read(0, road, row, cells[:, WINDOW_ROWS * place:WINDOW_ROWS * (place + 1)])
        known = dict(zip(CELL_NAMES, cells), **dict.fromkeys(("brightness", "scatter"), np.broadcast_to(np.float32(np.nan), cells.shape[1:])))
        ground = GroundCells(rows[0], -half, ROW_LENGTH, COLUMN_WIDTH, **known)
        wanted = [row for row, want in zip(rows, profiled) if want]
        if not wanted:
            return ground, None
        half = ground_columns(CORRIDOR, PROFILE_COLUMN)
        profiles = np.empty((len(SurfaceProfiles.NAMES), PROFILES_PER_WINDOW * len(wanted), 2 * half), np.float32)
        for place, row in enumerate(wanted):
            self._read(1, road, row, profiles[:, PROFILES_PER_WINDOW * place:PROFILES_PER_WINDOW * (place + 1)])
        first = np.array(wanted)[:, None] // round(PROFILE_ROW / ROW_LENGTH) + np.arange(PROFILES_PER_WINDOW)
        return ground, SurfaceProfiles((first.ravel() + 0.5) * PROFILE_ROW, (np.arange(-half, half) + 0.5) * PROFILE_COLUMN, *profiles)

    def _measure(self, road, rows, profiled, progress):
        """Keep what is wanted of windows and not known yet."""
        known, seen = self._kept
        windows = [window for window in ((row, (road, row) not in known, wanted and (road, row) not in seen) for row, wanted in zip(rows, profiled))
                   if any(window[1:])]
        executor = self.survey.executor.passing()
        size = MEASURED_WINDOWS if executor.folder else 1
        items = [windows[k:k + size] for k in range(0, len(windows), size)]
        phase = Phase(ground_of_windows, self.survey, (road,), lambda item: self.survey.stretch(
            road, item[0][0] * ROW_LENGTH, (item[-1][0] + WINDOW_ROWS) * ROW_LENGTH))
        self._file = self._file or SpillFile()
        for item, found in zip(items, executor.run(phase, items, progress)):
            for kind, (kept, parts) in enumerate(zip(self._kept, found), 1):
                for values, row in zip(parts, [window[0] for window in item if window[kind]]):
                    kept[road, row] = self._file.put(values.ravel())

    def _read(self, kind, road, row, out):
        """Fill an array with what is kept of a window: 0 its cells, 1 its profiles."""
        out[:] = self._file.get(self._kept[kind][road, row]).reshape(out.shape)


def ground_of_windows(survey: Survey, windows: Sequence[Wanted], road: int) -> tuple[np.ndarray, np.ndarray]:
    """The phase that measures the ground.

    Parameters
    ----------
    survey : Survey
    windows : what is wanted of each window
    road : its number

    Returns
    -------
    cells : (W, 3, R, C) float32, the attributes CELL_NAMES of the GroundCells of W windows
    profiles : (V, 5, P, K) float32, the attributes NAMES of the SurfaceProfiles of V windows
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
    return _stacked(cells, CELL_NAMES), _stacked(profiles, SurfaceProfiles.NAMES)


def _stacked(parts, names):
    """Attributes of each part as one array."""
    return np.array([[getattr(part, name) for name in names] for part in parts], np.float32)
