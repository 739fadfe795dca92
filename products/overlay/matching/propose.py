"""Control points of an image, proposed from corners of paint that the intensity image shows too."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
import shapely

from ....core.common.errors import RoadExtractionError
from ....core.common.features import PROPOSED_POINTS, Features
from ....core.common.progress import Progress
from ....core.common.setting import Limited, setting
from ....core.io.geotiff import IntensityImage
from ....core.lazy import cv2
from ..control_points import SourceImage
from ..rough_place import RoughPlace
from .places import Photo, Placement, SurveyedPaint, find_places, highest_order, left_out_residuals, paint_about, photo_of, reduced, robust_placement

_CORNERS = 400          # corners looked for
_CANDIDATES = 4         # places of the search that are followed up
_SAME = 0.6             # m at most corners of paint, within which two placements are one; bars of a crossing lie a metre apart
AMBIGUOUS = "all of it fits elsewhere too"


def propose_control_points(image: SourceImage, intensity: IntensityImage, rough: RoughPlace, settings: ProposalSettings | None = None,
                           progress: Progress = Progress()) -> Proposal:
    """Find corners of paint in an image and in the intensity image, and pair them.

    The paint of both is correlated over shift, turn and scale; patches of falling size then follow the distortion of the camera;
    at last the surroundings of single corners are compared. A pair is accepted where the two look alike, nothing nearby looks
    the same, and the other pairs place it where it is. None is accepted where the whole image fits another place about as well.

    intensity : IntensityImage in a projected CRS in metres
    rough : RoughPlace in that CRS
    Raises RoadExtractionError if the image does not lie over the intensity image, covers too much ground, or shows other paint.
    """
    settings = settings or ProposalSettings()
    paint, bounds = paint_about(image, intensity, rough)
    photo = photo_of(image, rough.size, paint.cell)
    progress.report(0.1)
    x, y = _paint_corners(paint.contrast, np.isfinite(paint.values), paint.cell, _CORNERS)
    if len(x) < LEAST_PAIRS:
        raise RoadExtractionError(f"The intensity image shows {len(x)} corners of paint where {image.path} may lie; {LEAST_PAIRS} are needed. "
                                  "Measure the control points by hand there, at manholes and curbs for example.")
    for sign, part in ((1, progress.part(0.1, 0.5)), (-1, progress.part(0.5, 0.9))):
        tried = _followed(image, photo, paint, bounds, sign, x, y, part)
        for placement, scores in tried:
            pairs = _pair_corners(placement, paint, photo, x, y, settings)
            if pairs is not None:
                middle = _middle_on_map(placement, image)
                rivals = [_rival_elsewhere(scores, other_scores, tuple((_middle_on_map(other, image) - middle).tolist()))
                          for other, other_scores in tried if other is not placement]
                near = _nearby_rival(pairs.placement, paint, photo, x, y)
                rival = min([*rivals, *([near] if near else [])], key=lambda one: one.margin, default=None)
                return _proposal(image, intensity, rough, settings, pairs, rival, paint)
    raise RoadExtractionError(f"The paint of {image.path} and that of the intensity image do not fit each other, though it was looked for "
                              f"{_range(rough, bounds)}. Is it another stretch of road, another scale, or a photo from before or after the road was "
                              "painted anew? Give a closer position, two points or the pixel size, or measure the control points by hand.")


def _followed(image, photo, paint, bounds, sign, x, y, progress):
    """(placement, its `_corner_scores`) of the few best places of the search, aligned with the paint, the best first."""
    tried: list[tuple[Placement, np.ndarray]] = []
    of_photo = replace(bounds, sizes=(bounds.sizes[0] * photo.factor, bounds.sizes[1] * photo.factor))
    places = find_places(photo.contrast, paint.contrast, paint.cell, of_photo, sign, progress.part(0.0, 0.8))
    for place in places[:_CANDIDATES]:
        progress.check_cancelled()
        start = Placement.similarity(place.x, place.y, place.turn, place.size / photo.factor, (image.width / 2, image.height / 2), place.sign)
        placement = _align(start, paint, photo, progress)
        # most corners tell whether two are the same: those beyond the photo are extrapolated
        if placement is not None and all(
                np.median(np.hypot(*placement.metres(x, y, *other.pixels(x, y)).T)) >= _SAME for other, _ in tried):
            tried.append((placement, _corner_scores(placement, paint, photo, x, y)))
    progress.report(1.0)
    return sorted(tried, key=lambda one: -float(np.nansum(np.maximum(one[1], 0.0))))


def _proposal(image, intensity, rough, settings, pairs, rival, paint):
    """The pairs that are shown, and what is said of them."""
    accepted = pairs.why == ""
    certain = np.flatnonzero(accepted)
    certain = certain[_spread(pairs.x[certain], pairs.y[certain], settings.count)]
    doubtful = np.flatnonzero(~accepted)
    doubtful = doubtful[np.argsort(-pairs.score[doubtful], kind="stable")][:settings.count // 2]
    shown = np.concatenate([certain[np.argsort(-pairs.score[certain], kind="stable")], doubtful])
    notes = []
    why = pairs.why[shown]
    if rival is not None and rival.margin < 1.0:
        why = np.where(why == "", AMBIGUOUS, why)
        notes.append(f"The paint repeats: {rival.votes_for:.0f} corners speak for this place and {rival.votes_against:.0f} for one "
                     f"{np.hypot(rival.dx, rival.dy):.1f} m away, so no pair is accepted. Give two points or a smaller search distance, or accept "
                     "the pairs by hand if the place is right.")
    slope = pairs.placement.polynomial.jacobian(pairs.x.mean(keepdims=True), pairs.y.mean(keepdims=True))[0]
    east = np.linalg.solve(slope, [1.0, 0.0])   # along a row of the image, m
    size = 1.0 / float(np.sqrt(abs(np.linalg.det(slope))))
    return Proposal(image, intensity, settings, rough, intensity.crs, paint.left + pairs.x[shown], paint.top + pairs.y[shown], pairs.pixel[shown],
                    pairs.line[shown], pairs.score[shown], pairs.residual[shown], why == "", tuple(why.tolist()), pairs.order,
                    float(np.arctan2(east[1], east[0])), size, rival, notes)


def _spread(x, y, count):
    """Indices of at most `count` places, each as far as possible from those before it."""
    if len(x) <= count:
        return np.arange(len(x))
    kept = [0]  # the strongest corner
    distance = np.hypot(x - x[0], y - y[0])
    while len(kept) < count:
        kept.append(int(distance.argmax()))
        distance = np.minimum(distance, np.hypot(x - x[kept[-1]], y - y[kept[-1]]))
    return np.array(kept)


def _middle_on_map(placement, image):
    """(2,) m, of the image's middle, by the affine part of the placement."""
    polynomial = placement.polynomial
    centre = np.array([polynomial.centre])
    slope = polynomial.jacobian(centre[:, 0], centre[:, 1])[0]
    centre_pixel = np.column_stack(polynomial.to_map(centre[:, 0], centre[:, 1]))[0]
    return polynomial.centre + np.linalg.solve(slope, np.array([0.5 * image.width, 0.5 * image.height]) - centre_pixel)


def _range(rough, bounds):
    """What was searched, in words."""
    area = f"within {rough.reach:.0f} m of where {rough.source} put it" if np.isfinite(rough.reach) else "everywhere"
    turns = "in all directions" if rough.turn_range >= np.pi else f"turned by up to {np.degrees(rough.turn_range):.0f}°"
    return f"{area}, {turns}, with pixels of {bounds.sizes[0]:.3f} to {bounds.sizes[1]:.3f} m"


# Corners of paint in the intensity image: ends of dashes, corners of arrows, bars and stop lines.

_SMOOTHING = 0.05    # m, standard deviation: the noise of single cells has corners too
_WINDOW = 0.5        # m, over which the directions of edges are collected
_APART = 1.0         # m between two corners
_LEAST = 0.08        # of the strongest corner's measure
_PAINT = 0.4         # contrast from which it is paint; spots of asphalt and its repairs have less
_BORDER = 0.3        # m from where the intensity image ends


def _paint_corners(paint: np.ndarray, known: np.ndarray, cell: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Places where paint has edges in two directions, spread over the image.

    .. [1] Shi and Tomasi (1994), Good features to track, CVPR: the smaller eigenvalue of the structure tensor.
    """
    if not known.any():
        return np.empty(0), np.empty(0)
    smooth = cv2.GaussianBlur(np.maximum(paint - _PAINT, 0.0), (0, 0), _SMOOTHING / cell)
    border = 2 * round(_BORDER / cell) + 1
    inside = cv2.erode(known.astype(np.uint8), np.ones((border, border), np.uint8), borderType=cv2.BORDER_CONSTANT, borderValue=0)
    corners = cv2.goodFeaturesToTrack(smooth, count, _LEAST, _APART / cell, mask=inside, blockSize=2 * round(_WINDOW / cell / 2) + 1)
    if corners is None:
        return np.empty(0), np.empty(0)
    column, row = corners[:, 0].T.astype(float)
    return (column + 0.5) * cell, -(row + 0.5) * cell


# From a place that is right to about a metre to one that is right to a decimetre, over the whole photo.

# Half the side of a patch, how far it is looked for, and the largest residual of one that is used (m each), with the cell. Large patches
# hold several markings, so that one dash is not taken for the next; small ones follow the tilt of the camera and its lens.
_ALIGNING_ROUNDS = ((10.0, 2.5, 0.6, 0.16), (5.0, 1.0, 0.25, 0.08), (3.0, 0.6, 0.15, 0.08))
_LEAST_SCORE = 0.15    # of a patch: shadows and cars spoil many, and which are right shows in that they agree
_MOST_SECOND_OF_PATCHES = 0.8     # share of the best correlation that another place may have


def _align(placement: Placement, paint: SurveyedPaint, photo: Photo, progress: Progress = Progress()) -> Placement | None:
    """Follow the photo's distortion from patches of the intensity image that are found in it, in ever smaller ones; None where they do not agree."""
    for half, search, tolerance, cell in _ALIGNING_ROUNDS:
        progress.check_cancelled()
        small, drawn, cell_size = _on_same_cells(placement, paint, photo, cell)
        height, width = (n * cell_size for n in small.shape)
        x, y = (axis.ravel() for axis in np.meshgrid(np.arange(half / 2, width, half), -np.arange(half / 2, height, half)))
        patches = _find_patches(small, drawn, cell_size, x, y, half, search)
        patches = patches.where((patches.score > _LEAST_SCORE) & (patches.second < _MOST_SECOND_OF_PATCHES))
        fitted = robust_placement(placement, patches.x, patches.y, np.column_stack([patches.dx, patches.dy]), tolerance)
        if fitted is None:
            return None
        placement = fitted[0]
    return placement


def _on_same_cells(placement: Placement, paint: SurveyedPaint, photo: Photo, cell: float) -> tuple[np.ndarray, np.ndarray, float]:
    """The contrast of the intensity image and that of the photo on cells of about that size (m), and the size that they have."""
    factor = max(1, round(cell / paint.cell))
    small = reduced(paint.contrast, factor)
    return small, placement.drawn(photo, paint.cell * factor, small.shape), paint.cell * factor


# Corners of paint paired: found in the photo by their surroundings, and judged by what the others say.

LEAST_PAIRS = 6         # pairs that agree, below which a fit may be chance: twice what turn, scale and shift need
_LEAST_SHARE = 0.4      # of the corners that look alike, which must agree on one placement
_PATCH = 0.8            # m, half the side of the cut-out that is compared: a dash's end, an arrow's corner
_ROUNDS = ((0.40, 1.5), (0.25, 1.0))  # m within which a corner is looked for, and how many tolerances a pair may be off
_MOST_SECOND = 0.9      # share of the best correlation that another place in the window may have
_LISTED_SCORE = 0.3     # correlation below which a corner is not worth showing
_SIGMAS = 3.0           # robust standard deviations of the residuals from which a pair is false
_FINEST = 0.03          # m: residuals below a cell of the image do not make a pair false
_MEDIAN_LENGTH = 1.1774  # median length of errors of two coordinates, in their standard deviation (Rayleigh)

WEAK, REPEATS, AWAY = "looks different", "repeats nearby", "does not fit the others"


class Pairs(NamedTuple):
    """N corners of paint and where the image has them."""

    placement: Placement   # Placement that those that agree were fitted to
    order: int   # of the polynomial that the residuals belong to
    x: np.ndarray   # x, y: (N,) m, local
    y: np.ndarray
    pixel: np.ndarray   # pixel, line: (N,)
    line: np.ndarray
    score: np.ndarray   # (N,) correlation of the two cut-outs
    residual: np.ndarray   # (N,) m, from where the pairs that agree place it, each without itself
    why: np.ndarray   # (N,) texts, why a pair is false or doubtful; "" for a sound one


def _pair_corners(placement: Placement, paint: SurveyedPaint, photo: Photo, x: np.ndarray, y: np.ndarray, settings: ProposalSettings) -> Pairs | None:
    """Corners of paint found in a photo that lies on the map to some decimetres; None where too few agree on one placement."""
    for search, times in _ROUNDS:
        small, drawn, cell = _on_same_cells(placement, paint, photo, paint.cell)
        patches = _find_patches(small, drawn, cell, x, y, _PATCH, search)
        patches = patches.where(patches.score > _LISTED_SCORE)
        alike = (patches.score >= settings.min_score) & (patches.second <= _MOST_SECOND)
        moved = np.column_stack([patches.dx, patches.dy])
        fitted = robust_placement(placement, patches.x[alike], patches.y[alike], moved[alike], times * settings.tolerance)
        if fitted is None or fitted[1].sum() < max(LEAST_PAIRS, _LEAST_SHARE * alike.sum()):
            return None
        pixel, line = placement.pixels(patches.x + patches.dx, patches.y + patches.dy)
        placement = fitted[0]
        used = np.zeros(len(patches.x), dtype=bool)
        used[np.flatnonzero(alike)[fitted[1]]] = True
    order = highest_order(patches.x[used], patches.y[used])
    if order == 0:
        return None
    residual = left_out_residuals(patches.x, patches.y, pixel, line, used, order)
    spread = float(np.median(residual[used])) / _MEDIAN_LENGTH
    fits = residual <= min(settings.tolerance, max(_SIGMAS * spread, _FINEST))
    why = np.select([patches.score < settings.min_score, patches.second > _MOST_SECOND, ~fits | ~used], [WEAK, REPEATS, AWAY], "")
    return Pairs(placement, order, patches.x, patches.y, pixel, line, patches.score, residual, why)


# What is proposed: pairs of places, which of them are accepted, what is known of the whole, and whether the paint allows another place.

@dataclass(frozen=True)
class ProposalSettings(Limited):
    """How pairs are found and accepted.

    tolerance : m, largest distance of a pair that is accepted from where the others place it
    pixel_size : m on the ground of the image's pixels, roughly; 0: as its position or its tags say
    """

    search: float = setting(15.0, 1.0, 100.0, "The search distance", "m")   # m, how far off the rough position may be
    tolerance: float = setting(0.10, 0.01, 1.0, "The tolerance", "m")
    min_score: float = setting(0.6, 0.3, 0.99, "The smallest score")   # smallest correlation of the two cut-outs of a pair that is accepted
    count: int = setting(40, 6, 400, "The number of pairs")   # most pairs that are accepted
    pixel_size: float = setting(0.0, 0.001, 1.0, "The pixel size", "m", zero="as the image says")


@dataclass(frozen=True)
class Proposal:
    """N pairs of places, in the image and on the map, the most certain first."""

    image: SourceImage   # image, intensity: as given
    intensity: IntensityImage
    settings: ProposalSettings
    rough: RoughPlace
    crs: str   # WKT of the map
    easting: np.ndarray   # easting, northing: (N,) m, in the intensity image
    northing: np.ndarray
    pixel: np.ndarray   # pixel, line: (N,) in the image
    line: np.ndarray
    score: np.ndarray   # (N,) correlation of the two cut-outs
    residual: np.ndarray   # (N,) m, distance from where the accepted pairs without this one place it
    accepted: np.ndarray   # (N,) bool, by default
    why: tuple[str, ...]   # N texts, why a pair is not accepted
    order: int   # of the polynomial that the residuals belong to
    turn: float   # turn, size: radians and m, of the image on the map
    size: float
    rival: _Rival | None   # the most likely other place, None where there is none
    notes: list[str] = field(default_factory=list)   # warnings for the user, one sentence each

    def __len__(self) -> int:
        return len(self.pixel)

    @property
    def rmse(self) -> float:
        """Root mean square of the residuals of the accepted pairs, m; NaN without any."""
        return float(np.sqrt(np.mean(self.residual[self.accepted] ** 2))) if self.accepted.any() else float("nan")

    @property
    def turn_degrees(self) -> float:
        """Degrees counter-clockwise, from the rows of the image to east."""
        return float(np.degrees(self.turn))

    def features(self) -> Features:
        """Features PROPOSED_POINTS, as "Georeference image" takes them: pairs that are not accepted are switched off."""
        layer = Features("PointZ", PROPOSED_POINTS, crs=self.crs)
        for k in range(len(self)):
            layer.add(shapely.Point(self.easting[k], self.northing[k], 0.0), point=k + 1, accepted=self.accepted[k], role="control",
                      score=self.score[k], residual=self.residual[k], pixel=self.pixel[k], line=self.line[k], why=self.why[k])
        return layer


# Whether a place is the only one that the paint allows: on a road of equal dashes several fit equally well.

_HALF = 0.8           # m, half the side of the patch about a corner
_AROUND = 6.0         # m within which shifted places are compared
_SAME_SHIFT = 0.6           # m, shifts nearer than this are the same place
_OFF = 0.24           # m by which a corner may be off its place
_CELL = 0.08          # m
_DECISIVE = 0.3       # difference of two correlations of a corner that speaks for one place
LEAST_DECISIVE = 4    # more corners must speak for a place than for another one
_SIGN_SIGMAS = 2.0         # and by so many standard deviations of their number (sign test)
_UNLIKE = 0.4         # correlation below which a corner is not what lies there


class _Rival(NamedTuple):
    """Another place that the paint might allow."""

    dx: float   # dx, dy: m, from the place
    dy: float
    votes_for: float   # votes_for, votes_against: corners that speak for the place, and for the rival
    votes_against: float

    @property
    def margin(self) -> float:
        """How clearly the corners speak for the place, 1 or more: clearly enough."""
        needed = max(LEAST_DECISIVE, _SIGN_SIGMAS * float(np.sqrt(self.votes_for + self.votes_against)))
        return (self.votes_for - self.votes_against) / needed


def _corner_scores(placement: Placement, paint: SurveyedPaint, photo: Photo, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """(N,) how well the photo fits about corners of paint, (N,) m, local: correlation of the best place within decimetres; NaN outside."""
    maps = _correlation_maps(*_on_same_cells(placement, paint, photo, _CELL), x, y, _HALF, _OFF)
    return np.array([np.nan if match is None else match.max() for match in maps])


def _nearby_rival(placement: Placement, paint: SurveyedPaint, photo: Photo, x: np.ndarray, y: np.ndarray) -> _Rival | None:
    """The shift by some metres that the corners allow best, besides none at all; None where no corner lies in the photo."""
    near = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * round(_OFF / _CELL) + 1,) * 2)
    correlations = _correlation_maps(*_on_same_cells(placement, paint, photo, _CELL), x, y, _HALF, _AROUND)
    maps = [cv2.dilate(match, near) for match in correlations if match is not None]
    if not maps:
        return None
    votes = np.maximum(maps, 0.0)
    total = votes.sum(axis=0)
    middle = len(total) // 2
    down, across = np.mgrid[:len(total), :len(total)] - middle
    total[np.hypot(down, across) * _CELL < _SAME_SHIFT] = -1.0
    row, column = divmod(int(total.argmax()), len(total))
    better = votes[:, middle, middle] - votes[:, row, column]
    return _Rival((column - middle) * _CELL, -(row - middle) * _CELL, int((better > _DECISIVE).sum()), int((better < -_DECISIVE).sum()))


def _rival_elsewhere(best: np.ndarray, other: np.ndarray, shift: tuple[float, float]) -> _Rival:
    """A place against another one that lies too far away to be compared corner by corner: by the corners that look unlike at each.

    best, other : (N,) `_corner_scores` of the two placements, NaN outside the photo
    shift : m, from the one to the other
    """
    best_scores, other_scores = best[np.isfinite(best)], other[np.isfinite(other)]
    scale = len(other_scores) / max(len(best_scores), 1)
    return _Rival(*shift, float((other_scores < _UNLIKE).sum()), scale * float((best_scores < _UNLIKE).sum()))


# Patches of the intensity image found again in the photo, once that lies roughly on the map.

_OTHER_PEAK = 0.3     # of the patch's half-width, from the best place, beyond which a second one is another
_LEAST_KNOWN = 0.3    # of a patch that the intensity image must hold
_LEAST_STRUCTURE = 0.02   # mean square contrast of a patch, below which there is no paint in it


class Found(NamedTuple):
    """Patches found again."""

    x: np.ndarray   # x, y: (N,) m, local, middles of the patches
    y: np.ndarray
    dx: np.ndarray   # dx, dy: (N,) m, from there to where the drawn photo has them
    dy: np.ndarray
    score: np.ndarray   # (N,) correlation, 0 to 1
    second: np.ndarray   # (N,) the largest correlation elsewhere in the window, as a share of the best

    def where(self, kept: np.ndarray) -> Found:
        """The patches of a (N,) bool or index array."""
        return Found(*(column[kept] for column in self))


def _find_patches(paint: np.ndarray, drawn: np.ndarray, cell: float, x: np.ndarray, y: np.ndarray, half: float, search: float) -> Found:
    """Find patches of the intensity image in the photo drawn on the same cells.

    paint, drawn : (H, W) contrast of the intensity image, 0 where unknown, its corner at local 0, 0, and of the photo on the same cells
    cell : m
    x, y : (N,) middles of the patches, m, local
    half, search : m, half the side of a patch, and how far off it may be
    Returns Found, without patches that lie too near the border, hold no paint, or were found at the border of their window
    """
    margin = max(2, round(search / cell))
    exclusion = max(2, round(_OTHER_PEAK * half / cell))
    rows: list[tuple[float, ...]] = []
    for at_x, at_y, match in zip(x, y, _correlation_maps(paint, drawn, cell, x, y, half, search)):
        best = None if match is None else _peak(match, exclusion)
        if best is not None:
            right, down, score, second = best
            rows.append((at_x, at_y, (right - margin) * cell, -(down - margin) * cell, score, second))
    return Found(*np.array(rows, float).reshape(-1, 6).T)


def _correlation_maps(paint: np.ndarray, drawn: np.ndarray, cell: float, x: np.ndarray, y: np.ndarray, half: float,
                     search: float) -> Iterator[np.ndarray | None]:
    """The correlation of each patch with the photo, for every shift by whole cells; parameters as of `_find_patches`.

    Yields (2 n + 1, 2 n + 1) float32, the shift by nothing in the middle; None where a patch holds no paint or the photo is empty.
    """
    reach, margin = max(2, round(half / cell)), max(2, round(search / cell))
    edge = reach + margin + 1
    framed, templates = (cv2.copyMakeBorder(values, edge, edge, edge, edge, cv2.BORDER_CONSTANT, value=0.0) for values in (drawn, paint))
    for at_x, at_y in zip(x, y):
        column, row = int(np.floor(at_x / cell)) + edge, int(np.floor(-at_y / cell)) + edge
        template = templates[row - reach:row + reach + 1, column - reach:column + reach + 1]
        mask = (template != 0).astype(np.float32)
        window = framed[row - reach - margin:row + reach + margin + 1, column - reach - margin:column + reach + margin + 1]
        without_paint = mask.mean() < _LEAST_KNOWN or float((template * template).mean()) < _LEAST_STRUCTURE
        outside = not window[margin:-margin, margin:-margin].any()
        yield None if without_paint or outside else _correlation(window, template, mask)


def _correlation(window, template, mask):
    """Normalised correlation of the contrasts over the known part of the template, their means removed."""
    count = mask.sum()
    zero_mean = (template - (template * mask).sum() / count) * mask
    product = cv2.matchTemplate(window, zero_mean, cv2.TM_CCORR)
    total, square = (cv2.matchTemplate(values, mask, cv2.TM_CCORR) for values in (window, window * window))
    spread = np.maximum(square - total * total / count, 1e-3 * count)  # at least a noise of 0.03: nothing else is nothing
    return product / np.sqrt(spread * (zero_mean * zero_mean).sum())


def _peak(match, other):
    """(column, row, value, second peak as a share of it) of the largest value; None at the border, or where it is none."""
    row, column = divmod(int(match.argmax()), match.shape[1])
    if not (0 < row < match.shape[0] - 1 and 0 < column < match.shape[1] - 1):
        return None
    a = match[row - 1:row + 2, column - 1:column + 2].astype(float)
    slope = np.array([a[1, 2] - a[1, 0], a[2, 1] - a[0, 1]]) / 2
    bend = np.array([[a[1, 2] - 2 * a[1, 1] + a[1, 0], (a[2, 2] - a[2, 0] - a[0, 2] + a[0, 0]) / 4],
                     [0.0, a[2, 1] - 2 * a[1, 1] + a[0, 1]]])
    bend[1, 0] = bend[0, 1]
    if np.linalg.eigvalsh(bend).max() >= 0 or a[1, 1] <= 0:
        return None
    move = np.clip(-np.linalg.solve(bend, slope), -1.0, 1.0)
    remaining = match.copy()
    remaining[max(0, row - other):row + other + 1, max(0, column - other):column + other + 1] = 0.0
    return column + move[0], row + move[1], a[1, 1], max(float(remaining.max()), 0.0) / a[1, 1]
