"""An uncertainty that changes along a road."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

STRETCH = 10.0         # m of road of which the mean is kept, and the least that is told apart on a line
CUT_FACTOR = 2.0       # times the uncertainty of the stretch beside it, and
LEAST_CHANGE = 0.010   # m more or less, that a stretch of a line is cut off for


@dataclass(frozen=True)
class SigmaAlong:
    """One sigma by station of a road; it changes evenly between nodes and stays beyond them.

    stations : of the nodes, m, rising
    metres : one sigma at each
    """

    stations: tuple[float, ...]
    metres: tuple[float, ...]

    @classmethod
    def everywhere(cls, metres: float) -> SigmaAlong:
        """The same all along the road."""
        return cls((0.0,), (float(metres),))

    @classmethod
    def through(cls, stations: np.ndarray, metres: np.ndarray) -> SigmaAlong:
        """From (N,) values in metres at (N,) stations in any order, N > 0: the RMS of every stretch of STRETCH."""
        stations, metres = np.asarray(stations, float), np.asarray(metres, float)
        if np.ptp(metres) == 0.0:
            return cls.everywhere(metres[0])
        _, stretch = np.unique(np.floor(stations / STRETCH), return_inverse=True)
        count = np.bincount(stretch)
        return cls(tuple((np.bincount(stretch, stations) / count).tolist()), tuple(np.sqrt(np.bincount(stretch, metres**2) / count).tolist()))

    def at(self, s: np.ndarray | float) -> np.ndarray:
        """(N,) m at (N,) stations."""
        return np.interp(s, self.stations, self.metres)

    def at_least(self, metres: float) -> SigmaAlong:
        """The same, nowhere less than some metres."""
        return SigmaAlong(self.stations, tuple(max(own, float(metres)) for own in self.metres))


def cuts_where_it_changes(along: np.ndarray, sigma: np.ndarray) -> np.ndarray:
    """Where a line is cut so that one number tells how uncertain each of its stretches is.

    From stretches of STRETCH on, those beside each other become one that differ least, weighted by their lengths (Ward), until every two differ by
    CUT_FACTOR times and LEAST_CHANGE.

    Parameters
    ----------
    along : (N,) m along the line, rising
    sigma : (N,) m, one sigma there

    Returns
    -------
    (K,) rows that begin a stretch, without the first; empty where one number tells it
    """
    count = int((along[-1] - along[0]) / STRETCH) if len(along) else 0
    if count < 2 or np.ptp(sigma) < LEAST_CHANGE:
        return np.empty(0, int)
    begin = np.unique(np.searchsorted(along, along[0] + (along[-1] - along[0]) * np.arange(count) / count))
    size = np.diff(np.append(begin, len(along))).astype(float)
    mean = np.add.reduceat(sigma, begin) / size
    while len(begin) > 1:
        change = np.abs(np.diff(mean))
        apart = (change >= LEAST_CHANGE) & (np.maximum(mean[1:], mean[:-1]) >= CUT_FACTOR * np.minimum(mean[1:], mean[:-1]))
        if apart.all():
            break
        k = int(np.argmin(np.where(apart, np.inf, size[1:] * size[:-1] / (size[1:] + size[:-1]) * change**2)))
        mean[k] = np.average(mean[k:k + 2], weights=size[k:k + 2])
        size[k] += size[k + 1]
        mean, size, begin = (np.delete(values, k + 1) for values in (mean, size, begin))
    return begin[1:]
