"""Paint against its surroundings, made comparable between a photo and an intensity image."""

from __future__ import annotations

import numpy as np

from ...lazy import cv2

SURROUNDINGS = 1.0   # m, standard deviation of the Gaussian window of the local mean; paint is at most half a metre wide
FULL_CONTRAST = 0.6  # difference of logarithms between fresh paint and asphalt that counts as 1
_DARKEST = 0.1       # of the range of values, added before the logarithm: black is not infinitely dark
_RANGE = (1.0, 99.5)  # percentiles of the values taken for black and white


def paint_contrast(values: np.ndarray, pixel_size: float) -> tuple[np.ndarray, np.ndarray]:
    """How much brighter each pixel is than its surroundings, as a logarithm, so that sun and shadow look alike.

    Parameters
    ----------
    values : (H, W) float, NaN where unknown
    pixel_size : m

    Returns
    -------
    contrast : (H, W) float32, -1 to 1; 0 where the value is unknown
    known : (H, W) bool
    """
    known = np.isfinite(values)
    if not known.any():
        return np.zeros(values.shape, np.float32), known
    low, high = np.percentile(values[known][:: max(1, int(known.sum()) // 1_000_000)], _RANGE)
    share = (np.where(known, values, low) - low) / max(float(high - low), 1e-9)
    logarithm = np.log(np.clip(share, 0.0, 1.0) + _DARKEST).astype(np.float32)
    weight = known.astype(np.float32)
    around = SURROUNDINGS / pixel_size
    mean = _smooth(logarithm * weight, around) / np.maximum(_smooth(weight, around), 1e-3)
    return np.clip((logarithm - mean) / FULL_CONTRAST, -1.0, 1.0) * weight, known


def _smooth(values, deviation):
    """Gaussian smoothing; a wide window works on a reduced copy, which is as exact as the smoothing needs."""
    step = max(1, int(deviation // 6))
    if step == 1:
        return cv2.GaussianBlur(values, (0, 0), deviation, borderType=cv2.BORDER_REPLICATE)
    height, width = values.shape
    small = cv2.resize(values, (max(1, width // step), max(1, height // step)), interpolation=cv2.INTER_AREA)
    small = cv2.GaussianBlur(small, (0, 0), deviation / step, borderType=cv2.BORDER_REPLICATE)
    return cv2.resize(small, (width, height), interpolation=cv2.INTER_LINEAR)


def reduced(contrast: np.ndarray, factor: int) -> np.ndarray:
    """The contrast in pixels that are `factor` times as wide, each the mean of those it covers.

    Parameters
    ----------
    contrast : (H, W)
    factor : at least 1; the last columns and rows that fill no pixel are left out

    Returns
    -------
    (H // factor, W // factor) float32
    """
    if factor == 1:
        return contrast
    height, width = (n // factor for n in contrast.shape)
    if not height or not width:
        return contrast[:1, :1]
    return cv2.resize(contrast[:height * factor, :width * factor], (width, height), interpolation=cv2.INTER_AREA)
