"""Layers as columns: dataclasses of arrays that declare once which fields of a layer they are, and are written to it and read from it so."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache
from typing import Any, ClassVar, TypeVar

import numpy as np

from .arrays import Rows
from .features import Features, Field

AnyLayerRows = TypeVar("AnyLayerRows", bound="LayerRows")
_KEY = "column"


@dataclass(frozen=True)
class _Column:
    """What `column` says, with the Field of the layer. kind : of the array; always_known : no value stands for NULL."""

    field: Field
    unknown: Any
    kind: type
    always_known: bool

    def array(self, values: Sequence[Any]) -> np.ndarray:
        """The array of values of which None is unknown."""
        return np.array([self.unknown if value is None else str(value) if self.kind is object else value for value in values], self.kind)

    def written(self, values: Any) -> list[Any]:
        """The values of an array as the layer holds them."""
        listed = np.asarray(values, self.kind).tolist()
        if self.always_known:
            return [self.field.value(value) for value in listed]
        return [None if value == "" or value != value or isinstance(value, int) and value < 0 else value for value in listed]


def column(name: str = "", unknown: Any = None) -> dict[str, Any]:
    """The metadata of an attribute of LayerRows that is a field of the layer, for `dataclasses.field`.

    name : of the field, "" for that of the attribute
    unknown : what the attribute holds where a layer that is read has NULL, an empty text or no such field, and then every value of the attribute
        is written as it is, but NaN; None for NaN, -1 or "" by the type of the field, which are written as NULL, as is any whole number below 0
    """
    return {_KEY: (name, unknown)}


def _columns_of(kind: type[LayerRows]) -> dict[str, _Column]:
    """The columns of a layer by attribute."""
    schema, columns = {attribute.name: attribute for attribute in kind.SCHEMA}, {}
    for attribute in fields(kind):  # type: ignore[arg-type]
        if _KEY in attribute.metadata:
            name, unknown = attribute.metadata[_KEY]
            field, given = schema[name or attribute.name], unknown is not None
            unknown = unknown if given else {int: -1, float: np.nan, str: ""}[field.type]
            columns[attribute.name] = _Column(field, unknown, object if isinstance(unknown, str) else type(unknown), given)
    return columns


_columns: Callable[[type], dict[str, _Column]] = cache(_columns_of)


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

    def derived(self, frame: Any) -> dict[str, Any]:
        """Fields of the layer that follow from other attributes: name to values, of which None, NaN and what is infinite become NULL."""
        return {}

    def to_features(self, frame: Any = None) -> Features:
        """The layer in map coordinates, in the same order. `frame` : RoadFrame."""
        columns = {attribute.field.name: attribute.written(getattr(self, name)) for name, attribute in _columns(type(self)).items()}
        derived = self.derived(frame)
        columns.update({attribute.name: [attribute.value(value) for value in derived[attribute.name]]
                        for attribute in self.SCHEMA if attribute.name in derived})
        rows = [dict(zip(columns, row)) for row in zip(*columns.values())]
        return Features(self.GEOMETRY_TYPE, list(self.SCHEMA), list(self.on_map(frame)), rows, self.crs)

    @classmethod
    def read_columns(cls, rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
        """Arrays by attribute of rows of the layer, whose fields may be missing."""
        return {name: attribute.array([None if (value := row.get(attribute.field.name)) == "" else value for row in rows])
                for name, attribute in _columns(cls).items()}

    @classmethod
    def gathered(cls, things: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
        """Arrays by attribute of things of which each is a dict of attribute to value; what is missing is unknown."""
        return {name: attribute.array([entry.get(name) for entry in things]) for name, attribute in _columns(cls).items()}

    @classmethod
    def array_of(cls, name: str, values: Any) -> np.ndarray:
        """The array of an attribute, of the type of its field."""
        attribute = _columns(cls).get(name)
        return np.asarray(values, None if attribute is None else attribute.kind)

    @classmethod
    def filled(cls: type[AnyLayerRows], count: int, crs: str = "", **values: Any) -> AnyLayerRows:
        """`count` entries: of each attribute an array, or a value that all share; what is not given is unknown."""
        values = {**{name: attribute.unknown for name, attribute in _columns(cls).items()}, **values}
        return cls(*(np.array(np.broadcast_to(cls.array_of(name, values.get(name, np.nan)), count)) for name in cls.names()), crs=crs)  # type: ignore[call-arg]

    @classmethod
    def join(cls: type[AnyLayerRows], parts: Sequence[AnyLayerRows], crs: str = "") -> AnyLayerRows:
        """The entries of all parts, one after the other; there may be no part."""
        return replace(super().join([cls.filled(0), *parts]), crs=crs)  # type: ignore[type-var]
