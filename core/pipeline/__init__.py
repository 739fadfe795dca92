"""The whole chain in one call.

In: point cloud files and a trajectory. Out: a `RoadMap` with every layer.
"""
