"""How far apart the tracks of the scan lie across the road: what is smaller than that was not seen, and no gap is."""

from __future__ import annotations

import numpy as np

from ...lazy import cv2
from ..cells.road_grid import CELL_SIZE

ALONG_REACH = 6       # cells of 4 cm along the road, either way: points so near are on the same track
ACROSS_REACH = 2      # cells across it, either way: a track wavers by so much
MAX_TRACK_GAP = 0.50  # m across the road: more between points is no spacing but a shadow


def track_spacing(occupied: np.ndarray) -> np.ndarray:
    """Distance across the road from each cell's track of the scan to the next one, on the side where it is farther.

    Parameters
    ----------
    occupied : (rows, columns) bool, cells of 4 cm that hold points; rows along the road

    Returns
    -------
    (rows, columns) float32 m; 0 where points lie in every cell or nothing was scanned
    """
    tracks = cv2.dilate(occupied.astype(np.uint8), np.ones((2 * ALONG_REACH + 1, 1), np.uint8), borderValue=0).astype(bool)
    columns = np.arange(tracks.shape[1], dtype=np.int16)
    far = np.int16(2 * tracks.shape[1])
    # beyond the outermost tracks they are far away; a product is quicker than a choice between a column and that
    before = tracks * (columns + far)
    before = np.maximum.accumulate(before, axis=1, out=before)
    before -= far
    after = (tracks * (columns - 2 * far))[:, ::-1]
    after = np.minimum.accumulate(after, axis=1)[:, ::-1] + 2 * far
    gap = after - before
    gap[gap > int(MAX_TRACK_GAP / CELL_SIZE)] = 0
    return cv2.dilate(gap.astype(np.float32), np.ones((1, 2 * ACROSS_REACH + 1), np.uint8), borderValue=0) * np.float32(CELL_SIZE)
