"""An uncertainty that changes along a road."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

STRETCH = 10.0   # m of road of which the mean is kept


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
