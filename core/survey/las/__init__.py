"""LAS, LAZ and COPC files.

In: paths. Out: checked headers, blocks of points in file order, and files that are written whole or not at all.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "header": ("find_damage",),
    "near": ("points_near",),
    "parallel_reader": ("ParallelCloudReader",),
    "reader": ("CloudHeader", "cloud_crs", "crs_of_records", "open_cloud", "read_blocks", "read_header", "read_headers"),
})
