"""The scan lattice: the scan line of every point, and its place on the line.

In: time and place of points. Out: rotation rate, mirror phase, and line and phase of each point.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {"scan_lattice": ("MirrorPhase", "ScanLattice", "find_lattice", "scanner_runs", "time_order")})
