"""Paint by the brightness of photographs, whose asphalt is as bright as shadows, seams of images and the sun leave it from metre to metre.

The level is that of the ground around a spot and not of a strip of road, and so is the scatter. Of what is brighter, a fleck of sun is as bright as
sunlit asphalt; paint is brighter than that, or lies above the shade by as much as elsewhere above the sun. Our own estimate.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from scipy import ndimage

from ...curves.robust import median
from ...lazy import cv2
from ..weights import ASPHALT, PHOTOGRAPHS, RIMS
from .asphalt_level import of_squares, otsu
from .not_paint import RimBands, beside_pieces, gutter_level


def bright_spots(brightness: np.ndarray,
                 rims: Sequence[RimBands]) -> tuple[np.ndarray, np.ndarray, Callable[..., np.ndarray], np.ndarray]:
    """Spreads above the ground around each cell, whether that makes it bright, what tells pieces of paint as in `clear_pieces`, and the brightness
    that points of paint have at least.

    All (rows, columns). `brightness` : (rows, columns) float32, NaN where nothing is known; `rims` : of the scanned road and of its edges.
    """
    ground = cv2.medianBlur(_filled(brightness), PHOTOGRAPHS.median_cells)
    # fills joints and tar, then takes off what is narrower than any painted area; the edges of shadows and patches stay where they are
    for operation, cells in ((cv2.MORPH_CLOSE, PHOTOGRAPHS.joint_cells), (cv2.MORPH_OPEN, PHOTOGRAPHS.level_cells)):
        ground = cv2.morphologyEx(ground, operation, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (cells, cells)))
    ground, spread = _asphalt(brightness, ground)
    z = (brightness - ground) / spread
    # half of the brightest three cells square nearby is where paint ends; worn paint is darker than what is left of it nearby
    brightest = cv2.dilate(cv2.blur(np.nan_to_num(z), (3, 3)), np.ones((PHOTOGRAPHS.half_maximum_cells,) * 2, np.uint8))
    threshold = np.clip(brightest / 2, ASPHALT.lowest, ASPHALT.highest)
    bright = z - np.maximum.reduce([gutter_level(z, rim) for rim in rims]) > threshold
    sunnier, light = _light(np.log(np.maximum(brightness, np.float32(1))), np.log(np.maximum(ground, np.float32(1))), bright)
    return z, bright, partial(_are_paint, z, brightness / spread, sunnier, light, bright, rims[0].distance), ground + (threshold - 0.5) * spread


def _light(brightness, ground, bright):
    """(rows, columns) logarithms by which asphalt in the sun nearby is brighter, and from -1 for asphalt to 1 for paint, in the sun or the shade.

    The latter by squares of distances in the usual step from asphalt to paint: light adds to logarithms of brightness, on paint and asphalt alike.
    Where asphalt has two levels and not one that scatters, the brighter one is that of the sun, taken from the metres around.

    brightness, ground : (rows, columns) float32 logarithms; bright : (rows, columns) bool
    """
    known = np.isfinite(brightness)
    threshold, below, usual, share = otsu(ground[known])
    squares, sunny = (of[::RIMS.coarse_cells, ::RIMS.coarse_cells].astype(np.float32) for of in (ground, known & (ground > threshold)))
    weight, near = (cv2.GaussianBlur(of, (0, 0), PHOTOGRAPHS.sun_squares) for of in (sunny, sunny * (squares - np.float32(usual))))
    sun = np.maximum(cv2.resize(np.float32(usual) + near / np.maximum(weight, np.float32(1e-3)), ground.shape[::-1]), ground)
    if share * (1.0 - share) * (usual - below) ** 2 < PHOTOGRAPHS.two_levels * ground[known].var():
        sun = ground
    above_sun = brightness - sun
    sure = above_sun[bright & (above_sun > PHOTOGRAPHS.paint_step / 2)]
    step = (PHOTOGRAPHS.paint_step * PHOTOGRAPHS.usual_cells + sure.sum()) / (PHOTOGRAPHS.usual_cells + len(sure))
    in_sun, in_shade = above_sun / step, (brightness - ground) / step
    asphalt, paint = (np.minimum(of_sun**2, of_shade**2) for of_sun, of_shade in ((in_sun, in_shade), (np.minimum(in_sun - 1, 0), in_shade - 1)))
    return np.maximum(-above_sun, 0), np.clip(asphalt - paint, -1, 1)


def _are_paint(z, above, sunnier, light, bright, rim, labels):
    """(rows, columns) bool, the cells of the parts of pieces that are paint: by what the whole piece is like, and by what the part is like itself.

    A line and a band of sun across it are one piece in the shade. The band has room for a disc that is wider than any line, and what is left on
    either side is the line: a morphological opening (G. Matheron, Random Sets and Integral Geometry, 1975). Arguments as of `_nats`.
    """
    pieces, disc = (labels > 0).view(np.uint8), cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (PHOTOGRAPHS.line_cells,) * 2)
    broad = cv2.morphologyEx(pieces, cv2.MORPH_OPEN, disc)
    (broad_end, parts), (thin_end, thin) = (cv2.connectedComponents(shape, connectivity=8) for shape in (broad, pieces - broad))
    parts, count = np.where(thin > 0, thin + (broad_end - 1), parts), broad_end + thin_end - 1
    of_piece, of_part = (_nats(z, above, sunnier, light, bright, rim, numbered) for numbered in (labels, parts))
    # what is too small to be sure of says nothing itself; a fleck of sun is no paint because its ragged rim went with the thin parts
    of_part[np.bincount(parts[bright], np.minimum(z[bright], ASPHALT.highest), count)[1:] < ASPHALT.evidence] = 0.0
    of_part[:broad_end - 1] = np.minimum(of_part[:broad_end - 1], 0.0)
    piece = np.zeros(count, int)
    piece[parts] = labels
    return np.append(False, of_part + of_piece[piece[1:] - 1] > 0.0)[parts]


def _nats(z, above, sunnier, light, bright, rim, labels):
    """(pieces,) nats by which pieces are paint, and not sunlit, dimmer than sun nearby, one-sided, ragged, or at the rim: a logistic regression.

    labels : as in `clear_pieces`; rim : (rows, columns) m to it; above : (rows, columns) brightness in spreads; the others as of `bright_spots`
    """
    numbers = np.arange(1, int(labels.max()) + 1)
    (_, left, usual), (darker, brighter, middle) = (np.nan_to_num(beside_pieces(values, labels, bright, PHOTOGRAPHS.beside)) for values in (z, above))
    # lengths of rim that run one way and across it: stripes alike stay as long for their breadth where a fleck of sun joins them
    slopes = np.gradient(cv2.GaussianBlur((labels > 0).astype(np.float32), (0, 0), PHOTOGRAPHS.rim_cells))
    moments = np.array([[ndimage.mean(a * b, labels, numbers) for a in slopes] for b in slopes])
    across, along = np.linalg.eigvalsh(moments.transpose(2, 0, 1)).T + 1e-6
    features = (np.clip(left / np.maximum(usual, 1.0), 0.0, PHOTOGRAPHS.most_fading),
                np.clip((brighter - darker) / np.maximum(middle - darker, 1.0), 0.0, 1.0),
                np.minimum(np.log(along / across), PHOTOGRAPHS.most_elongated),
                np.exp(-ndimage.mean(rim, labels, numbers) / PHOTOGRAPHS.rim_reach),
                *(ndimage.mean(np.nan_to_num(of), np.where(bright, labels, 0), numbers) for of in (sunnier, light)))
    return np.transpose(features) @ PHOTOGRAPHS.nats


def _asphalt(brightness, ground):
    """Brightness of the asphalt around each cell, and the standard deviation of asphalt there, (rows, columns) float32 each.

    The scatter is taken from quantiles below the median, since paint lies above it. `ground` : (rows, columns) the darkest of the ground around.
    """
    shares, sigmas = zip(*PHOTOGRAPHS.quantiles)

    def measures(low, high, dim, usual):
        dark, even = (high - low) / (sigmas[0] - sigmas[1]), (usual - dim) / (sigmas[2] - sigmas[3])
        return np.where(even > PHOTOGRAPHS.painted_square * dark, (high + sigmas[1] * dark, dark), (usual + sigmas[3] * even, even))

    middle, spread = of_squares(brightness - ground, shares, measures)
    return ground + middle, np.maximum(spread, np.float32(PHOTOGRAPHS.least_scatter * max(median(brightness[np.isfinite(brightness)]), 1.0)))


def _filled(values):
    """Values, NaN where unknown, with the nearest known one there."""
    nearest = ndimage.distance_transform_edt(np.isnan(values), return_distances=False, return_indices=True)
    return np.ascontiguousarray(values[tuple(nearest)], np.float32)
