"""Corners of paint in the intensity image: ends of dashes, corners of arrows, bars and stop lines."""

from __future__ import annotations

import numpy as np

from ...lazy import cv2

_SMOOTHING = 0.05    # m, standard deviation: the noise of single cells has corners too
_WINDOW = 0.5        # m, over which the directions of edges are collected
_APART = 1.0         # m between two corners
_LEAST = 0.08        # of the strongest corner's measure
_PAINT = 0.4         # contrast from which it is paint; spots of asphalt and its repairs have less
_BORDER = 0.3        # m from where the intensity image ends


def paint_corners(paint: np.ndarray, known: np.ndarray, cell: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Places where paint has edges in two directions, spread over the image.

    Parameters
    ----------
    paint : (H, W) contrast, its corner at local 0, 0
    known : (H, W) bool
    cell : m
    count : most corners

    Returns
    -------
    x, y : (N,) m, local, the strongest first

    References
    ----------
    .. [1] Shi and Tomasi (1994), Good features to track, CVPR: the smaller eigenvalue of the structure tensor.
    """
    if not known.any():
        return np.empty(0), np.empty(0)
    smooth = cv2.GaussianBlur(np.maximum(paint - _PAINT, 0.0), (0, 0), _SMOOTHING / cell)
    border = 2 * round(_BORDER / cell) + 1
    inside = cv2.erode(known.astype(np.uint8), np.ones((border, border), np.uint8), borderType=cv2.BORDER_CONSTANT, borderValue=0)
    found = cv2.goodFeaturesToTrack(smooth, count, _LEAST, _APART / cell, mask=inside, blockSize=2 * round(_WINDOW / cell / 2) + 1)
    if found is None:
        return np.empty(0), np.empty(0)
    column, row = found[:, 0].T.astype(float)
    return (column + 0.5) * cell, -(row + 0.5) * cell
