"""Robust least squares of many curves at once: of each a few hundred places, and numpy takes longer to be called than to compute."""

import numpy as np

from ..common.parallel import go_on
from .base import F_SCALE

TOGETHER = 8192   # places fitted at a time: what fits the processor's cache
FEW = 128         # places of a line that are fitted first
EXACT, NEARLY = 1e-7, 1e-3  # shares of a sensible step
LITTLE = 1e-3     # of what is left: where a step gains no more, a hopeless curve stays hopeless
MISSED = 0.05     # share of the places that lie farther off than is allowed, and the curve is none of theirs


class Places:
    """Places of L lines, one line after the other; `values` are arrays of (N,), `of` are arrays of (L, ...).

    counts : (L,) places of each line, none without
    """

    def __init__(self, counts):
        self.counts = np.asarray(counts, np.int64)
        self.starts = np.cumsum(self.counts) - self.counts
        self.owner = np.repeat(np.arange(len(self.counts)), self.counts)

    def sums(self, values):
        """(..., L) sums over the places of each line of (..., N)."""
        return np.add.reduceat(values, self.starts, axis=-1)

    def medians(self, values):
        """(L,) median of (N,) over the places of each line."""
        ordered = values[np.lexsort((values, self.owner))]
        return (ordered[self.starts + (self.counts - 1) // 2] + ordered[self.starts + self.counts // 2]) / 2

    def most(self, values):
        """(L,) greatest of (N,) over the places of each line."""
        return np.maximum.reduceat(values, self.starts)

    def thinned(self, most):
        """Rows of at most so many places of each line, evenly spread, the first and the last among them."""
        if self.counts.max() <= most:
            return np.arange(len(self.owner))
        step = np.maximum((self.counts - 1) / (most - 1), 1.0)
        kept = np.minimum(self.counts, most)
        within = np.arange(kept.sum()) - np.repeat(np.cumsum(kept) - kept, kept)
        return np.repeat(self.starts, kept) + np.rint(within * np.repeat(step, kept)).astype(np.int64)


def batches(counts, most=TOGETHER):
    """[(first, end)] of successive lines with at most so many places together (one line may have more)."""
    found, first, size = [], 0, 0
    for k, count in enumerate(counts):
        if k > first and size + count > most:
            found.append((first, k))
            first, size = k, 0
        size += count
    return [*found, (first, len(counts))] if len(counts) else []


def minimise_each(lines, problem_of, hopeless=np.inf):
    """Fits of curves of one kind to many lines.

    Every line is fitted to a few of its places first, which takes most of the steps,
    then to all of them, unless it is hopeless.

    Parameters
    ----------
    lines : list of (x, y), each (N,) metres, ordered along the line
    problem_of : makes a problem for `minimise_all` of Places, x and y; it has `start()`, (L, P), `scale` and `fit` too,
        and `on(places, x, y, lines, state)`: the same unknowns for more places of some of its lines
    hopeless : metres; a curve from which a twentieth of the places lie farther is left as the few places have it

    Returns
    -------
    list of what `fit(k, unknown, x, y, residuals, state)` makes of line k of a problem
    """
    found = [None] * len(lines)
    counts = np.array([len(x) for x, _ in lines], np.int64)
    for first, end in batches(np.minimum(counts, FEW)):
        numbers = np.arange(first, end)
        whole = Places(counts[numbers])
        x, y = (np.concatenate([lines[k][axis] for k in numbers]) for axis in (0, 1))
        rows = whole.thinned(FEW)
        problem = problem_of(Places(np.minimum(whole.counts, FEW)), x[rows], y[rows])
        solved = minimise_all(problem, problem.start(), problem.scale, np.where(whole.counts <= FEW, EXACT, NEARLY), hopeless)
        _put(found, numbers, np.flatnonzero(whole.counts <= FEW), problem, lines, *solved)
        long = np.flatnonzero(whole.counts > FEW)
        for a, b in batches(whole.counts[long]):
            there = np.flatnonzero(np.isin(whole.owner, long[a:b]))
            state = tuple(np.interp(there, rows, values) for values in solved[2])
            part = problem.on(Places(whole.counts[long[a:b]]), x[there], y[there], long[a:b], state)
            _refine(found, numbers[long[a:b]], part, lines, solved[0][long[a:b]], hopeless)
    return found


def _refine(found, numbers, problem, lines, unknown, hopeless):
    """Fit the lines of a problem from unknowns that are nearly right; what is hopeless stays as it is."""
    residuals, state = problem.at(unknown, problem.state)
    missed = problem.places.sums((np.abs(residuals) > hopeless).astype(float)) > MISSED * problem.places.counts
    _put(found, numbers, np.flatnonzero(missed), problem, lines, unknown, residuals, state)
    left = np.flatnonzero(~missed)
    if len(left):
        problem = problem.only(left, np.flatnonzero(~missed[problem.places.owner]))
        _put(found, numbers[left], np.arange(len(left)), problem, lines, *minimise_all(problem, unknown[left], problem.scale))


def _put(found, numbers, which, problem, lines, unknown, residuals, state):
    for k in which.tolist():
        own = slice(problem.places.starts[k], problem.places.starts[k] + problem.places.counts[k])
        x, y = lines[numbers[k]]
        found[numbers[k]] = problem.fit(k, unknown[k], x, y, residuals[own], tuple(values[own] for values in state))


def minimise_all(problem, start, scale, exact=EXACT, hopeless=np.inf):
    """Parameters of every line that minimise soft L1 of its residuals, by Levenberg-Marquardt.

    Plain least squares first; where the curve cannot follow the points no residual
    is an outlier, so the scale of soft L1 grows with that misfit. No line
    shows in what is found for another.

    Parameters
    ----------
    problem : has `places` (Places of L lines); `at(unknown, state)`, which gives (N,) residuals and the new state, a tuple
        of (N,) arrays; `jacobian(unknown, state)`, (P, N); `only(lines, rows)`, the same of some lines, whose
        places are `rows`; and `state` to begin with
    start : (L, P)
    scale : (L, P) the size of a sensible step in each parameter
    exact : (L,) or one; the share of such a step below which nothing is gained any more
    hopeless : metres; what misses by so much on average is given up when steps gain little

    Returns
    -------
    unknown : (L, P)
    residuals : (N,)
    state : tuple of (N,), that of the residuals
    """
    exact = np.broadcast_to(exact, len(start))
    found, residuals, state = _levenberg(problem, np.array(start, float), scale, np.full(len(start), np.inf), problem.state,
                                          np.maximum(exact, NEARLY / 10), hopeless)
    misfit = 1.4826 * problem.places.medians(np.abs(residuals))
    return _levenberg(problem, found, scale, np.maximum(F_SCALE, misfit), state, exact, hopeless)


def _levenberg(problem, found, scale, f_scale, state, exact, hopeless):
    size = found.shape[1]
    above, below = np.triu_indices(size)
    diagonal = np.arange(size)
    results = None
    lines, rows = np.arange(len(found)), slice(None)
    residuals, state = problem.at(found, state)
    now, damping, steps = _cost(problem, residuals, f_scale), np.full(len(found), 1e-3), np.zeros(len(found), int)
    while True:
        go_on()
        places = problem.places
        owner = places.owner
        weight = 1.0 / np.sqrt(1.0 + (residuals / f_scale[owner]) ** 2)
        by = problem.jacobian(found, state)
        # by the second derivative of soft L1, which is the weight's cube: the weight itself takes three times the steps
        weighted = by * weight**3
        normal = np.empty((len(found), size, size))
        normal[:, above, below] = normal[:, below, above] = places.sums(by[above] * weighted[below]).T
        normal *= scale[:, :, None] * scale[:, None, :]
        right = places.sums(by * (weight * residuals)).T * scale
        normal[:, diagonal, diagonal] += damping[:, None] * (normal[:, diagonal, diagonal] + 1e-12)
        step = np.linalg.solve(normal, right[:, :, None])[:, :, 0]
        further = found - scale * step
        tried, new = problem.at(further, state)
        then = _cost(problem, tried, f_scale)
        better, small = then <= now, np.abs(step).max(axis=1) < exact
        steps += better
        gain = now - then
        given_up = (gain <= LITTLE * now) & (then > places.counts * hopeless**2)
        over = np.where(better, (gain <= 1e-4 * exact * now) & small | given_up | (steps >= 100), (damping > 1e8) | small)
        damping = np.where(better, np.maximum(damping / 8, 1e-10), damping * 8)
        if better.all():
            found, residuals, state, now = further, tried, new, then
        else:
            there = better[owner]
            found, now = np.where(better[:, None], further, found), np.where(better, then, now)
            residuals = np.where(there, tried, residuals)
            state = tuple(np.where(there, a, b) for a, b in zip(new, state))
        if not over.any():
            continue
        if results is None:
            if over.all():
                return found, residuals, state
            results = found.copy(), residuals.copy(), tuple(values.copy() for values in state)
            rows = np.arange(len(residuals))
        results[0][lines], results[1][rows] = found, residuals
        for result, values in zip(results[2], state):
            result[rows] = values
        if over.all():
            return results
        left = np.flatnonzero(~over)
        there = np.flatnonzero(~over[owner])
        problem = problem.only(left, there)
        lines, rows = lines[left], rows[there]
        found, scale, f_scale, exact = found[left], scale[left], f_scale[left], exact[left]
        now, damping, steps = now[left], damping[left], steps[left]
        residuals, state = residuals[there], tuple(values[there] for values in state)


def _cost(problem, residuals, f_scale):
    """(L,) sum of squares, or of soft L1 where `f_scale` is finite (of all lines or of none)."""
    if np.isinf(f_scale[0]):
        return problem.places.sums(residuals * residuals)
    scale = f_scale[problem.places.owner]
    return problem.places.sums(2 * scale**2 * (np.sqrt(1 + (residuals / scale) ** 2) - 1))


def minimise(residuals, jacobian, start, scale, hopeless=np.inf):
    """`minimise_all` of one curve.

    residuals, jacobian : functions of the parameters (P,) giving (N,) and (N, P)
    scale : (P,) the size of a sensible step in each parameter
    """
    problem = _One(residuals, jacobian, start)
    return minimise_all(problem, problem.first[None, :], np.asarray(scale, float)[None, :], hopeless=hopeless)[0][0]


class _One:
    state = ()

    def __init__(self, residuals, jacobian, start):
        self.residuals, self.by, self.first = residuals, jacobian, np.asarray(start, float)
        self.places = Places([len(residuals(self.first))])

    def at(self, unknown, state):
        return self.residuals(unknown[0]), ()

    def jacobian(self, unknown, state):
        return self.by(unknown[0]).T
