"""OpenDRIVE: roads along a reference line, lanes as widths beside it.

In: a file `.xodr` or `Lanes`. Out: an `OpenDriveMap`, and from it layers or a file.
"""
