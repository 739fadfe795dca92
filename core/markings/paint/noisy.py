"""Strokes of paint among noisy points: bright pieces that are long for their width, lie flat and are seen so from many places.

What is bright on a road and no paint gives itself away: the face of a curb is
steep, what shows beneath a parked car is covered by it, the arc of one beam is
bright from one place only, a patch fades out where paint has a rim, and blotches
have no length. A short dash is told from a blotch by the row it stands in.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...survey.store.records import COORDINATE_SCALE
from ..objects.dash_rows import MIN_DASHES_IN_ROW, rows_of_dashes
from ..objects.road_grid import CELL_SIZE, CELL_UNITS
from ..objects.shape import Shape, measure

# Noisy points seen through averages: how much brighter a spot is than the road about it, and how steep it lies.

SPOT = 1.25       # cells, sigma of the average that a spot is seen through
AROUND_SPOT = 10.0     # cells, sigma of the average that this is compared with: tracks, patches and shadows are wider than strokes
FEWEST_IN_SPOT = 0.05     # points a cell, so averaged, below which nothing is known
BLOCK = 25        # cells: the scatter of averages is taken in squares of 1 m
BLOCKS = 5        # squares either way that have one scatter: the median of theirs
FEWEST_IN_BLOCK = 200   # cells
LOWER, SIGMAS = 0.30, 0.5244   # quantile that tells the scatter, and how far below the median: dark rails are below it
PLAIN_ROAD = 2.0       # spreads either way that asphalt keeps to
STEEP, GROUND = 3.0, 12.0      # cells, sigmas of the heights whose slopes are compared


@dataclass(frozen=True)
class Averages:
    """A window of the road in cells, (rows, columns) each, NaN where nothing is known.

    contrast : brightness above `ground`, that of the half metre about
    spread : how much the contrast of asphalt scatters there
    slope : tilt against the ground about, metres per metre: small on a road, large on the face of a curb
    """

    contrast: np.ndarray
    ground: np.ndarray
    spread: np.ndarray
    slope: np.ndarray

    @classmethod
    def of(cls, cell, value, height, shape):
        """Averages of points.

        Parameters
        ----------
        cell : (N,) flat cell number of each point
        value : (N,) its brightness
        height : (N,) int, its height in units of 0.1 mm
        shape : (rows, columns)
        """
        # in whole numbers, which sum exactly in any order
        count = np.bincount(cell, minlength=shape[0] * shape[1]).reshape(shape).astype(float)
        total = np.bincount(cell, np.rint(value.astype(float) * 64), count.size).reshape(shape) / 64
        low = int(height.min(initial=0))
        risen = np.bincount(cell, (height - low).astype(float), count.size).reshape(shape) * COORDINATE_SCALE
        spot, around = _mean(count, total, SPOT), _mean(count, total, AROUND_SPOT)
        # paint, rails and drains are no ground: a spot beside them is compared with asphalt
        contrast = spot - around
        with np.errstate(invalid="ignore"):
            plain = contrast > -PLAIN_ROAD * scatter_about(contrast)
        asphalt = _mean(count * plain, total * plain, AROUND_SPOT)
        around = np.where(np.isfinite(asphalt), asphalt, around)
        contrast = (spot - around).astype(np.float32)
        tilts = [np.gradient(_mean(count, risen, sigma), CELL_SIZE) for sigma in (STEEP, GROUND)]
        slope = np.stack([near - about for near, about in zip(*tilts)]).astype(np.float32)
        return cls(contrast, around, scatter_about(contrast), slope)

    @property
    def z(self):
        """Contrast in spreads."""
        return self.contrast / self.spread


def _mean(count, total, sigma):
    near, near_total = (ndimage.gaussian_filter(a, sigma, mode="constant", truncate=3.0) for a in (count, total))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(near > FEWEST_IN_SPOT, near_total / near, np.nan)


def scatter_about(contrast):
    """How much asphalt's contrast scatters in the metres about each cell, as a standard deviation.

    It is told by the values a little below the median: paint lies above them,
    rails, covers and seams below.

    Parameters
    ----------
    contrast : (rows, columns) float, NaN where nothing is known

    Returns
    -------
    (rows, columns) float32; that of the whole window where too little is known near by, NaN where nowhere
    """
    rows, columns = (-(-n // BLOCK) for n in contrast.shape)
    padded = np.full((rows * BLOCK, columns * BLOCK), np.nan, np.float32)
    padded[:contrast.shape[0], :contrast.shape[1]] = contrast
    blocks = np.sort(padded.reshape(rows, BLOCK, columns, BLOCK).transpose(0, 2, 1, 3).reshape(rows, columns, -1), axis=2)
    count = np.isfinite(blocks).sum(axis=2, keepdims=True)
    low, median = (np.take_along_axis(blocks, (share * np.maximum(count - 1, 0)).astype(np.int64), 2)[..., 0]
                   for share in (LOWER, 0.5))
    spread = np.where(count[..., 0] >= FEWEST_IN_BLOCK, (median - low) / SIGMAS, np.nan)
    known = spread[np.isfinite(spread)]
    if not len(known):
        return np.full(contrast.shape, np.nan, np.float32)
    reach = BLOCKS // 2
    about = np.lib.stride_tricks.sliding_window_view(np.pad(spread, reach, constant_values=np.nan), (BLOCKS, BLOCKS))
    ordered = np.sort(about.reshape(rows, columns, -1), axis=2)
    count = np.isfinite(ordered).sum(axis=2, keepdims=True)
    middle = np.take_along_axis(ordered, np.maximum(count - 1, 0) // 2, 2)[..., 0]
    middle = np.where(count[..., 0] > 0, middle, np.median(known))
    places = [np.clip((np.arange(n) + 0.5) / BLOCK - 0.5, 0, m - 1) for n, m in zip(contrast.shape, middle.shape)]
    return ndimage.map_coordinates(middle, np.meshgrid(*places, indexing="ij"), order=1).astype(np.float32)

RIM = 0.20            # m from the rim of the road: what hugs it is a curb or what grows over it
FAINT = 0.75          # of the threshold: a dash may be so faint where as many of its row are plain
RISE = 0.6          # of the threshold: how bright all of a piece is that reaches the threshold in places
BRIGHTEST = 90        # %: of a piece's cells, whose brightness must reach the threshold
USUAL = 75            # %: of a piece's cells, whose brightness above asphalt is that of the piece
HALF, NEAR = 0.5, 7   # of the height above asphalt of what is brightest within 7 cells: where the average has blurred a rim to
FADING = 0.15         # of its brightness: what is as bright as that beside it has no rim
BESIDE = 1.5, 3         # cells from a piece
FLAT = 0.020          # m per m against the ground about: what is steeper is the face of a curb
STEEPER = 2.0         # times that: a single dash may seem to be so steep where the others of its row are not
COVERED = 1 / 3       # of a piece's points, found beneath something: a parked car
STROKE_AREA, STROKE_LENGTH, ELONGATED = 0.12, 0.80, 3.5  # m2, m: least of a stroke on its own
PLAIN, LONG = 4 / 3, 2.0   # of the threshold, m: a stroke must be so plain or so long
BRANCHED = 1.5        # m: least of a branched one
DASH_AREA, DASH_LENGTH, DASH_WIDTH = 0.03, 0.25, 0.40    # m2, m: least, least and most of a dash in a row
AROUND = 3, 8         # cells from a piece, where asphalt is again
VIEW = 0.5            # m of the vehicle's way: from farther apart a place is seen anew
FEWEST_VIEWS, SURE = 4, 3.0   # views, and standard errors by which a piece is brighter than what is around in the same view


@dataclass(frozen=True)
class Piece:
    """A connected bright piece of a window.

    cells : its rows and columns; thickness : m, where it is thickest; slope : (2,) its mean tilt along and across the road
    rim : m from the rim of the road; top : its brightness above asphalt; z : the same in spreads
    fading : share of its brightness that is left just beside it
    """

    cells: tuple
    shape: Shape
    thickness: float
    slope: np.ndarray
    rim: float
    top: float
    fading: float
    z: float

    @property
    def is_stroke(self):
        """Whether it is long for its width: as a whole, or branched as hatching is, area over thickness."""
        if self.shape.area < STROKE_AREA or self.fading > FADING:
            return False
        if self.shape.length >= STROKE_LENGTH and self.shape.elongation >= ELONGATED:
            return True
        return self.shape.area / self.thickness >= max(BRANCHED, ELONGATED * self.thickness)

    @property
    def may_be_dash(self):
        return self.shape.length >= DASH_LENGTH and self.shape.width <= DASH_WIDTH


@dataclass(frozen=True)
class Witnesses:
    """The points of a window, one entry each.

    cell : flat number of its cell; value : its brightness; covered : whether something stands above it
    view : int, a number for where the vehicle was, or None where that is not known
    """

    cell: np.ndarray
    value: np.ndarray
    covered: np.ndarray
    view: np.ndarray = None


def views(points, frame):
    """(N,) int, the half metre of its way in which the vehicle saw each point; None where times are not known."""
    if not frame.has_time:
        return None
    found = np.zeros(len(points), np.int64)
    for number in np.unique(points.pass_number):
        rows = np.flatnonzero(points.pass_number == number)
        found[rows] = np.floor(frame.passes[number].station_at(points.time[rows]) / VIEW) + (int(number) << 32)
    return found


def stroke_cells(averages, rim, witnesses, threshold):
    """Cells of paint.

    Parameters
    ----------
    averages : Averages of a window of the road
    rim : (rows, columns) metres from the rim of the road
    witnesses : Witnesses
    threshold : spreads above asphalt that paint reaches

    Returns
    -------
    (rows, columns) bool
    """
    z, contrast = averages.z, averages.contrast
    with np.errstate(invalid="ignore"):
        bright = z > RISE * threshold
        tops = ndimage.maximum_filter(np.where(bright, contrast, 0.0), 2 * NEAR + 1)
        parted = bright & (contrast > HALF * tops)
    mask = np.zeros(rim.shape, bool)
    strokes = [piece for piece in pieces(bright, averages, rim, threshold) if piece.is_stroke
               and np.hypot(*piece.slope) < FLAT and (piece.z >= PLAIN * threshold or piece.shape.length >= LONG)]
    for piece in trusted(strokes, witnesses, rim.shape):
        row, column = piece.cells
        # an average makes what is beside a broad stroke look darker than asphalt
        inner = contrast[row, column] > HALF * piece.top * (1.0 + min(piece.fading, 0.0))
        mask[row[inner], column[inner]] = True
    # what noise took from the inside of strokes is theirs
    mask = ndimage.binary_closing(mask, np.ones((3, 3), bool), iterations=2)
    # an average runs neighbouring dashes together: they are looked for where it has been cut at half height
    dashes = [piece for piece in pieces(parted, averages, rim, FAINT * threshold)
              if piece.may_be_dash and np.hypot(*piece.slope) < STEEPER * FLAT]
    dashes = trusted(dashes, witnesses, rim.shape)
    for row in rows_of_dashes([piece.shape for piece in dashes]):
        plain = sum(dashes[k].z >= threshold for k in row)
        if plain >= max(MIN_DASHES_IN_ROW, len(row) / 2) and np.hypot(*np.mean([dashes[k].slope for k in row], axis=0)) < FLAT:
            for k in row:
                mask[dashes[k].cells] = True
    return mask


def pieces(mask, averages, rim, threshold):
    """Connected pieces of a mask that reach the threshold away from the road's rim; the smallest are left out."""
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
        reached = float(np.percentile(z[row, column], BRIGHTEST))
        if reached < threshold or np.median(rim[row, column]) <= RIM or not tilt.size:
            continue
        contrast = averages.contrast[row, column]
        top, highest = np.percentile(contrast, [USUAL, BRIGHTEST]).tolist()
        found.append(Piece((row, column), measure(row * CELL_UNITS, column * CELL_UNITS),
                           2.0 * CELL_SIZE * ndimage.distance_transform_edt(np.pad(inside, 1)).max(), tilt.mean(axis=1),
                           float(np.median(rim[row, column])), top,
                           _beside(inside & (averages.contrast[box] > HALF * highest), box, averages.contrast) / highest, reached))
    return found


def _beside(inside, box, contrast):
    """Mean contrast a decimetre or two beside the bright half of a piece."""
    far = BESIDE[1] + 1
    window = tuple(slice(max(side.start - far, 0), side.stop + far) for side in box)
    piece = np.zeros(contrast[window].shape, bool)
    piece[tuple(slice(side.start - w.start, side.stop - w.start) for side, w in zip(box, window))] = inside
    apart = ndimage.distance_transform_edt(~piece)
    values = contrast[window][(apart > BESIDE[0]) & (apart <= BESIDE[1])]
    values = values[np.isfinite(values)]
    return float(values.mean()) if len(values) else 0.0


def trusted(found, witnesses, shape):
    """The pieces that nothing covers, and that are brighter than what is around them in whichever view is taken.

    The contrast of each view is one observation, weighed by its points; their
    mean must be 3 of its standard errors above nothing.
    """
    if not found:
        return found
    number = np.full(shape, -1)
    for k, piece in enumerate(found):
        number[piece.cells] = k
    of = number.ravel()[witnesses.cell]
    on = of >= 0
    points = np.bincount(of[on], minlength=len(found))
    good = np.bincount(of[on], witnesses.covered[on], len(found)) <= COVERED * points
    if witnesses.view is not None:
        good &= _bright_in_all_views(number, witnesses, len(found))
    return [piece for piece, kept in zip(found, good) if kept]


def _bright_in_all_views(number, witnesses, count):
    apart, nearest = ndimage.distance_transform_edt(number < 0, return_indices=True)
    inner = number >= 0
    used = inner | (apart >= AROUND[0]) & (apart <= AROUND[1])
    rows = np.flatnonzero(used.ravel()[witnesses.cell])
    cell, value = witnesses.cell[rows], np.rint(witnesses.value[rows].astype(float) * 64)
    view, at = np.unique(witnesses.view[rows], return_inverse=True)
    key = number[tuple(nearest)].ravel()[cell] * len(view) + at
    inside = inner.ravel()[cell]
    (n, total), (around, around_total) = (
        (np.bincount(key[side], minlength=count * len(view)), np.bincount(key[side], value[side], count * len(view)) / 64)
        for side in (inside, ~inside))
    with np.errstate(invalid="ignore", divide="ignore"):
        weight = np.where((n > 1) & (around > 1), n * around / (n + around), 0.0).reshape(count, -1)
        above = np.where(weight > 0, (total / n - around_total / around).reshape(count, -1), 0.0)
        views, whole = (weight > 0).sum(axis=1), weight.sum(axis=1)
        mean = (weight * above).sum(axis=1) / whole
        error = np.sqrt(((weight * (above - mean[:, None])) ** 2).sum(axis=1) * views / (views - 1)) / whole
        return (views >= FEWEST_VIEWS) & (mean > SURE * error)
