"""The points from which a trajectory is estimated: an even sample of the first returns of a survey, in order of time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import ndimage, sparse
from scipy.spatial import cKDTree

from ...common.errors import RoadExtractionError
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...curves.robust import robustly_smoothed
from ..las.parallel_reader import ParallelCloudReader
from ..las.point_fields import first_returns, scanners_of
from ..las.reader import CloudHeader
from ..las.samples import TimeSlots
from ..trajectory.time_systems import unwrap_week, wrapped_week
from ..weights import LAS, TRACK

SAMPLED_LAYERS = ("z", "point_source_id", "gps_time", "flags", "classification")  # LAZ layers that are decoded
UNKNOWN_SCANNER = 255     # derived: the last of 8 bits; number of a point whose scanner is not known
ROUNDINGS = tuple(sorted((*(10.0**-k for k in range(2, 7)), *(2.0**-k for k in range(6, 20))), reverse=True))   # derived: s, of decimals and of bits


@dataclass
class Samples:
    """Points in order of time."""

    time: np.ndarray   # (N,) seconds since `start`, of the drives; zeros without time
    place: np.ndarray   # (N, 3) metres from `origin`, (3,) map coordinates
    scanner: np.ndarray   # (N,) numbers of the scanners from 0
    start: float   # s, the gps_time of the first drive's first point
    origin: np.ndarray
    has_time: bool   # whether the points' times differ
    drives: list[slice]   # slices of the rows between gaps in time
    left_out: int = 0   # points of drives too short to be estimated

    def __len__(self) -> int:
        return len(self.time)

    @property
    def scanners(self) -> int:
        numbers = self.scanner[self.scanner != UNKNOWN_SCANNER]
        return int(numbers.max()) + 1 if len(numbers) else 0


def read_samples(files: Sequence[CloudHeader], scanner_field: str = "automatic", progress: Progress = Progress()) -> Samples:
    """First returns of the files in an even sample of at most `max_samples`; RoadExtractionError if a file cannot be read, or too few are left.

    scanner_field : "automatic", "scanner_channel" or "point_source_id"
    """
    slots, readers = TimeSlots.for_points(sum(file.count for file in files), TRACK.max_samples), ParallelCloudReader(SAMPLED_LAYERS)
    origin = np.floor(np.min([file.minimum for file in files if file.count], axis=0))

    def sampled(part):
        number, first, count = part
        return [first_returns(points, slots, origin) for points in readers.points(files[number], first, count, LAS.points_per_block)]

    parts = [sample for samples in ordered_map(sampled, readers.ranges(files, LAS.points_per_block), progress) for sample in samples]
    time, place, numbers = (np.concatenate(column) for column in zip(*parts))
    del parts
    if len(time) < TRACK.min_drive_samples:
        raise RoadExtractionError(f"The point clouds have {len(time)} usable points; a trajectory is estimated from {TRACK.min_drive_samples} and "
                                  "more. Give the whole survey.")
    scanner = scanners_of(numbers, time, scanner_field)
    span = float(time.min()), float(time.max())
    if span[0] == span[1]:
        return Samples(np.zeros(len(time)), place, scanner, span[0], origin, False, [slice(0, len(time))])
    return samples_of(unwrap_week(time) if wrapped_week(span) else time, place, scanner, origin, slots.stride)


def samples_of(time: np.ndarray, place: np.ndarray, scanner: np.ndarray, origin: np.ndarray, stride: int = 1) -> Samples:
    """Points in any order as Samples: (N,) s, not all the same, (N, 3) m from the origin, and (N,) uint8 scanners.

    stride : every how many points of the survey are among them one is
    """
    order = np.argsort(time, kind="stable")
    time, place, scanner = time[order], place[order], scanner[order]
    cuts = np.flatnonzero(np.diff(time) > TRACK.max_gap_in_drive) + 1
    pieces = zip(np.r_[0, cuts].tolist(), np.r_[cuts, len(time)].tolist())
    long = [(a, b) for a, b in pieces if b - a >= TRACK.min_drive_samples and time[b - 1] - time[a] >= TRACK.min_drive_time]
    # from the first drive on: times long before it, which are wrong, would cost the precision of all others
    start = float(time[long[0][0]]) if long else float(time[0])
    ends = np.cumsum([0] + [b - a for a, b in long]).tolist()
    total = len(time)
    if ends[-1] < total and long:
        kept = np.concatenate([np.arange(a, b) for a, b in long])
        time, place, scanner = time[kept], place[kept], scanner[kept]
    return Samples(time - start, place, scanner, start, origin, True, [slice(a, b) for a, b in zip(ends[:-1], ends[1:])],
                   (total - ends[-1]) * stride)


def rounding_of(time: np.ndarray, start: float) -> float:
    """What (N,) times in seconds since `start` are rounded to, s; 0 where that is no power of ten or two."""
    sample = time[::max(len(time) // TRACK.max_rounding_samples, 1)] + start
    for tick in ROUNDINGS:
        steps = sample / tick
        if np.mean(np.abs(steps - np.rint(steps)) <= TRACK.rounded_tolerance) >= TRACK.min_rounded_share:
            return tick
    return 0.0


# The first track: in every short window of time, the place around which points lie densest, on the ridge of density.


@dataclass
class FirstTrack:
    """The rough track of one drive."""

    time: np.ndarray   # time, foot, count: (W,) s, middles of windows, (W, 3) m, on the ground, and (W,) samples
    foot: np.ndarray
    heading: np.ndarray   # (W,) radians, where the vehicle looked ahead, counter-clockwise from east, continuous
    count: np.ndarray
    reach: np.ndarray   # (W,) m, median horizontal distance of the samples from the densest place

    def at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(N, 3) feet and (N,) headings at (N,) times."""
        return (np.stack([np.interp(time, self.time, column) for column in self.foot.T], axis=1),
                np.interp(time, self.time, self.heading))


def first_track(time: np.ndarray, place: np.ndarray) -> FirstTrack:
    """The ridge of density of one drive, of (N,) ascending times (s) and (N, 3) places (m).

    On a flat road the density of a scan line falls off with the distance x from the scanner's foot as
    h / (h^2 + x^2): a Cauchy distribution, whose place is estimated by its likelihood.
    """
    begin = float(time[0])
    window = ((time - begin) / TRACK.window).astype(np.int64)
    size = int(window[-1]) + 1
    kept = thinned(window, TRACK.max_window_samples)
    time, place, window = time[kept], place[kept], window[kept]
    count = np.bincount(window, minlength=size)
    start = np.r_[0, np.cumsum(count)[:-1]]
    middle, low = (np.minimum(start + (count * share).astype(np.int64), len(time) - 1) for share in (0.5, TRACK.lowest_share))
    foot = np.stack([column[np.lexsort((column, window))][rank] for column, rank in zip(place.T, (middle, middle, low))], axis=1)
    for _ in range(TRACK.density_rounds):
        offset = place - foot[window]
        weight = 1.0 / ((1.0 + (offset[:, :2] ** 2).sum(axis=1) / TRACK.density_width**2) * (1.0 + (offset[:, 2] / TRACK.ground_weight_depth) ** 2))
        total = np.maximum(np.bincount(window, weight, size), 1e-9)
        foot = np.stack([np.bincount(window, weight * column, size) / total for column in place.T], axis=1)
    track = robustly_smoothed(foot, (count >= TRACK.min_window_samples).astype(float), TRACK.stiffness)
    far = np.hypot(*(place - foot[window])[:, :2].T)
    order = np.lexsort((far, window))
    start = np.r_[0, np.cumsum(count)[:-1]]
    reach = np.where(count > 0, far[order][np.minimum(start + count // 2, len(far) - 1)], np.nan)
    middles = begin + (np.arange(size) + 0.5) * TRACK.window
    return FirstTrack(middles, track, headings_of(track), count, reach)


def thinned(group: np.ndarray, most: int) -> np.ndarray:
    """(N,) bool: every n-th of the members of groups, (N,) ascending numbers, so that at most `most` of each are left."""
    rank = np.arange(len(group)) - np.searchsorted(group, group)
    return rank % -(-np.bincount(group) // most)[group] == 0


def headings_of(track: np.ndarray, about: np.ndarray | None = None) -> np.ndarray:
    """(N,) continuous headings, radians counter-clockwise from east, of a track of (N, 2 or more) evenly timed places, m.

    Where the vehicle stands, it keeps the heading in which it came; where it backs up, it keeps looking ahead.
    about : (N,) radians, headings known to less than a right angle; None for those of the track itself
    """
    velocity = np.gradient(track[:, :2], axis=0) if len(track) > 1 else np.zeros((len(track), 2))
    step = np.hypot(*velocity.T)
    moving = np.flatnonzero(step > TRACK.min_step)
    if not len(moving):
        return np.zeros(len(track))
    way = np.arctan2(velocity[moving, 1], velocity[moving, 0])
    about = _headings_by_distance(track) if about is None else about
    # of the two ways along a line, the one that is nearer
    heading = np.unwrap(way) if about is None else about[moving] + (way - about[moving] + np.pi / 2) % np.pi - np.pi / 2
    return np.interp(np.arange(len(track)), moving, heading)


def _headings_by_distance(track):
    """(N,) continuous headings between places `backing_step` apart; None for a track that is shorter.

    A vehicle that goes back within so short a way has not turned about but changed its gear. More of the way is driven forward.
    """
    row, (x0, y0) = [0], track[0, :2]
    for number, (x, y) in enumerate(track[:, :2].tolist()):
        if (x - x0) ** 2 + (y - y0) ** 2 >= TRACK.backing_step**2:
            row.append(number)
            x0, y0 = x, y
    if len(row) < 2:
        return None
    way = np.arctan2(*np.diff(track[row, :2], axis=0).T[::-1])
    backward = np.r_[0, np.cumsum(np.cos(np.diff(way)) < 0)] % 2
    backward = 1 - backward if backward.mean() > 0.5 else backward
    return np.interp(np.arange(len(track)), 0.5 * (np.array(row[:-1]) + row[1:]), np.unwrap(way + np.pi * backward))


# The track of a cloud without times: the ridge of its density on the ground.


def ridge_of(place: np.ndarray) -> np.ndarray:
    """The longest way along the ridge of density of (N, 3) points: (M, 3) m, places of the scanner at a usual height, `ridge_spacing` apart.

    RoadExtractionError if there is none.
    """
    ground = place[_on_ground(place)]
    corner = ground[:, :2].min(axis=0)
    column, row = ((ground[:, :2] - corner) / TRACK.cell).astype(np.int64).T
    shape = int(row.max()) + 1, int(column.max()) + 1
    if shape[0] * shape[1] > TRACK.max_cells:
        raise RoadExtractionError(
            f"The point clouds have no times and cover {shape[1] * TRACK.cell / 1000:.1f} by {shape[0] * TRACK.cell / 1000:.1f} km; without times a "
            f"track is sought in up to {TRACK.max_cells * TRACK.cell**2 / 1e6:.0f} km². Give fewer files, or clouds with gps_time.")
    cell = row * shape[1] + column
    count = np.bincount(cell, minlength=shape[0] * shape[1]).reshape(shape).astype(float)
    density = ndimage.gaussian_filter(count, TRACK.blur / TRACK.cell)
    crest = density / np.maximum(ndimage.maximum_filter(density, int(TRACK.crest_window / TRACK.cell) | 1), 1e-9)
    crest[density < TRACK.min_density_share * np.quantile(density[count > 0], TRACK.dense_share)] = 0.0
    used = crest >= TRACK.min_crest_share
    cells, height = np.stack(np.nonzero(used), axis=1), crest[used]
    # metres between neighbouring cells, dearer off the crest
    graph = (tree := cKDTree(TRACK.cell * cells)).sparse_distance_matrix(tree, 1.5 * TRACK.cell, output_type="coo_matrix")
    graph.data *= 2.0 / (height[graph.row] ** TRACK.crest_cost + height[graph.col] ** TRACK.crest_cost)
    cells = cells[_longest_path(graph.tocsr(), height >= TRACK.end_crest_share)]
    track = (cells[:, ::-1] + 0.5) * TRACK.cell + corner
    driven = np.r_[0.0, np.cumsum(np.hypot(*np.diff(track, axis=0).T))]
    if driven[-1] < TRACK.min_ridge:
        raise RoadExtractionError(
            f"No track shows in the density of the points: the longest ridge is {driven[-1]:.0f} m long, and {TRACK.min_ridge:.0f} m are needed. "
            "Give points with their times, or a trajectory.")
    even = np.arange(0.0, driven[-1], TRACK.ridge_spacing)
    flat = np.stack([np.interp(even, driven, axis) for axis in track.T], axis=1)
    flat = robustly_smoothed(flat, np.ones(len(flat)), TRACK.ridge_stiffness)
    _refuse_even(density, (flat - corner) / TRACK.cell)
    total = np.maximum(np.bincount(cell, minlength=count.size), 1e-9)
    height = (np.bincount(cell, ground[:, 2], minlength=count.size) / total).reshape(shape)
    c, r = np.clip(((flat - corner) / TRACK.cell).astype(np.int64), 0, [shape[1] - 1, shape[0] - 1]).T
    z = robustly_smoothed(height[r, c][:, None], (count[r, c] > 0).astype(float), TRACK.ridge_stiffness)[:, 0]
    return np.column_stack([flat, z + TRACK.usual_height])


def _refuse_even(density, track):
    """Refuse ground that is about as dense on one side of a track as on it: under a scanner density falls off, see `first_track`.

    Not where one of two places on each side is dense alone: there the track of another drive lies.

    density : (rows, columns), 0 beyond what was seen; track : (M, 2) column and row
    """
    way = np.gradient(track, axis=0)
    aside = way[:, ::-1] / np.maximum(np.hypot(*way.T), 1e-9)[:, None] * [-2.0, 2.0] * TRACK.density_width / TRACK.cell
    on, *beside = (ndimage.map_coordinates(density, (track + shift * aside).T[::-1] - 0.5, order=1) for shift in (0.0, -2.0, -1.0, 1.0, 2.0))
    share, second = (float(np.median(dense / np.maximum(on, 1e-9))) for dense in (np.max(beside[1:3], axis=0), np.sort(beside, axis=0)[-2]))
    if share > TRACK.most_even_share and second > TRACK.most_second_share:
        raise RoadExtractionError(
            f"The points have no times, and no track shows in their density: {2 * TRACK.density_width:.1f} m beside where they are densest it is "
            f"{100 * share:.0f} % of that, and under a scanner on a vehicle 20 to 60 %. Give a trajectory, or the points as they were measured.")


def _on_ground(place):
    """(N,) bool of the points on the ground of their cell."""
    column, row = ((place[:, :2] - place[:, :2].min(axis=0)) / TRACK.low_cell).astype(np.int64).T
    cell = row * (int(column.max()) + 1) + column
    order = np.lexsort((place[:, 2], cell))
    first = np.flatnonzero(np.r_[True, np.diff(cell[order]) > 0])
    held = np.diff(np.r_[first, len(cell)])
    ground = np.repeat(place[order[first + (held * TRACK.low_share).astype(np.int64)], 2], held)
    on_ground = np.empty(len(cell), bool)
    on_ground[order] = np.abs(place[order, 2] - ground) <= TRACK.ground_layer
    return on_ground


def _longest_path(graph, ends):
    """Cells along the longest of the cheapest ways between cells of which `ends`, (N,) bool, says that a way may end there."""
    _, part = sparse.csgraph.connected_components(graph, directed=False)
    size = np.bincount(part[ends])
    allowed = ends & (part == size.argmax())
    # the farthest from anywhere is an end; the farthest from that is the other
    start = int(np.argmax(allowed))
    for _ in range(2):
        cost, before = sparse.csgraph.dijkstra(graph, directed=False, indices=start, return_predecessors=True)
        finish, start = start, int(np.argmax(np.where(allowed, cost, -1.0)))
    path = [start]
    while path[-1] != finish and before[path[-1]] >= 0:
        path.append(int(before[path[-1]]))
    return np.array(path)
