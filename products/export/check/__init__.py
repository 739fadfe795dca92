"""What is wrong with an HD map, beyond what validators of its format see.

In: an `OpenDriveMap` or `LaneletMap`. Out: `Findings`, each with a place on the map.
"""
