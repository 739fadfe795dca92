"""Runs of True in a mask."""

from __future__ import annotations

import numpy as np


def mask_runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """(first, last + 1) of every run of True in (N,) bool."""
    change = np.flatnonzero(np.diff(np.r_[False, mask, False].astype(np.int8)))
    return list(zip(change[::2].tolist(), change[1::2].tolist()))
