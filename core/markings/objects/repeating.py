"""What repeats at an even pace: the stripes of zebra crossings and rows of dashes.

All stripes of a crossing have one direction and one pitch: across them the spots repeat, whichever track of the scan they lie on and however
much is worn off. That is measured by the length of their mean phase. Bars of hatching are parallel, too, but lie oblique to their row.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...common.arrays import linked_groups, members_of
from ...common.parallel import check_cancelled
from ...curves.robust import percentiles
from ...lazy import cv2
from ...survey.frame.placement import PlaceIndex
from ..road_grid import CELL_SIZE
from ..weights import CLASSES, ROWS, STRIPES
from .shape import Shape

# derived: the directions and pitches of stripes that are tried, from the steps between them
COMB_HEADINGS = np.arange(-np.pi / 2, np.pi / 2, STRIPES.comb_heading_step)
COMB_PITCHES = STRIPES.comb_pitch[0] * (1 + STRIPES.comb_pitch_step) ** np.arange(
    int(np.log(STRIPES.comb_pitch[1] / STRIPES.comb_pitch[0]) / np.log(1 + STRIPES.comb_pitch_step)) + 1)
COMB_ACROSS = np.stack([-np.sin(COMB_HEADINGS), np.cos(COMB_HEADINGS)])
PHASE_TOLERANCE = 1e-3   # derived: of a mean phase: its error in single precision is a tenth of that
COMB_SHARES = np.linspace(-0.5, 0.5, 11)   # derived: of a step of both, when it is looked at closely
COMB_REACH = int(1.5 * STRIPES.comb_window / STRIPES.comb_bin)   # derived: bins, either way
COMB_PHASES = np.exp(2j * np.pi * STRIPES.comb_bin * np.arange(-COMB_REACH, COMB_REACH + 1)[:, None] / COMB_PITCHES)


@dataclass(frozen=True)
class Comb:
    """Stripes of one direction and pitch, as clear as `coherence` from 0 to 1.

    `heading` : radians from the first axis to theirs; `phase` : m, where the middle of one lies across them, from the place `middle` on.
    """

    heading: float
    pitch: float
    phase: float
    middle: np.ndarray
    coherence: float


@dataclass(frozen=True)
class Stripe:
    """One stripe: the spots that lie on it, and its (4, 2) corners, m."""

    spots: np.ndarray
    corners: np.ndarray


Crossing = tuple[np.ndarray, Comb]   # rows of the spots about a crossing, and the clearest comb of its windows


def crossings_of(spots: PlaceIndex, windows: Sequence[np.ndarray], window_combs: Sequence[Comb | None]) -> list[tuple[np.ndarray, list[Crossing]]]:
    """The crossings that windows of spots, given by their rows, show by what `comb_of_window` finds in each.

    Those about which the same spots lie come together: the rows of their spots, and the crossings, whose rows are among these.
    """
    combs = [comb for comb in window_combs if comb is not None]
    rows = [members for members, comb in zip(windows, window_combs) if comb is not None]
    crossings: list[Crossing] = []
    for group in _alike(combs):
        check_cancelled()
        best = max((combs[k] for k in group), key=lambda comb: comb.coherence)
        crossings.append((_about(spots, np.unique(np.concatenate([rows[k] for k in group])), best.heading), best))
    return _sharing_spots(crossings, len(spots.places))


def _sharing_spots(crossings, spots):
    """What `crossings_of` gives of crossings about so many spots."""
    number = len(crossings)
    of, about = np.repeat(np.arange(number), [len(members) for members, _ in crossings]), [members for members, _ in crossings]
    groups, result = linked_groups(of, number + np.concatenate([np.empty(0, int), *about]), number + spots)[:number], []
    for _, group in members_of(groups):
        rows = np.unique(np.concatenate([about[k] for k in group]))
        result.append((rows, [(np.searchsorted(rows, about[k]), crossings[k][1]) for k in group]))
    return result


def stripes_of_crossings(places: np.ndarray, way: np.ndarray, crossings: Sequence[Crossing]) -> list[Stripe]:
    """The stripes of some crossings, each spot on one of them: a crossing has what those before it left. `places`, `way` : as of one crossing."""
    result, unused = [], np.ones(len(places), bool)
    for about, comb in crossings:
        check_cancelled()
        members = about[unused[about]]
        for stripe in stripes_of_crossing(places[members], way[members], comb):
            result.append(replace(stripe, spots=members[stripe.spots]))
            unused[result[-1].spots] = False
    return result


def spots_by_place(places: np.ndarray) -> tuple[PlaceIndex, list[np.ndarray]]:
    """An index of spots of paint on the ground, (N, 2) m, one a cell, and the rows of those in each window that may show stripes of a crossing.

    Where the road bends, station and offset would bend stripes, too.
    """
    spots = PlaceIndex(places, STRIPES.comb_window / 2)
    return spots, spots.windows(STRIPES.least_spots)


def _about(spots, rows, heading):
    """Rows of the spots in the box about some spots, along a heading and across it, and `REACH_OF_CROSSING` beyond it."""
    places = spots.places
    turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
    turned_spots = places[rows] @ turn
    low, high = turned_spots.min(axis=0) - STRIPES.reach_of_crossing, turned_spots.max(axis=0) + STRIPES.reach_of_crossing
    corners = np.array([low, (low[0], high[1]), high, (high[0], low[1])]) @ turn.T
    in_box = spots.within(corners.min(axis=0) - 1.0, corners.max(axis=0) + 1.0)
    turned = places[in_box] @ turn
    return in_box[np.logical_and(*((turned >= low) & (turned <= high)).T)]


def _least_spread(places):
    """Standard deviation of places in the direction where it is least, m."""
    deviations = places - places.sum(axis=0) / len(places)
    (xx, xy), (_, yy) = (deviations.T @ deviations / (len(places) - 1)).tolist()
    return float(np.sqrt(max((xx + yy) / 2 - np.hypot((xx - yy) / 2, xy), 0.0)))


def comb_of_window(places: np.ndarray) -> Comb | None:
    """The direction and pitch in which the spots of a window, (N, 2) m, repeat as stripes do; None where they are no three stripes side by side."""
    if _least_spread(places) < STRIPES.least_spread:
        return None   # most windows hold one line
    middle = places.mean(axis=0)
    centred = (places - middle)[::max(len(places) // STRIPES.most_spots, 1)]
    phase = _phases(centred)
    length = np.abs(phase)
    peaks = np.argwhere((length >= 0.8 * STRIPES.min_comb_coherence) & (length >= cv2.dilate(length, np.ones((3, 3), np.uint8))))
    # one line, and spots in a corner of the window, repeat at every pitch: stripes must lie side by side, each as long as one
    for a, b in peaks[np.argsort(-length[tuple(peaks.T)], kind="stable")][:STRIPES.most_peaks].tolist():
        comb = _refined(centred, middle, COMB_HEADINGS[a], COMB_PITCHES[b])
        if comb.coherence >= STRIPES.min_comb_coherence and _has_stripes(centred, comb):
            return comb
    return None


def _phases(spots):
    """(H, P) complex, nearly the mean phase of spots for every direction and pitch that is tried: by bins across the stripes."""
    number = np.floor(spots @ COMB_ACROSS / STRIPES.comb_bin).astype(np.int64) + COMB_REACH
    number = np.clip(number, 0, len(COMB_PHASES) - 1) + np.arange(len(COMB_HEADINGS)) * len(COMB_PHASES)
    counts = np.bincount(number.ravel(), minlength=len(COMB_HEADINGS) * len(COMB_PHASES)).reshape(len(COMB_HEADINGS), -1)
    # small: shared out to threads it takes longer
    return np.einsum("hb,bp->hp", counts.astype(float), COMB_PHASES.view(float)).view(complex) / len(spots)


def _refined(spots, middle, heading, pitch, steps=1.0):
    """The clearest comb within some of the steps that are tried of a direction and a pitch."""
    headings = heading + STRIPES.comb_heading_step * steps * COMB_SHARES
    pitches = pitch * (1 + STRIPES.comb_pitch_step * steps * COMB_SHARES)
    across = spots @ np.array([-np.sin(headings), np.cos(headings)])
    clear = _clear(across, pitches)
    headings, pitches = headings[clear.any(axis=1)], pitches[clear.any(axis=0)]
    turn = (2 * np.pi / pitches)[:, None, None] * across[:, clear.any(axis=1)]
    phase = (np.cos(turn).sum(axis=1) / len(across) + 1j * (np.sin(turn).sum(axis=1) / len(across))).T
    a, b = np.unravel_index(np.abs(phase).argmax(), phase.shape)
    return Comb(float(headings[a]), float(pitches[b]), float(np.angle(phase[a, b]) / (2 * np.pi) * pitches[b]), middle,
                float(np.abs(phase[a, b])))


def _clear(across, pitches):
    """(H, P) bool: directions and pitches whose mean phase may be the longest, as far as single precision tells; across : (N, H) m."""
    turn = (2 * np.pi / pitches).astype(np.float32)[:, None, None] * np.ascontiguousarray(across.T, np.float32)
    length = np.hypot(np.cos(turn).sum(axis=2), np.sin(turn, out=turn).sum(axis=2)).T / len(across)
    return length >= length.max() - PHASE_TOLERANCE


def _numbered(spots, comb):
    """Number of the stripe nearest to each spot, how far off its middle the spot lies, and where along it."""
    across = spots @ np.array([-np.sin(comb.heading), np.cos(comb.heading)]) - comb.phase
    number = np.rint(across / comb.pitch).astype(np.int64)
    return number, across - number * comb.pitch, spots @ np.array([np.cos(comb.heading), np.sin(comb.heading)])


def _has_stripes(spots, comb):
    """Whether at least three stripes side by side are long enough, and as long as each other at the same place."""
    number, _, along = _numbered(spots, comb)
    number -= number.min()
    enough = np.bincount(number) >= STRIPES.min_share_of_stripe * len(spots)
    side_by_side = np.convolve(enough, np.ones(STRIPES.min_stripes, int)) == STRIPES.min_stripes   # the last of so many side by side
    if not side_by_side.any():
        return False
    spans = {}
    for k in np.flatnonzero(enough).tolist():
        first, last = percentiles(along[number == k], (STRIPES.end_percent, 100 - STRIPES.end_percent))
        if last - first >= STRIPES.min_stripe_span:
            spans[k] = first, last
    run = best = 0
    for k, (first, last) in spans.items():
        before = spans.get(k - 1)
        shared = before is not None \
            and min(last, before[1]) - max(first, before[0]) >= STRIPES.min_shared_of_stripes * max(last - first, before[1] - before[0])
        run = run + 1 if shared else 1
        best = max(best, run)
    return best >= STRIPES.min_stripes


def _alike(combs):
    """Lists of the windows of each crossing."""
    if not combs:
        return []
    heading, pitch, middle = (np.array([getattr(comb, name) for comb in combs]) for name in ("heading", "pitch", "middle"))
    a, b = cKDTree(middle).query_pairs(STRIPES.comb_window, output_type="ndarray").reshape(-1, 2).T
    turn = np.abs((heading[a] - heading[b] + np.pi / 2) % np.pi - np.pi / 2)
    alike = (turn <= STRIPES.same_heading) & (np.abs(pitch[a] - pitch[b]) <= STRIPES.same_pitch * np.maximum(pitch[a], pitch[b]))
    return [members.tolist() for _, members in members_of(linked_groups(a[alike], b[alike], len(combs)))]


def stripes_of_crossing(places: np.ndarray, way: np.ndarray, comb: Comb) -> list[Stripe]:
    """The stripes of one crossing, from the (N, 2) spots about it, the (N,) direction of the road there, and a comb that it shows."""
    if len(places) < STRIPES.least_spots:
        return []
    rows, middle = np.arange(len(places)), places.mean(axis=0)
    centred = places - middle
    best, sample = comb, centred[::max(len(centred) // (8 * STRIPES.most_spots), 1)]
    # a window tells the pitch of three stripes less well than all of them do
    for steps in STRIPES.steps_of_crossing:
        best = _refined(sample, middle, best.heading, best.pitch, steps)
    if best.coherence < STRIPES.min_comb_coherence:
        return []
    number, offset, along = _numbered(centred, best)
    striped = _striped(number, offset / best.pitch, along)
    rows, centred, number, offset, along = (values[striped] for values in (rows, centred, number, offset, along))
    if len(rows) < STRIPES.least_spots:
        return []
    # spots of lines that end at the crossing turned the comb: its stripes alone tell their direction and pitch
    row = _row_of_stripes(number, offset, along, best)
    if row is None:
        return []
    best = _fitted(number, offset, along, best, row)
    number, offset, along = _numbered(centred, best)
    row = _row_of_stripes(number, offset, along, best)
    if row is None:
        return []
    stripe_numbers, width, ends = row.numbers, row.width, row.ends
    if (lengths := np.median(ends[:, 1] - ends[:, 0])) > STRIPES.stripe_length[1] or lengths < STRIPES.min_stripe_span:
        return []
    # the ends of all stripes lie on a line, up to which each is drawn
    lines = [_line_of_ends(np.array(stripe_numbers), end, outward) for end, outward in zip(ends.T, (-1, 1))]
    turn = np.abs((best.heading - way[rows] + np.pi / 2) % np.pi - np.pi / 2)
    skew = STRIPES.max_row_skew_along if np.median(turn) <= STRIPES.along_road else STRIPES.max_row_skew
    if np.mean([abs(slope) for _, slope in lines]) > np.tan(skew) * best.pitch:
        return []
    ends = np.stack([line for line, _ in lines], axis=1)
    if np.median(ends[:, 1] - ends[:, 0]) > STRIPES.stripe_length[1]:
        return []
    c, n = np.cos(best.heading), np.sin(best.heading)
    stripes = []
    for k, (first, last) in zip(stripe_numbers, ends):
        side = best.phase + k * best.pitch + np.array([-width / 2, width / 2])
        corners = np.array([(first, side[0]), (last, side[0]), (last, side[1]), (first, side[1])]) @ np.array([[c, n], [-n, c]]) + middle
        along_stripe = (along >= first - STRIPES.max_stray_end) & (along <= last + STRIPES.max_stray_end)
        inside = (np.abs(offset) <= width / 2 + STRIPES.ragged) & (number == k) & along_stripe
        stripes.append(Stripe(rows[inside], corners))
    return stripes


class _Row(NamedTuple):
    """Stripes side by side: their (K,) numbers, the width of all, and (K, 2) where each begins and ends along them, m."""

    numbers: list[int]
    width: float
    ends: np.ndarray


def _row_of_stripes(number, off, along, comb):
    """The stripes that are broad and long enough, from spots by the stripe nearest to each; None where they are no crossing's."""
    on_stripe = np.abs(off) < STRIPES.max_width_of_pitch / 2 * comb.pitch
    # half of what is spread evenly over a stripe lies within a quarter of its width
    width = 4 * float(np.median(np.abs(off[on_stripe])))
    # stripes that are painted all over have the mean phase that their width tells
    if width < max(STRIPES.stripe_width[0], STRIPES.min_width_of_pitch * comb.pitch) \
            or np.cos(2 * np.pi * off / comb.pitch).mean() < STRIPES.min_of_mean_phase * np.sinc(width / comb.pitch):
        return None
    width = min(width, STRIPES.stripe_width[1], STRIPES.max_width_of_pitch * comb.pitch)
    on_stripe = np.abs(off) <= width / 2
    kept_numbers, ends = [], []
    numbers, counts = _without_strays(*np.unique(number[on_stripe], return_counts=True))
    usual = np.median(counts)
    for k, count in zip(numbers, counts):
        span = _span(along[on_stripe & (number == k)])
        own_width, aside = _width(along[on_stripe & (number == k)], off[on_stripe & (number == k)])
        # a curb or a line that happens to lie there is narrower, or on one side; few spots tell their middle to two standard errors
        full = aside <= max(STRIPES.max_aside, 1 / np.sqrt(count)) * width and own_width >= STRIPES.min_of_width * width
        if full and count >= STRIPES.min_of_usual * usual and span[1] - span[0] >= STRIPES.min_stripe_span / 2:
            kept_numbers.append(int(k))
            ends.append(span)
    if max(map(len, np.split(kept_numbers, np.flatnonzero(np.diff(kept_numbers) != 1) + 1))) < STRIPES.min_stripes:
        return None
    return _Row(kept_numbers, width, np.array(ends))


def _fitted(number, off, along, comb, row):
    """The comb turned, shifted and stretched onto the spots of a row of its stripes, by least squares."""
    on_stripes = np.isin(number, row.numbers) & (np.abs(off) <= row.width / 2 + STRIPES.ragged)
    # a spot lies across at phase + number * pitch + turn * along, and anywhere over the width of its stripe
    design = np.column_stack([np.ones(on_stripes.sum()), number[on_stripes], along[on_stripes]])
    shift, stretch, turn = np.linalg.lstsq(design, off[on_stripes], rcond=None)[0].tolist()
    # across the turned stripes the distances shorten by the cosine of the turn
    heading, c = comb.heading + np.arctan(turn), np.cos(np.arctan(turn))
    return replace(comb, heading=float(heading), pitch=(comb.pitch + stretch) * c, phase=(comb.phase + shift) * c)


def _striped(number, phase, along):
    """(N,) bool, the spots of the stretch along the stripes over which they are stripes: side by side, not one with a line that continues."""
    step = np.floor((along - along.min()) / STRIPES.comb_step_along).astype(np.int64)
    count = np.bincount(step)
    mean = np.bincount(step, np.cos(2 * np.pi * phase)) / np.maximum(count, 1)
    stripes = np.bincount(np.unique(np.column_stack([step, number]), axis=0)[:, 0])
    # a line that continues from the outermost stripe has their phase, too; one worn step parts no stripes
    full = (mean >= STRIPES.least_phase) & (stripes > 1) & (count >= STRIPES.min_of_usual * np.median(count[step]))
    full = full | (np.r_[False, full[:-1]] & np.r_[full[1:], False] & (mean >= 0))
    runs = np.cumsum(np.diff(np.r_[False, full].astype(int)) == 1) * full
    spots = np.bincount(runs, count * full)
    best = int(spots[1:].argmax()) + 1 if len(spots) > 1 else -1
    best_run = runs == best
    # the stripes may end a little way into the next step
    ends = (mean >= STRIPES.least_phase) & (stripes > 1) & (np.r_[best_run[1:], False] | np.r_[False, best_run[:-1]])
    return (best_run | ends)[step]


def _span(along):
    """Where a stripe begins and ends, from spots spread evenly along it, of which a few at either end may not be its own."""
    first, last = percentiles(along, (STRIPES.end_percent, 100 - STRIPES.end_percent))
    beyond = STRIPES.end_percent / (100 - 2 * STRIPES.end_percent) * (last - first)
    return first - beyond, last + beyond


def _width(along, across):
    """Width of a strip, straight and maybe oblique, from spots spread evenly over it, and how far its middle lies aside."""
    run = along - along.mean()
    slope = (run * across).sum() / max((run * run).sum(), 1e-9)
    middle = np.median(across)
    return 4 * float(np.median(np.abs(across - middle - slope * run))), abs(float(middle))


def _without_strays(number, count):
    """Numbers of stripes and how many spots they have, without those at either end that have far fewer than the next."""
    first, last = 0, len(number)
    while last - first > 1 and count[first] < STRIPES.min_of_neighbour * count[first + 1]:
        first += 1
    while last - first > 1 and count[last - 1] < STRIPES.min_of_neighbour * count[last - 2]:
        last -= 1
    return number[first:last], count[first:last]


def _line_of_ends(number, end, outward):
    """The line on which stripes end, and its slope from stripe to stripe; of one that ends well before it, `max_stray_end` before it.

    `outward` : 1 or -1, the way out along the stripes.
    """
    a, b = np.triu_indices(len(number), 1)
    slope = float(np.median((end[b] - end[a]) / (number[b] - number[a])))
    residuals = np.sort(outward * (end - slope * number))
    line = outward * residuals[int(STRIPES.ends_seen / 100 * (len(residuals) - 1))] + slope * number
    return np.where(outward * (line - end) <= STRIPES.max_stray_end, line, line - outward * STRIPES.max_stray_end), slope


# Rows of dashes: one bright spot of half a metre may be anything; four in a line, evenly spaced and pointing along it, were painted (or are stones
# of one curb).


def rows_of_dashes(shapes: Sequence[Shape]) -> list[np.ndarray]:
    """Pieces that stand in rows: ascending int arrays, the pieces of each row; a piece where rows meet is in several."""
    return _chains(*_steps(shapes)) if len(shapes) >= ROWS.min_dashes_in_row else []


def _steps(shapes):
    """Pairs (P, 2) of pieces that may be neighbours in a row of dashes, both ways, (P,) m between them, and (P, 2) unit vectors to the second."""
    middle = np.array([((shape.s0 + shape.s1) / 2, (shape.d0 + shape.d1) / 2) for shape in shapes]).reshape(-1, 2)
    length, width, turn = (np.array([getattr(shape, name) for shape in shapes]) for name in ("length", "width", "direction"))
    pairs = cKDTree(middle).query_pairs((1 + ROWS.max_gap_per_dash) * CLASSES.short_dash_length[1], output_type="ndarray")
    pairs = np.concatenate([pairs, pairs[:, ::-1]])
    pairs = pairs[np.lexsort(pairs.T[::-1])]
    step = middle[pairs[:, 1]] - middle[pairs[:, 0]]
    apart = np.hypot(*step.T)
    ways = step / np.maximum(apart, 1e-9)[:, None]
    links = _narrow(length, width, turn, pairs, ways) & (apart >= ROWS.min_dash_spacing) \
        & (apart - length[pairs].mean(axis=1) <= ROWS.max_gap_per_dash * length[pairs].max(axis=1))
    return pairs[links], apart[links], ways[links]


def likely_rows(shapes: Sequence[Shape], odds: np.ndarray) -> list[np.ndarray]:
    """Arrays of the pieces of each row of dashes that is more likely painted than there by chance, from one end to the other. By our own rule.

    The odds of its dashes are added up, and for each of them how well it lies where the two before it lead. The likeliest row is taken first, and
    no piece is in two. `odds` : (N,) nats by which a piece is more likely paint than noise, if it is as likely as not that there is paint.
    """
    pairs, apart, ways = _steps(shapes)
    odds = np.maximum(odds, ROWS.dimmest)
    length = np.log([max(shape.length, CELL_SIZE) for shape in shapes])
    # a row leads one way along the road or across it
    directions = [_Steps.of(pairs[chosen], apart[chosen], ways[chosen], length) for chosen in (ways @ way >= ROWS.min_lead for way in np.eye(2))]
    rows: list[np.ndarray] = []
    free = np.ones(len(shapes), bool)
    while True:
        score, row = max((steps.likeliest(odds, free) for steps in directions), key=lambda scored: scored[0])
        if score <= ROWS.row:
            return rows
        rows.append(np.array(row))
        free[row] = False


class _Steps(NamedTuple):
    """Steps between pieces that lead one way, and which step goes on with which."""

    pairs: np.ndarray   # (P, 2) the pieces of each
    before: np.ndarray   # (T,) a step, the one that goes on with it, and how much more likely that is in a row than by chance, nats
    after: np.ndarray
    gain: np.ndarray

    @classmethod
    def of(cls, pairs, apart, ways, length):
        before, after, offset = _transitions(pairs, apart, ways)
        step = np.abs(np.log(apart[after] / apart[before]))
        # a dash between two of the three may be worn away
        worn = step > np.log(2.0) / 2
        step = step - np.log(2.0) * worn
        longer = length[pairs[after, 1]] - length[pairs[before, 1]]
        squares = (offset / ROWS.offset_sigma) ** 2 + (step / ROWS.step_sigma) ** 2 + (longer / ROWS.length_sigma) ** 2
        return cls(pairs, before, after, ROWS.next_dash - ROWS.worn_dash * worn - squares / 2)

    def likeliest(self, odds, free):
        """Nats of the likeliest row of three free pieces or more, and their numbers."""
        odds = np.where(free, odds, -np.inf)
        total, led_by = odds[self.pairs].sum(axis=1), np.full(len(self.pairs), -1)
        better = np.arange(len(self.before))
        while len(better):
            value = total[self.before] + self.gain + odds[self.pairs[self.after, 1]]
            better = np.lexsort((value, self.after))
            # of the steps that lead to one, the likeliest
            better = better[np.diff(self.after[better], append=-1) != 0]
            better = better[value[better] > total[self.after[better]] + 1e-9]
            total[self.after[better]], led_by[self.after[better]] = value[better], self.before[better]
        # two pieces are in line in any case
        total[led_by < 0] = -np.inf
        score, step, row = total.max(initial=-np.inf), int(np.argmax(np.r_[total, -np.inf])), []
        while 0 <= step < len(total):
            row += [self.pairs[step, 1]] if led_by[step] >= 0 else self.pairs[step, ::-1].tolist()
            step = led_by[step]
        return score, row[::-1]


def _way(places):
    """(2,) unit vector of the straight line through places, from the first to the last."""
    way = np.linalg.svd(places - places.mean(axis=0))[2][0]
    return way * np.sign(way @ (places[-1] - places[0]) or 1.0)


def give_way_blocks(filled: np.ndarray, sides: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """(N,) bool, which pieces are blocks of give-way lines: filled squares in rows.

    Where no more of a row was seen than two squares, they count if they lie at the pace of a sure row. A row goes on where a piece lies at its pace
    and in line with it, though wear or stray points leave it no square.

    filled : (N,) bool, whether most of the smallest rectangle about a piece is painted
    sides : (N, 2) m, of that rectangle; 0 for what is larger than any block
    middle : (N, 2) m, in one frame
    """
    squares = np.flatnonzero(filled)
    rows = [squares[row] for row in _rows_of_blocks(sides[squares], middle[squares])]
    result = np.zeros(len(filled), bool)
    if not rows:
        return result
    sure = np.unique(np.concatenate(rows))
    unsure = np.setdiff1d(squares, sure)
    pairs, size, apart = _pairs_of_squares(sides[unsure], middle[unsure])
    at_pace = np.zeros(len(pairs), bool)
    for row in rows:
        usual, pace = sides[row].mean(), _pace(middle[row])
        at_pace |= (np.maximum(size.max(axis=1), usual) <= ROWS.max_block_ratio * np.minimum(size.min(axis=1), usual)) \
            & (np.abs(apart - pace) <= ROWS.max_pace_error * pace)
    larger = sides.max(axis=1)
    small = np.flatnonzero(larger > 0)
    tree = cKDTree(middle[small])
    for row in [*rows, *unsure[pairs[at_pace]]]:
        result[row] = True
        usual = sides[row].mean()

        def likely(place, reach, usual=usual):
            candidates = small[sorted(tree.query_ball_point(place, reach))]
            return candidates[(larger[candidates] >= usual / ROWS.max_end_ratio) & (larger[candidates] <= ROWS.max_end_ratio * usual)]

        result[_led_on(middle[row], middle, likely)] = True
    return result


def _led_on(row, middle, likely):
    """Pieces at the pace of a row of (K, 2) places beyond its ends; `likely` gives those that may be, within a distance of a place."""
    way, pace, numbers = _way(row), _pace(row), []
    along = (row - row.mean(axis=0)) @ way
    for sign, place in ((1.0, row[np.argmax(along)]), (-1.0, row[np.argmin(along)])):
        while True:
            place = place + sign * pace * way
            candidates = likely(place, ROWS.max_end_offset * pace)
            if not len(candidates):
                break
            numbers.append(int(candidates[np.argmin(np.hypot(*(middle[candidates] - place).T))]))
    return numbers


def _pace(middle):
    """Median distance from one place of a row to the next."""
    return float(np.median(np.hypot(*np.diff(middle[np.argsort((middle - middle.mean(axis=0)) @ _way(middle))], axis=0).T)))


def blocks_of_strip(cells: np.ndarray) -> np.ndarray | None:
    """The number of each cell's block along a give-way line that was taken for one piece: along the road scan lines join what lies so near.

    `cells` : (K, 2) int, different ones, of a frame in which the line is straight. None where they are no row of blocks.
    """
    direction = np.linalg.eigh(np.cov(cells.T))[1][:, 1]
    turned = cells @ np.array([[direction[0], -direction[1]], [direction[1], direction[0]]])
    if np.ptp(turned[:, 0]) * CELL_SIZE < ROWS.least_strip or not ROWS.block_size[0] <= np.ptp(turned[:, 1]) * CELL_SIZE <= ROWS.block_size[1]:
        return None
    step = np.floor(turned[:, 0] - turned[:, 0].min()).astype(np.int64)
    count = np.bincount(step)
    painted = np.flatnonzero(count >= ROWS.painted_share * np.percentile(count[count > 0], 75))
    gaps = np.diff(painted)
    apart = np.flatnonzero(gaps > max(gaps.max(initial=0) / 2, ROWS.least_gap))
    if len(apart) < ROWS.min_blocks_in_row - 1:
        return None
    number = np.searchsorted((painted[apart] + painted[apart + 1]) / 2, step)
    low, high = np.full((2, len(apart) + 1), np.inf), np.full((2, len(apart) + 1), -np.inf)
    rows = np.flatnonzero(np.isin(step, painted))
    for k in range(2):
        np.minimum.at(low[k], number[rows], turned[rows, k])
        np.maximum.at(high[k], number[rows], turned[rows, k])
    block_rows = _rows_of_blocks((high - low + 1).T * CELL_SIZE, (low + high).T / 2 * CELL_SIZE)
    # those at the ends may be cut off
    return number if sum(map(len, block_rows)) >= max(len(apart) - 1, ROWS.min_blocks_in_row) else None


def _rows_of_blocks(sides: np.ndarray, middle: np.ndarray) -> list[np.ndarray]:
    """Ascending numbers of filled squares that stand in a row, for each row; `sides` and `middle` are (N, 2) m.

    Three of one size at an even pitch were painted, one may be a manhole cover.
    """
    pairs, of_pair, apart = _pairs_of_squares(sides, middle)
    links = (of_pair.max(axis=1) <= ROWS.max_block_ratio * of_pair.min(axis=1)) \
        & (apart >= ROWS.block_spacing[0] * of_pair.mean(axis=1)) & (apart <= ROWS.block_spacing[1] * of_pair.mean(axis=1))
    ways = (middle[pairs[:, 1]] - middle[pairs[:, 0]]) / np.maximum(apart, 1e-9)[:, None]
    return _chains(pairs[links], apart[links], ways[links], ROWS.min_blocks_in_row, ROWS.max_block_step_ratio, ROWS.max_block_offset)


def _pairs_of_squares(sides, middle):
    """(P, 2) squares near each other, either way, (P, 2) m their sizes, and (P,) m between their middles."""
    square = np.flatnonzero((sides.min(axis=1, initial=np.inf) >= ROWS.block_size[0]) & (sides.max(axis=1, initial=0.0) <= ROWS.block_size[1])
                            & (sides.max(axis=1, initial=0.0) <= ROWS.max_block_ratio * np.maximum(sides.min(axis=1, initial=np.inf), 1e-3)))
    pairs = square[cKDTree(middle[square]).query_pairs(ROWS.block_spacing[1] * ROWS.block_size[1], output_type="ndarray")].reshape(-1, 2)
    pairs = np.concatenate([pairs, pairs[:, ::-1]])
    pairs = pairs[np.lexsort(pairs.T[::-1])]
    return pairs, sides.mean(axis=1)[pairs], np.hypot(*(middle[pairs[:, 1]] - middle[pairs[:, 0]]).T)


def _narrow(length, width, turn, pairs, ways):
    """(P,) whether both pieces of each pair are narrow across the way from one to the other."""
    heading = np.arctan2(ways[:, 1], ways[:, 0])
    narrow = np.ones(len(pairs), bool)
    for k in pairs.T:
        oblique = turn[k] - heading
        narrow &= length[k] * np.abs(np.sin(oblique)) + width[k] * np.abs(np.cos(oblique)) <= ROWS.max_dash_breadth
    return narrow


def _chains(pairs, apart, ways, fewest=ROWS.min_dashes_in_row, max_step_ratio=ROWS.max_step_ratio, max_offset=ROWS.max_dash_offset):
    """Arrays of the pieces of each row, from steps between neighbours."""
    before, after, _ = _transitions(pairs, apart, ways, max_step_ratio, max_offset)
    row = linked_groups(before, after, len(pairs))
    # a row is found twice, forwards and backwards
    chains = {tuple(np.unique(pairs[steps]).tolist()) for _, steps in members_of(row) if len(steps) >= fewest - 1}
    return [np.array(members) for members in sorted(chains) if len(members) >= fewest]


def _transitions(pairs, apart, ways, max_step_ratio=ROWS.max_step_ratio, max_offset=ROWS.max_dash_offset):
    """Steps (T,) and those that go on with them in a row, and (T,) m that the third piece lies off the line through the first two."""
    # a step from i to j goes on in one from j to k
    order = np.argsort(pairs[:, 0], kind="stable")
    first, last = (np.searchsorted(pairs[order, 0], pairs[:, 1], side=side) for side in ("left", "right"))
    count = last - first
    before = np.repeat(np.arange(len(pairs)), count)
    after = order[np.arange(len(before)) - np.repeat(np.cumsum(count) - count - first, count)]
    even = np.maximum(apart[before], apart[after]) <= max_step_ratio * np.minimum(apart[before], apart[after])
    straight = (ways[before] * ways[after]).sum(axis=1) >= ROWS.min_step_cosine
    offset = apart[after] * np.abs(ways[before, 0] * ways[after, 1] - ways[before, 1] * ways[after, 0])
    joined = even & straight & (offset <= max_offset)
    return before[joined], after[joined], offset[joined]
