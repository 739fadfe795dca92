"""UAV images, georeferenced with ground control points.

In: an image and ground control points. Out: a polynomial, its residuals, and the image resampled onto the map.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "ControlPoints": "control_points",
    "GeoreferenceSettings": "georeference",
    "Georeferencing": "georeference",
    "SourceImage": "source_image",
    "draw_image": "warp",
    "open_image": "source_image",
    "read_control_points": "control_points",
    "residual_vectors": "georeference",
})
