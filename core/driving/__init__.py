"""Where to drive.

In: `PaintedLines`, with `MarkingObjects`, `RoadEdges` and road points where there are any. Out: `DrivingLines`, one per lane, and
`CurveElements`; the areas of the lanes as `Lanes`.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "alignment": ("circular_curve_elements", "design_check"),
    "driving_lines": ("make_driving_lines",),
    "layers": (
        "CurveElements", "DrivingLines", "LANE_TYPES", "Lanes"),
    "settings": ("DrivingSettings",),
})
