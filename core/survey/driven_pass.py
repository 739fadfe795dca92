"""One run of the vehicle along a road: where it was at any time, and at any station."""

from dataclasses import dataclass, field

import numpy as np

TICK = 0.005       # s between the times at which a pass is looked up
MOST_TICKS = 20_000_000


@dataclass
class Pass:
    """One run of the vehicle along a road.

    time, x, y, z (local), s, d: (N,) the vehicle's own samples in the road's frame.
    direction: +1 along the reference line, -1 against it. attitude: (3, N) roll, pitch, heading (radians), 0 where unknown, or None.
    """

    number: int
    road: int
    direction: int
    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    s: np.ndarray
    d: np.ndarray
    attitude: np.ndarray = field(default=None, repr=False)
    _by_station: tuple = field(default=None, repr=False)
    _progress: np.ndarray = field(default=None, repr=False)
    _by_tick: dict = field(default_factory=dict, repr=False)

    def at(self, time, *names):
        """What the vehicle did at (N,) times: (N,) values of each of "x", "y", "z", "s", "d", as at its ends beyond them.

        Values lie on a line between ticks of 5 ms, so that many times in any order cost little.
        """
        if not self._by_tick:
            span = self.time[-1] - self.time[0]
            tick = max(TICK, span / MOST_TICKS)
            self._by_tick["time"] = tick, self.time[0] + tick * np.arange(int(np.ceil(span / tick)) + 2)
        tick, times = self._by_tick["time"]
        at = (np.asarray(time, float) - times[0]) * (1.0 / tick)
        np.clip(at, 0.0, len(times) - 1.5, out=at)
        k = at.astype(np.intp)
        at -= k
        found = []
        for name in names:
            if name not in self._by_tick:
                self._by_tick[name] = np.interp(times, self.time, getattr(self, name))
            table = self._by_tick[name]
            here = table.take(k, mode="clip")
            step = table[1:].take(k, mode="clip")
            step -= here
            step *= at
            here += step
            found.append(here)
        return found

    def position(self, time):
        """Local x, y, z of the vehicle at the given times."""
        return tuple(self.at(time, "x", "y", "z"))

    def station_at(self, time):
        """Road station of the vehicle at the given times."""
        return self.at(time, "s")[0]

    def progress_at(self, time):
        """Metres of road gained since the pass began: stands still while the vehicle waits, trembles or backs up."""
        if self._progress is None:
            self._progress = np.maximum.accumulate(self.direction * self.s) - self.direction * self.s[0]
        return np.interp(time, self.time, self._progress)

    def at_station(self, s):
        """Offset and height of the vehicle's track where it passes station s."""
        stations, d, z = self._in_order()
        return np.interp(s, stations, d), np.interp(s, stations, z)

    def height_at_station(self, s):
        """Height of the vehicle's track where it passes station s."""
        stations, _, z = self._in_order()
        return np.interp(s, stations, z)

    def _in_order(self):
        if self._by_station is None:
            order = np.argsort(self.s, kind="stable")
            self._by_station = self.s[order], self.d[order], self.z[order]
        return self._by_station

    @property
    def span(self):
        """(first, last) station driven."""
        return float(self.s.min()), float(self.s.max())
