"""Curbs by the method of the driving-line thesis.

In: a `Survey`. Out: curb points found as steps on profiles across the road, and the principal points of these profiles.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "detect": ("detect_curbs", "find_principal_points"),
    "steps": ("find_averaged_steps", "find_steps"),
})
