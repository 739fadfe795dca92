"""Road edges.

In: curb points. Out: smooth lines, cut into pieces by what was measured and what was bridged.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "fit": ("EdgeSettings", "fit_road_edges"),
    "road_edges": ("EdgePiece", "RoadEdges", "joined_pieces"),
})
