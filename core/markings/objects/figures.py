"""Which markings show a bicycle or the word BUS: a figure may be one marking or, letter by letter, several.

Markings that lie together are compared with the drawn figures of the country catalogue. What does not agree clearly keeps its class.
On simulated figures with 2 to 4 cm of noise, scan lines 8 to 12 cm apart and a fifth to a third of the points worn off, bicycles
and BUS reach 0.61 to 0.89 as a whole; most other words, numbers, arrows and filled shapes fall short in the whole or in one third.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from ...common.arrays import linked_groups, members_of, overlapping_pairs
from ...countries.painted_symbols import SYMBOLS, PaintedSymbol
from ...execution.in_step import Asked, Work
from ...execution.phase import Items, NoSource, Phase
from ...execution.weights import EXECUTION
from ...lazy import cv2
from ..road_grid import CELL_SIZE, fill_gaps, filled_between_tracks
from ..weights import FIGURES
from .classify import NOT_PAINT
from .shape import Shape

FIGURE_PARTS = NOT_PAINT, "symbol", "arrow", "hatch"   # classes that pieces of a figure may have; a small wheel looks like a cover


class _RecognisedFigure(NamedTuple):
    """A figure: the numbers of its markings, and its class."""

    members: tuple[int, ...]
    kind: str


def painted_figures(shapes: Sequence[Shape], kinds: Sequence[str], possible: np.ndarray,
                    cells_of: Callable[[tuple[int, ...]], tuple[np.ndarray, np.ndarray]]) -> Work:
    """Part of a work: [_RecognisedFigure], bicycles and words among the N markings of one road; no marking is in two of them.

    kinds : N classes, "" for what was taken for no paint
    possible : (N,) bool, whether a marking lies where paint can be
    cells_of : gives the (K, 2) int cells of some markings together, different ones, and the (K,) m of `track_reach` there
    """
    parts = np.flatnonzero(possible & np.isin(np.array(kinds, object), FIGURE_PARTS))
    result: list[_RecognisedFigure] = []
    candidates = list(_candidates(shapes, kinds, parts))
    phase = Phase(figure_of_cells, NoSource(), (), lambda item: "the figures of all roads", together=EXECUTION.items_per_task)
    used: set[int] = set()
    for members, kind in zip(candidates, (yield Asked(phase, Items(len(candidates), lambda k: cells_of(candidates[k])), 0.5))):
        if kind and used.isdisjoint(members):
            result.append(_RecognisedFigure(members, kind))
            used.update(members)
    return result


def _candidates(shapes: Sequence[Shape], kinds: Sequence[str], parts: np.ndarray) -> Iterator[tuple[int, ...]]:
    """Of each group of markings that lie together those that may be a figure: all, those of them that were taken for paint, and each alone."""
    box = np.array([(shape.s0, shape.s1, shape.d0, shape.d1) for shape in shapes]).reshape(-1, 4)[parts]
    a, b = overlapping_pairs(box[:, 0], box[:, 1], box[:, 0], box[:, 1], FIGURES.letter_gap)
    near = np.maximum(box[a, 2], box[b, 2]) - np.minimum(box[a, 3], box[b, 3]) <= FIGURES.letter_gap
    group = linked_groups(a[near], b[near], len(parts))
    for _, together in members_of(group):
        painted = together[[kinds[k] != NOT_PAINT for k in parts[together]]]
        tried = set()
        for subset in (together, painted, *(single[None] for single in together)):
            members = tuple(parts[subset].tolist())
            if members in tried or not 0 < len(subset) <= FIGURES.most_parts:
                continue
            tried.add(members)
            size = box[subset][:, [1, 3]].max(axis=0) - box[subset][:, [0, 2]].min(axis=0)
            if FIGURES.figure_size[0] <= size.min() <= size.max() <= FIGURES.figure_size[1]:
                yield members


def figure_of_cells(source: NoSource, item: tuple[np.ndarray, np.ndarray]) -> str:
    """The phase that compares markings that lie together with figures: the class of the one that their cells show, "" where none clearly.

    item : as `painted_figures` is given it by `cells_of`
    """
    cells, reach = item
    mask, first = filled_between_tracks(cells, reach)
    mask = fill_gaps(mask, FIGURES.scan_gap, 0)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (FIGURES.thick_cells, FIGURES.thick_cells))
    thick = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_OPEN, disc)
    if thick.sum() > FIGURES.most_thick * mask.sum():
        return ""
    image = _PaintImage.of(mask, first * CELL_SIZE, CELL_SIZE)
    best, kind = 0.0, ""
    for symbol in SYMBOLS:
        (whole, third), (least, least_third) = agreement(image, symbol), getattr(FIGURES, f"least_of_{symbol.kind}")
        if whole >= least and third >= least_third and whole > best:
            best, kind = whole, symbol.kind
    return kind


# How well painted cells agree with a drawn figure: two images, of which the paint is turned, moved and scaled to cover the figure. They are
# compared by their correlation, bare road within the figure included, and each third by itself, so that another letter or one wheel is noticed.

TURNS = np.radians(np.arange(0.0, 360.0, 10.0))   # derived: that are tried


class _PaintImage(NamedTuple):
    """Paint of one marking or several."""

    image: np.ndarray   # (A, B) float32, painted cells blurred, first axis along the road and second across it
    corner: np.ndarray   # (2,) m, station and offset of its corner
    size: float   # m, of a cell
    places: np.ndarray   # (N, 2) m, the middles of the painted cells
    spread_right: np.ndarray   # (T,) m, standard deviation of these along the axes of a figure turned by each of TURNS
    spread_up: np.ndarray
    total_square: float   # sum of the squares of the image

    @classmethod
    def of(cls, mask: np.ndarray, corner: np.ndarray, size: float) -> _PaintImage:
        """The image of painted cells, (A, B) bool with cells of `size` m, from station and offset `corner` on."""
        image = cv2.GaussianBlur(np.pad(mask, FIGURES.rim).astype(np.float32), (0, 0), FIGURES.paint_blur)
        places = (np.argwhere(mask) + 0.5) * size + corner
        right, up = ((places @ way).std(axis=0) for way in _axes(TURNS))
        return cls(image, corner - FIGURES.rim * size, size, places, right, up, float((image * image).sum()))


class _Figure(NamedTuple):
    """A figure as an image."""

    image: np.ndarray   # (rows, columns) float32, blurred, of mean 0 and length 1; the first row is its top
    spread: np.ndarray   # (2,) standard deviation and mean place of its paint, right and up
    middle: np.ndarray
    size: np.ndarray   # (2,) width and height; units of its height


@cache
def figures_of(symbol: PaintedSymbol) -> tuple[_Figure, ...]:
    """The figure and its mirror image: a bicycle may look either way."""
    return _drawn(symbol, 1.0), _drawn(symbol, -1.0)


def _drawn(symbol, hand):
    strokes = [np.array(stroke) * [hand, 1.0] for stroke in symbol.strokes]
    low = np.min([stroke.min(axis=0) for stroke in strokes], axis=0) - symbol.stroke_width / 2
    high = np.max([stroke.max(axis=0) for stroke in strokes], axis=0) + symbol.stroke_width / 2
    size = high - low
    scale = FIGURES.figure_height / size[1]
    columns, rows = (np.ceil(size * scale).astype(int) + 2 * FIGURES.figure_margin).tolist()
    image = np.zeros((rows, columns), np.uint8)
    for stroke in strokes:
        pixels = (stroke - low) * scale
        pixels = np.column_stack([pixels[:, 0] + FIGURES.figure_margin, FIGURES.figure_height + FIGURES.figure_margin - pixels[:, 1]])
        # OpenCV has the middle of the first pixel at 0, and takes places in sixteenths
        thickness = max(int(round(symbol.stroke_width * scale)), 1)
        cv2.polylines(image, [np.rint(16 * (pixels - 0.5)).astype(np.int32)], False, 1, thickness, cv2.LINE_8, 4)
    row, column = np.nonzero(image)
    paint = np.stack([column + 0.5 - FIGURES.figure_margin, FIGURES.figure_height + FIGURES.figure_margin - row - 0.5]) / scale
    return _Figure(_normed(cv2.GaussianBlur(image.astype(np.float32), (0, 0), FIGURES.figure_blur)), paint.std(axis=1), paint.mean(axis=1), size)


def _normed(image):
    image = image - image.mean()
    return image / max(float(np.linalg.norm(image)), 1e-6)


def agreement(cells: _PaintImage, symbol: PaintedSymbol) -> tuple[float, float]:
    """How well paint agrees with a figure where it does best: correlation of the whole, -1 to 1, and of the third that agrees least.

    Both are -1 where the paint has not the figure's size in any direction, or is nothing like it.
    """
    best = None
    for figure in figures_of(symbol):
        poses = _allowed(_poses(cells, figure), figure, symbol)
        correlations = _correlations(cells, figure, poses)
        # of equal ones the last
        for k in np.lexsort((np.arange(len(poses)), correlations))[::-1][:FIGURES.closest].tolist():
            if correlations[k] < FIGURES.least_at_first:
                break
            refined = _closer(cells, figure, symbol, correlations[k], poses[k])
            if best is None or refined[0] > best[0]:
                best = (*refined, figure)
    if best is None:
        return -1.0, -1.0
    whole, pose, figure = best
    paint = _seen(cells, figure, pose[None])[0]
    columns = np.array_split(np.arange(figure.image.shape[1]), 3)
    return float(whole), min(float((_normed(figure.image[:, third]) * _normed(paint[:, third])).sum()) for third in columns)


def _poses(cells: _PaintImage, figure: _Figure) -> np.ndarray:
    """(P, 5) where the figure lies, in every direction, if the paint is spread as the figure's is.

    Radians from the first axis of the paint to its right, its middle, m, and width and height of a unit of it, m.
    """
    right, up = _axes(TURNS)
    scale = np.stack([cells.spread_right, cells.spread_up]) / figure.spread[:, None]
    shift = (figure.middle - figure.size / 2)[:, None] * scale
    middle = cells.places.mean(axis=0)[:, None] - shift[0] * right - shift[1] * up
    return np.column_stack([TURNS, *middle, *scale])


def _axes(turn):
    """(2, P) the ways to the right of figures and up."""
    along, across = np.cos(turn), np.sin(turn)
    return np.array([along, across]), np.array([-across, along])


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
    unit = figure.size[1] / FIGURES.figure_height
    across, down = right * width * unit, -up * height * unit
    rows, columns = figure.image.shape
    corner = np.array([x, y]) - across * (columns - 1) / 2 - down * (rows - 1) / 2
    to_cells = np.array([across, down, corner - cells.corner[:, None]]).swapaxes(0, 1) / cells.size
    to_cells[:, 2] -= 0.5
    images = np.empty((len(poses), rows, columns), np.float32)
    # OpenCV has the second axis first
    for transform, image in zip(np.ascontiguousarray(to_cells.transpose(2, 0, 1)[:, ::-1]), images):
        cv2.warpAffine(cells.image, transform, (columns, rows), image, cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)
    return images


def _correlations(cells, figure, poses):
    """(P,) correlation of the figure with the paint in each pose."""
    unit = figure.size[1] / FIGURES.figure_height
    paint = _seen(cells, figure, poses).reshape(len(poses), figure.image.size)
    total, square, product = (values.sum(axis=1).astype(float) for values in (paint, paint * paint, figure.image.ravel() * paint))
    # paint beyond the figure is none of it: it counts as well
    beyond = np.maximum(cells.total_square * cells.size**2 / (poses[:, 3] * poses[:, 4] * unit * unit) - square, 0.0)
    return product / np.sqrt(np.maximum(square - total**2 / paint.shape[1] + beyond, 1e-12))


def _closer(cells, figure, symbol, correlation, pose):
    """The best correlation near a pose, and the pose there."""
    for step in FIGURES.steps:
        better = True
        while better:
            better = False
            neighbours = _allowed(_beside(pose, figure, step), figure, symbol)
            for value, neighbour in zip(_correlations(cells, figure, neighbours).tolist(), neighbours):
                if value > correlation + 1e-4:
                    correlation, pose, better = value, neighbour, True
    return correlation, pose


def _beside(pose, figure, step):
    """(10, 5) poses that are turned, stretched and moved by a step either way."""
    right, up = _axes(pose[0])
    poses = np.repeat(pose[None], 10, axis=0)
    for k, sign in ((0, step), (5, -step)):
        poses[k, 0] += sign
        poses[k + 1, 3] *= 1 + sign
        poses[k + 2, 4] *= 1 + sign
        poses[k + 3, 1:3] += right * (pose[3] * figure.size[0]) * sign / 2
        poses[k + 4, 1:3] += up * (pose[4] * figure.size[1]) * sign / 2
    return poses
