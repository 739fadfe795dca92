"""What was read of a map from elsewhere, as layers like ours."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import shapely

from ..common.features import DRIVING_LINES, MARKING_LINES, ROAD_EDGES, Features
from ..driving.layers import Lanes

STATUS_OF_MAPS = "measured"


@dataclass
class MapLine:
    """A border or a line between borders in the file: a painted line, an edge, or neither.

    road : number; what : marking or edge; kind : edge, lane, centre, curb, dropped or pavement; pattern : as in MARKING_LINES
    points : (N, 3) map coordinates; width : metres, NaN where unknown; side : left, right or ""
    edge : what an edge is, curb or pavement; height : metres of a curb, NaN where unknown
    """

    road: int
    what: str
    kind: str
    pattern: str
    points: np.ndarray
    width: float = np.nan
    side: str = ""
    edge: str = "curb"
    height: float = np.nan


@dataclass
class MapLayers:
    """Lanes and lines of a map in one CRS.

    lanes : Lanes in map coordinates
    lines : list of MapLine
    notes : sentences for the user
    """

    lanes: Lanes
    lines: list[MapLine] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def lane_areas(self) -> Features:
        """The layer LANES."""
        return self.lanes.to_features()

    def driving_lines(self) -> Features:
        """The middles of driven lanes, as DRIVING_LINES."""
        layer, lanes, widths = Features("LineStringZ", DRIVING_LINES, crs=self.lanes.crs), self.lanes, self.lanes.width
        for k in range(len(lanes)):
            if lanes.type[k] not in ("driving", "connector"):
                continue
            left, right = lanes.borders(k)
            middle = without_repeats((left + right) / 2)
            if len(middle) < 2:
                continue
            layer.add(shapely.linestrings(middle), road=lanes.road[k], lane=lanes.lane[k], kind="lane", direction=lanes.direction[k],
                      pattern=f"{lanes.left_pattern[k] or 'none'}|{lanes.right_pattern[k] or 'none'}", source="pair", status=lanes.status[k],
                      station_m=lanes.station[k], end_m=lanes.end[k], length_m=plan_length(middle), width_m=widths[k])
        return layer

    def marking_lines(self) -> Features:
        """Painted borders, as MARKING_LINES."""
        layer = Features("LineStringZ", MARKING_LINES, crs=self.lanes.crs)
        for number, line in enumerate((line for line in self.lines if line.what == "marking"), start=1):
            layer.add(shapely.linestrings(line.points), road=line.road, line=number, kind=line.kind, pattern=line.pattern, status=STATUS_OF_MAPS,
                      station_m=0.0, end_m=plan_length(line.points), length_m=plan_length(line.points), width_m=line.width)
        return layer

    def road_edges(self) -> Features:
        """Curbs and the outer borders of what is driven on, as ROAD_EDGES."""
        layer = Features("LineStringZ", ROAD_EDGES, crs=self.lanes.crs)
        for number, line in enumerate((line for line in self.lines if line.what == "edge"), start=1):
            layer.add(shapely.linestrings(line.points), road=line.road, side=line.side or None, status=STATUS_OF_MAPS, station_m=0.0,
                      end_m=plan_length(line.points), part="bottom", length_m=plan_length(line.points), kind="main", edge=line.edge, chain=number,
                      height_m=line.height)
        return layer


def plan_length(points: np.ndarray) -> float:
    """Metres in plan along (N, 3) points."""
    return float(np.hypot(*np.diff(points[:, :2], axis=0).T).sum())


def without_repeats(points: np.ndarray, nearest: float = 1e-4) -> np.ndarray:
    """The points of a line without those that lie within a tenth of a millimetre of the one before."""
    keep = np.append(True, np.hypot(*np.diff(points[:, :2], axis=0).T) > nearest)
    return points[keep]
