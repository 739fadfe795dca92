"""What is done with the points of a section before they are put in order: scanners are numbered, and those far above or below the road go."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..las.point_fields import numbers_by_value
from ..store.columns import Columns
from ..store.records import COORDINATE_SCALE, road_of
from .blocks import KEPT_BELOW_ROAD, LEVEL_HEIGHT

if TYPE_CHECKING:
    from ..estimation.interleaved import ScannerSplitter
    from ..frame.road_frame import RoadFrame

ROAD_HEIGHT_STEP = 0.25      # m between the stations at which points are compared with the height of the road


@dataclass(frozen=True)
class Finishing:
    """Finishes the points of sections.

    frame : RoadFrame
    sensor_height : {pass number: metres from the trajectory down to the road}
    scanner_field : LAS field that identifies the scanners, None if there is one
    scanners : values of that field, see `ScannerCensus.choose`
    splitter : tells scanners apart that no field distinguishes; None where there is no need
    above_road : metres above the road up to which points are kept
    """

    frame: RoadFrame
    sensor_height: dict[int, float]
    scanner_field: str | None
    scanners: list[Any]
    splitter: ScannerSplitter | None
    above_road: float

    def __call__(self, road: int, records: Columns) -> np.ndarray | None:
        """Number the scanners of the records of a section from 0.

        Parameters
        ----------
        road : number, or that of what lies beside it
        records : (N,) Columns, in no order, N > 0

        Returns
        -------
        (N,) bool of those near the height of the road, None for all
        """
        if self.splitter is not None:
            records["scanner"] = self.splitter.numbers(records["time"], np.stack([records[name] for name in "xyz"], axis=1) * COORDINATE_SCALE)
        elif self.scanner_field is None:
            records["scanner"] = 0
        else:
            numbers = records["source" if self.scanner_field == "point_source_id" else "scanner"]
            records["scanner"] = numbers_by_value(self.scanners, int(numbers.max()) + 1).take(numbers)
        # only records near the limits are compared with the height at their own station
        z = records["z"]
        below, above = (KEPT_BELOW_ROAD, self.above_road) if road >= 0 else (LEVEL_HEIGHT, LEVEL_HEIGHT)
        first, nodes = self._heights(road_of(road), records["s"].min() * COORDINATE_SCALE, records["s"].max() * COORDINATE_SCALE)
        doubtful = np.flatnonzero((z < (nodes.max() - below) / COORDINATE_SCALE + 1)
                                  | (z > (nodes.min() + above) / COORDINATE_SCALE - 1))
        at = records["s"][doubtful] * COORDINATE_SCALE / ROAD_HEIGHT_STEP - first
        k = at.astype(np.int64)
        h = z[doubtful] * COORDINATE_SCALE - (nodes[k] + (at - k) * (nodes[k + 1] - nodes[k]))
        near = np.ones(len(records), bool)
        near[doubtful] = (h > -below) & (h < above)
        return None if near[doubtful].all() else near

    def _heights(self, road, start, end):
        """Heights of the road at fixed stations from start to end: number of the first, heights."""
        first = int(np.floor(start / ROAD_HEIGHT_STEP))
        stations = np.arange(first, int(np.floor(end / ROAD_HEIGHT_STEP)) + 2) * ROAD_HEIGHT_STEP
        return first, self.frame.track_height(road, stations, self.sensor_height)
