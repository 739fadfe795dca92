"""How long the dashes of lines are, from the markings that lie on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..objects.classify import LINE_KINDS
from .sections import STATION_STEP, CrossSections

if TYPE_CHECKING:
    from ..objects.marking_objects import MarkingObjects

BESIDE = 0.15        # m between the middle of a dash and its line
FULL_DASH = 75       # percent: of the dashes of a run those that are not worn; wear only ever shortens them
MIN_DASHES = 4       # in a run: fewer may be remnants of a line that is worn away


def dash_lengths(lines: CrossSections, markings: MarkingObjects | None, road: int) -> np.ndarray:
    """Length of the dashes of dashed lines.

    Parameters
    ----------
    lines : CrossSections of L lines at K stations
    markings : MarkingObjects or None
    road : number of the road

    Returns
    -------
    (L, K) metres, the same along each dashed stretch of a line; NaN where a line is not dashed, or has too few dashes to tell
    """
    found = np.full(lines.d.shape, np.nan)
    if markings is None:
        return found
    dashed = np.array([name == "dashed" for name in lines.names] + [False])[lines.drawn] & np.isfinite(lines.d)
    rows = (markings.road == road) & markings.keep & np.isin(markings.kind.astype(str), LINE_KINDS) & np.isfinite(markings.extent[:, 0])
    first, last, low, high = markings.extent[rows].T
    station = np.rint(((first + last) / 2 - lines.s[0]) / STATION_STEP).astype(int)
    inside = (station >= 0) & (station < len(lines.s))
    station, length, middle = station[inside], (last - first)[inside], ((low + high) / 2)[inside]
    for row, d, on in zip(found, lines.d, dashed):
        edges = np.flatnonzero(np.diff(np.r_[False, on, False].astype(int)))
        with np.errstate(invalid="ignore"):
            beside = on[station] & (np.abs(d[station] - middle) < BESIDE)
        for begin, end in zip(edges[::2], edges[1::2]):
            own = length[beside & (station >= begin) & (station < end)]
            if len(own) >= MIN_DASHES:
                row[begin:end] = np.percentile(own, FULL_DASH)
    return found
