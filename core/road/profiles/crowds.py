"""Crowded points thinned before anything else is done with them.

Of level ground a few points of a cell say what all of them would; a curb's face, a
hedge, and whatever a noisy scanner saw, keep theirs.
"""

import numpy as np

from ...survey.points import UNIT

FEW = 12          # points of a cell that tell level ground
LEVEL = 0.008     # m, standard deviation of heights in a cell that is level, on a road that climbs as on one that does not
UNEVEN = 60       # points of any other cell: more hardly tell its layers better
TOLD, MOSTLY = 4, 0.7  # points of a cell that tell whether it is level, and share of points in cells that are not
TOGETHER = 5.0    # m of road that are read at once
PIECE = 256_000   # points that are looked through at once
RARELY = 0.5      # share of points in crowded cells below which the others are not looked at
EXACT = 1e-6      # 0.1 mm: bounds between profiles are whole numbers of it but for rounding
LOTS = tuple(np.uint32(odd) for odd in (2654435761, 2246822519, 3266489917))  # large odd factors strew neighbours far apart
FARTHEST = (1 << 18) - 1  # 0.1 mm from the reference line; what lies beyond is as if it lay there


def few_of_every_cell(survey, road, profiles, width, spacing, most=FEW):
    """The points of profiles in runs along the road, thinned to about `most` where a cell of level ground holds more.

    Parameters
    ----------
    profiles : (first, last + 1) numbers of profiles
    width, spacing : m; a cell is a profile long and about `spacing` wide
    most : points of one pass in such a cell; None takes all of every cell

    Yields
    ------
    Points of whole profiles in canonical order. Which of a cell are taken depends on the points of its profile alone.
    """
    together = max(int(round(TOGETHER / width)), 1)
    for first in range(profiles[0] // together * together, profiles[1], together):
        own = max(first, profiles[0]), min(first + together, profiles[1])
        for points in in_pieces(survey.window(road, own[0] * width, own[1] * width), own[0] * width, width):
            yield points if most is None else points[_few_of(points, width, spacing, most)]


def in_pieces(points, start, width):
    """Points in runs along the road of whole profiles counted from station `start`, PIECE or so each."""
    cuts = np.arange(0, len(points), PIECE)
    if len(cuts) > 1:
        edges = np.unique(np.floor((points.records["s"][cuts[1:]] * UNIT - start) / width)) * width + start
        cuts = np.unique(np.r_[0, np.searchsorted(points.records["s"], np.ceil(edges / UNIT - 0.01).astype(np.int32))])
    return [points[a:b] for a, b in zip(cuts, np.r_[cuts[1:], len(points)]) if b > a]


def _few_of(points, width, spacing, most):
    """Indices of the points that are taken, ascending."""
    columns = [points.records[name] for name in ("s", "d", "z")]
    numbers = points.records["pass_number"]
    if numbers.min() == numbers.max():
        return _thinned(*columns, width, spacing, most)
    kept = []
    for number in np.flatnonzero(np.bincount(numbers)):
        own = np.flatnonzero(numbers == number)
        kept.append(own[_thinned(*(column.take(own) for column in columns), width, spacing, most)])
    return np.sort(np.concatenate(kept))


def _thinned(s, d, z, width, spacing, most):
    """Indices of the points taken of every cell; stations s (ascending), offsets d and heights z in 0.1 mm."""
    if len(s) <= most:
        return np.arange(len(s))
    cell = _cells(s, d, width, spacing)
    held = np.bincount(cell)
    crowded = held > most
    if not crowded.any():
        return np.arange(len(s))
    if held[crowded].sum() < RARELY * len(s):
        own = np.flatnonzero(crowded.take(cell))
        level = _level(cell.take(own), held, z.take(own))
    else:
        level = _level(cell, held, z)
    share = np.minimum(np.where(level, most, UNEVEN) * (65536.0 / np.maximum(held, 1)), 65535.0).astype(np.uint16)
    return np.flatnonzero(_by_lot(s, np.abs(d)) <= share.take(cell))


def mostly_uneven(survey, road, profile, width, spacing):
    """Is the ground about a profile uneven nearly everywhere? So it looks to a noisy scanner; there thinning leaves little out."""
    records = survey.window(road, (profile - 2) * width, (profile + 2) * width).records
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
