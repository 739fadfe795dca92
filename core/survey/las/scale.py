"""The whole numbers in which a LAS file keeps one coordinate, as the local units of a record."""

import numpy as np

from ..store.records import COORDINATE_SCALE, MAX_XY_32_BIT, fill_units

# m from the frame's origin: what lies beyond is absurd, and would overflow the units of a record
FARTHEST = {"X": MAX_XY_32_BIT, "Y": MAX_XY_32_BIT, "Z": 2e4}
FARTHEST_WIDE = 1e8    # where x and y have 64 bits


class LasAxis:
    """One axis of a file.

    Parameters
    ----------
    name : "X", "Y" or "Z"
    scale, offset : of the file's header, metres
    origin : metres, of the road frame
    kind : dtype of the units, int32 or int64
    """

    def __init__(self, name, scale, offset, origin, kind=np.int32):
        self._kind = np.dtype(kind)
        self.name, self.scale, self.shift = name, scale, offset - origin
        step, start = scale / COORDINATE_SCALE, self.shift / COORDINATE_SCALE
        # units follow from whole numbers by whole numbers for nearly every file; coordinates have 32 bits
        self._whole = abs(step - round(step)) <= 1e-13 * abs(step) and abs(start - round(start)) < 1e-3
        unsigned = np.dtype(f"u{self._kind.itemsize}")
        self._step, self._start = (np.array(round(value) % 2**(8 * unsigned.itemsize), unsigned).view(self._kind) if self._whole else None
                                   for value in (step, start))

        # whole numbers of places within reach
        farthest = FARTHEST[name] if self._kind == np.int32 else FARTHEST_WIDE
        reach = sorted((sign * farthest - self.shift) / scale for sign in (-1, 1))
        self._least, self._most = np.ceil(reach[0]), np.floor(reach[1])

    def units(self, raw, kept):
        """(N,) units of 0.1 mm of raw points, and (N,) bool which of them have a place on earth; None where all have."""
        numbers = kept(self.name, self._kind)
        np.copyto(numbers, raw[self.name])
        there = None
        if len(numbers) and not (numbers.min() >= self._least and numbers.max() <= self._most):
            there = (numbers >= self._least) & (numbers <= self._most)
        if not self._whole:
            metres = np.multiply(numbers, self.scale, out=kept("metres"))
            metres += self.shift
            return fill_units(metres, numbers), there
        # what is beyond 32 bits on the way is so by a multiple of them
        numbers *= self._step
        numbers += self._start
        return numbers, there
