"""The road frame: passes, roads and their reference lines.

In: a `Trajectory`. Out: a `RoadFrame` that gives station and offset of any place, and the map coordinates of any station and offset.
"""
