"""One road of OpenDRIVE from slices of lanes: reference line, lane offset, widths, heights."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .geometry import Cubics, PlanView
from .model import LaneSection, MapLane, MapRoad
from .profiles import broken_lines, difference, fit_cubics, simplified
from .reference_line import fit_reference, polynomial_reference
from .strips import Slice

NEAREST_POINTS = 0.005   # m between points of a guide line
FLAT = 0.001             # m of height that a cross-section may miss without a crossfall of its own
ROLLED = 0.001           # m by which a superelevation may move a border in plan: readers differ on whether it does
SAME_PLACE_ALONG = 0.05  # m between cross-sections at which lanes are cut
MOST_SECTIONS = 40       # between two cross-sections that are written
LEAST_END = 0.5          # m of width from which the end of a road has a direction
MOST_ASKEW = 0.2         # rad between the end of a road and a square cut: more is askew on purpose
LOOSER = (1.0, 5.0, 25.0)   # times the tolerance that the reference line may lie beside a border with corners
SMOOTHER = (1.0, 3.0)    # m, standard deviations of the means that take the corners from a border that no other line follows
BEND_STEP = 0.25         # m between the places at which a border is held against the curvature
LEAST_STRETCH = 0.1      # of a border against the reference line: less is beside the centre of the curve
FOOT_ROUNDS = 8
LEAST_STEP = 0.001       # m along the road between places that count


@dataclass
class RoadShape:
    """plan : reference line; s, t, z : for each slice a (borders, n) array of its vertices; starts : (sections + 1,) metres."""

    plan: PlanView
    s: list[np.ndarray]
    t: list[np.ndarray]
    z: list[np.ndarray]
    starts: np.ndarray


def centre_of(one: Slice, left_hand: bool) -> int:
    """Number of the border at which lane 0 lies: traffic along the road is right of it, in left-hand traffic left."""
    ways = [cell.direction for cell in one.cells]
    along = [k for k, way in enumerate(ways) if way > 0]
    against = [k for k, way in enumerate(ways) if way < 0]
    if along:
        return along[-1] + 1 if left_hand else along[0]
    if against:
        return against[0] if left_hand else against[-1] + 1
    return len(ways) if left_hand else 0


def shape_of(strip: list[Slice], centres: list[int], tolerance: float) -> RoadShape:
    """The reference line through the borders at which lane 0 lies, and every vertex in its s and t.

    Where lane 0 jumps aside, as where a lane for the opposite traffic begins, the reference line goes on beside it.

    Parameters
    ----------
    strip : slices end to end
    centres : number of a border in each
    tolerance : metres that the centre border may lie beside the reference line; what is missed is made up by the lane offset
    """
    guide, index = _guide(strip, centres)
    keep = np.append(True, np.hypot(*np.diff(guide, axis=0).T) > NEAREST_POINTS)
    ends, widest = _end_headings(strip, guide)
    plan = _reference(guide[keep], tolerance, ends, tolerance / max(widest, 1.0), _reach(strip, index, guide)[keep])
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(guide, axis=0).T)))
    along *= plan.length / along[-1]
    s_all, t_all, z_all = [], [], []
    for one, rows in zip(strip, index):
        places = np.stack(one.borders())
        s, t = feet(plan, places[..., :2].reshape(-1, 2), np.tile(along[rows], len(places)))
        s_all.append(s.reshape(places.shape[:2]))
        t_all.append(t.reshape(places.shape[:2]))
        z_all.append(places[..., 2])
    cuts = [float((s_all[k - 1][centres[k - 1], -1] + s_all[k][centres[k], 0]) / 2) for k in range(1, len(strip))]
    return RoadShape(plan, s_all, t_all, z_all, np.array([0.0, *cuts, plan.length]))


def _guide(strip, centres):
    """((N, 2) places, rows of them for each slice) along lane 0 without its jumps, from the longest slice outwards."""
    lines = [one.borders()[centre][:, :2] for one, centre in zip(strip, centres)]
    first = int(np.argmax([one.length for one in strip]))
    placed = {first: lines[first]}
    for k in range(first + 1, len(strip)):
        placed[k] = _beside(lines[k], placed[k - 1][-1], 0)
    for k in range(first - 1, -1, -1):
        placed[k] = _beside(lines[k], placed[k + 1][0], -1)
    rows, at = [], 0
    for k in range(len(strip)):
        rows.append(np.arange(at, at + len(lines[k])))
        at += len(lines[k]) - 1
    return np.concatenate([placed[0], *(placed[k][1:] for k in range(1, len(strip)))]), rows


def _reach(strip, index, guide):
    """(N, 2) metres from the guide to the rightmost border (negative) and to the leftmost one."""
    found = np.zeros((len(guide), 2))
    for one, rows in zip(strip, index):
        for side, border, sign in ((0, one.cells[-1].right, -1), (1, one.cells[0].left, 1)):
            away = sign * np.hypot(*(border[:, :2] - guide[rows]).T)
            found[rows, side] = np.minimum(found[rows, side], away) if sign < 0 else np.maximum(found[rows, side], away)
    return found


def _reference(points, tolerance, ends, turn_tolerance, reach):
    """The reference line; a border with a corner is cut short by it, and the lane offset has the rest."""
    # to meet other roads squarely matters more than to lie on the border, and no border may fold back in a curve
    guides = [points, *(_smoothed(points, width) for width in SMOOTHER)]
    for headings in (ends, (None, None)):
        for guide in guides:
            for loose in LOOSER:
                plan = fit_reference(guide, loose * tolerance, headings, turn_tolerance)
                if plan is not None and not _folds(plan, points, reach):
                    return plan
    return polynomial_reference(points)


def _folds(plan, points, reach):
    """Whether a border lies beyond the centre of a curve, or nearly."""
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    s = np.linspace(0.0, plan.length, max(int(plan.length / BEND_STEP), 1) + 1)
    bend = plan.at(s)[2]
    return any((1 - bend * np.interp(s, along * plan.length / along[-1], side) < LEAST_STRETCH).any() for side in reach.T)


def _smoothed(points, width):
    """A line without its corners: every place is the mean of those around it; the ends stay."""
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    even = np.linspace(0.0, along[-1], max(int(along[-1] / BEND_STEP), 2) + 1)
    line = np.stack([np.interp(even, along, column) for column in points.T], axis=1)
    count = int(min(3 * width / even[1], len(line) - 1))
    padded = np.concatenate([2 * line[0] - line[count:0:-1], line, 2 * line[-1] - line[-2:-count - 2:-1]])
    weights = np.exp(-0.5 * (np.arange(-count, count + 1) * even[1] / width) ** 2)
    return np.stack([np.convolve(column, weights / weights.sum(), mode="valid") for column in padded.T], axis=1)


def _end_headings(strip, guide):
    """((start, end) headings square to the ends of the road, None where they are cut askew; metres, its width)."""
    found, widest = [], 0.0
    for one, row, way in ((strip[0], 0, guide[min(2, len(guide) - 1)] - guide[0]), (strip[-1], -1, guide[-1] - guide[-min(3, len(guide))])):
        across = (one.cells[0].left[row] - one.cells[-1].right[row])[:2]
        widest = max(widest, float(np.hypot(*across)))
        heading, along = float(np.arctan2(-across[0], across[1])), float(np.arctan2(way[1], way[0]))
        askew = abs((heading - along + np.pi) % (2 * np.pi) - np.pi)
        found.append(heading if np.hypot(*across) > LEAST_END and askew < MOST_ASKEW else None)
    return tuple(found), widest


def _beside(line, place, end):
    """A line moved aside as far as its end lies from a place."""
    away = place - line[end]
    if np.hypot(*away) < NEAREST_POINTS:
        return line
    way = np.gradient(line, axis=0)
    normal = np.c_[-way[:, 1], way[:, 0]] / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
    return line + normal * (away @ normal[end])


def feet(plan: PlanView, places: np.ndarray, near: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """((N,) s, (N,) t) of (N, 2) places, found from s nearby; beyond the ends the first and last element go on."""
    s = np.array(near, float)
    for _ in range(FOOT_ROUNDS):
        on, heading, bend = plan.at(s)
        dx, dy = places[:, 0] - on[:, 0], places[:, 1] - on[:, 1]
        across = dy * np.cos(heading) - dx * np.sin(heading)
        s = s + (dx * np.cos(heading) + dy * np.sin(heading)) / np.clip(1 - bend * across, 0.2, 5.0)
    on, heading, _ = plan.at(s)
    dx, dy = places[:, 0] - on[:, 0], places[:, 1] - on[:, 1]
    return s, dy * np.cos(heading) - dx * np.sin(heading)


def add_lanes(road: MapRoad, shape: RoadShape, strip: list[Slice], centres: list[int], tolerance: float) -> list[list[int]]:
    """Give a road its lane offset and sections with widths.

    Returns
    -------
    the number of the lane of every cell of every slice
    """
    offsets, numbers = [], []
    for k, (one, centre) in enumerate(zip(strip, centres)):
        start, end = shape.starts[k], shape.starts[k + 1]
        s, t = zip(*(_within(start, end, *_rising(*_lengthened(shape, strip, k, j))) for j in range(len(one.cells) + 1)))
        functions = fit_cubics(s, t, start, end, tolerance)
        if _crossing(functions, end - start):
            functions = broken_lines(s, _untangled(s, t, centre), start, end)
        section = LaneSection(float(start))
        section.lanes[0] = MapLane(0, "none")
        ids = [centre - j if j < centre else centre - j - 1 for j in range(len(one.cells))]
        for j, id in enumerate(ids):
            section.lanes[id] = MapLane(id, width=simplified(difference(functions[j], functions[j + 1])))
        road.sections.append(section)
        numbers.append(ids)
        offsets.append(simplified(functions[centre]).moved(start).rows)
    rows = np.concatenate(offsets)
    road.lane_offset = Cubics.constant() if np.abs(rows[:, 1:]).max() < 1e-4 else Cubics(rows)
    return numbers


def _lengthened(shape, strip, k, border):
    """s and t of a border of a slice, with a vertex more at each end where it goes on in the next slice: sections are cut square, lanes not."""
    s, t = shape.s[k][border], shape.t[k][border]
    for other, here, there, beyond in ((k - 1, 0, -1, -2), (k + 1, -1, 0, 1)):
        if not 0 <= other < len(strip):
            continue
        node = strip[k].nodes()[border][here]
        same = [j for j, nodes in enumerate(strip[other].nodes()) if nodes[there] == node]
        if len(same) == 1:
            at = 0 if here == 0 else len(s)
            s, t = np.insert(s, at, shape.s[other][same[0], beyond]), np.insert(t, at, shape.t[other][same[0], beyond])
    return s, t


def _within(start, end, s, values):
    """Places of a function from start to end; where it reaches beyond, it is cut off there."""
    inner = (s > start + LEAST_STEP) & (s < end - LEAST_STEP)
    if not inner.any() and len(s) < 2:
        return s, values
    # what ends before an edge keeps its last place: the function goes straight on from there
    first = [start] if s[0] <= start + LEAST_STEP else []
    last = [end] if s[-1] >= end - LEAST_STEP else []
    places = np.concatenate([first, s[inner], last])
    return (places, np.interp(places, s, values)) if len(places) > 1 else (s, values)


def _rising(s, values):
    keep = np.append(True, np.diff(np.maximum.accumulate(s)) > LEAST_STEP)
    return s[keep], values[keep]


def _crossing(functions, length):
    return any(difference(left, right).least(length)[0] < -1e-9 for left, right in zip(functions[:-1], functions[1:]))


def _untangled(s, t, centre):
    """Offsets that never cross, from lane 0 outwards, at the places of the first border."""
    levels = [np.interp(s[0], one, value) for one, value in zip(s, t)]
    for k in range(centre - 1, -1, -1):
        levels[k] = np.maximum(levels[k], levels[k + 1])
    for k in range(centre + 1, len(levels)):
        levels[k] = np.minimum(levels[k], levels[k - 1])
    return [np.interp(one, s[0], level) for one, level in zip(s, levels)]


def add_heights(road: MapRoad, shape: RoadShape, tolerance: float) -> None:
    """Give a road its elevation, and a superelevation where the cross-section is a plane, else its shape.

    A superelevation is taken only where its roll moves no border by more than a millimetre: readers differ on whether it does.
    """
    along: list[float] = []
    level: list[float] = []
    sections: list[tuple[float, np.ndarray, np.ndarray]] = []
    for s, t, z in zip(shape.s, shape.t, shape.z):
        for column in range(s.shape[1]):
            order = np.argsort(t[:, column], kind="stable")
            across, height = t[order, column], z[order, column]
            at = float(s[int(np.argmin(np.abs(t[:, column]))), column])
            middle = float(_extended(0.0, across, height))
            along.append(at)
            level.append(middle)
            sections.append((at, across, height - middle))
    order = np.argsort(along, kind="stable")
    places, values = _rising(np.array(along)[order], np.array(level)[order])
    road.elevation = simplified(fit_cubics([places], [values], 0.0, road.length, tolerance / 2)[0])
    sections = [sections[k] for k in order]
    if max(np.abs(rise).max() for _, _, rise in sections) < FLAT:
        return
    slopes = np.array([float((t @ rise) / max(t @ t, 1e-9)) for _, t, rise in sections])
    missed = max(float(np.abs(rise - t * slope).max()) for (_, t, rise), slope in zip(sections, slopes))
    moved = max(float(np.abs(t).max()) * (1 - np.cos(np.arctan(slope))) for (_, t, _), slope in zip(sections, slopes))
    if missed < tolerance / 2 and moved < ROLLED:
        at, roll = _rising(np.array([s for s, _, _ in sections]), np.arctan(slopes))
        widest = max(float(np.abs(t).max()) for _, t, _ in sections)
        road.superelevation = simplified(fit_cubics([at], [roll], 0.0, road.length, tolerance / 2 / widest)[0])
        return
    rows = []
    sections = _one_each(sections)
    for k in _telling(sections, tolerance / 2):
        place, offsets, heights = sections[k]
        t, rise = _rising(offsets, heights)
        slope = np.diff(rise) / np.diff(t) if len(t) > 1 else np.zeros(1)
        rows += [[float(np.clip(place, 0.0, road.length)), a, b, c, 0.0, 0.0] for a, b, c in zip(t, rise, [*slope, 0.0])]
    road.shape = np.array(rows)


def _one_each(sections):
    """One cross-section a place: where two slices meet the wider one."""
    found = [sections[0]]
    for section in sections[1:]:
        if section[0] - found[-1][0] > SAME_PLACE_ALONG:
            found.append(section)
        elif np.ptp(section[1]) > np.ptp(found[-1][1]):
            found[-1] = found[-1][0], section[1], section[2]
    return found


def _telling(sections, tolerance):
    """Numbers of the cross-sections between which all others are interpolated within a tolerance."""
    kept, last = [0], len(sections) - 1
    while kept[-1] < last:
        first = kept[-1]
        reach = first + 1
        for k in range(first + 2, min(first + MOST_SECTIONS, last) + 1):
            if any(not _between(sections[first], sections[j], sections[k], tolerance) for j in range(first + 1, k)):
                break
            reach = k
        kept.append(reach)
    return kept


def _between(first, middle, last, tolerance):
    """Whether a cross-section is that between two others; where lanes begin or end it is not."""
    if not len(first[1]) == len(middle[1]) == len(last[1]) or last[0] - first[0] < LEAST_STEP:
        return False
    share = (middle[0] - first[0]) / (last[0] - first[0])
    return bool(np.abs(first[2] + share * (last[2] - first[2]) - middle[2]).max() <= tolerance)


def _extended(at, x, y):
    """Linear interpolation that goes on beyond the ends."""
    if len(x) > 1 and (at < x[0] or at > x[-1]):
        i, j = (0, 1) if at < x[0] else (-1, -2)
        run = x[i] - x[j]
        return y[i] + (y[i] - y[j]) / run * (at - x[i]) if abs(run) > 0.1 else y[i]
    return np.interp(at, x, y)
