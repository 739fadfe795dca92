"""Where points lie relative to the vehicle at the time they were measured, looked up in small tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..survey.frame.passes import Pass
from ..survey.store.records import COORDINATE_SCALE, Points

VEHICLE_TICK = 5e-4    # s between the times at which the vehicle's position is tabulated: 1 cm of driving
UNKNOWN_DISTANCE = np.int32(2**30)   # of a point during whose time no pass drove
PASS_MARGIN = 1.0      # s before and after a pass in which its points may still have been measured
ACROSS_TRACK, FROM_VEHICLE = 0, 1    # kinds of distance: across the vehicle's track, or horizontally from the vehicle


class VehicleDistances:
    """Distances of points from the vehicle during the time in which the points were measured.

    On a road the place relative to the vehicle stands for range and incidence
    together: the height of the sensor ties one to the other. A mirror scanner,
    even one yawed by 45 degrees, meets each distance across the road once per
    turn, at one range. A spinning scanner with many beams meets it at many ranges, but
    there the horizontal distance from the scanner determines the range.

    Parameters
    ----------
    passes : of the road frame
    time : (N,) s, of all points that will be asked for; the ticks are those of a pass, whatever points are asked for
    """

    def __init__(self, passes: Sequence[Pass], time: np.ndarray):
        self._tables: list[_PassTable] = []
        if len(time):
            first, last = float(time.min()), float(time.max())
            self._tables = [_PassTable(p, max(first, p.time[0] - PASS_MARGIN), min(last, p.time[-1] + PASS_MARGIN)) for p in passes
                            if first <= p.time[-1] + PASS_MARGIN and last >= p.time[0] - PASS_MARGIN]

    def of(self, points: Points, kinds: Sequence[int] = (ACROSS_TRACK, FROM_VEHICLE)) -> list[np.ndarray]:
        """Signed distances from the vehicle.

        Parameters
        ----------
        points : (N) road points
        kinds : which distances are asked for

        Returns
        -------
        for each of `kinds` (N,) int32, units of 0.1 mm, left of travel positive: across the track, or horizontally
        from the vehicle with the sign of the side; UNKNOWN_DISTANCE where no pass drove at the point's time
        """
        time, number = points.time, points.pass_number
        found = [np.full(len(points), UNKNOWN_DISTANCE, np.int32) for _ in kinds]
        for table in self._tables if len(points) else ():
            rows = table.rows(time, number)
            if rows is None:
                for whole, distances in zip(found, table.distances(points, time, kinds)):
                    whole[:] = distances
            elif len(rows):
                for whole, distances in zip(found, table.distances(points[rows], time[rows], kinds)):
                    whole[rows] = distances
        return found


class _PassTable:
    """Positions of the vehicle during a part of one pass, at every VEHICLE_TICK."""

    def __init__(self, driven: Pass, first: float, last: float):
        self.driven, self.begin = driven, driven.time[0]
        self.first = int(np.floor((first - self.begin) / VEHICLE_TICK))
        self.ticks = self.begin + VEHICLE_TICK * np.arange(self.first, int(np.floor((last - self.begin) / VEHICLE_TICK)) + 2)
        self._positions: dict[str, np.ndarray] = {}

    def rows(self, time: np.ndarray, number: np.ndarray) -> np.ndarray | None:
        """Indices of the points of this pass; None for all of them."""
        rows = number == self.driven.number
        start, end = self.begin - PASS_MARGIN, self.driven.time[-1] + PASS_MARGIN
        if time.min() < start or time.max() > end:
            rows &= (time >= start) & (time <= end)
        return None if rows.all() else np.flatnonzero(rows)

    def distances(self, points: Points, time: np.ndarray, kinds: Sequence[int]) -> Iterator[np.ndarray]:
        tick = time - self.begin
        tick *= 1.0 / VEHICLE_TICK
        tick += 0.5
        k = np.floor(tick, out=tick).astype(np.intp)
        k -= self.first
        across = self._relative(points.records["d"], "d", k)
        if self.driven.direction < 0:
            np.negative(across, out=across)
        for kind in kinds:
            yield across if kind == ACROSS_TRACK else self._horizontal(points, k, across)

    def _horizontal(self, points, k, across):
        x, y = (self._relative(points.records[name], name, k).astype(np.float32) for name in "xy")
        x *= x
        y *= y
        x += y
        return np.copysign(np.sqrt(x, out=x), across).astype(np.int32)

    def _relative(self, units, name, k):
        """(N,) int32 units minus the vehicle's at ticks k; of 64-bit coordinates the lower 32 bits suffice, as the difference is small."""
        if name not in self._positions:
            self._positions[name] = np.rint(self.driven.at(self.ticks, name)[0] / COORDINATE_SCALE).astype(np.int64).astype(np.int32)
        vehicle = self._positions[name].take(k, mode="clip")
        return np.subtract(units.astype(np.int32, copy=False), vehicle, out=vehicle)
