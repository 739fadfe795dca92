"""Cells of 4 cm in which paint is looked at, and which painted cells and points belong together, also where they are of several roads.

In: points of paint by road. Out: their clusters.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
})
