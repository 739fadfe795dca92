"""Reports: one HTML page per run, complete in itself, with numbers, charts and maps.

In: the result of an algorithm. Out: the text of an HTML file.
"""

from __future__ import annotations

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "Page": "page", "boundary_report": "assessment", "driving_report": "assessment", "georeferencing_report": "georeferencing",
    "inspection_report": "inspection", "intensity_correction_report": "intensity", "marking_report": "assessment", "road_map_report": "road_map",
})
