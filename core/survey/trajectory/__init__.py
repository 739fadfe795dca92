"""Where the vehicle was.

In: text tables, SBET files or columns of a layer. Out: a cleaned `Trajectory` in the time system of the point cloud.
"""
