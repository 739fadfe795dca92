"""Crowded points thinned before anything else is done with them.

Of level ground a few points of a cell say what all of them would; a curb's face, a
hedge, and whatever a noisy scanner saw, keep theirs.
"""

import threading

import numpy as np

from ...survey.points import UNIT
from ...survey.spill_file import SpillFile

FEW = 12          # points of a cell that tell level ground
FEW_IN_PLAN = 6   # the same in plan: there are four such cells and more in one of the raster
MOSTS = FEW, FEW_IN_PLAN
LEVEL = 0.008     # m, standard deviation of heights in a cell that is level, on a road that climbs as on one that does not
UNEVEN = 60       # points of any other cell: more hardly tell its layers better
TOLD, MOSTLY = 4, 0.7  # points of a cell that tell whether it is level, and share of points in cells that are not
TOGETHER = 5.0    # m of road that are read at once
PIECE = 256_000   # points that are looked through at once
RARELY = 0.5      # share of points in crowded cells below which the others are not looked at
EXACT = 1e-6      # 0.1 mm: bounds between profiles are whole numbers of it but for rounding
TURNS = 16        # locks that stretches share while they are thinned, the last of them the file's
LOTS = tuple(np.uint32(odd) for odd in (2654435761, 2246822519, 3266489917))  # large odd factors strew neighbours far apart
FARTHEST = (1 << 18) - 1  # 0.1 mm from the reference line; what lies beyond is as if it lay there


class Crowds:
    """Which points of a survey are looked at where they crowd: decided once, for curbs along the road and curbs in plan.

    width, spacing : m; a cell is a profile long and about `spacing` wide

    What is taken of a stretch is noted point by point, a bit each, in a temporary file: `close` it.
    """

    def __init__(self, survey, width, spacing):
        self.survey, self.width, self.spacing = survey, width, spacing
        self._together = max(int(round(TOGETHER / width)), 1)
        self._taken, self._uneven = {}, {}   # (road, first profile) -> {most: Stored bits}; (road, profile) -> bool
        self._turns = [threading.Lock() for _ in range(TURNS)]
        self._file = None

    def close(self):
        """Forget what was decided and give the disk space back."""
        self._taken.clear()
        if self._file is not None:
            self._file.close()
            self._file = None

    def few_of_every_cell(self, road, profiles, most=FEW):
        """The points of profiles in runs along the road, thinned to about `most` where a cell of level ground holds more.

        Parameters
        ----------
        profiles : (first, last + 1) numbers of profiles
        most : points of one pass in such a cell, FEW or FEW_IN_PLAN; None takes all of every cell

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

    def _window(self, road, first, last):
        return self.survey.window(road, first * self.width, last * self.width)

    def _rows(self, road, first, most):
        """Rows that are taken of the stretch which begins with profile `first`; None for all."""
        key = road, first
        with self._turns[hash(key) % (TURNS - 1)]:
            if key not in self._taken:
                self._taken[key] = self._decided(self._window(road, first, first + self._together), first * self.width)
        count, noted = self._taken[key]
        if noted[most] is None:
            return None
        bits = self._file.get(noted[most])
        return np.flatnonzero(np.unpackbits(bits, count=count).view(bool))

    def _decided(self, points, start):
        """Number of points, and which of them are taken for every `most`: bits in the file, None for all."""
        taken = {most: np.ones(len(points), bool) for most in MOSTS}
        first = 0
        for piece in in_pieces(points, start, self.width):
            for most, chosen in _few_of(piece, self.width, self.spacing).items():
                taken[most][first:first + len(piece)] = chosen
            first += len(piece)
        return len(points), {most: None if chosen.all() else self._noted(np.packbits(chosen)) for most, chosen in taken.items()}

    def _noted(self, bits):
        with self._turns[-1]:
            if self._file is None:
                self._file = SpillFile()
        return self._file.put(bits)


def in_pieces(points, start, width):
    """Points in runs along the road of whole profiles counted from station `start`, PIECE or so each."""
    cuts = np.arange(0, len(points), PIECE)
    if len(cuts) > 1:
        edges = np.unique(np.floor((points.records["s"][cuts[1:]] * UNIT - start) / width)) * width + start
        cuts = np.unique(np.r_[0, np.searchsorted(points.records["s"], np.ceil(edges / UNIT - 0.01).astype(np.int32))])
    return [points[a:b] for a, b in zip(cuts, np.r_[cuts[1:], len(points)]) if b > a]


def _few_of(points, width, spacing):
    """{most: (N,) bool} which of some points are taken."""
    columns = [points.records[name] for name in ("s", "d", "z")]
    numbers = points.records["pass_number"]
    if numbers.min() == numbers.max():
        return _thinned(*columns, width, spacing)
    taken = {most: np.empty(len(points), bool) for most in MOSTS}
    for number in np.flatnonzero(np.bincount(numbers)):
        own = np.flatnonzero(numbers == number)
        for most, chosen in _thinned(*(column.take(own) for column in columns), width, spacing).items():
            taken[most][own] = chosen
    return taken


def _thinned(s, d, z, width, spacing):
    """{most: (N,) bool} which points are taken of every cell; stations s (ascending), offsets d and heights z in 0.1 mm."""
    cell = _cells(s, d, width, spacing)
    held = np.bincount(cell)
    crowded = held > min(MOSTS)
    in_crowds = held[crowded].sum()
    if not in_crowds:
        return dict.fromkeys(MOSTS, True)
    if in_crowds < RARELY * len(s):
        own = np.flatnonzero(crowded.take(cell))
        level = _level(cell.take(own), held, z.take(own))
    else:
        level = _level(cell, held, z)
    lot, lots = _by_lot(s, np.abs(d)), 65536.0 / np.maximum(held, 1)
    return {most: lot <= np.minimum(np.where(level, most, UNEVEN) * lots, 65535.0).astype(np.uint16).take(cell) for most in MOSTS}


def _mostly_uneven(records, width, spacing):
    if not len(records):
        return False
    cell = _cells(records["s"], records["d"], width, spacing)
    held = np.bincount(cell)
    told = np.where(held >= TOLD, held, 0)
    return told[~_level(cell, held, records["z"])].sum() > MOSTLY * told.sum()


def _cells(s, d, width, spacing):
    """(N,) number of the cell of each point; stations s (ascending) and offsets d in 0.1 mm."""
    bits = int(np.rint(np.log2(spacing / UNIT)))
    half = (FARTHEST >> bits) + 1
    # stations ascend, so profiles are runs of points; bounds lie off the whole units
    first, last = (int(np.floor((int(end) + 0.5) * UNIT / width)) for end in (s[0], s[-1]))
    cuts = np.searchsorted(s, np.ceil(np.arange(first + 1, last + 1) * (width / UNIT) - 0.5 - EXACT).astype(np.int32)).tolist()
    # the two sides of a road are parted alike
    cell = np.abs(d)
    np.minimum(cell, FARTHEST, out=cell)
    cell >>= bits
    side = d >> 31
    side &= half
    cell += side
    for k, (start, end) in enumerate(zip([0, *cuts], [*cuts, len(s)])):
        cell[start:end] += np.int32(2 * half * k)
    return cell.astype(np.intp)


def _level(cell, held, z):
    """(C,) bool: is the ground of each cell level? Told for those of which all points are among (N,) cell and z."""
    z = z.astype(float)
    total = np.bincount(cell, z, len(held))
    z *= z
    squares = np.bincount(cell, z, len(held))
    return squares - total * total / np.maximum(held, 1) <= held * (LEVEL / UNIT) ** 2


def _by_lot(s, out):
    """(N,) uint16 that depend on nothing but the place of a point, and on it without a pattern."""
    lot = s.view(np.uint32) * LOTS[0]
    lot += out.view(np.uint32) * LOTS[1]
    lot ^= lot >> np.uint32(15)
    lot *= LOTS[2]
    lot >>= np.uint32(16)
    return lot.astype(np.uint16)
