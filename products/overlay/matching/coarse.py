"""Where a photo lies, to about a metre: its paint correlated with that of the intensity image over shift, turn and scale."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from scipy import fft

from ....core.common.errors import RoadExtractionError
from ....core.common.progress import Progress
from ....core.io.geotiff import IntensityImage
from ....core.lazy import cv2
from ..rough_place import RoughPlace
from ..source_image import SourceImage
from .photo import SurveyedPaint, read_paint, reduced

_CELLS = (0.64, 0.32)     # m, of the two rounds: the lines of a road, 0.15 m wide, still stand out in cells of half a metre
_SLACK = 2.0              # cells by which the ends of the photo may be off between two turns or scales that are tried
_PEAKS = 4                # places kept of each turn and scale
_KEPT = 12                # places that go into the second round
_APART = 3.0              # m between two places that count as different
_WORTH = 0.4              # of the best correlation so far, below which a place is not kept
_FINER = (0.5, 0.25)      # of a step, tried about each place in the second round


class Place(NamedTuple):
    """A similarity from the photo's middle to the map."""

    x: float   # x, y: m, local, of the photo's middle
    y: float
    turn: float   # radians, counter-clockwise, from the rows of the photo to east
    size: float   # m of a pixel
    sign: int   # 1, or -1 where paint is darker than the road
    score: float   # 0 to 1, correlation of the contrasts where both are known


@dataclass(frozen=True)
class Bounds:
    """What is tried."""

    x: float   # x, y: m, local, about where the photo's middle lies
    y: float
    reach: float   # m, how far off that may be; infinite where nothing is known
    turns: tuple[float, float]   # (from, to) radians
    sizes: tuple[float, float]   # (from, to) m of a pixel

    def of_pixels(self, factor: int) -> Bounds:
        """The same for a photo whose pixels are `factor` times as wide."""
        return replace(self, sizes=(self.sizes[0] * factor, self.sizes[1] * factor))


def find_places(photo: np.ndarray, paint: np.ndarray, cell: float, bounds: Bounds, sign: int = 1,
                progress: Progress = Progress()) -> list[Place]:
    """The places where the paint of a photo fits that of the intensity image best, the best first.

    Parameters
    ----------
    photo : (H, W) contrast of the photo, in pixels of `bounds.sizes`
    paint : (h, w) contrast of the intensity image, north up, its outer corner at local 0, 0 and y negative below it
    cell : m, pixel of the intensity image
    bounds : Bounds, of the pixels of `photo`
    sign : 1, or -1 where paint is darker than the road

    Returns list of Place, each some metres or a turn away from the others
    """
    middle_size = float(np.sqrt(bounds.sizes[0] * bounds.sizes[1]))
    half = 0.5 * max(photo.shape) * middle_size
    step = _SLACK * _CELLS[0] / half
    turns = _steps(*bounds.turns, step)
    sizes = np.exp(_steps(float(np.log(bounds.sizes[0])), float(np.log(bounds.sizes[1])), step))
    rough: list[Place] = []
    first = _Round(photo, paint, cell, middle_size, _CELLS[0])
    for number, turn in enumerate(turns):
        progress.report(0.7 * number / len(turns))
        for size in sizes:
            rough += first.peaks(turn, size, bounds, _PEAKS, sign)
    rough = _distinct(rough, step * half, _KEPT)
    second = _Round(photo, paint, cell, middle_size, _CELLS[1])
    refined: list[Place] = []
    for number, place in enumerate(rough):
        progress.report(0.7 + 0.3 * number / len(rough))
        for span in _FINER:
            place = second.best_about(place, span * step)
        refined.append(place)
    return _distinct(refined, half, len(refined))


def _steps(start, end, step):
    """Values from start to end, evenly, at most a step apart."""
    return np.linspace(start, end, int(np.ceil((end - start) / step)) + 1) if end > start else np.array([0.5 * (start + end)])


def _distinct(places, half, count):
    """The best `count` places of which no two are the same within some metres, at the ends of the photo too."""
    kept: list[Place] = []
    for place in sorted(places, key=lambda one: -one.score):
        if all(np.hypot(place.x - better.x, place.y - better.y) + half * abs(np.angle(np.exp(1j * (place.turn - better.turn)))) > _APART
               for better in kept):
            kept.append(place)
        if len(kept) == count:
            break
    return kept


class _Round:
    """Correlations at one cell size."""

    def __init__(self, photo, paint, cell, size, wanted):
        step = max(1, round(wanted / cell))
        self.cell, self.paint = cell * step, reduced(paint, step)
        self.factor = max(1, int(0.5 * self.cell / size))  # of the photo, half a cell: the warp below takes the rest
        self.photo = cv2.GaussianBlur(reduced(photo, self.factor), (0, 0), 0.8)
        self._transforms: dict[tuple[int, int], np.ndarray] = {}
        self._places: tuple[Any, Any] | None = None
        self._best = 0.0

    def warped(self, turn, size):
        """The photo, turned and scaled, on a square canvas of cells about its middle."""
        scale = size * self.factor / self.cell
        height, width = self.photo.shape
        side = int(np.ceil(np.hypot(height, width) * scale)) + 2
        cos, sin = np.cos(turn) * scale, np.sin(turn) * scale
        matrix = np.array([[cos, sin, 0.0], [-sin, cos, 0.0]])
        matrix[:, 2] = side / 2 - 0.5 - matrix[:, :2] @ [width / 2 - 0.5, height / 2 - 0.5]
        return cv2.warpAffine(self.photo, matrix, (side, side), flags=cv2.INTER_LINEAR)

    def peaks(self, turn, size, bounds, count, sign):
        """The places of the largest correlations, not yet comparable between rounds."""
        canvas = self.warped(turn, size)
        side = len(canvas)
        shape = tuple(fft.next_fast_len(n + side, real=True) for n in self.paint.shape)
        if shape not in self._transforms:
            self._transforms = {shape: fft.rfft2(self.paint, shape)}
        product = fft.irfft2(self._transforms[shape] * np.conj(fft.rfft2(canvas, shape)), shape)
        norm = float(np.sqrt((canvas * canvas).sum())) or 1.0
        across, down, far = self._middles(shape, side, bounds)
        product[far] = 0.0
        peaks = []
        values = product if sign > 0 else -product
        around = int(np.ceil(_APART / self.cell))
        for _ in range(count):
            row, column = divmod(int(values.argmax()), shape[1])
            score = float(values[row, column]) / norm
            if not score > _WORTH * self._best:
                break
            self._best = max(self._best, score)
            peaks.append(Place(float(across[column]), float(down[row]), float(turn), float(size), sign, score))
            values[max(0, row - around):row + around + 1, max(0, column - around):column + around + 1] = 0.0
        return peaks

    def best_about(self, place, span):
        """The best place of those turned and scaled by a span or not at all, with the correlation where both are known as its score."""
        near = Bounds(place.x, place.y, 2.5 * _CELLS[0], (0.0, 0.0), (0.0, 0.0))
        self._best = 0.0
        tried = [one for turn in (-span, 0.0, span) for size in (-span, 0.0, span)
                 for one in self.peaks(place.turn + turn, place.size * np.exp(size), near, 1, place.sign)]
        return max((self.judged(one) for one in tried), key=lambda one: one.score, default=self.judged(place))

    def _middles(self, shape, side, bounds):
        """(x and y of the photo's middle for every column and row of a product, those too far away as (H, W) bool)."""
        key = (shape, side, bounds)
        if self._places is None or self._places[0] != key:
            across, down = ((_shifts(n, n - side) + side / 2) * self.cell for n in shape[::-1])
            far = (across[None, :] - bounds.x) ** 2 + (-down[:, None] - bounds.y) ** 2 > bounds.reach**2
            self._places = key, (across, -down, far)
        return self._places[1]

    def judged(self, place):
        """The place with the correlation of both contrasts where both are known as its score."""
        canvas = self.warped(place.turn, place.size)
        side = len(canvas)
        column, row = round(place.x / self.cell - side / 2), round(-place.y / self.cell - side / 2)
        height, width = self.paint.shape
        rows, columns = slice(max(row, 0), min(row + side, height)), slice(max(column, 0), min(column + side, width))
        paint = self.paint[rows, columns]
        photo = canvas[rows.start - row:rows.stop - row, columns.start - column:columns.stop - column]
        photo = np.where(paint == 0, 0.0, photo)
        norm = float(np.sqrt((paint * paint).sum() * (photo * photo).sum()))
        return place._replace(score=place.sign * float((paint * photo).sum()) / norm if norm else 0.0)


def _shifts(length, most):
    """Shifts of a circular correlation, those beyond `most` being negative ones."""
    shifts = np.arange(length)
    return np.where(shifts > most, shifts - length, shifts)


# What is searched: the part of the intensity image where a photo may lie.

MOST_GROUND = 500.0     # m, longest side of an image: beyond, every turn of a fraction of a degree would have to be tried
MOST_SEARCHED = 1000.0  # m, longest side of an intensity image that is searched without any position


def paint_about(image: SourceImage, intensity: IntensityImage, rough: RoughPlace) -> tuple[SurveyedPaint, Bounds]:
    """The paint where an image may lie, and what is to be tried there.

    Parameters
    ----------
    rough : RoughPlace in its CRS

    Returns SurveyedPaint, Bounds in its local coordinates, for the pixels of the image itself

    Raises RoadExtractionError if the image covers too much ground, the intensity image has nothing there, or too much would have to be searched.
    """
    ground = max(image.width, image.height) * rough.size
    if ground > MOST_GROUND:
        raise RoadExtractionError(f"{image.path} covers {ground:.0f} m by its pixel size of {rough.size:.3g} m; images of up to {MOST_GROUND:.0f} m "
                                  "are matched. Give the single photo or a part of the mosaic, or the right pixel size.")
    placed = bool(np.isfinite(rough.reach))
    far = 0.5 * float(np.hypot(image.width, image.height)) * rough.size * (1.0 + rough.size_range) + (rough.reach if placed else 0.0)
    sides = intensity.width * intensity.cell_size, intensity.height * intensity.cell_size
    if not placed and max(sides) > MOST_SEARCHED:
        raise RoadExtractionError(f"The intensity image is {max(sides):.0f} m long; without any position an image is looked for within "
                                  f"{MOST_SEARCHED:.0f} m. Give two points or a world file, or cut the intensity image.")
    paint = read_paint(intensity, (rough.x - far, rough.y - far, rough.x + far, rough.y + far) if placed else None)
    if not paint.known.any():
        raise RoadExtractionError(_no_overlap(image, intensity, rough, sides))
    turns = (rough.turn - rough.turn_range, rough.turn + rough.turn_range)
    sizes = (rough.size / (1.0 + rough.size_range), rough.size * (1.0 + rough.size_range))
    x, y = (rough.x - paint.left, rough.y - paint.top) if placed else (0.0, 0.0)
    return paint, Bounds(float(x), float(y), rough.reach, turns, sizes)


def _no_overlap(image, intensity, rough, sides):
    west, north = intensity.geotransform[0], intensity.geotransform[3]
    x = np.clip(rough.x, west, west + sides[0]) - rough.x
    y = np.clip(rough.y, north - sides[1], north) - rough.y
    distance = float(np.hypot(x, y))
    text = f"{distance / 1000:,.1f} km" if distance >= 1000 else f"{distance:.0f} m"
    return (f"{image.path} and the intensity image do not overlap: by {rough.source} the middle of the image lies at {rough.x:.0f}, {rough.y:.0f}, "
            f"{text} from the intensity image's border, and no road was surveyed there. Is it an image of another road, or its position in "
            "another CRS?")
