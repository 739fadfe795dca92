"""Curbs that do not run along the road: around corners, into side streets, about islands.

In: a `Survey` and its main curbs. Out: further curb points with their kind.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {"classify": ("CurbReturn",), "detect": ("find_curb_returns", "with_curb_returns")})
