"""Strands of lines that few tracks of the scan met: each track shows such a line at one place of its width."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...common.parallel import check_cancelled
from ...curves.robust import median, percentiles
from ...survey.store.records import COORDINATE_SCALE
from ..objects.classify import LINE_KINDS
from ..objects.shape import middle_line
from .strands import MAX_BIN_STEP, MIN_STRAND_LENGTH, PLACE_STEP_UNITS, RUN_BIN_UNITS, Strand, trace_strands

if TYPE_CHECKING:
    from ...survey.store.columns import Columns

FEW_TRACKS = 0.20           # m across the road between tracks of the scan: of a line, which is 0.10 to 0.30 m broad, one or two meet it
LONGEST_HOLE_UNITS = MAX_BIN_STEP * RUN_BIN_UNITS   # of wear in one strand


def painted_strands(records: Columns, rank: np.ndarray) -> list[Strand]:
    """Strands of painted line: traced place by place where points lie close together, else along the middle line of their marking.

    Parameters
    ----------
    records : N points with `cluster` and `spacing`
    rank : (N,) class of each point as `line_paint` gives it

    Returns
    -------
    list of Strand, by station
    """
    if not len(records):
        return []
    of = records["cluster"]
    # most points of the marking, which is a line
    apart = (records["spacing"] >= FEW_TRACKS * 1e3) & (rank < len(LINE_KINDS))
    sparse = (2 * np.bincount(of[apart], minlength=int(of.max()) + 1) > np.bincount(of))[of]
    few = np.flatnonzero(sparse)
    check_cancelled()
    few = few[np.lexsort((records["s"][few], of[few]))]
    found = trace_strands(records[~sparse], rank[~sparse]) if len(few) else trace_strands(records, rank)
    along = records["s"][few]
    new = np.r_[True, (np.diff(of[few]) != 0) | (np.diff(along) > LONGEST_HOLE_UNITS)] if len(few) else np.empty(0, bool)
    bounds = np.append(np.flatnonzero(new), len(few))
    columns = [records[name][few] for name in ("s", "d", "z", "spacing")]
    for a, b in zip(bounds[:-1].tolist(), bounds[1:].tolist()):
        if (along[b - 1] - along[a]) * COORDINATE_SCALE >= MIN_STRAND_LENGTH:
            s, d, z, spacing = (values[a:b] for values in columns)
            found.append(_strand(s, d, z, spacing, LINE_KINDS[int(rank[few[a]])]))
    return sorted(found, key=lambda strand: (strand.first, strand.d[0]))


def _strand(along, across, height, spacing, kind):
    """The Strand of the points of one marking, by station; lengths in units, the spacing in mm."""
    nodes, offsets = middle_line(along, across, median(spacing) * 1e-3)
    if len(nodes) < 3:
        # too short to be followed: straight
        nodes = along[[0, -1]]
        offsets = np.polyval(np.polyfit(along - along[0], across, 1), nodes - along[0])
    starts = np.flatnonzero(np.r_[True, np.diff(along // PLACE_STEP_UNITS) != 0])
    count = np.diff(np.append(starts, len(along)))
    s, z = (np.add.reduceat(values, starts, dtype=np.int64) / count for values in (along, height))
    low, high = percentiles((across - np.interp(along, nodes, offsets)) * COORDINATE_SCALE, (2.5, 97.5))
    first, last = (float(along[k]) * COORDINATE_SCALE for k in (0, -1))
    return Strand(first, last, s * COORDINATE_SCALE, np.interp(s, nodes, offsets) * COORDINATE_SCALE, z * COORDINATE_SCALE, count.astype(float),
                  (high - low) / 0.95, {kind: last - first})
