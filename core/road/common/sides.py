"""The two sides of a road: points in profiles from the driven tracks outward, section by section."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ...common.arrays import members_of
from ...survey.frame.road_frame import RoadFrame
from ...survey.open_survey import Survey
from ...survey.store.records import Points
from ..weights import CURBS
from .curb_limits import CurbSettings
from .curb_points import CurbPoints, curb_points_at
from .decimation import PointDecimation, limit_points_per_cell
from .occlusion import OcclusionGrid
from .pseudo_scanlines import PseudoScanLines, cells_of_points, expand_ranges, nearest_distance, profiles_of_cells

SIDE_SIGNS = {"left": 1, "right": -1}   # derived: side -> sign of its offsets


class OutermostTrack:
    """Outward offset of the outermost driven track on one side. sign : of the side's offsets"""

    def __init__(self, frame: RoadFrame, road: int, sign: int):
        self.passes, self.sign = frame.passes_of(road), sign

    def __call__(self, s: np.ndarray) -> np.ndarray:
        """Offsets, m, at stations s, m; both of one shape. 0 where no pass drove."""
        s = np.asarray(s, float)
        offsets = np.full(s.shape, -np.inf)
        for p in self.passes:
            first, last = p.span
            inside = (s >= first - 5.0) & (s <= last + 5.0)
            offsets = np.where(inside, np.maximum(offsets, self.sign * p.at_station(s)[0]), offsets)
        return np.where(np.isfinite(offsets), offsets, 0.0)


def work_sections(survey: Survey, road: int, width: float) -> list[tuple[int, int]]:
    """(first, last + 1) profile numbers of the sections of a road, about CURBS.work_section_length each; `width` is m of road per profile."""
    start, end = survey.store.span(road)
    return fixed_sections(int(np.floor(start / width)), int(np.ceil(end / width)), width)


def fixed_sections(first: int, last: int, width: float) -> list[tuple[int, int]]:
    """Profiles or planes of a road in sections that are cut from station 0, so that two surveys with the same stations have the same ones.

    first, last : number of the first one, and of the last one + 1
    width : m from one to the next

    Returns a list of (first, last + 1), each about CURBS.work_section_length long, those at the ends between half of that and one and a half
    """
    length = max(int(round(CURBS.work_section_length / width)), 1)
    cuts = np.arange(first // length + 1, -(-last // length)) * length
    bounds = np.r_[first, cuts[(cuts - first >= length / 2) & (last - cuts >= length / 2)], last]
    return [(int(a), int(b)) for a, b in zip(bounds[:-1], bounds[1:])]


def join_sections(parts: Sequence[tuple[Mapping[str, Any], Mapping[str, OcclusionGrid]]]) -> tuple[dict[str, Any], dict[str, OcclusionGrid]]:
    """What the phases of profiles and scanlines find in a section, from what they find in parts of it that follow each other."""
    steps, grids = ({side: [part[side] for part in column if side in part] for side in SIDE_SIGNS} for column in zip(*parts))
    return {side: type(of_side[0]).join(of_side) for side, of_side in steps.items() if of_side}, \
        {side: OcclusionGrid.join(of_side) for side, of_side in grids.items()}


def side_profiles(decimation: PointDecimation, road: int, section: tuple[int, int], tracks: Mapping[str, OutermostTrack],
                  settings: CurbSettings, points_per_cell: int | None = CURBS.points_per_level_cell,
                  ) -> Iterator[tuple[str, int, tuple[np.ndarray, ...], PseudoScanLines]]:
    """Profiles of one section, separately for each side and pass.

    section : (first, last + 1) profile numbers
    tracks : side -> OutermostTrack
    points_per_cell : see `PointDecimation.decimated_points`; None uses all points, up to CURBS.points_per_uneven_cell of a cell

    Yields side, pass number, (u, s, h) of the tall points (each (N,) m), PseudoScanLines
    """
    survey, width, spacing = decimation.survey, decimation.width, decimation.spacing
    stations = (np.arange(*section) + 0.5) * width
    origins = {side: np.floor(tracks[side](stations).min()) for side in SIDE_SIGNS}
    cells = {side: max(int(np.ceil((CURBS.max_curb_offset - origins[side]) / spacing)), 1) for side in SIDE_SIGNS}
    ground: dict = {}
    tall: dict = {}
    for block in decimation.decimated_points(road, section, points_per_cell):
        s, d = block.s, block.d
        if not len(s):
            continue
        along = ahead_of_vehicle(survey, block, s)
        near = np.abs(along) < CURBS.max_look_along + np.abs(d)
        h = block.z - expected_height(survey, road, s)
        for side, sign in SIDE_SIGNS.items():
            u = sign * d
            for number, rows in members_of(np.where(near & (u > origins[side]) & (u < CURBS.max_curb_offset), block.pass_number, np.int32(-1))):
                inside, cell = cells_of_points(u, s, h, rows, section, cells[side], width, spacing, origins[side])
                if points_per_cell is None:
                    selected = limit_points_per_cell(cell)
                    inside, cell = inside[selected], cell[selected]
                ground.setdefault((side, number), []).append([*(v.take(inside) for v in (u, s, h, along)), cell])
                high = rows[h.take(rows) > CURBS.min_occluder_height]
                tall.setdefault((side, number), []).append([v.take(high) for v in (u, s, h)])
    for side, number in sorted(ground, key=lambda key: (list(SIDE_SIGNS).index(key[0]), key[1])):
        *points, cell = (np.concatenate(column) for column in zip(*ground[side, number]))
        lines = profiles_of_cells(points, cell, section, cells[side], width, spacing, settings.layer_jump, origins[side])
        yield side, number, tuple(np.concatenate(column) for column in zip(*tall[side, number])), lines


def expected_height(survey: Any, road: int, s: np.ndarray) -> np.ndarray:
    """(N,) m, local z at which the road is expected at (N,) stations, interpolated between nodes CURBS.height_node_spacing apart.

    `survey` is a Survey, or whatever else has `road_height`.
    """
    if not len(s):
        return np.empty(0)
    first = int(np.floor(np.min(s) / CURBS.height_node_spacing))
    last = int(np.floor(np.max(s) / CURBS.height_node_spacing)) + 1
    nodes = survey.road_height(road, np.arange(first, last + 1) * CURBS.height_node_spacing)
    position = s * (1.0 / CURBS.height_node_spacing)
    position -= first
    k = position.astype(np.intp)
    position -= k
    h = nodes.take(k)
    h += position * np.diff(nodes).take(k)
    return h


def ahead_of_vehicle(survey: Survey, points: Points, s: np.ndarray) -> np.ndarray:
    """Distance along the road from the vehicle to the points when they were measured.

    A point far ahead or behind is seen at a grazing angle and carries the drift of the
    positions since; a spinning scanner sees every place from both sides.

    points : N Points
    s : (N,) m, their stations

    Returns (N,) m, positive ahead; 0 for surveys without times
    """
    if not survey.has_time or not len(points):
        return np.zeros(len(points))
    numbers = points.pass_number
    if numbers.min() == numbers.max():
        return s - survey.frame.passes[int(numbers[0])].station_at(points.time)
    along, time = np.empty(len(points)), points.time
    for number in np.flatnonzero(np.bincount(numbers)):
        rows = np.flatnonzero(numbers == number)
        along[rows] = s[rows] - survey.frame.passes[number].station_at(time.take(rows))
    return along


# Hidden curb: places in the gaps of a main curb where something stands in front of it.


def hidden_points(measured: np.ndarray, occlusion: OcclusionGrid, track: OutermostTrack) -> list[dict]:
    """Places in the gaps between curb points where something hides the curb.

    measured : (N, 3) m, station, outward offset and height of the measured points above the expected road
    occlusion : OcclusionGrid of the side
    track : OutermostTrack of the side

    Returns a list of dict: s, u, h as above, and `fields`, what else is known of the point
    """
    if len(measured) < 2:
        return []
    measured = measured[np.argsort(measured[:, 0], kind="stable")]
    start, end = measured[:-1, 0], measured[1:, 0]
    wide = (end - start <= CURBS.max_line_gap) & (end - start > CURBS.min_hidden_gap)
    # counted from the gap's own ends: where station 0 lies does not matter
    parts = np.where(wide, np.rint((end - start) / CURBS.hidden_point_spacing), 0).astype(np.int64)
    gap, number = expand_ranges(np.zeros(len(parts), np.int64), parts)
    s = start[gap] + (number + 0.5) * ((end - start) / np.maximum(parts, 1))[gap]
    u, h = (np.interp(s, measured[:, 0], measured[:, k]) for k in (1, 2))
    hidden = occlusion.hidden(s, u, h, track(s))
    return [dict(s=float(a), u=float(b), h=float(c), fields=dict(status="occluded", part="bottom"))
            for a, b, c in zip(s[hidden], u[hidden], h[hidden])]


def hidden_beside(pieces: CurbPoints, main: Mapping[str, np.ndarray], beside: Mapping[str, OcclusionGrid], survey: Survey, road: int) -> CurbPoints:
    """Hidden places in the gaps next to pieces of main curb that were found later than the others.

    pieces : CurbPoints of the main curb of one road, found later
    main : side -> (M, 4) points of the main curb that were known before: station, offset, height above the expected road in m, and
        1 where it was measured and 0 where it is hidden
    beside : side -> OcclusionGrid of the road

    Returns CurbPoints of status occluded; none where a place is known to be hidden already
    """
    result = [CurbPoints.filled(0, pieces.crs)]
    for side, sign in SIDE_SIGNS.items():
        of_side = pieces[pieces.side == side]
        if not len(of_side) or side not in beside:
            continue
        later = np.c_[of_side.station, sign * of_side.offset, of_side.z - expected_height(survey, road, of_side.station)]
        main_curb = main[side] * (1, sign, 1, 1)
        measured = np.concatenate([later, main_curb[main_curb[:, 3] > 0, :3]])
        order, rows = np.argsort(measured[:, 0], kind="stable"), hidden_points(measured, beside[side], OutermostTrack(survey.frame, road, sign))
        s = np.array([row["s"] for row in rows])
        k = np.searchsorted(measured[order, 0], s)
        new = ((order[k - 1] < len(later)) | (order[k] < len(later))) \
            & (nearest_distance(s, main_curb[main_curb[:, 3] == 0, 0]) > 0.5 * CURBS.hidden_point_spacing)
        result.append(points_of_rows(survey, road, side, [rows[number] for number in np.flatnonzero(new)]))
    return CurbPoints.join(result, pieces.crs)


def points_of_rows(source: Any, road: int, side: str, rows: Sequence[dict], crs: str = "") -> CurbPoints:
    """CurbPoints from dicts of s, u, h in m and `fields`, as of `hidden_points`; `source` : what has `frame` and `road_height`."""
    s, u, h = (np.array([row[name] for row in rows], float) for name in ("s", "u", "h"))
    d = SIDE_SIGNS[side] * u
    places = source.frame.to_map(road, s, d, h + expected_height(source, road, s))
    return curb_points_at(source.frame, road, places, [row["fields"] for row in rows], crs, side=side, station=s, offset=d)
