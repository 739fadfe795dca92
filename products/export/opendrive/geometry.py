"""The mathematics of OpenDRIVE: piecewise cubics, and the reference line of a road from lines, arcs, spirals and polynomials.

Source: ASAM OpenDRIVE 1.7 and 1.8, chapters Geometry and Roads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import solve_banded

from ....core.curves.clothoid import GAUSS_RULES, gauss_rule

STRAIGHT_BEND = 1e-5    # 1/m: a curvature that moves 200 m of road by 5 cm
LEAST_ELEMENT = 1e-4   # m: shorter pieces of a reference line are none
FOOT_ROUNDS, FOUND_FOOT = 8, 1e-9   # of looking for the foot of a place; m that its step must fall below
TABLE_STEP = 0.25   # m between the places by which arc lengths on poly3 are found


@dataclass(frozen=True)
class Cubics:
    """A function of s in pieces ``a + b ds + c ds^2 + d ds^3``."""

    rows: np.ndarray   # (N, 5) start, a, b, c, d, in order of start; before the first start the first piece is not used: the value is 0

    @classmethod
    def constant(cls, value: float = 0.0) -> Cubics:
        """The same value everywhere."""
        return cls(np.array([[0.0, value, 0.0, 0.0, 0.0]]))

    def __len__(self) -> int:
        return len(self.rows)

    def at(self, s: np.ndarray | float) -> np.ndarray:
        """Its values at s."""
        s = np.asarray(s, float)
        if not len(self.rows):
            return np.zeros(s.shape)
        k = np.searchsorted(self.rows[:, 0], s + 1e-9, side="right") - 1
        start, a, b, c, d = self.rows[np.maximum(k, 0)].T
        ds = s - start
        return np.where(k < 0, 0.0, a + ds * (b + ds * (c + ds * d)))

    def moved(self, ds: float) -> Cubics:
        """The same function of s + ds."""
        rows = self.rows.copy()
        rows[:, 0] += ds
        return Cubics(rows)

    def steps(self) -> tuple[np.ndarray, np.ndarray]:
        """((K,) s, (K,) sizes) of the jumps between the pieces, which are 0 where there is none."""
        start, a, b, c, d = self.rows.T
        ds = np.diff(start)
        ends = a[:-1] + ds * (b[:-1] + ds * (c[:-1] + ds * d[:-1]))
        return start[1:][ds >= 0], np.abs(ends - a[1:])[ds >= 0]

    def least(self, length: float) -> tuple[float, float]:
        """(least value, where) over [0, length], from the ends and the turning points of every piece."""
        start, a, b, c, d = self.rows.T
        span = np.append(start[1:], length) - start
        with np.errstate(divide="ignore", invalid="ignore"):   # where the slope b + 2 c ds + 3 d ds^2 is 0
            q = -(c + np.copysign(np.sqrt(c**2 - 3 * b * d), c))
            turning = np.stack([q / (3 * d), b / q], axis=1)
            inside = (turning > 0) & (turning < span[:, None])
        ds = np.c_[np.zeros(len(span)), span, np.where(inside, turning, 0.0)]
        value = a[:, None] + ds * (b[:, None] + ds * (c[:, None] + ds * d[:, None]))
        value[span < 0] = np.inf
        piece, column = np.unravel_index(np.argmin(value), value.shape)
        return float(value[piece, column]), float(start[piece] + ds[piece, column])


def on_spirals(u: np.ndarray, x: Any, y: Any, heading: Any, bend: Any, change: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(N, 2) places, (N,) headings and (N,) curvatures at arc lengths (N,) of one spiral, or of one for each; lines and arcs are spirals too."""
    nodes, weights = GAUSS_RULES[gauss_rule(float((np.abs(bend * u) + np.abs(change * u * u / 2)).max(initial=0.0)))]
    first = np.asarray(heading)[..., None]
    ways = first + nodes * (bend * u)[:, None] + nodes**2 * (change * u * u / 2)[:, None]
    # what a direction differs by from the first is 0 on a straight line, which is exact so
    along, across = (function(heading) + (function(ways) - function(first)) @ weights for function in (np.cos, np.sin))
    return np.stack([x + u * along, y + u * across], axis=1), heading + u * (bend + change * u / 2), bend + change * u


@dataclass(frozen=True)
class PlanElement:
    """One piece of a reference line.

    values : line (); arc (curvature,); spiral (curvature at start, at end); poly3 (a, b, c, d); paramPoly3 (a, b, c, d of u, then of v)
    """

    s: float   # s, x, y, heading, length: start and length, metres and radians
    x: float
    y: float
    heading: float
    length: float
    kind: str = "line"   # line, arc, spiral, poly3 or paramPoly3
    values: tuple[float, ...] = ()
    normalized: bool = False   # whether the parameter of paramPoly3 runs from 0 to 1 instead of to `length`

    def at(self, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(N, 2) places, (N,) headings and (N,) curvatures at arc lengths u from its start."""
        u = np.asarray(u, float)
        if not self.is_polynomial:
            return on_spirals(u, self.x, self.y, self.heading, *self.bends())
        p, a, b = self._polynomials(u)
        powers = np.stack([np.ones_like(p), p, p**2, p**3])
        slopes = np.stack([np.zeros_like(p), np.ones_like(p), 2 * p, 3 * p**2])
        bends = np.stack([np.zeros_like(p), np.zeros_like(p), 2 * np.ones_like(p), 6 * p])
        (along, across), (du, dv), (ddu, ddv) = ((a @ terms, b @ terms) for terms in (powers, slopes, bends))
        c, s = np.cos(self.heading), np.sin(self.heading)
        places = np.c_[self.x + along * c - across * s, self.y + along * s + across * c]
        return places, self.heading + np.arctan2(dv, du), (du * ddv - dv * ddu) / np.maximum(du**2 + dv**2, 1e-12) ** 1.5

    @property
    def is_polynomial(self) -> bool:
        """Whether it is no line, arc or spiral."""
        return self.kind in ("poly3", "paramPoly3")

    def bends(self) -> tuple[float, float]:
        """Curvature (1/m) at its start and its change along it (1/m^2); of a line, arc or spiral."""
        first, last = (*self.values, *self.values, 0.0, 0.0)[:2]
        return first, (last - first) / self.length if self.length else 0.0

    def _polynomials(self, u):
        """The parameter p at arc lengths, proportional in paramPoly3, as the standard has it, by a table in poly3; coefficients of u(p) and v(p)."""
        if self.kind == "paramPoly3":
            return u / self.length if self.normalized and self.length else u, np.array(self.values[:4]), np.array(self.values[4:])
        _, b, c, d = self.values
        p = np.linspace(0.0, self.length, max(int(self.length / TABLE_STEP), 8) + 1)
        slope = np.hypot(1.0, b + p * (2 * c + p * 3 * d))
        along = np.append(0.0, np.cumsum((slope[1:] + slope[:-1]) / 2 * np.diff(p)))
        return np.interp(u, along, p), np.array([0.0, 1.0, 0.0, 0.0]), np.array(self.values)

    def end(self) -> tuple[float, float, float]:
        """x, y and heading of its end."""
        place, heading, _ = self.at(np.array([self.length]))
        return float(place[0, 0]), float(place[0, 1]), float(heading[0])


@dataclass(frozen=True)
class PlanView:
    """The reference line of a road in plan."""

    elements: tuple[PlanElement, ...]   # in order of s

    @property
    def length(self) -> float:
        """Metres, the sum of its elements."""
        return float(sum(element.length for element in self.elements))

    def at(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(N, 2) places, (N,) headings and (N,) curvatures at s; beyond an end the last element goes on."""
        s = np.asarray(s, float)
        starts, table, polynomial = self._table
        owner = np.maximum(np.searchsorted(starts, s + 1e-9, side="right") - 1, 0)
        places, heading, bend = on_spirals(s - starts[owner], *table[:, owner])
        for k in np.flatnonzero(polynomial):
            rows = owner == k
            if rows.any():
                places[rows], heading[rows], bend[rows] = self.elements[k].at(s[rows] - starts[k])
        return places, heading, bend

    @cached_property
    def _table(self):
        """(E,) s of the elements, (5, E) x, y, heading, curvature and its change, and (E,) bool: those without curvatures."""
        polynomial = np.array([element.is_polynomial for element in self.elements])
        bends = np.array([(0.0, 0.0) if element.is_polynomial else element.bends() for element in self.elements])
        starts, *poses = np.array([(element.s, element.x, element.y, element.heading) for element in self.elements]).T
        return starts, np.stack([*poses, *bends.T]), polynomial

    def feet(self, places: np.ndarray, near: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """((N,) s, (N,) t) of (N, 2) places, found from s nearby; beyond the ends the first and last element go on."""
        s = np.array(near, float)
        for _ in range(FOOT_ROUNDS):
            foot, heading, bend = self.at(s)
            dx, dy = places[:, 0] - foot[:, 0], places[:, 1] - foot[:, 1]
            across = dy * np.cos(heading) - dx * np.sin(heading)
            step = (dx * np.cos(heading) + dy * np.sin(heading)) / np.clip(1 - bend * across, 0.2, 5.0)
            s = s + step
            if np.abs(step).max(initial=0.0) < FOUND_FOOT:
                break
        foot, heading, _ = self.at(s)
        dx, dy = places[:, 0] - foot[:, 0], places[:, 1] - foot[:, 1]
        return s, dy * np.cos(heading) - dx * np.sin(heading)

    def jumps(self, gap: float, kink: float) -> list[tuple[float, float, float]]:
        """(s, metres, radians) where an element begins elsewhere, or in another direction, than the one before ends.

        gap, kink : metres and radians from which it counts
        """
        jumps = []
        for before, after in zip(self.elements[:-1], self.elements[1:]):
            x, y, heading = before.end()
            turn = (after.heading - heading + np.pi) % (2 * np.pi) - np.pi
            distance = float(np.hypot(after.x - x, after.y - y))
            if distance > gap or abs(turn) > kink:
                jumps.append((after.s, distance, abs(turn)))
        return jumps

    def lengthened(self, before: float, after: float) -> PlanView:
        """The same line, which goes on with the curvature of its ends by metres before its start and after its end."""
        elements = self.elements
        if before > LEAST_ELEMENT:
            first, (_, _, (bend,)) = elements[0], self.at(np.zeros(1))
            x, y, heading = _bent(0.0, first.x, first.y, first.heading + np.pi, before, -bend).end()
            if first.kind in ("line", "arc"):   # the same one, from farther back
                start = [replace(first, x=x, y=y, heading=heading - np.pi, length=first.length + before)]
            else:
                start = [_bent(0.0, x, y, heading - np.pi, before, bend), replace(first, s=before)]
            elements = (*start, *(replace(element, s=element.s + before) for element in elements[1:]))
        if after > LEAST_ELEMENT:
            last = elements[-1]
            _, _, (bend,) = last.at(np.array([last.length]))
            tail = (replace(last, length=last.length + after),) if last.kind in ("line", "arc") else (
                last, _bent(last.s + last.length, *last.end(), after, bend))
            elements = (*elements[:-1], *tail)
        return PlanView(elements)


def _bent(s, x, y, heading, length, bend):
    """A line or an arc."""
    return PlanElement(s, x, y, heading, length, *(("arc", (float(bend),)) if abs(bend) > STRAIGHT_BEND else ()))


# Smooth functions along a road as piecewise cubics, with no more pieces than the tolerance asks for.

STIFFNESS = 1e-3      # weight of the bending against the deviations: it decides only where there are too few places
MOST_PIECES = 400     # of one section
SHORTEST_CUBIC = 0.1  # m of a piece
LEAST_STEP = 0.001    # m along the road between places that count
STEP_RUN = 0.005      # m along the road between places that are not of one step
BAND = 3              # unknowns beside each other that one piece joins: levels and slopes at both of its ends


class LineBundle(NamedTuple):
    """Lines along a road that functions with common pieces follow, such as the borders of a section."""

    s: Sequence[np.ndarray]   # s, values: for each line (n,) metres, rising, and its values there
    values: Sequence[np.ndarray]
    start: float   # start, end: metres, of the functions; the first and last value are met there
    end: float
    tolerance: float   # how far a value may be missed
    slopes: Sequence[tuple[float, float]] = ()   # for each line those at its start and end, NaN for any; none are given by default
    broken: bool = False   # whether straight pieces lead from place to place everywhere, which are never below what they join


def fit_cubics(bundles: Sequence[LineBundle]) -> list[list[Cubics]]:
    """Functions with common pieces, whose values and slopes go on from piece to piece, but for corners and steps.

    The functions follow the lines between their places too. Where even the shortest cubics miss them, as at a corner or a step, straight pieces
    lead from place to place. All bundles are fitted at once: pieces that miss are halved until none does, with one system of equations a round.

    bundles : of any number of sections and roads
    Returns for each bundle a list of Cubics, its `start` counted as 0
    """
    fitted: dict[int, list[Cubics]] = {}
    divided = [_Division(number, bundle) for number, bundle in enumerate(bundles)]
    while divided:
        system = _System(divided)
        rows = system.solved()
        bad = system.missed(rows, system.s, system.values, system.piece)
        bad |= system.missed_between(rows, [bundle for bundle, missed in zip(divided, system.of_bundles(bad)) if not missed.any()])
        left = []
        for bundle, missed, first in zip(divided, system.of_bundles(bad), system.first):
            if missed.any():
                bundle.divide(missed)
                left.append(bundle)
            else:
                fitted[bundle.number] = bundle.cubics(rows[first:])
        divided = left
    return [fitted[number] for number in range(len(bundles))]


class _Division:
    """A bundle and how it is divided into pieces. knots : (K,) metres; straight : (K - 1,) whether the piece leads straight from place to place"""

    def __init__(self, number, given):
        self.number, self.given = number, given
        self.s, self.values = ([np.asarray(line, float) for line in lines] for lines in (given.s, given.values))
        self.slopes = given.slopes or [(np.nan, np.nan)] * len(self.s)
        self.knots, self.straight = np.array([given.start, given.end], float), np.array([given.broken])

    def divide(self, bad):
        """Halve the pieces that miss their lines, (K - 1,) bool; where none can be halved, they become straight ones."""
        knots = self.knots
        has_places = np.any([np.searchsorted(x, knots[1:]) > np.searchsorted(x, knots[:-1], side="right") for x in self.s], axis=0)
        halved = bad & has_places & (np.diff(knots) > 2 * SHORTEST_CUBIC) & (len(knots) <= MOST_PIECES)
        if halved.any():
            self.knots = np.sort(np.append(knots, ((knots[:-1] + knots[1:]) / 2)[halved]))
            self.straight = np.repeat(self.straight, 1 + halved)
        else:
            self.straight = self.straight | bad

    def piece_of(self, s):
        """(n,) numbers of the pieces at s."""
        return np.clip(np.searchsorted(self.knots, s, side="right") - 1, 0, len(self.knots) - 2)

    def cubics(self, rows):
        """The functions by the rows at the knots of all lines: a piece of a cubic has one, a straight piece one for each of its places."""
        knots, count = self.knots, len(self.knots)
        rows_of = [rows[number * count:(number + 1) * count - 1] for number in range(len(self.s))]
        if not self.straight.any():
            return [Cubics(row) for row in rows_of]
        places = np.unique(np.concatenate(self.s))
        piece = self.piece_of(places)
        inner = self.straight[piece] & (places > knots[piece] + LEAST_STEP) & (places < knots[piece + 1] - LEAST_STEP)
        breaks = np.concatenate([knots[:-1][self.straight], places[inner]])
        order = np.argsort(breaks, kind="stable")
        breaks, piece = breaks[order], np.append(np.flatnonzero(self.straight), piece[inner])[order]
        ends_piece = np.append(piece[1:] > piece[:-1], True)
        run = np.where(ends_piece, knots[piece + 1], np.append(breaks[1:], knots[-1])) - breaks
        first, last = [], []
        for number, (x, value) in enumerate(zip(self.s, self.values)):
            levels = rows[number * count:(number + 1) * count, 1]
            first.append(np.where(breaks == knots[piece], levels[piece], np.interp(breaks, x, value)))
            last.append(np.where(ends_piece, levels[piece + 1], np.append(first[-1][1:], 0.0)))
        rise = np.array(last) - np.array(first)
        kept = (run > STEP_RUN) | (np.abs(rise) < run).all(0) | (breaks == knots[0])   # up to a step the piece before goes on
        for number, row in enumerate(rows_of):
            lines = np.c_[breaks - knots[0], first[number], rise[number] / run, np.zeros((len(run), 2))][kept]
            both = np.concatenate([row[~self.straight], lines])
            rows_of[number] = both[np.argsort(both[:, 0], kind="stable")]
        return [Cubics(row) for row in rows_of]


class _System:
    """The equations of all lines of bundles: unknown are the level and the slope at every knot.

    Knots and places lie one line after the other; the pieces between the last knot of a line and the first one of the next are none.
    """

    def __init__(self, divided):
        self.divided = divided
        self.lines = [(bundle, x, value, slopes) for bundle in divided for x, value, slopes in zip(bundle.s, bundle.values, bundle.slopes)]
        self.knots = np.concatenate([bundle.knots for bundle, *_ in self.lines])
        counts = np.array([len(bundle.knots) for bundle, *_ in self.lines])
        self.last = np.cumsum(counts) - 1
        self.begin = self.last - counts + 1
        self.first = self.begin[np.cumsum([0, *(len(bundle.s) for bundle in divided)])[:-1]]
        self.straight = np.concatenate([np.append(bundle.straight, False) for bundle, *_ in self.lines])
        self.none = np.zeros(len(self.knots), bool)
        self.none[self.last] = True
        self.tolerance = np.repeat([bundle.given.tolerance for bundle, *_ in self.lines], counts)
        self.span = np.where(self.none, 1.0, np.diff(self.knots, append=np.inf))
        _, s, values, _ = zip(*self.lines)
        self.s, self.values = np.concatenate(s), np.concatenate(values)
        self.piece = np.concatenate([bundle.piece_of(x) + begin for (bundle, x, *_), begin in zip(self.lines, self.begin)])

    def of_bundles(self, values):
        """The values of all pieces, taken together for those of the lines of each bundle."""
        return [values[first:first + len(bundle.s) * len(bundle.knots)].reshape(len(bundle.s), -1)[:, :-1].any(0)
                for bundle, first in zip(self.divided, self.first)]

    def solved(self):
        """(K, 5) rows of Cubics at the knots, from the start of each bundle, by least squares; both ends are met, and their slopes where given."""
        prescribed = self._prescribed()
        smooth, pieces = ~self.straight[self.piece], np.flatnonzero(~self.straight & ~self.none)
        s, values, k, h = self.s[smooth], self.values[smooth], self.piece[smooth], self.span
        fit = np.stack(_basis((s - self.knots[k]) / h[k], h[k]), axis=1)
        # bending of every piece: the integral of the squared second derivative, by its values at both ends
        bending = [np.stack([a / h**2, b / h, c / h**2, d / h], axis=1)[pieces] for a, b, c, d in ((-6, -4, 6, -2), (6, 2, -6, 4))]
        weights = np.concatenate([fit, *(STIFFNESS * block for block in bending)])
        columns = 2 * np.concatenate([k, pieces, pieces])[:, None] + np.arange(4)   # level and slope of a knot lie side by side: a band
        fixed = np.isfinite(prescribed)
        target = np.append(values, np.zeros(2 * len(pieces))) - (weights * np.where(fixed, prescribed, 0.0)[columns]).sum(1)
        weights = np.where(fixed[columns], 0.0, weights)
        size, side = len(prescribed), np.arange(4)
        index = (BAND + side[:, None] - side) * size + columns[:, None, :]   # of each product of two weights in the band
        products = weights[:, :, None] * weights[:, None, :]
        band = np.bincount(index.ravel(), products.ravel(), (2 * BAND + 1) * size).reshape(-1, size)
        right = np.where(fixed, prescribed, 0.0) + np.bincount(columns.ravel(), (weights * target[:, None]).ravel(), size)
        band[BAND, fixed] = 1.0
        solution = solve_banded((BAND, BAND), band, right)
        levels, slopes = solution[::2], solution[1::2]
        rise, next_slopes = np.diff(levels, append=0.0), np.append(slopes[1:], 0.0)
        start = np.repeat(self.knots[self.begin], self.last - self.begin + 1)
        return np.c_[self.knots - start, levels, slopes, (3 * rise / h - 2 * slopes - next_slopes) / h, (slopes + next_slopes - 2 * rise / h) / h**2]

    def _prescribed(self):
        """(2 K,) level and slope of every knot that are given, else NaN: at the ends, and where straight pieces begin and end."""
        prescribed = np.full((len(self.knots), 2), np.nan)
        met = self.straight | np.roll(self.straight, 1)
        for (_, x, value, _), begin, last in zip(self.lines, self.begin, self.last):
            rows = begin + np.flatnonzero(met[begin:last + 1])
            if len(rows):
                prescribed[rows, 0] = np.interp(self.knots[rows], x, value)
        for rows, outer, inner in ((self.begin, 0, 1), (self.last, -1, -2)):
            # by the straight line through the outermost two places
            (s, other), (level, other_level) = (np.array([[line[row][k] for line in self.lines] for k in (outer, inner)]) for row in (1, 2))
            run = s - other
            flat = np.abs(run) <= 1e-6
            prescribed[rows, 0] = level + np.where(flat, 0.0, (level - other_level) / np.where(flat, 1.0, run) * (self.knots[rows] - s))
            prescribed[rows, 1] = [slopes[outer] for *_, slopes in self.lines]
        no_cubic = self.straight | self.none
        prescribed[no_cubic & np.roll(no_cubic, 1), 1] = 0.0
        return prescribed.ravel()

    def missed_between(self, rows, chosen):
        """(K,) bool of the pieces of the chosen bundles that miss their lines between the places."""
        quarters, shares = [(np.empty(0), np.empty(0), np.empty(0, int))], np.arange(1, 4) / 4
        for (bundle, x, value, _), begin in zip(self.lines, self.begin):
            if bundle in chosen:
                s = (bundle.knots[:-1, None] + np.diff(bundle.knots)[:, None] * shares).ravel()
                quarters.append((s, np.interp(s, x, value), begin + np.arange(len(s)) // len(shares)))
        return self.missed(rows, *map(np.concatenate, zip(*quarters)))

    def missed(self, rows, s, values, k):
        """(K,) bool of the pieces that miss values at places s, which lie on pieces k."""
        h = self.span[k]
        a, b, c, d = _basis((s - self.knots[k]) / h, h)
        miss = np.abs(a * rows[k, 1] + b * rows[k, 2] + c * rows[k + 1, 1] + d * rows[k + 1, 2] - values)
        missed = np.zeros(len(self.knots), bool)
        missed[k[miss > self.tolerance[k]]] = True
        return missed & ~self.straight


def difference(first: Cubics, second: Cubics) -> Cubics:
    """first less second, which have the same pieces."""
    return Cubics(np.c_[first.rows[:, 0], first.rows[:, 1:] - second.rows[:, 1:]])


def simplified(cubics: Cubics) -> Cubics:
    """Without pieces that only repeat the one before: constant and straight functions have one row."""
    rows, keep = cubics.rows, [0]
    repeats = _missed_by(rows[:-1], rows[1:]) <= 1e-9
    for k in range(1, len(rows)):
        last_is_before = keep[-1] == k - 1
        if not (repeats[k - 1] if last_is_before else _missed_by(rows[keep[-1], None], rows[k, None])[0] <= 1e-9):
            keep.append(k)
    tiny = rows[keep].copy()
    tiny[:, 1:][np.abs(tiny[:, 1:]) < 1e-12] = 0.0
    return Cubics(tiny)


def _missed_by(before, after):
    """(n,) by how much coefficients of (n, 5) rows differ from those of the rows before, which go on."""
    start, a, b, c, d = before.T
    ds = after[:, 0] - start
    moved = np.stack([a + ds * (b + ds * (c + ds * d)), b + ds * (2 * c + ds * 3 * d), c + 3 * d * ds, d], axis=1)
    return np.abs(moved - after[:, 1:]).max(1)


def risen(s: np.ndarray) -> np.ndarray:
    """(N,) bool: whether each of (N,) metres along the road lies ahead of all before it."""
    return np.append(True, np.diff(np.maximum.accumulate(s)) > LEAST_STEP)


def _basis(u: np.ndarray, h: np.ndarray) -> tuple[np.ndarray, ...]:
    """Hermite's functions: (value at start, slope at start, value at end, slope at end)."""
    return 2 * u**3 - 3 * u**2 + 1, h * (u**3 - 2 * u**2 + u), 3 * u**2 - 2 * u**3, h * (u**3 - u**2)
