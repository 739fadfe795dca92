"""Paint in averages of noisy points, and faint lines: bright pieces that are elongated, flat and bright from every viewpoint.

Single points are too noisy to be classified, so averages over a decimetre are searched. The face of a curb is steep, a surface beneath a parked
car is covered by it, the arc of one beam is bright from one place only, a patch fades out, and spots are not elongated. A short or worn dash is
recognised by its row. All rules are our own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...lazy import cv2
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.records import COORDINATE_SCALE, Points
from ..objects.repeating import MIN_DASHES_IN_ROW, dashes_beyond, rows_of_dashes
from ..objects.shape import Shape, measure
from ..road_grid import CELL_SIZE, CELL_UNITS, fill_gaps

# averages
SPOT_SIGMA = 1.25       # cells, of the average in which pieces are searched
GROUND_SIGMA = 10.0     # cells, of the average it is compared with: wheel tracks, patches and shadows are wider than paint
MIN_DENSITY = 0.05      # points per cell, averaged so, below which nothing is known
SCATTER_BLOCK = 25      # cells: the scatter of averages is taken in squares of 1 m
SCATTER_BLOCKS = 5      # squares in each direction: their median is the scatter of the one in the middle
MIN_BLOCK_CELLS = 200
SCATTER_QUANTILE = 0.30     # of a square's contrasts: dark rails are below it, paint is above the median
SCATTER_SIGMAS = 0.5244     # standard deviations of a normal distribution that it lies below the median
GROUND_CONTRAST = 2.0       # spreads: darker cells are no ground,
PAINT_CONTRAST = 3.0        # and no brighter ones, which may be paint: the default of the threshold on averages
SLOPE_SIGMA, GROUND_SLOPE_SIGMA = 3.0, 12.0      # cells, of the averaged heights whose slopes are compared
BRIGHTNESS_STEPS = 64   # brightness is summed in whole 64ths: their sums are exact in any order

# pieces
MIN_RIM_DISTANCE = 0.20     # m from the rim of the road: nearer pieces are curbs or plants
FAINT_DASH = 0.75       # of the threshold: a dash may be so faint where as many of its row reach the threshold
WORN_DASH = 0.5         # of the threshold: a dash may be so faint where it leads on a row that is sure
PIECE_BRIGHTNESS = 0.6  # of the threshold: brightness of all cells of a piece that reaches the threshold in places
TOP_PERCENTILE = 90     # %: of a piece's cells; its brightness must reach the threshold
USUAL_PERCENTILE = 75   # %: of a piece's cells; its contrast is that of the piece
HALF_MAXIMUM = 0.5      # of the maximum contrast nearby: the rim of paint in a blurred image
HALF_MAXIMUM_REACH = 7  # cells: where the maximum is taken
MAX_FADING = 0.15       # of a piece's contrast: where as much is left just beside it, it has no sharp rim
FADING_RING = 1.5, 3    # cells from a piece: where its fading is measured
MAX_SLOPE = 0.020       # m per m against the ground around: the face of a curb is steeper
DASH_SLOPE_FACTOR = 2.5     # a single dash may be so many times steeper where its row is flat on average: some lie beside the grooves of rails
MAX_COVERED = 1 / 3     # of a piece's points: covered by an object above, such as a parked car
STROKE_AREA, STROKE_LENGTH, STROKE_ELONGATION = 0.12, 0.80, 3.5  # m2, m, length over width: least of an elongated piece
CLEAR_BRIGHTNESS, CLEAR_LENGTH = 4 / 3, 2.0   # of the threshold, m: an elongated piece must be so bright or so long
FAINT_LINE_LENGTH, FAINT_LINE_WIDTH, FAINT_LINE_ELONGATION = 3.0, 0.30, 15.0   # m, m, length over width: noise is never so straight and thin,
FAINT_LINE = 0.5         # of the threshold: so faint may a piece of that shape be
BRANCHED_LENGTH = 1.5   # m: least area over thickness of a branched piece
DASH_AREA, DASH_LENGTH, DASH_WIDTH = 0.03, 0.25, 0.40    # m2, m: least, least and most of a dash in a row
VIEW_RING = 3, 8        # cells from a piece: asphalt that it is compared with in each view
VIEW_LENGTH = 0.5       # m of the vehicle's way: points measured from farther apart are different views
MIN_VIEWS, MIN_VIEW_SIGMAS = 4, 3.0   # views, and standard errors by which a piece is brighter than its surroundings in the mean of them


@dataclass(frozen=True)
class CellAverages:
    """CellAverages over a window of the road in cells, NaN where nothing is known.

    contrast : (rows, columns) float32 brightness above `ground`
    ground : (rows, columns) brightness of asphalt in the half metre around
    spread : (rows, columns) scatter of asphalt's contrast there, a standard deviation
    slope : (2, rows, columns) along and across the road against the ground around, metres per metre: small on a road, large on the face of a curb
    """

    contrast: np.ndarray
    ground: np.ndarray
    spread: np.ndarray
    slope: np.ndarray

    @classmethod
    def of(cls, cell: np.ndarray, value: np.ndarray, height: np.ndarray, shape: tuple[int, int],
           paint: float = PAINT_CONTRAST) -> CellAverages:
        """CellAverages of points.

        Parameters
        ----------
        cell : (N,) flat cell number of each point
        value : (N,) its brightness
        height : (N,) int, its height in units of 0.1 mm
        shape : (rows, columns)
        paint : spreads above the average about it at which a cell may be paint
        """
        count = np.bincount(cell, minlength=shape[0] * shape[1]).reshape(shape).astype(float)
        total = np.bincount(cell, np.rint(value.astype(float) * BRIGHTNESS_STEPS), count.size).reshape(shape) / BRIGHTNESS_STEPS
        low = int(height.min(initial=0))
        risen = np.bincount(cell, (height - low).astype(float), count.size).reshape(shape) * COORDINATE_SCALE
        spot, around = _gaussian_mean(count, total, SPOT_SIGMA), _gaussian_mean(count, total, GROUND_SIGMA)
        # paint, rails and drains are no ground: cells beside them are compared with asphalt
        contrast = spot - around
        with np.errstate(invalid="ignore"):
            scatter = _local_scatter(contrast)
            plain = (contrast > -GROUND_CONTRAST * scatter) & (contrast < paint * scatter)
        asphalt = _gaussian_mean(count * plain, total * plain, GROUND_SIGMA)
        around = np.where(np.isfinite(asphalt), asphalt, around)
        contrast = (spot - around).astype(np.float32)
        tilts = [np.gradient(_gaussian_mean(count, risen, sigma), CELL_SIZE) for sigma in (SLOPE_SIGMA, GROUND_SLOPE_SIGMA)]
        slope = np.stack([near - about for near, about in zip(*tilts)]).astype(np.float32)
        return cls(contrast, around, _local_scatter(contrast), slope)

    @property
    def z(self) -> np.ndarray:
        """(rows, columns) contrast in spreads."""
        return self.contrast / self.spread


def _gaussian_mean(count, total, sigma):
    """Gaussian average, NaN where there are too few points."""
    near, near_total = (ndimage.gaussian_filter(a, sigma, mode="constant", truncate=3.0) for a in (count, total))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(near > MIN_DENSITY, near_total / near, np.nan)


def _local_scatter(contrast: np.ndarray) -> np.ndarray:
    """Scatter of asphalt's contrast in the metres around each cell, a standard deviation, float32; NaN where nothing is known.

    It is estimated from values a little below the median: paint lies above them, rails, covers and seams below.
    """
    rows, columns = (-(-n // SCATTER_BLOCK) for n in contrast.shape)
    padded = np.full((rows * SCATTER_BLOCK, columns * SCATTER_BLOCK), np.nan, np.float32)
    padded[:contrast.shape[0], :contrast.shape[1]] = contrast
    blocks = np.sort(padded.reshape(rows, SCATTER_BLOCK, columns, SCATTER_BLOCK).transpose(0, 2, 1, 3).reshape(rows, columns, -1), axis=2)
    count = np.isfinite(blocks).sum(axis=2, keepdims=True)
    low, median = (np.take_along_axis(blocks, (share * np.maximum(count - 1, 0)).astype(np.int64), 2)[..., 0]
                   for share in (SCATTER_QUANTILE, 0.5))
    spread = np.where(count[..., 0] >= MIN_BLOCK_CELLS, (median - low) / SCATTER_SIGMAS, np.nan)
    known = spread[np.isfinite(spread)]
    if not len(known):
        return np.full(contrast.shape, np.nan, np.float32)
    reach = SCATTER_BLOCKS // 2
    around = np.lib.stride_tricks.sliding_window_view(np.pad(spread, reach, constant_values=np.nan), (SCATTER_BLOCKS, SCATTER_BLOCKS))
    ordered = np.sort(around.reshape(rows, columns, -1), axis=2)
    count = np.isfinite(ordered).sum(axis=2, keepdims=True)
    middle = np.take_along_axis(ordered, np.maximum(count - 1, 0) // 2, 2)[..., 0]
    middle = np.where(count[..., 0] > 0, middle, np.median(known))
    places = [np.clip((np.arange(n) + 0.5) / SCATTER_BLOCK - 0.5, 0, m - 1) for n, m in zip(contrast.shape, middle.shape)]
    return ndimage.map_coordinates(middle, np.meshgrid(*places, indexing="ij"), order=1).astype(np.float32)


@dataclass(frozen=True)
class BrightPiece:
    """A connected bright piece of a window.

    cells : rows and columns of its cells, (n,) int each
    shape : Shape
    thickness : m, where it is thickest
    slope : (2,) mean slope along and across the road, m per m
    rim : m from the rim of the road
    top : contrast of its bright cells
    fading : share of its contrast that is left just beside it
    z : contrast in spreads of asphalt
    """

    cells: tuple[np.ndarray, np.ndarray]
    shape: Shape
    thickness: float
    slope: np.ndarray
    rim: float
    top: float
    fading: float
    z: float

    @property
    def is_elongated(self) -> bool:
        """Whether it is long for its width: as a whole, or, branched like hatching, by its area over its thickness."""
        if self.shape.area < STROKE_AREA or self.fading > MAX_FADING:
            return False
        if self.shape.length >= STROKE_LENGTH and self.shape.elongation >= STROKE_ELONGATION:
            return True
        return self.shape.area / self.thickness >= max(BRANCHED_LENGTH, STROKE_ELONGATION * self.thickness)

    @property
    def is_line(self) -> bool:
        """Whether it is a thin straight line, however faint, on asphalt: between dark seams asphalt itself is brighter than what lies beside it."""
        thin = self.shape.width <= FAINT_LINE_WIDTH and self.shape.elongation >= FAINT_LINE_ELONGATION
        return self.is_elongated and thin and self.shape.length >= FAINT_LINE_LENGTH and self.fading >= -MAX_FADING


@dataclass(frozen=True)
class ViewSamples:
    """The points of a window, with the place from which each was measured.

    cell : (N,) int, flat number of the point's cell
    value : (N,) its brightness
    covered : (N,) bool, whether an object is above it
    view : (N,) int, the place of the vehicle, or None where it is not known
    """

    cell: np.ndarray
    value: np.ndarray
    covered: np.ndarray
    view: np.ndarray | None = None


def views(points: Points, frame: RoadFrame) -> np.ndarray | None:
    """The half metre of the vehicle's way from which each point was measured.

    Parameters
    ----------
    points : (N) road points

    Returns
    -------
    (N,) int numbers; None where times are not known
    """
    if not frame.has_time:
        return None
    found = np.zeros(len(points), np.int64)
    for number in np.unique(points.pass_number):
        rows = np.flatnonzero(points.pass_number == number)
        found[rows] = np.floor(frame.passes[number].station_at(points.time[rows]) / VIEW_LENGTH) + (int(number) << 32)
    return found


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
        bright, faint = z > PIECE_BRIGHTNESS * threshold, z > PIECE_BRIGHTNESS * FAINT_LINE * threshold
    mask = np.zeros(rim.shape, bool)
    strokes = [piece for piece in _bright_pieces(bright, averages, rim, threshold) if piece.is_elongated
               and (piece.z >= CLEAR_BRIGHTNESS * threshold or piece.shape.length >= CLEAR_LENGTH)]
    lines = [piece for piece in _bright_pieces(faint, averages, rim, FAINT_LINE * threshold) if piece.is_line]
    # a stroke may be the clear part of a line
    for piece in (piece for some in (strokes, lines)
                  for piece in _without_artefacts([one for one in some if np.hypot(*one.slope) < MAX_SLOPE], samples, rim.shape)):
        row, column = piece.cells
        # beside a broad stroke the average is darker than asphalt
        inner = contrast[row, column] > HALF_MAXIMUM * piece.top * (1.0 + min(piece.fading, 0.0))
        mask[row[inner], column[inner]] = True
    return mask


def _dashes_of_rows(averages, rim, samples, threshold):
    """Pieces that follow on each other as dashes do, and fainter ones where these rows lead."""
    with np.errstate(invalid="ignore"):
        dashes = _dashes(averages, rim, samples, averages.z > PIECE_BRIGHTNESS * threshold, FAINT_DASH * threshold)
    rows = []
    for row in rows_of_dashes([piece.shape for piece in dashes]):
        clear = sum(dashes[k].z >= threshold for k in row)
        if clear >= max(MIN_DASHES_IN_ROW, len(row) / 2) and np.hypot(*np.mean([dashes[k].slope for k in row], axis=0)) < MAX_SLOPE:
            rows.append([dashes[k] for k in row])
    if not rows:
        return []
    with np.errstate(invalid="ignore"):
        worn = _dashes(averages, rim, samples, averages.z > PIECE_BRIGHTNESS * WORN_DASH * threshold, WORN_DASH * threshold)
    shapes = [piece.shape for piece in worn]
    return [piece for row in rows for piece in row + [worn[k] for k in dashes_beyond([piece.shape for piece in row], shapes)]]


def _dashes(averages, rim, samples, bright, threshold):
    """Pieces that may be dashes: the average joins neighbouring ones, so they are searched for in the mask cut at half maximum."""
    contrast = averages.contrast
    tops = ndimage.maximum_filter(np.where(bright, contrast, 0.0), 2 * HALF_MAXIMUM_REACH + 1)
    with np.errstate(invalid="ignore"):
        cut = bright & (contrast > HALF_MAXIMUM * tops)
    found = [piece for piece in _bright_pieces(cut, averages, rim, threshold)
             if piece.shape.length >= DASH_LENGTH and piece.shape.width <= DASH_WIDTH and np.hypot(*piece.slope) < DASH_SLOPE_FACTOR * MAX_SLOPE]
    return _without_artefacts(found, samples, rim.shape)


def _bright_pieces(mask: np.ndarray, averages: CellAverages, rim: np.ndarray, threshold: float) -> list[BrightPiece]:
    """Connected pieces whose brightest tenth reaches the threshold, spreads above asphalt, away from the road's rim; the smallest are left out."""
    labels, count = ndimage.label(mask, np.ones((3, 3), bool))
    large = np.bincount(labels.ravel(), minlength=count + 1) * CELL_SIZE**2 >= DASH_AREA
    z, found = averages.z, []
    for number, box in enumerate(ndimage.find_objects(labels), start=1):
        if not large[number]:
            continue
        inside = labels[box] == number
        row, column = (a + side.start for a, side in zip(np.nonzero(inside), box))
        tilt = averages.slope[:, row, column]
        tilt = tilt[:, np.isfinite(tilt[0])]
        reached = float(np.percentile(z[row, column], TOP_PERCENTILE))
        if reached < threshold or np.median(rim[row, column]) <= MIN_RIM_DISTANCE or not tilt.size:
            continue
        contrast = averages.contrast[row, column]
        top, highest = np.percentile(contrast, [USUAL_PERCENTILE, TOP_PERCENTILE]).tolist()
        found.append(BrightPiece((row, column), measure(row * CELL_UNITS, column * CELL_UNITS),
                           2.0 * CELL_SIZE * ndimage.distance_transform_edt(np.pad(inside, 1)).max(), tilt.mean(axis=1),
                           float(np.median(rim[row, column])), top,
                           _beside(inside & (averages.contrast[box] > HALF_MAXIMUM * highest), box, averages.contrast) / highest, reached))
    return found


def _beside(inside, box, contrast):
    """Mean contrast about a decimetre beside the bright half of a piece."""
    far = FADING_RING[1] + 1
    window = tuple(slice(max(side.start - far, 0), side.stop + far) for side in box)
    piece = np.zeros(contrast[window].shape, bool)
    piece[tuple(slice(side.start - w.start, side.stop - w.start) for side, w in zip(box, window))] = inside
    apart = ndimage.distance_transform_edt(~piece)
    values = contrast[window][(apart > FADING_RING[0]) & (apart <= FADING_RING[1])]
    values = values[np.isfinite(values)]
    return float(values.mean()) if len(values) else 0.0


def _without_artefacts(found: list[BrightPiece], samples: ViewSamples, shape: tuple[int, ...]) -> list[BrightPiece]:
    """The pieces that no object covers, and that are brighter than their surroundings in all views together.

    The contrast of each view is one observation, weighted by its points; the mean must be 3 of its standard errors above zero.
    """
    if not found:
        return found
    number = np.full(shape, -1)
    for k, piece in enumerate(found):
        number[piece.cells] = k
    of = number.ravel()[samples.cell]
    on = of >= 0
    points = np.bincount(of[on], minlength=len(found))
    good = np.bincount(of[on], samples.covered[on], len(found)) <= MAX_COVERED * points
    if samples.view is not None:
        good &= _bright_in_all_views(number, samples, len(found))
    return [piece for piece, kept in zip(found, good) if kept]


def _bright_in_all_views(number, samples, count):
    apart, nearest = ndimage.distance_transform_edt(number < 0, return_indices=True)
    inner = number >= 0
    used = inner | (apart >= VIEW_RING[0]) & (apart <= VIEW_RING[1])
    rows = np.flatnonzero(used.ravel()[samples.cell])
    cell, value = samples.cell[rows], np.rint(samples.value[rows].astype(float) * BRIGHTNESS_STEPS)
    view, at = np.unique(samples.view[rows], return_inverse=True)
    key = number[tuple(nearest)].ravel()[cell] * len(view) + at
    inside = inner.ravel()[cell]
    (n, total), (around, around_total) = (
        (np.bincount(key[side], minlength=count * len(view)), np.bincount(key[side], value[side], count * len(view)) / BRIGHTNESS_STEPS)
        for side in (inside, ~inside))
    with np.errstate(invalid="ignore", divide="ignore"):
        weight = np.where((n > 1) & (around > 1), n * around / (n + around), 0.0).reshape(count, -1)
        above = np.where(weight > 0, (total / n - around_total / around).reshape(count, -1), 0.0)
        views, whole = (weight > 0).sum(axis=1), weight.sum(axis=1)
        mean = (weight * above).sum(axis=1) / whole
        error = np.sqrt(((weight * (above - mean[:, None])) ** 2).sum(axis=1) * views / (views - 1)) / whole
        return (views >= MIN_VIEWS) & (mean > MIN_VIEW_SIGMAS * error)


# Faint lines: where the ground is darker than usual or the strip beside it brighter, a threshold misses a line that still stands out against both
# its sides, over metres along the road.

STROKE_CELLS = 3          # across the road: 12 cm, of which the line is the mean
FLANK_CELLS = 4, 5        # from the middle of the stroke: what lies beside it, on either side
BEYOND_CELLS = 15         # from the middle of the stroke: the ground of the half metre farther on, where it was scanned
LEAST_RIM = 0.22          # m from the middle of the stroke to the rim of what was scanned: both flanks are ground, and no gutter ends there
MEAN_ALONG = 13           # cells: half a metre that both are taken over
MIN_CELLS_AVERAGED = 6    # of the stroke, and of the flanks, that were scanned
STROKE_REACH = 2          # cells from the middle of the stroke that may be paint
DRIFT_CELLS = 1           # either way that a line wavers from row to row
LONGEST_BREAK = 15        # cells along the road: a worn spot
SHORTEST_LINE = 50        # cells along the road: 2 m
MIN_PAINTED_SHARE = 0.65  # of the cells of a line: wear leaves more, and of even ground half are brighter than the mean
MAX_REFUSED_SHARE = 0.05  # of the cells of a line
LEAST_RATIO = 0.10        # of the brightness beside it, by which a line is brighter
CLEAR_SIGMAS = 3.0        # standard deviations of what asphalt shows, by which a line stands out


def faint_lines(brightness: np.ndarray, scanned: np.ndarray, rim: np.ndarray, found: np.ndarray,
                refused: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cells of narrow lines along the road, where there is no paint yet.

    Parameters
    ----------
    brightness : (rows, columns) NaN where nothing was scanned; rows along the road
    scanned : (rows, columns) bool, cells that points lie in
    rim : (rows, columns) m from the rim of what was scanned
    found : (rows, columns) bool, paint that a threshold found
    refused : (rows, columns) bool, what it found and what is none: a line that is such in part is none

    Returns
    -------
    lines : (rows, columns) bool
    halfway : (rows, columns) float32, the brightness halfway from beside the line to the line, at its cells
    """
    known = scanned & np.isfinite(brightness)
    # (2, rows, columns) how many cells and their sum, over half a metre along the road
    sums = np.stack([cv2.boxFilter(a, -1, (1, MEAN_ALONG), normalize=False, borderType=cv2.BORDER_CONSTANT)
                     for a in (known.astype(np.float32), np.where(known, brightness, 0.0).astype(np.float32))])
    half = STROKE_CELLS // 2
    stroke = _mean_of_columns(sums, range(-half, half + 1))
    beside = np.maximum(_mean_of_columns(sums, FLANK_CELLS), _mean_of_columns(sums, [-step for step in FLANK_CELLS]))
    # between two dark seams asphalt is no line: it is no brighter than what lies beyond them
    beyond = range(FLANK_CELLS[1] + 1, BEYOND_CELLS + 1), range(-FLANK_CELLS[1] - 1, -BEYOND_CELLS - 1, -1)
    with np.errstate(invalid="ignore"):
        clear = stroke - beside > LEAST_RATIO * beside
        cells = np.flatnonzero(clear)
        own = np.fmax(beside.take(cells), np.fmax(*(_mean_of_columns(sums, steps, cells) for steps in beyond)))
        clear.ravel()[cells] = stroke.take(cells) - own > LEAST_RATIO * own
    lines, halfway = np.zeros(known.shape, bool), np.full(known.shape, np.inf, np.float32)
    # most windows have no such line: what asphalt scatters by is not asked for there
    if not (_long_lines(_wavering(clear & (rim > LEAST_RIM)), lines) * clear * ~_near(found)).any():
        return lines, halfway
    beside = np.fmax(beside, np.where(np.isfinite(beside), np.fmax(*(_mean_of_columns(sums, steps) for steps in beyond)), np.nan))
    above = stroke - beside
    with np.errstate(invalid="ignore"):
        clear &= above > CLEAR_SIGMAS * _local_scatter(above)
    above = np.where(clear, above, 0.0).astype(np.float32)
    # the middle of the stroke
    ridge = clear & (rim > LEAST_RIM) & (above >= cv2.dilate(above, np.ones((1, 2 * STROKE_REACH + 1), np.uint8)))
    line = np.where(ridge & ~_near(found), _long_lines(_wavering(ridge), refused), 0)
    row, column = np.nonzero(line)
    level = ((stroke + beside) / 2)[row, column]
    # (n, steps) the cells of the stroke about each cell of its middle
    across = np.clip(column[:, None] + np.arange(-STROKE_REACH, STROKE_REACH + 1), 0, line.shape[1] - 1)
    along = np.broadcast_to(row[:, None], across.shape)
    seen = known[along, across]
    with np.errstate(invalid="ignore"):
        bright = seen & (brightness[along, across] > level[:, None])
    # a few bright specks raise a mean, too
    number = line[row, column]
    inner = slice(STROKE_REACH - half, STROKE_REACH + half + 1)
    filled = [np.bincount(number, cells[:, inner].sum(axis=1), line.max() + 1) for cells in (bright, seen)]
    bright &= (filled[0] >= MIN_PAINTED_SHARE * filled[1])[number][:, None]
    lines[along[bright], across[bright]] = True
    np.minimum.at(halfway, (along[bright], across[bright]), np.broadcast_to(level[:, None], bright.shape)[bright].astype(np.float32))
    return lines, halfway


def _mean_of_columns(sums, steps, cells=None):
    """Mean over the columns some steps beside all cells, or beside some of them, (n,) flat numbers; NaN where too few cells were scanned."""
    count, total = (sum(_shifted(a, step) if cells is None else _shifted_at(a, step, cells) for step in steps) for a in sums)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(count >= MIN_CELLS_AVERAGED, total / count, np.float32(np.nan))


def _shifted(values, step):
    """Values some columns farther on, 0 beyond the last."""
    found = np.zeros_like(values)
    last = values.shape[1] - abs(step)
    if last > 0:
        found[:, max(-step, 0):max(-step, 0) + last] = values[:, max(step, 0):max(step, 0) + last]
    return found


def _shifted_at(values, step, cells):
    """The same beside some cells."""
    column = cells % values.shape[1] + step
    return np.where((column >= 0) & (column < values.shape[1]), values.take(cells + step, mode="clip"), np.float32(0.0))


def _wavering(mask):
    """Cells of a mask and those that a line wavers to."""
    return cv2.dilate(mask.astype(np.uint8), np.ones((1, 2 * DRIFT_CELLS + 1), np.uint8)).astype(bool)


def _near(mask):
    """Cells beside some others, on either side of them."""
    box = np.ones((MEAN_ALONG, 2 * max(FLANK_CELLS) + 1), np.uint8)
    return cv2.dilate(mask.astype(np.uint8), box, borderType=cv2.BORDER_CONSTANT, borderValue=0).astype(bool)


def _long_lines(course, refused):
    """Numbers, from 1 on, of the pieces that run on along the road for long enough, slowly across it too; 0 elsewhere."""
    closed = fill_gaps(course, LONGEST_BREAK, 0)
    count, label, stats, _ = cv2.connectedComponentsWithStats(closed.astype(np.uint8), connectivity=8)
    area = np.maximum(stats[:, cv2.CC_STAT_AREA], 1)
    long = (stats[:, cv2.CC_STAT_HEIGHT] >= SHORTEST_LINE + MEAN_ALONG) & (np.bincount(label[refused], minlength=count) <= MAX_REFUSED_SHARE * area)
    long[0] = False
    return np.where(long, np.arange(count), 0)[label]
