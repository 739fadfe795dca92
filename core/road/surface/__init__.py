"""The road surface.

In: a `Survey` and road edges. Out: the points of the road and the outline of its surface.
"""
