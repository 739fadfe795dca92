"""A curb or a painted line that the map lacks, found in the points about a click, or along a line that was drawn by hand.

At a place and across a direction, a curb is a step between two straight pieces of ground, and paint is a stripe that is brighter than what lies on
both sides of it. From the click the line is followed both ways, place by place, for as long as it is seen.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import theilslopes

from ..countries.catalogue import country
from ..survey.frame.placement import PlaceIndex
from .weights import PICK


@dataclass(frozen=True)
class Seen:
    """A line in the points, and the evidence for it."""

    target: str   # "edge" or "marking"
    places: np.ndarray   # (K, 2) map coordinates along it; of an edge the foot of its face
    step: float   # m, median height of the face; NaN of paint
    brightness: float   # times as bright as beside it, median; NaN of an edge
    width: float   # m of the paint; NaN of an edge
    scatter: float   # m, one sigma of a place about its neighbours
    points: int   # that the places were measured from
    seen: float   # m of its length on which it was seen; the rest was bridged
    dashed: bool   # whether paint breaks off again and again

    @property
    def length(self) -> float:
        """m along it."""
        return float(np.hypot(*np.diff(self.places, axis=0).T).sum())


@dataclass(frozen=True)
class _Mark:
    """What is seen across one place: m left of it, strength in sigma, step (m) or brightness with a sign, width (m), and points.

    bottom, top : m, heights of both ends of a face; run : m that its top lies left of its bottom
    """

    offset: float
    strength: float
    size: float
    width: float
    points: int
    bottom: float = np.nan
    top: float = np.nan
    run: float = np.nan


@dataclass(frozen=True)
class Face:
    """The face of a curb in a section, and the evidence for it."""

    places: np.ndarray   # (2, 3) map coordinates of its bottom and its top
    direction: float   # in which the curb runs, degrees clockwise from north
    height: float   # m
    sigma_height: float   # sigma_height, sigma_across: m, one sigma of its height, and of its bottom across the curb
    sigma_across: float
    points: int   # that it was measured from


def pick_line(points: np.ndarray, x: float, y: float, azimuth: float, targets: Sequence[str] = ("edge", "marking")) -> Seen | None:
    """The curb or painted line at a click, followed both ways for as long as it is seen; None where there is none within a metre.

    points : (N, 4) x, y, z and intensity about the click at x, y, m
    azimuth : of the road there, degrees clockwise from north; the line may run otherwise
    targets : what is sought, "edge", "marking" or both, of which the nearer and clearer one is taken
    """
    cloud = _Cloud(points)
    # the direction of a low curb is told by how far it can be followed, not by one place of it
    for target, direction, mark in cloud.starts(targets, x, y, azimuth + np.arange(0.0, 180.0, PICK.turn), PICK.click_reach)[:PICK.starts]:
        seen = _measured(target, *cloud.followed(target, _beside((x, y), direction, mark.offset), direction, mark))
        if seen.seen >= PICK.shortest:
            return seen
    return None


def face_at(points: np.ndarray, x: float, y: float, azimuth: float) -> Face | None:
    """The face of a curb at a click in a section; None where no step of 2 cm within 0.3 m goes on for a metre along the road.

    The bottom and the top are read off straight lines along the curb through what is seen 1.5 m either way (Theil-Sen [1]_), so that a wheel or a
    tuft of grass at some of the places moves neither.

    points : (N, 4) x, y, z and intensity about the click at x, y, m
    azimuth : of the road there, degrees clockwise from north, which the section lies across; the curb may run otherwise

    .. [1] Sen (1968), Journal of the American Statistical Association 63, 1379-1389.
    """
    cloud = _Cloud(points[(np.abs(points[:, :2] - (x, y)) <= PICK.course).all(axis=1)], PICK.section_step)
    starts = cloud.starts(["edge"], x, y, azimuth + np.arange(-60.0, 61.0, PICK.turn), PICK.section_reach)
    if not starts:
        return None
    _, direction, _ = starts[0]
    ahead = np.array([np.sin(np.radians(azimuth)), np.cos(np.radians(azimuth))])
    left = np.array([-ahead[1], ahead[0]])
    for _ in range(2):   # the second time along the curb itself, whose face is not blurred then
        first = cloud.mark("edge", x, y, direction, PICK.section_reach)
        if first is None:
            return None
        places, marks, along = cloud.followed("edge", _beside((x, y), direction, first.offset), direction, first)
        near = np.flatnonzero(np.abs(along) <= PICK.course / 2)
        if len(near) < PICK.fewest_places:
            return None
        at, across = ((places[near] - (x, y)) @ np.column_stack([ahead, left])).T
        foot, slope, sigma_across = _line_at_0(at, across)
        direction = azimuth - np.degrees(np.arctan(slope))
    bottoms, tops, runs, formal, counts = np.array([
        (marks[k].bottom, marks[k].top, marks[k].run, abs(marks[k].size) / marks[k].strength, marks[k].points) for k in near]).T
    bottom, height, run = _line_at_0(at, bottoms)[0], float(np.median(tops - bottoms)), np.median(runs)
    sigma_height = np.hypot(1.4826 * np.median(np.abs(tops - bottoms - height)), np.median(formal))
    ends = np.array([[*((x, y) + offset * left), z + cloud.origin[2]] for offset, z in ((foot, bottom), (foot + run, bottom + height))])
    sigma_across = np.hypot(sigma_across * np.cos(np.arctan(slope)), PICK.noise)
    return Face(ends, float(direction), height, float(sigma_height), float(sigma_across), int(counts.sum()) // 2)


def _line_at_0(at, values):
    """Value at 0 and slope of the line through (K,) values that most of them agree on, and one sigma of a value about it."""
    slope, value, _, _ = theilslopes(values, at)
    return value, slope, 1.4826 * np.median(np.abs(values - value - slope * at))


def snap_line(points: np.ndarray, places: np.ndarray, target: str) -> Seen | None:
    """A line that was drawn by hand along (K, 2) places, laid onto the faces or paint beside it; None where half of it is not seen.

    Its ends stay the places of its ends along the road; between places where something is seen it runs straight.
    points : (N, 4) x, y, z and intensity about the line, m; target : "edge" or "marking"
    """
    cloud = _Cloud(points)
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(places, axis=0).T))]
    at = np.linspace(0.0, along[-1], max(int(np.ceil(along[-1] / PICK.step)), 1) + 1)
    drawn = np.column_stack([np.interp(at, along, column) for column in places.T])
    ahead = np.gradient(drawn, axis=0)
    directions = np.degrees(np.arctan2(ahead[:, 0], ahead[:, 1]))
    marks = [cloud.mark(target, x, y, direction, PICK.near) for (x, y), direction in zip(drawn, directions)]
    rows = np.flatnonzero([mark is not None for mark in marks])
    if len(rows) * 2 <= len(marks) or len(rows) < 3:
        return None
    offset = np.interp(np.arange(len(marks)), rows, [marks[k].offset for k in rows])
    usual = np.array([np.median(offset[max(k - 3, 0):k + 4]) for k in range(len(offset))])
    offset = np.where(np.abs(offset - usual) > PICK.face, usual, offset)   # another line beside it, seen at a few places
    snapped = np.array([_beside(*row) for row in zip(drawn, directions, offset)])
    return _measured(target, snapped[rows[0]:rows[-1] + 1], [marks[k] for k in rows], rows * PICK.step)


def _measured(target, places, marks, along):
    """Seen from the marks of a line, which lie at increasing m `along` it."""
    size = float(np.median([abs(mark.size) for mark in marks]))
    bend = np.hypot(*(places[1:-1] - (places[:-2] + places[2:]) / 2).T)
    scatter = float(1.4826 * np.median(bend) / np.sqrt(1.5)) if len(bend) else np.nan
    stands_out = np.r_[False, (bend > PICK.face / 4) & (bend > 4 * scatter), False]   # as where a wheel stands at the curb
    places = places[~stands_out] if len(bend) else places
    gaps = np.diff(along)
    edge = target == "edge"
    return Seen(target, places, size if edge else np.nan, np.nan if edge else size,
                np.nan if edge else float(np.median([mark.width for mark in marks])),
                scatter, sum(mark.points for mark in marks) // 2,
                float(np.minimum(gaps, PICK.step).sum()), not edge and int((gaps > PICK.dash_gap).sum()) >= 2)


def _beside(place, direction, offset):
    """The place so many m left of one, seen in a direction (degrees clockwise from north)."""
    angle = np.radians(direction)
    return np.array([place[0] - offset * np.cos(angle), place[1] + offset * np.sin(angle)])


class _Cloud:
    """Points by place. `lowest` : m of a step that counts"""

    def __init__(self, points, lowest=PICK.lowest_step):
        self.lowest = lowest
        points = points[::len(points) // PICK.most_points + 1]
        self.origin = points[:, :3].mean(axis=0) if len(points) else np.zeros(3)
        self.points = points - np.r_[self.origin, 0.0]
        self.index = PlaceIndex(self.points[:, :2], 1.0)

    def mark(self, target, x, y, direction, reach):
        """The clearest _Mark across a place, at most `reach` m beside it; None where there is none."""
        most = reach + PICK.face + PICK.flank + PICK.face
        place = np.array([x, y]) - self.origin[:2]
        near = self.points[self.index.within(place - np.hypot(most, PICK.step), place + np.hypot(most, PICK.step))]
        angle = np.radians(direction)
        dx, dy = (near[:, :2] - place).T
        across = dy * np.sin(angle) - dx * np.cos(angle)
        inside = (np.abs(dx * np.sin(angle) + dy * np.cos(angle)) <= PICK.step) & (np.abs(across) <= most)
        if inside.sum() < 2 * PICK.fewest:
            return None
        near, across = near[inside], across[inside]
        ground = near[:, 2] <= np.quantile(near[:, 2], 0.02) + PICK.tallest
        across, z, intensity = across[ground], near[ground, 2], near[ground, 3]
        return _step(across, z, reach, self.lowest) if target == "edge" else _stripe(across, intensity, reach)

    def starts(self, targets, x, y, directions, reach):
        """(target, direction, mark) of what is seen across a place in some directions, the clearest and nearest first."""
        marks = [(target, direction, mark) for target in targets for direction in directions
                 if (mark := self.mark(target, x, y, direction, reach)) is not None]
        return sorted(marks, key=lambda start: -start[2].strength * np.exp(-(start[2].offset / PICK.near) ** 2))

    def followed(self, target, place, direction, first):
        """(K, 2) places of a line both ways from one of them, the marks seen, and m along it at which they were."""
        ways = []
        for way in (1.0, -1.0):
            seen, marks, along = [place], [first], [0.0]
            gap = PICK.curb_gap if target == "edge" else PICK.paint_gap
            course, ahead = direction, PICK.step
            while ahead <= gap + PICK.step:
                angle = np.radians(course)
                next_place = seen[-1] + way * ahead * np.array([np.sin(angle), np.cos(angle)])
                mark = self.mark(target, *next_place, course, PICK.reach)
                if mark is None or not 1.0 / PICK.same < mark.size / first.size < PICK.same:
                    ahead += PICK.step
                    continue
                seen.append(_beside(next_place, course, mark.offset))
                marks.append(mark)
                along.append(along[-1] + ahead)
                ahead = PICK.step
                behind = seen[np.searchsorted(along, along[-1] - PICK.course)]
                step = way * (seen[-1] - behind)
                course = np.degrees(np.arctan2(step[0], step[1])) if np.hypot(*step) >= PICK.course / 2 else course
            ways.append((seen, marks, along))
        (ahead_seen, ahead_marks, ahead_along), (back_seen, back_marks, back_along) = ways
        return (np.array([*back_seen[:0:-1], *ahead_seen]), [*back_marks[:0:-1], *ahead_marks],
                np.r_[-np.array(back_along[:0:-1]), ahead_along])


class _Sums:
    """Sums of values over ranges of their places across."""

    def __init__(self, across, values):
        self.order = np.argsort(across, kind="stable")
        self.across = across[self.order]
        v, y = self.across, values[self.order]
        self.total = np.vstack([np.zeros(6), np.cumsum(np.column_stack([np.ones(len(v)), v, y, v * v, v * y, y * y]), axis=0)])

    def line(self, low, high, at):
        """Of the values between (M,) places: count; value at `at`, slope and variance of the line through them; mean and variance about it."""
        ends = np.searchsorted(self.across, low), np.searchsorted(self.across, high)
        n, v, y, vv, vy, yy = (self.total[ends[1]] - self.total[ends[0]]).T
        with np.errstate(divide="ignore", invalid="ignore"):
            v, y = v / n, y / n
            sxx, sxy, syy = np.maximum(vv / n - v * v, 1e-6), vy / n - v * y, np.maximum(yy / n - y * y, 0.0)
            slope = sxy / sxx
            rest = np.maximum(syy - slope * sxy, 0.0) * n / (n - 2)
            return n, y + slope * (at - v), slope, rest / n * (1.0 + (at - v) ** 2 / sxx), y, syy


def _step(across, z, reach, lowest):
    """The clearest step of heights, of `lowest` m at least, within `reach` m of 0."""
    at = np.arange(-reach, reach + 1e-9, PICK.face / 4)
    sums = _Sums(across, z)
    n_left, left, left_slope, left_variance, _, _ = sums.line(at + PICK.face, at + PICK.face + PICK.flank, at)
    n_right, right, right_slope, right_variance, _, _ = sums.line(at - PICK.face - PICK.flank, at - PICK.face, at)
    step = left - right
    with np.errstate(invalid="ignore"):
        strength = np.abs(step) / np.sqrt(left_variance + right_variance + PICK.noise ** 2)
        possible = (np.minimum(n_left, n_right) >= PICK.fewest) & (np.abs(step) >= lowest) & (np.abs(step) <= PICK.highest_step) & \
            (strength >= PICK.certain) & (np.abs(step) >= PICK.knee * np.abs(left_slope - right_slope))
    if not possible.any():
        return None
    k = int(np.argmax(np.where(possible, strength, 0.0)))
    sides = [(right[k], right_slope[k]), (left[k], left_slope[k])]
    (low, slope), (high, upper_slope) = sides if step[k] > 0 else sides[::-1]
    # the share of the step that each point about the face lies above the low side; the face parts those below half of it from those above
    near = np.argsort(across, kind="stable")
    near = near[np.abs(across[near] - at[k]) <= 2 * PICK.face]
    v, share = across[near], (z[near] - low - slope * (across[near] - at[k])) / abs(step[k])
    above = np.where(share > 0.5, 1, -1) * np.sign(step[k])
    wrong = np.cumsum(above)
    middle, run = float(v[wrong == wrong.min()].mean()), 0.0
    face = (share > 0.15) & (share < 0.85) & (np.abs(v - middle) <= PICK.face + PICK.face / 4)
    # of a mountable curb its foot is meant; in a lower step noise looks like a lean
    if face.sum() >= PICK.fewest and np.ptp(share[face]) > 0.5 and abs(step[k]) >= 2 * PICK.lowest_step:
        run = float(np.clip(np.polyfit(share[face], v[face], 1)[0], -2 * PICK.face, 2 * PICK.face))
    foot, head = middle - run / 2, middle + run / 2
    return _Mark(foot, float(strength[k]), float(step[k]), np.nan, int(n_left[k] + n_right[k] + face.sum()),
                 float(low + slope * (foot - at[k])), float(high + upper_slope * (head - at[k])), run)


def _stripe(across, intensity, reach):
    """The clearest stripe of paint within `reach` m of 0."""
    at = np.arange(-reach, reach + 1e-9, PICK.face / 4)
    sums = _Sums(across, intensity)
    best = None
    for width in country("neutral").line_widths:
        inner, outer = 0.4 * width, width / 2 + PICK.face / 2
        n, _, _, _, bright, spread = sums.line(at - inner, at + inner, at)
        sides = [sums.line(at + sign * outer + min(sign, 0) * PICK.flank, at + sign * outer + max(sign, 0) * PICK.flank, at) for sign in (1, -1)]
        worst = np.full(len(at), np.inf)
        for n_side, _, _, _, dark, dark_spread in sides:
            with np.errstate(divide="ignore", invalid="ignore"):
                strength = (bright - dark) / np.sqrt(spread / n + dark_spread / n_side)
                strength = np.where((np.minimum(n, n_side) >= PICK.fewest) & (bright >= PICK.brighter * dark), strength, 0.0)
            worst = np.minimum(worst, np.nan_to_num(strength))
        k = int(np.argmax(worst))
        if worst[k] >= PICK.certain and (best is None or worst[k] > best.strength):
            middle = float(np.average(at, weights=np.where(np.abs(at - at[k]) <= width / 2, worst, 0.0)))
            dark = max(side[4][k] for side in sides)
            best = _Mark(middle, float(worst[k]), float(bright[k] / dark), width, int(n[k]))
    return best
