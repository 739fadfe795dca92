"""Marking lines.

In: clustered paint points and `MarkingObjects`. Out: `PaintedLines`, edge, lane and centre lines as fitted curves in pieces, with
dashes linked and gaps marked as bridged.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "fit": ("MarkingLineSettings", "fit_marking_lines", "named_by_lines"),
    "painted_lines": ("PaintedLines",),
})
