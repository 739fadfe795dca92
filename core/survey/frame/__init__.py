"""The road frame: passes, roads and their reference lines.

In: a `Trajectory`. Out: a `RoadFrame` that gives the station and offset of any position, and map coordinates of any station and offset;
`FrameLines` are lines in it.
"""
