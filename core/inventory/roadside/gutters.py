"""Gutters: the lines of lowest points beside the carriageway's edge, where water runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..surface_grid import CROSS_CELL, SLICE_LENGTH, SurfaceGrid, smoothed, surface_grid
from .uprights import TOP_BINS, UPRIGHT_SLICE, Uprights

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...survey.open_survey import Survey

GUTTER_INSIDE, GUTTER_OUTSIDE = 0.80, 0.15  # m from the edge, within which the lowest point is looked for
OUTER_RISE, OUTER_REACH = 0.02, 0.40        # m that the ground rises outward of a gutter, and within how many
INNER_RISE, INNER_REACH = 0.008, 0.50       # m that the road rises inward of it: 1.6 % fall towards the gutter
READ_BEYOND = 0.60                          # m beyond the edge that are read


def find_gutters(survey: Survey, road: int, start: float, slices: int, side: int, edge: Callable[[np.ndarray], np.ndarray]) -> Uprights:
    """The lowest points of one side of a stretch of road, where water runs along its edge.

    Parameters
    ----------
    survey, road : where
    start, slices : m, station of the first slice, and their number
    side : 1 left, -1 right
    edge : function of stations that gives the offset of the edge of that side

    Returns
    -------
    Uprights whose `top` is how deep the gutter lies below its outer side; one for each UPRIGHT_SLICE
    """
    s = start + (np.arange(slices) + 0.5) * SLICE_LENGTH
    at = edge(s)
    ends = np.array([at - side * (GUTTER_INSIDE + INNER_REACH), at + side * READ_BEYOND])
    grid = surface_grid(survey, road, start, slices, (float(np.floor(ends.min() / CROSS_CELL) * CROSS_CELL), float(ends.max())))
    if not len(grid.groups):
        return Uprights.none()
    profile = smoothed(_mean(grid))
    u = side * (grid.d - at[:, None])
    looked = (u > -GUTTER_INSIDE) & (u < GUTTER_OUTSIDE) & np.isfinite(profile)
    lowest = np.where(looked, profile, np.inf)
    j = np.argmin(lowest, axis=1)
    rows = np.arange(slices)
    low, place = lowest[rows, j], u[rows, j]
    beyond = u - place[:, None]
    outer, inner = (_highest(profile, (beyond * way > 0) & (beyond * way < reach)) for way, reach in ((1, OUTER_REACH), (-1, INNER_REACH)))
    # water stays where the ground rises outward from the lowest point on: a verge that falls on is none
    falls_on = np.where((beyond > 0) & (beyond < OUTER_REACH) & np.isfinite(profile), profile, np.inf).min(axis=1) < low
    found = np.flatnonzero(np.isfinite(low) & (outer - low > OUTER_RISE) & (inner - low > INNER_RISE) & ~falls_on)
    # a slice of the surface holds several of those along which lines are followed
    times = int(round(SLICE_LENGTH / UPRIGHT_SLICE))
    found = np.repeat(found, times)
    number = np.floor(s[found] / SLICE_LENGTH).astype(np.int64) * times + np.tile(np.arange(times), len(found) // times)
    zero = np.zeros(len(found))
    return Uprights(number, grid.d[j[found]], low[found] + grid.line(s[found]), (outer - low)[found], zero, np.zeros((len(found), TOP_BINS)),
                    zero, zero, zero + 1.0, zero, zero > 0, zero)


def _mean(grid: SurfaceGrid) -> np.ndarray:
    """(I, J) heights of all passes and scanners together, by their numbers of points; NaN where there are none."""
    count = np.where(np.isfinite(grid.height), grid.count, 0)
    total = (np.nan_to_num(grid.height) * count).sum(axis=0)
    n = count.sum(axis=0)
    return np.where(n > 0, total / np.maximum(n, 1), np.nan)


def _highest(profile, where):
    return np.where(where & np.isfinite(profile), profile, -np.inf).max(axis=1)
