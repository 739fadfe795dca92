"""The points that a trajectory is estimated from, and the first rough track along the ridge of their density.

In: point cloud files. Out: `Samples`, and a `FirstTrack` of every drive.
"""

from ....lazy import public

__getattr__, __all__ = public(__name__, {
})
