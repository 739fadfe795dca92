"""What the objects of a scene are made of: labels of their points, and the noise of worn paint and patchy asphalt."""

from __future__ import annotations

import numpy as np

_SIZE = 512      # nodes per side of a texture, a power of two

# Objects and materials that return a pulse; their numbers are the labels of the points.
LABELS = ("nothing", "road", "paint", "worn paint", "manhole", "gutter", "curb face", "curb stone", "sidewalk",
          "shoulder", "verge", "car", "tree", "pole", "stray", "rail", "wall", "barrier", "fence", "hedge", "building")
LABEL = {name: number for number, name in enumerate(LABELS)}
CARRIAGEWAY_LABELS = tuple(LABEL[name] for name in ("road", "paint", "worn paint", "manhole", "gutter"))


class Texture:
    """Smooth noise of mean 0 and standard deviation about 1, for worn paint and patchy asphalt; equal seeds give equal noise."""

    def __init__(self, seed: int):
        self._tile = np.random.default_rng([seed, 7]).standard_normal((_SIZE, _SIZE)).astype(np.float32).ravel()

    def at(self, s: np.ndarray, d: np.ndarray, cell: float) -> np.ndarray:
        """(N,) float32 noise at (N,) places s, d, bilinear between nodes `cell` apart, m."""
        u, v = s / cell, d / cell + 131.7
        left, low = np.floor(u), np.floor(v)
        fu, fv = (u - left).astype(np.float32), (v - low).astype(np.float32)
        i, j = left.astype(np.int32), low.astype(np.int32)
        mask, tile = _SIZE - 1, self._tile
        row, next_row = (i & mask) * _SIZE, ((i + 1) & mask) * _SIZE
        column, next_column = j & mask, (j + 1) & mask
        near = tile[row + column] * (1 - fv) + tile[row + next_column] * fv
        far = tile[next_row + column] * (1 - fv) + tile[next_row + next_column] * fv
        # averaging reduces the standard deviation to 2/3 over a cell
        return np.float32(1.5) * (near * (1 - fu) + far * fu)
