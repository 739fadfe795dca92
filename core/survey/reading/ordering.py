"""The phase that puts points in order: sections are read from where they were stored, finished, sorted, and written to a folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ...common.progress import Progress
from ...execution.phase import Executor, Phase, Recipe
from ..store.section_store import SectionStore
from ..store.store_index import StoreIndex
from .finishing import Finishing

ORDERED_POINTS = 1_200_000   # points of a task, about: less than a second of a worker's time, some 25 MB of its file


class UnorderedPoints:
    """Points of a store, to be put in order in a folder.

    Parameters
    ----------
    store : SectionStore; the executor's workers must see its folder
    finishing : what its points are finished with, None where they are
    folder : that gets the points
    """

    def __init__(self, store: SectionStore, finishing: Finishing | None, folder: Path):
        self.store, self.finishing, self.folder = store, finishing, folder

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the points."""
        return Recipe("survey.reading.ordering:unordered_points", dict(contents=self.store.contents(), points_folder=str(self.store.folder),
                                                               finishing=self.finishing, folder=str(self.folder)))

    def items(self) -> list[tuple[int, int, int]]:
        """(road, first, last + 1 number of a section) of stretches with about ORDERED_POINTS points each."""
        found: list[tuple[int, int, int]] = []
        for road in self.store.roads():
            numbers = np.array(self.store.sections(road))
            ends = np.cumsum([self.store.size(road, number) for number in numbers.tolist()])
            cuts = numbers[np.searchsorted(ends, np.arange(ORDERED_POINTS, ends[-1], ORDERED_POINTS))] + 1
            bounds = np.unique(np.r_[numbers[0], cuts, numbers[-1] + 1]).tolist()
            found += [(road, first, end) for first, end in zip(bounds[:-1], bounds[1:])]
        return found

    def put_in_order(self, executor: Executor, place: Callable[[int, float, float], str], progress: Progress) -> None:
        """Put all points in order; the store has them from the folder, from then on.

        Parameters
        ----------
        executor : who does it
        place : names the stretch of a road between two stations (m)
        progress : Progress
        """
        length = self.store.section_length

        def points(item):
            return self.store.points_between(item[0], item[1] * length, item[2] * length)

        phase = Phase(order_sections, self, (), lambda item: place(item[0], item[1] * length, item[2] * length), points)
        found = list(executor.run(phase, self.items(), progress))
        self.store.take_over(StoreIndex.join(found), self.folder)


def unordered_points(contents: dict[str, Any], points_folder: str, finishing: Finishing | None, folder: str) -> UnorderedPoints:
    """What `UnorderedPoints.recipe` describes."""
    store = SectionStore.opened(Path(points_folder), **contents)
    store.finish = finishing
    return UnorderedPoints(store, finishing, Path(folder))


def order_sections(source: UnorderedPoints, item: tuple[int, int, int]) -> StoreIndex:
    """The phase: the points of some sections, in order, in a file of the folder.

    Parameters
    ----------
    source : UnorderedPoints
    item : (road, first, last + 1 number of a section)
    """
    road, first, end = item
    keys = [(road, number) for number in source.store.sections(road) if first <= number < end]
    return source.store.write_in_order(keys, source.folder)

