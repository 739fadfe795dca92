"""Curves fitted to points: line, circle, ellipse, clothoid, polynomial, B-spline.

In: points along a line, x and y in metres. Out: a `CurveFit`, of one kind or of the simplest kind that describes
the points; a long line divided into the elements of an alignment; smooth profiles.
"""
