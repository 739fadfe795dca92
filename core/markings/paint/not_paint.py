"""What is bright on a road and is no paint: runs that are too short, gutters, rims that fade out, things that stand above the asphalt."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...curves.robust import median
from ...lazy import cv2
from ...survey.store.records import COORDINATE_SCALE
from ..road_grid import CELL_SIZE, fill_gaps
from ..weights import ASPHALT, RIMS, TRACKS


def track_spacing(occupied: np.ndarray) -> np.ndarray:
    """(rows, columns) float32 m from each cell's track of the scan to the next one across the road, on the side where it is farther.

    It is 0 where points lie in every cell or nothing was scanned. `occupied` : (rows, columns) bool, cells of 4 cm that hold points.
    """
    tracks = cv2.dilate(occupied.astype(np.uint8), np.ones((2 * TRACKS.along_reach + 1, 1), np.uint8), borderValue=0).astype(bool)
    columns = np.arange(tracks.shape[1], dtype=np.int16)
    beyond = np.int16(2 * tracks.shape[1])
    # beyond the outermost tracks they are far away; a product is quicker than a choice between a column and that
    before = tracks * (columns + beyond)
    before = np.maximum.accumulate(before, axis=1, out=before)
    before -= beyond
    after = (tracks * (columns - 2 * beyond))[:, ::-1]
    after = np.minimum.accumulate(after, axis=1)[:, ::-1] + 2 * beyond
    gap = after - before
    gap[gap > int(TRACKS.max_track_gap / CELL_SIZE)] = 0
    return cv2.dilate(gap.astype(np.float32), np.ones((1, 2 * TRACKS.across_reach + 1), np.uint8), borderValue=0) * np.float32(CELL_SIZE)


def clear_pieces(z: np.ndarray, mask: np.ndarray, seen: np.ndarray, are_paint: Callable[[np.ndarray], np.ndarray] | None = None) -> np.ndarray:
    """(rows, columns) bool, the bright cells of a mask in pieces that are too large and too bright to be noise, and what wear left between two.

    A piece is what hangs together once gaps of `close` along the road are closed, and where points lie far apart those that no point was near. The
    brightness of its cells must sum up to enough `evidence`: a faint line of some length is as sure as a bright speck.

    z : (rows, columns) float32 spreads above asphalt, no more than the highest threshold of each cell counts
    mask, seen : (rows, columns) bool, bright cells and those whose brightness is known
    are_paint : gives (rows, columns) the share of the evidence of each cell that counts, by (rows, columns) int the numbers of pieces from 1 on, 0
        elsewhere; None where nothing else tells what is paint
    """
    joined = fill_gaps(mask, int(round(ASPHALT.close / CELL_SIZE)), 0)
    for axis, limit in enumerate((TRACKS.max_gap_on_track, TRACKS.max_track_gap)):
        joined |= _unseen_gaps(mask, seen, limit, axis)
    count, labels = cv2.connectedComponents(joined.view(np.uint8), connectivity=8)
    of, evidence = labels[mask], np.minimum(z[mask], ASPHALT.highest)
    large, counted = np.bincount(of, evidence, count) >= ASPHALT.evidence, True
    if are_paint is not None and large.any():
        counted = np.broadcast_to(are_paint((np.cumsum(large) * large)[labels]), mask.shape)[mask]
        large &= np.bincount(of, evidence * counted, count) >= ASPHALT.evidence
    clear = np.zeros(mask.shape, bool)
    clear[mask] = large[of] & (counted > 0)
    return mask & (clear | _between(clear, mask)) if clear.any() else clear


def two_sided(above: np.ndarray, bright: np.ndarray, least: float, labels: np.ndarray) -> np.ndarray:
    """(rows, columns) share of the evidence of pieces that counts, from 0 of the rim of a repair to 1; as of `clear_pieces`.

    Such a rim is bright on one side, too, or fades out into the repair: it is brighter than its brighter side by less than `least` spreads, and that
    side is about half as bright as itself, above the asphalt.

    above : (rows, columns) float32 spreads above the asphalt of the bin, local levels not taken off; bright : (rows, columns) bool cells of pieces
    """
    _, high, middle = beside_pieces(above, labels, bright, RIMS.beside)
    counted = np.interp(high / np.maximum(middle, 1e-6), RIMS.brighter_side, (1.0, 0.0))
    return np.append(0.0, np.where(middle - high < least, counted, 1.0))[labels]


def beside_pieces(values: np.ndarray, labels: np.ndarray, bright: np.ndarray, reach: tuple[int, int]) -> np.ndarray:
    """(3, pieces) of pieces: values on the darker and on the brighter side of what lies beside them, up to a reach less another in cells, and
    in their own bright cells."""
    known = np.isfinite(values)
    weight = cv2.blur(known.astype(np.float32), (3, 3))
    level = cv2.blur(np.where(known, values, np.float32(0)), (3, 3)) / np.maximum(weight, np.float32(1e-6))
    far, near = (cv2.dilate(labels.astype(np.float32), np.ones((2 * cells + 1, 2 * cells + 1), np.uint8)) for cells in reach)
    beside = np.where(known & (near == 0), far, 0).astype(np.int32)
    inside, count = np.where(bright, labels, 0), int(labels.max()) + 1
    return np.array([*_of_pieces(level, beside, count, RIMS.sides), *_of_pieces(level, inside, count, (0.5,))])[:, 1:]


def _of_pieces(values, labels, count, shares):
    """[(count,) of each label the value that a share of its cells do not exceed; NaN where it has no cell] of some shares."""
    cells = np.flatnonzero(labels)
    of, values = labels.ravel()[cells], values.ravel()[cells]
    number = np.bincount(of, minlength=count)
    ordered, first = np.append(values[np.lexsort((values, of))], np.nan), np.cumsum(number) - number
    places = (first + (share * np.maximum(number - 1, 0)).astype(np.int64) for share in shares)
    return [np.where(number > 0, ordered[np.minimum(place, len(cells))], np.nan) for place in places]


def _unseen_gaps(mask, seen, limit, axis):
    """Cells between two bright ones, at most `limit` metres apart along an axis, if none of them was seen."""
    gaps = fill_gaps(mask, int(round(limit / CELL_SIZE)), axis) & ~mask
    if not (gaps & ~seen).any():
        return np.zeros(mask.shape, bool)
    ends, dark, gaps = (cells if axis == 0 else cells.T for cells in (mask, seen & ~mask, gaps))
    gaps = gaps & _met_since(ends, dark) & _met_since(ends[::-1], dark[::-1])[::-1]
    return gaps if axis == 0 else gaps.T


def _between(ends, specks):
    """Cells of runs along the road that connect two ends by specks without long gaps; a column either way, as paint is not quite parallel to it."""
    kernel, result = np.ones((1, 3), np.uint8), np.zeros(specks.shape, bool)
    ends, specks = (cv2.dilate(mask.view(np.uint8), kernel, borderValue=0).view(bool) for mask in (ends, specks))
    columns = np.flatnonzero(ends.any(axis=0))
    ends, specks = np.ascontiguousarray(ends[:, columns]), np.ascontiguousarray(specks[:, columns])
    run = fill_gaps(specks, int(round(RIMS.worn_gap / CELL_SIZE)), 0)
    result[:, columns] = run & _met_since(ends, ~run) & _met_since(ends[::-1], ~run[::-1])[::-1]
    return result


def _met_since(ends, breaks):
    """Cells from which an end is reached before a break, going back along the first axis."""
    # what was met last: twice its row, and 1 more where it is an end and no break
    twice = np.arange(2, 2 * len(ends) + 2, 2, dtype=np.int16)[:, None]
    last_met = (ends | breaks) * twice
    last_met += ends > breaks
    last_met = np.maximum.accumulate(last_met, axis=0, out=last_met)
    last_met &= np.int16(1)
    return last_met.astype(bool)


# Concrete gutters begin at the very rim of the road, are broader or paler than a line, and run along metres of rim. They are a ground of their own:
# what is painted on one or beside it is brighter still. A stop line or zebra stripe at the rim takes up little of its length.

ROAD_GAP_ACROSS = int(TRACKS.max_track_gap / CELL_SIZE)   # derived: and across it those between tracks of the scan


def rim_distance(occupied: np.ndarray) -> np.ndarray:
    """(rows, columns) float32 m from each cell of road to the road's rim; 0 outside the road.

    Where the points end along the road, it is taken to continue. `occupied` : (rows, columns) bool, cells that hold road points.
    """
    rows = np.flatnonzero(occupied.any(axis=1))
    occupied = occupied.copy()
    if len(rows):
        occupied[:rows[0]] = occupied[rows[0]:rows[0] + RIMS.road_gap_along].any(axis=0)
        occupied[rows[-1] + 1:] = occupied[max(rows[-1] + 1 - RIMS.road_gap_along, 0):rows[-1] + 1].any(axis=0)
    # along each track first: two tracks rarely have points at the same station
    tracks = fill_gaps(occupied, RIMS.road_gap_along, 0)
    road = fill_gaps(fill_gaps(tracks, ROAD_GAP_ACROSS, 1), RIMS.road_gap_along, 0)
    return cv2.distanceTransform(road.view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE) * np.float32(CELL_SIZE)


def edge_distance(half_width: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """(rows, columns) float32 m from each cell to the road's edge on its side, whatever hides the road between them; infinite where unknown.

    The rim of an occluded area is no rim of the road: beside parked vehicles it is longer than the rim at the gutter, which would not be recognised.
    `half_width` : (2, rows) mm from the reference to the edge on the left and on the right, 0 where unknown; `offsets` : (columns,) m.
    """
    distance = np.full((half_width.shape[1], len(offsets)), np.inf, np.float32)
    for side, widest in zip((1, -1), half_width):
        columns, finite = np.flatnonzero(offsets * side > 0), np.flatnonzero(widest)
        if len(columns) and len(finite):
            edge = np.interp(np.arange(len(distance)), finite, widest[finite] * 1e-3)
            distance[:, columns[0]:columns[-1] + 1] = np.maximum(edge[:, None] - np.abs(offsets[columns]) + CELL_SIZE / 2, CELL_SIZE)
    return distance


@dataclass(frozen=True)
class RimBands:
    """The cells along one rim, by bands inwards and squares along it; the same for whatever is measured in them."""

    distance: np.ndarray   # (rows, columns) float32 metres from the rim, of `rim_distance` or `edge_distance`
    near: np.ndarray   # (N,) flat numbers of the cells that were scanned within the reach of gutters
    band: np.ndarray   # (N,) of each its band from the rim inwards, the flat number of its square of 20 cm, and that of square and band
    square: np.ndarray
    place: np.ndarray
    seen: np.ndarray   # (bands, squares along, squares across) cells of a band that were scanned along RIM_REACH either way

    @classmethod
    def of(cls, distance: np.ndarray, scanned: np.ndarray) -> RimBands:
        """The bands along a rim at a distance, (rows, columns) m, of the cells that were scanned, (rows, columns) bool."""
        cells_near = np.flatnonzero((distance > 0) & (distance < np.float32((RIMS.gutter_bands * RIMS.band_cells + 0.5) * CELL_SIZE)) & scanned)
        band = ((distance.take(cells_near) / np.float32(CELL_SIZE) - np.float32(0.5)) / np.float32(RIMS.band_cells)).astype(np.int32)
        band = np.minimum(band, RIMS.gutter_bands - 1)
        rows, columns = (-(-n // RIMS.coarse_cells) for n in distance.shape)
        square = _squares(cells_near.astype(np.int32), distance.shape[1], columns)
        bin_index = (square * np.int32(RIMS.gutter_bands) + band).astype(np.intp)
        counts = np.bincount(bin_index, minlength=RIMS.gutter_bands * rows * columns).astype(float)
        return cls(distance, cells_near, band, square, bin_index, _around(counts.reshape(rows, columns, RIMS.gutter_bands)))

    def sums(self, values: np.ndarray) -> np.ndarray:
        """(bands, squares along, squares across) sums of (N,) values at the cells along RIM_REACH either way."""
        return _around(np.bincount(self.place, values, self.seen.size).reshape(*self.seen.shape[1:], RIMS.gutter_bands))


def _squares(cell, width, columns):
    """(N,) int32 flat numbers of the squares of 20 cm that cells lie in; `width` : cells in a row, `columns` : squares in a row."""
    row = cell // np.int32(width)
    column = cell - row * np.int32(width)
    return row // np.int32(RIMS.coarse_cells) * np.int32(columns) + column // np.int32(RIMS.coarse_cells)


def _around(counts):
    """(bands, squares along, squares across) sums of (squares along, squares across, bands) along RIM_REACH either way."""
    box = 2 * int(round(RIMS.rim_reach / CELL_SIZE / RIMS.coarse_cells)) + 1
    sums = cv2.boxFilter(counts, -1, (box, box), normalize=False, borderType=cv2.BORDER_CONSTANT)
    return np.ascontiguousarray(np.moveaxis(sums, 2, 0))


def gutter_level(z: np.ndarray, rim: RimBands) -> np.ndarray:
    """(rows, columns) float32 spreads by which concrete gutters lie above asphalt, 0 elsewhere, by our own rule.

    How broad a strip along the rim is, and how pale beside the paint of the window, weighs in nats for a gutter and against a line.
    `z` : (rows, columns) spreads above asphalt, NaN where not scanned
    """
    result = np.zeros(z.shape, np.float32)
    value, scanned = z.take(rim.near), np.maximum(rim.seen, 1e-9)
    share = rim.sums(value > RIMS.gutter_brightness) / scanned
    # a cell at the rim is half curb: the second band tells, and the first may be half as bright
    share[0] = share[1]
    bright = np.cumprod((share >= RIMS.min_bright_share) & (scanned > RIMS.min_cells_seen), axis=0)
    if not bright.any():
        return result
    # in whole 64ths: their sums are exact in any order
    level = rim.sums(np.rint(64 * np.clip(value, 0.0, 100.0)) / 64) / scanned
    level[0] = np.minimum(2 * level[0], level[1])
    unbroken = np.minimum.accumulate(level, axis=0)
    with np.errstate(invalid="ignore"):
        paint = z[(z > ASPHALT.highest) & (rim.distance >= np.float32(RIMS.gutter_bands * RIMS.band_cells * CELL_SIZE))]
    paler = 1.0 - unbroken[1] / median(paint) if len(paint) >= ASPHALT.min_bin_cells else 0.0
    width = bright.sum(axis=0) * (RIMS.band_cells * CELL_SIZE)
    odds = RIMS.per_gutter_width * (width - RIMS.line_at_rim) + RIMS.per_paleness * np.maximum(paler, 0.0) - RIMS.gutter
    unbroken *= bright[0] & (odds > 0.0) & (unbroken > RIMS.gutter_brightness)
    # the band in which the gutter ends is half gutter, and nothing is paint in the one that is half curb
    unbroken[1:] = np.maximum(unbroken[1:], unbroken[:-1])
    unbroken[0] = np.where(unbroken[0] > 0.0, 100.0, 0.0)
    result.ravel()[rim.near] = unbroken.reshape(RIMS.gutter_bands, -1)[rim.band, rim.square]
    return result


# Raised things, such as the ends of traffic islands and the feet of vehicles: a bright square is compared with the plane through the squares of
# road about it that are not bright, which follows crossfall, crowns and ramps. The middle of the squares of a larger piece is surer: half of what
# one is to stand up says that it is no paint, as the face of a curb. By our own rule.

SIGMAS_OF_MEDIAN = 1.4826   # derived: standard deviations in a median of absolute deviations


def raised_cells(heights: Sequence[tuple[np.ndarray, np.ndarray]], mask: np.ndarray) -> np.ndarray:
    """(rows, columns) bool, cells of a mask of bright cells that stand above the asphalt about them.

    `heights` : (flat cell numbers, heights in units of 0.1 mm) of points, in any number of parts.
    """
    columns = -(-mask.shape[1] // RIMS.coarse_cells)
    shape = -(-mask.shape[0] // RIMS.coarse_cells), columns
    size, low = shape[0] * columns, min((int(z.min()) for _, z in heights if len(z)), default=0)
    # of dark cells and of bright ones; sums of whole numbers are the same in any order
    number, total = np.zeros(2 * size), np.zeros(2 * size)
    bright = mask.ravel()
    for cell, z in heights:
        square = _squares(cell, mask.shape[1], columns) + np.int32(size) * bright.take(cell)
        number += np.bincount(square, minlength=2 * size)
        total += np.bincount(square, (z - low).astype(float), 2 * size)
    with np.errstate(invalid="ignore", divide="ignore"):
        dark, light = (total / number * COORDINATE_SCALE).reshape(2, *shape)
    deviation = dark - _planes(dark)
    finite = deviation[np.isfinite(deviation)]
    if len(finite) < RIMS.min_squares_of_spread:
        return np.zeros(mask.shape, bool)
    limit = max(RIMS.least_rise, RIMS.rise_sigmas * SIGMAS_OF_MEDIAN * median(np.abs(finite)))
    with np.errstate(invalid="ignore"):
        # what is raised and not bright is no asphalt, either
        rise = light - _planes(np.where(deviation <= limit / 2, dark, np.nan))
        rise = np.repeat(np.repeat(rise, RIMS.coarse_cells, 0), RIMS.coarse_cells, 1)[:mask.shape[0], :mask.shape[1]]
        count, labels = cv2.connectedComponents(mask.view(np.uint8), connectivity=8)
        known = np.where(np.isfinite(rise), labels, 0)
        middle, = _of_pieces(rise, known, count, (0.5,))
        # the mean of four squares is off by half as much as one
        raised = (middle > limit / 2) & (np.bincount(known.ravel(), minlength=count) >= 4 * RIMS.coarse_cells**2)
        return mask & ((rise > limit) | raised[labels])


def _planes(height):
    """(A, B) m in the middle of each square, of the plane through those about it; NaN where few are known. NaN heights are not known."""
    finite = np.isfinite(height)
    z = np.where(finite, height, 0.0)
    weight = finite.astype(float)
    u, v = np.meshgrid(*(np.arange(n) * RIMS.coarse_cells * CELL_SIZE for n in height.shape), indexing="ij")

    def about(values):
        return cv2.boxFilter(values, -1, (RIMS.plane_squares, RIMS.plane_squares), normalize=False, borderType=cv2.BORDER_CONSTANT)

    n = about(weight)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean_u, mean_v, mean_z = about(weight * u) / n, about(weight * v) / n, about(z) / n
        uu, vv, uv = about(weight * u * u) / n - mean_u**2, about(weight * v * v) / n - mean_v**2, about(weight * u * v) / n - mean_u * mean_v
        uz, vz = about(z * u) / n - mean_u * mean_z, about(z * v) / n - mean_v * mean_z
        spread = uu * vv - uv * uv
        slope_u, slope_v = (uz * vv - vz * uv) / spread, (vz * uu - uz * uv) / spread
        plane = mean_z + slope_u * (u - mean_u) + slope_v * (v - mean_v)
        # in a row of squares there is no plane
        flat = spread > 0.1 * (RIMS.coarse_cells * CELL_SIZE) ** 4
    return np.where((n >= RIMS.min_plane_squares) & flat, plane, np.nan)
