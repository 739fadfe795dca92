"""What was measured.

In: point cloud files and a trajectory. Out: a `Survey`, whose points lie in the road frame, in a bounded section store.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "Survey": "open_survey",
    "SurveySettings": "open_survey",
    "inspect_survey": "inspection",
    "read_road_points": "road_points_las",
    "write_road_points": "road_points_las",
})
