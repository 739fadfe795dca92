"""Clothoids through points."""

from dataclasses import dataclass

import numpy as np

from .base import Curve, Fit, checked
from .batched_lsq import Places, minimise_each
from .line_circle import chords

# The clothoid: curvature grows evenly along it, as on the transition between straight and arc.

def _gauss(count):
    """Nodes and weights on [0, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return (nodes + 1) / 2, weights / 2


# Gauss points that integrate a clothoid to 1e-12 of its length, by how far it turns (radians)
RULES = _gauss(8), _gauss(14), _gauss(24)
LITTLE_TURN, MORE_TURN = 0.8, 3.0
STEP = _gauss(3)   # for steps of decimetres


def rule_of(turn):
    """Which of RULES serves for a turn (radians, float or array) of a clothoid."""
    return (turn >= LITTLE_TURN) * 1 + (turn >= MORE_TURN) * 1


@dataclass(frozen=True)
class Clothoid(Curve):
    """theta(u) = direction + bend u + change u^2 / 2, from (x, y)."""

    x: float
    y: float
    direction: float  # radians
    bend: float       # curvature at the start, 1/m
    change: float     # of curvature, 1/m^2
    length: float

    kind = "clothoid"

    def at(self, u):
        u = np.asarray(u, float)
        nodes, weights = self._rule(u)
        turn = self.heading(u[:, None] * nodes)
        places = np.stack([np.cos(turn) @ weights, np.sin(turn) @ weights], axis=1)
        places *= u[:, None]
        return np.add(places, (self.x, self.y), out=places)

    def _rule(self, u):
        far = float(np.abs(u).max()) if len(u) else 0.0
        turn = abs(self.bend) * far + abs(self.change) * far**2 / 2
        return RULES[rule_of(turn)]

    def heading(self, u):
        u = np.asarray(u, float)
        return self.direction + self.bend * u + 0.5 * self.change * u * u

    def curvature(self, u):
        return self.bend + self.change * np.asarray(u, float)

    def moved(self, dx, dy):
        return Clothoid(self.x + dx, self.y + dy, self.direction, self.bend, self.change, self.length)

    def reversed(self):
        (x, y), = self.at(np.array([self.length]))
        return Clothoid(float(x), float(y), float(self.heading(self.length)) + np.pi,
                        -float(self.curvature(self.length)), self.change, self.length)

    def cut(self, first, last):
        """The part from arc length `first` to `last`."""
        (x, y), = self.at(np.array([first]))
        return Clothoid(float(x), float(y), float(self.heading(first)), float(self.curvature(first)),
                        self.change, float(last - first))

FOOT_STEPS = 10   # of Newton's
SETTLED = 1e-5    # m: a step this short leaves 1e-10
MOST_BINS = 12    # of the places, from whose middles a start is made


def fit_clothoid(x, y):
    """A clothoid by robust orthogonal least squares.

    The start is a parabola through the headings of chords between bins of points
    (theta is a parabola of u on a clothoid); the unknowns are taken at the middle,
    where they disturb each other least.

    Parameters
    ----------
    x, y : (N,) metres, N >= 5, ordered along the line

    Returns
    -------
    Fit with a Clothoid from the first point's foot to the last's.
    """
    return fit_clothoids([(x, y)])[0]


def fit_clothoids(places, hopeless=np.inf):
    """`fit_clothoid` of many lines at once: places is a list of (x, y). What misses by more than `hopeless` metres is not refined."""
    return minimise_each([checked(x, y, 5) for x, y in places], _Clothoids, hopeless)


class _Clothoids:
    """Clothoids through the places of several lines, by x, y, heading, curvature and its change: a problem for `minimise_each`.

    The state is the arc lengths of the feet.
    """

    def __init__(self, places, x, y, about=None):
        self.places = places
        self.about = chords(places, x, y)[:2] if about is None else about
        self.dx, self.dy = x - self.about[0][places.owner], y - self.about[1][places.owner]

    def start(self):
        """(L, 5) unknowns to begin with; sets the scale and the state."""
        unknown, u = _start(self.places, self.dx, self.dy)
        half = np.maximum(self.places.most(np.abs(u)), 1e-3)
        self.scale = np.stack([np.ones(len(half)), np.ones(len(half)), 1.0 / half, 2.0 / half**2, 6.0 / half**3], axis=1)
        self.state = (u, *np.zeros((5, len(u))))
        return unknown

    def on(self, places, x, y, lines, state):
        """The same unknowns for other places of some of the lines."""
        part = _Clothoids(places, x, y, tuple(values[lines] for values in self.about))
        part.scale, part.state = self.scale[lines], state
        return part

    def only(self, lines, rows):
        """Some of the lines, whose places are `rows`."""
        part = object.__new__(_Clothoids)
        part.places, part.about = Places(self.places.counts[lines]), tuple(values[lines] for values in self.about)
        part.dx, part.dy, part.scale = self.dx[rows], self.dy[rows], self.scale[lines]
        part.state = tuple(values[rows] for values in self.state)
        return part

    def at(self, unknown, state):
        places, u = self.places, state[0]
        x, y, direction, bend, change = (column[places.owner] for column in unknown.T)
        cosines, sines = _moments(places, unknown, direction, bend, change, u)
        x, y = x + u * cosines[0], y + u * sines[0]
        lengths = np.stack([u, u**2, u**3 / 2])
        cosines, sines = cosines * lengths, sines * lengths
        moving = np.ones(len(places.counts), bool)
        for _ in range(FOOT_STEPS):
            along, across, *_ = self._gap(x, y, direction + (bend + 0.5 * change * u) * u)
            step = along / np.minimum(np.maximum(1 - (bend + change * u) * across, 0.3), 3.0)
            settled = places.most(np.abs(step)) < SETTLED
            step *= moving[places.owner]
            nodes = u + np.multiply.outer(STEP[0], step)
            turn = direction + (bend + 0.5 * change * nodes) * nodes
            x, y, u = x + step * (STEP[1] @ np.cos(turn)), y + step * (STEP[1] @ np.sin(turn)), u + step
            moving &= ~settled
            if not moving.any():
                break
        _, across, c, s = self._gap(x, y, direction + (bend + 0.5 * change * u) * u)
        # the foot is where the gap is shortest, so that to first order only the curve's own shift counts
        return across, (u, s, -c, *(-s * sines - c * cosines))

    def _gap(self, x, y, turn):
        dx, dy = self.dx - x, self.dy - y
        c, s = np.cos(turn), np.sin(turn)
        return dx * c + dy * s, dy * c - dx * s, c, s

    def jacobian(self, unknown, state):
        return np.stack(state[1:])

    def fit(self, line, unknown, x, y, residuals, state):
        curve = Clothoid(*unknown.tolist(), 0.0)
        found = curve.cut(float(state[0][0]), float(state[0][-1])).moved(float(self.about[0][line]), float(self.about[1][line]))
        return Fit(found, residuals.copy(), 5)


def _moments(places, unknown, direction, bend, change, u):
    """(3, N) each: means over [0, u] of cos and sin of the heading, times the share of the way to the power of 0, 1 and 2."""
    far = places.most(np.abs(u))
    rule = rule_of(np.abs(unknown[:, 3]) * far + np.abs(unknown[:, 4]) * far**2 / 2)[places.owner]
    least, most = int(rule.min()), int(rule.max())
    cosines, sines = np.empty((2, 3, len(u)))
    for k in range(least, most + 1):
        rows = slice(None) if least == most else np.flatnonzero(rule == k)
        nodes, weights = RULES[k]
        at = np.multiply.outer(nodes, u[rows])
        turn = direction[rows] + (bend[rows] + 0.5 * change[rows] * at) * at
        powers = weights * nodes ** np.arange(3)[:, None]
        cosines[:, rows], sines[:, rows] = powers @ np.cos(turn), powers @ np.sin(turn)
    return cosines, sines


def _start(places, x, y):
    """Unknowns (L, 5) at the middles of the places of every line, and (N,) arc lengths of the places."""
    lines, owner = np.arange(len(places.counts)), places.owner
    count = np.clip(places.counts // 3, 3, MOST_BINS)
    # bins of successive places, the first of them one place larger
    size, larger = (values[owner] for values in (places.counts // count, places.counts % count))
    within = np.arange(len(owner)) - places.starts[owner]
    bins = np.where(within < larger * (size + 1), within // (size + 1), (within - larger) // size)
    binned = Places(np.bincount(owner * MOST_BINS + bins, minlength=len(lines) * MOST_BINS).reshape(len(lines), -1)[
        np.arange(MOST_BINS) < count[:, None]])
    first, last = np.cumsum(count) - count, np.cumsum(count) - 1
    bx, by = binned.medians(x), binned.medians(y)
    # chords between bins; the last of a line leads nowhere and takes the place of the one before
    cx, cy = np.append(np.diff(bx), 0.0), np.append(np.diff(by), 0.0)
    length, heading = np.hypot(cx, cy), np.arctan2(cy, cx)
    length[last], heading[last] = 0.0, heading[last - 1]
    at = np.cumsum(length) - length
    at -= np.repeat(at[first], count)
    turn = np.diff(heading, prepend=heading[0])
    turn[first] = 0.0
    heading = np.cumsum(turn - 2 * np.pi * np.round(turn / (2 * np.pi)))
    heading += np.repeat(np.arctan2(cy, cx)[first] - heading[first], count)
    c, s = np.cos(heading)[binned.owner], np.sin(heading)[binned.owner]
    along = at[binned.owner] + (x - bx[binned.owner]) * c + (y - by[binned.owner]) * s
    centre = (along[places.starts] + along[places.starts + places.counts - 1]) / 2
    u = along - centre[owner]
    direction, bend, change = _parabolas(count, at + length / 2 - np.repeat(centre, count), heading)
    unknown = np.stack([np.zeros(len(lines)), np.zeros(len(lines)), direction, bend, 2 * change], axis=1)
    cosines, sines = _moments(places, unknown, *(column[owner] for column in unknown.T[2:]), u)
    unknown[:, 0], unknown[:, 1] = places.medians(x - u * cosines[0]), places.medians(y - u * sines[0])
    return unknown, u


def _parabolas(count, at, heading):
    """(L,) coefficients of order 0, 1 and 2 of the parabola (the straight line of two) through all but the last of each line's values."""
    kept = Places(count - 1)
    rows = np.delete(np.arange(len(at)), np.cumsum(count) - 1)
    at, heading = at[rows], heading[rows]
    scale = np.maximum(kept.most(np.abs(at)), 1e-6)
    powers = (at / scale[kept.owner]) ** np.arange(5)[:, None]
    sums, right = kept.sums(powers).T, kept.sums(powers[:3] * heading).T
    normal = sums[:, np.add.outer(np.arange(3), np.arange(3))]
    two = kept.counts < 3
    normal[two, 2, :], normal[two, :, 2], normal[two, 2, 2], right[two, 2] = 0.0, 0.0, 1.0, 0.0
    normal += 1e-12 * np.eye(3)
    return (np.linalg.solve(normal, right[:, :, None])[:, :, 0] / scale[:, None] ** np.arange(3)).T
