"""The road surface.

In: a `Survey` and, optionally, road edges. Out: the points of the road and the outline of its surface.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "extract": ("SurfaceSettings", "extract_road_surface"),
    "pavement_edge": ("edge_offsets",),
    "road_surface": ("SurfaceOutlines",),
})
