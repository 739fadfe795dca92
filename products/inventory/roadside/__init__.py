"""What stands beside the road: lines of rails, barriers, walls, fences and hedges, gutters, and single poles, signs and trunks.

In: an open `Survey` and the layers that say where the carriageway ends. Out: `Roadside`, and its layers.
"""

from ....core.lazy import public

__getattr__, __all__ = public(__name__, {"find": ("Roadside", "find_roadside", "roadside_to_features")})
