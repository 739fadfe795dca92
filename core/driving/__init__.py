"""Where to drive.

In: `PaintedLines`, with `MarkingObjects`, `RoadEdges` and road points where there are any. Out: `DrivingLines`, one per lane, and
`CurveElements`.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "CurveElements": "driving_layers", "DrivingLines": "driving_layers", "DrivingSettings": "settings", "RoadEdges": "road_edges",
    "circular_curve_elements": "curve_elements", "curve_elements_to_features": "driving_layers", "design_check": "curve_elements",
    "driving_lines_to_features": "driving_layers", "edges_from_features": "road_edges", "make_driving_lines": "driving_lines",
})
