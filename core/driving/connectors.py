"""Connectors: where the vehicle drove on from the end of a lane to the beginning of the next, over a junction or from one road to another."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..markings.cross_section.evidence import driven_offsets
from ..markings.cross_section.sections import STATION_STEP
from .lane_track import LaneTrack

if TYPE_CHECKING:
    from ..survey.frame.passes import Pass
    from ..survey.frame.road_frame import RoadFrame

NO_BORDER = "none", "none", ""        # line, kind and pattern
NEXT_LANE_GAP = 3.0                   # m between the end of a lane and the beginning of what follows it
LONGEST_CONNECTOR = 150.0             # m between the end of a lane and the beginning of the one that the vehicle drove on to
CONNECTOR_CONFIDENCE = 0.5            # where the way is known from the drive alone
DRIVEN_ON = 2.0                       # s between two passes of one drive at most: it went on without a stop between them


def connectors_on_road(s: np.ndarray, tracks: list[LaneTrack], heights: list[np.ndarray], frame: RoadFrame, number: int) -> list[dict[str, Any]]:
    """Areas along the drive from the end of a lane to the beginning of the next one of its direction on the same road.

    Parameters
    ----------
    s : (K,) metres, stations of the grid
    tracks : list of LaneTrack; heights : local z along each of them
    frame : RoadFrame; number : of the road

    Returns
    -------
    rows of Lanes, numbered on from the lanes
    """
    driven, directions = driven_offsets(frame, number, s)
    rows, lane = [], len(tracks)
    for way in (1, -1):
        ends = [(track, z, track.last if way > 0 else track.first) for track, z in zip(tracks, heights) if track.direction == way]
        begins = [(track, z, track.first if way > 0 else track.last) for track, z in zip(tracks, heights) if track.direction == way]
        by_station = sorted(range(len(begins)), key=lambda k: begins[k][2])
        stations, reach = [begins[k][2] for k in by_station], int(LONGEST_CONNECTOR / STATION_STEP)
        for before, z_before, a in ends:
            for p in np.flatnonzero(directions == way).tolist():
                if not abs(driven[p, a] - before.at(a)[0]) < before.at(a)[1] / 2:
                    continue
                near = sorted(by_station[slice(bisect_left(stations, a - reach), bisect_right(stations, a + reach))])
                found = [(way * (b - a), after, z, b) for after, z, b in map(begins.__getitem__, near)
                         if NEXT_LANE_GAP < way * (b - a) * STATION_STEP < LONGEST_CONNECTOR
                         and abs(driven[p, b] - after.at(b)[0]) < after.at(b)[1] / 2]
                if not found:
                    continue
                _, after, z_after, b = min(found, key=lambda one: one[0])
                low, high = sorted((a, b))
                columns = np.arange(low, high + 1)
                if not np.isfinite(driven[p, columns]).all():
                    continue
                lane += 1
                area = _connector(before, after, a, b, columns, driven[p], s, (z_before, z_after), frame, number)
                rows.append(area | dict(lane=lane))
                break
    return rows


def _connector(before, after, a, b, columns, driven, s, heights, frame, number):
    share = _eased((columns - a) / (b - a))
    ends = [track.at(k) for track, k in ((before, a), (after, b))]
    off = [place - driven[k] for (place, _), k in zip(ends, (a, b))]
    # from the middle of the one lane to the middle of the other, along the drive between them
    d = driven[columns] + off[0] * (1 - share) + off[1] * share
    half = (ends[0][1] * (1 - share) + ends[1][1] * share) / 2
    z = heights[0][a - before.first] * (1 - share) + heights[1][b - after.first] * share
    sides = [np.column_stack([*frame.roads[number].to_map(s[columns], d + side * half), z]) for side in (1, -1)]
    if before.direction < 0:
        sides = [side[::-1] for side in sides[::-1]]
    return _row(number, before, after, sides, half, station=float(s[columns[0]]), end=float(s[columns[-1]]), first=float(d[0]), last=float(d[-1]))


def _eased(share):
    """A share from 0 to 1 that begins and ends without a slope: no border turns at once where the lane ends."""
    return share**2 * (3 - 2 * share)


def _row(road, before, after, sides, half, **places):
    """The row of Lanes of an area from one lane to another; `half` of its width at each place, `places` along and across the road."""
    return dict(road=road, type="connector", direction=before.direction, left=sides[0], right=sides[1], about=[NO_BORDER, NO_BORDER],
                confidence=CONNECTOR_CONFIDENCE * float(min(before.confidence.mean(), after.confidence.mean())), status="inferred",
                width=float(np.median(2 * half)), **places)


class RoadLanes(NamedTuple):
    """The lanes of one road: stations of its grid, LaneTracks and local z along each."""

    s: np.ndarray
    tracks: list[LaneTrack]
    heights: list[np.ndarray]


class _LaneEnd(NamedTuple):
    """Where a pass leaves or enters a lane: number of the lane, its track, local z, and the station of the grid."""

    lane: int
    track: LaneTrack
    z: float
    at: int


def connectors_between_roads(lanes: dict[int, RoadLanes], frame: RoadFrame, rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Areas along the drive from the end of a lane of one road to the beginning of a lane of another, as where the vehicle turned.

    Parameters
    ----------
    lanes : {number of the road: RoadLanes}
    frame : RoadFrame
    rows : rows of Lanes of all roads; `successors` of the lanes that are left name the connectors afterwards

    Returns
    -------
    rows of Lanes, each of the road that is left; a connector names the piece of lane that it leads to
    """
    found: dict[tuple[int, int, int, int], dict[str, Any]] = {}
    rows_of: dict[int, dict[int, list[dict[str, Any]]]] = {}   # by road and lane
    for row in rows:
        rows_of.setdefault(row["road"], {}).setdefault(row["lane"], []).append(row)
    for before, after in zip(frame.passes[:-1], frame.passes[1:]):
        on = 0 <= after.time[0] - before.time[-1] <= DRIVEN_ON
        if not on or before.road == after.road or before.road not in lanes or after.road not in lanes:
            continue
        left, entered = _lane_end(lanes[before.road], before, leaving=True), _lane_end(lanes[after.road], after, leaving=False)
        if left is None or entered is None or (key := (before.road, left.lane, after.road, entered.lane)) in found:
            continue
        area = _turn(left, entered, before, after, lanes, frame)
        if area is None:
            continue
        number = 1 + max(rows_of[before.road])
        area.update(lane=number, lane_id=f"{before.road}.{number}.1",
                    successors=(_piece_at(rows_of[after.road][entered.lane], lanes[after.road].s[entered.at])["lane_id"],))
        piece = _piece_at(rows_of[before.road][left.lane], lanes[before.road].s[left.at])
        piece["successors"] += (area["lane_id"],)
        found[key] = area
        rows_of[before.road][number] = [area]
    return list(found.values())


def _lane_end(lanes: RoadLanes, drive: Pass, leaving: bool) -> _LaneEnd | None:
    """The last lane of its direction at whose end a pass is in it, or the first at whose beginning it is."""
    first, last = drive.span
    found = []
    for number, (track, z) in enumerate(zip(lanes.tracks, lanes.heights), start=1):
        at = track.last if leaving == (drive.direction > 0) else track.first
        if track.direction != drive.direction or not first <= lanes.s[at] <= last:
            continue
        d, width = track.at(at)
        if abs(drive.at_station(lanes.s[at:at + 1])[0][0] - d) < width / 2:
            found.append(_LaneEnd(number, track, float(z[at - track.first]), at))
    if not found:
        return None
    return (max if leaving == (drive.direction > 0) else min)(found, key=lambda one: one.at)


def _turn(left, entered, before, after, lanes, frame):
    """The area between two lane ends along two passes that follow each other; None where it is too long or there is no way between them."""
    path, off, half = [], [], []
    for end, drive, ahead in ((left, before, True), (entered, after, False)):
        s = lanes[drive.road].s
        d, width = end.track.at(end.at)
        off.append(drive.direction * (d - drive.at_station(s[end.at:end.at + 1])[0][0]))
        half.append(width / 2)
        # from the lane to the end of its pass, or from the beginning of its pass to the lane
        to = drive.span[1 if ahead == (drive.direction > 0) else 0]
        stations = np.linspace(s[end.at], to, max(int(abs(to - s[end.at]) / STATION_STEP), 1) + 1)
        x, y = frame.roads[drive.road].to_map(stations, drive.at_station(stations)[0])
        path.append(np.c_[x, y] if ahead else np.c_[x, y][::-1])
    places = np.concatenate(path)
    places = places[np.r_[True, np.hypot(*np.diff(places, axis=0).T) > STATION_STEP / 2]]
    if len(places) < 3:
        return None
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(places, axis=0).T))]
    if not NEXT_LANE_GAP < along[-1] < LONGEST_CONNECTOR:
        return None
    share = _eased(along / along[-1])
    ahead = np.gradient(places, along, axis=0)
    across = np.c_[-ahead[:, 1], ahead[:, 0]] / np.hypot(*ahead.T)[:, None]
    middle = off[0] * (1 - share) + off[1] * share
    wide = half[0] * (1 - share) + half[1] * share
    z = left.z * (1 - share) + entered.z * share
    sides = [np.c_[places + across * (middle + side * wide)[:, None], z] for side in (1, -1)]
    start = float(lanes[before.road].s[left.at])
    d = float(left.track.at(left.at)[0])
    return _row(before.road, left.track, entered.track, sides, wide, station=start, end=start + before.direction * float(along[-1]), first=d, last=d)


def _piece_at(rows, station):
    """The row of those of a lane that ends nearest a station."""
    return min(rows, key=lambda row: min(abs(row["station"] - station), abs(row["end"] - station)))
