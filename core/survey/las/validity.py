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


def valid_points(block: laspy.ScaleAwarePointRecord) -> np.ndarray | None:
    """Which points of a block are neither withheld nor classified as noise: (N,) bool, None for all.

    Parameters
    ----------
    block : laspy point record of N points, of whose LAZ layers `flags` and `classification` are decoded
    """
    raw = block.array
    # LAS 1.4 keeps the flags in one byte, which in most clouds is 0 throughout
    flags_there = "classification_flags" not in raw.dtype.names or bool(raw["classification_flags"].max(initial=0))
    withheld = np.asarray(block["withheld"]) != 0 if flags_there and "withheld" in block.point_format.dimension_names else np.zeros(1, bool)
    classes = np.asarray(block["classification"])
    low, high = NOISE_CLASSES
    noise = (classes == low) | (classes == high)
    if not noise.any():
        return ~withheld if withheld.any() else None
    return ~(noise | withheld)
