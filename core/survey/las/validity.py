"""Points that whoever made the cloud marked as none of the survey: withheld ones and noise.

References
----------
ASPRS, LAS specification 1.4 R15: a withheld point "should not be included in processing (synonymous with Deleted)"; table 17,
classes 7 (low point, noise) and 18 (high noise).
"""

from __future__ import annotations

import laspy
import numpy as np

NOISE_CLASSES = 7, 18


def flagged(block: laspy.ScaleAwarePointRecord) -> bool:
    """Whether any point of a block has a flag or a scanner channel: LAS 1.4 keeps them in one byte, and most clouds have none."""
    raw = block.array
    return "classification_flags" not in raw.dtype.names or bool(raw["classification_flags"].max(initial=0))


def valid_points(block: laspy.ScaleAwarePointRecord) -> np.ndarray | None:
    """Which points of a block are neither withheld nor classified as noise: (N,) bool, None for all.

    Parameters
    ----------
    block : laspy point record of N points, of whose LAZ layers `flags` and `classification` are decoded
    """
    there = flagged(block) and "withheld" in block.point_format.dimension_names
    withheld = np.asarray(block["withheld"]) != 0 if there else np.zeros(1, bool)
    classes = np.asarray(block["classification"])
    low, high = NOISE_CLASSES
    noise = (classes == low) | (classes == high)
    if not noise.any():
        return ~withheld if withheld.any() else None
    return ~(noise | withheld)
