"""UAV images, georeferenced with ground control points.

Control points are given, or proposed from paint that the intensity image shows too.

In: an image and ground control points. Out: a polynomial, its residuals, and the image resampled onto the map.
"""

from ...core.lazy import public

__getattr__, __all__ = public(__name__, {
    "control_points": ("ControlPoints", "read_control_points"),
    "georeference": ("GeoreferenceSettings", "Georeferencing", "residual_vectors"),
    "rough_place": ("PositionTags", "RoughPlace", "read_position_tags"),
    "source_image": ("SourceImage", "open_image"),
    "warp": ("draw_image",),
})
