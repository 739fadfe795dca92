"""The ground in plan, about places where curbs may have any direction.

In: points of a stretch of road. Out: a raster of the ground, and the places and directions in which it rises beside driven ground.
"""

from ....lazy import public

__getattr__, __all__ = public(__name__, {
})
