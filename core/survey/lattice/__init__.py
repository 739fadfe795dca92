"""The scan lattice: the scan line of every point, and its place on the line.

In: time and place of points. Out: rotation rate, mirror phase, and line and phase of each point.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "MirrorPhase": "mirror_phase",
    "ScanLattice": "scan_lattice",
    "find_lattice": "scan_lattice",
    "scanner_runs": "scan_lattice",
    "time_order": "scan_lattice",
})
