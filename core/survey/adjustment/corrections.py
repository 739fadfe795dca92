"""How passes were moved to lie on each other, as it travels with their points: measured coordinates can always be told."""

from dataclasses import dataclass

import numpy as np

from ..store.records import COORDINATE_SCALE, to_units

CORRECTION_STEP = 10.0        # m of station between the nodes
VLR_USER_ID = "Lanewright"  # of the records in LAS files, one for each pass, numbered from 1
_HEAD = np.dtype([("first", "<f8"), ("count", "<u4")])


@dataclass(frozen=True)
class PassCorrections:
    """East, north and up of every pass that was moved, by station.

    by_pass : {pass number: (station of the first node, (3, N) int16 in 0.1 mm)}, nodes CORRECTION_STEP metres apart; a pass goes
        on beyond its first and last node as there
    """

    by_pass: dict

    def metres(self, number, s):
        """East, north and up, (N,) metres, of a pass at (N,) stations."""
        first, values = self.by_pass[number]
        nodes = first + CORRECTION_STEP * np.arange(values.shape[1])
        return tuple(np.interp(s, nodes, row) * COORDINATE_SCALE for row in values)

    def units(self, records):
        """(3, N) int32 in 0.1 mm that the x, y and z of moved points, Columns or structured, lie off what was measured."""
        numbers, found = records["pass_number"], np.zeros((3, len(records)), np.int32)
        for number in np.unique(numbers).tolist():
            if number in self.by_pass:
                own = np.flatnonzero(numbers == number)
                found[:, own] = [to_units(v) for v in self.metres(number, records["s"].take(own) * COORDINATE_SCALE)]
        return found

    def to_records(self):
        """laspy VLRs."""
        import laspy

        return [laspy.VLR(VLR_USER_ID, number + 1, "Move of a pass",
                          np.array([(first, values.shape[1])], _HEAD).tobytes() + np.ascontiguousarray(values, "<i2").tobytes())
                for number, (first, values) in sorted(self.by_pass.items())]

    @classmethod
    def of_records(cls, records):
        """What `to_records` wrote, from the VLRs of a file; None where there is nothing of it."""
        found = {}
        for record in records:
            if record.user_id.rstrip("\0") == VLR_USER_ID:
                data = bytes(record.record_data_bytes())
                first, count = np.frombuffer(data, _HEAD, 1)[0].tolist()
                found[record.record_id - 1] = first, np.frombuffer(data, "<i2", 3 * count, _HEAD.itemsize).reshape(3, count)
        return cls(found) if found else None
