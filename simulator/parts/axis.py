"""The horizontal alignment of a simulated street."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

_SPACING = 0.25  # m between nodes of the axis; a cubic through a node is then accurate to a micrometre


class RoadAxis:
    """A horizontal alignment of elements whose curvature changes linearly, through (0, 0) at station 0.

    Evaluation and its inverse agree to a few micrometres for offsets below 0.6 of the radius.
    elements : list of (length, curvature at start, curvature at end), m and 1/m, left positive
    start : m, station at which the first element begins (may be negative)
    heading : radians counter-clockwise from east, at `start`
    """

    def __init__(self, elements: Sequence[tuple[float, float, float]], start: float, heading: float):
        lengths, curvature_from, curvature_to = (np.array(column, dtype=float) for column in zip(*elements))
        borders = start + np.concatenate([[0.0], np.cumsum(lengths)])
        self.start, self.end = borders[0], borders[-1]
        self._nodes = np.arange(self.start, self.end + _SPACING, _SPACING)
        element = np.clip(np.searchsorted(borders, self._nodes, side="right") - 1, 0, len(lengths) - 1)
        self._bend_rate = ((curvature_to - curvature_from) / lengths)[element]
        self._bend = curvature_from[element] + self._bend_rate * (self._nodes - borders[element])
        step = np.full(len(self._nodes) - 1, _SPACING)
        turned = step * (self._bend[:-1] + self._bend[1:]) / 2
        theta = heading + np.concatenate([[0.0], np.cumsum(turned)])
        self._theta = theta
        # three-point Gauss quadrature of the tangent over each step
        points, weights = np.polynomial.legendre.leggauss(3)
        along = (points[:, None] + 1) / 2 * step
        angle = theta[:-1] + self._bend[:-1] * along + self._bend_rate[:-1] * along**2 / 2
        x = np.concatenate([[0.0], np.cumsum((weights[:, None] * np.cos(angle)).sum(0) * step / 2)])
        y = np.concatenate([[0.0], np.cumsum((weights[:, None] * np.sin(angle)).sum(0) * step / 2)])
        self._x, self._y, self._cos, self._sin = x, y, np.cos(theta), np.sin(theta)
        zero_x, zero_y = self.to_map(np.zeros(1), np.zeros(1))
        self._x, self._y = x - zero_x, y - zero_y

    def _node(self, s):
        return np.clip(np.rint((s - self.start) / _SPACING), 0, len(self._nodes) - 1).astype(np.intp)

    def heading(self, s: np.ndarray) -> np.ndarray:
        """Direction of the axis at (N,) stations, (N,) radians counter-clockwise from east."""
        k = self._node(s)
        u = s - self._nodes[k]
        return self._theta[k] + self._bend[k] * u + self._bend_rate[k] * u**2 / 2

    def curvature(self, s: np.ndarray) -> np.ndarray:
        """Curvature at (N,) stations, (N,) 1/m, positive in a left bend."""
        k = self._node(s)
        return self._bend[k] + self._bend_rate[k] * (s - self._nodes[k])

    def to_map(self, s: np.ndarray, d: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
        """x and y (m, local) of stations and offsets (m, left positive), arrays of one shape."""
        k = self._node(s)
        u = s - self._nodes[k]
        bend, rate = self._bend[k], self._bend_rate[k]
        ahead = u - bend**2 * u**3 / 6
        aside = bend * u**2 / 2 + rate * u**3 / 6
        turn = bend * u + rate * u**2 / 2
        ahead = ahead - d * np.sin(turn)
        aside = aside + d * np.cos(turn)
        cos, sin = self._cos[k], self._sin[k]
        return self._x[k] + ahead * cos - aside * sin, self._y[k] + ahead * sin + aside * cos

    def locate(self, x: np.ndarray, y: np.ndarray, s: np.ndarray, steps: int = 2) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Station and offset, (N,) m, and cosine and sine of the direction of the axis there, of (N,) places x and y, m, local.

        s : (N,) m, approximate stations
        steps : of the iteration; one is enough within half a metre, two within 30 m
        """
        for _ in range(steps):
            k = self._node(s)
            cos, sin, bend = self._cos[k], self._sin[k], self._bend[k]
            dx, dy = x - self._x[k], y - self._y[k]
            ahead = dx * cos + dy * sin
            aside = dy * cos - dx * sin
            shrink = 1.0 - bend * aside
            u = ahead / shrink
            s = self._nodes[k] + u
        return s, aside - bend * ahead * u / 2, cos, sin


def winding_road(length: float, radius: float, straight: float = 30.0, transition: float = 20.0, arc: float = 45.0,
                 run_in: float = 70.0) -> list[tuple[float, float, float]]:
    """(length, curvature at start and end), m and 1/m, left positive, of the elements of a road of any length with bends to both sides in turn.

    It begins with a straight of `run_in` + `straight` metres, followed by clothoid, arc of `radius`, clothoid, half a straight, and the same to
    the other side. The heading returns to its first value, so that the road never meets itself.
    """
    elements, reached, sign = [(run_in + straight, 0.0, 0.0)], straight, 1.0
    while reached < length + run_in:
        bend = sign / radius
        elements += [
            (transition, 0.0, bend), (arc, bend, bend), (transition, bend, 0.0), (straight / 2, 0.0, 0.0)]
        reached += 2 * transition + arc + straight / 2
        sign = -sign
    return elements
