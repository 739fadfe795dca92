"""Columns in as few bytes as hold them, to the bit: what is put into a temporary file costs by the byte."""

from typing import NamedTuple

import numpy as np

from .kept_arrays import columns_kept

AT_ONCE = 1 << 15      # values worked at a time: what fits the processor's cache
PARTS = {0: (), 1: (1,), 2: (2,), 3: (2, 1), 4: (4,), 5: (4, 1), 6: (4, 2)}  # bytes of a value, and widths of its parts, lowest first


class Packing(NamedTuple):
    """How a column of `count` values was packed: its bits less `least`, in parts of so many bytes, all lowest parts first."""

    dtype: np.dtype
    count: int
    least: int
    widths: tuple

    @property
    def nbytes(self):
        return self.count * sum(self.widths)

    @property
    def alike(self):
        """A read-only view of the one value that all have; None where they differ."""
        if self.widths:
            return None
        size = self.dtype.itemsize
        return np.broadcast_to(np.array(self.least % 2**(8 * size), f"u{size}").view(self.dtype), self.count)

    def unpack(self, data, column, rows=None):
        """Fill a column, (N,), from its packed bytes; with some rows of it, (M,), where they are given."""
        bits = np.dtype(f"u{self.dtype.itemsize}")
        least, column = bits.type(self.least % 2**(8 * bits.itemsize)), column.view(bits)
        low, *high = _parts(data, self)
        for first in range(0, len(column), AT_ONCE):
            piece = column[first:first + AT_ONCE]
            some = slice(first, first + AT_ONCE) if rows is None else rows[first:first + AT_ONCE]
            if high:
                np.left_shift(_some(high[0], some), 8 * self.widths[0], out=piece, dtype=bits)
                piece |= _some(low, some)
                piece += least
            else:
                np.add(_some(low, some), least, out=piece, dtype=bits)


def packed(column):
    """Packing and packed bytes, (B,) uint8, of a column of one or more numbers.

    The bytes are overwritten by the next column that the same thread packs.
    """
    column = np.ascontiguousarray(column)
    size = column.dtype.itemsize
    values = column.view(f"i{size}") if column.dtype.kind == "f" else column   # so that NaN is NaN
    least, most = int(values.min()), int(values.max())
    widths = PARTS.get(((most - least).bit_length() + 7) // 8, (size,))
    if sum(widths) >= size:
        return Packing(column.dtype, len(column), 0, (size,)), column.view(np.uint8)
    packing = Packing(column.dtype, len(column), least, widths)
    bits = column.view(f"u{size}")
    least = bits.dtype.type(least % 2**(8 * size))
    data = columns_kept.of(packing.nbytes)("packed", np.uint8)
    parts = _parts(data, packing)
    over = np.empty(min(len(bits), AT_ONCE), bits.dtype)
    for first in range(0, len(bits) if parts else 0, AT_ONCE):
        here = bits[first:first + AT_ONCE]
        rest = np.subtract(here, least, out=over[:len(here)])
        parts[0][first:first + AT_ONCE] = rest
        if len(parts) > 1:
            parts[1][first:first + AT_ONCE] = np.right_shift(rest, 8 * widths[0], out=rest)
    return packing, data


def _parts(data, packing):
    """Views of the packed bytes, one for each part of the values."""
    ends = np.cumsum([0, *packing.widths]) * packing.count
    return [data[first:end].view(f"u{width}") for first, end, width in zip(ends[:-1].tolist(), ends[1:].tolist(), packing.widths)]


def _some(part, rows):
    return part[rows] if isinstance(rows, slice) else part.take(rows, mode="clip")
