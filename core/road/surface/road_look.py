"""How the ground beside a road looks beside the road itself: a curb has road before it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from ..weights import SURFACE
from .ground_grid import known_median

if TYPE_CHECKING:
    from .ground_grid import MeasuredGround


class RoadLook:
    """The ground of one road, compared with what the vehicle drove on.

    ground : MeasuredGround of the survey
    road : its number
    """

    def __init__(self, ground: MeasuredGround, road: int):
        self.cells = ground.cells(road)
        near = np.abs(self.cells.offsets) < SURFACE.track_reach
        driven = np.pad(self.cells.rough[:, near], ((SURFACE.rows_of_look,) * 2, (0, 0)), constant_values=np.nan)
        windows = np.lib.stride_tricks.sliding_window_view(driven, 2 * SURFACE.rows_of_look + 1, axis=0)
        self.usual = known_median(windows.reshape(len(windows), -1), 1)

    def roughness(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) roughness at (N,) stations and offsets, m, in units of that of the road under the vehicle there; NaN where it is not known."""
        row, column = np.floor(s / self.cells.row_size) - self.cells.first_row, np.floor(d / self.cells.column_size) - self.cells.first_column
        rows, columns = self.cells.rough.shape
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)   # NaN is not inside
        row, column = (np.where(inside, values, 0).astype(np.int64) for values in (row, column))
        return np.where(inside, self.cells.rough[row, column] / self.usual[row], np.nan)

    def outward(self, sign: int) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
        """`roughness` of one side, 1 left or -1 right, as a function of stations and outward offsets."""
        return lambda s, u: self.roughness(s, sign * u)


def looks_of(ground: MeasuredGround) -> dict[int, RoadLook]:
    """The RoadLook of every road by its number."""
    return {road: RoadLook(ground, road) for road in ground.survey.store.roads()}
