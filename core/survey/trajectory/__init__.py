"""Where the vehicle was.

In: text tables, SBET files or columns of a layer. Out: a cleaned `Trajectory` in the time system of the point cloud.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "Trajectory": "trajectory",
    "align_time": "time_systems",
    "clean_trajectory": "trajectory",
    "columns_by_role": "columns",
    "read_trajectory": "reader",
    "reproject_trajectory": "reprojection",
    "trajectory_from_columns": "reader",
    "unwrap_time": "time_systems",
})
