"""Corrections of passes that were adjusted to each other; stored with the points, so that measured coordinates can be restored."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..store.records import COORDINATE_SCALE, to_units

if TYPE_CHECKING:
    import laspy

    from ..store.columns import Columns

CORRECTION_STEP = 10.0        # m of station between nodes
VLR_USER_ID = "Lanewright"    # of the LAS records, one per pass; the record id is the pass number + 1
_HEAD = np.dtype([("first", "<f8"), ("count", "<u4")])


@dataclass(frozen=True)
class PassCorrections:
    """East, north and up corrections of every pass that was moved, by station.

    by_pass : {pass number: (station of the first node in m, (3, N) int16 in 0.1 mm)}, nodes CORRECTION_STEP apart; constant
        beyond the first and the last node
    """

    by_pass: dict[int, tuple[float, np.ndarray]]

    def metres(self, number: int, s: np.ndarray) -> tuple[np.ndarray, ...]:
        """East, north and up corrections, (N,) metres each, of a pass at (N,) stations."""
        first, values = self.by_pass[number]
        nodes = first + CORRECTION_STEP * np.arange(values.shape[1])
        return tuple(np.interp(s, nodes, row) * COORDINATE_SCALE for row in values)

    def units(self, records: Columns | np.ndarray) -> np.ndarray:
        """(3, N) int32 corrections of x, y and z of moved points (Columns or structured records), in units of 0.1 mm."""
        numbers, found = records["pass_number"], np.zeros((3, len(records)), np.int32)
        for number in np.unique(numbers).tolist():
            if number in self.by_pass:
                own = np.flatnonzero(numbers == number)
                found[:, own] = [to_units(v) for v in self.metres(number, records["s"].take(own) * COORDINATE_SCALE)]
        return found

    def to_records(self) -> list[laspy.VLR]:
        """The corrections as LAS variable length records, one per pass."""
        import laspy

        return [laspy.VLR(VLR_USER_ID, number + 1, "Move of a pass",
                          np.array([(first, values.shape[1])], _HEAD).tobytes() + np.ascontiguousarray(values, "<i2").tobytes())
                for number, (first, values) in sorted(self.by_pass.items())]

    @classmethod
    def of_records(cls, records: Iterable[laspy.VLR]) -> PassCorrections | None:
        """Read what `to_records` wrote, from the records of a file; None where there is nothing."""
        found = {}
        for record in records:
            if record.user_id.rstrip("\0") == VLR_USER_ID:
                data = bytes(record.record_data_bytes())
                first, count = np.frombuffer(data, _HEAD, 1)[0].tolist()
                found[record.record_id - 1] = first, np.frombuffer(data, "<i2", 3 * count, _HEAD.itemsize).reshape(3, count)
        return cls(found) if found else None
