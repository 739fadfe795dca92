"""Luminance of coloured points, as a substitute where a cloud has no intensity."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...common.errors import RoadExtractionError
from .reader import CloudHeader, read_blocks

INTENSITY_SOURCES = "intensity", "rgb"
COLOUR_FIELDS = "red", "green", "blue"
LUMINANCE_WEIGHTS = 0.2126, 0.7152, 0.0722   # of red, green and blue (ITU-R BT.709-6, section 3.2)


def luminance(points: Any) -> np.ndarray:
    """Brightness of coloured points, the weighted sum of their colours.

    Parameters
    ----------
    points : laspy point record with red, green and blue

    Returns
    -------
    (N,) uint16, in the unit of the colours
    """
    return np.rint(sum(weight * np.asarray(points[name], np.float32) for name, weight in zip(COLOUR_FIELDS, LUMINANCE_WEIGHTS))).astype(np.uint16)


def check_coloured(files: Sequence[CloudHeader]) -> None:
    """Refuse files whose points have no colours.

    Raises
    ------
    RoadExtractionError
        If the point format of a file that has points holds no colours.
    """
    grey = [file for file in files if file.count and not file.has_colour]
    if grey:
        raise RoadExtractionError(
            f"The points of {grey[0].path} have no colours (point format {grey[0].point_format}), from which the intensity was to be taken. "
            "Set Intensity from to intensity, or export the points with red, green and blue.")


def without_intensity(files: Sequence[CloudHeader], taken_from: str) -> str:
    """What to say of a cloud whose points are all equally bright.

    Parameters
    ----------
    files : headers of the clouds
    taken_from : one of INTENSITY_SOURCES, what was read as intensity

    Returns
    -------
    A sentence that names the colours, where they are a way out; "" where they are not
    """
    if taken_from == "rgb":
        return "The colours of the points are all the same, so they do not stand in for intensity."
    return ("The intensity of all points is the same, but they have colours: set Intensity from (INTENSITY_FROM) to rgb, and paint is "
            "looked for in their brightness.") if any(_has_colours(file) for file in files) else ""


def _has_colours(file):
    """Whether the first points of a file differ in colour."""
    if not (file.count and file.has_colour):
        return False
    values = luminance(next(read_blocks(file.path, layers=("rgb",))))
    return bool(values.min() < values.max())
