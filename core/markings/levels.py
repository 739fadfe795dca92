"""The level of asphalt and the threshold above it at any place of a road, between bins and windows."""

import numpy as np

from .gutters import gutter_cells
from .patches import patch_level
from .thresholds import WIDEST, background

BRIGHT = 2.5      # spreads: what is brighter is no background


def flatten(brightness, median, spread, rims):
    """Brightness in spreads above the asphalt about each cell, and the cells of gutters.

    rims : distances inwards, from the rim of what was scanned and from the road's edges
    """
    z = (brightness - median) / spread
    gutter = np.logical_or.reduce([gutter_cells(z, rim) for rim in rims])
    with np.errstate(invalid="ignore"):
        even = (z < BRIGHT) & (z > -2 * BRIGHT) & ~gutter
    z = z - background(z, even)
    return z - patch_level(z, BRIGHT), gutter


def asphalt_profile(bins, offsets):
    """Median and spread of asphalt at (N,) offsets, between the middles of one window's bins."""
    middles = [b.middle for b in bins]
    return (np.interp(offsets, middles, [b.median for b in bins]).astype(np.float32),
            np.interp(offsets, middles, [b.spread for b in bins]).astype(np.float32))


class Levels:
    """Asphalt and threshold at any place, between the bins of all windows.

    windows : dict of window number to list of (Bin, Split)
    window_length : m; window k reaches from k to k + 1 times that
    """

    def __init__(self, windows, window_length, settings):
        self.windows, self.window_length = windows, window_length
        self.settings = settings
        self.numbers = np.array(sorted(windows))
        self._limits = {w: self._thresholds(w) for w in windows}

    def _thresholds(self, w):
        """Threshold in z of each bin: Otsu's where there is paint, else the neighbours', else the highest."""
        near = [split for n in (w - 1, w, w + 1) for _, split in self.windows.get(n, ()) if split.accepted]
        limits = []
        for _, split in self.windows[w]:
            value = split.threshold
            if not split.accepted:
                beside = [other.threshold for other in near if abs(other.middle - split.middle) < WIDEST]
                value = float(np.median(beside)) if beside else self.settings.alone
            limits.append(float(np.clip(value, self.settings.lowest, self.settings.highest)))
        return limits

    def at(self, grid):
        """median, spread, scale, threshold as (rows, columns) arrays: a cell is bright beyond threshold * scale."""
        numbers = self.numbers
        position = grid.stations() / self.window_length - 0.5
        before = np.clip(np.searchsorted(numbers, np.floor(position), side="right") - 1, 0, len(numbers) - 1)
        after = np.minimum(before + 1, len(numbers) - 1)
        gap = np.maximum(numbers[after] - numbers[before], 1)
        share = np.clip((position - numbers[before]) / gap, 0.0, 1.0)[:, None].astype(np.float32)
        needed = np.unique(np.r_[before, after])
        profiles = np.stack([self._profile(numbers[k], grid.offsets()) for k in needed])
        a, b = np.searchsorted(needed, before), np.searchsorted(needed, after)
        return [(1 - share) * profiles[a, q] + share * profiles[b, q] for q in range(4)]

    def _profile(self, w, offsets):
        pairs = self.windows[w]
        middles = [b.middle for b, _ in pairs]
        columns = ([b.median for b, _ in pairs], [b.spread for b, _ in pairs], [split.spread for _, split in pairs], self._limits[w])
        return np.stack([np.interp(offsets, middles, column) for column in columns]).astype(np.float32)
