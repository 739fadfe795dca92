"""UAV images, georeferenced with ground control points.

In: an image and ground control points. Out: a polynomial, its residuals, and the image resampled onto the map.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "control_points": ("ControlPoints", "read_control_points"),
    "georeference": ("GeoreferenceSettings", "Georeferencing", "residual_vectors"),
    "source_image": ("SourceImage", "open_image"),
    "warp": ("draw_image",),
})
