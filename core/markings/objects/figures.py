"""Which markings show a bicycle or the word BUS: a figure may be one marking or, letter by letter, several.

Markings that lie together are compared with the drawn figures of the country catalogue. What does not agree clearly keeps its class.
On simulated figures with 2 to 4 cm of noise, scan lines 8 to 12 cm apart and a fifth to a third of the points worn off, bicycles
and BUS reach 0.61 to 0.89 as a whole; most other words, numbers, arrows and filled shapes fall short in the whole or in one third.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...common.groups import linked_groups, members_of
from ...common.near_pairs import overlapping_pairs
from ...common.parallel import check_cancelled
from ...countries.painted_symbols import SYMBOLS
from ...lazy import cv2
from ..figures.match import PaintImage, agreement
from ..road_grid import CELL_SIZE, fill_gaps, filled_between_tracks
from .classify import NOT_PAINT

if TYPE_CHECKING:
    from ...execution.phase import NoSource
    from .shape import Shape

FIGURE_PARTS = NOT_PAINT, "symbol", "arrow", "hatch"   # classes that pieces of a figure may have; a small wheel looks like a cover
FIGURE_SIZE = 0.6, 5.0      # m along and across of a figure
SCAN_GAP = 4                # cells along the road between scan lines that are closed; the strokes of a figure lie farther apart
LETTER_GAP = 0.45           # m between parts of one figure at most
MOST_PARTS = 12             # of a figure
GROUPS_AT_ONCE = 200        # groups of markings whose cells are in memory together
THICK_CELLS = 9            # cells: strokes of figures are thinner than this, 0.36 m, in one direction at least
MOST_THICK = 0.4            # of the paint may be thicker: bars of words that are 4 m long
LEAST_AGREEMENT = {"bicycle": (0.68, 0.64), "bus": (0.72, 0.66)}   # of the whole figure, and of the third that agrees least


class RecognisedFigure(NamedTuple):
    """A figure: the numbers of its markings, and its class."""

    members: tuple[int, ...]
    kind: str


Candidate = tuple[tuple[int, ...], np.ndarray, np.ndarray]   # markings that may be a figure together; their cells, and m of `track_reach` there


def painted_figures(shapes: Sequence[Shape], kinds: Sequence[str], possible: np.ndarray,
                    cells_of: Callable[[tuple[int, ...]], tuple[np.ndarray, np.ndarray]],
                    look: Callable[[list[list[Candidate]], float, float], Iterable[list[tuple[int, str]]]]) -> list[RecognisedFigure]:
    """Bicycles and words among the markings of one road.

    Parameters
    ----------
    shapes : N Shape
    kinds : N classes, "" for what was taken for no paint
    possible : (N,) bool, whether a marking lies where paint can be
    cells_of : gives the (K, 2) int cells of some markings together, different ones, and the (K,) m of `track_reach` there
    look : gives what `figures_of_group` finds in each of some groups, which are all groups from one fraction to another

    Returns
    -------
    list of RecognisedFigure, no marking in two of them
    """
    parts = np.flatnonzero(possible & np.isin(np.array(kinds, object), FIGURE_PARTS))
    found: list[RecognisedFigure] = []
    groups = list(_candidates(shapes, kinds, parts))
    for first in range(0, len(groups), GROUPS_AT_ONCE):
        some = [[(members, *cells_of(members)) for members in group] for group in groups[first:first + GROUPS_AT_ONCE]]
        for group, figures in zip(some, look(some, first / len(groups), (first + len(some)) / len(groups))):
            found += [RecognisedFigure(group[k][0], kind) for k, kind in figures]
    return found


def figures_of_group(source: NoSource, group: list[Candidate]) -> list[tuple[int, str]]:
    """The phase that compares markings that lie together with figures: which candidates are one, and its class; no marking is in two."""
    found: list[tuple[int, str]] = []
    taken: set[int] = set()
    for k, (members, cells, reach) in enumerate(group):
        check_cancelled()
        if taken.isdisjoint(members) and (kind := _figure(cells, reach)):
            found.append((k, kind))
            taken.update(members)
    return found


def _candidates(shapes: Sequence[Shape], kinds: Sequence[str], parts: np.ndarray) -> Iterator[list[tuple[int, ...]]]:
    """Of each group of markings that lie together those that may be a figure: all, those of them that were taken for paint, and each alone."""
    box = np.array([(shape.s0, shape.s1, shape.d0, shape.d1) for shape in shapes]).reshape(-1, 4)[parts]
    links = [np.empty((0, 2), np.int64)]
    for a, b in overlapping_pairs(box[:, 0], box[:, 1], box[:, 0], box[:, 1], LETTER_GAP):
        across = np.maximum(box[a, 2], box[b, 2]) - np.minimum(box[a, 3], box[b, 3])
        links.append(np.column_stack([a, b])[across <= LETTER_GAP])
    pairs = np.concatenate(links)
    group = linked_groups(pairs[:, 0], pairs[:, 1], len(parts))
    for _, together in members_of(group):
        painted = together[[kinds[k] != NOT_PAINT for k in parts[together]]]
        tried, large = set(), []
        for some in (together, painted, *(one[None] for one in together)):
            members = tuple(parts[some].tolist())
            if members in tried or not 0 < len(some) <= MOST_PARTS:
                continue
            tried.add(members)
            size = box[some][:, [1, 3]].max(axis=0) - box[some][:, [0, 2]].min(axis=0)
            if size.min() >= FIGURE_SIZE[0] and size.max() <= FIGURE_SIZE[1]:
                large.append(members)
        if large:
            yield large


def _figure(cells, reach):
    """The class of the figure that cells show, "" where none clearly."""
    mask, first = filled_between_tracks(cells, reach)
    mask = fill_gaps(mask, SCAN_GAP, 0)
    thick = cv2.morphologyEx(mask.astype(np.uint8), cv2.MORPH_OPEN, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (THICK_CELLS, THICK_CELLS)))
    if thick.sum() > MOST_THICK * mask.sum():
        return ""
    image = PaintImage.of(mask, first * CELL_SIZE, CELL_SIZE)
    best, kind = 0.0, ""
    for symbol in SYMBOLS:
        found, (whole, third) = agreement(image, symbol), LEAST_AGREEMENT[symbol.kind]
        if found is not None and found.whole >= whole and found.worst_third >= third and found.whole > best:
            best, kind = found.whole, symbol.kind
    return kind
