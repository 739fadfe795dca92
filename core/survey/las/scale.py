"""Coordinates of a LAS file, stored as integers, converted to the local integers of a record."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..store.records import COORDINATE_SCALE, MAX_XY_32_BIT, fill_units

# m from the frame's origin: points beyond are outliers, and would overflow the integers of a record
MAX_COORDINATE = {"X": MAX_XY_32_BIT, "Y": MAX_XY_32_BIT, "Z": 2e4}
MAX_COORDINATE_64_BIT = 1e8    # m, where the records have 64 bits


class LasAxis:
    """One coordinate axis of a file.

    Parameters
    ----------
    name : "X", "Y" or "Z"
    scale, offset : of the file's header, metres
    origin : metres, of the road frame
    dtype : of the units, int32 or int64
    """

    def __init__(self, name: str, scale: float, offset: float, origin: float, dtype: np.dtype | type = np.int32):
        self._dtype = np.dtype(dtype)
        self.name, self.scale, self.shift = name, scale, offset - origin
        step, start = scale / COORDINATE_SCALE, self.shift / COORDINATE_SCALE
        # For nearly every file the units follow from the file's integers by integer arithmetic.
        self._integer = abs(step - round(step)) <= 1e-13 * abs(step) and abs(start - round(start)) < 1e-3
        unsigned = np.dtype(f"u{self._dtype.itemsize}")
        modulus = 2**(8 * unsigned.itemsize)
        self._step, self._start = (np.array(round(value) % modulus if self._integer else 0, unsigned).view(self._dtype)
                                   for value in (step, start))

        # the file's integers of places within MAX_COORDINATE
        farthest = MAX_COORDINATE[name] if self._dtype == np.int32 else MAX_COORDINATE_64_BIT
        limits = sorted((sign * farthest - self.shift) / scale for sign in (-1, 1))
        self._least, self._most = np.ceil(limits[0]), np.floor(limits[1])

    def units(self, raw: np.ndarray, buffer: Callable[..., np.ndarray]) -> tuple[np.ndarray, np.ndarray | None]:
        """Local coordinates of raw points.

        Parameters
        ----------
        raw : (N,) structured array with the column `name` of the file's integers
        buffer : function of a name and a dtype (float64 by default) that returns an (N,) working array

        Returns
        -------
        units : (N,) units of 0.1 mm
        valid : (N,) bool, whether a point lies within MAX_COORDINATE; None where all do
        """
        numbers = buffer(self.name, self._dtype)
        np.copyto(numbers, raw[self.name])
        valid = None
        if len(numbers) and not (numbers.min() >= self._least and numbers.max() <= self._most):
            valid = (numbers >= self._least) & (numbers <= self._most)
        if not self._integer:
            metres = np.multiply(numbers, self.scale, out=buffer("metres"))
            metres += self.shift
            return fill_units(metres, numbers), valid
        # Integer overflow in between cancels: the result is right modulo 2**bits, and fits.
        numbers *= self._step
        numbers += self._start
        return numbers, valid
