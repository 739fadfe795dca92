"""What asphalt and paint return to the scanner.

In: road points. Out: intensities without the effect of range and incidence, and the geo-referenced intensity image.
"""

from __future__ import annotations

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "IntensitySettings": "correction", "IntensityReport": "correction", "correct_intensity": "correction",
    "ImageSettings": "image", "make_intensity_image": "image", "write_intensity_image": "image", "check_fits": "image",
    "IntensityRaster": "tiled_image", "TiledImage": "tiled_image",
    "check_image_shows": "coverage",
    "Saturation": "saturation", "saturation_of": "saturation",
})
