"""Whether a survey fits itself: the trajectory its own shape and its scanners, scanners each other.

In: a Trajectory on the clock of the clouds, or a `Survey`. Out: the same, mended where that is safe; warnings; and what stays uncertain.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
})
