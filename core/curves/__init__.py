"""Curves fitted to points: line, circle, ellipse, clothoid, polynomial, B-spline.

In: points with weights. Out: a `Fit`, and the simplest curve that the points allow.
"""
