"""Reports: one HTML page per run, complete in itself, with numbers, charts and maps.

In: the result of an algorithm. Out: the text of an HTML file.
"""

from __future__ import annotations

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "assessment": ("boundary_report", "driving_report", "marking_report"),
    "estimated_trajectory": ("estimated_trajectory_report",),
    "georeferencing": ("georeferencing_report",),
    "inspection": ("inspection_report",),
    "intensity": ("intensity_correction_report",),
    "map_check": ("map_check_report",),
    "map_export": ("map_export_report",),
    "page": ("Page",),
    "road_map": ("road_map_report",),
})
