"""The areas of lanes between their borders, the shoulders beside them, and what follows each lane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ..common.arrays import mask_runs
from ..common.parallel import check_cancelled
from ..curves.robust import median
from ..markings.cross_section.evidence import driven_offsets
from ..markings.cross_section.roads import EstimatedRoad
from ..markings.cross_section.sections import STATION_STEP, CrossSections
from ..markings.cross_section.weights import CENTRE_LINE, CURB, EDGE_LINE, HATCHING, ISLAND, LANE_LINE, OTHER_LINE, SURFACE
from ..survey.frame.road_frame import Pass, RoadFrame
from ..survey.weights import FRAME
from .alignment import track_pieces
from .lane_track import LANE_STATUS, LaneTrack, spans_of
from .layers import Lanes
from .weights import AREAS

KIND_OF_BORDER = {LANE_LINE: "lane", CENTRE_LINE: "centre", EDGE_LINE: "edge", OTHER_LINE: "edge"}


def lane_areas(road: EstimatedRoad, curbs: CrossSections | None, tracks: list[LaneTrack], heights: list[np.ndarray], frame: RoadFrame,
               number: int, pavement: CrossSections | None = None, of_others: Sequence[LaneTrack] = ()) -> list[dict[str, Any]]:
    """The rows of Lanes of one road: its lanes by piece, connectors along the drive where lanes end and begin again, and shoulders.

    `curbs`, `pavement` : edges of the pavement with and without a curb that were given to the estimate, or None. Lanes are numbered from 1 in the
    order of the tracks; `heights` : local z along each; `of_others` : lanes on the asphalt of this road that others have.
    """
    rows, borders = [], [_sides(road, track, z, frame, number) for track, z in zip(tracks, heights)]
    for lane, (track, sides) in enumerate(zip(tracks, borders), start=1):
        check_cancelled()
        for code, start, end in track_pieces(track, road.lines.s):
            part = slice(*np.searchsorted(road.lines.s[track.first:track.last + 1], [start, end + STATION_STEP / 2]))
            if part.stop - part.start >= 2:
                rows.append(_area(road, curbs, track, part, sides, number) | dict(lane=lane, status=LANE_STATUS[code]))
    rows += _connectors_on_road(road.lines.s, tracks, heights, frame, number)
    if pavement is not None:
        lanes = max((row["lane"] for row in rows), default=0)
        strips = shoulders(road, tracks, borders, pavement, frame, number, of_others)
        rows += [row | dict(lane=lane) for lane, row in enumerate(strips, start=lanes + 1)]
    names: dict[int, int] = {}
    for row in rows:
        names[row["lane"]] = names.get(row["lane"], 0) + 1
        row["lane_id"] = f"{number}.{row['lane']}.{names[row['lane']]}"
    follow(rows)
    return rows


def _sides(road, track, z, frame, number):
    """The left and the right border of a lane along the road, (N, 3) local metres each."""
    columns, sides = track.stations, []
    s, half = road.lines.s[columns], track.width / 2
    for side, row in ((1, track.left), (-1, track.right)):
        x, y = frame.roads[number].to_map(s, track.d + side * half)
        painted = (row >= 0) & (row < len(road.lines.d))
        line_z = np.where(painted, road.lines.z[np.where(painted, row, 0), columns], np.nan) if len(road.lines.d) else np.full(len(s), np.nan)
        sides.append(np.c_[x, y, np.where(np.isfinite(line_z), line_z, z)])
    return sides


def _area(road, curbs, track, part, sides, number):
    """One piece of a lane, of which `sides` are those of the whole: its borders as they are seen in the direction of travel."""
    columns = np.arange(track.first, track.last + 1)[part]
    s, d = road.lines.s[columns], track.d[part]
    borders = [_border(road, curbs, rows[part], uses[part], columns)
               for rows, uses in ((track.left, track.left_use), (track.right, track.right_use))]
    sides = [side[part] for side in sides]
    if track.direction < 0:
        sides, borders = [side[::-1] for side in sides[::-1]], borders[::-1]
    return dict(road=number, type="driving", direction=track.direction, left=sides[0], right=sides[1], about=borders,
                **track.said(part), station=float(s[0]), end=float(s[-1]), first=float(d[0]), last=float(d[-1]),
                width=median(track.width[part]))


def _border(road, curbs, rows, separates, columns):
    """What a border of a piece is along most of it: line, kind and pattern."""
    row = int(np.bincount(rows + 1).argmax()) - 1
    if row < 0:
        return NO_BORDER
    made_of = road.boundaries.made_of[row]
    if road.boundaries.painted[row]:
        drawn, uses = road.lines.drawn[row, columns], separates[(rows == row) & (separates >= 0)]
        pattern = road.lines.names[_usual(drawn)] if (drawn >= 0).any() else road.lines.patterns[row]
        return f"line {_usual(road.lines.number[row, columns])}", KIND_OF_BORDER.get(_usual(uses) if len(uses) else EDGE_LINE), pattern
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
        tip, d = (row["end"], row["last"]) if way > 0 else (row["station"], row["first"])
        (stations, of), reach = begins[way], AREAS.next_lane_gap + STATION_STEP
        candidates = [rows[k] for k in sorted(of[slice(*np.searchsorted(stations, [tip - reach, tip + reach]))])]
        row["successors"] = tuple(
            candidate["lane_id"] for candidate in candidates if candidate is not row
            and -STATION_STEP <= way * ((candidate["station"] if way > 0 else candidate["end"]) - tip) <= AREAS.next_lane_gap
            and abs((candidate["first"] if way > 0 else candidate["last"]) - d) < max(row["width"], candidate["width"]) / 2)


def follow_over_roads(rows: list[dict[str, Any]]) -> None:
    """Name also what follows a lane that goes on as a lane of another road right where it ends, as one of which two roads have a part each."""
    lanes = [row for row in rows if row["type"] == "driving"]
    if not lanes:
        return
    begins, tips = ([_tip(row, *at) for row in lanes] for at in ((0, 1), (-1, -2)))
    near = cKDTree([place for place, _ in begins]).query_ball_point([place for place, _ in tips], AREAS.next_lane_gap)
    for row, (end, back), following in zip(lanes, tips, near):
        names = []
        for k in sorted(following):
            begin, ahead = begins[k]
            across = abs(back[0] * (begin - end)[1] - back[1] * (begin - end)[0])
            along = -back @ ahead > np.cos(FRAME.parallel_angle)
            if along and lanes[k]["road"] != row["road"] and across < max(row["width"], lanes[k]["width"]) / 2:
                names.append(lanes[k]["lane_id"])
        row["successors"] = row["successors"] or tuple(names)


def _tip(row, tip, beside):
    """The middle of a lane at one of its vertices, and the unit vector from there to the middle at another one."""
    place, onward = ((row["left"][k] + row["right"][k])[:2] / 2 for k in (tip, beside))
    return place, (onward - place) / max(np.hypot(*(onward - place)), 1e-9)


def _begins(rows, way):
    """Stations, ascending, at which the lanes of a direction begin, and the rows they are of."""
    of = [k for k, row in enumerate(rows) if row["direction"] == way]
    stations = np.array([rows[k]["station" if way > 0 else "end"] for k in of], float)
    order = np.argsort(stations, kind="stable")
    return stations[order], np.array(of, int)[order].tolist()


def make_lanes(rows: list[dict[str, Any]], crs: str) -> Lanes:
    """Lanes of the rows of all roads."""
    borders = [dict(zip(("left_line", "left_kind", "left_pattern", "right_line", "right_kind", "right_pattern"), (*left[:3], *right[:3])))
               for left, right in (row["about"] for row in rows)]
    return Lanes.of_pieces([{**row, **border} for row, border in zip(rows, borders)], crs)


# Shoulders: the paved strips between the edge line of the outermost lane and the edge of the pavement.

STRIP_WIDTH = 0.3, 4.0   # source: m of a strip at any place: the widest paved shoulders are 12 ft (AASHTO, A Policy on Geometric Design, 4.4.2)


def shoulders(road: EstimatedRoad, tracks: list[LaneTrack], borders: list[list[np.ndarray]], pavement: CrossSections, frame: RoadFrame,
              number: int, of_others: Sequence[LaneTrack] = ()) -> list[dict[str, Any]]:
    """Rows of Lanes without numbers between the edge lines of lanes and the edges of the pavement beside them, with the vertices of the lane beside.

    Where a curb bounds the road the strip beside the line may be for parking, cycling or nothing, so it is not named.
    `borders` : the left and the right border of each track along the road, (N, 3) local m; `pavement` : edges of the pavement without a curb.
    """
    s, lines = road.lines.s, road.lines
    shift = int(np.rint((s[0] - pavement.s[0]) / STATION_STEP))   # stations by which the grid of the lines begins behind that of the pavement
    there = [*tracks, *of_others]
    rows, spans = [], spans_of(there)
    for track, (left, right) in zip(tracks, borders):
        columns = np.arange(track.first, track.last + 1)
        for sign, line_row, use, border in ((1, track.left, track.left_use, left), (-1, track.right, track.right_use, right)):
            inner = track.d + sign * track.width / 2
            nearest, width = _nearest_edge(pavement, columns[0] + shift, inner, sign)
            neighbours = [there[k] for k in spans.near(track.first, track.last).tolist()]
            wide = np.isfinite(width) & (use == EDGE_LINE) & (line_row >= 0) & (line_row < len(lines.d)) & ~_taken(neighbours, track, inner, sign)
            for a, b in mask_runs(wide):
                if (b - a - 1) * STATION_STEP < AREAS.shortest_shoulder or np.median(width[a:b]) < AREAS.least_shoulder:
                    continue
                part, edge = slice(a, b), nearest[a:b]
                stations = columns[part] + shift
                x, y = frame.roads[number].to_map(s[columns[part]], inner[part] + sign * width[part])
                z = pavement.z[edge, stations]
                outer = np.c_[x, y, np.where(np.isfinite(z), z, border[part, 2])]
                is_seen = bool(pavement.seen[edge, stations].mean() > 0.5)
                middle = inner[part] + sign * width[part] / 2
                drawn = lines.drawn[line_row[part], columns[part]]
                described = [(f"line {_usual(lines.number[line_row[part], columns[part]])}", "edge", lines.names[_usual(drawn)]),
                             (f"edge {_usual(pavement.number[edge, stations])}", "pavement", "")]
                strip = [border[part], outer]
                rows.append(dict(
                    road=number, type="shoulder", direction=0, left=strip[sign > 0], right=strip[sign < 0], about=described[::-sign],
                    status="measured" if is_seen else "inferred", confidence=float(track.confidence[part].mean()), station=float(s[columns[a]]),
                    end=float(s[columns[b - 1]]), first=float(middle[0]), last=float(middle[-1]), width=float(np.median(width[part]))))
    return rows


def _nearest_edge(pavement, first, inner, sign):
    """Which edge of the pavement lies nearest beside a border, (N,) m from station `first` on, and how far, m; inf where none does."""
    nearest, width = np.zeros(len(inner), int), np.full(len(inner), np.inf)
    spans = pavement.d.spans
    for row in spans.near(int(first), int(first) + len(inner) - 1).tolist():
        window = slice(max(int(spans.first[row] - first), 0), min(int(spans.end[row] - first), len(inner)))
        offset = sign * (pavement.d[row, window.start + first:window.stop + first] - inner[window])
        nearer = (offset >= STRIP_WIDTH[0]) & (offset <= STRIP_WIDTH[1]) & (offset < width[window])
        nearest[window], width[window] = np.where(nearer, row, nearest[window]), np.where(nearer, offset, width[window])
    return nearest, width


def _usual(numbers):
    """The most frequent of some numbers, those below 0 left out; 0 where there are no others."""
    valid = numbers[numbers >= 0]
    return int(np.bincount(valid).argmax()) if len(valid) else 0


def _taken(tracks, track, inner, sign):
    """(N,) bool, where another lane lies on the far side of a border of this one."""
    result = np.zeros(len(track), bool)
    for other in tracks:
        a, b = max(track.first, other.first), min(track.last, other.last)
        if other is track or a > b:
            continue
        of_own, of_other = slice(a - track.first, b - track.first + 1), slice(a - other.first, b - other.first + 1)
        apart = sign * (other.d[of_other] - inner[of_own])
        result[of_own] |= (apart > 0) & (apart < STRIP_WIDTH[1] + other.width[of_other] / 2)
    return result


# Connectors: where the vehicle drove on from the end of a lane to the beginning of the next, over a junction or from one road to another.

NO_BORDER = "none", "none", ""        # line, kind and pattern


def _connectors_on_road(s: np.ndarray, tracks: list[LaneTrack], heights: list[np.ndarray], frame: RoadFrame, number: int) -> list[dict[str, Any]]:
    """Rows of Lanes along the drive from the end of a lane to the beginning of the next one of its direction on the same road."""
    driven, directions = driven_offsets(frame, number, s)
    rows: list[dict[str, Any]] = []
    for way in (1, -1):
        ends, begins = ([_LaneEnd.of(lane, track, z, last) for lane, (track, z) in enumerate(zip(tracks, heights), start=1) if track.direction == way]
                        for last in (way > 0, way < 0))
        for left in ends:
            gap = way * STATION_STEP * np.array([begin.at - left.at for begin in begins])
            ahead = [begins[k] for k in np.argsort(gap, kind="stable").tolist() if AREAS.next_lane_gap < gap[k] < AREAS.longest_connector]
            for p in np.flatnonzero(directions == way).tolist():
                entered = next((begin for begin in ahead if begin.holds(driven[p, begin.at])), None)
                if entered is None or not left.holds(driven[p, left.at]):
                    continue
                columns = np.arange(left.at, entered.at + way, way)
                if np.isfinite(driven[p, columns]).all():
                    points = np.column_stack(frame.roads[number].to_map(s[columns], driven[p, columns]))
                    (station, first), (end, last) = sorted((float(s[of.at]), of.d) for of in (left, entered))
                    rows.append(_connector(number, points, (left, entered), [way * (of.d - driven[p, of.at]) for of in (left, entered)])
                                | dict(lane=len(tracks) + len(rows) + 1, station=station, end=end, first=first, last=last))
                    break
    return rows


def _connector(road, points, ends, offsets):
    """The row of Lanes from one _LaneEnd to another along (N, 2) points, from which their middles lie `offsets`, m, to the left."""
    chainage = np.r_[0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T))]
    # it begins and ends without a slope: no border turns at once where the lane ends
    share = np.clip(chainage / max(chainage[-1], 1e-9), 0.0, 1.0)
    share = share**2 * (3 - 2 * share)
    ahead = np.gradient(points, axis=0)
    normal = np.c_[-ahead[:, 1], ahead[:, 0]] / np.hypot(*ahead.T)[:, None]
    middle, half, z = (before * (1 - share) + after * share for before, after in (offsets, [end.width / 2 for end in ends], [end.z for end in ends]))
    left, right = (np.c_[points + normal * (middle + side * half)[:, None], z] for side in (1, -1))
    return dict(road=road, type="connector", direction=ends[0].track.direction, left=left, right=right, about=[NO_BORDER, NO_BORDER],
                confidence=AREAS.connector_confidence * float(min(end.track.confidence.mean() for end in ends)), status="inferred",
                width=float(np.median(2 * half)))


class RoadLanes(NamedTuple):
    """The lanes of one road: stations of its grid, LaneTracks and local z along each."""

    s: np.ndarray
    tracks: list[LaneTrack]
    heights: list[np.ndarray]


class _LaneEnd(NamedTuple):
    """Where a lane begins or ends: its number, its track, the station of the grid, and offset, width and local z there."""

    lane: int
    track: LaneTrack
    at: int
    d: float
    width: float
    z: float

    @classmethod
    def of(cls, lane: int, track: LaneTrack, z: np.ndarray, last: bool) -> _LaneEnd:
        """The one at the last station of a lane, or at its first."""
        at = track.last if last else track.first
        return cls(lane, track, at, *track.at(at), float(z[-1 if last else 0]))

    def holds(self, d: float) -> bool:
        """Whether a pass at an offset is in the lane."""
        return abs(d - self.d) < self.width / 2


def connectors_between_roads(lanes: dict[int, RoadLanes], frame: RoadFrame, rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of Lanes along the drive from the end of a lane of one road to the beginning of a lane of another, as where the vehicle turned.

    Each is of the road that is left, and names the piece of lane that it leads to; among `rows`, `successors` of the lane that is left name it.
    """
    turns: dict[tuple[int, int, int, int], dict[str, Any]] = {}
    rows_of: dict[int, dict[int, list[dict[str, Any]]]] = {}   # by road and lane
    for row in rows:
        rows_of.setdefault(row["road"], {}).setdefault(row["lane"], []).append(row)
    for before, after in zip(frame.passes[:-1], frame.passes[1:]):
        follows = 0 <= after.time[0] - before.time[-1] <= AREAS.driven_on
        if not follows or before.road == after.road or before.road not in lanes or after.road not in lanes:
            continue
        left, entered = _lane_end(lanes[before.road], before, leaving=True), _lane_end(lanes[after.road], after, leaving=False)
        if left is None or entered is None or (key := (before.road, left.lane, after.road, entered.lane)) in turns:
            continue
        area = _turn(left, entered, before, after, lanes, frame)
        if area is None:
            continue
        number = 1 + max(rows_of[before.road])
        area.update(lane=number, lane_id=f"{before.road}.{number}.1",
                    successors=(_piece_at(rows_of[after.road][entered.lane], lanes[after.road].s[entered.at])["lane_id"],))
        piece = _piece_at(rows_of[before.road][left.lane], lanes[before.road].s[left.at])
        piece["successors"] += (area["lane_id"],)
        turns[key] = area
        rows_of[before.road][number] = [area]
    return list(turns.values())


def _lane_end(lanes: RoadLanes, drive: Pass, leaving: bool) -> _LaneEnd | None:
    """The last lane of its direction at whose end a pass is in it, or the first at whose beginning it is."""
    (first, last), at_last = drive.span, leaving == (drive.direction > 0)
    ends = [_LaneEnd.of(lane, track, z, at_last) for lane, (track, z) in enumerate(zip(lanes.tracks, lanes.heights), start=1)
            if track.direction == drive.direction]
    ends = [end for end in ends if first <= lanes.s[end.at] <= last and end.holds(drive.at_station(lanes.s[end.at:end.at + 1])[0][0])]
    if not ends:
        return None
    return (max if at_last else min)(ends, key=lambda end: end.at)


def _turn(left, entered, before, after, lanes, frame):
    """The area between two lane ends along two passes that follow each other; None where it is too long or there is no way between them."""
    path, offsets = [], []
    for end, drive, ahead in ((left, before, True), (entered, after, False)):
        s = lanes[drive.road].s
        offsets.append(drive.direction * (end.d - drive.at_station(s[end.at:end.at + 1])[0][0]))
        # from the lane to the end of its pass, or from the beginning of its pass to the lane
        to = drive.span[1 if ahead == (drive.direction > 0) else 0]
        stations = np.linspace(s[end.at], to, max(int(abs(to - s[end.at]) / STATION_STEP), 1) + 1)
        x, y = frame.roads[drive.road].to_map(stations, drive.at_station(stations)[0])
        path.append(np.c_[x, y] if ahead else np.c_[x, y][::-1])
    points = np.concatenate(path)
    points = points[np.r_[True, np.hypot(*np.diff(points, axis=0).T) > STATION_STEP / 2]]
    length = float(np.hypot(*np.diff(points, axis=0).T).sum())
    if len(points) < 3 or not AREAS.next_lane_gap < length < AREAS.longest_connector:
        return None
    start = float(lanes[before.road].s[left.at])
    return _connector(before.road, points, (left, entered), offsets) | dict(
        station=start, end=start + before.direction * length, first=left.d, last=left.d)


def _piece_at(rows, station):
    """The row of those of a lane that ends nearest a station."""
    return min(rows, key=lambda row: min(abs(row["station"] - station), abs(row["end"] - station)))
