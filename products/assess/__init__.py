"""The accuracy of a result.

In: a result and a reference. Out: precision, recall, deviations and miscoding by the published protocols, and layers with
the outcome of every object.
"""

from __future__ import annotations

from ...core.lazy import public

__getattr__, __all__ = public(__name__, {
    "layers": ("AssessedLayer", "boundary_layer", "driving_line_layer", "marking_layer", "polygons_of_raster"),
    "lines": (
        "BoundaryAccuracy", "BoundaryAccuracySettings", "LineAccuracy", "LineAccuracySettings", "LineMatch", "assess_boundaries",
        "compare_lines", "match_lines"),
    "markings": ("MarkingAccuracy", "MarkingAccuracySettings", "OutcomeRaster", "assess_markings"),
    "matching": ("Rates", "f1_of"),
})
