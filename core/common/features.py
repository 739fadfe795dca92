"""Vector layers in memory: geometries in map coordinates with their fields.

A layer read from a file and a result passed on in memory have the same type, so every stage takes either.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Field:
    """A column of a layer.

    name : at most 10 characters
    type : int, float or str
    alias : the name spelled out, with its unit
    needed : False where a layer that is read may lack it, such as one that an earlier version wrote; its values are None then
    on_map : True for a map coordinate, which is written in the units of the layer's CRS
    """

    name: str
    type: type
    alias: str = ""
    needed: bool = True
    on_map: bool = False


@dataclass
class Features:
    """A vector layer in memory.

    Attributes
    ----------
    geometry_type : "PointZ", "LineStringZ", "PolygonZ" or "None" (a table)
    schema : list of Field
    geometries : list of shapely geometries with Z in map coordinates (None in a table)
    rows : list of dict, field name to value; a missing name is NULL
    crs : WKT, "" where unknown
    description : what made the layer, which a GeoPackage keeps
    """

    geometry_type: str
    schema: list[Field]
    geometries: list[Any] = field(default_factory=list)
    rows: list[dict[str, Any]] = field(default_factory=list)
    crs: str = ""
    description: str = ""

    def add(self, geometry: Any, **row: Any) -> None:
        """Append a feature with its field values."""
        self.geometries.append(geometry)
        self.rows.append(row)

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[tuple[Any, dict[str, Any]]]:
        return iter(zip(self.geometries, self.rows))

    def column(self, name: str, default: Any = None) -> list[Any]:
        """The values of one field in row order, `default` where NULL."""
        return [default if row.get(name) is None else row[name] for row in self.rows]
