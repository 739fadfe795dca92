"""Where a photo lies: read as contrast of paint, laid over the intensity image to about a metre, then placed by pairs that agree."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from scipy import fft

from ....core.common.errors import RoadExtractionError
from ....core.common.progress import Progress
from ....core.io.geotiff import GEOTIFF_TILE, IntensityImage
from ....core.io.local_files import gdal_exceptions, open_raster
from ....core.lazy import cv2, gdal
from ..control_points import SourceImage
from ..georeference import MIN_CONTROL_POINTS, MIN_INVERSE_CONDITION, ImagePolynomial, fit_image_polynomial, inverse_condition, lie_on_a_line
from ..rough_place import RoughPlace

FINEST_CELL = 0.04        # m: smaller cells show the gaps between laser points rather than paint
MOST_PIXELS = 60_000_000  # of either image in memory, 240 MB
_LUMINANCE = (0.299, 0.587, 0.114)  # of red, green and blue (ITU-R BT.601)


@dataclass(frozen=True)
class SurveyedPaint:
    """Contrast of a part of the intensity image, north up."""

    contrast: np.ndarray   # (H, W) float32, 0 where unknown
    values: np.ndarray   # (H, W) float32 intensity, NaN where unknown
    cell: float   # m
    left: float   # left, top: map coordinates of its outer corner, the origin of local coordinates
    top: float


@dataclass(frozen=True)
class Photo:
    """Contrast of the photo."""

    contrast: np.ndarray   # (H, W) float32
    factor: int   # pixels of the image side by side in a pixel here


def _read_paint(image: IntensityImage, box: tuple[float, float, float, float] | None = None) -> SurveyedPaint:
    """The part of an intensity image within (west, south, east, north), m, or all of it; cells are no finer than FINEST_CELL."""
    cell = image.cell_size
    first, last = (0, 0), (image.width, image.height)
    if box is not None:
        (c0, c1), (r0, r1) = image.pixel_of(np.array([box[0], box[2]]), np.array([box[3], box[1]]))
        first = max(0, int(np.floor(c0))), max(0, int(np.floor(r0)))
        last = min(image.width, int(np.ceil(c1))), min(image.height, int(np.ceil(r1)))
    width, height = max(0, last[0] - first[0]), max(0, last[1] - first[1])
    step = max(1, round(FINEST_CELL / cell), int(np.ceil(np.sqrt(width * height / MOST_PIXELS))))
    values = np.full((height // step, width // step), np.nan, np.float32)
    strip = max(1, GEOTIFF_TILE // step)
    for row in range(0, len(values), strip):
        count = min(strip, len(values) - row)
        pixels = image.read_pixels(first[0], first[1] + row * step, values.shape[1] * step, count * step)
        values[row:row + count] = pixels if step == 1 else _means(pixels, step)
    left, top = image.geotransform[0] + first[0] * cell, image.geotransform[3] - first[1] * cell
    return SurveyedPaint(_paint_contrast(values, cell * step), values, cell * step, left, top)


def _means(pixels, step):
    """Means of step x step pixels over those that are known."""
    blocks = pixels.reshape(len(pixels) // step, step, pixels.shape[1] // step, step)
    finite = np.isfinite(blocks)
    count = finite.sum(axis=(1, 3))
    total = np.where(finite, blocks, 0.0).sum(axis=(1, 3))
    return np.divide(total, count, out=np.full(count.shape, np.nan, np.float32), where=count > 0)


@gdal_exceptions()
def photo_of(image: SourceImage, size: float, cell: float) -> Photo:
    """The contrast of an image of pixels of about `size` m, in pixels about as large as a `cell` (m) of the intensity image or as they are.

    Raises RoadExtractionError if the image cannot be read.
    """
    width, height = image.width, image.height
    factor = max(1, int(cell / size + 0.25), int(np.ceil(np.sqrt(width * height / MOST_PIXELS))))
    columns, rows = max(1, width // factor), max(1, height // factor)
    try:
        dataset = open_raster(image.path)
        if image.palette:
            dataset = gdal.Translate("", dataset, format="VRT", rgbExpand="rgb")
        colours = (1, 2, 3) if dataset.RasterCount - image.has_alpha >= 3 else (1,)
        weights = _LUMINANCE if len(colours) == 3 else (1.0,)

        def read(band, resampling, kind=gdal.GDT_Float32, dtype=np.float32):
            data = band.ReadRaster(0, 0, columns * factor, rows * factor, columns, rows, kind, resample_alg=resampling)
            return np.frombuffer(data, dtype).reshape(rows, columns)

        luminance = np.zeros((rows, columns), np.float32)
        for number, weight in zip(colours, weights):
            luminance += np.float32(weight) * read(dataset.GetRasterBand(number), gdal.GRIORA_Average)
        mask = read(dataset.GetRasterBand(1).GetMaskBand(), gdal.GRIORA_NearestNeighbour, gdal.GDT_Byte, np.uint8)
    except RuntimeError as problem:
        raise RoadExtractionError(f"{image.path} cannot be read as an image ({problem}). Export it anew as a TIFF or JPEG.") from problem
    luminance[(mask < 128) | ~np.isfinite(luminance)] = np.nan
    return Photo(_paint_contrast(luminance, size * factor), factor)


# Paint against its surroundings, made comparable between a photo and an intensity image.

SURROUNDINGS = 1.0   # m, standard deviation of the Gaussian window of the local mean; paint is at most half a metre wide
FULL_CONTRAST = 0.6  # difference of logarithms between fresh paint and asphalt that counts as 1
_DARKEST = 0.1       # of the range of values, added before the logarithm: black is not infinitely dark
_RANGE = (1.0, 99.5)  # percentiles of the values taken for black and white


def _paint_contrast(values: np.ndarray, pixel_size: float) -> np.ndarray:
    """How much brighter each pixel is than its surroundings, -1 to 1, as a logarithm, so that sun and shadow look alike; 0 where unknown."""
    finite = np.isfinite(values)
    if not finite.any():
        return np.zeros(values.shape, np.float32)
    low, high = np.percentile(values[finite][:: max(1, int(finite.sum()) // 1_000_000)], _RANGE)
    share = (np.where(finite, values, low) - low) / max(float(high - low), 1e-9)
    logarithm = np.log(np.clip(share, 0.0, 1.0) + _DARKEST).astype(np.float32)
    weight = finite.astype(np.float32)
    around = SURROUNDINGS / pixel_size
    mean = _smooth(logarithm * weight, around) / np.maximum(_smooth(weight, around), 1e-3)
    return np.clip((logarithm - mean) / FULL_CONTRAST, -1.0, 1.0) * weight


def _smooth(values, deviation):
    """Gaussian smoothing; a wide window works on a reduced copy, which is as exact as the smoothing needs."""
    step = max(1, int(deviation // 6))
    if step == 1:
        return cv2.GaussianBlur(values, (0, 0), deviation, borderType=cv2.BORDER_REPLICATE)
    height, width = values.shape
    small = cv2.resize(values, (max(1, width // step), max(1, height // step)), interpolation=cv2.INTER_AREA)
    small = cv2.GaussianBlur(small, (0, 0), deviation / step, borderType=cv2.BORDER_REPLICATE)
    return cv2.resize(small, (width, height), interpolation=cv2.INTER_LINEAR)


def reduced(contrast: np.ndarray, factor: int) -> np.ndarray:
    """(H // factor, W // factor) float32, a contrast (H, W) in pixels that are `factor` times as wide, each the mean of those it covers.

    The last columns and rows that fill no pixel are left out.
    """
    if factor == 1:
        return contrast
    height, width = (n // factor for n in contrast.shape)
    if not height or not width:
        return contrast[:1, :1]
    return cv2.resize(contrast[:height * factor, :width * factor], (width, height), interpolation=cv2.INTER_AREA)


# Where a photo lies, to about a metre: its paint correlated with that of the intensity image over shift, turn and scale.

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


def find_places(photo: np.ndarray, paint: np.ndarray, cell: float, bounds: Bounds, sign: int = 1,
                progress: Progress = Progress()) -> list[Place]:
    """The places where the paint of a photo fits that of the intensity image best, the best first, some metres or a turn apart.

    photo : (H, W) contrast of the photo, in pixels of `bounds.sizes`
    paint : (h, w) contrast of the intensity image in cells of `cell` m, north up, its outer corner at local 0, 0 and y negative below it
    sign : 1, or -1 where paint is darker than the road
    """
    middle_size = float(np.sqrt(bounds.sizes[0] * bounds.sizes[1]))
    half = 0.5 * max(photo.shape) * middle_size
    step = _SLACK * _CELLS[0] / half
    turns = _steps(*bounds.turns, step)
    sizes = np.exp(_steps(float(np.log(bounds.sizes[0])), float(np.log(bounds.sizes[1])), step))
    rough: list[Place] = []
    first = _Round(photo, paint, cell, middle_size, _CELLS[0])
    for number, size in enumerate(sizes):   # of one size after the other: the paint is transformed once for all turns
        progress.report(0.7 * number / len(sizes))
        for turn in turns:
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
        near, tried = int(2.5 * _CELLS[0] / self.cell), []
        for turn, size in product((place.turn - span, place.turn, place.turn + span), place.size * np.exp([-span, 0.0, span])):
            canvas = self.warped(turn, float(size))
            column, row = self._corner(place, len(canvas))
            sums = cv2.matchTemplate(self._part(column - near, row - near, len(canvas) + 2 * near), canvas, cv2.TM_CCORR)
            down, across = np.unravel_index((place.sign * sums).argmax(), sums.shape)
            x, y = (column - near + across + len(canvas) / 2) * self.cell, -(row - near + down + len(canvas) / 2) * self.cell
            tried.append(self._judged(place._replace(x=float(x), y=float(y), turn=turn, size=float(size)), canvas))
        return max(tried, key=lambda one: one.score)

    def _corner(self, place, side):
        """Column and row of the first cell of the photo's canvas, which is that large, at a place."""
        return round(place.x / self.cell - side / 2), round(-place.y / self.cell - side / 2)

    def _part(self, column, row, side):
        """A square of the paint from a cell on, 0 where it reaches beyond."""
        part, (height, width) = np.zeros((side, side), np.float32), self.paint.shape
        rows, columns = slice(max(row, 0), min(row + side, height)), slice(max(column, 0), min(column + side, width))
        if rows.start < rows.stop and columns.start < columns.stop:
            part[rows.start - row:rows.stop - row, columns.start - column:columns.stop - column] = self.paint[rows, columns]
        return part

    def _middles(self, shape, side, bounds):
        """(x and y of the photo's middle for every column and row of a product, those too far away as (H, W) bool)."""
        key = (shape, side, bounds)
        if self._places is None or self._places[0] != key:
            # shifts of a circular correlation, those beyond the photo's side being negative ones
            across, down = ((np.where(np.arange(n) > n - side, np.arange(n) - n, np.arange(n)) + side / 2) * self.cell for n in shape[::-1])
            far = (across[None, :] - bounds.x) ** 2 + (-down[:, None] - bounds.y) ** 2 > bounds.reach**2
            self._places = key, (across, -down, far)
        return self._places[1]

    def _judged(self, place, canvas):
        """The place with the correlation of both contrasts where both are known as its score."""
        paint = self._part(*self._corner(place, len(canvas)), len(canvas))
        photo = np.where(paint == 0, 0.0, canvas)
        norm = float(np.sqrt((paint * paint).sum() * (photo * photo).sum()))
        return place._replace(score=place.sign * float((paint * photo).sum()) / norm if norm else 0.0)


# What is searched: the part of the intensity image where a photo may lie.

MOST_GROUND = 500.0     # m, longest side of an image: beyond, every turn of a fraction of a degree would have to be tried
MOST_SEARCHED = 1000.0  # m, longest side of an intensity image that is searched without any position


def paint_about(image: SourceImage, intensity: IntensityImage, rough: RoughPlace) -> tuple[SurveyedPaint, Bounds]:
    """The paint where an image may lie by a RoughPlace in the CRS of the intensity image, and what is to be tried there.

    Bounds are in local coordinates of the SurveyedPaint, for the pixels of the image itself.
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
    paint = _read_paint(intensity, (rough.x - far, rough.y - far, rough.x + far, rough.y + far) if placed else None)
    if not np.isfinite(paint.values).any():
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


# Where each place of the map lies in the photo, by a polynomial, the photo drawn onto the map by it, and RANSAC.

_NODE = 16  # cells between places whose pixels are computed; between them they are interpolated


@dataclass(frozen=True)
class Placement:
    """From local map coordinates to pixel and line."""

    polynomial: ImagePolynomial   # ImagePolynomial whose input is x and y, m, and whose output is pixel and line
    sign: int = 1   # -1 where paint is darker than the road

    @classmethod
    def fitted(cls, x: np.ndarray, y: np.ndarray, pixel: np.ndarray, line: np.ndarray, order: int, sign: int = 1) -> Placement:
        """The least-squares placement of (N,) places; N at least MIN_CONTROL_POINTS[order], not on a line."""
        return cls(fit_image_polynomial(x, y, pixel, line, order).polynomial, sign)

    @classmethod
    def similarity(cls, x: float, y: float, turn: float, size: float, middle: tuple[float, float], sign: int = 1) -> Placement:
        """From a place (m) that lies at a `middle` (pixel and line), the turn (radians) and the size (m) of the pixels."""
        along, up = np.array([-1.0, 1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0, 1.0])
        across, down = middle[0] + along / size, middle[1] - up / size
        cos, sin = np.cos(turn), np.sin(turn)
        return cls.fitted(x + along * cos - up * sin, y + along * sin + up * cos, across, down, 1, sign)

    def pixels(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pixel and line, (N,) each, of (N,) places."""
        return self.polynomial.to_map(x, y)

    def metres(self, x: np.ndarray, y: np.ndarray, pixel: np.ndarray, line: np.ndarray) -> np.ndarray:
        """(N, 2) m, how far on the map (N,) pixels lie from those of places, to first order."""
        placed = np.column_stack(self.pixels(x, y))
        slope = self.polynomial.jacobian(x, y)
        return np.linalg.solve(slope, (np.column_stack([pixel, line]) - placed)[..., None])[..., 0]

    def drawn(self, photo: Photo, cell: float, shape: tuple[int, ...]) -> np.ndarray:
        """(H, W) float32, the contrast of a photo on cells (m) of the map from local 0, 0 to the east and south: of dark paint negated, 0 outside.

        Where a cell covers several pixels of the photo these are averaged first.
        """
        height, width = shape
        across = np.linspace(0, width, max(2, -(-width // _NODE) + 1))
        down = np.linspace(0, height, max(2, -(-height // _NODE) + 1))
        x, y = np.meshgrid(across * cell, -down * cell)
        pixel, line = (axis.reshape(x.shape) for axis in self.pixels(x.ravel(), y.ravel()))
        centre = self.polynomial.centre
        per_metre = np.sqrt(abs(np.linalg.det(self.polynomial.jacobian(centre[:1], centre[1:])[0])))
        reduction = max(1, int(cell * per_metre / photo.factor + 0.25))
        factor = photo.factor * reduction
        nodes = [(position / factor - 0.5).astype(np.float32) for position in (pixel, line)]
        # of the middles of the cells: linear between the nodes
        grid = np.meshgrid((np.arange(width) + 0.5) * (len(across) - 1) / width, (np.arange(height) + 0.5) * (len(down) - 1) / height)
        maps = [cv2.remap(node, *(axis.astype(np.float32) for axis in grid), cv2.INTER_LINEAR) for node in nodes]
        return self.sign * cv2.remap(reduced(photo.contrast, reduction), *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=0.0)


# A placement that most pairs of places agree on, whatever the others say (RANSAC).

_DRAWS = 2000         # cost: at most so many, of three pairs: with half of them false, all three are true in one of eight draws
_ROUNDS = 10          # of fitting to the pairs that agree and looking again which these are
_PAIRS_PER_TERM = 2   # an order is fitted to at least so many times the pairs that it needs


def agreeing(x: np.ndarray, y: np.ndarray, moved: np.ndarray, tolerance: float) -> np.ndarray:
    """(N,) bool, the pairs whose displacements one affine transformation explains, as many as can be found; none of too few places.

    Where the places lie on a line, as large patches of a straight road do, the transformation is a similarity.

    x, y, moved : (N,) and (N, 2) m, places on the map and their displacements
    tolerance : m, from the displacement that the transformation gives
    """
    places, inside = np.column_stack([x, y]), None
    if len(x) >= MIN_CONTROL_POINTS[1]:
        estimate = cv2.estimateAffinePartial2D if lie_on_a_line(places) else cv2.estimateAffine2D
        _, inside = estimate(places, places + moved, ransacReprojThreshold=tolerance, maxIters=_DRAWS, confidence=0.9999, refineIters=0)
    return np.zeros(len(x), bool) if inside is None else inside.ravel() > 0


def robust_placement(placement: Placement, x: np.ndarray, y: np.ndarray, moved: np.ndarray,
                     tolerance: float) -> tuple[Placement, np.ndarray] | None:
    """A new placement, of order 2 where there are pairs enough, from places of the map that were found displaced in the photo as drawn by an old one.

    x, y, moved : (N,) and (N, 2) m, places on the map, and from there to where the drawn photo has them
    tolerance : m, largest residual of a pair that is used
    Returns placement, used: Placement and (N,) bool; None where no three pairs agree
    """
    pixel, line = placement.pixels(x + moved[:, 0], y + moved[:, 1])
    used = agreeing(x, y, moved, tolerance * 1.5)
    fitted = placement
    for _ in range(_ROUNDS):
        if used.sum() < MIN_CONTROL_POINTS[1]:
            return None
        degree = highest_order(x[used], y[used])
        fitted = (Placement.fitted(x[used], y[used], pixel[used], line[used], degree, placement.sign) if degree else
                  _turned(placement, x[used], y[used], moved[used]))
        before, used = used, np.hypot(*fitted.metres(x, y, pixel, line).T) <= tolerance
        if (used == before).all():
            break
    return (fitted, used) if used.sum() >= MIN_CONTROL_POINTS[1] else None


def _turned(placement, x, y, moved):
    """The placement after the similarity that fits the displacements best: places on a line say no more."""
    terms = np.column_stack([np.ones(len(x)), x + 1j * y])
    a, b = np.linalg.lstsq(terms, moved[:, 0] + 1j * moved[:, 1], rcond=None)[0]
    reach = max(np.ptp(x), np.ptp(y), 1.0) / 2
    across, down = (axis.ravel() for axis in np.meshgrid(*np.array([[-1.0], [1.0]]).T.repeat(2, 0) * reach))
    at_x, at_y = x.mean() + across, y.mean() + down
    shift = a + b * (at_x + 1j * at_y)
    return Placement.fitted(at_x, at_y, *placement.pixels(at_x + shift.real, at_y + shift.imag), 1, placement.sign)


def highest_order(x: np.ndarray, y: np.ndarray) -> int:
    """The highest order, 2 or 1, that (N,) places determine well; 0 where they lie on a line or are too few."""
    for order in (2, 1):
        if len(x) >= _PAIRS_PER_TERM * MIN_CONTROL_POINTS[order] or (order == 1 and len(x) > MIN_CONTROL_POINTS[1]):
            if not lie_on_a_line(np.column_stack([x, y])) and (order == 1 or inverse_condition(x, y, order) > 10 * MIN_INVERSE_CONDITION):
                return order
    return 0


def left_out_residuals(x: np.ndarray, y: np.ndarray, pixel: np.ndarray, line: np.ndarray, used: np.ndarray, order: int) -> np.ndarray:
    """(N,) m, residuals of pairs on the map against a polynomial from the image to the map, fitted to those `used` without each."""
    fit = fit_image_polynomial(pixel[used], line[used], x[used], y[used], order)
    residuals = np.column_stack([x, y]) - np.column_stack(fit.polynomial.to_map(pixel, line))
    residuals[used] = fit.left_out
    return np.hypot(*residuals.T)
