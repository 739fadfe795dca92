"""LAS, LAZ and COPC files.

In: paths. Out: checked headers, blocks of points in file order, and files that are written whole or not at all.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "CloudHeader": "reader",
    "ParallelCloudReader": "parallel_reader",
    "find_damage": "guard",
    "new_laz": "writer",
    "open_cloud": "reader",
    "read_blocks": "reader",
    "read_header": "reader",
    "read_headers": "reader",
    "scale_for": "writer",
})
