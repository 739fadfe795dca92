"""The curb on one side of a road, whatever method finds its steps: sections searched, passes merged, chains chosen, points in blocks."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from ...common.progress import Progress
from ...execution.phase import Phase
from ...survey.frame.road import Road
from ...survey.frame.road_frame import RoadFrame
from ..weights import CURBS
from .corners import CurbSteps
from .curb_limits import CurbLimits
from .curb_points import CurbPoints
from .lowered_curb import lowered_points
from .occlusion import OcclusionGrid
from .sides import SIDE_SIGNS, OutermostTrack, fixed_sections, hidden_points, join_sections, points_of_rows
from .tracking import StepChain, curb_chains, drop_short_curbs, is_road, link_steps, select_along_road, with_pieces_in_line

if TYPE_CHECKING:
    from ..surface.road_look import RoadLook

AnySteps = TypeVar("AnySteps", bound=CurbSteps)
Section = tuple[str, int, int, int]   # method, number of a road, first and last + 1 number of its profiles or planes


@dataclass(frozen=True)
class Search:
    """Where a method looks for steps.

    width : m of road per profile, or from one plane to the next
    limits : CurbLimits of what is taken for a curb
    sections : {number of a road: [(first, last + 1) numbers of profiles or planes]}
    bounds : {number of a road: (K,) m, stations at which blocks begin and end}
    """

    width: float
    limits: CurbLimits
    sections: dict[int, list[tuple[int, int]]]
    bounds: dict[int, np.ndarray]

    @classmethod
    def of(cls, spans: Mapping[int, tuple[float, float]], frame: RoadFrame, width: float, limits: CurbLimits, block_length: float,
           beyond: int = 0) -> Search:
        """A Search between two stations of each road, m, and as many planes `beyond`; `block_length` is that of `block_bounds`."""
        return cls(width, limits, {road: fixed_sections(int(np.floor(start / width)), int(np.ceil(end / width)) + beyond, width)
                                   for road, (start, end) in spans.items()},
                   {road: block_bounds(frame.road(road), start, end, block_length) for road, (start, end) in spans.items()})


def steps_of_roads(function: Callable, source: Any, settings: tuple[Any, ...], searches: Mapping[str, Search],
                   progress: Progress) -> dict[str, dict[tuple[int, str], SideSteps]]:
    """{method: {(number of a road, side): SideSteps}}; what several methods read of one place is worked on together.

    function : the phase; (source, Section, *settings) -> side -> CurbSteps, and side -> OcclusionGrid
    source : PointDecimation of a survey, or scanlines
    """
    sections = [(method, road, *section) for method, search in searches.items() for road, of_road in search.sections.items() for section in of_road]
    sections.sort(key=lambda section: (section[1], section[2] * searches[section[0]].width))
    parts: dict[tuple[str, int, str], list[CurbSteps]] = {}
    grids: dict[tuple[str, int, str], list[OcclusionGrid]] = {}
    phase = Phase(function, source, settings, join=join_sections, together=CURBS.sections_together * len(searches), **_of_profiles(
        source, lambda section: (section[1], *(number * searches[section[0]].width for number in section[2:]))))
    for (steps_by_side, beside), (method, road, *_) in zip(source.executor.run(phase, sections, progress), sections):
        for collected, values in ((parts, steps_by_side), (grids, beside)):
            for side, of_side in values.items():
                collected.setdefault((method, road, side), []).append(of_side)
    result: dict[str, dict[tuple[int, str], SideSteps]] = {method: {} for method in searches}
    for (method, road, side), of_side in grids.items():
        steps, search = parts.get((method, road, side)), searches[method]
        result[method][road, side] = SideSteps(type(steps[0]).join(steps) if steps else None, search.width, search.limits, search.bounds[road],
                                               OcclusionGrid.join(of_side))
    return result


def _of_profiles(source, span):
    """`Survey.along`; of scanlines of a layer, what messages call planes of a road."""
    return source.survey.along(span, source.known, reach=source.reach) if hasattr(source, "survey") else dict(
        place=lambda item: "road {}, {:.0f} to {:.0f} m".format(*span(item)))


def phase_along(function: Callable, source: Any, arguments: tuple[Any, ...], width: float, join: Callable) -> Phase:
    """A phase over sections of profiles: (number of a road, first, last + 1); `width` : m from one profile to the next."""
    return Phase(function, source, arguments, join=join, together=CURBS.sections_together, **_of_profiles(
        source, lambda section: (section[0], section[1] * width, section[2] * width)))


def merged_passes(seen: Sequence[AnySteps]) -> AnySteps:
    """One step where several passes or scanners saw the same one: the mean, weighted by support."""
    steps = type(seen[0]).join(seen)
    if len(seen) < 2 or not len(steps):
        return steps
    steps = steps[np.lexsort((steps.u, steps.profile))]
    separate = (np.diff(steps.profile) > 0) | (np.diff(steps.u) > CURBS.pass_merge_across) | (np.abs(np.diff(steps.h)) > CURBS.pass_merge_height)
    first, group = np.r_[True, separate], np.r_[0, np.cumsum(separate)]
    weight = np.sqrt(np.maximum(steps.support, 1))
    total = np.bincount(group, weight)

    def merged(name):
        values = getattr(steps, name)
        if name in ("support", "behind"):
            return np.bincount(group, values).astype(np.int64)
        return values[first] if name in ("profile", "sloped") else np.bincount(group, weight * values) / total

    return type(steps)(**{field.name: merged(field.name) for field in fields(steps)})


@dataclass(frozen=True)
class SideSteps:
    """What one method saw on one side of one road.

    steps : CurbSteps of the side, None where there are none
    width : m of road per profile
    limits : CurbLimits of what is taken for a curb
    bounds : (K,) m, stations at which blocks begin and end
    occlusion : OcclusionGrid of the side
    """

    steps: CurbSteps | None
    width: float
    limits: CurbLimits
    bounds: np.ndarray
    occlusion: OcclusionGrid

    def chains(self, look: RoadLook | None) -> list[StepChain]:
        """The chains of the steps, upright and sloped ones apart. `look` : RoadLook of the side, None where nothing is known of the ground."""
        steps = self.steps
        if steps is None or not len(steps):
            return []
        label, upright = np.empty(len(steps), np.int64), steps.upright
        label[upright] = link_steps(steps[upright], self.width)
        label[~upright] = link_steps(steps[~upright], self.width) + label[upright].max(initial=-1) + 1
        return [chain for chain in curb_chains(steps, label, self.width, self.limits)
                if look is None or _has_road_before(steps[chain.steps], chain.end - chain.start, look)]


def grids_beside(steps: Mapping[tuple[int, str], SideSteps]) -> dict[int, dict[str, OcclusionGrid]]:
    """What was seen beside each road: number of the road -> side -> OcclusionGrid."""
    beside: dict[int, dict[str, OcclusionGrid]] = {}
    for (road, side), seen in steps.items():
        beside.setdefault(road, {})[side] = seen.occlusion
    return beside


def curbs_along(source: Any, steps_by_method: Mapping[str, Mapping[tuple[int, str], SideSteps]],
                look_at: Callable[[int], RoadLook] | None = None) -> dict[str, CurbPoints]:
    """{method: CurbPoints} of each method alone and, as "both", those of the best path along the road through the chains of two.

    source : PointDecimation of a survey, or scanlines
    steps_by_method : method -> (number of the road, side) -> SideSteps; the method with the stricter model of a curb comes first
    look_at : gives the RoadLook of a road; None where nothing but the steps is known of the ground
    """
    roads = sorted({road for road, _ in next(iter(steps_by_method.values()))})
    methods = {method: [method] for method in steps_by_method}
    if len(methods) > 1:
        methods["both"] = list(methods)
    items = [(road, side, method, {name: steps_by_method[name][road, side] for name in names})
             for road in roads for side in SIDE_SIGNS for method, names in methods.items()]
    looks = {road: look_at(road) for road in roads} if look_at else {}
    phase = Phase(_curbs_of_side, source, (looks,), lambda item: f"the {item[1]} side of road {item[0]}")
    parts, crs = list(source.executor.run(phase, items)), getattr(source, "survey", source).crs
    return {method: CurbPoints.join([points for item, points in zip(items, parts) if item[2] == method and points is not None], crs)
            for method in methods}


def _curbs_of_side(source: Any, item: tuple[int, str, str, Mapping[str, SideSteps]], looks: dict[int, RoadLook]) -> CurbPoints | None:
    """The phase that follows the curb: CurbPoints of a method, or of "both", on one side of a road, as of `curbs_along`; None without any steps.

    item : number of the road, the side, the method, and what it or each of both saw there
    """
    road, side, method, methods = item
    beside = looks[road].side(SIDE_SIGNS[side]) if road in looks else None
    linked = [(seen, seen.chains(beside)) for seen in methods.values() if seen.steps is not None and len(seen.steps)]
    if not linked:
        return None
    # scanlines may have been told how high the scanner is
    return points_of_side(source if method == "scanlines" else getattr(source, "survey", source), road, side, linked,
                          methods["profiles" if "profiles" in methods else method].occlusion, beside)


def _points_of_line(steps, bounds, number):
    """Curb points of the steps of one line, by station: one of each part per block, between (K,) bounds.

    Returns a list of dict: s, u, h in m, and `fields`, what else is known of it, with the number of the line
    """
    if not len(steps):
        return []
    blocks, member = np.unique(_block_numbers(steps, bounds), return_inverse=True)
    n = np.bincount(member)
    names = {"s", "u", "height", *(name for _, *coordinates in steps.PARTS for name in coordinates)}
    mean = {name: np.bincount(member, getattr(steps, name)) / n for name in names}
    residual = np.sqrt(np.bincount(member, (steps.u - np.interp(steps.s, mean["s"], mean["u"])) ** 2) / n)
    support, hidden = np.bincount(member, steps.support), np.sqrt(np.bincount(member, steps.hidden**2) / n)
    return [dict(s=float(mean["s"][k]), u=float(mean[u][k]), h=float(mean[h][k]),
                 fields=dict(status="measured", height=round(float(mean["height"][k]), 4), chain=number, part=part,
                             residual=round(float(residual[k]), 4), support=int(support[k]), sigma=round(float(hidden[k]), 4) or np.nan))
            for k in range(len(blocks)) for part, u, h in steps.PARTS]


def _has_road_before(steps, length, look):
    """Does road lie before a line of steps? What goes on in one line for long enough is a curb whatever is before it."""
    before = np.array(CURBS.road_before_curb)[:, None]
    return length >= CURBS.min_faint_length or is_road(look.roughness(*(v.ravel() for v in np.broadcast_arrays(steps.s, steps.u - before))))


def points_of_side(source: Any, road: int, side: str, by_method: Sequence[tuple[SideSteps, list[StepChain]]], occlusion: OcclusionGrid,
                   look: RoadLook | None = None) -> CurbPoints:
    """Curb points of one side of one road, measured and hidden, in order of station.

    source : Survey, or scanlines: what has `frame` and `road_height`
    by_method : SideSteps of every method, and their chains
    look : RoadLook of the side, None where nothing is known of the ground
    """
    frame, sign, seen = source.frame, SIDE_SIGNS[side], [of_method.steps for of_method, _ in by_method if of_method.steps is not None]
    first = np.cumsum([0, *map(len, seen)])   # number of the first step of each method among all of them
    steps = CurbSteps(*(np.concatenate([getattr(part, field.name) for part in seen]) for field in fields(CurbSteps)))
    chains = [replace(chain, steps=chain.steps + begin, method=method)
              for method, ((_, of_method), begin) in enumerate(zip(by_method, first)) for chain in of_method]
    chains.sort(key=lambda chain: (chain.start, chain.end))
    track = OutermostTrack(frame, road, sign)
    selected = drop_short_curbs(select_along_road(chains, steps, track, look), chains, steps)
    lines = with_pieces_in_line(selected, chains, steps, lambda s, u: frame.road(road).to_map(s, sign * u), first[1:-1].tolist())
    rows = []
    for number, members in enumerate(lines):
        method = int(np.searchsorted(first, members[0], side="right")) - 1
        rows += _points_of_line(seen[method][members - first[method]], by_method[method][0].bounds, number)
    if look is not None:
        rows += lowered_points(rows, frame.road(road), look)
    bottoms = np.array([(row["s"], row["u"], row["h"]) for row in rows if row["fields"]["part"] == "bottom"]).reshape(-1, 3)
    rows += hidden_points(bottoms, occlusion, track)
    return points_of_rows(source, road, side, sorted(rows, key=lambda row: (row["s"], row["fields"]["part"])))


def block_bounds(road: Road, start: float, end: float, block_length: float) -> np.ndarray:
    """Stations at which blocks begin and end, counted from station 0.

    Automatic blocks are CURBS.min_block_length to CURBS.max_block_length long, so that the road turns no
    more than CURBS.max_block_turn within one; the length is decided for every 20 m of road.

    start, end : m, stations that the blocks cover
    block_length : m, 0 for automatic

    Returns (K,) m, ascending
    """
    if block_length:
        return np.arange(np.floor(start / block_length), np.ceil(end / block_length) + 1) * block_length
    section_length = CURBS.block_section_length
    first, last = int(np.floor(start / section_length)), int(np.ceil(end / section_length))
    bounds = []
    for k in range(first, last):
        bend = np.abs(road.curvature(np.arange(k * section_length, (k + 1) * section_length, 0.5))).max()
        length = np.clip(CURBS.max_block_turn / max(bend, 1e-9), CURBS.min_block_length, CURBS.max_block_length)
        bounds.append(np.linspace(k * section_length, (k + 1) * section_length, int(np.ceil(section_length / length)) + 1)[:-1])
    return np.r_[np.concatenate(bounds), last * section_length] if bounds else np.array([start, end])


def _block_numbers(steps: CurbSteps, bounds: np.ndarray) -> np.ndarray:
    """The block of each step of a chain.

    Blocks in which the curb bends are divided into four, and both ends of a chain are blocks of their own.

    steps : M CurbSteps of one chain, by station
    bounds : (K,) m, result of `block_bounds`

    Returns (M,) numbers, ascending along the road
    """
    block = np.searchsorted(bounds, steps.s, side="right")
    names, member = np.unique(block, return_inverse=True)
    n = np.bincount(member)
    ds = steps.s - (np.bincount(member, steps.s) / n)[member]
    du = steps.u - (np.bincount(member, steps.u) / n)[member]
    slope = np.bincount(member, ds * du) / (np.bincount(member, ds * ds) + 1e-3)
    off = np.sqrt(np.bincount(member, (du - slope[member] * ds) ** 2) / n)
    start, length = bounds[names - 1], np.diff(bounds)[np.minimum(names, len(bounds) - 1) - 1]
    quarter = np.clip(np.floor(4 * (steps.s - start[member]) / length[member]), 0, 3).astype(np.int64)
    block = 8 * block + 2 * np.where(off[member] > CURBS.max_block_bend, quarter, 0)  # even numbers leave odd ones for the ends
    # the ends of a chain keep their own place instead of the middle of their blocks
    if len(steps) > 2 * CURBS.chain_end_steps:
        block[:CURBS.chain_end_steps] = block[0] - 1
        block[-CURBS.chain_end_steps:] = block[-1] + 1
    return block
