"""Segmentation of a long line into straights, arcs and clothoids: the elements of its alignment."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..common.parallel import check_cancelled
from .base import checked_points
from .bspline import fit_splines
from .robust import MAD_TO_SIGMA, median
from .weights import FITS

ELEMENT_DEGREES = {"line": 1, "circle": 2, "clothoid": 3}  # derived: of the polynomial of arc length that stands for the element
_EXPONENTS, _DIAGONAL = np.arange(7), np.arange(4)
_EXPONENT_SUMS = np.add.outer(_DIAGONAL, _DIAGONAL)


def element_ranges(lines: Sequence[tuple[np.ndarray, np.ndarray]]) -> list[list[tuple[float, float, str]]]:
    """Divide lines into straights, circular arcs and clothoids.

    A smoothing spline is fitted first. Relative to it, with its own heading integrated twice added back, a straight is a polynomial of degree 1 of
    arc length, an arc of degree 2 and a clothoid of degree 3 (to first order in the few centimetres of residual). The best of all divisions at
    nodes 4 m apart is found by dynamic programming with a BIC cost per element.

    lines : list of (x, y), each (N,) metres, ordered, one point per 0.25 to 1 m

    Returns of each line: first and last arc length, m, and kind of its elements, in order and without gaps.
    """
    ranges = []
    points = [checked_points(x, y, 4) for x, y in lines]
    for (x, y), base in zip(points, fit_splines(points)):
        u, e = base.curve.project(x, y)
        order = np.argsort(u, kind="stable")
        u, e = np.clip(u[order], 0, base.curve.length), e[order]
        sigma = max(MAD_TO_SIGMA * median(np.abs(e)), FITS.min_element_sigma)
        ranges.append(_divide(base.curve, u, e, sigma, base.curve.length))
    return ranges


def _divide(curve, u, e, sigma, length):
    """[(first, last, kind)] of the cheapest division."""
    count = max(1, int(round(length / FITS.element_node_spacing)))
    nodes = np.linspace(0.0, length, count + 1)
    shortest = max(1, int(np.ceil(FITS.min_element_length / (length / count))))
    if count < 2 * shortest:
        nodes = nodes[[0, -1]]
        count = shortest = 1
    costs = _Costs(curve, u, e, nodes, sigma)
    best, beaten = np.full(count + 1, np.inf), np.full(count + 1, count)
    best[0] = 0.0
    came_from, came_by = np.zeros((2, count + 1), int)
    prices = FITS.element_cost_factor * np.log(max(len(u), 2)) * np.array([degree + 2 for degree in ELEMENT_DEGREES.values()])
    begun = np.empty(0, np.int64)   # nodes at which an element may begin that is not yet beaten
    for j in range(1, count + 1):
        check_cancelled()
        begun = begun[(beaten[begun] > j - shortest) & (nodes[begun] >= nodes[j] - FITS.max_element_length - 1e-9)]
        if np.isfinite(best[j - 1]):
            begun = np.append(begun, j - 1)
        costs.extend(begun, j)
        long_enough = begun[begun <= j - shortest]
        if not len(long_enough) or 0 < count - j < shortest:
            continue
        cost = costs.of(long_enough, j)
        total = best[long_enough, None] + cost + prices
        first = int(total.argmin())
        best[j], came_from[j], came_by[j] = total.flat[first], long_enough[first // len(ELEMENT_DEGREES)], first % len(ELEMENT_DEGREES)
        # an element that ends here at more than the least cost is dropped: a new one from here is cheaper than its extension
        lost = long_enough[best[long_enough] + cost.min(axis=1) > best[j] + FITS.cost_margin]
        beaten[lost] = np.minimum(beaten[lost], j)
    cuts, j, names = [], count, list(ELEMENT_DEGREES)
    while j:
        i = came_from[j]
        cuts.append((float(nodes[i]), float(nodes[j]), names[came_by[j]]))
        j = i
    return cuts[::-1]


class _Costs:
    """What elements cost that began at some nodes, by kind: residual sums over sigma^2 of polynomials of degree 1 to 3.

    Less the line's own bend, which arc and clothoid can take up and a straight cannot, the shape stays small and sums keep their digits.
    """

    def __init__(self, curve, u, e, nodes, sigma):
        self.u, self.nodes, self.sigma = u, nodes, sigma
        self.begin = np.searchsorted(u, nodes)
        self.begin[-1] = len(u)
        fine = np.linspace(0.0, curve.length, max(16, int(curve.length / 0.25)) + 1)
        # curvature of the base, its integral, and the integral of that
        k = curve.curvature(fine)
        step = fine[1] - fine[0]
        turn = np.append(0.0, np.cumsum((k[:-1] + k[1:]) / 2 * step))
        area = np.append(0.0, np.cumsum((turn[:-1] + turn[1:]) / 2 * step))
        self.curvature, self.heading, self.area = (np.interp(nodes, fine, values) for values in (k, turn, area))
        self.shape = e + np.interp(u, fine, area)
        # sums over the points of each node's element: of powers of t; of powers of t times the shape, and of its square; the same less the bend
        self.powers, self.whole, self.less = np.zeros((len(nodes), 7)), np.zeros((len(nodes), 3)), np.zeros((len(nodes), 5))

    def extend(self, begun, j):
        """Add the points between node j - 1 and node j to the elements that began at some nodes."""
        places = slice(self.begin[j - 1], self.begin[j])
        t = self.u[places] - self.nodes[begun, None]
        powers = t[:, :, None] ** _EXPONENTS
        whole = self.shape[places] - self.area[begun, None] - self.heading[begun, None] * t
        less = whole - 0.5 * self.curvature[begun, None] * powers[:, :, 2]
        self.powers[begun] += powers.sum(axis=1)
        for sums, values, most in ((self.whole, whole, 2), (self.less, less, 4)):
            sums[begun, :most] += np.einsum("nt,ntk->nk", values, powers[:, :, :most])
            sums[begun, most] += (values * values).sum(axis=1)

    def of(self, begun, j):
        """(M, 3) costs of elements that began at some nodes and end at node j."""
        costs = np.empty((len(begun), len(ELEMENT_DEGREES)))
        scale = (self.nodes[j] - self.nodes[begun])[:, None] ** -np.arange(4.0)
        normal = self.powers[begun][:, _EXPONENT_SUMS] * (scale[:, :, None] * scale[:, None, :])
        normal[:, _DIAGONAL, _DIAGONAL] += 1e-10 * np.maximum(self.begin[j] - self.begin[begun], 1)[:, None]
        for kind, sums in enumerate((self.whole, self.less, self.less)):
            size = kind + 2
            right = sums[begun, :size] * scale[:, :size]
            solution = np.linalg.solve(normal[:, :size, :size], right[:, :, None])[:, :, 0]
            costs[:, kind] = sums[begun, -1] - (solution * right).sum(axis=1)
        return np.maximum(costs, 0.0) / self.sigma**2
