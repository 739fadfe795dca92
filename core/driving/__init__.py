"""Where to drive.

In: `PaintedLines`, with `MarkingObjects`, `RoadEdges` and road points where there are any. Out: `DrivingLines`, one per lane, and
`CurveElements`; the areas of the lanes as `Lanes`.
"""
