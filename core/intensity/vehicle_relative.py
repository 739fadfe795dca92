"""Where points lie as seen from the vehicle at the time they were measured, looked up in small tables."""

import numpy as np

from ..survey.store.records import COORDINATE_SCALE

TICK = 5e-4            # s between the times at which the vehicle is looked up: 1 cm of driving
UNKNOWN = np.int32(2**30)
BEYOND = 1.0           # s before and after a pass in which its points may still have been measured
ACROSS, AWAY = 0, 1    # how distance is told


class Tracks:
    """The vehicle during the time in which some points were measured.

    On a road the place relative to the vehicle stands for range and incidence
    together: the height of the sensor ties one to the other. A mirror scanner,
    even one yawed by 45 degrees, meets each distance across the road once per
    turn, at one range; a spinning one with many beams meets it at many, but
    there the distance away from it tells the range.
    """

    def __init__(self, passes, time):
        """`time` (N,) of all points that will be asked for; the ticks are those of a pass, whatever points are asked for."""
        self._tracks = []
        if len(time):
            first, last = float(time.min()), float(time.max())
            self._tracks = [_Track(p, max(first, p.time[0] - BEYOND), min(last, p.time[-1] + BEYOND)) for p in passes
                            if first <= p.time[-1] + BEYOND and last >= p.time[0] - BEYOND]

    def places(self, points, ways=(ACROSS, AWAY)):
        """Signed distances from the vehicle.

        Parameters
        ----------
        points : (N) road points
        ways : which distances are asked for

        Returns
        -------
        for each of `ways` (N,) int32, units of 0.1 mm, left of travel positive: across the track, or horizontally
        away with the sign of the side; UNKNOWN where no pass drove at the point's time
        """
        time, number = points.time, points.pass_number
        found = [np.full(len(points), UNKNOWN, np.int32) for _ in ways]
        for track in self._tracks if len(points) else ():
            rows = track.rows(time, number)
            if rows is None:
                for all_places, places in zip(found, track.places(points, time, ways)):
                    all_places[:] = places
            elif len(rows):
                for all_places, places in zip(found, track.places(points[rows], time[rows], ways)):
                    all_places[rows] = places
        return found


class _Track:
    """One pass during some seconds."""

    def __init__(self, driven, first, last):
        self.driven, self.begin = driven, driven.time[0]
        self.first = int(np.floor((first - self.begin) / TICK))
        self.ticks = self.begin + TICK * np.arange(self.first, int(np.floor((last - self.begin) / TICK)) + 2)
        self._tables = {}

    def rows(self, time, number):
        """Indices of the points of this pass; None for all of them."""
        rows = number == self.driven.number
        start, end = self.begin - BEYOND, self.driven.time[-1] + BEYOND
        if time.min() < start or time.max() > end:
            rows &= (time >= start) & (time <= end)
        return None if rows.all() else np.flatnonzero(rows)

    def places(self, points, time, ways):
        tick = time - self.begin
        tick *= 1.0 / TICK
        tick += 0.5
        k = np.floor(tick, out=tick).astype(np.intp)
        k -= self.first
        across = self._less(points.records["d"], "d", k)
        if self.driven.direction < 0:
            np.negative(across, out=across)
        for way in ways:
            yield across if way == ACROSS else self._away(points, k, across)

    def _away(self, points, k, across):
        x, y = (self._less(points.records[name], name, k).astype(np.float32) for name in "xy")
        x *= x
        y *= y
        x += y
        return np.copysign(np.sqrt(x, out=x), across).astype(np.int32)

    def _less(self, units, name, k):
        """(N,) int32 units less where the vehicle was at ticks k: of places with 64 bits the lower 32 tell it, as what is near is."""
        if name not in self._tables:
            self._tables[name] = np.rint(self.driven.at(self.ticks, name)[0] / COORDINATE_SCALE).astype(np.int64).astype(np.int32)
        there = self._tables[name].take(k, mode="clip")
        return np.subtract(units.astype(np.int32, copy=False), there, out=there)
