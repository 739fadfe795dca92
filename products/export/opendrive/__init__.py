"""OpenDRIVE: roads along a reference line, lanes as widths beside it.

In: a file `.xodr` or `Lanes`. Out: an `OpenDriveMap`, and from it layers or a file.
"""

from ....core.lazy import public

__getattr__, __all__ = public(__name__, {
    "exporter": ("OpenDriveDraft", "OpenDriveSettings", "draft_opendrive"),
    "geometry": ("Cubics", "PlanElement", "PlanView"),
    "model": ("Connection", "Junction", "LaneSection", "MapLane", "MapRoad", "OpenDriveMap", "RoadLink", "RoadMark", "RoadSurface"),
    "reference_line": ("fit_reference", "polynomial_reference"),
    "xodr": ("layers_of_opendrive", "opendrive_text", "read_opendrive"),
})
