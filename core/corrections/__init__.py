"""What an analyst corrected in a road map.

In: the layer CORRECTIONS, and what a run found: road edges, marking objects and lines, driving lines and lanes. Out: the same, corrected.
A correction is matched by its place in the road frame of the run, never by the number of a feature, so that it holds when the run changes.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "apply": ("correct_edges", "correct_marking_lines", "correct_markings"),
    "corrections": ("ACTIONS", "Correction", "Corrections", "TARGETS", "corrections_from_features", "taken_reading"),
    "lanes": ("correct_lanes",),
})
