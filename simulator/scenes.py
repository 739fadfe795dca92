"""The scenes that can be surveyed, by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Union

from ..core.common.errors import RoadExtractionError
from .plan.crossing import crossing
from .plan.motorway import motorway
from .plan.roundabout import roundabout
from .plan.scene import PlanScene
from .plan.serpentine import serpentine
from .streets.cycle_lanes import cycle_lanes
from .streets.lane_scenes import beside_middle, hatched_island, no_centre_line, one_lane, one_sided_island, solid_centre_line, wide_lane
from .streets.ordinary import rural, street, urban
from .streets.outskirts import outskirts
from .streets.street import Scene

_SHORTEST = 20.0  # m of road


AnyScene = Union[Scene, PlanScene]


class _Kind(NamedTuple):
    """How a scene is built, and its length (m): usual, and at the most."""

    build: Callable[[float, int, float, float, float], AnyScene]
    usual: float
    longest: float


_STREET = 120.0, 20000.0
_SCENES = {
    "street": _Kind(street, *_STREET), "rural": _Kind(rural, *_STREET), "urban": _Kind(urban, *_STREET),
    "one-lane": _Kind(one_lane, *_STREET), "wide-lane": _Kind(wide_lane, *_STREET),
    "no-centre-line": _Kind(no_centre_line, *_STREET), "hatched-island": _Kind(hatched_island, *_STREET),
    "outskirts": _Kind(outskirts, *_STREET), "cycle-lanes": _Kind(cycle_lanes, *_STREET),
    # a plan is held as a whole, so its size is limited
    "motorway": _Kind(motorway, 240.0, 600.0), "serpentine": _Kind(serpentine, 200.0, 1000.0),
    "crossing": _Kind(crossing, 110.0, 300.0), "roundabout": _Kind(roundabout, 110.0, 300.0)}
SCENES = tuple(_SCENES)
# those that tests survey and nobody is offered: streets that can be read in two ways
_SCENES |= {"beside-middle": _Kind(beside_middle, *_STREET), "solid-centre-line": _Kind(solid_centre_line, *_STREET),
            "one-sided-island": _Kind(one_sided_island, *_STREET)}


def length_of(name: str, length: float) -> float:
    """The length of a scene, m: the usual one where `length` is 0.

    Raises RoadExtractionError if there is no such scene, or it cannot be that long or short.
    """
    if name not in _SCENES:
        raise RoadExtractionError(f"There is no sample scene {name!r}. Choose one of: {', '.join(SCENES)}.")
    kind = _SCENES[name]
    length = length or kind.usual
    if not _SHORTEST <= length <= kind.longest:
        raise RoadExtractionError(f"The sample scene {name} cannot be {length:g} m long. Choose from {_SHORTEST:g} to {kind.longest:g} m, "
                                  f"or 0 for the usual {kind.usual:g} m.")
    return length


def build_scene(name: str, length: float, seed: int, radius: float, curb_height: float, gutter: float) -> AnyScene:
    """The scene of a name in SCENES, of a length (m), with bends of a radius, curbs of a height and a concrete gutter of a width, m."""
    return _SCENES[name].build(length, seed, radius, curb_height, gutter)
