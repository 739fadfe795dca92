"""Curbs and road boundaries from normalized scanlines.

In: a `Survey` or a layer of scanlines. Out: normalized scanlines, corners of curbs where planes intersect, and boundary lines.
"""
