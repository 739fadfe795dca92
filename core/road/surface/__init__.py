"""The road surface.

In: a `Survey` and, optionally, road edges. Out: the points of the road and the outline of its surface.
"""
