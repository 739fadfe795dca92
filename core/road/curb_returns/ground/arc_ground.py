"""The ground about an arc along which a curb may run: how well two levels with the curb's height between them explain its points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...common.corners import FACE_LOWER_SHARE, FACE_PRIOR, FACE_UPPER_SHARE

GROUND_HALF_WIDTH = 0.8       # m on either side of the points that show the levels
CURB_HALF_WIDTH = 0.03        # m about the curb in which a point is on neither level, but anywhere between them
MIN_SIDE_POINTS = 3           # along LED_LENGTH on either side
POINT_HEIGHT_SIGMA, PLACE_SIGMA = 0.015, 0.03   # m, of a point about its level, and of a step of the known curb about its course
MAX_RESIDUAL = 3.0            # sigmas beyond which a point counts no more: objects, plants
# What is known beforehand: sigmas of the bottom's height at the end (m), of grade (m per m), height (m), crossfall (m per m) and bend (1/m)
BOTTOM_SIGMA, GRADE_SIGMA, RISE_SIGMA, CROSSFALL_SIGMA, ARC_BEND_SIGMA = 0.02, 0.03, 0.03, 0.04, 0.005
LEAST_STEPS = 8               # of the known curb, which are independent
Arc = tuple[float, float, float]


@dataclass
class CurbEnd:
    """The end of a curb: place and height of its bottom (local m), unit vector out of it, its side uphill (1: on the right, else -1), its
    height (m), and (3, N) its steps near the end: metres along and uphill from there, and height."""

    x: float
    y: float
    z: float
    tx: float
    ty: float
    uphill: float
    height: float
    trail: np.ndarray

    def ahead(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places t metres straight on."""
        return self.x + t * self.tx, self.y + t * self.ty

    def beside(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Metres along and uphill."""
        dx, dy = x - self.x, y - self.y
        return dx * self.tx + dy * self.ty, self.uphill * (dx * self.ty - dy * self.tx)


@dataclass
class GroundAboutArc:
    """Points about an arc from the end of a curb: t, u, z in m from there; `prior`: weights of what is known of the levels beforehand.

    All arcs near that one are compared on the same points: one that had more of them than another would seem to explain more.
    """

    t: np.ndarray
    u: np.ndarray
    z: np.ndarray
    end: CurbEnd
    prior: np.ndarray

    @staticmethod
    def about(t: np.ndarray, u: np.ndarray, z: np.ndarray, end: CurbEnd, start: float, stop: float, arc: Arc) -> GroundAboutArc | None:
        """The points between two distances; None where there are too few."""
        own = np.flatnonzero((t >= start) & (t < stop) & (np.abs(u - aside_of_arcs(np.array([arc]), t)[0]) < GROUND_HALF_WIDTH))
        if len(own) < 2 * MIN_SIDE_POINTS:
            return None
        prior = np.array([BOTTOM_SIGMA + 0.01 * start, GRADE_SIGMA, RISE_SIGMA, CROSSFALL_SIGMA])**-2.0
        return GroundAboutArc(t[own], u[own], z[own] - end.z, end, prior)

    def explained(self, arcs: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """How well (C, 3) arcs explain points and known curb.

        Returns (C,) sums of squares of what both differ from them, in sigmas, (C, 4) levels, their (C, N, 4) design and (C, N) m across.
        """
        t, z, end = self.t, self.z, self.end
        v = self.u - aside_of_arcs(arcs, t)
        on_level = np.abs(v) > CURB_HALF_WIDTH
        design = np.stack([np.ones_like(v), np.broadcast_to(t, v.shape), (v > 0).astype(float), v], axis=2)
        levels, residual = levels_of_arcs(design, z, on_level, self.prior, np.array([0.0, 0.0, end.height, 0.0]))
        low, height = residual + design[:, :, 2] * levels[:, 2:3] / POINT_HEIGHT_SIGMA, levels[:, 2:3] / POINT_HEIGHT_SIGMA
        # the curb itself is as high as either level, or anywhere between them
        residual = np.where(on_level, residual, low - np.clip(low, 0.0, np.maximum(height, 0.0)))
        at, aside, _ = end.trail
        off = (aside - aside_of_arcs(arcs, at)) / PLACE_SIGMA
        return cost_of_arcs(residual) + (off**2).mean(axis=1) * min(len(at), LEAST_STEPS) + (arcs[:, 2] / ARC_BEND_SIGMA)**2, levels, design, v

    def foot(self, arc: np.ndarray) -> float:
        """How far uphill from an arc, m, the foot of the curb is that leans where the points on it are; 0 where there are few."""
        _, (levels,), (design,), (v,) = self.explained(arc[None])
        rise = self.z - design[:, [0, 1, 3]] @ levels[[0, 1, 3]]
        face = (np.abs(v) <= CURB_HALF_WIDTH) & (rise > FACE_LOWER_SHARE * levels[2]) & (rise < FACE_UPPER_SHARE * levels[2])
        if face.sum() < MIN_SIDE_POINTS:
            return 0.0
        v, rise = v[face], rise[face]
        off = rise - rise.mean()
        return float(v.mean() - (v @ off) / (off @ off + face.sum() * FACE_PRIOR) * rise.mean())


def aside_of_arcs(arcs: np.ndarray, t: np.ndarray) -> np.ndarray:
    """(C, N) m uphill, of (C, 3) arcs at (N,) m along."""
    return arcs[:, :1] + arcs[:, 1:2] * t + 0.5 * arcs[:, 2:] * t * t


def levels_of_arcs(design: np.ndarray, z: np.ndarray, used: np.ndarray, prior: np.ndarray,
                   expected: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(C, P) parameters of each of C designs (C, N, P), and (C, N) sigmas that heights differ from them; `used` : (C, N) bool."""
    weight = used.astype(float)
    for _ in range(3):
        normal = np.einsum("ck,cki,ckj->cij", weight, design, design, optimize=True) / POINT_HEIGHT_SIGMA**2 + np.diag(prior)
        right = np.einsum("ck,cki,k->ci", weight, design, z, optimize=True) / POINT_HEIGHT_SIGMA**2 + prior * expected
        found = np.linalg.solve(normal, right[:, :, None])[:, :, 0]
        residual = (z - np.einsum("cki,ci->ck", design, found)) / POINT_HEIGHT_SIGMA
        weight = used / (1.0 + (residual / MAX_RESIDUAL)**2)
    return found, residual


def cost_of_arcs(residual: np.ndarray) -> np.ndarray:
    """(C,) sums of squares of (C, N) differences in sigmas, cut off."""
    return np.minimum(residual**2, MAX_RESIDUAL**2).sum(axis=1)
