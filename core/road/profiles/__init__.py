"""Curbs by the method of the driving-line thesis.

In: a `Survey`. Out: curb points found as steps on profiles across the road, and the principal points of these profiles.
"""
