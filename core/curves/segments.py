"""A long line cut into straights, arcs and clothoids: the alignment as a road engineer would list it."""

from dataclasses import dataclass

import numpy as np

from .arcs import fit_circle, fit_line
from .choice import simplest
from .fit import checked, median
from .spline import fit_splines
from .transitions import fit_clothoid

NODE = 4.0          # m between places where one element may end and the next begin
SHORTEST = 8.0      # m: no element is shorter
LONGEST = 1000.0    # m: longer elements are found in parts
NOISE = 0.008       # m: what a line is never better known than, for counting evidence
# Each element costs its free numbers and its end; the doubled price answers neighbouring
# points whose errors are alike (worn paint, trajectory drift), which plain BIC takes for shape.
PRICE = 2.0
ORDER = {"line": 1, "circle": 2, "clothoid": 3}


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
    curvature, heading, shape = _integrated(curve, u, nodes)
    begin = np.searchsorted(u, nodes)
    begin[-1] = len(u)
    best = np.full(count + 1, np.inf)
    best[0] = 0.0
    came_from, came_by = np.zeros((2, count + 1), int)
    price = PRICE * np.log(max(len(u), 2))
    for i in range(count):
        if not np.isfinite(best[i]):
            continue
        window = slice(begin[i], begin[np.searchsorted(nodes, nodes[i] + LONGEST, "right") - 1])
        t = u[window] - nodes[i]
        bend = 0.5 * curvature(nodes[i]) * t * t
        value = e[window] + shape(u[window]) - shape(nodes[i]) - heading(nodes[i]) * t
        ends = np.arange(i + shortest, count + 1)
        ends = ends[(nodes[ends] <= nodes[i] + LONGEST + 1e-9) & ((ends == count) | (count - ends >= shortest))]
        if not len(ends):
            continue
        costs = _costs(t, value, bend, begin[ends] - begin[i], nodes[ends] - nodes[i], sigma)
        for kind, (name, degree) in enumerate(ORDER.items()):
            total = best[i] + costs[name] + price * (degree + 2)
            better = total < best[ends]
            best[ends[better]] = total[better]
            came_from[ends[better]], came_by[ends[better]] = i, kind
    cuts, j, names = [], count, list(ORDER)
    while j:
        i = came_from[j]
        cuts.append((float(nodes[i]), float(nodes[j]), names[came_by[j]]))
        j = i
    return cuts[::-1]


def _integrated(curve, u, nodes):
    """Functions of arc length: curvature of the base, its integral, and the integral of that."""
    fine = np.linspace(0.0, curve.length, max(16, int(curve.length / 0.25)) + 1)
    k = curve.curvature(fine)
    step = fine[1] - fine[0]
    turn = np.r_[0.0, np.cumsum((k[:-1] + k[1:]) / 2 * step)]
    area = np.r_[0.0, np.cumsum((turn[:-1] + turn[1:]) / 2 * step)]
    return tuple((lambda v: lambda at: np.interp(at, fine, v))(v) for v in (k, turn, area))


def _costs(t, value, bend, counts, spans, sigma):
    """Residual sums over sigma^2 of polynomials of degree 1 to 3 through the first `counts` points, per kind.

    Less the line's own bend, which arc and clothoid can take up and a straight cannot, the
    shape stays small and sums keep their digits.
    """
    powers = np.vander(t, 7, increasing=True)
    sums = np.cumsum(powers, axis=0)
    rows = np.maximum(counts - 1, 0)
    out = {}
    for shape, kinds in ((value, ("line",)), (value - bend, ("circle", "clothoid"))):
        most = max(ORDER[kind] for kind in kinds) + 1
        mixed = np.cumsum(powers[:, :most] * shape[:, None], axis=0)[rows]
        squares = np.cumsum(shape**2)[rows]
        for kind in kinds:
            size = ORDER[kind] + 1
            grid = np.add.outer(np.arange(size), np.arange(size))
            scale = spans[:, None] ** -np.arange(float(size))
            normal = sums[rows][:, grid] * scale[:, :, None] * scale[:, None, :]
            right = mixed[:, :size] * scale
            normal = normal + 1e-10 * np.eye(size) * np.maximum(counts, 1)[:, None, None]
            found = np.linalg.solve(normal, right[:, :, None])[:, :, 0]
            out[kind] = np.maximum(squares - (found * right).sum(1), 0.0) / sigma**2
    return out
