"""The road frame: passes, roads and their reference lines.

In: a `Trajectory`. Out: a `RoadFrame` that gives the station and offset of any position, and map coordinates of any station and offset.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "passes": ("Pass",),
    "road_frame": ("Road", "RoadFrame", "build_frame"),
})
