"""Curves fitted to points: line, circle, ellipse, clothoid, polynomial, B-spline.

In: points along a line, x and y in metres. Out: a `CurveFit`, of one kind or of the simplest kind that describes
the points; a long line divided into the elements of an alignment; smooth profiles.
"""

from __future__ import annotations

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "Arc": "base", "Clothoid": "clothoid", "Curve": "base", "CurveFit": "curve_fit", "Ellipse": "ellipse", "Polynomial": "polynomial",
    "Spline": "bspline",
    "curve_from_params": "model_selection", "element_ranges": "segmentation", "fit_circle": "line_circle", "fit_circles": "line_circle",
    "fit_clothoid": "clothoid", "fit_clothoids": "clothoid", "fit_curve": "model_selection", "fit_curves": "model_selection",
    "fit_ellipse": "ellipse", "fit_line": "line_circle", "fit_lines": "line_circle", "fit_polynomial": "polynomial",
    "fit_spline": "bspline", "fit_splines": "bspline", "segment_line": "segmentation", "select_each": "model_selection", "smooth_profiles": "bspline",
})
