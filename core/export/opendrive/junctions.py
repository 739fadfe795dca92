"""Links between the roads of an export: lanes of sections, ends of roads, junctions with their connections."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import NamedTuple

from .model import Connection, Junction, MapRoad, OpenDriveMap, RoadLink, travel
from .strips import Slice


@dataclass
class DraftRoad:
    """A road with the cells that its lanes come from.

    road; strip : slices; numbers : lane of every cell of every slice; single : whether it is a way through a junction
    """

    road: MapRoad
    strip: list[Slice]
    numbers: list[list[int]]
    single: bool


class _Place(NamedTuple):
    """Where a cell is: road, section, lane."""

    draft: int
    section: int
    lane: int


class _Touch(NamedTuple):
    """A lane at a road's end and the lane that it touches at an end of another road."""

    lane: int
    other: int
    other_end: str
    other_lane: int


def link_roads(whole: OpenDriveMap, drafts: list[DraftRoad]) -> list[str]:
    """Fill in the links of lanes and roads, and the junctions.

    Returns
    -------
    list of sentences on what OpenDRIVE cannot say
    """
    place = {id(cell): _Place(k, j, number) for k, draft in enumerate(drafts) for j, (one, ids) in enumerate(zip(draft.strip, draft.numbers))
             for cell, number in zip(one.cells, ids)}
    touches: dict[tuple[int, str], list[_Touch]] = defaultdict(list)
    for draft in drafts:
        for one in draft.strip:
            for cell in one.cells:
                here = place[id(cell)]
                for end, others in (("end", cell.after), ("start", cell.before)):
                    for other in others:
                        there = place.get(id(other))
                        if there is not None:
                            _link(drafts, touches, here, end, there, "start" if any(cell is back for back in other.before) else "end")
    junction = _clusters(drafts, touches)
    notes = []
    for k, end in touches:
        notes += _end_link(drafts, k, end, touches, junction)
    _connections(whole, drafts, touches, junction)
    return sorted(set(notes))


def _link(drafts, touches, here, end, there, other_end):
    """One touch: of lanes of neighbouring sections at once, of ends of roads for later."""
    sections = drafts[here.draft].road.sections
    beyond = here.section + (1 if end == "end" else -1)
    if here.draft == there.draft and there.section == beyond:
        lane = sections[here.section].lanes[here.lane]
        known = lane.successors if end == "end" else lane.predecessors
        if there.lane not in known:
            known.append(there.lane)
    elif not 0 <= beyond < len(sections):
        touch = _Touch(here.lane, there.draft, other_end, there.lane)
        if touch not in touches[here.draft, end]:
            touches[here.draft, end].append(touch)


def _clusters(drafts, touches):
    """Number of the junction of every way through one: those at one road's end, or end to end, are of one junction."""
    parent = {k: k for k, draft in enumerate(drafts) if draft.single}

    def root(k):
        while parent[k] != k:
            k = parent[k]
        return k

    for (k, _), found in touches.items():
        together = [touch.other for touch in found if touch.other in parent] + ([k] if k in parent else [])
        for other in together[1:]:
            parent[root(other)] = root(together[0])
    roots = sorted({root(k) for k in parent})
    return {k: roots.index(root(k)) for k in parent}


def _end_link(drafts, k, end, touches, junction):
    """Link one end of a road; sentences on what cannot be linked."""
    found = touches[k, end]
    road = drafts[k].road
    name = "successor" if end == "end" else "predecessor"
    if k not in junction and any(touch.other in junction for touch in found):
        setattr(road, name, RoadLink("junction", junction_id(drafts, junction[next(t.other for t in found if t.other in junction)])))
        return []
    # a junction lies between this road and those whose ends are linked to it
    found = [touch for touch in found if k in junction or not any(one.other in junction for one in touches.get((touch.other, touch.other_end), ()))]
    if not found:
        return []
    # of several roads the one with the most lanes is kept: OpenDRIVE has one link an end
    ends = sorted({(touch.other, touch.other_end) for touch in found}, key=lambda way: (-sum(touch[1:3] == way for touch in found), way))
    other, other_end = ends[0]
    setattr(road, name, RoadLink("road", drafts[other].road.id, other_end))
    section = road.sections[-1 if end == "end" else 0]
    for touch in found:
        if (touch.other, touch.other_end) == ends[0]:
            lane = section.lanes[touch.lane]
            (lane.successors if end == "end" else lane.predecessors).append(touch.other_lane)
    if len(ends) > 1:
        return [f"Road {road.id} touches {len(ends)} roads at its {end} without a connector; it is linked to road {drafts[other].road.id} alone."]
    return []


def junction_id(drafts: list[DraftRoad], number: int) -> str:
    """The id of a junction: beyond those of the roads, as both share one space in some readers."""
    return str(len(drafts) + 1 + number)


def _connections(whole, drafts, touches, junction):
    found = {number: Junction(junction_id(drafts, number)) for number in sorted(set(junction.values()))}
    for k, number in junction.items():
        drafts[k].road.junction = found[number].id
    for (k, end), touched in sorted(touches.items()):
        road = drafts[k].road
        if k in junction:
            continue
        lanes = defaultdict(list)
        for touch in touched:
            # only what drives out of the road at this end is incoming traffic of the junction
            if touch.other in junction and (travel(road, touch.lane) > 0) == (end == "end"):
                lanes[touch.other, touch.other_end].append((touch.lane, touch.other_lane))
        for (other, other_end), links in sorted(lanes.items()):
            connections = found[junction[other]].connections
            connections.append(Connection(str(len(connections)), road.id, drafts[other].road.id, other_end, links))
    whole.junctions = [one for one in found.values() if one.connections]
    known = {one.id for one in whole.junctions}
    for draft in drafts:
        for name in ("predecessor", "successor"):
            link = getattr(draft.road, name)
            if link is not None and link.element == "junction" and link.id not in known:
                setattr(draft.road, name, None)
        if draft.road.junction not in known:
            draft.road.junction = "-1"
