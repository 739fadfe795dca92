"""Patches of the intensity image found again in the photo, once that lies roughly on the map."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ....core.lazy import cv2

_OTHER_PEAK = 0.3     # of the patch's half-width, from the best place, beyond which a second one is another
_LEAST_KNOWN = 0.3    # of a patch that the intensity image must hold
_LEAST_STRUCTURE = 0.02   # mean square contrast of a patch, below which there is no paint in it


class Found(NamedTuple):
    """Patches found again."""

    x: np.ndarray   # x, y: (N,) m, local, middles of the patches
    y: np.ndarray
    dx: np.ndarray   # dx, dy: (N,) m, from there to where the drawn photo has them
    dy: np.ndarray
    score: np.ndarray   # (N,) correlation, 0 to 1
    second: np.ndarray   # (N,) the largest correlation elsewhere in the window, as a share of the best
    sharpness: np.ndarray   # (N,) how fast the correlation falls in the direction in which it falls slowest, per m²

    def where(self, kept: np.ndarray) -> Found:
        """The patches of a (N,) bool or index array."""
        return Found(*(column[kept] for column in self))


def find_patches(paint: np.ndarray, drawn: np.ndarray, cell: float, x: np.ndarray, y: np.ndarray, half: float, search: float) -> Found:
    """Find patches of the intensity image in the photo drawn on the same cells.

    Parameters
    ----------
    paint : (H, W) contrast of the intensity image, 0 where unknown, its corner at local 0, 0
    drawn : (H, W) contrast of the photo on the same cells
    cell : m
    x, y : (N,) middles of the patches, m, local
    half : m, half the side of a patch
    search : m, how far off it may be

    Returns Found, without patches that lie too near the border, hold no paint, or were found at the border of their window
    """
    margin = max(2, round(search / cell))
    exclusion = max(2, round(_OTHER_PEAK * half / cell))
    rows: list[tuple[float, ...]] = []
    for at_x, at_y, match in zip(x, y, correlation_maps(paint, drawn, cell, x, y, half, search)):
        best = None if match is None else _peak(match, exclusion)
        if best is not None:
            right, down, score, second, sharpness = best
            rows.append((at_x, at_y, (right - margin) * cell, -(down - margin) * cell, score, second, sharpness / cell**2))
    return Found(*np.array(rows, float).reshape(-1, 7).T)


def correlation_maps(paint: np.ndarray, drawn: np.ndarray, cell: float, x: np.ndarray, y: np.ndarray, half: float,
                     search: float) -> Iterator[np.ndarray | None]:
    """The correlation of each patch with the photo, for every shift by whole cells.

    as of `find_patches`
    Returns iterator of (2 n + 1, 2 n + 1) float32, the shift by nothing in the middle; None where a patch holds no paint or the photo is empty
    """
    reach, margin = max(2, round(half / cell)), max(2, round(search / cell))
    edge = reach + margin + 1
    framed, templates = (cv2.copyMakeBorder(values, edge, edge, edge, edge, cv2.BORDER_CONSTANT, value=0.0) for values in (drawn, paint))
    for at_x, at_y in zip(x, y):
        column, row = int(np.floor(at_x / cell)) + edge, int(np.floor(-at_y / cell)) + edge
        template = templates[row - reach:row + reach + 1, column - reach:column + reach + 1]
        mask = (template != 0).astype(np.float32)
        window = framed[row - reach - margin:row + reach + margin + 1, column - reach - margin:column + reach + margin + 1]
        without_paint = mask.mean() < _LEAST_KNOWN or float((template * template).mean()) < _LEAST_STRUCTURE
        outside = not window[margin:-margin, margin:-margin].any()
        yield None if without_paint or outside else _correlation(window, template, mask)


def _correlation(window, template, mask):
    """Normalised correlation of the contrasts over the known part of the template, their means removed."""
    count = mask.sum()
    zero_mean = (template - (template * mask).sum() / count) * mask
    product = cv2.matchTemplate(window, zero_mean, cv2.TM_CCORR)
    total, square = (cv2.matchTemplate(values, mask, cv2.TM_CCORR) for values in (window, window * window))
    spread = np.maximum(square - total * total / count, 1e-3 * count)  # at least a noise of 0.03: nothing else is nothing
    return product / np.sqrt(spread * (zero_mean * zero_mean).sum())


def _peak(match, other):
    """(column, row, value, second peak as a share of it, sharpness per cell²) of the largest value; None at the border."""
    row, column = divmod(int(match.argmax()), match.shape[1])
    if not (0 < row < match.shape[0] - 1 and 0 < column < match.shape[1] - 1):
        return None
    a = match[row - 1:row + 2, column - 1:column + 2].astype(float)
    slope = np.array([a[1, 2] - a[1, 0], a[2, 1] - a[0, 1]]) / 2
    bend = np.array([[a[1, 2] - 2 * a[1, 1] + a[1, 0], (a[2, 2] - a[2, 0] - a[0, 2] + a[0, 0]) / 4],
                     [0.0, a[2, 1] - 2 * a[1, 1] + a[0, 1]]])
    bend[1, 0] = bend[0, 1]
    flattest = -np.linalg.eigvalsh(bend).max()
    if flattest <= 0 or a[1, 1] <= 0:
        return None
    move = np.clip(-np.linalg.solve(bend, slope), -1.0, 1.0)
    remaining = match.copy()
    remaining[max(0, row - other):row + other + 1, max(0, column - other):column + other + 1] = 0.0
    return column + move[0], row + move[1], a[1, 1], max(float(remaining.max()), 0.0) / a[1, 1], flattest
