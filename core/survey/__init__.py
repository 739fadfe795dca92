"""What was measured.

In: point cloud files and a trajectory. Out: a `Survey`, whose points lie in the road frame, in a bounded section store.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "road_points_las": ("read_road_points", "write_road_points"),
    "survey": ("Survey", "SurveySettings"),
})
