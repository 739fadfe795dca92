"""Reports: one HTML page per run, complete in itself, with numbers, charts and maps.

In: the result of an algorithm. Out: the text of an HTML file.
"""

from __future__ import annotations

from ...core.lazy import public

__getattr__, __all__ = public(__name__, {
    "assessment": ("boundary_report", "driving_report", "marking_report"),
    "hd_map": ("map_check_report", "map_export_report"),
    "inventory": ("cross_section_report", "roadside_report"),
    "overlay": ("georeferencing_report", "proposed_points_report"),
    "page": ("html_page",),
    "road_map": ("road_map_report",),
    "survey": ("estimated_trajectory_report", "inspection_report"),
})
