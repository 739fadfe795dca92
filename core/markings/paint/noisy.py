"""Paint in averages of noisy points: bright pieces that are more likely paint than anything else that is bright on a road.

Single points are too noisy to be classified, so averages over a decimetre are searched. The face of a curb is steep and lies at the rim, a surface
beneath a parked car is covered by it, the arc of one beam is bright from one place only, a patch is broad and fades out, a spot is round, and noise
is dim and short: what a piece measures weighs against each of these in nats. A short or worn dash is recognised by its row. Our own estimate.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from ...intensity.asphalt_model import INNER_QUANTILE, INNER_SIGMAS
from ...survey.frame.road_frame import RoadFrame
from ...survey.store.records import COORDINATE_SCALE, Points
from ..objects.repeating import likely_rows
from ..objects.shape import measure
from ..road_grid import CELL_SIZE, CELL_UNITS
from ..weights import NOISY
from .asphalt_level import of_squares

BRIGHTNESS_STEPS = 64   # derived: brightness is summed in whole 64ths: their sums are exact in any order


@dataclass(frozen=True)
class CellAverages:
    """Averages over a window of the road in cells, (rows, columns), NaN where nothing is known."""

    contrast: np.ndarray   # brightness above `ground`, which is that of asphalt in the half metre around
    ground: np.ndarray
    spread: np.ndarray   # scatter of asphalt's contrast there, a standard deviation
    slope: np.ndarray   # (2, rows, columns) m per m along and across the road against the ground around: small on a road, large on the face of a curb

    @classmethod
    def of(cls, cell: np.ndarray, value: np.ndarray, height: np.ndarray, shape: tuple[int, int], paint: float) -> CellAverages:
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

    It is estimated from values a little below the median: paint lies above them, dark rails, covers and seams below.
    """
    return of_squares(contrast, (INNER_QUANTILE, 0.5), lambda low, median: [(median - low) / INNER_SIGMAS])[0]


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
    """(rows, columns) bool, cells of paint: of pieces that are more likely paint than anything else, by themselves or as a row.

    `rim` : distance of cells from the rim of the road, m; `threshold` : spreads at which brightness speaks neither for paint nor against it.
    """
    with np.errstate(invalid="ignore"):
        bright, faint = (averages.z > share * threshold for share in (NOISY.bright, NOISY.faint))
        tops = ndimage.maximum_filter(np.where(faint, averages.contrast, 0.0), 2 * NOISY.half_maximum_reach + 1)
        # the average joins neighbouring pieces: they are parted at half maximum
        parted = faint & (averages.contrast > NOISY.half_maximum * tops)
    strokes, pieces = (_pieces(cells, averages) for cells in (bright, parted))
    shapes, tops, odds = _weighed(pieces, averages, rim, samples, threshold)
    in_row = np.zeros(len(shapes) + 1, bool)
    for row in likely_rows(shapes, odds[:, 0] + NOISY.noise):
        # all of a row is of one kind, and spots rarely stand in rows
        in_row[row + 1] = (odds[row, 1:].sum(axis=0) + [NOISY.next_spot * (len(row) - 2), 0.0, 0.0, 0.0, 0.0] > 0.0).all()
    mask = _bright_half(pieces, averages, tops, odds)
    _, tops, odds = _weighed(strokes, averages, rim, samples, threshold)
    # a stroke that dashes are a good part of is these
    dashes = np.bincount(strokes.ravel(), in_row[pieces].ravel(), len(odds) + 1)[1:] > NOISY.dashes * np.bincount(strokes.ravel())[1:]
    mask |= _bright_half(strokes, averages, tops, np.where(dashes[:, None], -np.inf, odds))
    # holes that noise left in strokes are closed
    return ndimage.binary_closing(mask, np.ones((3, 3), bool), iterations=2) | in_row[pieces]


def _bright_half(label, averages, tops, odds):
    """(rows, columns) bool, cells of more than half the contrast of their piece, of those that are more likely paint than anything else."""
    least = np.where(odds.min(axis=1, initial=np.inf) > 0.0, NOISY.half_maximum * tops, np.inf)
    with np.errstate(invalid="ignore"):
        return averages.contrast > np.r_[np.inf, least][label]


def _pieces(mask, averages):
    """(rows, columns) int, number of the connected piece of a mask that each cell is of, 0 of none and of the smallest."""
    label, count = ndimage.label(mask, np.ones((3, 3), bool))
    known = np.bincount(label.ravel(), np.isfinite(averages.slope).all(axis=0).ravel(), count + 1)
    large = (np.bincount(label.ravel(), minlength=count + 1) * CELL_SIZE**2 >= NOISY.least_area) & (known > 0)
    large[0] = False
    return np.where(large, np.cumsum(large), 0)[label]


def _weighed(label, averages, rim, samples, threshold):
    """Shapes of N pieces, (N,) contrast of their bright cells, and (N, 6) nats by which each is more likely paint than something else.

    That is noise, a spot, the face of a curb, a patch, glare, and what shines beneath an object.
    """
    shapes, measured, z_of_cells = [], [], averages.z
    for number, box in enumerate(ndimage.find_objects(label), start=1):
        inside = label[box] == number
        row, column = (k + side.start for k, side in zip(np.nonzero(inside), box))
        shapes.append(measure(row * CELL_UNITS, column * CELL_UNITS))
        thickness = 2.0 * CELL_SIZE * ndimage.distance_transform_edt(np.pad(inside, 1)).max()
        top, highest = np.percentile(averages.contrast[row, column], [NOISY.usual_percentile, NOISY.top_percentile]).tolist()
        fading = _beside(inside & (averages.contrast[box] > NOISY.half_maximum * highest), box, averages.contrast) / highest
        tilt = averages.slope[:, row, column]
        measured.append((np.percentile(z_of_cells[row, column], NOISY.top_percentile), thickness, shapes[-1].area / thickness,
                         np.hypot(*tilt[:, np.isfinite(tilt).all(axis=0)].mean(axis=1)), np.median(rim[row, column]), fading,
                         # beside a broad stroke the average is darker than asphalt
                         top * (1.0 + min(fading, 0.0))))
    z, thickness, stroke, slope, from_rim, fading, tops = np.array(measured).reshape(-1, 7).T
    length, elongation = (np.array([getattr(shape, name) for shape in shapes]) for name in ("length", "elongation"))
    # branched, like hatching, it is as long as its area over its thickness
    length, elongation = np.maximum(length, stroke), np.maximum(elongation, stroke / np.maximum(thickness, CELL_SIZE))
    covered, sigmas = _seen(label, samples, len(shapes))
    bright = NOISY.brightness * (np.minimum(z / threshold, 2.0) - 1.0)
    seen = np.clip(sigmas, 0.0, 2 * NOISY.usual_sigmas) - NOISY.usual_sigmas
    longer = length - NOISY.usual_length
    return shapes, tops, np.stack([
        bright + NOISY.seen_often * seen + NOISY.per_length * np.clip(longer, 0.0, NOISY.most_length) - NOISY.noise,
        np.maximum(NOISY.per_elongation * (elongation - NOISY.elongation_of_spots) + NOISY.per_length * longer, NOISY.round),
        NOISY.flat - NOISY.per_slope * slope - NOISY.at_rim * np.exp(-from_rim / NOISY.rim_reach),
        NOISY.sharp + bright - NOISY.per_fading * fading - NOISY.per_width * np.maximum(thickness - NOISY.usual_width, 0.0),
        sigmas - NOISY.sigmas_of_glare,
        NOISY.uncovered - NOISY.per_cover * covered], axis=1)


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


def _seen(label, samples, count):
    """Of N pieces (N,) shares of their points beneath an object, and (N,) standard errors by which all views together saw them brighter than around.

    The contrast of each view is one observation, weighted by its points.
    """
    of = label.ravel()[samples.cell]
    points = np.maximum(np.bincount(of, minlength=count + 1), 1)
    covered = (np.bincount(of, samples.covered, count + 1) / points)[1:]
    if samples.view is None or not count:
        return covered, np.full(count, NOISY.usual_sigmas)
    apart, nearest = ndimage.distance_transform_edt(label == 0, return_indices=True)
    inner = label > 0
    used = inner | (apart >= NOISY.view_ring[0]) & (apart <= NOISY.view_ring[1])
    rows = np.flatnonzero(used.ravel()[samples.cell])
    cell, value = samples.cell[rows], np.rint(samples.value[rows].astype(float) * BRIGHTNESS_STEPS)
    view, view_index = np.unique(samples.view[rows], return_inverse=True)
    key = (label[tuple(nearest)].ravel()[cell] - 1) * len(view) + view_index
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
        # Student's distribution of a scatter that few views told is wider than the normal one
        sigmas = mean / error * np.sqrt(np.maximum(views - 3, 0) / np.maximum(views - 1, 1))
    return covered, np.nan_to_num(sigmas, posinf=0.0)
