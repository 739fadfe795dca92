"""Clothoids: the curve whose curvature changes linearly along it, as on the transition between straight and arc."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .base import Curve, CurveFit, checked_points
from .robust import PointGroups, fit_batch
from .simple_curves import chords
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
        nodes, weights = self._rule(u)
        turn = self.heading(u[:, None] * nodes)
        points = np.stack([np.cos(turn) @ weights, np.sin(turn) @ weights], axis=1)
        points *= u[:, None]
        return np.add(points, (self.x, self.y), out=points)

    def _rule(self, u):
        far = float(np.abs(u).max()) if len(u) else 0.0
        turn = abs(self.bend) * far + abs(self.change) * far**2 / 2
        return GAUSS_RULES[gauss_rule(turn)]

    def heading(self, u: np.ndarray | float) -> np.ndarray:
        u = np.asarray(u, float)
        return self.direction + self.bend * u + 0.5 * self.change * u * u

    def curvature(self, u: np.ndarray | float) -> np.ndarray:
        return self.bend + self.change * np.asarray(u, float)

    def reversed(self) -> Clothoid:
        (x, y), = self.at(np.array([self.length]))
        return Clothoid(float(x), float(y), float(self.heading(self.length)) + np.pi,
                        -float(self.curvature(self.length)), self.change, self.length)

    def cut(self, first: float, last: float) -> Clothoid:
        """The part from arc length `first` to `last`."""
        (x, y), = self.at(np.array([first]))
        return Clothoid(float(x), float(y), float(self.heading(first)), float(self.curvature(first)),
                        self.change, float(last - first))


def fit_clothoids(lines: Sequence[tuple[np.ndarray, np.ndarray]], max_misfit: float = np.inf) -> list[CurveFit]:
    """Fit a clothoid to each line by robust orthogonal least squares, from the first point's projection to the last's.

    The start is a parabola through the headings of chords between bins of points (theta is a parabola of u on a clothoid); the unknowns are those
    at the middle, where they are correlated least.

    lines, max_misfit : as of `fit_batch`, N >= 5
    """
    return fit_batch([checked_points(x, y, 5) for x, y in lines], _ClothoidProblem, max_misfit)


class _ClothoidProblem:
    """Clothoids through the points of several lines, by x, y, heading, curvature and its change: a problem for `fit_batch`.

    The state is the arc lengths of the projections.
    """

    def __init__(self, groups, x, y, about=None):
        self.groups = groups
        self.about = chords(groups, x, y)[:2] if about is None else about
        self.dx, self.dy = x - self.about[0][groups.owner], y - self.about[1][groups.owner]

    def start(self):
        """(L, 5) unknowns to begin with; sets the scale and the state."""
        unknown, u = _start(self.groups, self.dx, self.dy)
        half = np.maximum(self.groups.maxima(np.abs(u)), 1e-3)
        self.scale = np.stack([np.ones(len(half)), np.ones(len(half)), 1.0 / half, 2.0 / half**2, 6.0 / half**3], axis=1)
        self.state = (u, *np.zeros((5, len(u))))
        return unknown

    def with_points(self, groups, x, y, lines, state):
        """The same unknowns for other points of some of the lines."""
        part = _ClothoidProblem(groups, x, y, tuple(values[lines] for values in self.about))
        part.scale, part.state = self.scale[lines], state
        return part

    def subset(self, lines, rows):
        """Some of the lines, whose points are `rows`."""
        part = object.__new__(_ClothoidProblem)
        part.groups, part.about = PointGroups(self.groups.counts[lines]), tuple(values[lines] for values in self.about)
        part.dx, part.dy, part.scale = self.dx[rows], self.dy[rows], self.scale[lines]
        part.state = tuple(values[rows] for values in self.state)
        return part

    def evaluate(self, unknown, state):
        groups, u = self.groups, state[0]
        x, y, direction, bend, change = (column[groups.owner] for column in unknown.T)
        cosines, sines = _moments(groups, unknown, direction, bend, change, u)
        x, y = x + u * cosines[0], y + u * sines[0]
        lengths = np.stack([u, u**2, u**3 / 2])
        cosines, sines = cosines * lengths, sines * lengths
        moving = np.ones(len(groups.counts), bool)
        for _ in range(FITS.max_newton_steps):
            along, across, *_ = self._separation(x, y, direction + (bend + 0.5 * change * u) * u)
            step = along / np.minimum(np.maximum(1 - (bend + change * u) * across, 0.3), 3.0)
            settled = groups.maxima(np.abs(step)) < FITS.newton_tolerance
            step *= moving[groups.owner]
            nodes = u + np.multiply.outer(STEP_RULE[0], step)
            turn = direction + (bend + 0.5 * change * nodes) * nodes
            x, y, u = x + step * (STEP_RULE[1] @ np.cos(turn)), y + step * (STEP_RULE[1] @ np.sin(turn)), u + step
            moving &= ~settled
            if not moving.any():
                break
        _, across, c, s = self._separation(x, y, direction + (bend + 0.5 * change * u) * u)
        # the projection is where the gap is shortest, so that to first order only the curve's own shift counts
        return across, (u, s, -c, *(-s * sines - c * cosines))

    def _separation(self, x, y, turn):
        dx, dy = self.dx - x, self.dy - y
        c, s = np.cos(turn), np.sin(turn)
        return dx * c + dy * s, dy * c - dx * s, c, s

    def jacobian(self, unknown, state):
        return np.stack(state[1:])

    def fit(self, line, unknown, x, y, residuals, state):
        curve = Clothoid(*unknown.tolist(), 0.0)
        moved = curve.cut(float(state[0][0]), float(state[0][-1])).moved(float(self.about[0][line]), float(self.about[1][line]))
        return CurveFit(moved, residuals.copy(), 5)


def _moments(groups, unknown, direction, bend, change, u):
    """(3, N) each: means over [0, u] of cos and sin of the heading, times the share of the way to the power of 0, 1 and 2."""
    far = groups.maxima(np.abs(u))
    rule = gauss_rule(np.abs(unknown[:, 3]) * far + np.abs(unknown[:, 4]) * far**2 / 2)[groups.owner]
    least, most = int(rule.min()), int(rule.max())
    cosines, sines = np.empty((2, 3, len(u)))
    for k in range(least, most + 1):
        rows = slice(None) if least == most else np.flatnonzero(rule == k)
        nodes, weights = GAUSS_RULES[k]
        arcs = np.multiply.outer(nodes, u[rows])
        turn = direction[rows] + (bend[rows] + 0.5 * change[rows] * arcs) * arcs
        powers = weights * nodes ** np.arange(3)[:, None]
        cosines[:, rows], sines[:, rows] = powers @ np.cos(turn), powers @ np.sin(turn)
    return cosines, sines


def _start(groups, x, y):
    """Unknowns (L, 5) at the middles of the points of every line, and (N,) arc lengths of the points."""
    lines, owner = np.arange(len(groups.counts)), groups.owner
    count = np.clip(groups.counts // 3, 3, FITS.max_start_bins)
    # bins of successive points, the first of them one point larger
    size, larger = (values[owner] for values in (groups.counts // count, groups.counts % count))
    within = np.arange(len(owner)) - groups.starts[owner]
    bins = np.where(within < larger * (size + 1), within // (size + 1), (within - larger) // size)
    binned = PointGroups(np.bincount(owner * FITS.max_start_bins + bins, minlength=len(lines) * FITS.max_start_bins).reshape(len(lines), -1)[
        np.arange(FITS.max_start_bins) < count[:, None]])
    first, last = np.cumsum(count) - count, np.cumsum(count) - 1
    bx, by = binned.medians(x), binned.medians(y)
    # chords between bins; the last of a line leads nowhere and takes the point of the one before
    cx, cy = np.append(np.diff(bx), 0.0), np.append(np.diff(by), 0.0)
    length, heading = np.hypot(cx, cy), np.arctan2(cy, cx)
    length[last], heading[last] = 0.0, heading[last - 1]
    arcs = np.cumsum(length) - length
    arcs -= np.repeat(arcs[first], count)
    turn = np.diff(heading, prepend=heading[0])
    turn[first] = 0.0
    heading = np.cumsum(turn - 2 * np.pi * np.round(turn / (2 * np.pi)))
    heading += np.repeat(np.arctan2(cy, cx)[first] - heading[first], count)
    c, s = np.cos(heading)[binned.owner], np.sin(heading)[binned.owner]
    along = arcs[binned.owner] + (x - bx[binned.owner]) * c + (y - by[binned.owner]) * s
    centre = (along[groups.starts] + along[groups.starts + groups.counts - 1]) / 2
    u = along - centre[owner]
    direction, bend, change = _parabolas(count, arcs + length / 2 - np.repeat(centre, count), heading)
    unknown = np.stack([np.zeros(len(lines)), np.zeros(len(lines)), direction, bend, 2 * change], axis=1)
    cosines, sines = _moments(groups, unknown, *(column[owner] for column in unknown.T[2:]), u)
    unknown[:, 0], unknown[:, 1] = groups.medians(x - u * cosines[0]), groups.medians(y - u * sines[0])
    return unknown, u


def _parabolas(count, at, heading):
    """(L,) coefficients of order 0, 1 and 2 of the parabola (the straight line of two) through all but the last of each line's values."""
    chord_groups = PointGroups(count - 1)
    rows = np.delete(np.arange(len(at)), np.cumsum(count) - 1)
    at, heading = at[rows], heading[rows]
    scale = np.maximum(chord_groups.maxima(np.abs(at)), 1e-6)
    powers = (at / scale[chord_groups.owner]) ** np.arange(5)[:, None]
    sums, right = chord_groups.sums(powers).T, chord_groups.sums(powers[:3] * heading).T
    normal = sums[:, np.add.outer(np.arange(3), np.arange(3))]
    two = chord_groups.counts < 3
    normal[two, 2, :], normal[two, :, 2], normal[two, 2, 2], right[two, 2] = 0.0, 0.0, 1.0, 0.0
    normal += 1e-12 * np.eye(3)
    return (np.linalg.solve(normal, right[:, :, None])[:, :, 0] / scale[:, None] ** np.arange(3)).T
