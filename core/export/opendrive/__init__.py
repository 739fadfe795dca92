"""OpenDRIVE: roads along a reference line, lanes as widths beside it.

In: a file `.xodr` or `Lanes`. Out: an `OpenDriveMap`, and from it layers or a file.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "exporter": ("OpenDriveDraft", "OpenDriveSettings", "draft_opendrive"),
    "geometry": ("PlanView", "PlanElement", "Cubics"),
    "layers": ("layers_of_opendrive",),
    "model": ("Connection", "Junction", "MapLane", "MapRoad", "LaneSection", "OpenDriveMap", "RoadLink", "RoadMark"),
    "reader": ("read_opendrive",),
    "reference_line": ("fit_reference", "polynomial_reference"),
    "surface": ("RoadSurface",),
    "writer": ("opendrive_text",),
})
