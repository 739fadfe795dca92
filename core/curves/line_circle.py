"""Straight lines and circles through points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .base import Arc, CurveFit, checked_points
from .robust import PointGroups, fit_batch


def fit_line(x: np.ndarray, y: np.ndarray) -> CurveFit:
    """Fit a straight line by orthogonal, robust least squares.

    Parameters
    ----------
    x, y : (N,) metres, N >= 2, ordered along the line

    Returns
    -------
    CurveFit with an Arc of curvature 0 from the first point's projection to the last's.
    """
    return fit_lines([(x, y)])[0]


def fit_circle(x: np.ndarray, y: np.ndarray) -> CurveFit:
    """Fit a circle: Taubin's algebraic fit as start, then the geometric distance, robustly.

    The unknowns are heading, offset and curvature at the points' middle, so that a
    nearly straight line is as easy as a tight bend. Kasa's simpler fit is not used:
    it is biased towards small radii on short arcs.

    Parameters
    ----------
    x, y : (N,) metres, N >= 3, ordered along the line

    Returns
    -------
    CurveFit with an Arc from the first point's projection to the last's.

    References
    ----------
    Taubin (1991), IEEE PAMI 13, 1115-1138; Chernov (2010), Circular and linear regression, ch. 5-7.
    """
    return fit_circles([(x, y)])[0]


def fit_lines(lines: Sequence[tuple[np.ndarray, np.ndarray]], max_misfit: float = np.inf) -> list[CurveFit]:
    """`fit_line` of many lines at once.

    Parameters
    ----------
    lines : list of (x, y), each (N,) metres, N >= 2, ordered along the line
    max_misfit : metres; a curve from which a twentieth of the points lie farther is not refined

    Returns
    -------
    list of CurveFit, one for each line
    """
    return fit_batch([checked_points(x, y, 2) for x, y in lines], _LineProblem, max_misfit)


def fit_circles(lines: Sequence[tuple[np.ndarray, np.ndarray]], max_misfit: float = np.inf) -> list[CurveFit]:
    """`fit_circle` of many lines at once.

    Parameters
    ----------
    lines : list of (x, y), each (N,) metres, N >= 3, ordered along the line
    max_misfit : metres; a curve from which a twentieth of the points lie farther is not refined

    Returns
    -------
    list of CurveFit, one for each line
    """
    return fit_batch([checked_points(x, y, 3) for x, y in lines], _CircleProblem, max_misfit)


def _taubin(groups, x, y):
    """(L,) curvatures of Taubin's circles through the points of several lines."""
    owner, count = groups.owner, groups.counts
    dx, dy = x - (groups.sums(x) / count)[owner], y - (groups.sums(y) / count)[owner]
    size = np.sqrt(groups.sums(dx**2 + dy**2) / count)
    scale = np.where(size > 0, size, 1.0)
    dx, dy = dx / scale[owner], dy / scale[owner]
    q = dx**2 + dy**2
    # Taubin's constraint, reduced to the least eigenvector of a 3 x 3 matrix (Chernov's TaubinSVD)
    design = np.stack([(q - 1.0) / 2.0, dx, dy])
    above, below = np.triu_indices(3)
    normal = np.empty((len(count), 3, 3))
    normal[:, above, below] = normal[:, below, above] = (groups.sums(design[above] * design[below]) / count).T
    a, b, c = np.linalg.eigh(normal)[1][:, :, 0].T
    root = b * b + c * c + a * a
    bend = np.abs(a) / np.sqrt(np.maximum(root, 1e-300)) / scale
    direction = chords(groups, x, y)[2]
    # the centre lies at (-b, -c) / a
    side = np.sign(np.where(a == 0, 0.0, -np.sign(a) * (c * np.cos(direction) - b * np.sin(direction))))
    return np.where((root > 0) & (bend >= 1e-9) & (size > 0), bend * side, 0.0)


def chords(groups: PointGroups, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The line through the centroids of the two halves of ordered points.

    Unlike the principal axis it keeps the order of the points, and it does not
    turn where an arc is nearly half a circle.

    Parameters
    ----------
    groups : PointGroups of L lines
    x, y : (N,) metres

    Returns
    -------
    x, y : (L,) centroids, metres
    direction : (L,) radians
    """
    half = np.maximum(groups.counts // 2, 1)
    within = np.arange(len(groups.owner)) - groups.starts[groups.owner]
    tail = within >= (groups.counts - half)[groups.owner]
    head = within < half[groups.owner]
    step = [(groups.sums(np.where(tail, v, 0.0)) - groups.sums(np.where(head, v, 0.0))) / half for v in (x, y)]
    return groups.sums(x) / groups.counts, groups.sums(y) / groups.counts, np.arctan2(step[1], step[0])


def chord(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, float]:
    """`chords` of one line: its centroid (2,), metres, and direction, radians."""
    middle_x, middle_y, direction = chords(PointGroups([len(x)]), x, y)
    return np.array([middle_x[0], middle_y[0]]), float(direction[0])


class _CircleProblem:
    """Circles through the points of several lines, in the form of offset, heading and curvature: a problem for `fit_batch`."""

    free_bend = True
    state = ()

    def __init__(self, groups, x, y, about=None):
        self.groups = groups
        self.about = chords(groups, x, y) if about is None else about
        owner, (middle_x, middle_y, self.direction) = groups.owner, self.about
        self.dx, self.dy = x - middle_x[owner], y - middle_y[owner]
        size = np.maximum(np.sqrt(groups.sums(self.dx**2 + self.dy**2) / groups.counts), 1e-3)
        self.scale = size[:, None] ** -np.arange(2.0 + self.free_bend)

    def start(self):
        """(L, P) unknowns to begin with."""
        groups, size = self.groups, 1.0 / self.scale[:, 1]
        bend = _taubin(groups, self.dx, self.dy) if self.free_bend else np.zeros(len(size))
        c, s = np.cos(self.direction)[groups.owner], np.sin(self.direction)[groups.owner]
        sagitta = groups.sums(self.dy * c - self.dx * s) / groups.counts
        return np.stack([sagitta - bend * size**2 / 2, np.zeros(len(bend)), bend][:2 + self.free_bend], axis=1)

    def with_points(self, groups, x, y, lines, state):
        """The same unknowns for other points of some of the lines."""
        return type(self)(groups, x, y, tuple(values[lines] for values in self.about))

    def subset(self, lines, rows):
        """Some of the lines, whose points are `rows`."""
        part = object.__new__(type(self))
        part.groups, part.about = PointGroups(self.groups.counts[lines]), tuple(values[lines] for values in self.about)
        part.direction, part.dx, part.dy, part.scale = part.about[2], self.dx[rows], self.dy[rows], self.scale[lines]
        return part

    def evaluate(self, unknown, state):
        owner = self.groups.owner
        turned = self.direction + unknown[:, 1]
        c, s = np.cos(turned)[owner], np.sin(turned)[owner]
        along, across = self.dx * c + self.dy * s, self.dy * c - self.dx * s - unknown[:, 0][owner]
        if not self.free_bend:
            return across, (along,)
        k, square = unknown[:, 2][owner], along**2 + across**2
        lift = 2 * across - k * square
        root = np.sqrt(np.maximum(1 - k * lift, 1e-12))
        e = lift / (1 + root)
        # how the distance changes with `across`, `along` and k
        by_across, by_along = (1 - k * across) / root, -k * along / root
        return e, (by_across, by_along * (across + unknown[:, 0][owner]) - by_across * along, (e**2 - square) / (2 * root))

    def jacobian(self, unknown, state):
        by_across, by_heading, by_bend = state
        return np.stack([-by_across, by_heading, by_bend])

    def fit(self, line, unknown, x, y, residuals, state):
        middle_x, middle_y, direction = (values[line] for values in self.about)
        turned = direction + unknown[1]
        arc = Arc(float(middle_x - unknown[0] * np.sin(turned)), float(middle_y + unknown[0] * np.cos(turned)), float(turned),
                  float(unknown[2]) if self.free_bend else 0.0, 0.0)
        u, _ = arc.project(x[[0, -1]], y[[0, -1]])
        first, last = float(u[0]), float(u[1])
        (x0, y0), = arc.at(u[:1])
        return CurveFit(Arc(float(x0), float(y0), float(arc.heading(first)), arc.bend, last - first), residuals.copy(), len(unknown))


class _LineProblem(_CircleProblem):
    """Straight lines through the points of several lines."""

    free_bend = False

    def jacobian(self, unknown, state):
        return np.stack([np.full(len(state[0]), -1.0), -state[0]])
