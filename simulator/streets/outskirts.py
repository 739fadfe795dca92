"""The edge of a town: what runs along a road beside it, from guard rails to hedges."""

from __future__ import annotations

from ..parts.sides import ditch, sidewalk
from .builder import MODULE, SceneBuilder
from .street import Scene

_EDGE = 3.75  # m from the axis to the edges of the carriageway
_LINE = 3.45  # m, edge lines
_SIDEWALK = 2.0  # m, curb and sidewalk
_GARDENS = 6.0  # m from the axis to the fronts of the gardens
_RAIL = 4.45  # m from the axis to what keeps vehicles on the road
_PASTURE = 9.4  # m from the axis to the fence beyond the ditch


def outskirts(length: float, seed: int, radius: float, curb_height: float, gutter: float) -> Scene:
    """Two lanes; gardens behind a sidewalk on the left, guard rail, concrete barrier and a pasture's fence on the right; driven both ways."""
    road = SceneBuilder(length, seed, radius)
    lowered = []
    road.line("edge line", 1, _LINE, 0.0, length, width=0.12)
    road.line("centre line", 2, 0.0, 0.0, length, width=0.12, dash=(4.0, 8.0))
    road.line("edge line", 3, -_LINE, 0.0, length, width=0.12)
    for base in road.modules():
        lowered.append((base + 31.0, base + 35.0))
        road.running_along("wall", base + 3.0, base + 31.0, _GARDENS)
        road.running_along("wall", base + 35.0, base + 53.0, _GARDENS, 1.0)
        road.running_along("fence", base + 55.0, base + 83.0, _GARDENS)
        road.running_along("building", base + 60.0, base + 74.0, _GARDENS + 3.5)
        road.running_along("hedge", base + 86.0, base + 116.0, _GARDENS)
        road.running_along("guard_rail", base + 4.0, base + 56.0, -_RAIL)
        road.running_along("barrier", base + 62.0, base + 98.0, -_RAIL)
        road.running_along("fence", base + 20.0, base + 110.0, -_PASTURE)
        road.trees(base + 8.0, base + MODULE - 8.0, -_PASTURE - 3.0, 19.0, crown=(1.9, 2.9))
        road.poles(base + 10.0, base + MODULE, _EDGE + 0.5, 35.0)
        road.poles(base + 100.0, base + MODULE, -_RAIL, 50.0, height=1.0)
        road.repair(base + 40.0, base + 49.0, -2.6, -0.8, 1.35)
    road.lane(1, -1, (0.0, _LINE / 2, _LINE), (length, _LINE / 2, _LINE))
    road.lane(2, 1, (0.0, -_LINE / 2, _LINE), (length, -_LINE / 2, _LINE))
    return road.scene(
        "outskirts", sidewalk(1, _EDGE, curb_height, lowered, _SIDEWALK), ditch(-1, _EDGE), [(1, -_LINE / 2, 1.0), (-1, _LINE / 2, 1.1)], gutter
    )
