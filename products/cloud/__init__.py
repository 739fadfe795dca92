"""The survey's own points, given back with classes and with the fields of the road.

In: an open `Survey` and the layers of its road map. Out: copies of its files in which every point says what it belongs to, and where on the road.
"""
