"""Points by road section: memory up to a limit, then a temporary file.

In: compact point records in any order. Out: the points of one section, in an order that does not depend on the files.
"""

from ...lazy import public

__getattr__, __all__ = public(__name__, {
    "COORDINATE_SCALE": "records",
    "Columns": "columns",
    "PointSubset": "point_subset",
    "Points": "records",
    "ROAD_POINT": "records",
    "RoadPoints": "road_points",
    "SURVEY_POINT": "records",
    "SectionStore": "section_store",
    "to_units": "records",
})
