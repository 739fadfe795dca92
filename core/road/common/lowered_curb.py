"""Lowered curb: places in the gaps of a main curb where the ground still steps up on the curb's own line.

At drives and crossings a curb is lowered to two or three centimetres. A profile has a few points of such a face, and whether it shows a step depends on
a millimetre. The ground cells of a row show it surely: the lines through the road before the curb and through the ground behind it are apart where the
curb is. Their distance is taken along the line that leads from the curb before a gap to the curb behind it. The median of some rows counts. It must
stand above what the same rows show on the road beside the curb, where nothing steps. Across the mouth of a street, and behind a curb that leaves its
line for a bulb-out, the two lines are one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...common.arrays import mask_runs, stretch_of
from ...curves.robust import MAD_TO_SIGMA
from ...survey.frame.road import Road
from ..edges.fit import without_outliers
from ..surface.ground_grid import known_median
from ..weights import CURBS
from .tracking import line_across

if TYPE_CHECKING:
    from ..surface.road_look import SideLook


def lowered_points(rows: list[dict], road: Road, look: SideLook) -> list[dict]:
    """Places of lowered curb between the curb points of one side of a road.

    rows : of the curb points, dicts as of `SideChains.points`
    look : SideLook of the side

    Returns a list of dict like `rows`, one for each row of ground cells that shows the step
    """
    points = np.array([(row["fields"]["chain"], row["s"], row["u"], row["fields"]["height"], *road.to_map(row["s"], look.sign * row["u"]))
                       for row in rows if row["fields"]["part"] == "bottom"],
                      dtype=[("chain", int), *((name, float) for name in ("s", "d", "height", "x", "y"))])
    points = without_outliers(np.sort(points, order="s"))
    s = np.ascontiguousarray(points["s"])
    gaps = np.diff(s)
    found = []
    for k in np.flatnonzero((gaps > CURBS.max_joined_gap) & (gaps <= CURBS.max_hidden_gap)):
        turn, line, axes = line_across(points, s, k)
        full = points["height"][stretch_of(s, s[k] - CURBS.line_fit_length, s[k + 1] + CURBS.line_fit_length)].max()
        if line is not None and turn <= CURBS.max_lowered_turn:
            stations, offsets = line.between(look.row_size, meets=False)
            if axes == "xy":
                stations, offsets = road.locate(stations, offsets)
                offsets = look.sign * offsets
            found += _seen_between(points[k:k + 2], full, stations, offsets, look)
    return found


def _seen_between(ends, full, stations, offsets, look):
    """The places in one gap.

    ends : (2,) points before and after it; full : m, height of the curb about it
    stations, offsets : (N,) m, of places on the line across, outward
    """
    (first, last), order = ends["s"], np.argsort(stations)
    s = look.row_size * (np.arange(np.floor(first / look.row_size), np.ceil(last / look.row_size)) + 0.5)
    s = s[(s > first) & (s < last)]
    u = np.interp(s, stations[order], offsets[order])
    step, height, bottom = look.step_at(s, u)
    noise = MAD_TO_SIGMA * _median_about(np.abs(look.step_at(s, u - CURBS.road_beside)[0])) / np.sqrt(CURBS.lowered_rows)
    with np.errstate(invalid="ignore"):
        shown = _median_about(step) >= np.maximum(CURBS.least_lowered_step, CURBS.significant_sigmas * noise)
        lowered = shown & (step > 0.0) & (height > 0.0) & (height <= full)
    runs = [(a, b) for a, b in mask_runs(lowered) if b - a >= CURBS.min_piece_steps]
    # one after the other from the curb before the gap, and from that behind it
    from_first, from_last = (_reached(runs[::way], s, tip) for way, tip in ((1, first), (-1, last)))
    return [dict(s=float(s[k]), u=float(u[k]), h=float(bottom[k]),
                 fields=dict(status="bridged", height=round(float(height[k]), 4), part="bottom"))
            for run in sorted({*from_first, *from_last}) for k in range(*run)]


def _median_about(step):
    """(N,) median of the rows about each one, NaN where too few of them were seen."""
    rows = np.lib.stride_tricks.sliding_window_view(np.pad(step, CURBS.lowered_rows // 2, constant_values=np.nan), CURBS.lowered_rows)
    return np.where(np.isfinite(rows).sum(1) >= CURBS.min_piece_steps, known_median(rows, 1), np.nan)


def _reached(runs, s, tip):
    """Those of the runs of rows, in order, that lead on from a place at station `tip`, m, or from the run before."""
    for number, (a, b) in enumerate(runs):
        begin, end = sorted((s[a], s[b - 1]), key=lambda at: abs(at - tip))
        if abs(begin - tip) > CURBS.max_joined_gap:
            return runs[:number]
        tip = end
    return runs
