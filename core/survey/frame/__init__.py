"""The road frame: passes, roads and their reference lines.

In: a `Trajectory`. Out: a `RoadFrame` that gives the station and offset of any position, and map coordinates of any station and offset;
`FrameLines` are lines in it.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "passes": ("Pass",),
    "placement": ("FrameLines", "line_parts", "lines_in_frame", "located"),
    "road": ("Road",),
    "road_frame": ("RoadFrame", "build_frame"),
    "row_table": ("RowSpans", "RowTable"),
})
