"""Marking lines.

In: clustered paint points and `MarkingObjects`. Out: `PaintedLines`, edge, lane and centre lines as fitted curves in pieces, with
dashes linked and gaps marked as bridged.
"""
