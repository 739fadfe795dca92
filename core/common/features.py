"""Vector layers in memory: geometries in map coordinates with their fields.

A layer read from a file and a result passed on in memory have the same type, so every stage takes either.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache, cached_property
from math import isfinite
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Field:
    """A column of a layer."""

    name: str   # at most 10 characters
    type: type   # int, float or str
    alias: str = ""   # the name spelled out, with its unit
    needed: bool = True   # False where a layer that is read may lack it, such as one that an earlier version wrote; its values are None then
    on_map: bool = False   # True for a map coordinate, which is written in the units of the layer's CRS

    def value(self, value: Any) -> Any:
        """A value as a row holds it: a Python number or text of the field's type, None (NULL) for a number that is NaN or infinite."""
        return None if value is None or self.type is not str and not isfinite(value) else self.type(value)


@dataclass
class Features:
    """A vector layer in memory."""

    geometry_type: str   # "PointZ", "LineStringZ", "PolygonZ" or "None" (a table)
    schema: list[Field]
    geometries: list[Any] = field(default_factory=list)   # shapely geometries with Z in map coordinates (None in a table)
    rows: list[dict[str, Any]] = field(default_factory=list)   # field name to value; a missing name is NULL
    crs: str = ""   # WKT, "" where unknown
    description: str = ""   # what made the layer, which a GeoPackage keeps

    def add(self, geometry: Any, **row: Any) -> None:
        """Append a feature with its field values, numpy's or Python's, see `Field.value`."""
        self.geometries.append(geometry)
        self.rows.append({name: self._fields[name].value(value) if name in self._fields else value for name, value in row.items()})

    @cached_property
    def _fields(self) -> dict[str, Field]:
        return {attribute.name: attribute for attribute in self.schema}

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[tuple[Any, dict[str, Any]]]:
        return iter(zip(self.geometries, self.rows))

    def column(self, name: str, default: Any = None) -> list[Any]:
        """The values of one field in row order, `default` where NULL."""
        return [default if row.get(name) is None else row[name] for row in self.rows]


# The fields of all layers, and those that several of them have: what fields.txt calls them are names of this module.

@cache
def _named() -> dict[str, Any]:
    """{name: Field, or list of the Fields of a layer} of fields.txt, whose first lines say how it is read."""
    named: dict[str, Any] = {}
    layer: list[Field] = []
    for line in Path(__file__).with_name("fields.txt").read_text(encoding="utf-8").splitlines():
        if line.startswith("["):
            layer = named[line.strip("[]")] = []
        elif re.fullmatch("[A-Z_ ]+", line):
            for known in map(named.get, line.split()):
                layer += known if isinstance(known, list) else [known]
        elif line and not line.startswith("#"):
            name, _, column = line.rpartition(" = ")
            column, kind, alias = column.split(maxsplit=2)
            made = Field(column, {"int": int, "float": float, "str": str}[kind.rstrip("?@")], alias, "?" not in kind, "@" in kind)
            if name:
                named[name] = made
            else:
                layer.append(made)
    return named


def __getattr__(name: str) -> Any:
    if name not in _named():
        raise AttributeError(name)
    return _named()[name]
