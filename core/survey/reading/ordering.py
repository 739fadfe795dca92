"""The phase that puts points in order: sections are read from where they were stored, finished, sorted, and written to a folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ...common.progress import Progress
from ...execution.phase import Executor, Phase, Recipe
from ..store.section_store import STRETCH_POINTS, SectionStore, Stretch
from ..store.spill_file import StoreIndex, close_parts
from .finishing import Finishing


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
        found = list(executor.run(phase, self.store.stretches(STRETCH_POINTS, self.store.numbers()), progress))
        self.store.take_over(StoreIndex.join(found), self.folder)


def unordered_points(contents: dict[str, Any], points_folder: str, finishing: Finishing | None, folder: str) -> UnorderedPoints:
    """What `UnorderedPoints.recipe` describes."""
    store = SectionStore.opened(Path(points_folder), **contents)
    store.finish = finishing
    return UnorderedPoints(store, finishing, Path(folder))


def order_sections(source: UnorderedPoints, item: Stretch) -> StoreIndex:
    """The phase: the points of some sections, in order, in a file of the folder.

    Parameters
    ----------
    source : UnorderedPoints
    item : Stretch of its road
    """
    try:
        return source.store.write_in_order(source.store.in_stretch(item), source.folder)
    finally:
        # they are removed when all is in order, which Windows refuses for files that are open
        close_parts()

