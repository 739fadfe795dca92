"""The areas of lanes between their borders, and what follows each lane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.parallel import check_cancelled
from ..markings.cross_section.sections import STATION_STEP, CrossSections
from ..markings.cross_section.weights import CENTRE_LINE, CURB, EDGE_LINE, HATCHING, ISLAND, LANE_LINE, OTHER_LINE, SURFACE
from .alignment import track_pieces
from .connectors import NEXT_LANE_GAP, NO_BORDER, connectors_on_road
from .lane_track import LANE_STATUS, LaneTrack
from .layers import Lanes
from .shoulders import shoulders

if TYPE_CHECKING:
    from ..markings.cross_section.roads import EstimatedRoad
    from ..survey.frame.road_frame import RoadFrame

KIND_OF_BORDER = {LANE_LINE: "lane", CENTRE_LINE: "centre", EDGE_LINE: "edge", OTHER_LINE: "edge"}


def lane_areas(road: EstimatedRoad, curbs: CrossSections | None, tracks: list[LaneTrack], heights: list[np.ndarray], frame: RoadFrame,
               number: int, pavement: CrossSections | None = None) -> list[dict[str, Any]]:
    """The rows of Lanes of one road: its lanes by piece, connectors along the drive where lanes end and begin again, and shoulders.

    Parameters
    ----------
    road : EstimatedRoad
    curbs : CrossSections of the road edges that were given to the estimate, or None
    tracks : list of LaneTrack; lanes are numbered from 1 in their order
    heights : local z along each track
    frame : RoadFrame
    number : of the road
    pavement : CrossSections of the edges of the pavement without a curb, or None
    """
    rows = []
    for lane, (track, z) in enumerate(zip(tracks, heights), start=1):
        check_cancelled()
        for code, start, end in track_pieces(track, road.lines.s):
            part = slice(*np.searchsorted(road.lines.s[track.first:track.last + 1], [start, end + STATION_STEP / 2]))
            if part.stop - part.start >= 2:
                rows.append(_area(road, curbs, track, part, z, frame, number) | dict(lane=lane, status=LANE_STATUS[code]))
    rows += connectors_on_road(road.lines.s, tracks, heights, frame, number)
    if pavement is not None:
        lanes = max((row["lane"] for row in rows), default=0)
        borders = [_sides(road, track, slice(0, len(track)), z, frame, number) for track, z in zip(tracks, heights)]
        rows += [row | dict(lane=lane) for lane, row in enumerate(shoulders(road, tracks, borders, pavement, frame, number), start=lanes + 1)]
    names: dict[int, int] = {}
    for row in rows:
        names[row["lane"]] = names.get(row["lane"], 0) + 1
        row["lane_id"] = f"{number}.{row['lane']}.{names[row['lane']]}"
    follow(rows)
    return rows


def _sides(road, track, part, z, frame, number):
    """The left and the right border of part of a lane along the road, (N, 3) local metres each."""
    columns = np.arange(track.first, track.last + 1)[part]
    s, d, half = road.lines.s[columns], track.d[part], track.width[part] / 2
    sides = []
    for side, row in ((1, track.left[part]), (-1, track.right[part])):
        x, y = frame.roads[number].to_map(s, d + side * half)
        painted = (row >= 0) & (row < len(road.lines.d))
        own = np.where(painted, road.lines.z[np.where(painted, row, 0), columns], np.nan) if len(road.lines.d) else np.full(len(s), np.nan)
        sides.append(np.c_[x, y, np.where(np.isfinite(own), own, z[part])])
    return sides


def _area(road, curbs, track, part, z, frame, number):
    """One piece of a lane: its borders as they are seen in the direction of travel."""
    columns = np.arange(track.first, track.last + 1)[part]
    s, d = road.lines.s[columns], track.d[part]
    sides = _sides(road, track, part, z, frame, number)
    about = [_border(road, curbs, rows[part], uses[part], columns)
             for rows, uses in ((track.left, track.left_use), (track.right, track.right_use))]
    if track.direction < 0:
        sides, about = [side[::-1] for side in sides[::-1]], about[::-1]
    return dict(road=number, type="driving", direction=track.direction, left=sides[0], right=sides[1], about=about,
                **track.said(part), station=float(s[0]), end=float(s[-1]), first=float(d[0]), last=float(d[-1]),
                width=float(np.median(track.width[part])))


def _border(road, curbs, rows, separates, columns):
    """What a border of a piece is along most of it: line, kind and pattern."""
    row = int(np.bincount(rows + 1).argmax()) - 1
    if row < 0:
        return NO_BORDER
    made_of = road.boundaries.made_of[row]
    if road.boundaries.painted[row]:
        numbers = road.lines.number[row, columns]
        drawn = road.lines.drawn[row, columns]
        number = int(np.bincount(numbers[numbers >= 0]).argmax()) if (numbers >= 0).any() else 0
        pattern = road.lines.names[int(np.bincount(drawn[drawn >= 0]).argmax())] if (drawn >= 0).any() else road.lines.patterns[row]
        what = separates[rows == row]
        return f"line {number}", KIND_OF_BORDER.get(int(np.bincount(what[what >= 0]).argmax()) if (what >= 0).any() else EDGE_LINE), pattern
    if made_of in (CURB, ISLAND) and curbs is not None:
        return f"edge {int(curbs.number.row(row - len(road.lines.d)).max())}", "curb", ""
    if made_of == HATCHING:
        return "none", "hatch", ""
    return ("none", "pavement", "") if made_of == SURFACE else NO_BORDER


def follow(rows: list[dict[str, Any]]) -> None:
    """Name in every row what follows it in the direction of travel."""
    begins = {way: _begins(rows, way) for way in (1, -1)}
    for row in rows:
        row["successors"] = ()
        if not (way := row["direction"]):
            continue
        at, d = (row["end"], row["last"]) if way > 0 else (row["station"], row["first"])
        (stations, of), reach = begins[way], NEXT_LANE_GAP + STATION_STEP
        near = [rows[k] for k in sorted(of[slice(*np.searchsorted(stations, [at - reach, at + reach]))])]
        row["successors"] = tuple(
            other["lane_id"] for other in near if other is not row
            and -STATION_STEP <= way * ((other["station"] if way > 0 else other["end"]) - at) <= NEXT_LANE_GAP
            and abs((other["first"] if way > 0 else other["last"]) - d) < max(row["width"], other["width"]) / 2)


def _begins(rows, way):
    """Stations, ascending, at which the lanes of a direction begin, and the rows they are of."""
    of = [k for k, row in enumerate(rows) if row["direction"] == way]
    stations = np.array([rows[k]["station" if way > 0 else "end"] for k in of], float)
    order = np.argsort(stations, kind="stable")
    return stations[order], np.array(of, int)[order].tolist()


def make_lanes(rows: list[dict[str, Any]], crs: str) -> Lanes:
    """Lanes of the rows of all roads."""
    def column(name: str, kind: Any) -> np.ndarray:
        return np.array([row[name] for row in rows], kind)

    def border(side: int, k: int) -> np.ndarray:
        return np.array([row["about"][side][k] for row in rows], object)

    return Lanes(
        column("road", int), column("lane", int), column("lane_id", object), column("type", object), column("direction", int), border(0, 0),
        border(1, 0), border(0, 1), border(1, 1), border(0, 2), border(1, 2), [row["successors"] for row in rows], column("status", object),
        column("confidence", float), column("station", float), column("end", float),
        np.concatenate([np.empty((0, 3)), *(row["left"] for row in rows)]), np.concatenate([np.empty((0, 3)), *(row["right"] for row in rows)]),
        np.append(0, np.cumsum([len(row["left"]) for row in rows], dtype=int)), crs, np.array([row.get("other", "") for row in rows], object))
