"""Paint gathered into markings.

In: paint points without outliers. Out: the points with cluster numbers, and `MarkingObjects` with class, length and width.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "classify": ("ClassSettings", "classify_markings"),
    "cluster": ("ClusterSettings", "cluster_markings"),
    "marking_objects": ("MarkingObjects", "Outlines", "with_kinds_of"),
})
