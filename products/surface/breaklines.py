"""Breaklines: lines along which the ground bends or steps, with the heights that were measured there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from ...core.common.arrays import mask_runs
from ...core.common.progress import Progress
from ...core.driving.layers import Lanes
from ...core.survey.frame.placement import FrameLines, line_parts, lines_in_frame
from ...core.survey.frame.road_frame import RoadFrame
from ...core.survey.survey import Survey
from ..inventory.borders import BorderLayers
from ..inventory.roadside.uprights import lowest_along
from ..inventory.surface_grid import CROSS_CELL, SLICE_LENGTH, smoothed
from .ground import RoadGround, edge_profiles, medians

# In the order of their weight: where two run beside each other, the triangulation follows the first
KINDS = ("edge_bottom", "edge_top", "gutter_flow_line", "crown", "lane_border")
HIDDEN_LENGTH = 3.0     # m along a line that may be hidden and are drawn straight
MIN_LENGTH = 5.0        # m of a crown or gutter
FOOT, PLATEAU = (-0.30, -0.05), (0.20, 0.50)   # m from an edge, outward: the road and the ground behind the curb that tell the heights of both
RISE = 0.85             # share of a curb's height that its face has reached where its top begins
MAX_LEAP = 0.03         # m between a height and the median of those along a line about it: more comes of something that stands there
MIN_STEP = 0.015        # m: a lower step has no top that would be told from its foot
MOST_ASIDE = 0.25       # m that a place of a gutter or crown lies aside of the median of those about it at most
CROWN_FALL = 0.004      # m/m by which the road falls to either side of a crown at least
CROWN_INSIDE = 1.0      # m from the edges, within which there is no crown
CROWN_SLICES = 9        # slices whose profiles are averaged for a crown


@dataclass(frozen=True)
class Breakline:
    kind: str   # one of KINDS
    road: int
    places: np.ndarray   # (N, 3) local m
    station: tuple[float, float]   # m along the road, least and greatest
    sigma: float   # m, of its heights
    step: float = np.nan   # m that an edge_top lies above its edge_bottom


def lines_to_follow(layers: BorderLayers, frame: RoadFrame) -> tuple[FrameLines, FrameLines]:
    """Edges, and borders of lanes or else marking lines, with vertices about a slice apart."""
    if layers.lanes is None:
        return _even(_parts_of(layers.edges), frame), _even(_parts_of(layers.marking_lines), frame)
    lanes = Lanes.from_features(layers.lanes)
    # borders of lanes, each once
    borders = {min(border.tobytes(), border[::-1].tobytes()): (shapely.linestrings(border), lanes.road[k]) for k in range(len(lanes))
               if lanes.type[k] != "connector" for border in lanes.borders(k)}
    return _even(_parts_of(layers.edges), frame), _even(list(zip(*borders.values())) or ([], []), frame)


def road_breaklines(survey: Survey, ground: RoadGround, edges: FrameLines, borders: FrameLines,
                    progress: Progress = Progress()) -> list[Breakline]:
    """The breaklines of a road: feet and tops of its edges, gutters, crown and borders of lanes; nothing where the ground was not seen.

    edges, borders : of all roads, as `lines_to_follow` gives them
    """
    frame = survey.frame
    result = list(_edges(survey, ground, edges[edges.road == ground.road], progress))
    for side in (1, -1):
        result += _along("gutter_flow_line", ground, frame, *_gutter(ground, side))
    result += _along("crown", ground, frame, *_crown(ground))
    lines = borders[borders.road == ground.road]
    z, sigma = ground.at(lines.s, lines.d), ground.at(lines.s, lines.d, ground.sigma)
    # a lane that ends at the curb ends at the edge's own line
    followed = shapely.union_all([shapely.linestrings(line.places[:, :2]) for line in result if line.kind.startswith("edge")])
    z[shapely.dwithin(shapely.points(lines.x, lines.y), followed, 2 * CROSS_CELL)] = np.nan
    for k in range(len(lines)):
        part = lines.line(k)
        result += _pieces("lane_border", ground.road, np.stack([lines.x[part], lines.y[part], z[part]], axis=1), lines.s[part], sigma[part])
    return result


def _parts_of(layer):
    """(lines in map coordinates, road of each) of a layer of lines, each once, as neighbouring surveys may both have one; tops of curbs are
    measured, not taken from it."""
    if layer is None:
        return [], []
    members = [(part, layer.rows[row]) for part, row in zip(*line_parts(layer.geometries)) if layer.rows[row].get("part") != "top"]
    parts, length = [part for part, _ in members], [part.length for part, _ in members]
    covered, by = shapely.STRtree(shapely.buffer(parts, CROSS_CELL)).query(parts, predicate="covered_by") if parts else ((), ())
    twice = {k for k, other in zip(covered, by) if (length[other], other) > (length[k], k)}
    kept = [(part, -1 if row.get("road") is None else int(row["road"])) for k, (part, row) in enumerate(members) if k not in twice]
    return [part for part, _ in kept], [road for _, road in kept]


def _even(lines_and_roads, frame):
    """FrameLines with vertices a slice apart."""
    shapes, roads = lines_and_roads
    even = [shapely.linestrings(shapely.get_coordinates(shapely.line_interpolate_point(
        shape, np.linspace(0.0, 1.0, max(int(round(shape.length / SLICE_LENGTH)), 2) + 1), normalized=True), include_z=True)) for shape in shapes]
    return lines_in_frame(even, roads, frame, None)


def _edges(survey, ground, lines, progress):
    """Foot and top of every edge. Which side is the higher one is measured, so that it does not matter which way a line was drawn."""
    u, z, normal = edge_profiles(survey, ground, lines, progress)
    higher = np.nan_to_num(_line(u, z, PLATEAU)[0] - _line(-u, z, PLATEAU)[0]) < 0
    z = np.where(higher[:, None], z[:, ::-1], z)
    foot, slope, noise = _line(u, z, FOOT)
    rise = z - foot[:, None] - slope[:, None] * u
    top_z, top_slope, top_noise = _line(u, z, PLATEAU)
    step = np.concatenate([np.empty(0), *(_running_median((top_z - foot)[lines.line(k)]) for k in range(len(lines)))])
    reached = (rise >= RISE * step[:, None]) & (u > 0)
    j = np.maximum(reached.argmax(axis=1), 1)
    rows = np.arange(len(z))
    before, after = rise[rows, j - 1], rise[rows, j]
    share = np.clip(np.nan_to_num((RISE * step - before) / np.maximum(after - before, 1e-9), nan=1.0), 0.0, 1.0)
    width = np.maximum(u[j] - CROSS_CELL * (1.0 - share), CROSS_CELL / 2)
    stepped = (step > np.maximum(MIN_STEP, 3 * np.hypot(noise, top_noise))) & reached.any(axis=1)
    outward = np.where(higher, -1.0, 1.0)[:, None] * normal
    tops = np.where(stepped, top_z + top_slope * width, np.nan)
    for k in range(len(lines)):
        part = lines.line(k)
        xy = np.stack([lines.x[part], lines.y[part]], axis=1)
        yield from _pieces("edge_bottom", ground.road, np.c_[xy, foot[part]], lines.s[part], noise[part])
        top = np.c_[xy + outward[part] * width[part, None], tops[part]]
        yield from _pieces("edge_top", ground.road, top, lines.s[part], top_noise[part], step[part])


def _line(u, z, reach):
    """(level at u = 0, slope, sigma of the level), (V,) each, of the straight lines through the cells of (V, K) profiles within a reach."""
    inside = (u > reach[0]) & (u < reach[1]) & np.isfinite(z)
    n = inside.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean_u, mean_z = (np.where(inside, values, 0.0).sum(axis=1) / n for values in (u, z))
        off = np.where(inside, u - mean_u[:, None], 0.0)
        spread = (off**2).sum(axis=1)
        slope = (off * np.where(inside, z, 0.0)).sum(axis=1) / spread
        residual = np.where(inside, z - mean_z[:, None] - slope[:, None] * off, 0.0)
        noise = np.sqrt((residual**2).sum(axis=1) / np.maximum(n - 2, 1)) * np.sqrt(1.0 / n + mean_u**2 / spread)
    return tuple(np.where(n > 2, values, np.nan) for values in (mean_z - slope * mean_u, slope, noise))


def _gutter(ground, side):
    """(offsets, heights, sigmas), (I,) each, of where water runs along the edge of a side."""
    edge = ground.left if side > 0 else ground.right
    rows, columns, _ = lowest_along(smoothed(ground.z), side * (ground.d - edge[:, None]))
    d, z, sigma = np.full((3, len(ground.s)), np.nan)
    d[rows], z[rows], sigma[rows] = ground.d[columns], ground.z[rows, columns], ground.sigma[rows, columns]
    return d, z, sigma


def _crown(ground):
    """The same of the line from which the road falls to both sides: where the straight lines through both sides meet."""
    count = len(ground.s)
    d, z, sigma = np.full((3, count), np.nan)
    padded = np.pad(ground.z - ground.level[:, None], ((CROWN_SLICES // 2, CROWN_SLICES // 2), (0, 0)), constant_values=np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(padded, CROWN_SLICES, axis=0)
    for i in range(count):
        seen = np.isfinite(windows[i])
        profile = np.where(seen, windows[i], 0.0).sum(axis=1) / np.maximum(seen.sum(axis=1), 1)
        # a slice more or less at one place would lift it by the grade of the road
        inside = (seen.sum(axis=1) == seen.sum(axis=1).max()) & (ground.d > ground.right[i] + 0.3) & (ground.d < ground.left[i] - 0.3)
        x, heights = ground.d[inside], profile[inside]
        if len(x) * CROSS_CELL < 2 * CROWN_INSIDE + 1.0:
            continue
        apex = _hinge(x, heights)
        if apex is not None and ground.right[i] + CROWN_INSIDE < apex[0] < ground.left[i] - CROWN_INSIDE:
            d[i], z[i], sigma[i] = apex[0], apex[1] + ground.level[i], apex[2]
    return d, z, sigma


def _hinge(x, heights):
    """(offset, height, sigma) of the ridge of the two straight lines, joined end to end, that follow a profile best; None where it has none."""
    places = np.arange(x[0] + CROWN_INSIDE / 2, x[-1] - CROWN_INSIDE / 2, 2 * CROSS_CELL)
    if not len(places):
        return None
    away = x - places[:, None]
    lines = np.stack([np.ones_like(away), away, np.abs(away)], axis=1)
    fits = np.linalg.solve(lines @ lines.transpose(0, 2, 1), (lines @ heights)[..., None])
    squares = ((lines * fits).sum(axis=1) - heights) ** 2
    best = int(np.argmin(squares.sum(axis=1)))
    level, slope, bend = fits[best, :, 0].tolist()
    # left of the ridge the road falls outward by slope + bend < 0, right of it by slope - bend > 0
    if slope - bend < CROWN_FALL or slope + bend > -CROWN_FALL:
        return None
    return float(places[best]), level, float(np.sqrt(squares[best].sum() / max(len(x) - 3, 1)))


def _along(kind, ground, frame, d, z, sigma):
    """Lines along a road of (I,) offsets, heights and sigmas; places that leap aside of their neighbours do not count."""
    middle = _running_median(d)
    z = np.where(np.abs(d - middle) < MOST_ASIDE, z, np.nan)
    middle = np.where(np.isfinite(middle), middle, 0.0)
    x, y = frame.road(ground.road).to_map(ground.s, middle)
    pieces = _pieces(kind, ground.road, np.stack([x, y, z], axis=1), ground.s, sigma)
    return [piece for piece in pieces if piece.station[1] - piece.station[0] >= MIN_LENGTH]


def _running_median(values):
    """(N,) medians of nine neighbours without NaN; beyond its ends a line goes on as it came."""
    return medians(np.lib.stride_tricks.sliding_window_view(np.pad(values, 4, mode="reflect", reflect_type="odd"), 9))


def _pieces(kind, road, places, station, sigma, step=None):
    """The stretches of a line whose heights were measured; short gaps are drawn straight."""
    seen = np.abs(places[:, 2] - _running_median(places[:, 2])) < MAX_LEAP
    if not seen.any():
        return []
    index = np.arange(len(places))
    z = np.interp(index, index[seen], places[seen, 2])
    hidden = int(HIDDEN_LENGTH / SLICE_LENGTH)
    known = seen.copy()
    for first, end in mask_runs(~seen):
        if 0 < first and end < len(seen) and end - first <= hidden:
            known[first:end] = True
    pieces = []
    for first, end in mask_runs(known):
        if end - first > 1:
            rows = slice(first, end)
            pieces.append(Breakline(kind, road, np.c_[places[rows, :2], z[rows]], (float(np.nanmin(station[rows])), float(np.nanmax(station[rows]))),
                                    float(np.nanmedian(sigma[rows])), np.nan if step is None else float(np.nanmedian(step[rows]))))
    return pieces
