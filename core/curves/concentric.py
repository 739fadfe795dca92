"""Several arcs of one bend: circles about one centre, fitted together."""

from dataclasses import dataclass

import numpy as np

from .arcs import fit_circle
from .curve import Arc
from .fit import F_SCALE, NOISE_FLOOR, Fit, checked
from .together import minimise


@dataclass(frozen=True)
class ConcentricFit:
    """Arcs about one centre.

    fits : one Fit per line, in the order given; their parameters share the centre
    bic, separate_bic : of the joint fit, and of circles fitted one by one
    """

    fits: list
    bic: float
    separate_bic: float

    @property
    def concentric(self):
        """Is one centre the better account of the points (BIC)?"""
        return self.bic <= self.separate_bic


def fit_concentric(lines):
    """Circles with a common centre through the lines of one bend.

    Minimises the sum over lines j and points k of soft L1 of | |p_jk - c| - R_j |
    in (heading, offsets, curvature) form, so that short arcs stay well behaved:
    arcs of 15 m each, whose radii fail alone, are held by each other's distance.

    Parameters
    ----------
    lines : list of (x, y), each (N_j,) metres, N_j >= 3, all ordered in one direction

    Returns
    -------
    ConcentricFit

    Notes
    -----
    What concentric arcs share is the centre, not the curvature: the outer one is
    flatter.
    """
    lines = [checked(x, y, 3) for x, y in lines]
    alone = [fit_circle(x, y) for x, y in lines]
    longest = max(range(len(lines)), key=lambda j: alone[j].curve.length)
    base = alone[longest].curve
    half = base.length / 2
    (bx, by), = base.at(np.array([half]))
    direction, bend = float(base.heading(half)), base.bend
    owner = np.repeat(np.arange(len(lines)), [len(x) for x, _ in lines])
    dx = np.concatenate([x for x, _ in lines]) - bx
    dy = np.concatenate([y for _, y in lines]) - by
    member = np.zeros((len(dx), len(lines)))
    member[np.arange(len(dx)), owner] = 1.0

    def parts(unknown):
        turn, k, offsets = unknown[0], unknown[1], unknown[2:]
        c, s = np.cos(direction + turn), np.sin(direction + turn)
        along, across = dx * c + dy * s, dy * c - dx * s
        lift = 2 * across - k * (along**2 + across**2)
        root = np.sqrt(np.maximum(1 - k * lift, 1e-12))
        # distance from the base circle less the line's own offset from it
        return along, across, k, root, lift / (1 + root), offsets

    def residuals(unknown):
        *_, e, offsets = parts(unknown)
        return e - offsets[owner]

    def jacobian(unknown):
        along, across, k, root, e, _ = parts(unknown)
        by_across, by_along = (1 - k * across) / root, -k * along / root
        return np.c_[-by_across * along + by_along * across, (e**2 - along**2 - across**2) / (2 * root), -member]

    *_, e, _ = parts(np.r_[0.0, bend, np.zeros(len(lines))])
    start = np.r_[0.0, bend, [np.median(e[owner == j]) for j in range(len(lines))]]
    size = max(float(np.hypot(dx, dy).max()), 1.0)
    unknown = minimise(residuals, jacobian, start, np.r_[1.0 / size, 1.0 / size**2, np.ones(len(lines))])
    turned, k = direction + unknown[0], unknown[1]
    common = Arc(float(bx), float(by), float(turned), float(k), 0.0)
    fits = []
    for (x, y), offset in zip(lines, unknown[2:]):
        endless = common.parallel(float(offset))
        u, e = endless.foot(x, y)
        (x0, y0), = endless.at(u[:1])
        curve = Arc(float(x0), float(y0), float(endless.heading(u[0])), endless.bend, float(u[-1] - u[0]))
        fits.append(Fit(curve, e, 1 + 2 / len(lines)))
    return ConcentricFit(fits, _joint_bic(fits, 2 + len(lines)), _joint_bic(alone, 3 * len(lines)))


def _joint_bic(fits, parameters):
    residuals = np.concatenate([fit.residuals for fit in fits])
    spread = 2 * F_SCALE**2 * np.mean(np.sqrt(1 + (residuals / F_SCALE) ** 2) - 1)
    return float(len(residuals) * np.log(max(spread, NOISE_FLOOR**2)) + parameters * np.log(len(residuals)))
