"""Points by road section, in files that every thread, process and machine maps into memory.

In: compact point records in any order. Out: the points of one section, in an order that does not depend on the files.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "columns": ("Columns",),
    "records": ("COORDINATE_SCALE", "Points", "ROAD_POINT", "SURVEY_POINT", "to_units"),
    "road_points": ("RoadPoints", "columns_of_roads"),
    "section_store": ("SectionStore",),
})
