"""How long the dashes of lines are, from the markings that lie on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...survey.frame.row_table import RowTable
from ..objects.classify import LINE_KINDS
from .sections import STATION_STEP, CrossSections

if TYPE_CHECKING:
    from ..objects.marking_objects import MarkingObjects

BESIDE = 0.15        # m between the middle of a dash and its line
FULL_DASH = 75       # percent: of the dashes of a run those that are not worn; wear only ever shortens them
MIN_DASHES = 4       # in a run: fewer may be remnants of a line that is worn away


def dash_lengths(lines: CrossSections, markings: MarkingObjects | None, road: int) -> RowTable:
    """Length of the dashes of dashed lines.

    Parameters
    ----------
    lines : CrossSections of L lines at K stations
    markings : MarkingObjects or None
    road : number of the road

    Returns
    -------
    RowTable (L, K) of metres, the same along each dashed stretch of a line; NaN where a line is not dashed, or has too few dashes to tell
    """
    found = RowTable.full(lines.d.spans, np.nan)
    if markings is None:
        return found
    dashed = np.array([name == "dashed" for name in lines.names] + [False])[lines.drawn.values] & np.isfinite(lines.d.values)
    rows = (markings.road == road) & markings.keep & np.isin(markings.kind.astype(str), LINE_KINDS) & np.isfinite(markings.extent[:, 0])
    first, last, low, high = markings.extent[rows].T
    station = np.rint(((first + last) / 2 - lines.s[0]) / STATION_STEP).astype(int)
    inside = (station >= 0) & (station < len(lines.s))
    order = np.flatnonzero(inside)
    order = order[np.argsort(station[order], kind="stable")]
    station, length, middle = station[order], (last - first)[order], ((low + high) / 2)[order]
    # runs of dashed stations of one row
    row, at = lines.d.spans.owner, lines.d.spans.station
    edges = np.flatnonzero(np.diff(np.r_[-1, np.where(dashed, row, -1), -1]))
    for begin, end in zip(edges[:-1].tolist(), edges[1:].tolist()):
        if not dashed[begin]:
            continue
        near = slice(*np.searchsorted(station, [at[begin], at[end - 1] + 1]))
        own = length[near][np.abs(lines.d.values[begin:end][station[near] - at[begin]] - middle[near]) < BESIDE]
        if len(own) >= MIN_DASHES:
            found.values[begin:end] = np.percentile(own, FULL_DASH)
    return found
