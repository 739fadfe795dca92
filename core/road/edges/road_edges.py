"""Road edges as arrays, read from the layer ROAD_EDGES."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...common.features import Features
from ...survey.frame.frame_lines import FrameLines, line_parts, lines_in_frame

if TYPE_CHECKING:
    from ...survey.frame.road_frame import RoadFrame


@dataclass(frozen=True)
class RoadEdges:
    """E pieces of road edges, each of one status.

    edge : (E,) int, row of the layer that the piece comes from
    kind : (E,) str objects: main for the road's own edges; corner, side_street and island for what leads away from it or stands in it
    status : (E,) str objects, measured, bridged, inferred
    course : FrameLines, one per piece
    """

    edge: np.ndarray
    kind: np.ndarray
    status: np.ndarray
    course: FrameLines

    def __len__(self) -> int:
        return len(self.edge)


def edges_from_features(features: Features, frame: RoadFrame) -> RoadEdges:
    """Read the layer ROAD_EDGES.

    Parameters
    ----------
    features : Features with lines in map coordinates; `road`, `kind` and `status` are used where they are. Rows without `kind` are main edges
    frame : RoadFrame

    Returns
    -------
    RoadEdges, one piece a LineString; rows without geometry are left out
    """
    parts, row_of = line_parts(features.geometries)
    rows = [features.rows[k] for k in row_of]
    road = [-1 if row.get("road") is None else int(row["road"]) for row in rows]
    kind, status = (np.array([str(row.get(name) or missing) for row in rows], object)
                    for name, missing in (("kind", "main"), ("status", "measured")))
    return RoadEdges(np.array(row_of, int), kind, status, lines_in_frame(parts, road, frame))
