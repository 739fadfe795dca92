"""Crowded points thinned before anything else is done with them.

Of level ground a few points of a cell say what all of them would; a curb's face, a
hedge, and whatever a noisy scanner saw, keep theirs.
"""

import threading
from dataclasses import dataclass

import numpy as np

from ...common.order_statistics import decimate_cells
from ...survey.store.records import COORDINATE_SCALE
from ...survey.store.spill_file import SpillFile

# The strip about a track in which the ground is level beyond doubt: no curb is there, and nothing that hides one.

MAX_STRIP_OFFSET = 8.0        # m from the reference line within which the strip lies
MIN_LEVEL_POINTS = 4           # points of a cell that tell whether it is level
MAX_STEP_WIDTH = 0.20      # m across within which a step rises, one that runs askew, too: its height shows in the means of cells so far apart
LEVEL_STEP_SHARE = 0.4        # of the least step that such means may differ
MAX_STRIP_STD = 0.016      # m, standard deviation of heights in a cell, beyond which it is not level
MIN_UNEVEN_NEIGHBOURS = 5         # of 15 cells that a step changes: a bird, a drop of rain or a ghost lies in one
BLIND_HALF_WIDTH = 1.5        # m beside the track that may not have been seen: scanners do not look beneath their vehicle
NO_OFFSET = 1 << 28  # 0.1 mm: farther than any offset
MIN_STRIP_WIDTH = 1.0    # m: leaving a narrower strip out is not worth it


@dataclass
class LevelStrip:
    """Offsets between which the ground of profiles is level, in 0.1 mm; low > high where it is not.

    first, width : number of the first profile, metres of road of each
    low, high : (P,) int32
    height : (P,) mean local z of the ground there, metres
    """

    first: int
    width: float
    low: np.ndarray
    high: np.ndarray
    height: np.ndarray

    @classmethod
    def none(cls, first, count, width):
        return cls(first, width, np.full(count, NO_OFFSET, np.int32), np.full(count, -(NO_OFFSET), np.int32), np.zeros(count))

    def within(self, across, along):
        """The part that lies `across` metres inside and whose ends `along` metres up and down the road do, too."""
        around = int(np.ceil(along / self.width))

        def widest(values):
            return np.lib.stride_tricks.sliding_window_view(values, 2 * around + 1).max(axis=1)

        margin = int(round(across / COORDINATE_SCALE))
        low, high = widest(self.low) + margin, -widest(-self.high) - margin
        narrow = high - low < MIN_STRIP_WIDTH / COORDINATE_SCALE
        own = slice(around, len(self.height) - around)
        return LevelStrip(self.first + around, self.width, np.where(narrow, NO_OFFSET, low).astype(np.int32),
                          np.where(narrow, -(NO_OFFSET), high).astype(np.int32), self.height[own])

    def holds(self, s, d):
        """(N,) bool: is a point in the strip? Stations s (ascending) and offsets d in 0.1 mm."""
        edges = np.ceil((self.first + np.arange(1, len(self.low))) * (self.width / COORDINATE_SCALE) - 0.5).astype(np.int32)
        counts = np.diff(np.searchsorted(s, edges), prepend=0, append=len(s))
        inside = d > np.repeat(self.low, counts)
        inside &= d < np.repeat(self.high, counts)
        return inside

    def at(self, s):
        """Low and high offset, metres, and height at (N,) stations."""
        k = np.clip(np.floor(np.asarray(s) / self.width).astype(np.int64) - self.first, 0, len(self.low) - 1)
        return self.low[k] * COORDINATE_SCALE, self.high[k] * COORDINATE_SCALE, self.height[k]


def find_level_strip(track, held, total, squares, size, least):
    """How far the ground about a track is level, profile by profile.

    Parameters
    ----------
    track : (P,) offset of the vehicle's track, 0.1 mm
    held, total, squares : (P, 2, C) points of every cell, the sum of their heights in 0.1 mm, and that of the squares of
        what these lie off their mean: cells of the left and of the right side, from the reference line outward
    size : width of a cell, 0.1 mm
    least : the least step, 0.1 mm

    Returns
    -------
    (low, high, height) of a LevelStrip
    """
    half = min(int(MAX_STRIP_OFFSET / COORDINATE_SCALE) // size, held.shape[2])
    held, total, squares = (np.concatenate([v[:, 1, :half][:, ::-1], v[:, 0, :half]], axis=1) for v in (held, total, squares))
    seen = held > 0
    mean = np.where(seen, total / np.maximum(held, 1), np.nan)
    bad = seen & ((held < MIN_LEVEL_POINTS) | (squares > held * (MAX_STRIP_STD / COORDINATE_SCALE) ** 2))
    apart = max(int(round(MAX_STEP_WIDTH * 0.5 / COORDINATE_SCALE / size)), 1)
    with np.errstate(invalid="ignore"):
        bad[:, apart:-apart] |= np.abs(mean[:, 2 * apart:] - mean[:, :-2 * apart]) > LEVEL_STEP_SHARE * least
    bad &= _together(bad) >= MIN_UNEVEN_NEIGHBOURS
    own = np.clip(track // size + half, 0, 2 * half - 1).astype(np.int64)
    left, right = (_cells_from(own, sign, bad, seen, size) for sign in (1, -1))
    column = np.arange(2 * half)
    inside = (column > (own - right)[:, None]) & (column < (own + left)[:, None])
    count = (held * inside).sum(axis=1)
    known = (left > 0) & (right > 0) & (count > 0)
    low = np.where(known, (own - right + 1 - half) * size, NO_OFFSET)
    high = np.where(known, (own + left - half) * size, -(NO_OFFSET))
    return low, high, (total * inside).sum(axis=1) / np.maximum(count, 1) * COORDINATE_SCALE


def _together(bad):
    """(P, C) how many of the cells about each one are bad, of 3 profiles and 5 cells of each; the ends count for what lies beyond them."""
    wide = np.pad(bad, ((1, 1), (2, 2)), mode="edge").astype(np.uint8)
    rows = wide[:-2] + wide[1:-1] + wide[2:]
    return sum(rows[:, k:k + bad.shape[1]] for k in range(5))


def _cells_from(own, sign, bad, seen, size):
    """(P,) number of cells from the track's own to before the first in which the ground is not level or was not seen."""
    last = bad.shape[1] - 1
    away = np.arange(last + 1)
    column = own[:, None] + sign * away
    on = (column >= 0) & (column <= last)
    column = np.clip(column, 0, last)
    there = np.take_along_axis(seen, column, axis=1)
    ends = ~on | np.take_along_axis(bad, column, axis=1)
    ends |= ~there & (np.logical_or.accumulate(there, axis=1) | (away * size * COORDINATE_SCALE > BLIND_HALF_WIDTH))
    return np.argmax(ends, axis=1)

POINTS_PER_LEVEL_CELL = 12          # points of a cell that tell level ground
POINTS_PER_LEVEL_CELL_IN_PLAN = 6   # the same in plan: there are four such cells and more in one of the raster
LEVEL_CELL_LIMITS = POINTS_PER_LEVEL_CELL, POINTS_PER_LEVEL_CELL_IN_PLAN
MAX_STRIP_PROFILE_WIDTH = 0.30    # m of road of a profile: in the means of longer ones a low curb that runs askew looks like a slope
MIN_STEP_HEIGHT = 0.03      # m, the least step that is sought anywhere
LEVEL_CELL_STD = 0.008     # m, standard deviation of heights in a cell that is level, on a road that climbs as on one that does not
POINTS_PER_UNEVEN_CELL = 60       # points of any other cell: more hardly tell its layers better
MOSTLY_UNEVEN_SHARE = 0.7  # share of points in cells that are not level
STRETCH_LENGTH = 5.0    # m of road that are read at once
DECIMATION_BLOCK_POINTS = 256_000   # points that are looked through at once
MIN_DENSE_SHARE = 0.5      # share of points in crowded cells below which the others are not looked at
PROFILE_BOUND_TOLERANCE = 1e-6      # 0.1 mm: bounds between profiles are whole numbers of it but for rounding
DECIMATION_LOCKS = 16        # locks that stretches share while they are thinned, the last of them the file's
HASH_FACTORS = tuple(np.uint32(odd) for odd in (2654435761, 2246822519, 3266489917))  # large odd factors strew neighbours far apart
MAX_CELL_OFFSET = (1 << 18) - 1  # 0.1 mm from the reference line; what lies beyond is as if it lay there


class PointDecimation:
    """Which points of a survey are looked at where they crowd: decided once, for curbs along the road and curbs in plan.

    width, spacing : m; a cell is a profile long and about `spacing` wide
    least : m, a step that no level strip has (see `level_strip`)

    What is taken of a stretch is noted point by point, a bit each, in a temporary file: `close` it.
    """

    def __init__(self, survey, width, spacing, least=MIN_STEP_HEIGHT):
        self.survey, self.width, self.spacing, self.least = survey, width, spacing, least
        self._together = max(int(round(STRETCH_LENGTH / width)), 1)
        self._taken, self._uneven = {}, {}   # (road, first profile) -> {most: Stored bits}; (road, profile) -> bool
        self._strips = {}   # (road, first profile) -> {pass number: LevelStrip}
        self._turns = [threading.Lock() for _ in range(DECIMATION_LOCKS)]
        self._file = None

    def close(self):
        """Forget what was decided and give the disk space back."""
        self._taken.clear()
        self._strips.clear()
        if self._file is not None:
            self._file.close()
            self._file = None

    def decimated_points(self, road, profiles, most=POINTS_PER_LEVEL_CELL):
        """The points of profiles in runs along the road, thinned to about `most` where a cell of level ground holds more.

        Parameters
        ----------
        profiles : (first, last + 1) numbers of profiles
        most : points of one pass in such a cell, POINTS_PER_LEVEL_CELL or POINTS_PER_LEVEL_CELL_IN_PLAN; None takes all of every cell

        Yields
        ------
        Points of whole profiles in canonical order. Which of a cell are taken depends on the points of its profile alone.
        """
        for first in range(profiles[0] // self._together * self._together, profiles[1], self._together):
            start, end = max(first, profiles[0]), min(first + self._together, profiles[1])
            points = self._window(road, start, end)
            if most is not None and len(points):
                rows = self._rows(road, first, most)
                before = len(self._window(road, first, start)) if start > first else 0
                if rows is not None:
                    a, b = np.searchsorted(rows, (before, before + len(points)))
                    points = points[rows[a:b] - before]
            yield from in_pieces(points, start * self.width, self.width)

    def mostly_uneven(self, road, profile):
        """Is the ground about a profile uneven nearly everywhere? So it looks to a noisy scanner; there thinning leaves little out."""
        key = road, profile
        if key not in self._uneven:
            self._uneven[key] = _mostly_uneven(self._window(road, profile - 2, profile + 2).records, self.width, self.spacing)
        return self._uneven[key]

    def level_strip(self, road, number, profiles, across, along):
        """The LevelStrip of profiles (first, last + 1) about the track of a pass, `across` and `along` metres from where it is not level."""
        around = int(np.ceil(along / self.width))
        wide = LevelStrip.none(profiles[0] - around, profiles[1] - profiles[0] + 2 * around, self.width)
        end = wide.first + len(wide.low)
        for first in range(wide.first // self._together * self._together, end, self._together):
            self._look_at(road, first)
            strip = self._strips[road, first].get(number)
            if strip is not None:
                a, b = max(first, wide.first), min(first + self._together, end)
                for name in ("low", "high", "height"):
                    getattr(wide, name)[a - wide.first:b - wide.first] = getattr(strip, name)[a - first:b - first]
        return wide.within(across, along)

    def _window(self, road, first, last):
        return self.survey.window(road, first * self.width, last * self.width)

    def _rows(self, road, first, most):
        """Rows that are taken of the stretch which begins with profile `first`; None for all."""
        self._look_at(road, first)
        count, noted = self._taken[road, first]
        if noted[most] is None:
            return None
        bits = self._file.get(noted[most])
        return np.flatnonzero(np.unpackbits(bits, count=count).view(bool))

    def _look_at(self, road, first):
        """Decide what is taken of the stretch which begins with profile `first`, unless that was done."""
        key = road, first
        with self._turns[hash(key) % (DECIMATION_LOCKS - 1)]:
            if key not in self._taken:
                self._strips[key] = {}
                self._taken[key] = self._decided(road, first, self._strips[key])

    def _decided(self, road, first, strips):
        """Number of points, and which of them are taken for every `most`: bits in the file, None for all; `strips` are filled in."""
        points = self._window(road, first, first + self._together)
        taken, done = {most: np.ones(len(points), bool) for most in LEVEL_CELL_LIMITS}, 0
        for piece in in_pieces(points, first * self.width, self.width):
            for number, own, columns in _by_pass(piece.records):
                cells = _Cells(*columns, self.width, self.spacing)
                for most, chosen in cells.thinned().items():
                    here = taken[most][done:done + len(piece)]
                    here[slice(None) if own is None else own] = chosen
                if cells.looked_through and self.width <= MAX_STRIP_PROFILE_WIDTH:
                    strip = strips.setdefault(number, LevelStrip.none(first, self._together, self.width))
                    self._note_strip(strip, cells, self.survey.frame.passes[number])
            done += len(piece)
        return len(points), {most: None if chosen.all() else self._noted(np.packbits(chosen)) for most, chosen in taken.items()}

    def _note_strip(self, strip, cells, p):
        """Fill in the profiles of a strip that some cells are of."""
        middles = (cells.first + np.arange(cells.profiles) + 0.5) * self.width
        found = find_level_strip(np.floor(p.at_station(middles)[0] / COORDINATE_SCALE), *cells.grids(), cells.size, self.least / COORDINATE_SCALE)
        own = slice(cells.first - strip.first, cells.first - strip.first + cells.profiles)
        strip.low[own], strip.high[own], strip.height[own] = found

    def _noted(self, bits):
        with self._turns[-1]:
            if self._file is None:
                self._file = SpillFile()
        return self._file.put(bits)


def in_pieces(points, start, width):
    """Points in runs along the road of whole profiles counted from station `start`, DECIMATION_BLOCK_POINTS or so each."""
    cuts = np.arange(0, len(points), DECIMATION_BLOCK_POINTS)
    if len(cuts) > 1:
        edges = np.unique(np.floor((points.records["s"][cuts[1:]] * COORDINATE_SCALE - start) / width)) * width + start
        cuts = np.unique(np.r_[0, np.searchsorted(points.records["s"], np.ceil(edges / COORDINATE_SCALE - 0.01).astype(np.int32))])
    return [points[a:b] for a, b in zip(cuts, np.r_[cuts[1:], len(points)]) if b > a]


def _by_pass(records):
    """[(pass number, indices of its records, None for all, their columns s, d, z)]"""
    columns, numbers = [records[name] for name in ("s", "d", "z")], records["pass_number"]
    if numbers.min() == numbers.max():
        return [(int(numbers[0]), None, columns)]
    owns = [(int(number), np.flatnonzero(numbers == number)) for number in np.flatnonzero(np.bincount(numbers))]
    return [(number, own, [column.take(own) for column in columns]) for number, own in owns]


def limit_points_per_cell(place):
    """Indices of (N,) cell indices, in every cell no more than about POINTS_PER_UNEVEN_CELL, evenly spread over their order."""
    if len(place) <= POINTS_PER_UNEVEN_CELL:
        return slice(None)
    place = place - place.min()
    return slice(None) if np.bincount(place).max() <= POINTS_PER_UNEVEN_CELL else decimate_cells(place, POINTS_PER_UNEVEN_CELL)


class _Cells:
    """Points by cell: a profile long, about `spacing` wide, of one side of the road.

    s (ascending), d, z : (N,) stations, offsets and heights in 0.1 mm
    first, profiles, size : number of the first profile, count of profiles, width of a cell in 0.1 mm
    looked_through : whether the heights of all points have been looked at, which `grids` needs
    """

    def __init__(self, s, d, z, width, spacing):
        self.s, self.d, self.z = s, d, z
        bits = int(np.rint(np.log2(spacing / COORDINATE_SCALE)))
        self.size, self.half, self.looked_through = 1 << bits, (MAX_CELL_OFFSET >> bits) + 1, False
        # stations ascend, so profiles are runs of points; bounds lie off the whole units
        self.first, last = (int(np.floor((int(end) + 0.5) * COORDINATE_SCALE / width)) for end in (s[0], s[-1]))
        self.profiles = last - self.first + 1
        bounds = np.arange(self.first + 1, last + 1) * (width / COORDINATE_SCALE) - 0.5 - PROFILE_BOUND_TOLERANCE
        cuts = np.searchsorted(s, np.ceil(bounds).astype(np.int32)).tolist()
        # the two sides of a road are parted alike
        cell = np.abs(d)
        np.minimum(cell, MAX_CELL_OFFSET, out=cell)
        cell >>= bits
        side = d >> 31
        side &= self.half
        cell += side
        for k, (start, end) in enumerate(zip([0, *cuts], [*cuts, len(s)])):
            cell[start:end] += np.int32(2 * self.half * k)
        self.cell = cell.astype(np.intp)
        self.held = np.bincount(self.cell, minlength=2 * self.half * self.profiles)

    def thinned(self):
        """{most: (N,) bool} which points are taken of every cell."""
        crowded = self.held > min(LEVEL_CELL_LIMITS)
        in_crowds = self.held[crowded].sum()
        if not in_crowds:
            return dict.fromkeys(LEVEL_CELL_LIMITS, True)
        if in_crowds < MIN_DENSE_SHARE * len(self.s):
            level = self.level(np.flatnonzero(crowded.take(self.cell)))
        else:
            level = self.level()
        lot, lots = _by_lot(self.s, np.abs(self.d)), 65536.0 / np.maximum(self.held, 1)
        return {most: lot <= np.minimum(np.where(level, most, POINTS_PER_UNEVEN_CELL) * lots, 65535.0).astype(np.uint16).take(self.cell)
                for most in LEVEL_CELL_LIMITS}

    def level(self, own=None):
        """(C,) bool: is the ground of each cell level? Told for those of which all points are among `own`, indices, None for all."""
        cell, z = (self.cell, self.z) if own is None else (self.cell.take(own), self.z.take(own))
        z = z.astype(float)
        self.total = total = np.bincount(cell, z, len(self.held))
        z *= z
        squares = np.bincount(cell, z, len(self.held))
        self.squares = squares - total * total / np.maximum(self.held, 1)
        self.looked_through = own is None
        return self.squares <= self.held * (LEVEL_CELL_STD / COORDINATE_SCALE) ** 2

    def grids(self):
        """Of every cell its points, the sum of their heights, and that of the squares off their mean: (profiles, 2 sides, cells outward)."""
        return tuple(values.reshape(self.profiles, 2, self.half) for values in (self.held, self.total, self.squares))


def _mostly_uneven(records, width, spacing):
    if not len(records):
        return False
    cells = _Cells(*(records[name] for name in ("s", "d", "z")), width, spacing)
    told = np.where(cells.held >= MIN_LEVEL_POINTS, cells.held, 0)
    return told[~cells.level()].sum() > MOSTLY_UNEVEN_SHARE * told.sum()


def _by_lot(s, out):
    """(N,) uint16 that depend on nothing but the place of a point, and on it without a pattern."""
    lot = s.view(np.uint32) * HASH_FACTORS[0]
    lot += out.view(np.uint32) * HASH_FACTORS[1]
    lot ^= lot >> np.uint32(15)
    lot *= HASH_FACTORS[2]
    lot >>= np.uint32(16)
    return lot.astype(np.uint16)
