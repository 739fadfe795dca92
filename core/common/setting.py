"""Settings with limits, declared once: the core refuses what lies outside them, and a dialog offers what lies inside."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from typing import Any, TypeVar

from .errors import RoadExtractionError

_KEY = "limits"
Weights = TypeVar("Weights")


def table(kind: type[Weights]) -> Weights:
    """The one frozen object of a class of weights, which has the name of the class.

    Nobody compares or prints it: what would do so takes longer to make than all else of it, at every start of QGIS and of each worker.
    """
    return dataclass(frozen=True, eq=False, repr=False)(kind)()


@dataclass(frozen=True)
class Limits:
    """The values that a setting may have."""

    minimum: float   # minimum, maximum: both allowed, in `unit`
    maximum: float
    name: str   # the setting, as at the beginning of a sentence
    unit: str = ""   # "" without one
    zero: str = ""   # what 0 stands for, where 0 is allowed below the minimum; "" where it is not

    @property
    def lowest(self) -> float:
        """The smallest value allowed, including a 0 with a meaning of its own."""
        return 0 * self.minimum if self.zero else self.minimum

    def check(self, value: float) -> None:
        """Refuse a value outside the limits, or NaN."""
        if self.minimum <= value <= self.maximum or self.zero and value == 0:
            return
        unit = self.unit if self.unit in ("", "°") else f" {self.unit}"
        zero = f", or 0 {self.zero}" if self.zero else ""
        raise RoadExtractionError(f"{self.name} is {value}{unit}; it must be between {self.minimum:.10g} and {self.maximum:.10g}{unit}{zero}.")


@dataclass(frozen=True)
class Choices:
    """The words that a setting may be; `name` as of Limits."""

    words: tuple[str, ...]
    name: str

    def check(self, value: str) -> None:
        """Refuse another word."""
        if value not in self.words:
            raise RoadExtractionError(f"{self.name} is “{value}”; it must be one of {', '.join(self.words)}.")


def setting(default: Any, minimum: float, maximum: float, name: str, unit: str = "", zero: str = "") -> Any:
    """A dataclass field of a Settings class with Limits; the class is Limited, or calls `check_limits` in its `__post_init__`."""
    return field(default=default, metadata={_KEY: Limits(minimum, maximum, name, unit, zero)})


def choice(default: str, words: Iterable[str], name: str) -> Any:
    """As `setting`, of a word that is one of several."""
    return field(default=default, metadata={_KEY: Choices(tuple(words), name)})


def limits_of(settings: Any, name: str) -> Limits | Choices | None:
    """The Limits or Choices of a field of a Settings class or object, None where it has none."""
    return next(entry.metadata.get(_KEY) for entry in fields(settings) if entry.name == name)


def check_limits(settings: Any) -> None:
    """Refuse settings of which one lies outside its limits; the message names the first."""
    for entry in fields(settings):
        if _KEY in entry.metadata:
            entry.metadata[_KEY].check(getattr(settings, entry.name))


class Limited:
    """A Settings class that refuses values beyond their limits when it is made."""

    def __post_init__(self) -> None:
        check_limits(self)
