"""Paint separated from asphalt.

In: road points and the intensity image. Out: the points and the pixels that are paint.
"""

from __future__ import annotations

from ...lazy import public

__getattr__, __all__ = public(__name__, {"extract": ("extract_markings",), "settings": ("MarkingSettings", "PaintMethod")})
