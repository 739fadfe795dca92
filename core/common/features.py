"""Vector results between stages: geometries in map coordinates with their fields.

One small container, so that a layer read from a file and a result passed on in
memory are the same thing to the next stage.
"""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Field:
    """A column: `name` has at most 10 characters, `type` is int, float or str."""

    name: str
    type: type
    alias: str = ""


@dataclass
class Features:
    """A layer in memory.

    Attributes
    ----------
    geometry_type : "PointZ", "LineStringZ", "PolygonZ" or "None" (a table)
    schema : list of Field
    geometries : list of shapely geometries with Z in map coordinates (None in a table)
    rows : list of dict, field name to value; a missing name is NULL
    crs : WKT or "" where unknown
    """

    geometry_type: str
    schema: list
    geometries: list = field(default_factory=list)
    rows: list = field(default_factory=list)
    crs: str = ""

    def add(self, geometry, **row):
        self.geometries.append(geometry)
        self.rows.append(row)

    def __len__(self):
        return len(self.rows)

    def __iter__(self):
        return iter(zip(self.geometries, self.rows))

    def column(self, name, default=None):
        """The values of one field, in row order."""
        return [default if row.get(name) is None else row[name] for row in self.rows]
