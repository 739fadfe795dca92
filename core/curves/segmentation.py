"""A long line cut into straights, arcs and clothoids: the alignment as a road engineer would list it."""

from dataclasses import dataclass

import numpy as np

from .base import checked, median
from .bspline import fit_splines
from .clothoid import fit_clothoid
from .line_circle import fit_circle, fit_line
from .model_selection import simplest

NODE = 4.0          # m between places where one element may end and the next begin
SHORTEST = 8.0      # m: no element is shorter
LONGEST = 1000.0    # m: longer elements are found in parts
NOISE = 0.008       # m: what a line is never better known than, for counting evidence
# Each element costs its free numbers and its end; the doubled price answers neighbouring
# points whose errors are alike (worn paint, trajectory drift), which plain BIC takes for shape.
PRICE = 2.0
ORDER = {"line": 1, "circle": 2, "clothoid": 3}
MARGIN = 1.0        # of cost, beyond all rounding
POWERS, DIAGONAL = np.arange(7), np.arange(4)
GRID = np.add.outer(DIAGONAL, DIAGONAL)


@dataclass(frozen=True)
class Segment:
    """One element of an alignment, from arc length `first` to `last` of the whole line; `fit` holds its curve."""

    first: float
    last: float
    fit: object

    @property
    def kind(self):
        return self.fit.curve.kind

    @property
    def length(self):
        return self.last - self.first


def segment_line(x, y):
    """Cut a line into straights, circular arcs and clothoids.

    A smoothing spline is laid through the places. Seen from it, adding its own
    heading integrated twice, a straight is a polynomial of degree 1 of arc length,
    an arc of degree 2, a clothoid of degree 3 (to first order in the few
    centimetres of residual), so that the best of all divisions at nodes 4 m apart
    is found by dynamic programming, at the price of BIC per element. Each element is
    then fitted to its own places in true geometry.

    Parameters
    ----------
    x, y : (N,) metres, ordered, thinned (one place per 0.25 to 1 m)

    Returns
    -------
    list of Segment, in order, covering the line without gaps.
    """
    (cuts, u, x, y), = _cuts([(x, y)])
    return [_segment(first, last, kind, u, x, y) for first, last, kind in cuts]


def cuts_of(lines):
    """The [(first, last)] arc lengths of the Segments of `segment_line` of each of many lines (x, y), where their fits are not asked for."""
    return [[(first, last) for first, last, _ in cuts] for cuts, *_ in _cuts(lines)]


def _cuts(lines):
    """[(first, last, kind)] of the elements of each line, and the arc lengths and places they were found from, in order."""
    lines, found = [checked(x, y, 4) for x, y in lines], []
    for (x, y), base in zip(lines, fit_splines(lines)):
        u, e = base.curve.foot(x, y)
        order = np.argsort(u, kind="stable")
        u, e = np.clip(u[order], 0, base.curve.length), e[order]
        sigma = max(1.4826 * median(np.abs(e)), NOISE)
        found.append((_divide(base.curve, u, e, sigma, base.curve.length), u, x[order], y[order]))
    return found


def _segment(first, last, kind, u, x, y):
    inside = (u >= first - 1e-9) & (u <= last + 1e-9)
    if inside.sum() < 5:
        inside = np.sort(np.argsort(np.abs(u - (first + last) / 2), kind="stable")[:5])
    px, py = x[inside], y[inside]
    makers = {"line": fit_line, "circle": fit_circle, "clothoid": fit_clothoid}
    # the division works to first order; in true geometry a simpler element may do as well
    fits = (makers[name](px, py) for name in ORDER if ORDER[name] <= ORDER[kind] and len(px) > ORDER[name] + 1)
    return Segment(first, last, simplest(fits))


def _divide(curve, u, e, sigma, length):
    """[(first, last, kind)] of the cheapest division."""
    count = max(1, int(round(length / NODE)))
    nodes = np.linspace(0.0, length, count + 1)
    shortest = max(1, int(np.ceil(SHORTEST / (length / count))))
    if count < 2 * shortest:
        nodes = nodes[[0, -1]]
        count = shortest = 1
    costs = _Costs(curve, u, e, nodes, sigma)
    best, beaten = np.full(count + 1, np.inf), np.full(count + 1, count)
    best[0] = 0.0
    came_from, came_by = np.zeros((2, count + 1), int)
    prices = PRICE * np.log(max(len(u), 2)) * np.array([degree + 2 for degree in ORDER.values()])
    begun = np.empty(0, np.int64)   # nodes at which an element may have begun that is not yet beaten
    for j in range(1, count + 1):
        begun = begun[(beaten[begun] > j - shortest) & (nodes[begun] >= nodes[j] - LONGEST - 1e-9)]
        if np.isfinite(best[j - 1]):
            begun = np.append(begun, j - 1)
        costs.lead_on(begun, j)
        long_enough = begun[begun <= j - shortest]
        if not len(long_enough) or 0 < count - j < shortest:
            continue
        cost = costs.of(long_enough, j)
        total = best[long_enough, None] + cost + prices
        first = int(total.argmin())
        best[j], came_from[j], came_by[j] = total.flat[first], long_enough[first // len(ORDER)], first % len(ORDER)
        # an element that ends here at more than the least cost leads nowhere: to go on from here is cheaper than to lead it on
        lost = long_enough[best[long_enough] + cost.min(axis=1) > best[j] + MARGIN]
        beaten[lost] = np.minimum(beaten[lost], j)
    cuts, j, names = [], count, list(ORDER)
    while j:
        i = came_from[j]
        cuts.append((float(nodes[i]), float(nodes[j]), names[came_by[j]]))
        j = i
    return cuts[::-1]


class _Costs:
    """What elements cost that began at some nodes, by kind: residual sums over sigma^2 of polynomials of degree 1 to 3.

    Less the line's own bend, which arc and clothoid can take up and a straight cannot, the
    shape stays small and sums keep their digits.
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
        # sums over the places of each node's element: of powers of t; of powers of t times the shape, and of its square; the same less the bend
        self.powers, self.whole, self.less = np.zeros((len(nodes), 7)), np.zeros((len(nodes), 3)), np.zeros((len(nodes), 5))

    def lead_on(self, begun, j):
        """Add the places between node j - 1 and node j to the elements that began at some nodes."""
        places = slice(self.begin[j - 1], self.begin[j])
        t = self.u[places] - self.nodes[begun, None]
        powers = t[:, :, None] ** POWERS
        whole = self.shape[places] - self.area[begun, None] - self.heading[begun, None] * t
        less = whole - 0.5 * self.curvature[begun, None] * powers[:, :, 2]
        self.powers[begun] += powers.sum(axis=1)
        for sums, values, most in ((self.whole, whole, 2), (self.less, less, 4)):
            sums[begun, :most] += np.einsum("nt,ntk->nk", values, powers[:, :, :most])
            sums[begun, most] += (values * values).sum(axis=1)

    def of(self, begun, j):
        """(M, 3) costs of elements that began at some nodes and end at node j."""
        found = np.empty((len(begun), len(ORDER)))
        scale = (self.nodes[j] - self.nodes[begun])[:, None] ** -np.arange(4.0)
        normal = self.powers[begun][:, GRID] * (scale[:, :, None] * scale[:, None, :])
        normal[:, DIAGONAL, DIAGONAL] += 1e-10 * np.maximum(self.begin[j] - self.begin[begun], 1)[:, None]
        for kind, sums in enumerate((self.whole, self.less, self.less)):
            size = kind + 2
            right = sums[begun, :size] * scale[:, :size]
            by = np.linalg.solve(normal[:, :size, :size], right[:, :, None])[:, :, 0]
            found[:, kind] = sums[begun, -1] - (by * right).sum(axis=1)
        return np.maximum(found, 0.0) / self.sigma**2
