"""The whole chain in one call.

In: point cloud files and a trajectory. Out: a `RoadMap` with every layer.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {"road_map": ("RoadMap", "RoadMapSettings", "make_road_map")})
