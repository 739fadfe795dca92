"""What of clustering is computed of some clusters or windows apart from all others: phases, whose items hold the columns that they need."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...common.parallel import check_cancelled
from ...common.progress import Progress
from ...execution.phase import Executor, Phase, Recipe
from .shape import Shape, measure
from .split_merge import parts_of_compound
from .zebra import Comb, comb_of_window

if TYPE_CHECKING:
    from ...survey.store.columns import Columns

TASK_POINTS = 20_000   # of paint, that a worker process is given together at least: about a tenth of a second of its time


class NoSource:
    """What phases read from whose items hold all that is needed: some columns of paint, which is a small part of the points."""

    def recipe(self, folder: Path) -> Recipe:
        """There is nothing to open."""
        return Recipe("markings.objects.phases:NoSource", {})


def combs_of_windows(source: NoSource, item: tuple[np.ndarray, np.ndarray]) -> list[tuple[Any, ...] | None]:
    """The phase that looks for stripes of crossings; item : (N, 2) m spots of windows one after the other, and the bounds of the windows."""
    places, bounds = item
    found = []
    for first, end in zip(bounds[:-1].tolist(), bounds[1:].tolist()):
        check_cancelled()
        comb = comb_of_window(places[first:end])
        found.append(None if comb is None else tuple(comb))
    return found


def parts_of_compounds(source: NoSource, item: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]) -> list[tuple[np.ndarray, int]]:
    """The phase that divides compound clusters; item : s, d (0.1 mm), spacing (mm) of the points, and the bounds of the clusters."""
    return [parts_of_compound(*columns) for columns in _clusters(item)]


def shapes_of_clusters(source: NoSource, item: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]) -> list[Shape]:
    """The phase that measures clusters; item : as of `parts_of_compounds`."""
    return [measure(*columns) for columns in _clusters(item)]


def _clusters(item):
    *columns, bounds = item
    for first, end in zip(bounds[:-1].tolist(), bounds[1:].tolist()):
        check_cancelled()
        yield [column[first:end] for column in columns]


@dataclass(frozen=True)
class ApartWork:
    """The phases for the clusters of one road.

    executor : Executor
    road : its number
    """

    executor: Executor
    road: int

    def combs(self, places: np.ndarray, windows: Sequence[np.ndarray], progress: Progress) -> list[Comb | None]:
        """The Comb of each window, None where it has no stripes; places : (N, 2) m, windows : rows of the spots of each."""
        bounds = np.cumsum([0, *map(len, windows)])
        rows = np.concatenate([np.empty(0, np.intp), *windows])
        found = self._run(combs_of_windows, (places,), bounds, progress, rows=rows)
        return [None if comb is None else Comb(*comb) for comb in found]

    def parts(self, s: np.ndarray, d: np.ndarray, spacing: np.ndarray, spans: Sequence[tuple[int, int]],
              progress: Progress) -> list[tuple[np.ndarray, int]]:
        """Of each compound cluster, which begins and ends at rows of the columns, the part of every point, and how many parts there are."""
        rows = np.concatenate([np.empty(0, np.intp), *(np.arange(first, end) for first, end in spans)])
        bounds = np.cumsum([0, *(end - first for first, end in spans)])
        return self._run(parts_of_compounds, (s, d, spacing), bounds, progress, rows=rows, alone=True)

    def shapes(self, records: Columns, bounds: np.ndarray, progress: Progress) -> list[Shape]:
        """The Shape of each cluster; bounds : of the clusters in the records."""
        return self._run(shapes_of_clusters, tuple(records[name] for name in ("s", "d", "spacing")), bounds, progress)

    def _run(self, function: Callable[..., list[Any]], columns: Sequence[np.ndarray], bounds: np.ndarray, progress: Progress,
             rows: np.ndarray | None = None, alone: bool = False) -> list[Any]:
        """Results of all clusters; threads of this process take one after the other, or each `alone`: for the small ones Python is the cost."""
        if len(bounds) < 2:
            return []
        if self.executor.folder is not None:
            cuts = np.unique(np.r_[0, np.searchsorted(bounds, np.arange(TASK_POINTS, bounds[-1], TASK_POINTS)), len(bounds) - 1])
        else:
            cuts = np.arange(len(bounds)) if alone else np.array([0, len(bounds) - 1])
        items = []
        for first, end in zip(cuts[:-1].tolist(), cuts[1:].tolist()):
            some: Any = slice(bounds[first], bounds[end])
            some = some if rows is None else rows[some]
            items.append((*(column[some] for column in columns), bounds[first:end + 1] - bounds[first]))
        phase = Phase(function, NoSource(), (), lambda item: f"markings of road {self.road}")
        return [found for some in self.executor.run(phase, items, progress) for found in some]
