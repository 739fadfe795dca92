"""Paint gathered into markings.

In: paint points without outliers. Out: the points with cluster numbers, and `MarkingObjects` with class, length and width.
"""
