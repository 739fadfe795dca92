"""How much single points of each scanner scatter about asphalt: a scanner is noisy or it is not, wherever it drove.

Points of multi-beam scanners scatter by half of asphalt's brightness, those of
mirror scanners by a sixth. What is known of a scanner comes from all roads
of a survey; what is done along a piece of road depends on whose points lie there.
"""

from dataclasses import dataclass

import numpy as np

from ...common.order_statistics import order_by
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...intensity.asphalt_model import LOWER_QUANTILE
from ...survey.store.records import COORDINATE_SCALE

NOISY = 0.40      # of asphalt's level: single points that scatter more are averaged (multi-beam scanners)
SQUARE = 1.0      # m
FEWEST_IN_SQUARE = 30  # points of one scanner
FEWEST = 500      # points of a scanner in squares that tell its scatter
STREWN = 100_000  # points of a window: where there are twice as many, evenly strewn ones tell whether single ones scatter
SPARSE = 4        # every fourth window of a road tells, others where a scanner is in none of these


@dataclass(frozen=True)
class Scatter:
    """What a survey tells of its scanners.

    shares : {scanner: scatter as a share of asphalt's level, the median over squares of 1 m of all roads}; scanners with too few
        points are left out, and are taken for quiet
    points : {(road, window): (scanners,) points of each scanner}
    """

    shares: dict
    points: dict

    @classmethod
    def of(cls, points_in, windows, progress=Progress()):
        """Look at the windows of a survey.

        Parameters
        ----------
        points_in : gives the Points of a (road, window)
        windows : list of (road, window) of all roads
        """
        chosen = {key for key in windows if key[1] % SPARSE == 0}
        roads = {road for road, _ in chosen}
        chosen |= {key for key in windows if key[0] not in roads}
        counts, squares = {}, []

        def look(key):
            points = points_in(*key)
            return np.bincount(points.scanner), squares_of(points) if key in chosen else None

        for key, (count, found) in zip(windows, ordered_map(look, windows, progress)):
            counts[key] = count
            squares += [] if found is None else [found]
        shares = _shares(squares)
        missing = {scanner for count in counts.values() for scanner in np.flatnonzero(count).tolist()} - set(shares)
        rest = [key for key in windows if key not in chosen and any(counts[key][k] for k in missing if k < len(counts[key]))]
        squares += ordered_map(lambda key: squares_of(points_in(*key)), rest)
        return cls({**{scanner: share for scanner, share in _shares(squares).items() if scanner in missing}, **shares}, counts)

    @property
    def noisy(self):
        """Scanners that are noisy, in order."""
        return [scanner for scanner, share in sorted(self.shares.items()) if share > NOISY]

    def averaged(self, road):
        """The windows of a road in which most points are of noisy scanners: there paint is sought in averages."""
        return {window for (there, window), count in self.points.items()
                if there == road and 2 * sum(count[k] for k in self.noisy if k < len(count)) > count.sum()}

    def line(self, length):
        """A sentence for a log; `length` is that of a window, metres."""
        if not self.shares:
            return "How much intensities scatter about asphalt is not known, there are too few road points: paint is sought in the image."
        each = ", ".join(f"{100 * share:.0f} % (scanner {scanner})" for scanner, share in sorted(self.shares.items()))
        text = f"Intensities scatter about asphalt by {each}; more than {100 * NOISY:.0f} % is noisy."
        windows = sum(len(self.averaged(road)) for road in {road for road, _ in self.points})
        every = sum(bool(count.sum()) for count in self.points.values())
        if not windows:
            return text + " Paint is sought in the image."
        where = "" if windows == every else f"Along {windows * length:.0f} of {every * length:.0f} m most points are of noisy scanners, and "
        there = " there" if where else ""
        return (f"{text} {where}{'p' if where else 'P'}aint is sought{there} in averages over a decimetre, as strokes and rows of dashes; "
                f"other markings are not seen{there}.")


def squares_of(points):
    """How much single points scatter about asphalt in squares of 1 m that one scanner sees from one distance.

    It is taken of the intensities as measured. The lower half of a square tells it, which paint is not in.

    Returns
    -------
    scanner, count, scatter : (squares,) the scatter as a share of asphalt's level; squares of few points or without intensity are left out
    """
    if not len(points):
        return np.empty(0, np.uint8), np.empty(0, int), np.empty(0)
    points = points[::max(len(points) // STREWN, 1)]
    value, scanner = points.intensity, points.scanner
    side = int(round(SQUARE / COORDINATE_SCALE))
    square = np.zeros(len(value), np.int32)
    # another pass is another distance
    for key in (points.records["s"] // side, points.records["d"] // side, scanner, points.pass_number):
        low, high = int(key.min()), int(key.max())
        square *= high - low + 1
        square += key.astype(np.int32) - low
    order = order_by(value, square)
    value = value[order].astype(float)
    starts = np.flatnonzero(np.r_[True, np.diff(square[order]) != 0])
    count = np.diff(np.r_[starts, len(value)])
    starts, count = starts[count >= FEWEST_IN_SQUARE], count[count >= FEWEST_IN_SQUARE]
    median, low = value[starts + count // 2], value[starts + (LOWER_QUANTILE * count).astype(np.int64)]
    lit = median > 0
    return scanner[order][starts[lit]], count[lit], 1.0 - low[lit] / median[lit]


def _shares(squares):
    """{scanner: median scatter} of what `squares_of` found in several windows."""
    if not squares:
        return {}
    scanner, count, scatter = (np.concatenate(parts) for parts in zip(*squares))
    points = np.bincount(scanner, count)
    return {k: float(np.median(scatter[scanner == k])) for k in np.flatnonzero(points >= FEWEST).tolist()}
