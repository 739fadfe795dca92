"""LAS, LAZ and COPC files.

In: paths. Out: checked headers, blocks of points in file order, and files that are written whole or not at all.
"""
