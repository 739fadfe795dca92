"""Fields of deterministic noise over the road: worn paint, patchy asphalt."""

import numpy as np

_SIZE = 512


class Texture:
    """Smooth noise of mean 0 and standard deviation about 1, the same for the same seed."""

    def __init__(self, seed):
        self._tile = np.random.default_rng([seed, 7]).standard_normal((_SIZE, _SIZE)).astype(np.float32).ravel()

    def at(self, s, d, cell):
        """Noise at stations and offsets, bilinear on a lattice of `cell` metres; float32 array."""
        u, v = s / cell, d / cell + 131.7
        left, low = np.floor(u), np.floor(v)
        fu, fv = (u - left).astype(np.float32), (v - low).astype(np.float32)
        i, j = left.astype(np.int32), low.astype(np.int32)
        mask, tile = _SIZE - 1, self._tile
        row, next_row = (i & mask) * _SIZE, ((i + 1) & mask) * _SIZE
        column, next_column = j & mask, (j + 1) & mask
        near = tile[row + column] * (1 - fv) + tile[row + next_column] * fv
        far = tile[next_row + column] * (1 - fv) + tile[next_row + next_column] * fv
        # 1.5 restores the standard deviation that averaging takes away (2/3 over a cell).
        return np.float32(1.5) * (near * (1 - fu) + far * fu)
