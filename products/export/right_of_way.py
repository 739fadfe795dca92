"""Who waits for whom at the junctions of a map: as the lanes state it, else as the signs before them say."""

from __future__ import annotations

from collections import defaultdict
from typing import NamedTuple

import numpy as np
import shapely

from .shared_borders import WIDEST_DOUBLE
from .sources import RoadMapSource, areas_of

GIVE_WAY = {("DE", "205"), ("DE", "206"), ("US", "R1-1"), ("US", "R1-2"), ("CH", "3.01"), ("CH", "3.02"), ("FR", "AB3a"), ("FR", "AB4"),
            ("GB", "601.1"), ("GB", "602")}   # (country, code) of signs at which one stops or gives way


class _RightOfWay(NamedTuple):
    """waiting, first : lane_ids; signs : rows of the layer SIGNALS that say so; before : where they wait; conflicts : (row of a way through the
    junction that waits, row of one that goes first) of ways that cross."""

    waiting: list[str]
    first: list[str]
    signs: list[int]
    before: shapely.Geometry
    conflicts: list[tuple[int, int]]


def named(text: object) -> list[str]:
    """The lane_ids in a field that holds several."""
    return [name for part in str(text or "").split(",") if (name := part.strip())]


def rights_of_way(source: RoadMapSource) -> list[_RightOfWay]:
    """One for each group of lanes that wait for the same ones; of lanes that state nothing, one for each sign at which they give way.

    Before a sign go the lanes whose ways through the junction cross theirs and that have no such sign.
    """
    lanes = source.lanes
    rows, crosses = {name: k for k, name in enumerate(lanes.lane_id)}, lanes.type == "connector"
    ways = {name: {k} if crosses[k] else {rows[after] for after in lanes.successors[k] if after in rows and crosses[rows[after]]}
            for name, k in rows.items()}
    across = np.flatnonzero(crosses)
    areas = areas_of(lanes, across)
    # by more than the stripe that neighbours have between them
    cross = across[shapely.STRtree(areas).query(shapely.buffer(areas, -WIDEST_DOUBLE), predicate="intersects")]
    crossing = set(zip(*cross.tolist()))

    def ways_of(names):
        return set().union(*(ways[name] for name in names))

    def conflicts(names, first):
        # of two lanes that lead to several ways, those that cross
        return [(k, j) for name in names for other in first for k in sorted(ways[name]) for j in sorted(ways[other])
                if crosses[rows[name]] and crosses[rows[other]] or (k, j) in crossing]

    stated: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for name, known in source.attributes.items():
        if name in rows and (first := tuple(other for other in named(known.get("yields_to")) if other in rows and other != name)):
            stated[first].append(name)
    signs = {number: [name for name in named(row.get("lanes")) if ways.get(name)]
             for number, row in enumerate(source.signals.rows if source.signals else ())
             if row.get("kind") == "sign" and (row.get("country"), row.get("code")) in GIVE_WAY}
    rights = [(names, first, [number for number, at in signs.items() if ways_of(names) & ways_of(at)]) for first, names in stated.items()]
    known_ways, at_signs = ways_of(name for names in stated.values() for name in names), {name for names in signs.values() for name in names}
    others = sorted(name for name, k in rows.items() if not crosses[k] and name not in at_signs)
    for number, names in signs.items():
        if names := [name for name in names if not ways[name] & known_ways]:
            rights.append((names, tuple(other for other in others if conflicts(names, [other])), [number]))
    led = [{name, *after} for name, after in zip(lanes.lane_id, lanes.successors)]
    return [_RightOfWay(list(names), list(first), number, shapely.union_all(areas_of(lanes, [k for k in rows.values() if led[k] & {*names}])),
                        conflicts(names, first)) for names, first, number in rights if first]
