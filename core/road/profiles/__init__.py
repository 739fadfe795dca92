"""Curbs by the method of the driving-line thesis.

In: a `Survey`. Out: curb points found as steps on profiles across the road, and the principal points of these profiles.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "CurbSettings": "detect",
    "detect_curbs": "detect",
    "find_averaged_steps": "averaged_steps",
    "find_steps": "steps",
    "find_principal_points": "principal_points",
})
