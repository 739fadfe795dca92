"""Normalized scanlines: sections of the measured surface by planes across the road, as polylines in the road frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np


@dataclass
class Scanlines:
    """Polylines of one road: L lines with V vertices in all.

    Every line lies in the section plane at its station, perpendicular to the reference line of the road. A line is
    connected: where the surface is interrupted, a new line begins. Lines are sorted by station, pass, scanner and offset.

    Attributes
    ----------
    station : (L,) float64 m along the road
    pass_number, scanner : (L,) int; a line holds points of one pass and one scanner
    first : (L + 1,) int; vertices first[i]:first[i + 1] belong to line i
    d : (V,) float64 m, offset, left positive, increasing within a line
    z : (V,) float64 m, local height (of the road frame)
    intensity : (V,) float32, raw counts
    """

    station: np.ndarray
    pass_number: np.ndarray
    scanner: np.ndarray
    first: np.ndarray
    d: np.ndarray
    z: np.ndarray
    intensity: np.ndarray

    def __len__(self) -> int:
        return len(self.station)

    @classmethod
    def none(cls) -> Scanlines:
        """No lines."""
        return cls(np.empty(0), np.empty(0, int), np.empty(0, int), np.zeros(1, int), np.empty(0), np.empty(0),
                   np.empty(0, np.float32))

    @classmethod
    def join(cls, parts: Sequence[Scanlines]) -> Scanlines:
        """The lines of several Scanlines of one road, in the order given."""
        parts = [part for part in parts if len(part)]
        if not parts:
            return cls.none()
        values = {f.name: np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(cls) if f.name != "first"}
        counts = np.concatenate([np.diff(part.first) for part in parts])
        return cls(first=np.r_[0, np.cumsum(counts)], **values)

    def runs(self) -> list[Scanlines]:
        """The lines of each pass and scanner."""
        keys = np.c_[self.pass_number, self.scanner]
        values = np.unique(keys, axis=0)
        return [self] if len(values) == 1 else [self[(keys == key).all(1)] for key in values]

    def line_of_vertex(self) -> np.ndarray:
        """(V,) int, number of the line of each vertex."""
        return np.repeat(np.arange(len(self)), np.diff(self.first))

    def __getitem__(self, which: np.ndarray | slice) -> Scanlines:
        """The lines selected by a mask, by numbers or by a slice, in the order given."""
        numbers = np.arange(len(self))[which]
        counts = np.diff(self.first)[numbers]
        first = np.r_[0, np.cumsum(counts)]
        vertices = np.repeat(self.first[numbers] - first[:-1], counts) + np.arange(first[-1])
        return Scanlines(self.station[numbers], self.pass_number[numbers], self.scanner[numbers], first,
                         self.d[vertices], self.z[vertices], self.intensity[vertices])
