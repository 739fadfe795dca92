"""The edges of the road beside painted lines: an edge line keeps its distance from the edge, also where the road widens."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from ..cross_section.sections import sections_of_edges, sections_of_pavement

if TYPE_CHECKING:
    from ...road.edges.road_edges import RoadEdges
    from ..cross_section.sections import CrossSections

LINE_TO_EDGE = 4.0   # m between a line and the edge that it runs along: the widest paved shoulders are 12 ft (AASHTO, Green Book, 4.4.2)
LOOKUP_STRETCH = 50.0   # m of road whose edges are listed together
LEVEL_REACH = 3.0    # m of a line at either side of a gap that say how far it lies from the edge


class EdgesBeside:
    """The edges along one road.

    Parameters
    ----------
    sections : CrossSections of edges
    """

    def __init__(self, sections: list[CrossSections]) -> None:
        self._by_stretch: dict[int, list[tuple[np.ndarray, np.ndarray]]] = {}
        for s, d in chain.from_iterable(map(_edges, sections)):
            for stretch in range(int(s[0] // LOOKUP_STRETCH), int(s[-1] // LOOKUP_STRETCH) + 1):
                self._by_stretch.setdefault(stretch, []).append((s, d))

    def between(self, before: tuple[float, float], after: tuple[float, float]) -> Callable[[np.ndarray], np.ndarray] | None:
        """The nearest edge that leads along both of two places, (station, offset) in m: a function of stations (N,), its offset; None without one."""
        (s0, d0), (s1, d1) = before, after
        best = None
        for s, d in self._by_stretch.get(int(min(s0, s1) // LOOKUP_STRETCH), ()):
            if not s[0] <= min(s0, s1) <= max(s0, s1) <= s[-1]:
                continue
            far = float(np.abs(np.interp([s0, s1], s, d) - (d0, d1)).max())
            if far <= LINE_TO_EDGE and (best is None or far < best[0]):
                best = far, s, d
        return None if best is None else partial(np.interp, xp=best[1], fp=best[2])


def _edges(sections):
    """(stations, offsets) of the edges of CrossSections; where one is interrupted another begins."""
    for k, first in enumerate(sections.d.spans.first.tolist()):
        d = sections.d.row(k)
        known = np.flatnonzero(np.isfinite(d))
        for part in np.split(known, np.flatnonzero(np.diff(known) > 1) + 1):
            if len(part) > 1:
                yield sections.s[first + part], d[part]


def edges_beside(edges: RoadEdges | None, roads: list[int]) -> dict[int, EdgesBeside]:
    """EdgesBeside of every road; those of a road without edges, or where none are known, are empty."""
    kinds = [sections_of_edges(edges), sections_of_pavement(edges)] if edges is not None else []
    return {road: EdgesBeside([found[road] for found in kinds if road in found]) for road in roads}
