"""Where the road is.

In: a `Survey`. Out: curb points, road edges, road points and the outline of the surface.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "detect_boundaries": ("BoundarySettings", "RoadBoundaries", "draw_boundaries", "find_curb_points"),
})
