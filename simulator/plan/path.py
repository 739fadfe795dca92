"""Smooth paths in the plane, with stations along them and offsets from them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from ..parts.axis import RoadAxis

_SPACING = 0.25  # m between nodes; chords of an arc of 10 m are then shorter than the arc by 0.003 percent


class Path:
    """A line through (N, 2) places, m, local, at most half a metre apart, continued straight beyond both ends; it begins at station `start`, m."""

    def __init__(self, places: np.ndarray, start: float = 0.0):
        steps = np.hypot(*np.diff(places, axis=0).T)
        self.start = start
        self._s = start + np.concatenate([[0.0], np.cumsum(steps)])
        self.end = float(self._s[-1])
        self._spline = CubicSpline(self._s, places)
        self._tangent = self._spline.derivative()
        self._tree: cKDTree | None = None

    def at(self, s: np.ndarray | float, d: np.ndarray | float = 0.0) -> np.ndarray:
        """(N, 2) m, local places at stations and offsets (m, left positive)."""
        s, d = np.broadcast_arrays(np.atleast_1d(np.asarray(s, dtype=float)), np.asarray(d, dtype=float))
        on = np.clip(s, self.start, self.end)
        ahead = self._ahead(on)
        return self._spline(on) + (s - on)[:, None] * ahead + d[:, None] * np.column_stack([-ahead[:, 1], ahead[:, 0]])

    def heading(self, s: np.ndarray | float) -> np.ndarray:
        """Direction at stations, (N,) radians counter-clockwise from east."""
        ahead = self._ahead(np.clip(np.atleast_1d(np.asarray(s, dtype=float)), self.start, self.end))
        return np.arctan2(ahead[:, 1], ahead[:, 0])

    def curvature(self, s: np.ndarray) -> np.ndarray:
        """Curvature at (N,) stations, (N,) 1/m, positive in a left bend."""
        around = np.unwrap([self.heading(s - 0.5), self.heading(s + 0.5)], axis=0)
        return around[1] - around[0]

    def _ahead(self, s):
        ahead = self._tangent(s)
        return ahead / np.hypot(ahead[:, 0], ahead[:, 1])[:, None]

    def locate(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Station and offset of the nearest point of the path, (N,) m each, for (N, 2) places within a radius of it."""
        if self._tree is None:
            self._nodes = np.arange(self.start, self.end, _SPACING)
            self._tree = cKDTree(self.at(self._nodes))
        s = self._nodes[self._tree.query(places)[1]]
        for _ in range(2):
            ahead = self._ahead(np.clip(s, self.start, self.end))
            offset = places - self.at(s)
            s = s + np.clip((offset * ahead).sum(axis=1), -_SPACING, _SPACING)
        offset = places - self.at(s)
        return s, ahead[:, 0] * offset[:, 1] - ahead[:, 1] * offset[:, 0]

    def reversed(self) -> Path:
        """The same line the other way, its first station 0."""
        return Path(self._spline(self._s)[::-1])


def path_of_elements(place: tuple[float, float], heading: float, elements: Sequence[tuple[float, float, float]], start: float = 0.0) -> Path:
    """A path of (length, curvature at start, curvature at end), m and 1/m, left positive, from a place and heading at its first station."""
    axis = RoadAxis(elements, start, heading)
    s = np.linspace(axis.start, axis.end, int(np.ceil((axis.end - axis.start) / _SPACING)) + 1)
    return Path(np.column_stack(axis.to_map(s, np.zeros(len(s)))) + place, start)


def path_through(places: np.ndarray, start: float = 0.0) -> Path:
    """A smooth path through (N, 2) places some metres apart (m, local)."""
    chord = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    return Path(CubicSpline(chord, places)(np.arange(0.0, chord[-1], _SPACING)), start)
