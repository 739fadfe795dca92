"""The whole numbers in which a LAS file keeps one coordinate, as the local units of a record."""

import numpy as np

from .points import UNIT, in_units

FARTHEST = {"X": 2e5, "Y": 2e5, "Z": 2e4}  # m from the frame's origin: what lies beyond is absurd, and would overflow the units of a record


class LasAxis:
    """One axis of a file.

    Parameters
    ----------
    name : "X", "Y" or "Z"
    scale, offset : of the file's header, metres
    origin : metres, of the road frame
    """

    def __init__(self, name, scale, offset, origin):
        self.name, self.scale, self.shift = name, scale, offset - origin
        step, start = scale / UNIT, self.shift / UNIT
        # units follow from whole numbers by whole numbers for nearly every file; coordinates have 32 bits
        self._whole = abs(step - round(step)) <= 1e-13 * abs(step) and abs(start - round(start)) < 1e-3
        self._step, self._start = (np.array(round(value) % 2**32, np.uint32).view(np.int32) if self._whole else None for value in (step, start))

        # whole numbers of places within reach
        reach = sorted((sign * FARTHEST[name] - self.shift) / scale for sign in (-1, 1))
        self._least, self._most = np.ceil(reach[0]), np.floor(reach[1])

    def units(self, raw, kept):
        """(N,) int32 of 0.1 mm of raw points, and (N,) bool which of them have a place on earth; None where all have."""
        numbers = kept(self.name, np.int32)
        np.copyto(numbers, raw[self.name])
        there = None
        if len(numbers) and not (numbers.min() >= self._least and numbers.max() <= self._most):
            there = (numbers >= self._least) & (numbers <= self._most)
        if not self._whole:
            metres = np.multiply(numbers, self.scale, out=kept("metres"))
            metres += self.shift
            return in_units(metres, numbers), there
        # what is beyond 32 bits on the way is so by a multiple of them
        numbers *= self._step
        numbers += self._start
        return numbers, there
