"""Control points of an image, proposed from corners of paint that the intensity image shows too."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...io.geotiff import IntensityImage
from ..rough_place import RoughPlace
from ..source_image import SourceImage
from .alignment import align
from .coarse import find_places, paint_about
from .corners import paint_corners
from .pairing import LEAST_PAIRS, pair_corners
from .photo import read_photo
from .placement import Placement
from .proposal import Proposal, ProposalSettings, corner_scores, nearby_rival, rival_elsewhere

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

    Parameters
    ----------
    image : SourceImage
    intensity : IntensityImage in a projected CRS in metres
    rough : RoughPlace in that CRS
    settings : ProposalSettings
    progress : Progress

    Returns
    -------
    Proposal

    Raises
    ------
    RoadExtractionError
        If the image does not lie over the intensity image, covers too much ground, or shows other paint.
    """
    settings = settings or ProposalSettings()
    paint, bounds = paint_about(image, intensity, rough)
    photo = read_photo(image, rough.size, paint.cell)
    progress.report(0.1)
    x, y = paint_corners(paint.contrast, paint.known, paint.cell, _CORNERS)
    if len(x) < LEAST_PAIRS:
        raise RoadExtractionError(
            f"The intensity image shows {len(x)} corners of paint where {image.path} may lie; {LEAST_PAIRS} are needed. Measure the control "
            "points by hand there, at manholes and curbs for example.")
    for sign, part in ((1, progress.part(0.1, 0.5)), (-1, progress.part(0.5, 0.9))):
        tried = _followed(image, photo, paint, bounds, sign, x, y, part)
        for chosen in tried:
            pairs = pair_corners(chosen.placement, paint, photo, x, y, settings)
            if pairs is not None:
                rivals = [rival_elsewhere(chosen.scores, other.scores, _shift(chosen.placement, other.placement, image))
                          for other in tried if other is not chosen]
                near = nearby_rival(pairs.placement, paint, photo, x, y)
                rival = min([*rivals, *([near] if near else [])], key=lambda one: one.margin, default=None)
                return _proposal(image, intensity, rough, settings, pairs, rival, paint)
    raise RoadExtractionError(
        f"The paint of {image.path} and that of the intensity image do not fit each other, though it was looked for {_range(rough, bounds)}. "
        "Is it another stretch of road, another scale, or a photo from before or after the road was painted anew? Give a closer position, "
        "two points or the pixel size, or measure the control points by hand.")


def _followed(image, photo, paint, bounds, sign, x, y, progress):
    """The few best places of the search, aligned with the paint, the best first."""
    tried: list[_Tried] = []
    places = find_places(photo.contrast, paint.contrast, paint.cell, bounds.of_pixels(photo.factor), sign, progress.part(0.0, 0.8))
    for place in places[:_CANDIDATES]:
        progress.check_cancelled()
        start = Placement.similarity(place.x, place.y, place.turn, place.size / photo.factor, _middle(image), place.sign)
        placement = align(start, paint, photo, progress)
        if placement is not None and not any(_same(placement, other.placement, x, y) for other in tried):
            tried.append(_Tried(placement, corner_scores(placement, paint, photo, x, y)))
    progress.report(1.0)
    return sorted(tried, key=lambda one: -one.total)


class _Tried(NamedTuple):
    placement: Placement
    scores: np.ndarray

    @property
    def total(self):
        return float(np.nansum(np.maximum(self.scores, 0.0)))


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
        notes.append(
            f"The paint repeats: {rival.votes_for:.0f} corners speak for this place and {rival.votes_against:.0f} for one "
            f"{np.hypot(rival.dx, rival.dy):.1f} m away, so no pair is accepted. Give two points or a smaller search distance, or accept the "
            "pairs by hand if the place is right.")
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


def _middle(image):
    return image.width / 2, image.height / 2


def _corners_on_map(placement, image):
    """(5, 2) m, of the image's corners and its middle, by the affine part of the placement."""
    polynomial = placement.polynomial
    centre = np.array([polynomial.centre])
    slope = polynomial.jacobian(centre[:, 0], centre[:, 1])[0]
    at = np.column_stack(polynomial.to_map(centre[:, 0], centre[:, 1]))
    corners = np.array([(a * image.width, b * image.height) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.5))])
    return centre + np.linalg.solve(slope, (corners - at).T).T


def _same(one, other, x, y):
    # of most corners: those beyond the photo are extrapolated
    return bool(np.median(np.hypot(*one.metres(x, y, *other.pixels(x, y)).T)) < _SAME)


def _shift(one, other, image):
    return tuple(float(v) for v in _corners_on_map(other, image)[4] - _corners_on_map(one, image)[4])


def _range(rough, bounds):
    """What was searched, in words."""
    where = f"within {rough.reach:.0f} m of where {rough.source} put it" if np.isfinite(rough.reach) else "everywhere"
    turns = "in all directions" if rough.turn_range >= np.pi else f"turned by up to {np.degrees(rough.turn_range):.0f}°"
    return f"{where}, {turns}, with pixels of {bounds.sizes[0]:.3f} to {bounds.sizes[1]:.3f} m"
