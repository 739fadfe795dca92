"""How well painted cells agree with a drawn figure, in whatever direction it lies and however it is stretched.

The figure and the paint are two images. The paint is turned, moved and scaled so that it covers the figure, and the two are
compared by their correlation: 1 for the same image, about 0 for images that have nothing to do with each other. Bare road
within the figure counts as much as paint does. Each third of the figure is compared by itself, too, so that a figure with another
letter, or with one wheel, is told.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from ...countries.painted_symbols import PaintedSymbol
from ...lazy import cv2

PAINT_BLUR = 0.8           # cells
RIM = 4                    # cells about the paint
FIGURE_HEIGHT = 48         # px of a figure
FIGURE_MARGIN = 8          # px of bare road about it that is compared, too
FIGURE_BLUR = 2.0          # px, so that strokes need not lie exactly on each other
TURNS = np.radians(np.arange(0.0, 360.0, 10.0))   # that are tried
CLOSEST = 3                # of them are looked at closely
LEAST_AT_FIRST = 0.20      # correlation of a first pose that is worth a closer look: a figure with a part missing may begin so low
STEPS = 0.10, 0.05, 0.025  # of the size that it is moved and stretched by, and the same in radians that it is turned by, coarse to fine


class PaintImage(NamedTuple):
    """Paint of one marking or several.

    image : (A, B) float32, painted cells blurred, first axis along the road and second across it
    corner : (2,) m, station and offset of its corner
    size : m, of a cell
    places : (N, 2) m, the middles of the painted cells
    spread_right, spread_up : (T,) m, standard deviation of these along the axes of a figure turned by each of TURNS
    total_square : sum of the squares of the image
    """

    image: np.ndarray
    corner: np.ndarray
    size: float
    places: np.ndarray
    spread_right: np.ndarray
    spread_up: np.ndarray
    total_square: float

    @classmethod
    def of(cls, mask: np.ndarray, corner: np.ndarray, size: float) -> PaintImage:
        """The image of painted cells.

        Parameters
        ----------
        mask : (A, B) bool, first axis along the road, second across it
        corner : (2,) m, station and offset where it begins
        size : m, of a cell
        """
        image = cv2.GaussianBlur(np.pad(mask, RIM).astype(np.float32), (0, 0), PAINT_BLUR)
        places = (np.argwhere(mask) + 0.5) * size + corner
        right, up = ((places @ way).std(axis=0) for way in _axes(TURNS))
        return cls(image, corner - RIM * size, size, places, right, up, float((image * image).sum()))


class Pose(NamedTuple):
    """Where a figure lies.

    turn : radians from the first axis of the paint to the way to the right of the figure
    x, y : m, its middle; width, height : m, of one unit of the figure
    """

    turn: float
    x: float
    y: float
    width: float
    height: float


class Agreement(NamedTuple):
    """How well paint agrees with a figure: the correlation of the whole, -1 to 1, that of the third that agrees least, and the pose."""

    whole: float
    worst_third: float
    pose: Pose


class Figure(NamedTuple):
    """A figure as an image.

    image : (rows, columns) float32, blurred, of mean 0 and length 1; the first row is its top
    spread : (2,) standard deviation of its paint, right and up, units of its height
    middle : (2,) mean place of its paint, right and up
    size : (2,) width and height, units of its height
    """

    image: np.ndarray
    spread: np.ndarray
    middle: np.ndarray
    size: np.ndarray


@cache
def figures_of(symbol: PaintedSymbol) -> tuple[Figure, ...]:
    """The figure and its mirror image: a bicycle may look either way."""
    return _drawn(symbol, 1.0), _drawn(symbol, -1.0)


def _drawn(symbol, hand):
    strokes = [np.array(stroke) * [hand, 1.0] for stroke in symbol.strokes]
    low = np.min([stroke.min(axis=0) for stroke in strokes], axis=0) - symbol.stroke_width / 2
    high = np.max([stroke.max(axis=0) for stroke in strokes], axis=0) + symbol.stroke_width / 2
    size = high - low
    scale = FIGURE_HEIGHT / size[1]
    columns, rows = (np.ceil(size * scale).astype(int) + 2 * FIGURE_MARGIN).tolist()
    image = np.zeros((rows, columns), np.uint8)
    for stroke in strokes:
        places = (stroke - low) * scale
        places = np.column_stack([places[:, 0] + FIGURE_MARGIN, FIGURE_HEIGHT + FIGURE_MARGIN - places[:, 1]])
        # OpenCV has the middle of the first pixel at 0, and takes places in sixteenths
        thickness = max(int(round(symbol.stroke_width * scale)), 1)
        cv2.polylines(image, [np.rint(16 * (places - 0.5)).astype(np.int32)], False, 1, thickness, cv2.LINE_8, 4)
    row, column = np.nonzero(image)
    paint = np.stack([column + 0.5 - FIGURE_MARGIN, FIGURE_HEIGHT + FIGURE_MARGIN - row - 0.5]) / scale
    return Figure(_normed(cv2.GaussianBlur(image.astype(np.float32), (0, 0), FIGURE_BLUR)), paint.std(axis=1), paint.mean(axis=1), size)


def _normed(image):
    image = image - image.mean()
    return image / max(float(np.linalg.norm(image)), 1e-6)


def agreement(cells: PaintImage, symbol: PaintedSymbol) -> Agreement | None:
    """The best agreement of paint with a figure; None where it has not the figure's size in any direction, or is nothing like it.

    Parameters
    ----------
    cells : PaintImage
    symbol : PaintedSymbol
    """
    best = None
    for figure in figures_of(symbol):
        poses = _allowed(_poses(cells, figure), figure, symbol)
        correlations = _correlations(cells, figure, poses)
        # of equal ones the last
        for k in np.lexsort((np.arange(len(poses)), correlations))[::-1][:CLOSEST].tolist():
            if correlations[k] < LEAST_AT_FIRST:
                break
            found = _closer(cells, figure, symbol, correlations[k], poses[k])
            if best is None or found[0] > best[0]:
                best = (*found, figure)
    if best is None:
        return None
    whole, pose, figure = best
    seen = _seen(cells, figure, pose[None])[0]
    columns = np.array_split(np.arange(figure.image.shape[1]), 3)
    return Agreement(float(whole), min(float((_normed(figure.image[:, some]) * _normed(seen[:, some])).sum()) for some in columns),
                     Pose(*pose.tolist()))


def _poses(cells: PaintImage, figure: Figure) -> np.ndarray:
    """(P, 5) as Pose, in every direction, in which the paint is spread as the figure's is."""
    right, up = _axes(TURNS)
    scale = np.stack([cells.spread_right, cells.spread_up]) / figure.spread[:, None]
    off = (figure.middle - figure.size / 2)[:, None] * scale
    middle = cells.places.mean(axis=0)[:, None] - off[0] * right - off[1] * up
    return np.column_stack([TURNS, *middle, *scale])


def _axes(turn):
    """(2, P) the ways to the right of figures and up."""
    along, across = np.cos(turn), np.sin(turn)
    return np.stack([along, across]), np.stack([-across, along])


def _allowed(poses, figure, symbol):
    """Those poses in which the figure has a size and a shape that it may have."""
    width, height = poses[:, 3] * figure.size[0], poses[:, 4] * figure.size[1]
    stretch = poses[:, 4] / poses[:, 3]
    return poses[(symbol.width[0] <= width) & (width <= symbol.width[1]) & (symbol.height[0] <= height) & (height <= symbol.height[1])
                 & (symbol.stretch[0] <= stretch) & (stretch <= symbol.stretch[1])]


def _seen(cells, figure, poses):
    """(P, rows, columns) float32, the paint as it lies on the pixels of the figure."""
    turn, x, y, width, height = poses.T
    right, up = _axes(turn)
    unit = figure.size[1] / FIGURE_HEIGHT
    across, down = right * width * unit, -up * height * unit
    rows, columns = figure.image.shape
    corner = np.stack([x, y]) - across * (columns - 1) / 2 - down * (rows - 1) / 2
    to_cells = np.stack([across, down, corner - cells.corner[:, None]], axis=1) / cells.size
    to_cells[:, 2] -= 0.5
    found = np.empty((len(poses), rows, columns), np.float32)
    # OpenCV has the second axis first
    for one, seen in zip(np.ascontiguousarray(to_cells.transpose(2, 0, 1)[:, ::-1]), found):
        cv2.warpAffine(cells.image, one, (columns, rows), seen, cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)
    return found


def _correlations(cells, figure, poses):
    """(P,) correlation of the figure with the paint in each pose."""
    unit = figure.size[1] / FIGURE_HEIGHT
    seen = _seen(cells, figure, poses).reshape(len(poses), figure.image.size)
    total, square, both = (values.sum(axis=1).astype(float) for values in (seen, seen * seen, figure.image.ravel() * seen))
    # paint beyond the figure is none of it: it counts as well
    beyond = np.maximum(cells.total_square * cells.size**2 / (poses[:, 3] * poses[:, 4] * unit * unit) - square, 0.0)
    return both / np.sqrt(np.maximum(square - total**2 / seen.shape[1] + beyond, 1e-12))


def _closer(cells, figure, symbol, correlation, pose):
    """The best correlation near a pose, and the pose there."""
    for step in STEPS:
        better = True
        while better:
            better = False
            beside = _allowed(_beside(pose, figure, step), figure, symbol)
            for other, one in zip(_correlations(cells, figure, beside).tolist(), beside):
                if other > correlation + 1e-4:
                    correlation, pose, better = other, one, True
    return correlation, pose


def _beside(pose, figure, step):
    """(10, 5) poses that are turned, stretched and moved by a step either way."""
    right, up = _axes(pose[0])
    found = np.repeat(pose[None], 10, axis=0)
    for k, sign in ((0, step), (5, -step)):
        found[k, 0] += sign
        found[k + 1, 3] *= 1 + sign
        found[k + 2, 4] *= 1 + sign
        found[k + 3, 1:3] += right * (pose[3] * figure.size[0]) * sign / 2
        found[k + 4, 1:3] += up * (pose[4] * figure.size[1]) * sign / 2
    return found
