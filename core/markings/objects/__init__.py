"""Paint gathered into markings.

In: paint points. Out: points without outliers, clusters, and markings as polygons with class, length and width.
"""
