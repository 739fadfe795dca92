"""An even sample of a survey's points that keeps neighbours together, whatever the order of the files."""

from __future__ import annotations

from dataclasses import dataclass
from math import gcd

import numpy as np

SLOT = 0.001   # s: some hundred pulses, a part of a mirror's turn


@dataclass(frozen=True)
class TimeSlots:
    """Every `stride`-th slot of time.

    Points of one slot follow each other along a scan line; slots pass through all parts of a turn.
    """

    stride: int

    @classmethod
    def for_points(cls, count: int, most: int) -> TimeSlots:
        """The slots of which `count` points fill at most `most`."""
        stride = max(-(-count // most), 1)
        # mirrors turn in 5, 10 or 20 ms: a stride with a common factor would see the same part of every turn
        while stride > 1 and gcd(stride, 10) > 1:
            stride += 1
        return cls(stride)

    def kept(self, time: np.ndarray) -> np.ndarray:
        """(N,) bool of the points in the sample, by (N,) times in seconds."""
        if self.stride == 1:
            return np.ones(len(time), bool)
        slot = np.asarray(time, float) / SLOT
        np.floor(slot, out=slot)
        # the nearest multiple of the stride, exact for whole numbers: a remainder takes ten times as long
        nearest = slot * (1.0 / self.stride)
        np.rint(nearest, out=nearest)
        nearest *= self.stride
        with np.errstate(invalid="ignore"):   # infinite times
            nearest -= slot
        return nearest == 0
