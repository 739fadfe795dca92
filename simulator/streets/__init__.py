"""Simulated streets that follow one axis.

In: length, seed, radius, curb height and gutter. Out: a `Scene` for the scanners, with its truth.
"""

from ...core.lazy import public

__getattr__, __all__ = public(__name__, {
    "builder": ("SceneBuilder",),
    "street": ("Scene",),
})
