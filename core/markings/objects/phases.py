"""What of clustering is computed of some clusters or windows apart from all others: phases, whose items hold the columns that they need."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from ...common.parallel import check_cancelled
from ...common.progress import Progress
from ...execution.phase import Executor, NoSource, Phase
from .figures import Candidate, figures_of_group
from .shape import Shape, drawn_outline, measure
from .split_merge import parts_of_compound
from .zebra import Comb, Crossing, Stripe, comb_of_window, stripes_of_crossing

if TYPE_CHECKING:
    from ...survey.frame.road import Road
    from ...survey.store.columns import Columns

TASK_POINTS = 20_000   # of paint, that a worker process is given together at least: about a tenth of a second of its time
PHASE_POINTS = 500_000   # of paint, whose columns are held for tasks at a time


def combs_of_windows(source: NoSource, item: tuple[np.ndarray, np.ndarray]) -> list[tuple[Any, ...] | None]:
    """The phase that looks for stripes of crossings; item : (N, 2) m spots of windows one after the other, and the bounds of the windows."""
    places, bounds = item
    found = []
    for first, end in zip(bounds[:-1].tolist(), bounds[1:].tolist()):
        check_cancelled()
        comb = comb_of_window(places[first:end])
        found.append(None if comb is None else tuple(comb))
    return found


def stripes_of_crossings(source: NoSource, item: tuple[np.ndarray, np.ndarray, np.ndarray, list[tuple[Any, ...]]]) -> list[list[tuple[Any, ...]]]:
    """The phase that finds the stripes of crossings.

    Parameters
    ----------
    source : NoSource
    item : (N, 2) m spots about crossings one after the other, (N,) radians of the road there, the bounds of the crossings, and the Comb of each
    """
    places, way, bounds, combs = item
    found = []
    for first, end, comb in zip(bounds[:-1].tolist(), bounds[1:].tolist(), combs):
        check_cancelled()
        found.append([tuple(stripe) for stripe in stripes_of_crossing(places[first:end], way[first:end], Comb(*comb))])
    return found


def parts_of_compounds(source: NoSource, item: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]) -> list[tuple[np.ndarray, int]]:
    """The phase that divides compound clusters; item : s, d (0.1 mm), spacing (mm) of the points, and the bounds of the clusters."""
    return [parts_of_compound(*columns) for columns in _clusters(item)]


def shapes_of_clusters(source: NoSource, item: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]) -> list[Shape]:
    """The phase that measures clusters; item : as of `parts_of_compounds`."""
    return [measure(*columns) for columns in _clusters(item)]


def outlines_of_markings(source: NoSource, item: tuple[Any, ...], road: Road) -> tuple[np.ndarray, ...]:
    """The phase that draws markings.

    Parameters
    ----------
    source : NoSource
    item : s, d, x, y, z (0.1 mm), spacing (mm) of the points, the bounds of the markings, and the Shape and whether it is a strip of each
    road : Road

    Returns
    -------
    vertices : (V, 3) local m
    ring_start, polygon_start : (R + 1,), (P + 1,) first vertex of each ring and first ring of each polygon
    count : (M,) polygons of each marking
    """
    *columns, looks = item
    drawn = [drawn_outline(own, shape, strip, road) for own, (shape, strip) in zip(_clusters(columns), looks)]
    polygons = [polygon for some in drawn for polygon in some]
    _, vertices, starts = shapely.to_ragged_array(polygons, include_z=True) if polygons else (None, np.empty((0, 3)), (np.zeros(1, int),) * 2)
    return vertices, *starts, np.array([len(some) for some in drawn])


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
        rows = np.concatenate([np.empty(0, np.int32), *windows])
        found = self._run(combs_of_windows, lambda a, b: (places[rows[bounds[a]:bounds[b]]],), bounds, progress)
        return [None if comb is None else Comb(*comb) for comb in found]

    def stripes(self, places: np.ndarray, way: np.ndarray, crossings: Sequence[Crossing], progress: Progress) -> list[list[Stripe]]:
        """The stripes of each crossing, their spots by number among those of the crossing; places, way : as of `zebra_stripes`."""
        bounds = np.cumsum([0, *(len(own) for own, _ in crossings)])
        rows = np.concatenate([np.empty(0, np.intp), *(own for own, _ in crossings)])
        found = self._run(stripes_of_crossings, lambda a, b: tuple(values[rows[bounds[a]:bounds[b]]] for values in (places, way)), bounds, progress,
                          alone=True, looks=[tuple(comb) for _, comb in crossings])
        return [[Stripe(*stripe) for stripe in some] for some in found]

    def parts(self, s: np.ndarray, d: np.ndarray, spacing: np.ndarray, spans: Sequence[tuple[int, int]],
              progress: Progress) -> list[tuple[np.ndarray, int]]:
        """Of each compound cluster, which begins and ends at rows of the columns, the part of every point, and how many parts there are."""
        rows = np.concatenate([np.empty(0, np.intp), *(np.arange(first, end) for first, end in spans)])
        bounds = np.cumsum([0, *(end - first for first, end in spans)])
        return self._run(parts_of_compounds, lambda a, b: tuple(column[rows[bounds[a]:bounds[b]]] for column in (s, d, spacing)), bounds, progress,
                         alone=True)

    def shapes(self, records: Columns, bounds: np.ndarray, progress: Progress) -> list[Shape]:
        """The Shape of each cluster; bounds : of the clusters in the records."""
        def columns(a, b):
            return _columns_at(records, np.arange(bounds[a], bounds[b]), ("s", "d", "spacing"))

        return self._run(shapes_of_clusters, columns, bounds, progress)

    def outlines(self, records: Columns, rows: Sequence[np.ndarray], looks: Sequence[tuple[Shape, bool]], road: Road,
                 progress: Progress) -> list[list[Any]]:
        """The polygons of each marking, of `drawn_outline`; rows : in the records, of each; looks : the Shape of each and whether it is a strip."""
        def columns(a, b):
            return _columns_at(records, np.concatenate(rows[a:b]), ("s", "d", "x", "y", "z", "spacing"))

        return self._run(outlines_of_markings, columns, np.cumsum([0, *map(len, rows)]), progress, looks=looks, arguments=(road,), read=_polygons)

    def figures(self, groups: list[list[Candidate]], begin: float, end: float, progress: Progress) -> Iterator[list[tuple[int, str]]]:
        """What `figures_of_group` finds in each group; they are the work from a fraction `begin` of the progress to `end`."""
        phase = Phase(figures_of_group, NoSource(), (), lambda item: f"markings of road {self.road}")
        return self.executor.run(phase, groups, progress.part(begin, end))

    def _run(self, function: Callable[..., Any], columns: Callable[[int, int], tuple[np.ndarray, ...]], bounds: np.ndarray, progress: Progress,
             alone: bool = False, looks: Sequence[Any] | None = None, arguments: tuple[Any, ...] = (),
             read: Callable[[Any], list[Any]] = list) -> list[Any]:
        """Results of all clusters; threads of this process take one after the other, or each `alone`: for the small ones Python is the cost.

        `columns` gives those of the clusters from a number to before another, one after the other: PHASE_POINTS are there at a time.
        """
        phase = Phase(function, NoSource(), arguments, lambda item: f"markings of road {self.road}")
        whole, found = _cuts(bounds, PHASE_POINTS), []
        for begin, end in zip(whole[:-1].tolist(), whole[1:].tolist()):
            own = bounds[begin:end + 1]
            if self.executor.folder is not None:
                cuts = _cuts(own, TASK_POINTS)
            else:
                cuts = np.arange(len(own)) if alone else np.array([0, len(own) - 1])
            here = columns(begin, end)
            items = [_item(here, own[a:b + 1] - own[0], None if looks is None else list(looks[begin + a:begin + b]))
                     for a, b in zip(cuts[:-1].tolist(), cuts[1:].tolist())]
            part = progress.part(begin / whole[-1], end / whole[-1])
            found += [one for some in self.executor.run(phase, items, part) for one in read(some)]
        return found


def _cuts(bounds, points):
    """Ascending numbers of clusters, from the first to the end, with so many points between two of them at least."""
    total = bounds[-1] - bounds[0]
    return np.unique(np.r_[0, np.searchsorted(bounds - bounds[0], np.arange(points, total, points)), len(bounds) - 1])


def _columns_at(records, rows, names):
    """Some columns of some rows."""
    some = records.take(rows)
    return tuple(some[name] for name in names)


def _item(columns, bounds, looks):
    """What a phase needs of some clusters, whose bounds in the columns are given."""
    return (*(column[bounds[0]:bounds[-1]] for column in columns), bounds - bounds[0], *([] if looks is None else [looks]))


def _polygons(found):
    """[[Polygon]] of each marking, from what `outlines_of_markings` gives."""
    vertices, ring_start, polygon_start, count = found
    ends = np.cumsum(count).tolist()
    polygons = shapely.from_ragged_array(shapely.GeometryType.POLYGON, vertices, (ring_start, polygon_start)).tolist()
    return [polygons[end - some:end] for end, some in zip(ends, count.tolist())]
