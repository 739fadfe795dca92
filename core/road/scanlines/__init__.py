"""Curbs and road boundaries from normalized scanlines.

In: a `Survey` or a layer of scanlines. Out: normalized scanlines, corners of curbs where planes intersect, and boundary lines.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "LayerScanlines": "source",
    "ResampledPoints": "resampling",
    "ResamplingSettings": "resampling",
    "ScanlineBoundarySettings": "detect",
    "ScanlineLayerSettings": "layer",
    "ScanlineSettings": "section_planes",
    "Scanlines": "scanlines",
    "SurveyScanlines": "source",
    "all_scanlines": "section_planes",
    "boundary_lines": "detect",
    "curbs_from_scanlines": "detect",
    "scanlines_from_features": "layer",
    "scanlines_of": "section_planes",
    "write_scanlines": "layer",
})
