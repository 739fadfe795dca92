"""The whole numbers in which a LAS file keeps one coordinate: as local metres, and as the units of a record."""

import numpy as np

from .points import UNIT, in_units


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

    def metres(self, raw, kept):
        """(N,) float64 local metres of raw points."""
        numbers = kept(self.name, np.int32)
        np.copyto(numbers, raw[self.name])
        metres = np.multiply(numbers, self.scale, out=kept(self.name + " metres"))
        metres += self.shift
        return metres

    def units(self, metres, kept):
        """(N,) int32 of 0.1 mm: those of `metres` as it gave them last."""
        numbers = kept(self.name, np.int32)
        if not self._whole:
            return in_units(metres, numbers)
        # what is beyond 32 bits on the way is so by a multiple of them
        numbers *= self._step
        numbers += self._start
        return numbers
