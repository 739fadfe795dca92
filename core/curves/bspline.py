"""A smoothing cubic B-spline through points: for lines whose curvature changes as the road wants."""

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dpbsv
from scipy.sparse import csc_matrix, csr_matrix

from .base import F_SCALE, Fit, TabledCurve, checked, least_bic, median, medians
from .batched_lsq import batches

# Cubic B-splines through places of many lines at once: the equations of their control points.

DEGREE = 3


def pieces_of(length, bandwidth):
    return max(1, int(np.ceil(length / max(bandwidth, 1.0))))


class Bases:
    """The cubic B-splines on even knots that places lie in, four a place, with their penalty, of several lines and bandwidths.

    The equations of all of them are solved as one system in which they do not touch: most
    lines have a few hundred places, and numpy takes longer to be called than to compute.

    lines : list of (t, bandwidths): (N,) rising from 0, and (B,). There is a block of N places for every bandwidth,
        one after the other.
    """

    def __init__(self, lines):
        each = [(t, b) for t, bandwidths in lines for b in bandwidths]
        lengths = np.array([float(t[-1]) for t, _ in each])
        pieces = np.array([pieces_of(length, b) for length, (_, b) in zip(lengths.tolist(), each)])
        steps = lengths / pieces
        self.knots = [step * np.arange(-DEGREE, count + DEGREE + 1) for step, count in zip(steps, pieces.tolist())]
        self.counts, self.sizes = pieces + DEGREE, np.array([len(t) for t, _ in each])
        self.starts, self.rows = np.cumsum(self.counts) - self.counts, np.cumsum(self.sizes) - self.sizes
        whole, size = int(self.counts.sum()), int(self.sizes.sum())
        step, most = np.repeat(steps, self.sizes), np.repeat(pieces, self.sizes)
        inside = np.clip(np.concatenate([t for t, _ in each]) / step, 0.0, most)
        piece = np.minimum(inside.astype(np.int32), most - 1)
        f = inside - piece
        g = 1 - f
        values = np.stack([g**3, (3 * f - 6) * f * f + 4, ((3 - 3 * f) * f + 3) * f + 1, f**3], axis=1) / 6
        slopes = np.stack([-g * g, (3 * f - 4) * f, (2 - 3 * f) * f + 1, f * f], axis=1) / (2 * step[:, None])
        at = (piece + np.repeat(self.starts, self.sizes)).astype(np.int32)[:, None] + np.arange(4, dtype=np.int32)
        four = np.arange(0, 4 * size + 1, 4, dtype=np.int32)
        self._values = csr_matrix((values.ravel(), at.ravel(), four), (size, whole))
        self._slopes = csr_matrix((slopes.ravel(), at.ravel(), four), (size, whole))
        self._turned = self._values.T
        # what each place adds to the upper banded form of the normal matrix, wherever two of its four meet
        first, second = np.triu_indices(4)
        ten = np.arange(0, 10 * size + 1, 10, dtype=np.int32)
        band = 4 * at[:, second] + (DEGREE - (second - first)).astype(np.int32)
        self._products = csc_matrix(((values[:, first] * values[:, second]).ravel(), band.ravel(), ten), (4 * whole, size))
        scale = self.sizes / np.maximum(lengths, 1e-6) * np.array([b for _, b in each]) ** 6 / steps**5
        self._penalty = np.concatenate([_roughness(count) * by for count, by in zip(self.counts.tolist(), scale.tolist())])

    def solve(self, weight, values):
        """(K, C) control points of all blocks, one after the other, that follow (N, C) values with (N,) weights, smoothly."""
        bands = (self._products @ weight).reshape(-1, 4)
        bands += self._penalty
        # a breath of ridge keeps control points in a gap from being undetermined
        bands[:, DEGREE] += np.repeat(1e-9 * np.maximum.reduceat(bands[:, DEGREE], self.starts), self.counts)
        right = self._turned @ (values * weight[:, None])
        # solveh_banded checks more than it computes
        _, control, trouble = dpbsv(bands.T, right, overwrite_ab=1)
        if trouble:
            raise LinAlgError(f"The spline's equations cannot be solved ({trouble}).")
        return control

    def of(self, control):
        """(N, C) what control points (K, C) give at the places, and the slopes there."""
        return self._values @ control, self._slopes @ control

    def part(self, control, k):
        """The control points of one block."""
        return control[self.starts[k]:self.starts[k] + self.counts[k]]

    def weights(self, residuals):
        """`robust_weights` of (N,) residuals, of every block by its own scale."""
        found, size = np.empty(len(residuals)), np.abs(residuals)
        k = 0
        while k < len(self.sizes):
            # blocks of one length stand as rows of a table
            count, alike = self.sizes[k], k + 1
            while alike < len(self.sizes) and self.sizes[alike] == count:
                alike += 1
            rows = slice(self.rows[k], self.rows[k] + count * (alike - k))
            scale = np.maximum(F_SCALE, 1.4826 * medians(size[rows].reshape(-1, count)))
            found[rows] = (size[rows].reshape(-1, count) / scale).ravel()
            k = alike
        found *= found
        found += 1.0
        return 1.0 / np.sqrt(found, out=found)


@lru_cache(maxsize=64)
def _roughness(count):
    """(K, 4), the upper banded form, turned, of D'D with D the third differences of K control points."""
    inner = max(count - 8, 0)
    small = np.zeros((DEGREE + 1, count - inner))
    difference = np.array([-1.0, 3.0, -3.0, 1.0])
    for row in range(4):
        for column in range(row, 4):
            small[DEGREE - (column - row), column:column + count - inner - 3] += difference[row] * difference[column]
    bands = np.repeat(small.T, np.r_[1, 1, 1, 1 + inner, np.ones(max(len(small.T) - 4, 0), int)][:len(small.T)], axis=0)
    bands.flags.writeable = False
    return bands

BANDWIDTHS = (1.0, 1.4, 2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 25.0, 40.0, 60.0)  # m; waves shorter than 6 of them are smoothed away
TOGETHER = 4096  # places of a line times bandwidths that are fitted at a time: what fits the processor's cache
TURNS, PROFILE_TURNS = 8, 6  # of weights
SETTLED = 1e-6  # of a weight: its next change moves the curve by less than a micrometre


@dataclass(frozen=True)
class Spline(TabledCurve):
    """A cubic B-spline (t -> x, y) with its knots and control points."""

    knots: tuple
    control_x: tuple
    control_y: tuple
    _splines: dict = field(default_factory=dict, repr=False, compare=False)

    kind = "b-spline"

    def _derivative(self, order):
        if order not in self._splines:
            base = BSpline(np.array(self.knots), np.c_[self.control_x, self.control_y], DEGREE)
            self._splines[order] = base.derivative(order) if order else base
        return self._splines[order]

    def _span(self):
        return self.knots[DEGREE], self.knots[-DEGREE - 1]

    def _place(self, t):
        return self._derivative(0)(t)

    def _slope(self, t):
        return self._derivative(1)(t)

    def _bend(self, t):
        return self._derivative(2)(t)

    def params(self):
        return dict(curve=self.kind, degree=DEGREE, knots=list(self.knots), control_x=list(self.control_x),
                    control_y=list(self.control_y))

    def moved(self, dx, dy):
        return Spline(self.knots, tuple(v + dx for v in self.control_x), tuple(v + dy for v in self.control_y))

    def reversed(self):
        turn = self.knots[0] + self.knots[-1]
        return Spline(tuple(turn - k for k in self.knots[::-1]), self.control_x[::-1], self.control_y[::-1])


def fit_spline(x, y, along=None, bandwidth=None):
    """A penalised cubic B-spline by robust least squares.

    The penalty is on the third derivative, so that arcs pass unhindered and what is
    smoothed is change of curvature. How far it smooths is chosen by BIC among
    BANDWIDTHS, with the effective number of parameters of a smoothing spline of
    this order, L / (3 bandwidth) + 3 per coordinate [1]_; one coordinate is counted, since
    only the deviation across the line is an observation.

    Parameters
    ----------
    x, y : (N,) metres, N >= 4, ordered along the line; gaps are allowed
    along : (N,) rising distances along the line, metres, where they are known
        (stations), else chord lengths of the points
    bandwidth : metres, or None to choose it

    Returns
    -------
    Fit with a Spline from the first point to the last.

    References
    ----------
    .. [1] Eilers and Marx (1996), Statistical Science 11, 89-121; the effective
       dimension is the integral of 1 / (1 + (w b)^6).
    """
    return fit_splines([(x, y)], [along], bandwidth)[0]


def fit_splines(places, along=None, bandwidth=None):
    """`fit_spline` of many lines at once: places is a list of (x, y), `along` a list of what is known of each, or None."""
    lines = [_Line(*checked(x, y, 4), known, bandwidth) for (x, y), known in zip(places, along or [None] * len(places))]
    waiting = [line for line in lines if line.waiting]
    while waiting:
        some, size = [], 0
        for line in waiting:
            count = min(max((TOGETHER - size) // len(line.t), 0 if some else 1), len(line.waiting))
            if not count:
                break
            some.append((line, count))
            size += count * len(line.t)
        fitted = iter(_penalised([(line.x, line.y, line.t, line.waiting[:count]) for line, count in some]))
        for line, count in some:
            line.take([next(fitted) for _ in range(count)])
        waiting = [line for line in waiting if line.waiting]
    return [line.fit() for line in lines]


class _Line:
    """A line to which a spline is fitted, the bandwidths that wait to be tried, and the best so far."""

    def __init__(self, x, y, along, bandwidth):
        self.x, self.y = x, y
        self.t = _chord_lengths(x, y) if along is None else np.asarray(along, float) - along[0]
        self.length = float(self.t[-1])
        self.waiting = [bandwidth] if bandwidth else [b for b in BANDWIDTHS[::-1] if b < max(self.length, 2.5)]
        self.best = None

    def take(self, fitted):
        """What was fitted with the first of the bandwidths that wait."""
        for b, found in zip(self.waiting, fitted):
            fit = Fit(found, found[2], _freedom(self.length, b))
            # the larger bandwidth wins unless the smaller one earns its freedom
            if self.best is None or fit.bic < self.best.bic:
                self.best = fit
        # for which it may be too dear however well it fits
        self.waiting = [b for b in self.waiting[len(fitted):]
                        if least_bic(len(self.t), _freedom(self.length, b)) < self.best.bic]

    def fit(self):
        knots, control, across = self.best.curve
        curve = Spline(tuple(knots.tolist()), tuple(control[:, 0].tolist()), tuple(control[:, 1].tolist()))
        return Fit(curve, across, self.best.parameters)


def _freedom(length, bandwidth):
    """The effective number of parameters of a coordinate."""
    return min(3 + length / (3 * bandwidth), pieces_of(length, bandwidth) + DEGREE)


def _chord_lengths(x, y):
    # noise makes raw chords too long; medians of five keep the parameter near the true length
    dx, dy = np.gradient(_smoothed(x)), np.gradient(_smoothed(y))
    step = np.hypot(np.diff(x), np.diff(y))
    forward = (np.diff(x) * (dx[:-1] + dx[1:]) + np.diff(y) * (dy[:-1] + dy[1:])) / np.maximum(
        np.hypot(dx[:-1] + dx[1:], dy[:-1] + dy[1:]), 1e-12)
    return np.r_[0.0, np.cumsum(np.maximum(forward, 0.2 * step + 1e-6))]


def _smoothed(values, reach=4):
    padded = np.r_[2 * values[0] - values[reach:0:-1], values, 2 * values[-1] - values[-2:-reach - 2:-1]] \
        if len(values) > reach else values
    if len(padded) == len(values):
        return values
    return np.convolve(padded, np.full(2 * reach + 1, 1 / (2 * reach + 1)), "valid")


def _penalised(lines):
    """[(knots, control points (K, 2), distances (N,) across the curve)] of (x, y, t, bandwidths), line by line, for each bandwidth."""
    bases = Bases([(t, bandwidths) for _, _, t, bandwidths in lines])
    blocks = len(bases.sizes)
    weight, turn = np.ones(int(bases.sizes.sum())), 0
    middles = [np.array([x.mean(), y.mean()]) for x, y, _, bandwidths in lines for _ in bandwidths]
    places = np.concatenate([np.stack([x, y], axis=1) for x, y, _, bandwidths in lines for _ in bandwidths])
    places -= np.repeat(middles, bases.sizes, axis=0)
    found = [None] * blocks
    for turn in range(TURNS):
        control = bases.solve(weight, places)
        at, slope = bases.of(control)
        gap = places - at
        size = np.maximum(np.hypot(slope[:, 0], slope[:, 1]), 1e-12)
        across = (gap[:, 1] * slope[:, 0] - gap[:, 0] * slope[:, 1]) / size
        before, weight = weight, bases.weights(across)
        settled = np.maximum.reduceat(np.abs(weight - before), bases.rows) < SETTLED
        for k in range(blocks):
            if found[k] is None and (settled[k] or turn == TURNS - 1):
                rows = slice(bases.rows[k], bases.rows[k] + bases.sizes[k])
                found[k] = bases.knots[k], bases.part(control, k) + middles[k], across[rows]
        if None not in found:
            break
    return found


def smooth_profile(t, values, bandwidth):
    """A function of t that follows values smoothly, strays counting little; held constant beyond the ends.

    t : (N,) rising; values : (N,) metres, as a height or an offset along a line.
    """
    return smooth_profiles([(t, values)], bandwidth)[0]


def smooth_profiles(profiles, bandwidth):
    """`smooth_profile` of many at once: profiles is a list of (t, values)."""
    profiles = [(np.asarray(t, float), np.asarray(values, float)) for t, values in profiles]
    found = [None] * len(profiles)
    which = []
    for k, (t, values) in enumerate(profiles):
        if len(t) < 4 or t[-1] - t[0] < 1.0:
            found[k] = _level(median(values))
        else:
            which.append(k)
    for first, end in batches([len(profiles[k][0]) for k in which], TOGETHER):
        some = which[first:end]
        for k, smooth in zip(some, _smooth([profiles[k] for k in some], bandwidth)):
            found[k] = smooth
    return found


def _level(level):
    return lambda at: np.full(np.shape(at), level)


def _smooth(profiles, bandwidth):
    bases = Bases([(t - t[0], [bandwidth]) for t, _ in profiles])
    levels = [median(values) for _, values in profiles]
    places = np.concatenate([values - level for (_, values), level in zip(profiles, levels)])
    weight, found = np.ones(len(places)), [None] * len(profiles)
    for turn in range(PROFILE_TURNS):
        control = bases.solve(weight, places[:, None])
        before, weight = weight, bases.weights(places - bases.of(control)[0][:, 0])
        settled = np.maximum.reduceat(np.abs(weight - before), bases.rows) < SETTLED
        for k, (t, _) in enumerate(profiles):
            if found[k] is None and (settled[k] or turn == PROFILE_TURNS - 1):
                found[k] = _profile(bases.knots[k], bases.part(control, k)[:, 0], levels[k], t[0])
        if None not in found:
            break
    return found


def _profile(knots, control, level, start):
    spline = BSpline(knots, control, DEGREE)
    return lambda at: level + spline(np.clip(np.asarray(at, float) - start, 0.0, knots[-DEGREE - 1]))
