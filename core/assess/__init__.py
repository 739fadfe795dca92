"""The accuracy of a result.

In: a result and a reference. Out: precision, recall, deviations and miscoding by the published protocols, and layers with
the outcome of every object.
"""

from __future__ import annotations

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "AssessedLayer": "inputs", "BoundaryAccuracy": "boundaries", "BoundaryAccuracySettings": "boundaries", "LineAccuracy": "driving_lines",
    "LineAccuracySettings": "driving_lines", "LineMatch": "driving_lines", "MarkingAccuracy": "markings", "MarkingAccuracySettings": "markings",
    "OutcomeRaster": "burn", "Rates": "metrics", "assess_boundaries": "boundaries", "assess_markings": "markings", "boundary_layer": "layers",
    "compare_lines": "driving_lines", "curvature_along": "curvature", "driving_line_layer": "layers", "f1_of": "metrics",
    "marking_curvature": "curvature", "marking_layer": "layers", "match_lines": "driving_lines", "polygons_of_raster": "raster_polygons",
})
