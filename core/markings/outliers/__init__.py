"""Lone points among the paint points: found and removed.

In: paint points. Out: the same points without those that lie far from their neighbours.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "": ("OutlierSettings", "remove_outliers"),
})
