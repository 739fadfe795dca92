"""The road frame: the roads and passes of a survey, and the conversion between map coordinates and theirs.

Both published methods use this frame, and every stage works in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from .passes import Pass
from .road import CORRIDOR, Road
from .sigma_along import SigmaAlong

MAX_POINT_DISTANCE = 200.0    # m from the track: exceeds the widest corridor and the extension at the ends of a road


@dataclass
class RoadFrame:
    """All roads and passes of a survey.

    origin : (3,) map coordinates of the local origin, m
    roads : list of Road, by number
    passes : list of Pass, by number
    crs : WKT, "" where unknown
    has_time : whether points are assigned to passes by their time
    way_known : whether the direction of its passes is that of the drive, which an estimated trajectory may not know
    notes : remarks on the trajectory, for the log
    pass_sigma : {road number: SigmaAlong}, one sigma across of the middle of its passes, by what they differ or
        by the accuracy of the trajectory where it was told, whichever is more; without entry where both are unknown
    """

    origin: np.ndarray
    roads: list[Road]
    passes: list[Pass]
    crs: str = ""
    has_time: bool = True
    notes: Sequence[str] = ()
    pass_sigma: dict[int, SigmaAlong] = field(default_factory=dict)
    way_known: bool = True

    def road(self, number: int) -> Road:
        """The road of a number."""
        return self.roads[number]

    def passes_of(self, road: int) -> list[Pass]:
        """The passes over a road."""
        return [p for p in self.passes if p.road == road]

    def passes_sigma(self, road: int, s: np.ndarray, unknown: float = 0.0) -> np.ndarray:
        """(N,) m, one sigma across of the middle of the passes at (N,) stations of a road; `unknown` where nothing says it."""
        along = self.pass_sigma.get(road)
        return np.full(np.shape(s), unknown) if along is None else along.at(s)

    @property
    def farthest(self) -> float:
        """The largest |local x| or |local y| that a point in the frame can have, m."""
        return max(max(np.abs(p.x).max(), np.abs(p.y).max()) for p in self.passes) + MAX_POINT_DISTANCE

    def to_local(self, x: np.ndarray, y: np.ndarray, z: np.ndarray | None = None) -> tuple[np.ndarray, ...]:
        """Local coordinates of map coordinates: x, y, and z if given."""
        local = np.asarray(x, float) - self.origin[0], np.asarray(y, float) - self.origin[1]
        return local if z is None else local + (np.asarray(z, float) - self.origin[2],)

    def to_map(self, road: int, s: np.ndarray, d: np.ndarray | float, z: np.ndarray | None = None) -> tuple[np.ndarray, ...]:
        """Map coordinates of stations and offsets on a road: x, y, and z if a local z is given."""
        x, y = self.roads[road].to_map(s, d)
        found = x + self.origin[0], y + self.origin[1]
        return found if z is None else found + (np.asarray(z, float) + self.origin[2],)

    def track_height(self, road: int, s: np.ndarray, below: dict[int, float] | None = None) -> np.ndarray:
        """Height of the trajectory at stations of a road: the mean of the passes there, else the nearest pass.

        Parameters
        ----------
        road : number
        s : (N,) stations, m
        below : {pass number: metres to subtract}, such as the sensor heights

        Returns
        -------
        (N,) local z, m
        """
        s = np.asarray(s, float)
        below = below or {}
        total, count = np.zeros(s.shape), np.zeros(s.shape)
        passes = self.passes_of(road)
        for p in passes:
            first, last = p.span
            there = (s >= first) & (s <= last)
            total += np.where(there, p.height_at_station(s) - below.get(p.number, 0.0), 0.0)
            count += there
        if not count.all():
            # beyond the driven part and between two passes: the pass that ends nearest
            nearest = np.argmin([np.maximum(np.maximum(p.span[0] - s, s - p.span[1]), 0.0) for p in passes], axis=0)
            for k, p in enumerate(passes):
                alone = (count == 0) & (nearest == k)
                total[alone], count[alone] = p.height_at_station(s[alone]) - below.get(p.number, 0.0), 1
        return total / count

    def nearest_pass(self, road: int, s: np.ndarray, d: np.ndarray) -> np.ndarray:
        """(N,) number of the pass whose track is nearest to (N,) stations and offsets, of those that drove there."""
        s, d = np.asarray(s, float), np.asarray(d, float)
        passes = self.passes_of(road)
        away = [np.where((s >= p.span[0]) & (s <= p.span[1]), 0.0, 1e6) + np.abs(p.at_station(s)[0] - d) for p in passes]
        return np.array([p.number for p in passes])[np.argmin(away, axis=0)]

    def locate_nearest(self, x: np.ndarray, y: np.ndarray, corridor: float = CORRIDOR) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Road number, station and offset of the nearest point on any road, (N,) each; -1 and NaN where there is none."""
        x, y = np.asarray(x, float), np.asarray(y, float)
        best_road = np.full(len(x), -1)
        best_s, best_d = np.full(len(x), np.nan), np.full(len(x), np.nan)
        for road in self.roads:
            s, d = road.locate(x, y, corridor=corridor)
            better = np.isfinite(d) & ~(np.abs(d) >= np.abs(np.where(np.isnan(best_d), np.inf, best_d)))
            best_road[better], best_s[better], best_d[better] = road.number, s[better], d[better]
        return best_road, best_s, best_d
