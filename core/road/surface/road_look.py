"""What the ground beside a road tells of steps on it: a curb has road before it, and across level ground it may go on farther out."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from ...curves.robust import MAD_TO_SIGMA
from ..weights import CURBS, EDGE, SURFACE
from .ground_change import follow_road, smooth_road
from .ground_grid import MeasuredGround, known_median


class RoadLook:
    """The ground of one road, compared with what the vehicle drove on.

    ground : MeasuredGround of the survey
    road : its number
    """

    def __init__(self, ground: MeasuredGround, road: int):
        # the brightness of the ground tells nothing here, and workers are sent the rest
        self.cells = replace(ground.cells(road), brightness=np.empty((0, 0)), scatter=np.empty((0, 0)))
        self.prior = ground.survey.road_height(road, self.cells.stations)
        driven = known_median(self.cells.rough[:, np.abs(self.cells.offsets) < SURFACE.track_reach], 1)
        driven = np.pad(driven, SURFACE.rows_of_look, constant_values=np.nan)
        self.usual = known_median(np.lib.stride_tricks.sliding_window_view(driven, 2 * SURFACE.rows_of_look + 1), 1)

    def roughness(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) roughness at stations and offsets, (N,) m, in units of that of the road under the vehicle there; NaN where it is not known."""
        rough, row = self._at(self.cells.rough, s, d)
        return rough / np.where(self.usual > 0.0, self.usual, np.nan)[row]   # heights in coarse steps have none

    def road_height(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """Height of the road as it goes on from the track, above the expected one; m, of one shape with stations and offsets, m."""
        height, row = self._at(self._road, s, d)
        return height - self.prior[row]

    def off_road(self, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """Height of the ground above the road as it goes on from the track; m, of one shape with stations and offsets; NaN where none was seen."""
        return self._at(self.cells.height, s, d)[0] - self._at(self._road, s, d)[0]

    def step_at(self, s: np.ndarray, d: np.ndarray, outward: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """How far the ground steps up outward at (N,) stations and offsets, m, between the lines through the cells before it and behind it.

        Returns
            step : (N,) m, how far the two lines are apart at the place; NaN where one of the cells was not seen
            height : (N,) m, of the first cell behind it above the line before it
            bottom : (N,) m, of that line at the place, above the expected road
        """
        size, cells = self.cells.column_size, np.arange(1, SURFACE.cells_of_step + 1)
        middle = (np.floor(d / size) + 0.5) * size - d
        levels, slopes, firsts = [], [], []
        for way in (outward, -outward):
            heights, row = self._at(self.cells.height, s[:, None], d[:, None] + way * size * cells)
            from_middle = size * (cells - cells.mean())
            slopes.append(heights @ from_middle / (from_middle @ from_middle))
            levels.append(heights.mean(1) - slopes[-1] * (size * cells.mean() + way * middle))
            firsts.append(heights[:, 0])
        height = firsts[0] - levels[1] + slopes[1] * (size + outward * middle)
        return levels[0] - levels[1], height, levels[1] - self.prior[row[:, 0]]

    def side(self, sign: int) -> SideLook:
        """The look to the left, 1, or to the right, -1."""
        return SideLook(self, sign)

    @cached_property
    def _road(self):
        followed = follow_road(self.cells, self.prior)
        return np.full_like(self.cells.height, np.nan) if followed is None else smooth_road(followed, self.cells)

    def _at(self, values, s, d):
        """Values of cells at stations and offsets, NaN beyond them, and their rows."""
        row, column = np.floor(s / self.cells.row_size) - self.cells.first_row, np.floor(d / self.cells.column_size) - self.cells.first_column
        inside = (row >= 0) & (row < values.shape[0]) & (column >= 0) & (column < values.shape[1])   # NaN is not inside
        row, column = (np.where(inside, number, 0).astype(np.int64) for number in (row, column))
        return np.where(inside, values[row, column], np.nan), row


class SideLook:
    """A RoadLook from the track outward to one side, 1 left or -1 right."""

    def __init__(self, look: RoadLook, sign: int):
        self.look, self.sign = look, sign

    def roughness(self, s: np.ndarray, u: np.ndarray) -> np.ndarray:
        """`RoadLook.roughness` at stations and outward offsets."""
        return self.look.roughness(s, self.sign * u)

    def road_height(self, s: np.ndarray, u: np.ndarray) -> np.ndarray:
        """`RoadLook.road_height` at stations and outward offsets."""
        return self.look.road_height(s, self.sign * u)

    def steps_up(self, s: np.ndarray, u: np.ndarray, full: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Whether the ground is that of a lowered curb at places in consecutive rows of cells.

        It steps up outward, more than the same rows show on the road beside them. Or it climbs from there to the sidewalk within a metre: where
        a ramp bends, the line through it hides the step.

        s, u : (N,) m, stations of the middles of rows, and outward offsets; full : m, height of the curb where it is not lowered

        Returns
            shown : (N,) bool
            height, bottom : (N,) m, as of `RoadLook.step_at`
        """
        step, height, bottom = self.look.step_at(s, self.sign * u, self.sign)
        beside = np.abs(self.look.step_at(s, self.sign * (u - CURBS.road_beside), self.sign)[0])
        behind = self.look.off_road(s, self.sign * (u + CURBS.ramp_length))
        noise = MAD_TO_SIGMA * _median_about(beside) / np.sqrt(CURBS.lowered_rows)
        with np.errstate(invalid="ignore"):
            shown = _median_about(step) >= np.maximum(CURBS.least_lowered_step, CURBS.significant_sigmas * noise)
            climbs = (_median_about(height) >= CURBS.least_climb) & (_median_about(behind) >= EDGE.lowered_share * full)
            return (shown & (step > 0.0) | climbs) & (height > 0.0) & (height <= full), height, bottom

    @property
    def row_size(self) -> float:
        """m along the road of a row of cells."""
        return self.look.cells.row_size

    def level_to(self, s: np.ndarray, u: np.ndarray, end_s: float, end_u: float) -> np.ndarray:
        """(N,) bool, is the ground seen, and as high as the road, on the straight way from (N,) places to one?

        s, u : (N,) m, stations and outward offsets; end_s, end_u : those of the one place
        """
        share = np.linspace(0.0, 1.0, SURFACE.places_between)[:, None]
        off = self.look.off_road(s + share * (end_s - s), self.sign * (u + share * (end_u - u)))
        seen = np.isfinite(off)
        with np.errstate(invalid="ignore"):
            level = np.abs(off) < SURFACE.max_height_deviation
        return (seen.mean(0) >= SURFACE.min_seen_between) & (level.sum(0) >= SURFACE.min_level_between * seen.sum(0))


def _median_about(step):
    """(N,) median of the rows about each one, NaN where too few of them were seen."""
    rows = np.lib.stride_tricks.sliding_window_view(np.pad(step, CURBS.lowered_rows // 2, constant_values=np.nan), CURBS.lowered_rows)
    return np.where(np.isfinite(rows).sum(1) >= CURBS.min_piece_steps, known_median(rows, 1), np.nan)
