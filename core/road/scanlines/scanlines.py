"""Normalized scanlines: the measured surface cut by planes across the road, as polylines in the road frame."""

from dataclasses import dataclass, fields

import numpy as np


@dataclass
class Scanlines:
    """Polylines of one road, L lines with V vertices in all.

    Every line lies in the section plane at its station, perpendicular to the road's
    reference line, and is connected: where the surface is interrupted a new line
    begins. Lines are ordered by station, pass, scanner and offset.

    Attributes
    ----------
    station : (L,) float64, metres along the road
    pass_number, scanner : (L,) int; lines of different passes and scanners are never mixed
    first : (L + 1,) int; vertices first[i]:first[i + 1] belong to line i
    d : (V,) float64, offset in metres, left positive, increasing within a line
    z : (V,) float64, local height in metres (the road frame's)
    intensity : (V,) float32, raw counts
    """

    station: np.ndarray
    pass_number: np.ndarray
    scanner: np.ndarray
    first: np.ndarray
    d: np.ndarray
    z: np.ndarray
    intensity: np.ndarray

    def __len__(self):
        return len(self.station)

    @classmethod
    def none(cls):
        return cls(np.empty(0), np.empty(0, int), np.empty(0, int), np.zeros(1, int), np.empty(0), np.empty(0),
                   np.empty(0, np.float32))

    @classmethod
    def join(cls, parts):
        """The lines of several Scanlines of one road, in the order given."""
        parts = [part for part in parts if len(part)]
        if not parts:
            return cls.none()
        values = {f.name: np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(cls) if f.name != "first"}
        counts = np.concatenate([np.diff(part.first) for part in parts])
        return cls(first=np.r_[0, np.cumsum(counts)], **values)

    def runs(self):
        """List of Scanlines, each of one pass and scanner."""
        keys = np.c_[self.pass_number, self.scanner]
        values = np.unique(keys, axis=0)
        return [self] if len(values) == 1 else [self[(keys == key).all(1)] for key in values]

    def line_of_vertex(self):
        """(V,) number of the line each vertex belongs to."""
        return np.repeat(np.arange(len(self)), np.diff(self.first))

    def __getitem__(self, chosen):
        """The lines chosen by a mask or by numbers, in the order given."""
        numbers = np.arange(len(self))[chosen]
        counts = np.diff(self.first)[numbers]
        first = np.r_[0, np.cumsum(counts)]
        vertices = np.repeat(self.first[numbers] - first[:-1], counts) + np.arange(first[-1])
        return Scanlines(self.station[numbers], self.pass_number[numbers], self.scanner[numbers], first,
                         self.d[vertices], self.z[vertices], self.intensity[vertices])
