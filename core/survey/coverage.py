"""Whether a road was measured under the vehicle all along its way: by points there, and at its height."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .frame.road_frame import RoadFrame
from .store.records import COORDINATE_SCALE, to_units
from .weights import READING


class Coverage:
    """Counts of the points on the vehicle's own track, by pass and cell of station; independent of the order of adding.

    counts : {pass number: (3, C) int64} of the points near the height of the road, of those far above or below it, and the sum of the depths of the
        latter below the trajectory, units of 0.1 mm
    """

    def __init__(self, frame: RoadFrame):
        ends = {p.number: to_units(np.array(p.span)) >> READING.coverage_cell_bits for p in frame.passes}
        self._first = {number: int(first) for number, (first, _) in ends.items()}
        self.counts = {number: np.zeros((3, int(last - first) + 1), np.int64) for number, (first, last) in ends.items()}

    def add(self, number: int, s: np.ndarray, drops: np.ndarray, near: bool) -> None:
        """Count points of a pass, near the height of the road or not: (N,) int32 stations and depths below the trajectory, units of 0.1 mm."""
        counts = self.counts[number]
        cell = np.clip((s >> READING.coverage_cell_bits) - self._first[number], 0, counts.shape[1] - 1)
        counts[0 if near else 1] += np.bincount(cell, minlength=counts.shape[1])
        if not near:
            np.add.at(counts[2], cell, drops)

    def join(self, counts: dict[int, np.ndarray]) -> None:
        """Add the counts of other points."""
        for number, counted in counts.items():
            self.counts[number] += counted

    def warnings(self, frame: RoadFrame, heights: dict[int, float]) -> list[str]:
        """What to tell of stretches that were driven and show no road; `heights` as of `SurveyReader`."""
        elsewhere: list[tuple[int, float, float]] = []
        holes: list[tuple[int, float, float]] = []
        above: list[float] = []
        for road in frame.roads:
            first, driven, (near, far, depths) = self._of_road(frame, road.number)
            other = driven & (far > READING.min_track_points) & (near < READING.least_near_share * far)
            height = np.mean([heights[p.number] for p in frame.passes_of(road.number)])
            above += (height - COORDINATE_SCALE * depths[other] / far[other]).tolist()
            elsewhere += [(road.number, *ends) for ends in _runs(other, first)]
            seen = np.flatnonzero(near)
            hole = driven & (near == 0) & ~other
            hole[:seen.min(initial=len(hole))] = hole[seen.max(initial=0):] = False
            # two surveys along one trajectory have more between them than a file that is missing
            if hole.sum() < len(seen):
                holes += [(road.number, *ends) for ends in _runs(hole, first) if ends[1] - ends[0] > READING.least_hole]
        return [*_said_of_heights(elsewhere, above), *_said_of_holes(holes)]

    def _of_road(self, frame, road):
        """(first cell, (C,) bool of the cells that a pass drove through, (3, C) counts of its passes together)."""
        passes = frame.passes_of(road)
        first = min(self._first[p.number] for p in passes)
        length = max(self._first[p.number] - first + self.counts[p.number].shape[1] for p in passes)
        driven, total = np.zeros(length, bool), np.zeros((3, length), np.int64)
        for p in passes:
            at, counts = self._first[p.number] - first, self.counts[p.number]
            total[:, at:at + counts.shape[1]] += counts
            driven[at + 1:at + counts.shape[1] - 1] = True
        return first, driven, total


def _runs(chosen: np.ndarray, first: int) -> Iterator[tuple[float, float]]:
    """(start, end) m of the runs of (C,) chosen cells, of which the first has a number."""
    ends = np.flatnonzero(np.diff(np.r_[False, chosen, False].astype(np.int8)))
    stations = COORDINATE_SCALE * (first + ends << READING.coverage_cell_bits)
    return ((start, end) for start, end in stations.reshape(-1, 2).tolist())


def _named(stretches):
    longest = sorted(stretches, key=lambda stretch: stretch[1] - stretch[2])[:READING.told_stretches]
    places = "; ".join(f"road {road}, station {start:.0f} to {end:.0f} m" for road, start, end in longest)
    return f"{sum(end - start for _, start, end in stretches):.0f} m of the drive ({places}{'; …' if len(stretches) > len(longest) else ''})"


def _said_of_heights(stretches, above):
    if stretches:
        metres = float(np.median(above))
        yield (f"Along {_named(stretches)} what was measured under the vehicle lies about {abs(metres):.0f} m {'above' if metres > 0 else 'below'} "
               "the road elsewhere; it was left out, and the map lacks it. Files or drives seem to have heights of two kinds (above the ellipsoid "
               "and above sea level). Export all with one kind of heights, and run again.")


def _said_of_holes(stretches):
    if stretches:
        yield (f"No point was kept under the vehicle along {_named(stretches)}, though there are some before and behind. A file may be missing, or "
               "its points are withheld or without time. The map is bridged or broken off there: give all files, and run again.")
