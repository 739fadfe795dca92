"""What asphalt and paint return to the scanner.

In: road points. Out: intensities without the effect of range and incidence, and the geo-referenced intensity image.
"""

from __future__ import annotations

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "correction": ("IntensityReport", "IntensitySettings", "Saturation", "correct_intensity", "saturation_of"),
    "image": ("ImageSettings", "check_fits", "check_image_shows", "make_intensity_image", "write_intensity_image"),
    "tiled_image": ("TiledImage",),
})
