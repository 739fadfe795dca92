"""Where the road is.

In: a `Survey`. Out: curb points, road edges, road points and the outline of the surface.
"""
