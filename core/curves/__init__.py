"""Curves fitted to points: line, circle, ellipse, clothoid, polynomial, B-spline."""
