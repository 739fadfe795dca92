"""Bright things that stand above the asphalt about them: the ends of traffic islands, the tops of dropped curbs, feet of vehicles.

Paint lies on the road: at most it is some millimetres thick. The asphalt about a place is a plane through the squares of road
that are not bright, which follows crossfall, crowns and ramps; a bright square is compared with it. By our own rule.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...curves.robust import median
from ...lazy import cv2
from ...survey.store.records import COORDINATE_SCALE
from ..road_grid import CELL_SIZE

SQUARE_CELLS = 5            # squares of 20 cm
PLANE_SQUARES = 9           # squares, either way, that a plane is fitted to: 1.8 m
MIN_PLANE_SQUARES = 12      # of them with asphalt, for the plane to be known
LEAST_RISE = 0.02           # m above it: dropped curbs stand 3 cm high, thick paint lies 6 mm above the road
RISE_SIGMAS = 5.0           # standard deviations of the squares of asphalt off their planes that a rise is at least
SIGMAS_OF_MEDIAN = 1.4826   # standard deviations in a median of absolute deviations
MIN_SQUARES_OF_SPREAD = 30  # squares of asphalt in a window that tell how far they lie off their planes


def raised_cells(heights: Sequence[tuple[np.ndarray, np.ndarray]], mask: np.ndarray) -> np.ndarray:
    """Cells of a mask that stand above the asphalt about them.

    Parameters
    ----------
    heights : (flat cell numbers, heights in units of 0.1 mm) of points, in any number of parts
    mask : (rows, columns) bool, bright cells

    Returns
    -------
    (rows, columns) bool, some of the cells of the mask
    """
    columns = -(-mask.shape[1] // SQUARE_CELLS)
    shape = -(-mask.shape[0] // SQUARE_CELLS), columns
    size, low = shape[0] * columns, min((int(z.min()) for _, z in heights if len(z)), default=0)
    # of dark cells and of bright ones; sums of whole numbers are the same in any order
    count, total = np.zeros(2 * size), np.zeros(2 * size)
    bright = mask.ravel()
    for cell, z in heights:
        row = cell // np.int32(mask.shape[1])
        column = cell - row * np.int32(mask.shape[1])
        place = row // np.int32(SQUARE_CELLS) * np.int32(columns) + column // np.int32(SQUARE_CELLS) + np.int32(size) * bright.take(cell)
        count += np.bincount(place, minlength=2 * size)
        total += np.bincount(place, (z - low).astype(float), 2 * size)
    with np.errstate(invalid="ignore", divide="ignore"):
        dark, light = (total / count * COORDINATE_SCALE).reshape(2, *shape)
    off = dark - _planes(dark)
    known = off[np.isfinite(off)]
    if len(known) < MIN_SQUARES_OF_SPREAD:
        return np.zeros(mask.shape, bool)
    limit = max(LEAST_RISE, RISE_SIGMAS * SIGMAS_OF_MEDIAN * median(np.abs(known)))
    with np.errstate(invalid="ignore"):
        # what is raised and not bright is no asphalt, either
        raised = light - _planes(np.where(off <= limit / 2, dark, np.nan)) > limit
    return np.repeat(np.repeat(raised, SQUARE_CELLS, 0), SQUARE_CELLS, 1)[:mask.shape[0], :mask.shape[1]] & mask


def _planes(height):
    """(A, B) m in the middle of each square, of the plane through those about it; NaN where few are known. NaN heights are not known."""
    known = np.isfinite(height)
    z = np.where(known, height, 0.0)
    weight = known.astype(float)
    u, v = np.meshgrid(*(np.arange(n) * SQUARE_CELLS * CELL_SIZE for n in height.shape), indexing="ij")

    def about(values):
        return cv2.boxFilter(values, -1, (PLANE_SQUARES, PLANE_SQUARES), normalize=False, borderType=cv2.BORDER_CONSTANT)

    n = about(weight)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean_u, mean_v, mean_z = about(weight * u) / n, about(weight * v) / n, about(z) / n
        uu, vv, uv = about(weight * u * u) / n - mean_u**2, about(weight * v * v) / n - mean_v**2, about(weight * u * v) / n - mean_u * mean_v
        uz, vz = about(z * u) / n - mean_u * mean_z, about(z * v) / n - mean_v * mean_z
        spread = uu * vv - uv * uv
        slope_u, slope_v = (uz * vv - vz * uv) / spread, (vz * uu - uz * uv) / spread
        plane = mean_z + slope_u * (u - mean_u) + slope_v * (v - mean_v)
        # in a row of squares there is no plane
        flat = spread > 0.1 * (SQUARE_CELLS * CELL_SIZE) ** 4
    return np.where((n >= MIN_PLANE_SQUARES) & flat, plane, np.nan)
