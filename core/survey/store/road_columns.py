"""The points of whole roads, read from the sections of a store whenever a column is asked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .columns import Columns
from .section_store import SectionStore


def columns_of_roads(store: SectionStore, roads: Sequence[int], names: Sequence[str] | None = None) -> Columns:
    """The Columns of all points of some roads, each by station.

    A column is there as long as whoever asked for it uses it, and is read again when it is asked for again: of a long road, columns that are
    kept would take as much memory as the points.

    Parameters
    ----------
    store : SectionStore, to which no points are added any more
    roads : numbers
    names : of the columns; all by default
    """
    sections = [(road, number) for road in roads for number in store.sections(road)]
    ends = np.cumsum([0, *(len(store.section(*key)) for key in sections)])

    def load(name):
        whole = np.empty(ends[-1], store.dtype[name])
        for key, first, end in zip(sections, ends[:-1].tolist(), ends[1:].tolist()):
            whole[first:end] = store.section(*key)[name]
        return whole

    def load_rows(name, rows):
        found = np.empty(len(rows), store.dtype[name])
        order = np.argsort(rows, kind="stable")
        ascending = rows.take(order)
        bounds = np.searchsorted(ascending, ends)
        for k in np.flatnonzero(np.diff(bounds)).tolist():
            some = slice(bounds[k], bounds[k + 1])
            found[order[some]] = store.section(*sections[k]).column_rows(name, ascending[some] - ends[k])
        return found

    dtype = store.dtype if names is None else np.dtype([(name, store.dtype[name]) for name in names])
    return Columns({}, dtype, int(ends[-1]), load, load_rows=load_rows, kept=False).read_only()
