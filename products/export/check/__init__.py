"""What is wrong with an HD map, beyond what validators of its format see.

In: an `OpenDriveMap` or `LaneletMap`. Out: `Findings`, each with a place on the map.
"""

from ....core.lazy import public

__getattr__, __all__ = public(__name__, {
    "findings": ("FAULTS", "Finding", "Findings"),
    "lanelets": ("check_lanelets",),
    "roads": ("check_opendrive",),
})
