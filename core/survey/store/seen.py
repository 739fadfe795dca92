"""What the points of a section show of the surface of their road: where it was scanned, and where it ends."""

from __future__ import annotations

from typing import Any

import numpy as np

from .records import COORDINATE_SCALE

STATION_STEP = 0.5   # derived: m of station between places where lanes are looked for
BIN = 0.2   # derived: m across, of what is seen of the surface and of hatching
FAR = 30.0   # derived: m: beyond any road
BINS = int(round(2 * FAR / BIN))   # derived

Seen = tuple[int, np.ndarray, np.ndarray, np.ndarray]


def seen_in_section(records: Any) -> Seen:
    """Where the surface was scanned in one section of road points.

    Returns the number of the first of the N stations of the grid that it shows; (N, BINS) bool, the bins with points; (N, 2) sums of half widths (mm)
    and (N, 2) numbers of points on the left and on the right.
    """
    step, wide, reach = (int(round(length / COORDINATE_SCALE)) for length in (STATION_STEP, BIN, FAR))
    k, d = (records["s"] + step // 2) // step, records["d"]
    inside = np.abs(d) < reach
    if not inside.any():
        return 0, np.zeros((0, BINS), bool), np.zeros((0, 2)), np.zeros((0, 2))
    half_width = records["half_width"]
    if not inside.all():
        k, d, half_width = k[inside], d[inside], half_width[inside]
    begin = int(k.min())
    k -= begin
    stations = int(k.max()) + 1
    covered = np.zeros((stations, BINS), bool)
    covered.reshape(-1)[k * BINS + (d + reach) // wide] = True
    side = 2 * k + (d < 0)
    total, number = (np.bincount(side, weights, 2 * stations).reshape(-1, 2) for weights in (half_width, None))
    return begin, covered, total, number
