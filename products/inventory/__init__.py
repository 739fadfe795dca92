"""What else the road shows: cross-sections, and in `roadside/` what stands beside it.

In: an open `Survey` and the layers of its road map. Out: `RoadSections`, and their layer and table.
"""

from ...core.lazy import public

__getattr__, __all__ = public(__name__, {
    "borders": ("BorderLayers", "CrossSectionSettings", "RoadsideSettings"),
    "cross_sections": ("RoadSections", "measure_cross_sections", "sections_to_features"),
})
