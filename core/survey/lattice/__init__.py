"""The scan lattice: the scan line of every point, and its place on the line.

In: time and place of points. Out: rotation rate, mirror phase, and line and phase of each point.
"""
