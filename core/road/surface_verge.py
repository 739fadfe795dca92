"""Where a road without a curb ends: its edge towards verge, ditch or yard, told from height, roughness and brightness."""

import warnings

import numpy as np

from ..parallel import in_order
from ..progress import Progress
from .surface_cells import Cells, ground_cells

ALONG, ACROSS = 1.0, 0.1   # m, cells of the profile across the side
STRETCH = 5                # rows that make one profile: 5 m
WINDOW = 20                # rows read at a time
SURE = 1.2                 # m beside the track that are road in any case: the vehicle drove there
PERSISTS = 4               # cells over which a change must last
STEP, STEP_NOISE = 0.035, 2.0  # m, and times the noise, off the road's height
ROUGHER, ROUGH_FLOOR = 1.6, 0.0025  # times the road's roughness, and m on top
TURN = 0.10                # change of tilt that begins a bank or a ditch
EMPTY = 5                  # cells without a point at which the road is lost sight of
STRIP = 8                  # cells before the verge in which a strip of gravel is looked for
INSIDE = 6                 # cells of road that such a strip is compared with
BRIGHTER, STANDS_OUT = 0.03, 4.0  # share, and times the scatter, by which its brightness differs
INSET = 0.05               # m kept off a limit: too wide a road takes verge for paint, too narrow a one loses nothing
SMOOTH = 2                 # profiles either side of the running median


def grown_offsets(survey, road, cells, height, noise, sign, track, missing, max_width, progress=Progress()):
    """How far the road reaches on a side where no edge says so.

    Profiles of 5 m are followed outward from the track. The road ends where for
    0.4 m the ground is off its height, tilts away, or is rougher than the road
    so far; a strip of another brightness before that (gravel along the asphalt)
    is left out too.

    Parameters
    ----------
    cells, height, noise : of the followed road
    sign : 1 for the left side, -1 for the right
    track : (rows,) offset of the outermost track on that side
    missing : (rows,) where an offset is needed
    max_width : m from the track

    Returns
    -------
    (rows,) offsets
    """
    stations = cells.stations
    rows_per_window = int(round(WINDOW / cells.row_size))
    first = int(np.floor(stations[0] / ALONG))
    windows = [first + WINDOW * k for k in range(int(np.ceil(len(stations) / rows_per_window)))
               if missing[k * rows_per_window:(k + 1) * rows_per_window].any()]

    def profiles(first_row):
        points = survey.window(road, first_row * ALONG, (first_row + WINDOW) * ALONG)
        fine = ground_cells(points, first_row, WINDOW, -cells.first_column * cells.column_size,
                            lambda s: survey.road_height(road, s), ALONG, ACROSS)
        return _profile_ends(fine, cells, height, noise, sign, track, max_width)

    at, ends = [], []
    for found in in_order(profiles, windows, progress):
        at += [s for s, _ in found]
        ends += [end for _, end in found]
    known = np.isfinite(ends)
    if not known.any():
        return track + sign * max_width
    at, ends = np.array(at)[known], _running_median(np.array(ends)[known], SMOOTH)
    return sign * (np.interp(stations, at, ends) - INSET)


def _running_median(values, reach):
    padded = np.pad(values, reach, mode="edge")
    return np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1), axis=1)


def _profile_ends(fine, cells, height, noise, sign, track, max_width):
    """(station, outward distance from the reference line) of each profile of a window; NaN where nothing is seen."""
    u = sign * fine.offsets
    outward = np.argsort(u)[np.sort(u) > 0]
    off = fine.height - _height_at(cells, height, fine.stations, fine.offsets)
    found = []
    for row in range(0, WINDOW, STRETCH):
        rows = slice(row, row + STRETCH)
        station = (fine.first_row + row + STRETCH / 2) * ALONG
        beside = sign * float(np.interp(station, cells.stations, track))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # cells without points
            profile = Profile(u[outward], np.nanmedian(off[rows][:, outward], axis=0),
                              sign * np.nanmedian(fine.tilt[rows][:, outward], axis=0),
                              np.nanmedian(fine.rough[rows][:, outward], axis=0),
                              np.nanmedian(fine.brightness[rows][:, outward], axis=0))
        found.append((station, profile.end(beside, max_width, noise)))
    return found


def _height_at(cells, height, stations, offsets):
    """The followed road's height at the middles of finer cells."""
    row = np.clip((stations / cells.row_size - cells.first_row - 0.5), 0, len(height) - 1)
    column = np.clip(offsets / cells.column_size - cells.first_column - 0.5, 0, height.shape[1] - 1)
    i, j = np.minimum(row.astype(int), len(height) - 2), np.minimum(column.astype(int), height.shape[1] - 2)
    a, b = (row - i)[:, None], (column - j)[None, :]
    at = height[np.ix_(i, j)], height[np.ix_(i, j + 1)], height[np.ix_(i + 1, j)], height[np.ix_(i + 1, j + 1)]
    return (1 - a) * ((1 - b) * at[0] + b * at[1]) + a * ((1 - b) * at[2] + b * at[3])


class Profile:
    """Cells of ACROSS metres from the reference line outward.

    u : middles, ascending; off : height off the followed road; tilt : outward;
    rough; brightness: NaN where a cell shows nothing
    """

    def __init__(self, u, off, tilt, rough, brightness):
        self.u, self.off, self.tilt, self.rough, self.brightness = u, off, tilt, rough, brightness

    def end(self, beside, max_width, noise):
        """Distance at which the road ends, at most `max_width` beyond `beside`, the track's own distance."""
        reach = beside + max_width
        start = int(np.searchsorted(self.u, beside + SURE))
        stop = min(int(np.searchsorted(self.u, reach)), len(self.u))
        if not np.isfinite(self.off[:stop]).any():
            return np.nan
        for k in range(start, stop):
            ahead = slice(k, k + PERSISTS)
            if np.isnan(self.off[k:k + EMPTY]).all():
                return self.u[k] - ACROSS / 2
            if self._differs(k, ahead, noise):
                return self._before_strip(k)
        return reach

    def _differs(self, k, ahead, noise):
        """Whether from cell k on the ground is no longer the road's."""
        off = self.off[ahead]
        seen = np.isfinite(off)
        if seen.any() and abs(self.off[k]) > STEP + STEP_NOISE * noise \
                and (np.abs(off[seen]) > STEP + STEP_NOISE * noise).mean() > 0.7:
            return True
        inner = slice(max(k - 15, 0), k)
        rough, usual = self.rough[ahead], self.rough[inner]
        rough, usual = rough[np.isfinite(rough)], usual[np.isfinite(usual)]
        if len(rough) > 1 and len(usual) > 3:
            limit = ROUGHER * np.median(usual) + ROUGH_FLOOR
            if self.rough[k] > limit and (rough > limit).mean() > 0.7:
                return True
        return self._turns(k)

    def _turns(self, k):
        """Whether the ground tilts away from here on, over 0.5 m, against the metre before."""
        after, before = self.off[k:k + 6], self.off[max(k - 10, 0):k]
        a, b = np.isfinite(after), np.isfinite(before)
        if a.sum() < 4 or b.sum() < 5:
            return False
        slope = np.polyfit(self.u[k:k + 6][a], after[a], 1)[0] - np.polyfit(self.u[max(k - 10, 0):k][b], before[b], 1)[0]
        return abs(slope) > TURN

    def _before_strip(self, k):
        """The near side of a strip of another brightness that ends at cell k, or k itself."""
        best, at = 0.0, k
        for first in range(max(k - STRIP, INSIDE), k - 1):
            inside, strip = self.brightness[first - INSIDE:first], self.brightness[first:k]
            inside, strip = inside[np.isfinite(inside)], strip[np.isfinite(strip)]
            if len(inside) < 4 or len(strip) < 2:
                continue
            level = np.median(inside)
            scatter = 1.4826 * np.median(np.abs(inside - level))
            differs = strip - level
            limit = max(BRIGHTER * level, STANDS_OUT * scatter)
            # all of the strip, one way
            least = min(differs.min(), differs.max(), key=abs) if differs.min() * differs.max() > 0 else 0.0
            if abs(least) > limit and abs(least) / limit > best:
                best, at = abs(least) / limit, first
        return self.u[at] - ACROSS / 2
