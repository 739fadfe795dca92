"""What all simulated scenes share: scanners and vehicle, objects, paint, strips beside the road, materials, and the fields of the truth."""

from ...core.lazy import public

__getattr__, __all__ = public(__name__, {
    "materials": ("LABELS", "Texture"),
    "scanner": ("Scanner", "cast"),
    "scene": ("SurveyedScene",),
    "truth": ("Truth",),
    "vehicle": ("Drive",),
})
