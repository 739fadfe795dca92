"""Marking lines.

In: clustered paint points and `MarkingObjects`. Out: `PaintedLines`, edge, lane and centre lines as fitted curves in pieces, with
dashes linked and gaps marked as bridged.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "FrameLines": "frame_lines", "MarkingLineSettings": "fit", "PaintedLines": "painted_lines", "fit_marking_lines": "fit",
    "lines_from_features": "painted_lines", "lines_in_frame": "frame_lines", "lines_to_features": "painted_lines",
    "named_by_lines": "naming",
})
