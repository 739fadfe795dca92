"""Straight lines and circles through points."""

import numpy as np

from .base import Arc, Fit, checked
from .batched_lsq import Places, minimise_each


def fit_line(x, y):
    """A straight line by orthogonal, robust least squares.

    Parameters
    ----------
    x, y : (N,) metres, N >= 2, ordered along the line

    Returns
    -------
    Fit with an Arc of curvature 0 from the first point's foot to the last's.
    """
    return fit_lines([(x, y)])[0]


def fit_circle(x, y):
    """A circle: Taubin's algebraic fit as start, then the geometric distance, robustly.

    The unknowns are heading, offset and curvature at the points' middle, so that a
    nearly straight line is as easy as a tight bend. Kasa's simpler fit is not used:
    it is biased to small radii on short arcs.

    Parameters
    ----------
    x, y : (N,) metres, N >= 3, ordered along the line

    Returns
    -------
    Fit with an Arc from the first point's foot to the last's.

    References
    ----------
    Taubin (1991), IEEE PAMI 13, 1115-1138; Chernov (2010), Circular and linear regression, ch. 5-7.
    """
    return fit_circles([(x, y)])[0]


def fit_lines(places, hopeless=np.inf):
    """`fit_line` of many lines at once: places is a list of (x, y). What misses by more than `hopeless` metres is not refined."""
    return minimise_each([checked(x, y, 2) for x, y in places], _Straights, hopeless)


def fit_circles(places, hopeless=np.inf):
    """`fit_circle` of many lines at once: places is a list of (x, y). What misses by more than `hopeless` metres is not refined."""
    return minimise_each([checked(x, y, 3) for x, y in places], _Circles, hopeless)


def taubin_curvature(x, y):
    """Signed curvature (1/m, left positive in the order of the points) of Taubin's circle; 0 for points in a line."""
    x, y = checked(x, y, 3)
    return float(_taubin(Places([len(x)]), x, y)[0])


def _taubin(places, x, y):
    """(L,) curvatures of Taubin's circles through the places of several lines."""
    owner, count = places.owner, places.counts
    dx, dy = x - (places.sums(x) / count)[owner], y - (places.sums(y) / count)[owner]
    size = np.sqrt(places.sums(dx**2 + dy**2) / count)
    scale = np.where(size > 0, size, 1.0)
    dx, dy = dx / scale[owner], dy / scale[owner]
    q = dx**2 + dy**2
    # Taubin's constraint, reduced to the least eigenvector of a 3 x 3 matrix (Chernov's TaubinSVD)
    design = np.stack([(q - 1.0) / 2.0, dx, dy])
    above, below = np.triu_indices(3)
    normal = np.empty((len(count), 3, 3))
    normal[:, above, below] = normal[:, below, above] = (places.sums(design[above] * design[below]) / count).T
    a, b, c = np.linalg.eigh(normal)[1][:, :, 0].T
    root = b * b + c * c + a * a
    bend = np.abs(a) / np.sqrt(np.maximum(root, 1e-300)) / scale
    direction = chords(places, x, y)[2]
    # the centre lies at (-b, -c) / a
    side = np.sign(np.where(a == 0, 0.0, -np.sign(a) * (c * np.cos(direction) - b * np.sin(direction))))
    return np.where((root > 0) & (bend >= 1e-9) & (size > 0), bend * side, 0.0)


def chords(places, x, y):
    """Middle x and y (L,) and direction (L,) of ordered places: the line through the two halves' centres.

    Unlike the principal axis this keeps the order of the points, and it does not
    turn where an arc is nearly half a circle.
    """
    half = np.maximum(places.counts // 2, 1)
    within = np.arange(len(places.owner)) - places.starts[places.owner]
    tail = within >= (places.counts - half)[places.owner]
    head = within < half[places.owner]
    step = [(places.sums(np.where(tail, v, 0.0)) - places.sums(np.where(head, v, 0.0))) / half for v in (x, y)]
    return places.sums(x) / places.counts, places.sums(y) / places.counts, np.arctan2(step[1], step[0])


def chord(x, y):
    """`chords` of one line: its middle (2,) and direction (radians)."""
    middle_x, middle_y, direction = chords(Places([len(x)]), x, y)
    return np.array([middle_x[0], middle_y[0]]), float(direction[0])


class _Circles:
    """Circles through the places of several lines, in the form of offset, heading and curvature: a problem for `minimise_each`."""

    free_bend = True
    state = ()

    def __init__(self, places, x, y, about=None):
        self.places = places
        self.about = chords(places, x, y) if about is None else about
        owner, (middle_x, middle_y, self.direction) = places.owner, self.about
        self.dx, self.dy = x - middle_x[owner], y - middle_y[owner]
        size = np.maximum(np.sqrt(places.sums(self.dx**2 + self.dy**2) / places.counts), 1e-3)
        self.scale = size[:, None] ** -np.arange(2.0 + self.free_bend)

    def start(self):
        """(L, P) unknowns to begin with."""
        places, size = self.places, 1.0 / self.scale[:, 1]
        bend = _taubin(places, self.dx, self.dy) if self.free_bend else np.zeros(len(size))
        c, s = np.cos(self.direction)[places.owner], np.sin(self.direction)[places.owner]
        sagitta = places.sums(self.dy * c - self.dx * s) / places.counts
        return np.stack([sagitta - bend * size**2 / 2, np.zeros(len(bend)), bend][:2 + self.free_bend], axis=1)

    def on(self, places, x, y, lines, state):
        """The same unknowns for other places of some of the lines."""
        return type(self)(places, x, y, tuple(values[lines] for values in self.about))

    def only(self, lines, rows):
        """Some of the lines, whose places are `rows`."""
        part = object.__new__(type(self))
        part.places, part.about = Places(self.places.counts[lines]), tuple(values[lines] for values in self.about)
        part.direction, part.dx, part.dy, part.scale = part.about[2], self.dx[rows], self.dy[rows], self.scale[lines]
        return part

    def at(self, unknown, state):
        owner = self.places.owner
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
        u, _ = arc.foot(x[[0, -1]], y[[0, -1]])
        first, last = float(u[0]), float(u[1])
        (x0, y0), = arc.at(u[:1])
        return Fit(Arc(float(x0), float(y0), float(arc.heading(first)), arc.bend, last - first), residuals.copy(), len(unknown))


class _Straights(_Circles):
    """Straight lines through the places of several lines."""

    free_bend = False

    def jacobian(self, unknown, state):
        return np.stack([np.full(len(state[0]), -1.0), -state[0]])
