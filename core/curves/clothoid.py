"""Clothoids: the curve whose curvature changes linearly along it, as on the transition between straight and arc."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .base import Curve, CurveFit, checked_points
from .robust import CurveProblem, median
from .weights import FITS


def _gauss(count):
    """Nodes and weights on [0, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (nodes + 1) / 2, weights / 2


# derived: Gauss-Legendre rules that integrate a clothoid to 1e-12 of its length, by how far it turns
GAUSS_RULES = _gauss(8), _gauss(14), _gauss(24)
STEP_RULE = _gauss(3)    # derived: for steps of decimetres


def gauss_rule(turn: float | np.ndarray) -> int | np.ndarray:
    """Index of the GAUSS_RULES for a clothoid that turns by so many radians (float or array)."""
    return (turn >= FITS.medium_rule_turn) * 1 + (turn >= FITS.fine_rule_turn) * 1


@dataclass(frozen=True)
class Clothoid(Curve):
    """``theta(u) = direction + bend u + change u^2 / 2``, from (x, y)."""

    x: float   # x, y: start, metres
    y: float
    direction: float   # heading at the start, radians
    bend: float   # curvature at the start, 1/m, positive to the left
    change: float   # change of curvature, 1/m^2
    length: float   # metres

    kind = "clothoid"

    def at(self, u: np.ndarray) -> np.ndarray:
        u = np.asarray(u, float)
        nodes, weights = self.rule(u)
        turn = self.heading(u[:, None] * nodes)
        points = np.stack([np.einsum("nk,k->n", np.cos(turn), weights), np.einsum("nk,k->n", np.sin(turn), weights)], axis=1)
        points *= u[:, None]
        return np.add(points, (self.x, self.y), out=points)

    def rule(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The one of GAUSS_RULES for arc lengths up to u."""
        far = float(np.abs(u).max()) if len(u) else 0.0
        turn = abs(self.bend) * far + abs(self.change) * far**2 / 2
        return GAUSS_RULES[gauss_rule(turn)]

    def heading(self, u: np.ndarray | float) -> np.ndarray:
        u = np.asarray(u, float)
        return self.direction + self.bend * u + 0.5 * self.change * u * u

    def curvature(self, u: np.ndarray | float) -> np.ndarray:
        return self.bend + self.change * np.asarray(u, float)

    def cut(self, first: float, last: float) -> Clothoid:
        """The part from arc length `first` to `last`."""
        (x, y), = self.at(np.array([first]))
        return Clothoid(float(x), float(y), float(self.heading(first)), float(self.curvature(first)), self.change, float(last - first))


def fit_clothoids(lines: Sequence[tuple[np.ndarray, np.ndarray]], max_misfit: float = np.inf) -> list[CurveFit]:
    """Fit a clothoid to each line by robust orthogonal least squares, from the first point's projection to the last's.

    The start is a parabola through the headings of chords between bins of points (theta is a parabola of u on a clothoid); the unknowns are those
    at the middle, where they are correlated least.

    lines, max_misfit : as of `fit_lines`, N >= 5
    """
    return [_ClothoidProblem(*checked_points(x, y, 5)).fit(max_misfit) for x, y in lines]


class _ClothoidProblem(CurveProblem):
    """A clothoid, by its offset, heading, curvature and the change of it where it passes the centroid; places along it are arc lengths."""

    def start(self):
        curve, u = _start(self.x, self.y)
        here = float(curve.project(np.zeros(1), np.zeros(1))[0][0])
        curve, u = curve.cut(here, here), u - here
        offset, half = curve.y * np.cos(self.direction) - curve.x * np.sin(self.direction), max(float(np.abs(u).max()), 1e-3)
        return np.array([offset, curve.direction, curve.bend, curve.change]), np.array([1.0, 1.0 / half, 2.0 / half**2, 6.0 / half**3]), u

    def _curve(self, unknown):
        offset, heading, bend, change = unknown.tolist()
        return Clothoid(-offset * np.sin(self.direction), offset * np.cos(self.direction), heading, bend, change, 0.0)

    def evaluate(self, unknown, along):
        curve = self._curve(unknown)
        x, y, bend, change = curve.x, curve.y, curve.bend, curve.change
        cosines, sines = _moments(curve, along)
        x, y, u = x + along * cosines[0], y + along * sines[0], along
        lengths = np.stack([u, u**2, u**3 / 2])
        for _ in range(FITS.max_newton_steps):
            ahead, across, *_ = self._separation(x, y, curve.heading(u))
            step = ahead / np.minimum(np.maximum(1 - (bend + change * u) * across, 0.3), 3.0)
            turn = curve.heading(u + np.multiply.outer(STEP_RULE[0], step))
            x, y = (at + step * np.einsum("k,kn->n", STEP_RULE[1], way) for at, way in ((x, np.cos(turn)), (y, np.sin(turn))))
            u = u + step
            if np.abs(step).max() < FITS.newton_tolerance:
                break
        _, across, c, s = self._separation(x, y, curve.heading(u))
        # the projection is where the gap is shortest, so that to first order only the curve's own shift counts
        turn = curve.heading(u) - self.direction
        return across, np.stack([-np.cos(turn), *(-s * sines * lengths - c * cosines * lengths)]), u

    def _separation(self, x, y, turn):
        dx, dy = self.x - x, self.y - y
        c, s = np.cos(turn), np.sin(turn)
        return dx * c + dy * s, dy * c - dx * s, c, s

    def fit(self, max_misfit):
        """The CurveFit, from the first point's projection to the last's."""
        unknown, distances, u = self.fitted(max_misfit)
        curve = self._curve(unknown).cut(float(u[0]), float(u[-1]))
        return CurveFit(curve.moved(*self.centre.tolist()), distances, 5)


def _moments(curve, u):
    """(3, N) each: means over [0, u] of cos and sin of the heading, times the share of the way to the power of 0, 1 and 2."""
    nodes, weights = curve.rule(u)
    turn = curve.heading(np.multiply.outer(nodes, u))
    powers = weights * nodes ** np.arange(3)[:, None]
    # not by BLAS, whose last digit depends on how many threads it has
    return np.einsum("pk,kn->pn", powers, np.cos(turn)), np.einsum("pk,kn->pn", powers, np.sin(turn))


def _start(x, y):
    """A clothoid that begins at the middle of points, and (N,) their arc lengths."""
    count = int(np.clip(len(x) // 3, 3, FITS.max_start_bins))
    bins = np.array_split(np.arange(len(x)), count)   # of successive points
    bx, by = (np.array([median(values[rows]) for rows in bins]) for values in (x, y))
    length, heading = np.hypot(np.diff(bx), np.diff(by)), np.unwrap(np.arctan2(np.diff(by), np.diff(bx)))
    arcs, bin_of = np.append(0.0, np.cumsum(length)), np.repeat(np.arange(count), [len(rows) for rows in bins])
    # the last bin begins no chord and takes the heading of the one before
    turn = np.append(heading, heading[-1])[bin_of]
    along = arcs[bin_of] + (x - bx[bin_of]) * np.cos(turn) + (y - by[bin_of]) * np.sin(turn)
    centre = (along[0] + along[-1]) / 2
    at, u = arcs[:-1] + length / 2 - centre, along - centre
    direction, bend, change = np.append(np.polynomial.polynomial.polyfit(at, heading, min(len(at) - 1, 2)), 0.0)[:3]
    curve = Clothoid(0.0, 0.0, float(direction), float(bend), 2 * float(change), 0.0)
    cosines, sines = _moments(curve, u)
    return curve.moved(median(x - u * cosines[0]), median(y - u * sines[0])), u
