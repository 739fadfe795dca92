"""The clothoid: curvature grows evenly along it, as on the transition between straight and arc."""

from dataclasses import dataclass

import numpy as np

from .curve import Curve


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
