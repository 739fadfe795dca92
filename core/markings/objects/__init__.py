"""Paint gathered into markings.

In: paint points. Out: points without outliers and with cluster numbers, and `MarkingObjects` with class, length and width.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "ClassSettings": "classify", "ClusterSettings": "cluster", "MarkingObjects": "marking_objects", "OutlierSettings": "outliers",
    "Outlines": "marking_objects", "classify_markings": "classify", "cluster_markings": "cluster", "markings_from_features": "marking_objects",
    "markings_to_features": "marking_objects", "remove_outliers": "outliers", "with_kinds_of": "marking_objects",
})
