"""UAV images, georeferenced with ground control points.

Control points are given, or proposed from paint that the intensity image shows too.

In: an image and ground control points. Out: a polynomial, its residuals, and the image resampled onto the map.
"""

from ...core.lazy import public

__getattr__, __all__ = public(__name__, {
    "control_points": ("ControlPoints", "SourceImage", "open_image", "read_control_points"),
    "georeference": ("GeoreferenceSettings", "Georeferencing", "draw_image", "residual_vectors"),
    "rough_place": ("PositionTags", "RoughPlace", "read_position_tags"),
})
