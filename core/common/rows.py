"""Things of one kind as columns: dataclasses of arrays that have one entry for each of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

AnyRows = TypeVar("AnyRows", bound="Rows")


class Rows:
    """Base of a dataclass whose fields are arrays of one length: how many entries there are, some of them, and those of several joined."""

    def columns(self) -> list[np.ndarray]:
        """The arrays, in the order of the fields."""
        return [getattr(self, entry.name) for entry in fields(self)]  # type: ignore[arg-type]

    def __len__(self) -> int:
        return len(self.columns()[0])

    def __getitem__(self: AnyRows, which: Any) -> AnyRows:
        return type(self)(*(values[which] for values in self.columns()))

    @classmethod
    def join(cls: type[AnyRows], parts: Sequence[AnyRows]) -> AnyRows:
        """The entries of all parts, one after the other."""
        return cls(*map(np.concatenate, zip(*(part.columns() for part in parts))))
