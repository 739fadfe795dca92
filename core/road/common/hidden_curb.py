"""Hidden curb: places in the gaps of a main curb where something stands in front of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from .curb_points import CurbPoints, curb_points_at
from .occlusion import HIDDEN_POINT_SPACING, OcclusionGrid
from .pseudo_scanlines import expand_ranges
from .sides import SIDE_SIGNS, OutermostTrack, expected_height

if TYPE_CHECKING:
    from ...survey.open_survey import Survey

MIN_HIDDEN_GAP = 2.0          # m between curb points from which one may be hidden: as far apart as points of automatic blocks lie
MAX_HIDDEN_GAP = 30.0         # m between curbs within which hidden curb is reported


def hidden_points(measured: np.ndarray, occlusion: OcclusionGrid, track: OutermostTrack) -> list[dict]:
    """Places in the gaps between curb points where something hides the curb.

    Parameters
    ----------
    measured : (N, 3) m, station, outward offset and height of the measured points above the expected road
    occlusion : OcclusionGrid of the side
    track : OutermostTrack of the side

    Returns
    -------
    list of dict: s, u, h as above, and `fields`, what else is known of the point
    """
    if len(measured) < 2:
        return []
    measured = measured[np.argsort(measured[:, 0], kind="stable")]
    start, end = measured[:-1, 0], measured[1:, 0]
    wide = (end - start <= MAX_HIDDEN_GAP) & (end - start > MIN_HIDDEN_GAP)
    # counted from the gap's own ends: where station 0 lies does not matter
    parts = np.where(wide, np.rint((end - start) / HIDDEN_POINT_SPACING), 0).astype(np.int64)
    gap, number = expand_ranges(np.zeros(len(parts), np.int64), parts)
    s = start[gap] + (number + 0.5) * ((end - start) / np.maximum(parts, 1))[gap]
    u, h = (np.interp(s, measured[:, 0], measured[:, k]) for k in (1, 2))
    hidden = occlusion.hidden(s, u, h, track(s))
    return [dict(s=float(a), u=float(b), h=float(c), fields=dict(status="occluded"))
            for a, b, c in zip(s[hidden], u[hidden], h[hidden])]


def hidden_beside(pieces: CurbPoints, main: Mapping[str, np.ndarray], beside: Mapping[str, OcclusionGrid], survey: Survey, road: int) -> CurbPoints:
    """Hidden places in the gaps next to pieces of main curb that were found later than the others.

    Parameters
    ----------
    pieces : CurbPoints of the main curb of one road, found later
    main : side -> (M, 4) points of the main curb that were known before: station, offset, height above the expected road in m, and
        1 where it was measured and 0 where it is hidden
    beside : side -> OcclusionGrid of the road
    survey : Survey
    road : number of the road

    Returns
    -------
    CurbPoints of status occluded; none where a place is known to be hidden already
    """
    found = [CurbPoints.none(pieces.crs)]
    for side, sign in SIDE_SIGNS.items():
        own = pieces[pieces.side == side]
        if not len(own) or side not in beside:
            continue
        later = np.c_[own.station, sign * own.offset, own.z - expected_height(survey, road, own.station)]
        known = main[side] * (1, sign, 1, 1)
        measured = np.concatenate([later, known[known[:, 3] > 0, :3]])
        order, reported = np.argsort(measured[:, 0], kind="stable"), np.r_[-np.inf, np.sort(known[known[:, 3] == 0, 0]), np.inf]
        ends, rows = measured[order, 0], []
        for row in hidden_points(measured, beside[side], OutermostTrack(survey.frame, road, sign)):
            k = np.searchsorted(ends, row["s"])
            at = np.searchsorted(reported, row["s"])
            if (order[k - 1:k + 1] < len(later)).any() and np.abs(reported[at - 1:at + 1] - row["s"]).min() > 0.5 * HIDDEN_POINT_SPACING:
                rows.append(row)
        s, u, h = (np.array([row[name] for row in rows], float) for name in ("s", "u", "h"))
        places = survey.frame.to_map(road, s, sign * u, h + expected_height(survey, road, s))
        found.append(curb_points_at(survey.frame, road, places, [row["fields"] for row in rows], side=side, station=s, offset=sign * u))
    return CurbPoints.join(found, pieces.crs)
