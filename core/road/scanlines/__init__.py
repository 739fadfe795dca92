"""Curbs by the method of the scanline paper.

In: a `Survey` or a layer of scanlines. Out: normalized scanlines, curb corners where planes meet, and boundary lines.
"""
