"""Lanelet2: lanes between two shared lines of nodes with latitude and longitude.

In: a file `.osm` or `Lanes`. Out: a `LaneletMap`, and from it layers or a file.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "exporter": ("LaneletDraft", "LaneletSettings", "draft_lanelets"),
    "layers": ("layers_of_lanelets",),
    "model": ("Lanelet", "LaneletMap", "LaneletNetwork", "Way"),
    "reader": ("read_lanelet2",),
    "writer": ("Degrees", "lanelet2_text", "to_degrees"),
})
