"""Heights of driving lines: the road's own."""

import numpy as np
from scipy.ndimage import gaussian_filter1d, median_filter

from ..parallel import in_order
from ..survey.points import UNIT
from ..survey.sorting import order_by
from .boundaries import STEP

REACH = 0.3        # m either side of the driving line
LEAST_POINTS = 3
SMOOTHING = 2.0    # m: a car does not follow a pothole
WINDOW = 20.0      # m of road points in memory at a time


def road_heights(road_points, road, s, tracks):
    """Median height of road points within 0.3 m of the places along lanes.

    Parameters
    ----------
    road_points : RoadPoints; every point is read once for all lanes
    road : number
    s : (K,) grid stations
    tracks : list of Track

    Returns
    -------
    list of (N,) z, NaN where there are fewer than 3 points, one array per track
    """
    found = [np.full(len(track), np.nan) for track in tracks]
    size = int(WINDOW / STEP)

    def of_window(first):
        last = min(first + size, len(s)) - 1
        inside = [(k, max(first, track.first), min(last, track.last)) for k, track in enumerate(tracks)]
        inside = [row for row in inside if row[1] <= row[2]]
        points = road_points.window(road, s[first] - STEP / 2, s[last] + STEP / 2) if inside else ()
        if not len(points):
            return []
        return [(k, a - tracks[k].first, _medians(points.records, s[a:b + 1], tracks[k].d[a - tracks[k].first:b - tracks[k].first + 1]))
                for k, a, b in inside]

    for heights in in_order(of_window, range(0, len(s), size)):
        for k, first, z in heights:
            found[k][first:first + len(z)] = z
    return found


def _medians(records, s, d):
    offset = records["d"]
    low, high = np.floor((np.nanmin(d) - REACH) / UNIT), np.ceil((np.nanmax(d) + REACH) / UNIT)
    near = np.flatnonzero((offset >= low) & (offset <= high))
    cell = np.rint((records["s"].take(near) * UNIT - s[0]) / STEP).astype(np.int32)
    inside = (cell >= 0) & (cell < len(s))
    inside[inside] &= np.abs(offset.take(near[inside]) * UNIT - d[cell[inside]]) <= REACH
    cell, z = cell[inside], records["z"].take(near[inside])
    order = order_by(z, cell)
    cell, pz = cell[order], z[order] * UNIT
    begin, end = (np.searchsorted(cell, np.arange(len(s)), side) for side in ("left", "right"))
    count = end - begin
    found = np.full(len(s), np.nan)
    enough = count >= LEAST_POINTS
    lower, upper = begin + (count - 1) // 2, begin + count // 2
    found[enough] = (pz[lower[enough]] + pz[upper[enough]]) / 2
    return found


def line_heights(lines, first, d):
    """(N,) height between the marking lines (or beside them) at offsets d from grid station `first` on."""
    window = slice(first, first + len(d))
    z, at = lines.z[:, window], lines.d[:, window]
    known = np.isfinite(z) & np.isfinite(at)
    left = np.where(known & (at >= d), at - d, np.inf)
    right = np.where(known & (at < d), d - at, np.inf)
    i, j = left.argmin(0), right.argmin(0)
    columns = np.arange(len(d))
    a, b = left[i, columns], right[j, columns]
    za, zb = z[i, columns], z[j, columns]
    with np.errstate(invalid="ignore"):
        between = (za * b + zb * a) / (a + b)
    return np.where(np.isfinite(a) & np.isfinite(b), between, np.where(np.isfinite(a), za, np.where(np.isfinite(b), zb, np.nan)))


def smooth_heights(z):
    """Gaps closed along the lane, stray medians taken out, the rest smoothed; NaN only if all is."""
    known = np.isfinite(z)
    if not known.any():
        return z
    rows = np.arange(len(z))
    z = np.interp(rows, rows[known], z[known])
    z = median_filter(z, size=min(7, len(z)), mode="nearest")
    # slopes go on beyond the ends
    pad = min(int(4 * SMOOTHING / STEP), len(z) - 1)
    if pad < 1:
        return z
    head, tail = 2 * z[0] - z[1:pad + 1][::-1], 2 * z[-1] - z[-pad - 1:-1][::-1]
    return gaussian_filter1d(np.r_[head, z, tail], SMOOTHING / STEP)[pad:pad + len(z)]


def lane_heights(lines, road_points, road, tracks):
    """Local z along every lane, (N,) each: from road points where there are any, else from the marking lines beside it."""
    measured = road_heights(road_points, road, lines.s, tracks) if road_points is not None else [None] * len(tracks)
    return [_height(z, line_heights(lines, track.first, track.d)) for z, track in zip(measured, tracks)]


def _height(measured, painted):
    if measured is None:
        return smooth_heights(painted)
    both = np.isfinite(measured) & np.isfinite(painted)
    # where the road was not scanned the lines' height serves, shifted to what the road says nearby
    if both.any():
        rows = np.arange(len(measured))
        painted = painted + np.interp(rows, rows[both], (measured - painted)[both])
    return smooth_heights(np.where(np.isfinite(measured), measured, painted))
