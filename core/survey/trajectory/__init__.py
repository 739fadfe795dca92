"""Where the vehicle was.

In: text tables, SBET files or columns of a layer. Out: a cleaned `Trajectory` in the time system of the point cloud.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "columns": ("columns_by_role",),
    "reader": ("read_trajectory", "trajectory_from_columns"),
    "time_systems": ("align_time", "unwrap_time"),
    "trajectory": ("Trajectory", "clean_trajectory", "reproject_trajectory"),
})
