"""Paint on a plan: polygons in local metres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import TYPE_CHECKING

import numpy as np
import shapely

from .path import Path

if TYPE_CHECKING:
    from ..parts.materials import Texture

_STEP = 0.25    # m along a line between vertices of its outline
_PIECE = 16     # vertices along a line in one piece; short pieces are quickly looked up
_CELL = 0.25    # m, cells that tell where paint may be


@dataclass(frozen=True)
class Mark:
    """One marking."""

    kind: str   # class of the marking
    line: int | None   # number of the line, None for other markings
    pattern: str | None   # solid or dashed, None for other markings
    width: float | None   # m, of a line
    outlines: tuple[np.ndarray, ...]   # (n, 2) m, of its painted parts
    pieces: tuple[np.ndarray, ...]   # the same area in smaller polygons
    wear: float   # 0 to 1, share of the paint that is worn off


def line_mark(kind: str, line: int, path: Path, spans: Sequence[tuple[float, float]], offsets: Sequence[np.ndarray], width: float,
              dashed: bool, wear: float) -> Mark:
    """A line along a path, painted between the (start, end) stations of `spans`, with offsets at `stations_between` of each, m."""
    outlines, pieces = [], []
    for (start, end), offset in zip(spans, offsets):
        s = stations_between(start, end)
        left, right = path.at(s, offset + width / 2), path.at(s, offset - width / 2)
        outlines.append(np.concatenate([right, left[::-1]]))
        for first in range(0, len(s) - 1, _PIECE):
            rows = slice(first, first + _PIECE + 1)
            pieces.append(np.concatenate([right[rows], left[rows][::-1]]))
    return Mark(kind, line, "dashed" if dashed else "solid", width, tuple(outlines), tuple(pieces), wear)


def stations_between(start: float, end: float) -> np.ndarray:
    """Stations of the vertices of a line, m."""
    return np.linspace(start, end, max(2, int(np.ceil((end - start) / _STEP)) + 1))


class PlanPaint:
    """All markings of a plan, with the Texture of their wear."""

    def __init__(self, markings: Sequence[Mark], texture: Texture):
        self.markings, self._texture = list(markings), texture
        self._areas = Areas([piece for mark in markings for piece in mark.pieces],
                            np.array([number for number, mark in enumerate(markings) for _ in mark.pieces], dtype=np.int16))
        self._limits = np.array([NormalDist().inv_cdf(mark.wear) for mark in markings])

    def at(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(number of the marking, -1 where there is none; whether its paint is not worn off), (N,) each, at (N,) places."""
        number = self._areas.number(x, y)
        fresh = np.zeros(len(x), dtype=bool)
        painted = np.flatnonzero(number >= 0)
        x, y = x[painted], y[painted]
        chips = 0.8 * self._texture.at(x, y, 0.035) + 0.6 * self._texture.at(x, y, 0.9)
        fresh[painted] = chips > self._limits[number[painted]]
        return number, fresh


class Areas:
    """Polygons, (n, 2) m outlines, that are looked up by place; `numbers`: (P,) int16, what to give for each."""

    def __init__(self, outlines: Sequence[np.ndarray], numbers: np.ndarray):
        self._numbers = numbers
        self._tree = shapely.STRtree([shapely.Polygon(outline) for outline in outlines])
        if len(outlines) == 0:
            return
        low = np.min([outline.min(axis=0) for outline in outlines], axis=0)
        high = np.max([outline.max(axis=0) for outline in outlines], axis=0)
        self._corner = low - _CELL
        columns, rows = ((high - low) / _CELL).astype(int) + 4
        self._near = np.zeros((rows, columns), dtype=bool)
        for outline in outlines:
            (left, bottom), (right, top) = ((limit(outline, axis=0) - self._corner) / _CELL for limit in (np.min, np.max))
            self._near[int(bottom):int(top) + 1, int(left):int(right) + 1] = True

    def number(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(N,) int16, the number of the polygon at (N,) places, -1 where there is none."""
        number = np.full(len(x), -1, dtype=np.int16)
        if len(self._numbers) == 0:
            return number
        rows, columns = self._near.shape
        column = np.clip(((x - self._corner[0]) / _CELL).astype(np.intp), 0, columns - 1)
        row = np.clip(((y - self._corner[1]) / _CELL).astype(np.intp), 0, rows - 1)
        near = np.flatnonzero(self._near[row, column])
        point, polygon = self._tree.query(shapely.points(x[near], y[near]), predicate="intersects")
        number[near[point]] = self._numbers[polygon]
        return number
