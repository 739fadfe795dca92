"""The scan lattice: which scan line, and which place in it, every point has.

In: time and place of points. Out: rotation rate, mirror phase, and line and column of each point.
"""
