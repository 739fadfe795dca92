"""The beams of a spinning scanner, separated by their elevation angle, and brought to one brightness.

Each laser of such a scanner has its own gain and threshold, so that asphalt looks like a pattern of bright and dark arcs. Relative to the scanner a
laser always points at the same elevation: its points form a ring, and the asphalt of each ring shows how bright the laser makes asphalt.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter1d

from ..common.parallel import ordered_map
from ..common.progress import Progress
from ..execution.phase import Phase
from ..survey.frame.road_frame import Pass, RoadFrame
from ..survey.store.columns import Columns
from ..survey.store.records import Points
from ..survey.store.road_points import RoadPoints
from ..survey.store.section_store import Stretch
from .asphalt_model import INTENSITY_LEVELS, asphalt_of_histograms, is_logarithmic, to_level, weighted_median
from .weights import ASPHALT, BEAMS

ELEVATION_BINS = round(-BEAMS.lowest_elevation / BEAMS.elevation_bin)
SOURCE_IDS = 2**16      # source: LAS 1.4, numbers that point_source_id may have
SAMPLE_COLUMNS = "time", "x", "y", "z", "source", "pass_number"   # needed for the elevation seen from the vehicle
ANGLE_SIGNS = ((0, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))  # sign conventions of roll and pitch that are tried; 0 ignores them


def _middles_of_turns(road_points, samples):
    """(65536,) s, the time in the middle of each turn of a spinning scanner, numbered in point_source_id; NaN where the number is no turn.

    samples : [Points] from all over the road: where each number occurs for longer than a turn in them, there are no turns
    """
    middle = np.full(SOURCE_IDS, np.nan)
    first, last = _occurrences(samples)
    if not (last - first < BEAMS.max_turn_time)[np.isfinite(first)].any():
        return middle
    first, last = _occurrences(road_points.section(*key) for key in road_points.all_sections())
    number = np.flatnonzero(np.isfinite(first))
    number = number[np.argsort(first[number], kind="stable")]
    begin, end = first[number], last[number]
    # not every turn begins and ends over the road: two consecutive turns share the time between them
    follows = begin[1:] - end[:-1] < BEAMS.max_turn_time / 2
    between = (end[:-1] + begin[1:]) / 2
    begin[1:][follows], end[:-1][follows] = between[follows], between[follows]
    # a turn without a predecessor or a successor is as long as the others
    turn = np.r_[False, follows] & np.r_[follows, False]
    if turn.any():
        length = float(np.median((end - begin)[turn]))
        begin = np.where(np.r_[False, follows] | ~np.r_[follows, False], begin, end - length)
        end = np.where(np.r_[follows, False] | ~np.r_[False, follows], end, begin + length)
    turn = (end - begin < BEAMS.max_turn_time) & (end > begin)
    middle[number[turn]] = (begin[turn] + end[turn]) / 2
    return middle


def _occurrences(parts):
    """(65536,) s, when each point_source_id occurs first and last among Points; infinite where it does not."""
    first, last = np.full(SOURCE_IDS, np.inf), np.full(SOURCE_IDS, -np.inf)
    for points in parts:
        if len(points):
            order = np.argsort(points.source, kind="stable")
            source, time = points.source[order], points.time[order]
            begins = np.flatnonzero(np.r_[True, source[1:] != source[:-1]])
            number = source[begins]
            first[number] = np.minimum(first[number], np.minimum.reduceat(time, begins))
            last[number] = np.maximum(last[number], np.maximum.reduceat(time, begins))
    return first, last


@dataclass
class _ElevationModel:
    """How the elevation of a point seen from the scanner is computed."""

    passes: Sequence[Pass]   # of the road frame
    turns: np.ndarray   # of `_middles_of_turns`
    by_turn: bool = False   # at the middle of the point's turn, to which its whole turn was moved; else at the point's own time
    signs: tuple[int, int] = (0, 0)   # of roll and pitch

    def elevation_bin(self, points: Points) -> np.ndarray:
        """(N,) int, the bin of elevation; -1 where no pass drove at the point's time."""
        bins = np.full(len(points), -1)
        for rows, geometry in self.geometries(points):
            bins[rows] = geometry.elevation_bin(self.signs)
        return bins

    def geometries(self, points: Points) -> Iterator[tuple[np.ndarray, _BeamGeometry]]:
        """Yield (indices, _BeamGeometry) of the points of each pass, the same for all signs."""
        time, number = points.time, points.pass_number
        if self.by_turn:
            middle = self.turns[points.source]
            time = np.where(np.isfinite(middle), middle, time)
        for p in self.passes:
            rows = np.flatnonzero((number == p.number) & (time >= p.time[0] - ASPHALT.pass_margin) & (time <= p.time[-1] + ASPHALT.pass_margin))
            if len(rows):
                yield rows, _BeamGeometry.of(p, points[rows], time[rows])


@dataclass(frozen=True)
class _BeamGeometry:
    """Where points lie relative to the vehicle."""

    reach: np.ndarray   # reach, rise: (N,) m, horizontally and up
    rise: np.ndarray
    by_roll: np.ndarray | float   # by_roll, by_pitch: (N,) m that roll and pitch raise them by, 0 where the attitude is unknown
    by_pitch: np.ndarray | float

    @classmethod
    def of(cls, p: Pass, points: Points, time: np.ndarray) -> _BeamGeometry:
        """Geometry of (N) points of a pass, each seen from where the vehicle was at a time, (N,) s."""
        px, py, pz = p.position(time)
        dx, dy = points.x - px, points.y - py
        by_roll: np.ndarray | float = 0.0
        by_pitch: np.ndarray | float = 0.0
        if p.attitude is not None:
            roll, pitch, heading = (np.interp(time, p.time, angle) for angle in p.attitude)
            c, n = np.cos(heading), np.sin(heading)
            by_roll, by_pitch = roll * (dx * c - dy * n), pitch * (dx * n + dy * c)
        return cls(np.hypot(dx, dy), points.z - pz, by_roll, by_pitch)

    def elevation_bin(self, signs: tuple[int, int]) -> np.ndarray:
        """(N,) int; `signs` are those of roll and pitch."""
        elevation = np.degrees(np.arctan2(self.rise + signs[0] * self.by_roll + signs[1] * self.by_pitch, self.reach))
        return np.clip(np.floor((elevation - BEAMS.lowest_elevation) / BEAMS.elevation_bin), -1, ELEVATION_BINS - 1).astype(int)


@dataclass
class Beams:
    """Beams of the scanners that have several."""

    models: dict[int, _ElevationModel]   # _ElevationModel by scanner
    beam: dict[int, np.ndarray]   # by scanner (ELEVATION_BINS,) number of the beam at each elevation
    corrections: dict[int, np.ndarray]   # by scanner (beams,) summands or factors of a beam's intensities
    added: dict[int, bool]   # by scanner, whether the correction is added

    @classmethod
    def of(cls, road_points: RoadPoints, frame: RoadFrame, scanners: int, progress: Progress = Progress()) -> Beams | None:
        """Beams of a survey's scanners, numbered below `scanners`; None where every scanner has one, or all of one brightness."""
        samples = _samples(road_points, frame, scanners)
        if not samples:
            return None
        turns = _middles_of_turns(road_points, [points for beams in samples.values() for points in beams])
        models = {scanner: model for scanner, beams in samples.items() if (model := _sharpest(beams, frame.passes, turns)) is not None}
        if not models:
            return None
        beams = cls(models, {}, {}, {})
        for scanner, levels in zip(models, _levels(road_points, models, progress)):
            beams._estimate(scanner, levels)
        return beams if beams.corrections else None

    def _estimate(self, scanner, levels):
        """Corrections that bring each beam's asphalt to the level of all, from (ELEVATION_BINS, INTENSITY_LEVELS) counts."""
        smooth = gaussian_filter1d(levels.sum(axis=1).astype(float), 1.0)
        valleys = np.flatnonzero((smooth[1:-1] <= smooth[:-2]) & (smooth[1:-1] < smooth[2:])) + 1
        starts = np.r_[0, valleys]
        median, lower = asphalt_of_histograms(np.add.reduceat(levels, starts, axis=0))
        weight = np.add.reduceat(levels.sum(axis=1), starts)
        usable = np.flatnonzero(np.isfinite(median) & (median > 0))
        if len(usable) < 2 * BEAMS.neighbour_beams:
            return
        reference = weighted_median(median[usable], weight[usable])
        padded = np.pad(median[usable], BEAMS.neighbour_beams, mode="edge")
        neighbours = np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * BEAMS.neighbour_beams + 1), axis=1)
        if weighted_median(np.abs(median[usable] - neighbours), weight[usable]) < BEAMS.unequal_beams * reference:
            return
        # a beam with few points on the road is interpolated between its neighbours
        median = np.interp(np.arange(len(median)), usable, median[usable])
        self.beam[scanner] = np.searchsorted(starts, np.arange(ELEVATION_BINS), side="right") - 1
        self.added[scanner] = is_logarithmic(median[usable], lower[usable], weight[usable])
        self.corrections[scanner] = reference - median if self.added[scanner] else reference / median

    def equalised(self, points: Points) -> np.ndarray:
        """(N,) float intensity as if all beams were alike."""
        value = points.intensity.astype(float)
        for scanner, corrections in self.corrections.items():
            rows = np.flatnonzero(points.scanner == scanner)
            bins = self.models[scanner].elevation_bin(points[rows])
            rows, bins = rows[bins >= 0], bins[bins >= 0]
            correction = corrections[self.beam[scanner][bins]]
            value[rows] = np.maximum(value[rows] + correction, 0.0) if self.added[scanner] else value[rows] * correction
        return value


def _levels(road_points, models, progress):
    """(scanners with beams, ELEVATION_BINS, INTENSITY_LEVELS) how many points have each level at each elevation."""
    counts = np.zeros((len(models), ELEVATION_BINS * INTENSITY_LEVELS), np.int64)
    phase = phase_of_stretches(_levels_at_elevations, road_points, (models,))
    for of_stretch in road_points.executor.run(phase, road_points.stretches(), progress):
        for of_scanner, (place, number) in zip(counts, of_stretch):
            of_scanner[place] += number
    return counts.reshape(len(models), ELEVATION_BINS, INTENSITY_LEVELS)


def phase_of_stretches(function: Callable[..., Any], road_points: RoadPoints, arguments: tuple[Any, ...], source: RoadPoints | None = None) -> Phase:
    """The phase, a function of stretches of the road points, that reads from these or from a `source`."""
    length = road_points.store.section_length
    return Phase(function, road_points if source is None else source, arguments, state=road_points.store.state,
                 place=lambda item: road_points.survey.stretch(item[0], item[1] * length, item[2] * length))


def _levels_at_elevations(road_points: RoadPoints, stretch: Stretch, models: dict[int, _ElevationModel]) -> list[tuple[np.ndarray, np.ndarray]]:
    """The phase that counts levels of intensity by elevation.

    Returns of each scanner the places that are not empty in a flattened table (ELEVATION_BINS, INTENSITY_LEVELS), (K,) int, and (K,) points there.
    """
    places: list[list[np.ndarray]] = [[np.empty(0, int)] for _ in models]
    for key in road_points.store.in_stretch(stretch):
        points = road_points.section(*key)
        for of_scanner, (scanner, model) in zip(places, models.items()):
            rows = np.flatnonzero(points.scanner == scanner)
            bins = model.elevation_bin(points[rows])
            valid = bins >= 0
            of_scanner.append(bins[valid] * INTENSITY_LEVELS + to_level(points.intensity[rows][valid]))
    counts = [np.bincount(np.concatenate(of_scanner)) for of_scanner in places]
    return [(np.flatnonzero(number), number[number > 0]) for number in counts]


def _samples(road_points: RoadPoints, frame: RoadFrame, scanners: int) -> dict[int, list[Points]]:
    """{scanner: [Points]} of a few windows of each road, at the same stations however the sections are cut; scanners without are left out."""
    places = []
    for road in road_points.roads():
        start, end = frame.road(road).start, frame.road(road).end
        places += [(road, s) for s in np.linspace(start, max(end - BEAMS.sample_window, start), BEAMS.sample_windows)]
    samples: dict[int, list[Points]] = {}
    for window_samples in ordered_map(lambda place: _samples_of_window(road_points, *place, scanners), places):
        for scanner, points in window_samples:
            samples.setdefault(scanner, []).append(points)
    return {scanner: samples[scanner] for scanner in sorted(samples)}


def _samples_of_window(road_points, road, s, scanners):
    """[(scanner, Points)] of the window that begins at station s."""
    points, result = road_points.window(road, s, s + BEAMS.sample_window), []
    scanner_of_point = points.scanner
    for scanner in range(scanners):
        rows = np.flatnonzero(scanner_of_point == scanner)
        if len(rows) >= ASPHALT.min_asphalt_points:
            records = points[rows[::-(-len(rows) // BEAMS.max_sample_points)]].records
            # copies of the columns, so that the memory of the sections is freed
            columns = Columns({name: records[name] for name in SAMPLE_COLUMNS}, np.dtype([(name, records.dtype[name]) for name in SAMPLE_COLUMNS]))
            result.append((scanner, Points(columns)))
    return result


def _sharpest(samples: list[Points], passes: Sequence[Pass], turns: np.ndarray) -> _ElevationModel | None:
    """The _ElevationModel in which points form the clearest rings; None where they do in none."""
    all_signs = ANGLE_SIGNS if any(p.attitude is not None for p in passes) else ANGLE_SIGNS[:1]
    best, sharpest = BEAMS.min_sharpness, None
    for by_turn in (False, True) if np.isfinite(turns).any() else (False,):
        model = _ElevationModel(passes, turns, by_turn)
        geometries = [geometry for points in samples for _, geometry in model.geometries(points)]
        for signs in all_signs:
            places = (geometry.elevation_bin(signs) for geometry in geometries)
            value = sharpness(sum((np.bincount(place[place >= 0], minlength=ELEVATION_BINS) for place in places), np.zeros(ELEVATION_BINS)))
            if value > best:
                best, sharpest = value, replace(model, signs=signs)
    return sharpest


def sharpness(counts: np.ndarray) -> float:
    """How much fuller the elevation bin of a point is, on average, than the mean of a degree around it: 1 for an even distribution.

    counts : (ELEVATION_BINS,) float, points at each elevation
    """
    total = counts.sum()
    if total < ELEVATION_BINS:
        return 0.0
    # a point does not count as its own neighbour
    return float((counts * (counts - 1)).sum() / max((counts * gaussian_filter1d(counts, 0.5 / BEAMS.elevation_bin)).sum(), 1e-9))
