"""One road of OpenDRIVE from slices of lanes: reference line, lane offset, widths, heights."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..sources import LEAST_CHORD, LEAST_CURB
from .geometry import LEAST_STEP, STEP_RUN, Cubics, LineBundle, PlanView, difference, fit_cubics, risen, simplified
from .model import LaneSection, MapLane, MapRoad, shape_height
from .reference_line import Steps, farthest, polynomial_reference, reference_steps
from .strips import MOST_TURN, SLOPE_REACH, Slice

NEAREST_POINTS = 0.005   # m within which two places of a guide line are one
GUIDE_STEP = 0.1         # m between points of a guide line at the least: what lies between tells no direction
LEAST_GUIDE = 0.05       # m of a guide line: where lane 0 is shorter, as about a corner, another border leads
LEAST_END = 0.5          # m of width from which the end of a road has a direction
MOST_OBLIQUE = 0.5         # rad between the end of a road and a square cut to which it can turn within a few metres
SQUARE_END = 0.002           # m along the road by which the corners of an end may miss a square cut: validators allow 1 cm between two roads
END_CHORD = 5.0          # m of a road whose direction is that of its end
LOOSER = (1.0, 5.0, 25.0)   # times the tolerance that the reference line may lie beside a border with corners
SMOOTHER = (1.0, 3.0)    # m, standard deviations of the means that take the corners from a border that no other line follows
BEND_STEP = 0.25         # m between the places at which a border is held against the curvature
LEAST_STRETCH = 0.1      # of a border against the reference line: less is beside the centre of the curve
END_ROUNDS = 4
SAME_LINE = 0.02         # m by which lane 0 may jump from section to section and still go on


@dataclass
class RoadShape:
    """plan : reference line; s, t, z : for each slice a (borders, n) array of its vertices; starts : (sections + 1,) metres.
    courses : for each slice and border (3, n) s, t, z that reach from the start of its section to its end at least, s rising: sections are cut
        square, lanes are not
    """

    plan: PlanView
    s: list[np.ndarray]
    t: list[np.ndarray]
    z: list[np.ndarray]
    lifts: list[np.ndarray]   # for each slice (cells, n) metres that its lanes lie above the road, as beyond a curb; z is that of the road
    starts: np.ndarray
    courses: list[list[np.ndarray]]
    follows: bool   # whether the reference line lies on the border at which lane 0 is; else that has corners, which a smoother line cuts


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


def shape_steps(strip: list[Slice], centres: list[int], tolerance: float) -> Steps[RoadShape]:
    """A task of `side_by_side`: the reference line through the borders at which lane 0 lies, and every vertex in its s and t.

    Where lane 0 jumps aside, as where a lane for the opposite traffic begins, the reference line goes on beside it.

    strip : slices end to end
    centres : number of a border in each
    tolerance : metres that the centre border may lie beside the reference line; what is missed is made up by the lane offset
    """
    guide, index, along, keep = _guided(strip, centres)
    ends, widest = _end_headings(strip, guide)
    plan, follows = yield from _reference(guide[keep], tolerance, ends, SQUARE_END / max(widest, 1.0), _reach(strip, index, guide)[keep])
    shown, near = strip, [along[rows] * plan.length / along[-1] for rows in index]
    if not follows:   # seen from a line that cuts a corner, a border is not straight from vertex to vertex
        shown, near = (list(values) for values in zip(*(_finer(part, s) for part, s in zip(strip, near))))
    plan, s_all, t_all = _square_ends(plan, strip, shown, near)
    strip = shown
    for s in s_all:   # two vertices of every border nearly at one place are a step across the road: all borders have the same s there
        for k in np.flatnonzero((np.diff(s.mean(0)) < STEP_RUN) & (np.ptp(s[:, :-1], axis=0) < 2 * STEP_RUN)):
            s[:, k:k + 2] = s[:, k:k + 2].mean() + LEAST_STEP * np.array([-1.0, 1.0])
    z_all, lifts = (list(values) for values in zip(*(part.levels(centre) for part, centre in zip(strip, centres))))
    starts = np.array([0.0, *_cuts(strip, centres, s_all), plan.length])
    courses = [[_course(strip, k, j, (s_all, t_all, z_all), starts[k:k + 2]) for j in range(len(strip[k].cells) + 1)] for k in range(len(strip))]
    return RoadShape(plan, s_all, t_all, z_all, lifts, starts, courses, follows)


def _guided(strip, centres):
    """((N, 2) places along lane 0, rows of them for each slice, (N,) metres along, (N,) bool: the places that tell a direction)."""
    guide, index = _guide(strip, centres)
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(guide, axis=0).T)))
    if along[-1] < LEAST_GUIDE:
        guide, index = _guide(strip, [int(np.argmax([np.hypot(*np.diff(line[:, :2], axis=0).T).sum() for line in part.borders()])) for part in strip])
        along = np.append(0.0, np.cumsum(np.hypot(*np.diff(guide, axis=0).T)))
    keep = np.append(True, np.diff(np.floor(along / GUIDE_STEP)) > 0)
    keep[np.flatnonzero(keep)[-1] if keep.sum() > 1 else -1] = False
    keep[-1] = True
    return guide, index, along, keep


def _square_ends(plan, strip, shown, near):
    """(the reference line with what makes its ends square, s and t of the vertices from it). near : for each slice (n,) metres along the road"""
    for _ in range(END_ROUNDS):   # seen from a longer line the corners lie a little elsewhere
        s_all, t_all = [], []
        for part, along in zip(shown, near):
            places = np.stack(part.borders())[..., :2]
            s, t = plan.feet(places.reshape(-1, 2), np.tile(along, len(places)))
            s_all.append(s.reshape(places.shape[:2]))
            t_all.append(t.reshape(places.shape[:2]))
        # an end that meets no other road is made square, as far as borders reach beyond it
        before = 0.0 if strip[0].beyond(False) else max(-float(s_all[0][:, 0].min()), 0.0)
        after = 0.0 if strip[-1].beyond(True) else max(float(s_all[-1][:, -1].max()) - plan.length, 0.0)
        if max(before, after) < LEAST_STEP:
            break
        plan, near = plan.lengthened(before, after), [s + before for s in near]
    return plan, s_all, t_all


def _finer(one, s):
    """A slice with vertices every BEND_STEP at least, and their s from (n,) metres of its own."""
    gaps = max((np.hypot(*np.diff(border[:, :2], axis=0).T) for border in one.borders()), key=np.sum)
    parts = np.maximum(np.ceil(gaps / BEND_STEP), 1).astype(int)
    indices = np.append(np.repeat(np.arange(len(gaps)), parts) + (np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)) / np.repeat(
        parts, parts), len(gaps))

    def line(places):
        return np.stack([np.interp(indices, np.arange(len(s)), values) for values in places.T], axis=1)

    cells = [replace(cell, left=line(cell.left), right=line(cell.right), left_nodes=(cell.left_nodes[0], cell.left_nodes[-1]),
                     right_nodes=(cell.right_nodes[0], cell.right_nodes[-1])) for cell in one.cells]
    return replace(one, cells=cells), np.interp(indices, np.arange(len(s)), s)


def _cuts(strip, centres, s):
    """Metres at which sections begin after the first: at lane 0, but before borders that begin there and after those that end."""
    cuts = [0.0]
    for k in range(1, len(strip)):
        cut = float((s[k - 1][centres[k - 1], -1] + s[k][centres[k], 0]) / 2)
        ending, beginning = [nodes[-1] for nodes in strip[k - 1].nodes()], [nodes[0] for nodes in strip[k].nodes()]
        least = max((float(s[k - 1][j, -1]) for j, node in enumerate(ending) if node not in beginning), default=-np.inf)
        most = min((float(s[k][j, 0]) for j, node in enumerate(beginning) if node not in ending), default=np.inf)
        cut = (least + most) / 2 if least > most else min(max(cut, least), most)
        cuts.append(max(cut, cuts[-1] + LEAST_STEP))
    return cuts[1:]


def _course(strip, k, j, frame, ends):
    """(3, n) s, t, z of a border of a slice, with the vertices of the borders that it goes on in, and straight on beyond them."""
    def vertices(number, border):
        return np.stack([values[number][border] for values in frame])

    parts = [vertices(k, j)]
    for way, row, next_row in ((-1, 0, -1), (1, -1, 0)):
        number, border = k, j
        while 0 <= number + way < len(strip) and (parts[0][0, 0] > ends[0] - SLOPE_REACH if way < 0 else parts[-1][0, -1] < ends[1] + SLOPE_REACH):
            node = strip[number].nodes()[border][row]
            same = [index for index, nodes in enumerate(strip[number + way].nodes()) if nodes[next_row] == node]
            if len(same) != 1:
                break
            number, border = number + way, same[0]
            parts.insert(0 if way < 0 else len(parts), vertices(number, border))
    line = np.concatenate(parts, axis=1)
    line = line[:, risen(line[0])]
    for end, station in ((0, ends[0]), (-1, ends[1])):
        if line.shape[1] > 1 and (line[0, 0] > station if end == 0 else line[0, -1] < station):
            reach = np.flatnonzero(np.abs(line[0] - line[0, end]) >= LEAST_CHORD)
            index = 0 if end else -1
            index = int(reach[0 if end == 0 else -1]) if len(reach) else index
            slope = (line[1:, end] - line[1:, index]) / (line[0, end] - line[0, index])
            vertex = np.r_[station, line[1:, end] + slope * (station - line[0, end])]
            line = np.insert(line, 0 if end == 0 else line.shape[1], vertex, axis=1)
    return line


def _guide(strip, centres):
    """((N, 2) places, rows of them for each slice) along lane 0 without its jumps, from the longest slice outwards."""
    lines = [part.borders()[centre][:, :2] for part, centre in zip(strip, centres)]
    first, placed = int(np.argmax([part.length for part in strip])), dict(enumerate(lines))
    for k in range(first + 1, len(strip)):
        placed[k] = _beside(lines[k], placed[k - 1][-1], 0)
    for k in range(first - 1, -1, -1):
        placed[k] = _beside(lines[k], placed[k + 1][0], -1)
    starts = np.cumsum([0, *(len(line) - 1 for line in lines)])
    rows = [np.arange(start, end + 1) for start, end in zip(starts[:-1], starts[1:])]
    return np.concatenate([placed[0], *(placed[k][1:] for k in range(1, len(strip)))]), rows


def _reach(strip, index, guide):
    """(N, 2) metres from the guide to the rightmost border (negative) and to the leftmost one."""
    reach = np.zeros((len(guide), 2))
    for part, rows in zip(strip, index):
        for side, border, sign in ((0, part.cells[-1].right, -1), (1, part.cells[0].left, 1)):
            distances = sign * np.hypot(*(border[:, :2] - guide[rows]).T)
            reach[rows, side] = np.minimum(reach[rows, side], distances) if sign < 0 else np.maximum(reach[rows, side], distances)
    return reach


def _reference(points, tolerance, ends, turn_tolerance, reach):
    """(the reference line, whether it follows the points within the tolerance); a border with a corner is cut short by it, and the lane offset
    has the rest."""
    # to meet other roads squarely matters more than to lie on the border, and no border may fold back in a curve
    for headings in (ends, (None, None)):
        for width in (0.0, *SMOOTHER):
            guide = _smoothed(points, width) if width else points
            for loose in LOOSER:
                plan = yield from reference_steps(guide, loose * tolerance, headings, turn_tolerance)
                if plan is not None and not _folds(plan, points, reach):
                    return plan, guide is points and loose == LOOSER[0]
    return polynomial_reference(points), True


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
    """((start, end) headings square to the ends at which the road meets another, None where they are cut obliquely; metres, its width)."""
    headings, widest = [], 0.0
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(guide, axis=0).T)))
    near, far = (int(np.clip(np.searchsorted(along, distance), 1, len(guide) - 1)) for distance in (END_CHORD, along[-1] - END_CHORD))
    for part, row, way, meets in ((strip[0], 0, guide[near] - guide[0], strip[0].beyond(False)),
                                  (strip[-1], -1, guide[-1] - guide[far - 1], strip[-1].beyond(True))):
        across = (part.cells[0].left[row] - part.cells[-1].right[row])[:2]
        widest = max(widest, float(np.hypot(*across)))
        heading, along = float(np.arctan2(-across[0], across[1])), float(np.arctan2(way[1], way[0]))
        oblique = abs((heading - along + np.pi) % (2 * np.pi) - np.pi)
        headings.append(heading if meets and np.hypot(*across) > LEAST_END and oblique < MOST_OBLIQUE else None)
    return tuple(headings), widest


def _beside(line, place, end):
    """A line moved aside as far as its end lies from a place."""
    offset = place - line[end]
    if np.hypot(*offset) < NEAREST_POINTS:
        return line
    way = np.gradient(line, axis=0)
    normal = np.c_[-way[:, 1], way[:, 0]] / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
    return line + normal * (offset @ normal[end])


def fit_borders(roads: Sequence[tuple[RoadShape, list[Slice], list[int]]], tolerance: float,
                directions: dict[int, float]) -> list[list[list[Cubics]]]:
    """The borders of all sections of roads as functions of the metres from the start of the section.

    roads : the shape of each, its slices, and the number of the border in each at which lane 0 lies
    tolerance : metres that a border may be missed
    directions : {number of a vertex: radians} of the borders where roads meet others
    Returns for each road and each of its sections the functions from left to right
    """
    bundles = [bundle for shape, strip, _ in roads for bundle in _border_bundles(shape, strip, tolerance, directions)]
    centres = [centre for *_, road_centres in roads for centre in road_centres]
    fitted = fit_cubics(bundles)
    crossing = [k for k, (functions, bundle) in enumerate(zip(fitted, bundles)) if any(
        difference(left, right).least(bundle.end - bundle.start)[0] < -1e-9 for left, right in zip(functions[:-1], functions[1:]))]
    untangled = [LineBundle([bundle.s[0]] * len(bundle.s), _untangled(bundle.s, bundle.values, centres[k]), bundle.start, bundle.end, tolerance,
                            broken=True) for k, bundle in enumerate(bundles) if k in crossing]
    for k, functions in zip(crossing, fit_cubics(untangled)):
        fitted[k] = functions
    sections = iter(fitted)
    return [[next(sections) for _ in strip] for _, strip, _ in roads]


def _border_bundles(shape, strip, tolerance, directions):
    """The borders of every section of a road."""
    bundles = []
    for k, (courses, start, end) in enumerate(zip(shape.courses, shape.starts[:-1], shape.starts[1:])):
        s = [np.r_[start, along[(along > start + LEAST_STEP) & (along < end - LEAST_STEP)], end] for along, _, _ in courses]
        t = [np.interp(places, *course[:2]) for places, course in zip(s, courses)]
        slopes = [_slopes_where_met(shape, strip, directions, at_end) if k == outermost else [_slope_at(place, course) for course in courses]
                  for at_end, place, outermost in ((False, start, 0), (True, end, len(strip) - 1))]
        bundles.append(LineBundle(s, t, start, end, tolerance, list(zip(*slopes))))
    return bundles


def add_lanes(road: MapRoad, shape: RoadShape, strip: list[Slice], centres: list[int], sections: list[list[Cubics]]) -> list[list[int]]:
    """Give a road its lane offset and sections with widths, by the functions of their borders.

    Returns for every slice the numbers of the lanes of its cells
    """
    offsets, numbers = [], []
    lines = _lines_of_lane_0(sections, centres, np.diff(shape.starts), int(np.argmax([part.length for part in strip])))
    for start, part, centre, functions, line in zip(shape.starts, strip, centres, sections, lines):
        section = LaneSection(float(start))
        section.lanes[0] = MapLane(0, "none")
        ids = [centre - j if j < centre else centre - j - 1 for j in range(len(part.cells))]
        if line is not functions[centre]:   # between lane 0 and the lanes beside it there is nothing
            side = -1 if centre == 0 else 1
            section.lanes[side] = MapLane(side, "none", width=simplified(difference(*((line, functions[0]) if side < 0 else (functions[-1], line)))))
            ids = [id + side for id in ids]
        for j, id in enumerate(ids):
            section.lanes[id] = MapLane(id, width=simplified(difference(functions[j], functions[j + 1])))
        road.sections.append(section)
        numbers.append(ids)
        offsets.append(simplified(line).moved(start).rows)
    rows = np.concatenate(offsets)
    road.lane_offset = Cubics.constant() if np.abs(rows[:, 1:]).max() < 1e-4 else Cubics(rows)
    return numbers


def _lines_of_lane_0(sections, centres, lengths, first):
    """Where lane 0 lies in every section: along its border, or straight on beside it where that border jumps aside and no lane is in the way.

    Readers differ on which section a place on their common cut belongs to, so a jump of lane 0 is a gap to some of them.
    """
    lines = {first: sections[first][centres[first]]}
    for way in (1, -1):
        before_end, line_start = (-1, 0) if way > 0 else (0, -1)
        for k in range(first + way, len(sections) if way > 0 else -1, way):
            line, before = sections[k][centres[k]], lines[k - way]
            value, start_value = float(before.at(lengths[k - way] * -before_end)), float(line.at(lengths[k] * -line_start))
            if abs(start_value - value) <= SAME_LINE:
                lines[k] = line
            else:
                straight = Cubics(np.c_[line.rows[:, 0], np.full(len(line), value), np.zeros((len(line), 3))])
                room = difference(straight, line) if centres[k] == 0 else difference(line, straight) if centres[k] == len(sections[k]) - 1 else None
                lines[k] = straight if room is not None and room.least(lengths[k])[0] >= 0.0 else line
    return [lines[k] for k in range(len(sections))]


def _slope_at(place, course):
    """The slope of a border where a section is cut, from its vertices before and after; NaN where it does not go on, or turns there."""
    s, t = course[:2]
    sides = [(s >= place - SLOPE_REACH) & (s < place - LEAST_STEP), (s > place + LEAST_STEP) & (s <= place + SLOPE_REACH)]
    if min(int(side.sum()) for side in sides) < 2:
        return np.nan
    offset = np.interp(place, s, t)
    before, after = (float((s[side] - place) @ (t[side] - offset) / ((s[side] - place) @ (s[side] - place))) for side in sides)
    return (before + after) / 2 if abs(after - before) < MOST_TURN else np.nan


def _slopes_where_met(shape, strip, directions, at_end):
    """The slope of every border at an end of the road, as the borders of the roads that it meets have it; NaN where it meets none."""
    row = -1 if at_end else 0
    _, (heading,), (bend,) = shape.plan.at(np.array([shape.plan.length if at_end else 0.0]))
    slopes = []
    for nodes, t in zip(strip[row].nodes(), shape.t[row][:, row]):
        turn = (directions.get(nodes[row], np.nan) - heading + np.pi / 2) % np.pi - np.pi / 2
        slopes.append(float(np.tan(turn) * (1 - bend * t)) if abs(turn) < MOST_TURN else np.nan)
    return slopes


def _untangled(s, t, centre):
    """Offsets that never cross, from lane 0 outwards, at the places of the first border."""
    levels = np.array([np.interp(s[0], x, value) for x, value in zip(s, t)])
    levels[centre::-1] = np.maximum.accumulate(levels[centre::-1])
    levels[centre:] = np.minimum.accumulate(levels[centre:])
    return list(levels)


# The heights of an OpenDRIVE road: an elevation along it, and across it a superelevation or the shape of the cross-section.

FLAT = 0.001             # m of height that a cross-section may miss without a crossfall of its own
ROLLED = 0.001           # m by which a superelevation may move a border in plan: readers differ on whether it does
SAME_PLACE_ALONG = 0.05  # m along the road within which two cross-sections are one
SAME_T = 0.01            # m across within which two places of a cross-section are one
SHAPE_ROUNDS = 3
CLOSER = (0.5, 0.25, 0.1, 0.0)   # shares of the tolerance within which cross-sections are left out, until all places are met


class _Profile(NamedTuple):
    """A cross-section. s : metres; t : (n,) metres to the left, rising; z : (n,) metres, heights there."""

    s: float
    t: np.ndarray
    z: np.ndarray


def add_heights(road: MapRoad, shape: RoadShape, tolerance: float) -> None:
    """Give a road its elevation, and a superelevation where the cross-section is a plane, else its shape, within a tolerance, m.

    A superelevation is taken only where its roll moves no border by more than a millimetre: readers differ on whether it does. The shape has
    as many cross-sections as it takes to meet the heights of all vertices.
    """
    level = np.concatenate([z.ravel() for z in shape.z])
    if np.ptp(level) == 0:
        road.elevation = Cubics.constant(float(level[0]))
        return
    profiles = _profiles(shape, np.zeros(0))
    s = np.array([profile.s for profile in profiles])
    middle = _at_reference(profiles, s)
    (elevation,), = fit_cubics([LineBundle([s], [middle], 0.0, road.length, tolerance / 2)])
    road.elevation = simplified(elevation)
    if max(float(np.abs(profile.z - level).max()) for profile, level in zip(profiles, middle)) < FLAT:
        return
    if _superelevation(road, profiles, middle, tolerance):
        return
    # s, t and height above the elevation of all vertices along the road
    s, t, z = (np.concatenate([values.ravel() for values in parts]) for parts in (shape.s, shape.t, shape.z))
    targets = np.c_[s, t, z - road.elevation.at(s)][(s >= 0.0) & (s <= road.length)]
    missed = np.zeros(0)
    for _ in range(SHAPE_ROUNDS):   # cross-sections are where the lanes have vertices; where that is not enough, also where one border has some
        profiles = _profiles(shape, targets[missed > tolerance, 0] if len(missed) else missed)
        levels = road.elevation.at(np.array([profile.s for profile in profiles]))
        profiles = [profile._replace(z=profile.z - level) for profile, level in zip(profiles, levels)]
        for share in CLOSER:
            # straight from place to place of a cross-section, and beyond them
            kept = [profiles[k] for k in _telling(profiles, share * tolerance)]
            road.shape = np.array([[s, a, b, c, 0.0, 0.0] for s, t, z in kept for a, b, c in zip(t, z, _slopes(t, z))])
            missed = np.abs(shape_height(road.shape, targets[:, 0], targets[:, 1]) - targets[:, 2])
            if missed.max(initial=0.0) <= tolerance:
                return


def heights_above_road(shape: RoadShape, number: int, cell: int) -> np.ndarray:
    """(N, 3) metres from the start of a slice's section, heights of the inner and outer border of one of its lanes above the road."""
    lift, s = shape.lifts[number][cell], shape.s[number][cell:cell + 2].mean(0) - shape.starts[number]
    rows = [(0.0, lift[0])]
    for station, value in zip(s, lift):
        if abs(value - rows[-1][1]) > LEAST_CURB:
            rows.append((max(float(station), 0.0), value))
    return np.array([(station, value, value) for station, value in rows]) if lift.any() else np.empty((0, 3))


def _at_reference(profiles, s):
    """(N,) heights at the reference line; where lanes lie on one side of it alone, those before and after it: the shape has the rest."""
    height = np.array([_height(profile, np.zeros(1))[0] for profile in profiles])
    inside = np.array([profile.t[0] - SAME_T <= 0.0 <= profile.t[-1] + SAME_T for profile in profiles])
    if not inside.any():
        return np.array([profile.z[np.argmin(np.abs(profile.t))] for profile in profiles])
    return np.where(inside, height, np.interp(s, s[inside], height[inside]))


def _profiles(shape, more):
    """A cross-section wherever the lanes have vertices, at both ends of every slice, and at (N,) more s, in order; of two at one place one."""
    profiles = []
    for number, (first, last) in enumerate(zip(shape.starts[:-1], shape.starts[1:])):
        places = np.sort(np.append(shape.s[number].mean(0), more))
        places = places[risen(places)]
        places = places[(places > first + SAME_PLACE_ALONG) & (places < last - SAME_PLACE_ALONG)]
        places = np.concatenate([[first], places, [last]])
        t, z = (np.stack([np.interp(places, course[0], course[row]) for course in shape.courses[number]]) for row in (1, 2))
        order = np.argsort(t, axis=0, kind="stable")
        t, z = np.take_along_axis(t, order, 0), np.take_along_axis(z, order, 0)
        slice_profiles = [_Profile(float(s), t[:, k], z[:, k]) for k, s in enumerate(places)]
        if profiles:   # where two slices meet
            s, *before = profiles.pop()
            t, z = (np.concatenate(values) for values in zip(before, slice_profiles[0][1:]))
            order = np.argsort(t, kind="stable")
            slice_profiles[0] = _Profile(s, t[order], z[order])
        profiles += slice_profiles
    apart = (np.append(True, np.diff(np.maximum.accumulate(profile.t)) > SAME_T) for profile in profiles)
    return [_Profile(s, t[keep], z[keep]) for (s, t, z), keep in zip(profiles, apart)]


def _superelevation(road, profiles, middle, tolerance):
    """Roll the road where every cross-section is a plane; whether it could be."""
    slopes = np.array([float((profile.t @ (profile.z - level)) / max(profile.t @ profile.t, 1e-9)) for profile, level in zip(profiles, middle)])
    missed = max(float(np.abs(profile.z - level - profile.t * slope).max()) for profile, level, slope in zip(profiles, middle, slopes))
    widest = max(float(np.abs(profile.t).max()) for profile in profiles)
    if missed > tolerance / 4 or widest * (1 - np.cos(np.arctan(np.abs(slopes).max()))) > ROLLED:
        return False
    s = np.array([profile.s for profile in profiles])
    (roll,), = fit_cubics([LineBundle([s], [np.arctan(slopes)], 0.0, road.length, tolerance / 4 / max(widest, 1.0))])
    road.superelevation = simplified(roll)
    return True


def _slopes(t, z):
    """(n,) of the straight piece that begins at each place; the last one's goes on."""
    slope = np.diff(z) / np.diff(t) if len(t) > 1 else np.zeros(1)
    return np.append(slope, slope[-1])[:len(t)]


def _telling(profiles, tolerance):
    """Numbers of the cross-sections between which all others are interpolated within a tolerance."""
    kept, last = [0], len(profiles) - 1
    while kept[-1] < last:
        kept.append(farthest(kept[-1] + 1, last, lambda k: _between(profiles, kept[-1], k, tolerance)))
    return kept


def _between(profiles, first, last, tolerance):
    """Whether the cross-sections between two are what the format interpolates there: along the road at equal offsets."""
    a, b = profiles[first], profiles[last]
    middle = profiles[first + 1:last]
    count = [len(profile.t) for profile in middle]
    t, z = (np.concatenate([profile[row] for profile in middle]) for row in (1, 2))
    share = np.repeat([(profile.s - a.s) / max(b.s - a.s, 1e-9) for profile in middle], count)
    return bool(np.abs((1 - share) * _height(a, t) + share * _height(b, t) - z).max() <= tolerance)


def _height(profile, t):
    """(N,) heights of a cross-section at (N,) offsets."""
    _, x, z = profile
    slope = _slopes(x, z)
    return np.interp(t, x, z) + slope[0] * np.minimum(t - x[0], 0.0) + slope[-1] * np.maximum(t - x[-1], 0.0)
