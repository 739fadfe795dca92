"""Whether the road was measured under the vehicle all along its way, at one height below the trajectory."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ..common.arrays import mask_runs
from .frame.road_frame import RoadFrame
from .store.records import COORDINATE_SCALE, to_units
from .weights import READING

CountedCells = tuple[int, int, np.ndarray]   # number of a pass, its first cell that has points, and the counts from there on


class Coverage:
    """Counts of the points on the vehicle's own track, by pass, cell of station and depth below the trajectory.

    They do not depend on the order of adding. about : m, first estimate of the height of the trajectory above the road
    """

    def __init__(self, frame: RoadFrame, about: float):
        self.frame, self._about = frame, float(to_units(np.array([about]))[0])
        self._ends = {p.number: (to_units(np.array(p.span)) >> READING.coverage_cell_bits).tolist() for p in frame.passes}
        # the last two columns are for points beyond all bins: their number, and the sum of their depths in units of 0.1 mm
        self._counts: dict[int, np.ndarray] = {}

    def add(self, number: int, s: np.ndarray, drops: np.ndarray) -> None:
        """Count points of a pass: (N,) int32 stations and depths below the trajectory, units of 0.1 mm."""
        first, last = self._ends[number]
        cell = np.clip((s >> READING.coverage_cell_bits) - first, 0, last - first)
        low, bins = int(cell.min()), READING.coverage_bins
        cell -= low
        k = np.floor((drops - self._about) * (COORDINATE_SCALE / READING.coverage_step)).astype(np.int64) + bins // 2
        far = (k < 0) | (k >= bins)
        k[far] = bins
        rows = int(cell.max()) + 1
        counted = np.bincount(cell * (bins + 2) + k, minlength=rows * (bins + 2)).reshape(rows, bins + 2)
        np.add.at(counted[:, -1], cell[far], drops[far])
        self._of(number)[low:low + rows] += counted

    def _of(self, number):
        if number not in self._counts:
            first, last = self._ends[number]
            self._counts[number] = np.zeros((last - first + 1, READING.coverage_bins + 2), np.int64)
        return self._counts[number]

    def counted(self) -> list[CountedCells]:
        """The counts, to be sent elsewhere."""
        cells = {number: np.flatnonzero(counts.any(axis=1)) for number, counts in self._counts.items()}
        return [(number, int(rows[0]), self._counts[number][rows[0]:rows[-1] + 1].copy()) for number, rows in cells.items() if len(rows)]

    def join(self, others: Iterable[CountedCells]) -> None:
        """Add the counts of other points."""
        for number, first, counts in others:
            self._of(number)[first:first + len(counts)] += counts

    def warnings(self) -> tuple[str, str]:
        """What to tell of stretches that were driven and show a road at another height, and of those that show none; "" for nothing."""
        moved: list[tuple[int, float, float]] = []
        holes: list[tuple[int, float, float]] = []
        metres: list[float] = []
        for road in self.frame.roads:
            passes = self.frame.passes_of(road.number)
            first = min(self._ends[p.number][0] for p in passes)
            driven, seen = np.zeros((2, max(self._ends[p.number][1] for p in passes) - first + 1), bool)
            for p in passes:
                at, counts = self._ends[p.number][0] - first, self._of(p.number)
                higher = self._levels(counts.sum(axis=0, keepdims=True)) - self._levels(counts)
                for start, end in _runs(np.abs(higher) > READING.other_level, first + at, READING.least_moved):
                    moved.append((road.number, *_stations(start, end)))
                    metres += higher[start - first - at:end - first - at].tolist()
                seen[at:at + len(counts)] |= counts[:, :-2].any(axis=1) | np.isfinite(higher)
                driven[at + 1:at + len(counts) - 1] = True
            where = np.flatnonzero(seen)
            hole = driven & ~seen
            hole[:where.min(initial=len(hole))] = hole[where.max(initial=0):] = False
            # two surveys along one trajectory have more between them than a file that is missing
            if hole.sum() < len(where):
                holes += [(road.number, *_stations(start, end)) for start, end in _runs(hole, first, READING.least_hole)]
        return (f"The trajectory does not keep to one height above the road: along {_named(moved)} the road lies {np.median(metres):+.2g} m from its "
                "usual height. Heights may be in feet in one file, or of two kinds: export all from one solution." if moved else "",
                f"No point was kept under the vehicle along {_named(holes)} of the drive, though there are some before and behind. Give all files: "
                "one may be missing." if holes else "")

    def _levels(self, counts):
        """m down from the trajectory, less `about`, to where most points of cells lie, of (C, bins + 2) counts; NaN for too few points."""
        near, far = counts[:, :-2], counts[:, -2]
        padded = np.pad(near, ((0, 0), (1, 1)))
        windows = np.stack([padded[:, k:k + near.shape[1]] for k in range(3)])   # each bin with its neighbours
        peak, rows = windows.sum(axis=0).argmax(axis=1), np.arange(len(counts))
        weights = windows[:, rows, peak]
        level = (peak + (weights[2] - weights[0]) / np.maximum(weights.sum(axis=0), 1) + 0.5 - near.shape[1] // 2) * READING.coverage_step
        beyond = near.sum(axis=1) < READING.least_near_share * far
        level[beyond] = COORDINATE_SCALE * (counts[beyond, -1] / far[beyond] - self._about)
        return np.where(counts[:, :-1].sum(axis=1) > READING.min_track_points, level, np.nan)


def _runs(chosen: np.ndarray, first: int, least: float) -> Iterator[tuple[int, int]]:
    """(first, last + 1) of the runs of (C,) chosen cells that are longer than so many metres; `first` is the number of the first cell."""
    return ((first + a, first + b) for a, b in mask_runs(chosen) if np.subtract(*_stations(b, a)) > least)


def _stations(*cells):
    """m of the starts of cells."""
    return tuple(COORDINATE_SCALE * (cell << READING.coverage_cell_bits) for cell in cells)


def _named(stretches):
    longest = sorted(stretches, key=lambda stretch: stretch[1] - stretch[2])[:READING.told_stretches]
    places = "; ".join(f"road {road}, station {start:.0f} to {end:.0f} m" for road, start, end in longest)
    return f"{sum(end - start for _, start, end in stretches):.0f} m ({places}{'; …' if len(stretches) > len(longest) else ''})"
