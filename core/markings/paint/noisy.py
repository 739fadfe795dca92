"""Paint in averages of noisy points, and faint lines: bright pieces that are elongated, flat and bright from every viewpoint.

Single points are too noisy to be classified, so averages over a decimetre are searched. The face of a curb is steep, a surface beneath a parked
car is covered by it, the arc of one beam is bright from one place only, a patch fades out, and spots are not elongated. A short or worn dash is
recognised by its row. All rules are our own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...survey.frame.road_frame import RoadFrame
from ...survey.store.records import COORDINATE_SCALE, Points
from ..objects.repeating import dashes_beyond, rows_of_dashes
from ..objects.shape import Shape, measure
from ..road_grid import CELL_SIZE, CELL_UNITS
from ..weights import NOISY, ROWS

SCATTER_SIGMAS = 0.5244   # derived: standard deviations of a normal distribution that it lies below the median
BRIGHTNESS_STEPS = 64   # derived: brightness is summed in whole 64ths: their sums are exact in any order


@dataclass(frozen=True)
class CellAverages:
    """Averages over a window of the road in cells, (rows, columns), NaN where nothing is known."""

    contrast: np.ndarray   # brightness above `ground`, which is that of asphalt in the half metre around
    ground: np.ndarray
    spread: np.ndarray   # scatter of asphalt's contrast there, a standard deviation
    slope: np.ndarray   # (2, rows, columns) m per m along and across the road against the ground around: small on a road, large on the face of a curb

    @classmethod
    def of(cls, cell: np.ndarray, value: np.ndarray, height: np.ndarray, shape: tuple[int, int],
           paint: float = NOISY.paint_contrast) -> CellAverages:
        """Averages of N points.

        `cell` : flat cell number of each, `value` : brightness, `height` : int, units of 0.1 mm; `paint` : spreads above the average about it at
        which a cell may be paint.
        """
        count = np.bincount(cell, minlength=shape[0] * shape[1]).reshape(shape).astype(float)
        total = np.bincount(cell, np.rint(value.astype(float) * BRIGHTNESS_STEPS), count.size).reshape(shape) / BRIGHTNESS_STEPS
        low = int(height.min(initial=0))
        risen = np.bincount(cell, (height - low).astype(float), count.size).reshape(shape) * COORDINATE_SCALE
        spot, around = _gaussian_mean(count, total, NOISY.spot_sigma), _gaussian_mean(count, total, NOISY.ground_sigma)
        # paint, rails and drains are no ground: cells beside them are compared with asphalt
        contrast = spot - around
        with np.errstate(invalid="ignore"):
            scatter = _local_scatter(contrast)
            plain = (contrast > -NOISY.ground_contrast * scatter) & (contrast < paint * scatter)
        asphalt = _gaussian_mean(count * plain, total * plain, NOISY.ground_sigma)
        around = np.where(np.isfinite(asphalt), asphalt, around)
        contrast = (spot - around).astype(np.float32)
        tilts = [np.gradient(_gaussian_mean(count, risen, sigma), CELL_SIZE) for sigma in (NOISY.slope_sigma, NOISY.ground_slope_sigma)]
        slope = np.stack([tilt - ground_tilt for tilt, ground_tilt in zip(*tilts)]).astype(np.float32)
        return cls(contrast, around, _local_scatter(contrast), slope)

    @property
    def z(self) -> np.ndarray:
        """(rows, columns) contrast in spreads."""
        return self.contrast / self.spread


def _gaussian_mean(count, total, sigma):
    """Gaussian average, NaN where there are too few points."""
    weight, weighted = (ndimage.gaussian_filter(a, sigma, mode="constant", truncate=3.0) for a in (count, total))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(weight > NOISY.min_density, weighted / weight, np.nan)


def _local_scatter(contrast: np.ndarray) -> np.ndarray:
    """Standard deviation of asphalt's contrast in the metres around each cell, float32; NaN where nothing is known.

    It is estimated from values a little below the median: paint lies above them, rails, covers and seams below.
    """
    rows, columns = (-(-n // NOISY.scatter_block) for n in contrast.shape)
    padded = np.full((rows * NOISY.scatter_block, columns * NOISY.scatter_block), np.nan, np.float32)
    padded[:contrast.shape[0], :contrast.shape[1]] = contrast
    blocks = np.sort(padded.reshape(rows, NOISY.scatter_block, columns, NOISY.scatter_block).transpose(0, 2, 1, 3).reshape(rows, columns, -1), axis=2)
    count = np.isfinite(blocks).sum(axis=2, keepdims=True)
    low, median = (np.take_along_axis(blocks, (share * np.maximum(count - 1, 0)).astype(np.int64), 2)[..., 0]
                   for share in (NOISY.scatter_quantile, 0.5))
    spread = np.where(count[..., 0] >= NOISY.min_block_cells, (median - low) / SCATTER_SIGMAS, np.nan)
    finite = spread[np.isfinite(spread)]
    if not len(finite):
        return np.full(contrast.shape, np.nan, np.float32)
    reach = NOISY.scatter_blocks // 2
    around = np.lib.stride_tricks.sliding_window_view(np.pad(spread, reach, constant_values=np.nan), (NOISY.scatter_blocks, NOISY.scatter_blocks))
    ordered = np.sort(around.reshape(rows, columns, -1), axis=2)
    count = np.isfinite(ordered).sum(axis=2, keepdims=True)
    middle = np.take_along_axis(ordered, np.maximum(count - 1, 0) // 2, 2)[..., 0]
    middle = np.where(count[..., 0] > 0, middle, np.median(finite))
    positions = [np.clip((np.arange(n) + 0.5) / NOISY.scatter_block - 0.5, 0, m - 1) for n, m in zip(contrast.shape, middle.shape)]
    return ndimage.map_coordinates(middle, np.meshgrid(*positions, indexing="ij"), order=1).astype(np.float32)


@dataclass(frozen=True)
class _BrightPiece:
    """A connected bright piece of a window."""

    cells: tuple[np.ndarray, np.ndarray]   # rows and columns of its cells
    shape: Shape
    thickness: float   # m, where it is thickest
    slope: np.ndarray   # (2,) mean slope along and across the road, m per m
    rim: float
    top: float   # contrast of its bright cells
    fading: float   # share of its contrast that is left just beside it
    z: float

    @property
    def is_elongated(self) -> bool:
        """Whether it is long for its width: as a whole, or, branched like hatching, by its area over its thickness."""
        if self.shape.area < NOISY.stroke_area or self.fading > NOISY.max_fading:
            return False
        if self.shape.length >= NOISY.stroke_length and self.shape.elongation >= NOISY.stroke_elongation:
            return True
        return self.shape.area / self.thickness >= max(NOISY.branched_length, NOISY.stroke_elongation * self.thickness)

    @property
    def is_line(self) -> bool:
        """Whether it is a thin straight line, however faint, on asphalt: between dark seams asphalt itself is brighter than what lies beside it."""
        thin = self.shape.width <= NOISY.faint_line_width and self.shape.elongation >= NOISY.faint_line_elongation
        return self.is_elongated and thin and self.shape.length >= NOISY.faint_line_length and self.fading >= -NOISY.max_fading


@dataclass(frozen=True)
class ViewSamples:
    """The N points of a window: flat number of the cell, brightness, whether an object is above, and the vehicle's place, None where unknown."""

    cell: np.ndarray
    value: np.ndarray
    covered: np.ndarray
    view: np.ndarray | None = None


def views(points: Points, frame: RoadFrame) -> np.ndarray | None:
    """(N,) numbers of the half metre of the vehicle's way from which each of N road points was measured; None where times are not known."""
    if not frame.has_time:
        return None
    result = np.zeros(len(points), np.int64)
    for number in np.unique(points.pass_number):
        rows = np.flatnonzero(points.pass_number == number)
        result[rows] = np.floor(frame.passes[number].station_at(points.time[rows]) / NOISY.view_length) + (int(number) << 32)
    return result


def noisy_paint_cells(averages: CellAverages, rim: np.ndarray, samples: ViewSamples, threshold: float) -> np.ndarray:
    """(rows, columns) bool, cells of paint; `rim` is their distance from the rim of the road, m, and `threshold` the spreads that paint reaches."""
    # holes that noise left in strokes are closed
    mask = ndimage.binary_closing(_stroke_cells(averages, rim, samples, threshold), np.ones((3, 3), bool), iterations=2)
    for piece in _dashes_of_rows(averages, rim, samples, threshold):
        mask[piece.cells] = True
    return mask


def _stroke_cells(averages, rim, samples, threshold):
    """Cells of clear strokes and of thin straight lines, which may be fainter."""
    z, contrast = averages.z, averages.contrast
    with np.errstate(invalid="ignore"):
        bright, faint = z > NOISY.piece_brightness * threshold, z > NOISY.piece_brightness * NOISY.faint_line * threshold
    mask = np.zeros(rim.shape, bool)
    strokes = [piece for piece in _bright_pieces(bright, averages, rim, threshold) if piece.is_elongated
               and (piece.z >= NOISY.clear_brightness * threshold or piece.shape.length >= NOISY.clear_length)]
    lines = [piece for piece in _bright_pieces(faint, averages, rim, NOISY.faint_line * threshold) if piece.is_line]
    # a stroke may be the clear part of a line
    for piece in (piece for group in (strokes, lines)
                  for piece in _without_artefacts([candidate for candidate in group if np.hypot(*candidate.slope) < NOISY.max_slope],
                                                  samples, rim.shape)):
        row, column = piece.cells
        # beside a broad stroke the average is darker than asphalt
        inner = contrast[row, column] > NOISY.half_maximum * piece.top * (1.0 + min(piece.fading, 0.0))
        mask[row[inner], column[inner]] = True
    return mask


def _dashes_of_rows(averages, rim, samples, threshold):
    """Pieces that follow on each other as dashes do, and fainter ones where these rows lead."""
    with np.errstate(invalid="ignore"):
        dashes = _dashes(averages, rim, samples, averages.z > NOISY.piece_brightness * threshold, NOISY.faint_dash * threshold)
    rows = []
    for row in rows_of_dashes([piece.shape for piece in dashes]):
        clear = sum(dashes[k].z >= threshold for k in row)
        if clear >= max(ROWS.min_dashes_in_row, len(row) / 2) and np.hypot(*np.mean([dashes[k].slope for k in row], axis=0)) < NOISY.max_slope:
            rows.append([dashes[k] for k in row])
    if not rows:
        return []
    with np.errstate(invalid="ignore"):
        worn = _dashes(averages, rim, samples, averages.z > NOISY.piece_brightness * NOISY.worn_dash * threshold, NOISY.worn_dash * threshold)
    shapes = [piece.shape for piece in worn]
    return [piece for row in rows for piece in row + [worn[k] for k in dashes_beyond([piece.shape for piece in row], shapes)]]


def _dashes(averages, rim, samples, bright, threshold):
    """Pieces that may be dashes: the average joins neighbouring ones, so they are searched for in the mask cut at half maximum."""
    contrast = averages.contrast
    tops = ndimage.maximum_filter(np.where(bright, contrast, 0.0), 2 * NOISY.half_maximum_reach + 1)
    with np.errstate(invalid="ignore"):
        cut = bright & (contrast > NOISY.half_maximum * tops)
    pieces = [piece for piece in _bright_pieces(cut, averages, rim, threshold)
              if piece.shape.length >= NOISY.dash_length and piece.shape.width <= NOISY.dash_width
              and np.hypot(*piece.slope) < NOISY.dash_slope_factor * NOISY.max_slope]
    return _without_artefacts(pieces, samples, rim.shape)


def _bright_pieces(mask: np.ndarray, averages: CellAverages, rim: np.ndarray, threshold: float) -> list[_BrightPiece]:
    """Connected pieces whose brightest tenth reaches the threshold, spreads above asphalt, away from the road's rim; the smallest are left out."""
    labels, count = ndimage.label(mask, np.ones((3, 3), bool))
    large = np.bincount(labels.ravel(), minlength=count + 1) * CELL_SIZE**2 >= NOISY.dash_area
    z, pieces = averages.z, []
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        if not large[number]:
            continue
        inside = labels[box] == number
        row, column = (a + side.start for a, side in zip(np.nonzero(inside), box))
        tilt = averages.slope[:, row, column]
        tilt = tilt[:, np.isfinite(tilt[0])]
        reached = float(np.percentile(z[row, column], NOISY.top_percentile))
        if reached < threshold or np.median(rim[row, column]) <= NOISY.min_rim_distance or not tilt.size:
            continue
        contrast = averages.contrast[row, column]
        top, highest = np.percentile(contrast, [NOISY.usual_percentile, NOISY.top_percentile]).tolist()
        pieces.append(_BrightPiece((row, column), measure(row * CELL_UNITS, column * CELL_UNITS),
                                   2.0 * CELL_SIZE * ndimage.distance_transform_edt(np.pad(inside, 1)).max(), tilt.mean(axis=1),
                                   float(np.median(rim[row, column])), top,
                                   _beside(inside & (averages.contrast[box] > NOISY.half_maximum * highest), box, averages.contrast) / highest,
                                   reached))
    return pieces


def _beside(inside, box, contrast):
    """Mean contrast about a decimetre beside the bright half of a piece."""
    margin = NOISY.fading_ring[1] + 1
    window = tuple(slice(max(side.start - margin, 0), side.stop + margin) for side in box)
    piece = np.zeros(contrast[window].shape, bool)
    piece[tuple(slice(side.start - w.start, side.stop - w.start) for side, w in zip(box, window))] = inside
    apart = ndimage.distance_transform_edt(~piece)
    values = contrast[window][(apart > NOISY.fading_ring[0]) & (apart <= NOISY.fading_ring[1])]
    values = values[np.isfinite(values)]
    return float(values.mean()) if len(values) else 0.0


def _without_artefacts(found: list[_BrightPiece], samples: ViewSamples, shape: tuple[int, ...]) -> list[_BrightPiece]:
    """The pieces that no object covers, and that are brighter than their surroundings in all views together.

    The contrast of each view is one observation, weighted by its points; the mean must be 3 of its standard errors above zero.
    """
    if not found:
        return found
    number = np.full(shape, -1)
    for k, piece in enumerate(found):
        number[piece.cells] = k
    of = number.ravel()[samples.cell]
    on_piece = of >= 0
    points = np.bincount(of[on_piece], minlength=len(found))
    genuine = np.bincount(of[on_piece], samples.covered[on_piece], len(found)) <= NOISY.max_covered * points
    if samples.view is not None:
        genuine &= _bright_in_all_views(number, samples, len(found))
    return [piece for piece, is_genuine in zip(found, genuine) if is_genuine]


def _bright_in_all_views(number, samples, count):
    apart, nearest = ndimage.distance_transform_edt(number < 0, return_indices=True)
    inner = number >= 0
    used = inner | (apart >= NOISY.view_ring[0]) & (apart <= NOISY.view_ring[1])
    rows = np.flatnonzero(used.ravel()[samples.cell])
    cell, value = samples.cell[rows], np.rint(samples.value[rows].astype(float) * BRIGHTNESS_STEPS)
    view, view_index = np.unique(samples.view[rows], return_inverse=True)
    key = number[tuple(nearest)].ravel()[cell] * len(view) + view_index
    inside = inner.ravel()[cell]
    (n, total), (around, around_total) = (
        (np.bincount(key[side], minlength=count * len(view)), np.bincount(key[side], value[side], count * len(view)) / BRIGHTNESS_STEPS)
        for side in (inside, ~inside))
    with np.errstate(invalid="ignore", divide="ignore"):
        weight = np.where((n > 1) & (around > 1), n * around / (n + around), 0.0).reshape(count, -1)
        above = np.where(weight > 0, (total / n - around_total / around).reshape(count, -1), 0.0)
        views, total_weight = (weight > 0).sum(axis=1), weight.sum(axis=1)
        mean = (weight * above).sum(axis=1) / total_weight
        error = np.sqrt(((weight * (above - mean[:, None])) ** 2).sum(axis=1) * views / (views - 1)) / total_weight
        return (views >= NOISY.min_views) & (mean > NOISY.min_view_sigmas * error)
