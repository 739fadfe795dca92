"""Paint by the brightness of photographs, whose asphalt is as bright as shadows, seams of images and the sun leave it from metre to metre.

The level is that of the ground around a spot and not of a strip of road, and so is the scatter. Our own estimate.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import ndimage

from ...curves.robust import median
from ...lazy import cv2
from ..weights import PHOTOGRAPHS
from .not_paint import RimBands, gutter_cells
from .settings import MarkingSettings


def bright_spots(brightness: np.ndarray, rims: Sequence[RimBands], settings: MarkingSettings) -> tuple[np.ndarray, ...]:
    """Spreads above the ground around each cell, whether that makes it bright, brightness in the same spreads, and that of points of paint there.

    All (rows, columns). `brightness` : (rows, columns) float32, NaN where nothing is known; `rims` : of the scanned road and of its edges.
    """
    contrast, spread = _above_ground(brightness)
    z = contrast / spread
    # half of the brightest three cells square nearby is where paint ends; worn paint is darker than what is left of it nearby
    brightest = cv2.dilate(cv2.blur(np.nan_to_num(z), (3, 3)), np.ones((PHOTOGRAPHS.half_maximum_cells,) * 2, np.uint8))
    threshold = np.clip(brightest / 2, settings.lowest, settings.highest)
    gutter = np.logical_or.reduce([gutter_cells(z, rim) for rim in rims])
    return z, (z > threshold) & ~gutter, brightness / spread, brightness - contrast + (threshold - 0.5) * spread


def _above_ground(brightness):
    """Brightness above the asphalt around each cell, and the standard deviation of asphalt there, (rows, columns) float32 each.

    A morphological opening takes off what is narrower than any painted area; the edges of shadows and patches stay where they are. The scatter is
    taken from quantiles below the median, since paint lies above it.
    """
    even = cv2.medianBlur(_filled(brightness), PHOTOGRAPHS.median_cells)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (PHOTOGRAPHS.level_cells, PHOTOGRAPHS.level_cells))
    contrast = brightness - cv2.morphologyEx(even, cv2.MORPH_OPEN, disc)
    side = PHOTOGRAPHS.square_cells
    rows, columns = (-(-n // side) for n in contrast.shape)
    padded = np.pad(contrast, [(0, m * side - n) for m, n in zip((rows, columns), contrast.shape)], constant_values=np.nan)
    squares = padded.reshape(rows, side, columns, side).swapaxes(1, 2).reshape(rows * columns, side * side)
    enough = np.isfinite(squares).sum(axis=1) >= PHOTOGRAPHS.min_square_cells
    if not enough.any():
        return contrast, np.full(contrast.shape, np.nan, np.float32)
    shares, sigmas = np.transpose(PHOTOGRAPHS.quantiles)
    (low, dim), (high, usual) = np.nanquantile(squares[enough], shares, axis=1)[[[0, 2], [1, 3]]]
    spreads = (np.stack([high, usual]) - [low, dim]) / (sigmas[::2] - sigmas[1::2])[:, None]
    middles = [high, usual] + sigmas[1::2, None] * spreads
    painted = spreads[1] > PHOTOGRAPHS.painted_square * spreads[0]
    maps = np.full((2, rows * columns), np.nan, np.float32)
    maps[:, enough] = np.where(painted, (middles[0], spreads[0]), (middles[1], spreads[1]))
    middle, spread = (cv2.resize(ndimage.median_filter(_filled(of.reshape(rows, columns)), PHOTOGRAPHS.squares_around, mode="nearest"),
                                 padded.shape[::-1])[:contrast.shape[0], :contrast.shape[1]] for of in maps)
    return contrast - middle, np.maximum(spread, np.float32(PHOTOGRAPHS.least_scatter * median(brightness[np.isfinite(brightness)])))


def _filled(values):
    """Values, NaN where unknown, with the nearest known one there."""
    nearest = ndimage.distance_transform_edt(np.isnan(values), return_distances=False, return_indices=True)
    return np.ascontiguousarray(values[tuple(nearest)], np.float32)
