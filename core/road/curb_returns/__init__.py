"""Curbs that do not run along the road: around corners, into side streets, about islands.

In: a `Survey` and its main curbs. Out: further curb points with their kind.
"""
