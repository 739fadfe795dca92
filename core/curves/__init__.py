"""Curves fitted to points: line, circle, ellipse, clothoid, polynomial, B-spline.

In: points along a line, x and y in metres. Out: a `CurveFit`, of one kind or of the simplest kind that describes
the points; a long line divided into the elements of an alignment; smooth profiles.
"""

from __future__ import annotations

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "base": ("Arc", "Curve", "CurveFit"),
    "bspline": ("Profile", "Spline", "fit_splines", "smooth_profiles"),
    "clothoid": ("Clothoid", "fit_clothoids"),
    "model_selection": ("fit_curve", "fit_curves"),
    "segmentation": ("element_ranges",),
    "simple_curves": ("Ellipse", "Polynomial", "fit_circles", "fit_ellipse", "fit_lines", "fit_polynomial"),
})
