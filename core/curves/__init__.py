"""Curves fitted to points: line, circle, ellipse, clothoid, polynomial, B-spline.

In: points along a line, x and y in metres. Out: a `CurveFit`, of one kind or of the simplest kind that describes
the points; a long line divided into the elements of an alignment; smooth profiles.
"""

from __future__ import annotations

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "base": ("Arc", "Curve", "CurveFit"),
    "bspline": ("Spline", "fit_spline", "fit_splines", "smooth_profiles"),
    "clothoid": ("Clothoid", "fit_clothoid", "fit_clothoids"),
    "ellipse": ("Ellipse", "fit_ellipse"),
    "line_circle": ("fit_circle", "fit_circles", "fit_line", "fit_lines"),
    "model_selection": ("curve_from_params", "fit_curve", "fit_curves", "select_each"),
    "polynomial": ("Polynomial", "fit_polynomial"),
    "segmentation": ("element_ranges", "segment_line"),
})
