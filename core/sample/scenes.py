"""The scenes that can be surveyed, by name."""

from __future__ import annotations

from .lane_scenes import hatched_island, no_centre_line, one_lane, wide_lane
from .street import Scene
from .street_scenes import rural, street, urban

_SCENES = {"street": street, "rural": rural, "urban": urban, "one-lane": one_lane, "wide-lane": wide_lane,
           "no-centre-line": no_centre_line, "hatched-island": hatched_island}
SCENES = tuple(_SCENES)


def build_scene(name: str, length: float, seed: int, radius: float, curb_height: float, gutter: float) -> Scene:
    """Build a scene.

    Parameters
    ----------
    name : one of SCENES
    length : m of road
    seed : of all random numbers
    radius : m, of the bends
    curb_height : m
    gutter : m, width of a concrete gutter along the curbs

    Returns
    -------
    Scene
    """
    return _SCENES[name](length, seed, radius, curb_height, gutter)
