"""Curbs and road boundaries from normalized scanlines.

In: a `Survey` or a layer of scanlines. Out: normalized scanlines, corners of curbs where planes intersect, and boundary lines.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "detect": ("LayerScanlines", "ScanlineBoundarySettings", "SurveyScanlines", "boundary_lines", "curbs_from_scanlines"),
    "grid": ("Scanlines",),
    "section_planes": ("ScanlineSettings", "all_scanlines", "scanlines_of"),
})
