"""What the ground beside a road tells of steps on it: a curb has road before it, and across level ground it may go on farther out."""

from __future__ import annotations

from copy import copy
from dataclasses import replace

import numpy as np

from ...curves.robust import MAD_TO_SIGMA
from ..weights import CURBS, EDGE, SURFACE
from .ground_change import followed_road
from .ground_grid import MeasuredGround, known_median, median_about


class RoadLook:
    """The ground of one road, compared with what the vehicle drove on. Offsets count outward from the track to the side `sign`: 1 left, -1 right.

    ground : MeasuredGround of the survey
    road : its number
    """

    def __init__(self, ground: MeasuredGround, road: int):
        # the brightness of the ground tells nothing here, and workers are sent the rest
        self.cells, self.sign = replace(ground.cells(road), brightness=np.empty((0, 0)), scatter=np.empty((0, 0))), 1
        self.prior = ground.survey.road_height(road, self.cells.stations)
        driven = known_median(self.cells.rough[:, np.abs(self.cells.offsets) < SURFACE.track_reach], 1)
        self.usual = median_about(driven, SURFACE.rows_of_look)
        followed = followed_road(ground, road, self.cells, self.prior)
        self._road = np.full_like(self.cells.height, np.nan) if followed is None else followed[1]

    def side(self, sign: int) -> RoadLook:
        """The look to the left, 1, or to the right, -1."""
        look = copy(self)
        look.sign = sign
        return look

    def roughness(self, s: np.ndarray, u: np.ndarray) -> np.ndarray:
        """(N,) roughness at stations and offsets, (N,) m, in units of that of the road under the vehicle there; NaN where it is not known."""
        rough, row = self._at(self.cells.rough, s, u)
        return rough / np.where(self.usual > 0.0, self.usual, np.nan)[row]   # heights in coarse steps have none

    def road_height(self, s: np.ndarray, u: np.ndarray) -> np.ndarray:
        """Height of the road as it goes on from the track, above the expected one; m, of one shape with stations and offsets, m."""
        height, row = self._at(self._road, s, u)
        return height - self.prior[row]

    def _off_road(self, s, u):
        """Height of the ground above the road as it goes on from the track; m, of one shape with stations and offsets; NaN where none was seen."""
        return self._at(self.cells.height, s, u)[0] - self._at(self._road, s, u)[0]

    def _step_at(self, s, u):
        """How far the ground steps up outward at (N,) stations and offsets, m, between the lines through the cells before it and behind it.

        Returns
            step : (N,) m, how far the two lines are apart at the place; NaN where one of the cells was not seen
            height : (N,) m, of the first cell behind it above the line before it
            bottom : (N,) m, of that line at the place, above the expected road
        """
        size, cells = self.cells.column_size, np.arange(1, SURFACE.cells_of_step + 1)
        middle = (np.floor(self.sign * u / size) + 0.5) * size * self.sign - u
        levels, slopes, firsts = [], [], []
        for way in (1, -1):
            heights, row = self._at(self.cells.height, s[:, None], u[:, None] + way * size * cells)
            from_middle = size * (cells - cells.mean())
            slopes.append(heights @ from_middle / (from_middle @ from_middle))
            levels.append(heights.mean(1) - slopes[-1] * (size * cells.mean() + way * middle))
            firsts.append(heights[:, 0])
        height = firsts[0] - levels[1] + slopes[1] * (size + middle)
        return levels[0] - levels[1], height, levels[1] - self.prior[row[:, 0]]

    def steps_up(self, s: np.ndarray, u: np.ndarray, full: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Whether the ground is that of a lowered curb at places in consecutive rows of cells.

        It steps up outward, more than the same rows show on the road beside them. Or it climbs from there to the sidewalk within a metre: where
        a ramp bends, the line through it hides the step.

        s, u, full : (N,) m, stations of the middles of rows, offsets, and the height of the curb where it is not lowered

        Returns
            shown : (N,) bool
            height : (N,) m, of the first cell behind the step above the road before it
            bottom : (N,) m, of the road at the step, above the expected one
        """
        step, height, bottom = self._step_at(s, u)
        beside = np.abs(self._step_at(s, u - CURBS.road_beside)[0])
        behind = self._off_road(s, u + CURBS.ramp_length)
        noise = MAD_TO_SIGMA * _median_about(beside) / np.sqrt(CURBS.lowered_rows)
        shown = _median_about(step) >= np.maximum(CURBS.least_lowered_step, CURBS.significant_sigmas * noise)
        climbs = (_median_about(height) >= CURBS.least_climb) & (_median_about(behind) >= EDGE.lowered_share * full)
        return (shown & (step > 0.0) | climbs) & (height > 0.0) & (height <= full), height, bottom

    def level_to(self, s: np.ndarray, u: np.ndarray, end_s: float, end_u: float) -> np.ndarray:
        """(N,) bool, is the ground seen, and as high as the road, on the straight way from (N,) places to one?

        s, u : (N,) m, stations and offsets; end_s, end_u : those of the one place
        """
        share = np.linspace(0.0, 1.0, SURFACE.places_between)[:, None]
        off = self._off_road(s + share * (end_s - s), u + share * (end_u - u))
        seen = np.isfinite(off)
        level = np.abs(off) < SURFACE.max_height_deviation
        return (seen.mean(0) >= SURFACE.min_seen_between) & (level.sum(0) >= SURFACE.min_level_between * seen.sum(0))

    def _at(self, values, s, u):
        """Values of cells at stations and offsets, NaN beyond them, and their rows."""
        row, column, inside = self.cells.at(s, self.sign * u)
        return np.where(inside, values[row, column], np.nan), row


def _median_about(step):
    """(N,) median of the rows about each one, NaN where too few of them were seen."""
    reach = CURBS.lowered_rows // 2
    seen = np.convolve(np.isfinite(step), np.ones(CURBS.lowered_rows))[reach:len(step) + reach] if len(step) else 0
    return np.where(seen >= CURBS.min_piece_steps, median_about(step, reach), np.nan)
