"""Where the curb is occluded: the ground and the tall things that the scanner saw beside the road.

A missing curb counts as occluded only where no ground was measured at its place and something tall stands between it and the vehicle, or where the
road before it returned nothing, as water does, and the ground behind it is raised. Where ground was seen there, the road is open: a driveway, a
junction.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from typing import Any

import numpy as np

from ..weights import CURBS


class OcclusionGrid:
    """Ground and tall things on one side of a road: profiles along, cells of CURBS.occlusion_cell across.

    width : m of road per profile
    first, count : number of the first profile, and how many there are
    reach : m, the largest outward offset

    ground : (P, C) float32, m, height of the lowest ground above the expected road, NaN where none was seen
    tall : (P, C) bool, is there something that can hide a curb?
    """

    def __init__(self, width: float, first: int, count: int, reach: float):
        self.width, self.first = width, first
        self.cells = int(np.ceil(reach / CURBS.occlusion_cell))
        self.ground = np.full((count, self.cells), np.nan, np.float32)
        self.tall = np.zeros((count, self.cells), bool)

    def add_points(self, u: np.ndarray, s: np.ndarray, h: np.ndarray, profiles: tuple[int, int], lines: Any) -> None:
        """Add what one pass saw of some profiles.

        u, s, h : (N,) m, outward offset, station, and height above the expected road of the tall points
        profiles : (first, last + 1)
        lines : PseudoScanLines or HeightGrid of these profiles
        """
        first, last = profiles[0] - self.first, profiles[1] - self.first
        row = np.floor(s / self.width).astype(np.int64) - self.first
        cell = np.floor(u / CURBS.occlusion_cell).astype(np.int64)
        tall = (h > CURBS.min_occluder_height) & (cell >= 0) & (cell < self.cells) & (row >= first) & (row < last)
        self.tall[row[tall], cell[tall]] = True
        cells = np.clip((lines.offset(np.arange(lines.shape[1])) / CURBS.occlusion_cell).astype(np.int64), 0, self.cells - 1)
        starts = np.flatnonzero(np.r_[True, np.diff(cells) > 0])
        lowest = np.fmin.reduceat(lines.low, starts, axis=1)
        ground = self.ground[first:last]
        ground[:, cells[starts]] = np.fmin(ground[:, cells[starts]], lowest)

    @classmethod
    def join(cls, parts: Sequence[OcclusionGrid]) -> OcclusionGrid:
        """One grid of the profiles of several, which follow each other."""
        joined = copy(parts[0])
        joined.ground, joined.tall = (np.concatenate([getattr(part, name) for part in parts]) for name in ("ground", "tall"))
        return joined

    def hidden(self, s: np.ndarray, u: np.ndarray, h: np.ndarray, near: np.ndarray) -> np.ndarray:
        """Is the curb that is expected at a place hidden from the scanner?

        s, u, h : (N,) m, station, outward offset, and height of its bottom above the expected road
        near : (N,) m, outward offset of the vehicle's track

        Returns (N,) bool
        """
        rows = len(self.ground)
        row = np.clip(np.floor(s / self.width).astype(np.int64) - self.first, 0, rows - 1)
        cell = np.floor(u / CURBS.occlusion_cell).astype(np.int64)
        offsets = cell[:, None] + np.arange(-1, 2)
        inside = (offsets >= 0) & (offsets < self.cells)
        heights = self.ground[row[:, None], np.clip(offsets, 0, self.cells - 1)]
        measured = inside & (np.abs(heights - h[:, None]) < CURBS.max_bottom_difference)
        # a summed-area table gives the tall cells of any rectangle in four look-ups
        sums = np.zeros((rows + 1, self.cells + 1), np.int32)
        np.cumsum(np.cumsum(self.tall, 0, np.int32), 1, np.int32, out=sums[1:, 1:])
        reach = int(round(CURBS.shadow_reach / self.width))
        r0, r1 = np.clip(row - reach, 0, rows), np.clip(row + reach + 1, 0, rows)
        c0 = np.clip(np.floor(near / CURBS.occlusion_cell).astype(np.int64) + 3, 0, self.cells)
        c1 = np.maximum(np.clip(cell + 1, 0, self.cells), c0)
        tall = sums[r1, c1] - sums[r0, c1] - sums[r1, c0] + sums[r0, c0]
        return (measured.sum(1) < 2) & (tall > 0) | self._in_water(row, cell, h)

    def _in_water(self, row, cell, h):
        """(N,) bool, whether the road before a place returned nothing and the ground behind it is raised like the top of a curb."""
        offsets = cell[:, None] + np.arange(-CURBS.water_cells, CURBS.water_cells)
        rise = self.ground[row[:, None], np.clip(offsets, 0, self.cells - 1)] - h[:, None]
        measured = np.abs(rise) < CURBS.max_bottom_difference
        raised = measured & (rise > CURBS.least_water_step)
        return ((offsets[:, 0] > 0) & ~measured[:, :CURBS.water_cells].any(1) & raised[:, CURBS.water_cells:].any(1)
                & ~(measured & ~raised)[:, CURBS.water_cells:].any(1))
