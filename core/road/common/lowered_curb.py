"""Lowered curb: places in the gaps of a main curb where the ground still steps up on the curb's own line.

At drives and crossings a curb is lowered to two or three centimetres. A profile has few points of such a face, and whether it shows a step
depends on a millimetre. The ground cells of a row show it surely: the lines through the road before the curb and through the ground behind it
are apart where the curb is. Their distance is taken along the line that leads from the curb before a gap to the curb behind it. The median of some
rows counts. It must stand above what the same rows show on the road beside the curb, where nothing steps. Across the mouth of a street, and behind a
curb that leaves its line for a bulb-out, the two lines are one. Where no line leads across, nothing goes on: at a corner a lowered curb bends, and
no line of its own says how. But it goes straight on to the place where a corner begins.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ...common.arrays import mask_runs, stretch_of
from ...survey.frame.road import Road
from ..weights import CURBS
from .tracking import IN_LINE_TURN, is_lowered, line_across, without_outliers

if TYPE_CHECKING:
    from ..surface.road_look import RoadLook


def lowered_points(rows: list[dict], road: Road, look: RoadLook) -> list[dict]:
    """Places of lowered curb between the curb points of one side of a road.

    rows : of the curb points, dicts as of `points_of_rows`
    look : RoadLook of the side

    Returns a list of dict like `rows`, one for each row of ground cells that shows the step
    """
    bottoms = [(row["fields"]["chain"], row["s"], row["u"], row["fields"]["height"], 0.0, 0.0) for row in rows if row["fields"]["part"] == "bottom"]
    points = np.array(bottoms, dtype=[("chain", int), *((name, float) for name in ("s", "d", "height", "x", "y"))])
    points["x"], points["y"] = road.to_map(points["s"], look.sign * points["d"])
    points = without_outliers(np.sort(points, order="s"))
    s = np.ascontiguousarray(points["s"])
    # where a curb is low its place is known to some centimetres only
    full = points[~is_lowered(points, s)]
    gaps = []
    for k in np.flatnonzero(np.diff(s) > CURBS.max_joined_gap):
        before, behind = s[k:k + 2]
        near = full[stretch_of(full["s"], before - CURBS.line_fit_length, behind + CURBS.line_fit_length)]
        line = _line_across(near, before, behind, road, look)
        if line is not None:
            gaps.append((before, behind, line, near["height"].max()))
    return [row for gap, seen in zip(gaps, _seen_in_gaps(gaps, look) if gaps else ()) for row in _seen_between(*gap[:2], *seen)]


def _line_across(near, before, behind, road, look):
    """Function from stations to outward offsets of the line across a gap; None where the curb on both sides turns off it."""
    k = int(np.searchsorted(near["s"], before, side="right")) - 1
    if not 0 <= k < len(near) - 1 or behind - before > CURBS.max_hidden_gap:
        return None
    lengths = near["s"][k] - near["s"][0], near["s"][-1] - near["s"][k + 1]
    # of less curb the direction is not known, and a bend through a single place may lead anywhere
    bends = min(lengths) >= CURBS.min_bend_length
    limit = CURBS.max_lowered_turn if bends else IN_LINE_TURN
    turn, line, axes = line_across(near, np.ascontiguousarray(near["s"]), k, 1 + bends)
    if turn > limit and not bends and max(lengths) >= CURBS.min_bend_length:
        # where the shorter end turns off at once, its tip still lies straight on from the other; that is surer the shorter the gap is
        near, k = (near[:k + 2], k) if lengths[0] > lengths[1] else (near[k:], 0)
        limit *= max(lengths) / (max(lengths) + 2.0 * (behind - before))
        turn, line, axes = line_across(near, np.ascontiguousarray(near["s"]), k, 1)
    if line is None or turn > limit:
        return None
    stations, offsets = line.between(look.cells.row_size)
    if axes == "xy":
        stations, offsets = road.locate(stations, offsets)
        offsets = look.sign * offsets
    order = np.argsort(stations)
    return partial(np.interp, xp=stations[order], fp=offsets[order])


def _seen_in_gaps(gaps, look):
    """Of each gap stations and offsets of the middles of rows of ground cells on its line, and what `RoadLook.steps_up` gives of these.

    gaps : at least one; of each the stations of both ends, the function from stations to offsets that leads across, and the height of the curb
        about it, m
    """
    places, size = [], look.cells.row_size
    for first, last, offsets, full in gaps:
        s = size * (np.arange(np.floor(first / size), np.ceil(last / size)) + 0.5)
        s = s[(s > first) & (s < last)]
        # no median of some rows reaches from one gap into the next
        places.append(np.pad([s, offsets(s), np.full(len(s), full)], [(0, 0), (0, CURBS.lowered_rows)], constant_values=np.nan))
    s, u, full = np.concatenate(places, axis=1)
    seen, begins = (s, u, *look.steps_up(s, u, full)), np.cumsum([0, *(columns.shape[1] for columns in places)])
    return [[values[a:b - CURBS.lowered_rows] for values in seen] for a, b in zip(begins, begins[1:])]


def _seen_between(first, last, s, u, lowered, height, bottom):
    """The places between two stations, m, at which the ground steps, as far as they lead on from the curb at either of them.

    The others are as of `_seen_in_gaps`.
    """
    runs = np.array([run for run in mask_runs(lowered) if np.ptp(run) >= CURBS.min_piece_steps], int).reshape(-1, 2)
    parted = np.r_[s[runs[:, 0]], last] - np.r_[first, s[runs[:, 1] - 1]] > CURBS.max_joined_gap
    reached = ~(np.logical_or.accumulate(parted)[:-1] & np.logical_or.accumulate(parted[::-1])[-2::-1])
    return [dict(s=float(s[k]), u=float(u[k]), h=float(bottom[k]),
                 fields=dict(status="bridged", height=round(float(height[k]), 4), part="bottom"))
            for run in runs[reached] for k in range(*run)]
