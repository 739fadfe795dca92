"""The clothoid: curvature grows evenly along it, as on the transition between straight and arc."""

from dataclasses import dataclass

import numpy as np

from .curve import Curve

# 24 Gauss points integrate a road's clothoid (a few radians of turn) to 1e-12
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)
_NODES, _WEIGHTS = (_NODES + 1) / 2, _WEIGHTS / 2


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
        turn = self.heading(u[:, None] * _NODES)
        return np.c_[self.x + u * (np.cos(turn) @ _WEIGHTS), self.y + u * (np.sin(turn) @ _WEIGHTS)]

    def heading(self, u):
        u = np.asarray(u, float)
        return self.direction + self.bend * u + 0.5 * self.change * u * u

    def curvature(self, u):
        return self.bend + self.change * np.asarray(u, float)

    def derivatives(self, u):
        """(N, 2, 5): how the place at u moves with (x, y, direction, bend, change)."""
        u = np.asarray(u, float)
        t = u[:, None] * _NODES
        turn = self.heading(t)
        normal = np.stack([-np.sin(turn), np.cos(turn)], 1)  # (N, 2, 24)
        out = np.zeros((len(u), 2, 5))
        out[:, 0, 0] = out[:, 1, 1] = 1.0
        for column, weight in ((2, np.ones_like(t)), (3, t), (4, 0.5 * t * t)):
            out[:, :, column] = u[:, None] * np.einsum("nak,nk,k->na", normal, weight, _WEIGHTS)
        return out

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
