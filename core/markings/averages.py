"""Noisy points seen through averages: how much brighter a spot is than the road about it, and how steep it lies.

Single points of a multi-beam scanner scatter by half of asphalt's brightness.
Dozens of them lie in a square decimetre, and their mean tells paint from asphalt.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ..survey.points import UNIT

CELL = 0.04       # m
SPOT = 1.25       # cells, sigma of the average that a spot is seen through
AROUND = 10.0     # cells, sigma of the average that this is compared with: tracks, patches and shadows are wider than strokes
FEWEST = 0.05     # points a cell, so averaged, below which nothing is known
BLOCK = 25        # cells: the scatter of averages is taken in squares of 1 m
BLOCKS = 5        # squares either way that have one scatter: the median of theirs
FEWEST_IN_BLOCK = 200   # cells
LOWER, SIGMAS = 0.30, 0.5244   # quantile that tells the scatter, and how far below the median: dark rails are below it
PLAIN = 2.0       # spreads either way that asphalt keeps to
STEEP, GROUND = 3.0, 12.0      # cells, sigmas of the heights whose slopes are compared


@dataclass(frozen=True)
class Averages:
    """A window of the road in cells, (rows, columns) each, NaN where nothing is known.

    contrast : brightness above `ground`, that of the half metre about
    spread : how much the contrast of asphalt scatters there
    slope : tilt against the ground about, metres per metre: small on a road, large on the face of a curb
    """

    contrast: np.ndarray
    ground: np.ndarray
    spread: np.ndarray
    slope: np.ndarray

    @classmethod
    def of(cls, cell, value, height, shape):
        """Averages of points.

        Parameters
        ----------
        cell : (N,) flat cell number of each point
        value : (N,) its brightness
        height : (N,) int, its height in units of 0.1 mm
        shape : (rows, columns)
        """
        # in whole numbers, which sum exactly in any order
        count = np.bincount(cell, minlength=shape[0] * shape[1]).reshape(shape).astype(float)
        total = np.bincount(cell, np.rint(value.astype(float) * 64), count.size).reshape(shape) / 64
        low = int(height.min(initial=0))
        risen = np.bincount(cell, (height - low).astype(float), count.size).reshape(shape) * UNIT
        spot, around = _mean(count, total, SPOT), _mean(count, total, AROUND)
        # paint, rails and drains are no ground: a spot beside them is compared with asphalt
        contrast = spot - around
        with np.errstate(invalid="ignore"):
            plain = contrast > -PLAIN * scatter_about(contrast)
        asphalt = _mean(count * plain, total * plain, AROUND)
        around = np.where(np.isfinite(asphalt), asphalt, around)
        contrast = (spot - around).astype(np.float32)
        tilts = [np.gradient(_mean(count, risen, sigma), CELL) for sigma in (STEEP, GROUND)]
        slope = np.stack([near - about for near, about in zip(*tilts)]).astype(np.float32)
        return cls(contrast, around, scatter_about(contrast), slope)

    @property
    def z(self):
        """Contrast in spreads."""
        return self.contrast / self.spread


def _mean(count, total, sigma):
    near, near_total = (ndimage.gaussian_filter(a, sigma, mode="constant", truncate=3.0) for a in (count, total))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(near > FEWEST, near_total / near, np.nan)


def scatter_about(contrast):
    """How much asphalt's contrast scatters in the metres about each cell, as a standard deviation.

    It is told by the values a little below the median: paint lies above them,
    rails, covers and seams below.

    Parameters
    ----------
    contrast : (rows, columns) float, NaN where nothing is known

    Returns
    -------
    (rows, columns) float32; that of the whole window where too little is known near by, NaN where nowhere
    """
    rows, columns = (-(-n // BLOCK) for n in contrast.shape)
    padded = np.full((rows * BLOCK, columns * BLOCK), np.nan, np.float32)
    padded[:contrast.shape[0], :contrast.shape[1]] = contrast
    blocks = np.sort(padded.reshape(rows, BLOCK, columns, BLOCK).transpose(0, 2, 1, 3).reshape(rows, columns, -1), axis=2)
    count = np.isfinite(blocks).sum(axis=2, keepdims=True)
    low, median = (np.take_along_axis(blocks, (share * np.maximum(count - 1, 0)).astype(np.int64), 2)[..., 0]
                   for share in (LOWER, 0.5))
    spread = np.where(count[..., 0] >= FEWEST_IN_BLOCK, (median - low) / SIGMAS, np.nan)
    known = spread[np.isfinite(spread)]
    if not len(known):
        return np.full(contrast.shape, np.nan, np.float32)
    reach = BLOCKS // 2
    about = np.lib.stride_tricks.sliding_window_view(np.pad(spread, reach, constant_values=np.nan), (BLOCKS, BLOCKS))
    ordered = np.sort(about.reshape(rows, columns, -1), axis=2)
    count = np.isfinite(ordered).sum(axis=2, keepdims=True)
    middle = np.take_along_axis(ordered, np.maximum(count - 1, 0) // 2, 2)[..., 0]
    middle = np.where(count[..., 0] > 0, middle, np.median(known))
    places = [np.clip((np.arange(n) + 0.5) / BLOCK - 0.5, 0, m - 1) for n, m in zip(contrast.shape, middle.shape)]
    return ndimage.map_coordinates(middle, np.meshgrid(*places, indexing="ij"), order=1).astype(np.float32)
