"""A reference line of straight lines, arcs and spirals through the places of a border."""

from __future__ import annotations

import numpy as np

from .geometry import STRAIGHT_BEND, PlanElement, PlanView

FIT_GRID = 0.25             # m between the places at which the curve is integrated
LEAST_PIECE = 2.0       # m of an element: shorter ones follow noise
FIT_ROUNDS = 8              # of the solution for one set of knots
END_WEIGHT = 10.0       # of the first and last place: there roads meet
TURN_WEIGHT = 50.0      # m: a milliradian at an end counts as much as 5 cm of one place
SETTLED_STEP = 1e-6          # m of change of the places from one round to the next


def fit_reference(points: np.ndarray, tolerance: float, ends: tuple[float | None, float | None] = (None, None),
                  turn_tolerance: float = 0.01) -> PlanView | None:
    """The curve whose curvature is linear between as few knots as the tolerance allows: lines, arcs and spirals that join without a kink.

    Parameters
    ----------
    points : (N, 2) metres in order
    tolerance : metres that a point may lie beside it
    ends : radians, headings that it must have at its start and end, None for any
    turn_tolerance : radians by which it may miss them

    Returns
    -------
    PlanView from the first point's foot to the last one's; None where even short elements miss the points
    """
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    length = along[-1]
    knots = np.array([0.0, length])
    fit = _Fit(points, along, tolerance, ends, turn_tolerance)
    while True:
        bend = fit.solve(knots, np.eye(len(knots)))
        if fit.good():
            break
        missed = np.abs(fit.offsets)
        owner = np.clip(np.searchsorted(knots, along, side="right") - 1, 0, len(knots) - 2)
        worst = np.zeros(len(knots) - 1)
        np.maximum.at(worst, owner, missed)
        for piece, missed_turn in zip((0, -1), fit.turns_missed):
            if missed_turn > turn_tolerance:
                worst[piece] = np.inf
        middles = (knots[:-1] + knots[1:]) / 2
        new = middles[(worst > tolerance) & (np.diff(knots) >= 2 * LEAST_PIECE)]
        if not len(new):
            return None
        knots = np.sort(np.append(knots, new))
    knots, bend = _plainer(fit, knots, bend)
    return fit.plan(knots, bend)


def _plainer(fit, knots, bend):
    """The same curve with straight pieces, arcs and fewer knots, wherever the points allow it.

    First every two neighbouring knots are tried with no curvature, or with one in common; then knots are left out.
    """
    groups, straight = np.arange(len(knots)), np.zeros(len(knots), bool)

    def fits(knots, groups, straight):
        tie = _ties(groups, straight)
        found = fit.solve(knots, tie)
        return found if fit.good() else None

    for k in np.argsort(np.abs(bend[1:]) + np.abs(bend[:-1]), kind="stable"):
        none = straight.copy()
        none[[k, k + 1]] = True
        if fits(knots, groups, none) is not None:
            straight = none
    for k in np.argsort(np.abs(np.diff(bend)), kind="stable"):
        joined = np.where(groups == groups[k + 1], groups[k], groups)
        if not straight[k] and not straight[k + 1] and fits(knots, joined, straight) is not None:
            groups = joined
    k = 1
    while k < len(knots) - 1:
        fewer = np.delete(knots, k), np.delete(groups, k), np.delete(straight, k)
        if fits(*fewer) is not None:
            knots, groups, straight = fewer
        else:
            k += 1
    return knots, fit.solve(knots, _ties(groups, straight))


def _ties(groups, straight):
    """(K, Q) the curvature of every knot from those of the groups; knots without curvature have a row of 0."""
    tie = (groups[:, None] == np.unique(groups)[None, :]) * ~straight[:, None]
    return tie[:, tie.any(0)].astype(float)


class _Fit:
    """Least squares for one line of points: the start, the direction there and the curvature at the knots."""

    def __init__(self, points, along, tolerance, ends, turn_tolerance):
        self.points, self.along, self.tolerance, self.ends, self.turn_tolerance = points, along, tolerance, ends, turn_tolerance
        self.offsets, self.turns_missed = np.zeros(len(points)), [0.0, 0.0]
        first = points[min(len(points) - 1, max(1, int(np.searchsorted(along, 1.0))))] - points[0]
        self.pose = np.array([*points[0], np.arctan2(first[1], first[0])])

    def solve(self, knots, tie):
        """(K,) curvatures at the knots; `tie` (K, Q) makes them from Q unknowns. Sets `pose` and `offsets`."""
        s = np.linspace(0.0, knots[-1], max(int(knots[-1] / FIT_GRID), 8) + 1)
        ds = s[1]
        hats = np.stack([np.interp(s, knots, row) for row in np.eye(len(knots))], axis=1) @ tie
        turns = _integral(hats, ds)
        headings = np.arctan2(*np.gradient(self.points, axis=0).T[::-1])
        smooth = np.interp(s, self.along, np.unwrap(headings))
        pose = np.append(self.points[0], smooth[0])
        unknown = np.linalg.lstsq(np.c_[np.ones(len(s)), turns], smooth, rcond=None)[0]
        pose[2], q = unknown[0], unknown[1:]
        u = self.along
        for _ in range(FIT_ROUNDS):
            heading = pose[2] + turns @ q
            c, n = np.cos(heading), np.sin(heading)
            x, y = pose[0] + _integral(c, ds), pose[1] + _integral(n, ds)
            u, offset = self._feet(s, x, y, heading, u)
            normal = -np.sin(np.interp(u, s, heading)), np.cos(np.interp(u, s, heading))
            # how far a turn by one unit at the start, and by every curvature, moves the place at u
            moved = [_integral(-n[:, None] * np.c_[np.ones(len(s)), turns], ds), _integral(c[:, None] * np.c_[np.ones(len(s)), turns], ds)]
            at = [np.stack([np.interp(u, s, column) for column in one.T], axis=1) for one in moved]
            # the start moves across the curve only: along it nothing would change
            across = -np.sin(pose[2]), np.cos(pose[2])
            matrix = np.c_[normal[0] * across[0] + normal[1] * across[1], at[0] * normal[0][:, None] + at[1] * normal[1][:, None]]
            weight = np.ones(len(offset))
            weight[[0, -1]] = END_WEIGHT
            more, target = self._turns_at_ends(heading, turns)
            step = np.linalg.lstsq(np.concatenate([matrix * weight[:, None], more]), np.append(offset * weight, target), rcond=None)[0]
            pose += step[0] * across[0], step[0] * across[1], step[1]
            q = q + step[2:]
            if np.abs(matrix @ step).max() < SETTLED_STEP:
                break
        self.pose = pose
        heading = pose[2] + turns @ q
        x, y = pose[0] + _integral(np.cos(heading), ds), pose[1] + _integral(np.sin(heading), ds)
        self.feet, self.offsets = self._feet(s, x, y, heading, u)
        self.turns_missed = [0.0 if wanted is None else abs(float(_wrapped(wanted - heading[at]))) for wanted, at in zip(self.ends, (0, -1))]
        return tie @ q

    def good(self):
        """Whether the last solution is within the tolerances."""
        return bool(np.abs(self.offsets).max() <= self.tolerance and max(self.turns_missed) <= self.turn_tolerance)

    def _turns_at_ends(self, heading, turns):
        """Rows of the system for the headings at the ends."""
        rows, target = np.empty((0, 2 + turns.shape[1])), []
        for wanted, at in zip(self.ends, (0, -1)):
            if wanted is not None:
                rows = np.concatenate([rows, TURN_WEIGHT * np.r_[0.0, 1.0, turns[at]][None]])
                target.append(TURN_WEIGHT * float(_wrapped(wanted - heading[at])))
        return rows, target

    def _feet(self, s, x, y, heading, u):
        """((N,) arc lengths, (N,) offsets) of the points' feet on the curve."""
        for _ in range(4):
            turn = np.interp(u, s, heading)
            dx, dy = self.points[:, 0] - _interpolated(u, s, x), self.points[:, 1] - _interpolated(u, s, y)
            u = u + dx * np.cos(turn) + dy * np.sin(turn)
        turn = np.interp(u, s, heading)
        dx, dy = self.points[:, 0] - _interpolated(u, s, x), self.points[:, 1] - _interpolated(u, s, y)
        return u, -dx * np.sin(turn) + dy * np.cos(turn)

    def plan(self, knots, bend):
        """The elements, from the first foot to the last."""
        first, last = float(self.feet[0]), float(self.feet[-1])
        x, y, heading = self.pose
        elements, s = [], 0.0
        for k in range(len(knots) - 1):
            a = min(knots[k], first) if k == 0 else knots[k]
            b = max(knots[k + 1], last) if k == len(knots) - 2 else knots[k + 1]
            rate = (bend[k + 1] - bend[k]) / (knots[k + 1] - knots[k])
            whole = _element(s, x, y, heading, knots[k + 1] - knots[k], bend[k], bend[k + 1])
            lo, hi = max(a, first) if k == 0 else a, min(b, last) if k == len(knots) - 2 else b
            place, turn, _ = whole.at(np.array([lo - knots[k]]))
            curve = [bend[k] + rate * (at - knots[k]) for at in (lo, hi)]
            made = _element(s, float(place[0, 0]), float(place[0, 1]), float(turn[0]), hi - lo, *curve)
            ahead, turn_ahead, _ = whole.at(np.array([knots[k + 1] - knots[k]]))
            elements.append(made)
            s += made.length
            x, y, heading = float(ahead[0, 0]), float(ahead[0, 1]), float(turn_ahead[0])
        return PlanView(_merged(elements))


def _merged(elements):
    """Neighbours that are one line or one arc, as one."""
    found = [elements[0]]
    for element in elements[1:]:
        last = found[-1]
        if last.kind == element.kind and last.values == element.values and element.kind in ("line", "arc"):
            found[-1] = PlanElement(last.s, last.x, last.y, last.heading, last.length + element.length, last.kind, last.values)
        else:
            found.append(element)
    return tuple(found)


def _element(s, x, y, heading, length, first, last):
    if abs(first) < STRAIGHT_BEND * 1e-3 and abs(last) < STRAIGHT_BEND * 1e-3:
        return PlanElement(s, x, y, heading, length)
    if abs(first - last) < 1e-12:
        return PlanElement(s, x, y, heading, length, "arc", (float(first),))
    return PlanElement(s, x, y, heading, length, "spiral", (float(first), float(last)))


def _wrapped(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def _integral(values, ds):
    """Of functions on the grid from its start, (M,) or (M, Q), by the rule of the trapezium."""
    total = np.zeros_like(values, dtype=float)
    total[1:] = np.cumsum((values[1:] + values[:-1]) / 2 * ds, axis=0)
    return total


def _interpolated(u, s, values):
    """Linear, also beyond the ends."""
    k = np.clip(np.searchsorted(s, u, side="right") - 1, 0, len(s) - 2)
    return values[k] + (values[k + 1] - values[k]) / (s[k + 1] - s[k]) * (u - s[k])


def polynomial_reference(points: np.ndarray) -> PlanView:
    """A line of parametric cubics through all points, joined without a kink: for borders that no other element follows.

    Parameters
    ----------
    points : (N, 2) metres in order
    """
    from scipy.interpolate import CubicSpline

    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    curve = CubicSpline(along, points)
    elements, s = [], 0.0
    for k in range(len(along) - 1):
        d, c, b, a = curve.c[:, k]
        heading = float(np.arctan2(b[1], b[0]))
        cosine, sine = np.cos(heading), np.sin(heading)
        span = along[k + 1] - along[k]
        local = [np.array([cosine * p[0] + sine * p[1], -sine * p[0] + cosine * p[1]]) for p in (b, c, d)]
        u = np.linspace(0.0, span, 17)
        slope = local[0][:, None] + 2 * local[1][:, None] * u + 3 * local[2][:, None] * u**2
        speed = np.hypot(*slope)
        length = float(((speed[1:] + speed[:-1]) / 2 * np.diff(u)).sum())
        stretch = span / length
        values = (0.0, *(float(p[0] * stretch**power) for power, p in enumerate(local, start=1)),
                  0.0, *(float(p[1] * stretch**power) for power, p in enumerate(local, start=1)))
        elements.append(PlanElement(s, float(a[0]), float(a[1]), heading, length, "paramPoly3", values))
        s += length
    return PlanView(tuple(elements))
