"""The trajectory from the cloud alone: where the scanner must have been to see what it saw at its times.

In: point cloud files. Out: an `EstimatedTrajectory`.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {"estimate": ("EstimatedTrajectory", "estimate_trajectory", "splitter_of")})
