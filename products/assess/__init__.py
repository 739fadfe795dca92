"""The accuracy of a result.

In: a result and a reference. Out: precision, recall, deviations and miscoding by the published protocols, and layers with
the outcome of every object.
"""

from __future__ import annotations

from ...core.lazy import public

__getattr__, __all__ = public(__name__, {
    "boundaries": ("BoundaryAccuracy", "BoundaryAccuracySettings", "assess_boundaries"),
    "driving_lines": ("LineAccuracy", "LineAccuracySettings", "LineMatch", "compare_lines", "match_lines"),
    "inputs": ("AssessedLayer", "polygons_of_raster"),
    "layers": ("boundary_layer", "driving_line_layer", "marking_layer"),
    "markings": ("MarkingAccuracy", "MarkingAccuracySettings", "OutcomeRaster", "assess_markings"),
    "metrics": ("Rates", "f1_of"),
})
