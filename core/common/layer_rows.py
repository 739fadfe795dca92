"""Layers as columns: dataclasses of arrays that declare once which fields of a layer they are, and are written to it and read from it so."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cache
from typing import Any, ClassVar, TypeVar

import numpy as np

from .arrays import Rows
from .features import Features, Field

AnyLayerRows = TypeVar("AnyLayerRows", bound="LayerRows")
_KEY = "column"


@dataclass(frozen=True)
class _Column:
    """What `column` says. unknown : the value that stands for NULL; kind : of the array."""

    field: str
    unknown: Any
    kind: type


def column(field_name: str = "", unknown: Any = None) -> Any:
    """An attribute of LayerRows that is a field of the layer.

    Parameters
    ----------
    field_name : of the layer, "" for that of the attribute
    unknown : what the attribute holds where the layer has NULL or no such field; None for NaN, -1 or "" by the type of the field
    """
    return field(metadata={_KEY: (field_name, unknown)})


@cache
def _columns(kind: type[LayerRows]) -> dict[str, _Column]:
    """The columns of a layer by attribute."""
    types = {one.name: one.type for one in kind.SCHEMA}
    found = {}
    for one in fields(kind):  # type: ignore[arg-type]
        if _KEY in one.metadata:
            name, unknown = one.metadata[_KEY]
            name = name or one.name
            array, usual = {int: (int, -1), float: (float, np.nan), str: (object, "")}[types[name]]
            found[one.name] = _Column(name, usual if unknown is None else unknown, array)
    return found


class LayerRows(Rows):
    """Base of the arrays that stages hand each other of a layer: they are written to it and read from it as `column` declares them.

    A subclass has a field `crs` (WKT, "" where unknown), the geometries as arrays of its own, and `on_map` that gives them.
    """

    GEOMETRY_TYPE: ClassVar[str]
    SCHEMA: ClassVar[list[Field]]
    crs: str

    def on_map(self, frame: Any) -> Iterable[Any]:
        """Shapely geometries with Z in map coordinates, one each, as the layer holds them. `frame` : RoadFrame."""
        raise NotImplementedError

    def derived(self, frame: Any) -> dict[str, np.ndarray]:
        """Fields of the layer that follow from other attributes: name to array."""
        return {}

    def to_features(self, frame: Any) -> Features:
        """The layer in map coordinates, in the same order; NaN, "" and whole numbers below 0 become NULL. `frame` : RoadFrame."""
        arrays = {one.field: getattr(self, name) for name, one in _columns(type(self)).items()}
        arrays.update(self.derived(frame))
        rows = [{name: _written(value) for name, value in zip(arrays, row)} for row in zip(*(values.tolist() for values in arrays.values()))]
        return Features(self.GEOMETRY_TYPE, list(self.SCHEMA), list(self.on_map(frame)), rows, self.crs)

    @classmethod
    def read_columns(cls, rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
        """Arrays by attribute of rows of the layer, whose fields may be missing."""
        return {name: np.array([one.unknown if row.get(one.field) is None else row[one.field] for row in rows], one.kind)
                for name, one in _columns(cls).items()}

    @classmethod
    def array_of(cls, name: str, values: Any) -> np.ndarray:
        """The array of an attribute, of the type of its field."""
        one = _columns(cls).get(name)
        return np.asarray(values, None if one is None else one.kind)

    @classmethod
    def filled(cls: type[AnyLayerRows], count: int, crs: str = "", **values: Any) -> AnyLayerRows:
        """`count` entries: of each attribute an array, or a value that all share; what is not given is unknown."""
        values = {**{name: one.unknown for name, one in _columns(cls).items()}, **values}
        return cls(*(np.array(np.broadcast_to(cls.array_of(name, values.get(name, np.nan)), count)) for name in cls.names()), crs=crs)

    @classmethod
    def join(cls: type[AnyLayerRows], parts: Sequence[AnyLayerRows], crs: str = "") -> AnyLayerRows:
        """The entries of all parts, one after the other; there may be no part."""
        return replace(super().join([cls.filled(0), *parts]), crs=crs)  # type: ignore[type-var]


def _written(value: Any) -> Any:
    """A value for the field of a layer: None (NULL) for what arrays hold as unknown."""
    return None if value == "" or value != value or isinstance(value, int) and value < 0 else value
