"""What a survey's files hold: points, density, time, scanners, intensity, and whether the trajectory fits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from ..core.common.errors import RoadExtractionError
from ..core.common.progress import Progress
from ..core.common.setting import Limited, setting
from ..core.io.crs import check_projected, crs_note
from ..core.io.geotiff import new_geotiff
from ..core.survey.blocks import sensor_height_of
from ..core.survey.frame.road_frame import build_frame
from ..core.survey.las.point_fields import INTENSITY_SOURCES, ScannerCensus, in_one_scale, intensity_source_of, without_intensity
from ..core.survey.las.reader import read_blocks, read_headers
from ..core.survey.las.samples import coarse_coordinates, distinct_rows, may_overlap, sample_files, without_copies
from ..core.survey.open_survey import match_clocks
from ..core.survey.survey import SurveySettings
from ..core.survey.trajectory.trajectory import Trajectory, clean_trajectory, reproject_trajectory
from ..core.survey.weights import LAS, READING

NEAR_TRAJECTORY = 25.0        # m: points within this distance count as measured from the trajectory
SAMPLING_INTERVAL = 50       # the distance to the trajectory is measured for every 50th point
INTENSITY_VALUES = 65536
MAX_DENSITY_CELLS = 40_000_000  # of the density raster
MAX_COPY_SAMPLES = 500_000      # points among which copies are looked for
COPY_PRIMES = np.array([73856093, 19349663, 83492791])   # mix the numbers of a place, so that neighbours are chosen apart from each other
CELLS_BEFORE = 2**19      # cells either side of the first, in each direction
PROFILE_STEP = 2.0         # m driven between the heights of the profile


@dataclass(frozen=True)
class InspectionSettings(Limited):
    """Edges of the cells that density is counted in, metres."""

    cell_size: float = setting(1.0, 0.05, 100.0, "The density cell", "m")
    cube_size: float = setting(1.0, 0.05, 100.0, "The density cube", "m")


@dataclass
class Inspection:
    """Findings; lengths in metres, times in the clouds' own seconds.

    per_area, per_volume : points per m² and per m³: mean, median and largest over occupied
        cells, and of_a_point, the mean over points of the density of their own cell
    """

    files: list
    crs: str
    count: int
    minimum: np.ndarray
    maximum: np.ndarray
    per_area: dict
    per_volume: dict
    density: tuple   # ((H, W) float32 points per m², row 0 in the north, NaN where empty; (min x, max y) of its corner)
    intensity: np.ndarray   # (65536,) counts of each value
    time_span: tuple
    scanner_field: str
    scanners: list   # LAS field that distinguishes them or None, and its values
    returns: dict
    classes: dict
    settings: InspectionSettings
    near_share: float | None = None   # near_share, in_time_share: share of points measured near and during the trajectory, None without one
    in_time_share: float | None = None
    trajectory: Trajectory | None = None
    drive: _InspectedDrive | None = None   # _InspectedDrive: roads, passes, sensor height, height profile; None without a usable trajectory
    notes: list = field(default_factory=list)


def inspect_survey(paths: Sequence[str | Path], trajectory: Trajectory | None = None,
                   settings: InspectionSettings = InspectionSettings(), crs: str = "", progress: Progress = Progress()) -> Inspection:
    """Read every point of LAS, LAZ or COPC files once and gather statistics.

    The `notes` of the Inspection name what the road map would refuse (a geographic CRS, no overlap, no time, no intensity) and what to try.
    Raises RoadExtractionError if a file is missing, damaged, or all are empty.

    trajectory : in any known CRS and time system, or None
    crs : WKT for clouds that carry none
    """
    copies: list[str] = []
    files = without_copies(read_headers(paths, copies.append, crs), copies.append)
    wkt = next((file.crs for file in files if file.crs), "") or crs
    usable = _usable(trajectory, wkt)
    counter = _Counter(files, settings, usable)
    total, done = sum(file.count for file in files), 0
    for file in files:
        for block in read_blocks(file.path, units=file.units):
            counter.take(block)
            done += len(block)
            progress.report(done / total)
    inspection = counter.inspection(files, wkt, trajectory, progress)
    samples = sample_files(files)
    usual = INTENSITY_SOURCES[0]
    drive = None if usable is None else np.c_[usable.x, usable.y]
    notes = coarse_coordinates(samples)[0], in_one_scale(files, samples, usual, drive)[1], intensity_source_of(samples, usual)[1]
    inspection.notes[:0] = copies + [note for note in notes if note]
    return inspection


def _usable(trajectory, wkt):
    """The trajectory in the CRS of the clouds, or None if it cannot be reprojected."""
    if trajectory is None:
        return None
    try:
        return clean_trajectory(reproject_trajectory(trajectory, wkt))
    except RoadExtractionError:
        return None


class _Counter:
    """Counts block by block; memory grows with the area covered, not with the points."""

    def __init__(self, files, settings, trajectory):
        self.settings = settings
        filled = [file for file in files if file.count]
        self.minimum, self.maximum = np.full(3, np.inf), np.full(3, -np.inf)
        # where cells are counted from; points may lie before it where headers state other bounds
        self.corner = np.floor(np.min([file.minimum for file in filled], axis=0) / settings.cell_size) * settings.cell_size
        self.cells, self.cubes = _Tally(), _Tally()
        self.intensity = np.zeros(INTENSITY_VALUES, np.int64)
        self.census, self.time = ScannerCensus(), [np.inf, -np.inf]
        self.returns, self.classes = np.zeros(256, np.int64), np.zeros(256, np.int64)
        self.count = self.sampled = self.near = 0
        self.trajectory, self.on_track = trajectory, []
        # copies of a point are all in the sample or none is: it is drawn by their places
        self.every = max(sum(file.count for file in filled) // MAX_COPY_SAMPLES, 1) if len(filled) > 1 and may_overlap(filled) else 0
        self.copy_samples = []
        self.tree = None if trajectory is None else cKDTree(np.c_[trajectory.x, trajectory.y])

    def take(self, block):
        x, y, z = (np.asarray(block[name], float) for name in "xyz")
        self.count += len(x)
        if len(x):
            self.minimum, self.maximum = (beyond(extreme, [end(axis) for axis in (x, y, z)])
                                          for beyond, end, extreme in ((np.minimum, np.min, self.minimum), (np.maximum, np.max, self.maximum)))
        cell, cube = self.settings.cell_size, self.settings.cube_size
        column, row = np.floor((x - self.corner[0]) / cell), np.floor((y - self.corner[1]) / cell)
        self.cells.add(_key(column, row))
        self.cubes.add(_key(np.floor((x - self.corner[0]) / cube), np.floor((y - self.corner[1]) / cube),
                            np.floor((z - self.corner[2]) / cube)))
        self.intensity += np.bincount(np.asarray(block["intensity"]), minlength=INTENSITY_VALUES)
        self.returns += np.bincount(np.asarray(block["return_number"]), minlength=256)
        self.classes += np.bincount(np.asarray(block["classification"]), minlength=256)
        names = set(block.point_format.dimension_names)
        time = np.asarray(block["gps_time"], float) if "gps_time" in names else np.zeros(len(x))
        self.time = [min(self.time[0], time.min(initial=np.inf)), max(self.time[1], time.max(initial=-np.inf))]
        for name in ("point_source_id", "scanner_channel"):
            if name in names:
                self.census.add(name, np.asarray(block[name]), time)
        if self.every:
            whole = np.rint(np.stack([x, y, z], axis=1) * LAS.places_per_metre).astype(np.int64)   # mm
            mixed = (whole * COPY_PRIMES).sum(axis=1).astype(np.uint64)
            chosen = (mixed >> np.uint64(17)) % np.uint64(self.every) == 0
            self.copy_samples.append((time[chosen], whole[chosen]))
        if self.tree is not None:
            distance, row = self.tree.query(np.c_[x, y][::SAMPLING_INTERVAL], distance_upper_bound=NEAR_TRAJECTORY)
            below = distance < READING.own_track_half_width
            self.on_track.append((row[below], z[::SAMPLING_INTERVAL][below]))
            self.sampled += len(distance)
            self.near += int(np.isfinite(distance).sum())

    def inspection(self, files, wkt, trajectory, progress):
        scanner_field, scanners = self.census.choose()
        has_time = all(file.has_time for file in files) and self.time[1] > self.time[0]
        inspection = Inspection(
            files, wkt, self.count, self.minimum, self.maximum,
            _density(self.cells.counts, self.settings.cell_size**2), _density(self.cubes.counts, self.settings.cube_size**3),
            self._raster(), self.intensity, tuple(self.time) if has_time else None, scanner_field, scanners,
            _named(self.returns), _named(self.classes), self.settings, trajectory=trajectory)
        if self.sampled:
            inspection.near_share = self.near / self.sampled
        if self.near:
            inspection.drive = _inspect_drive(self.trajectory, *(np.concatenate(parts) for parts in zip(*self.on_track)))
        if self.copy_samples:
            time, xyz = (np.concatenate(column) for column in zip(*self.copy_samples))
            if share := 1 - len(distinct_rows(time, xyz)) / max(len(time), 1):
                inspection.notes.append(f"About {100 * share:.2g} % of the points are copies of points in another file, as where tiles overlap. "
                                        "They are counted here as often as they are there; a road map uses each point once.")
        _judge_crs(inspection)
        if trajectory is not None:
            _judge_trajectory(inspection, wkt, has_time, progress)
        if np.count_nonzero(self.intensity) < 2:
            inspection.notes.append(f"All intensities are {self.intensity.argmax()}: road edges can be found, markings and driving lines cannot. "
                                    f"{without_intensity(files, INTENSITY_SOURCES[0])}".strip())
        if not has_time:
            inspection.notes.append("There is no usable gps_time: each point is assigned to the nearest position on the trajectory, "
                                    "which mixes the passes where a street was driven twice. Export the point clouds with gps_time, or process "
                                    "each drive with its own files.")
        return inspection

    def _raster(self):
        cell = self.settings.cell_size
        column, row = ((self.cells.keys >> bits & 2 * CELLS_BEFORE - 1) - CELLS_BEFORE for bits in (0, 20))
        first, last = row.min(), row.max()
        west, width, height = column.min(), int(np.ptp(column)) + 1, int(last - first) + 1
        corner = (self.corner[0] + west * cell, self.corner[1] + (last + 1) * cell)
        if width * height > MAX_DENSITY_CELLS:
            raise RoadExtractionError(f"A density raster of {width:,} x {height:,} cells of {cell} m would be too large. Choose a larger cell, or "
                                      "inspect fewer files at once.")
        image = np.full((height, width), np.nan, np.float32)
        image[last - row, column - west] = self.cells.counts / cell**2
        return image, corner


class _Tally:
    """Counts of keys, sorted by key."""

    def __init__(self):
        self.keys, self.counts = np.empty(0, np.int64), np.empty(0, np.int64)

    def add(self, keys):
        new, counts = np.unique(keys, return_counts=True)
        self.keys, index = np.unique(np.r_[self.keys, new], return_inverse=True)
        self.counts = np.bincount(index.ravel(), np.r_[self.counts, counts]).astype(np.int64)


def _key(column, row, layer=0):
    """One int64 of up to three cell numbers from -CELLS_BEFORE to below CELLS_BEFORE."""
    part = [np.clip(np.asarray(v) + CELLS_BEFORE, 0, 2 * CELLS_BEFORE - 1).astype(np.int64) for v in (column, row, layer)]
    return (part[2] << 40) | (part[1] << 20) | part[0]


def _density(counts, size):
    """Points per unit: over occupied cells, and of_a_point, the mean over points of their own cell, to which the density per
    neighbourhood of CloudCompare and of the driving-line thesis (figures 4.2 and 4.5) comes close."""
    counts = counts / size
    return dict(cells=len(counts), mean=float(counts.mean()), median=float(np.median(counts)), largest=float(counts.max()),
                of_a_point=float((counts**2).sum() / counts.sum()))


def _named(counts):
    return {int(value): int(counts[value]) for value in np.flatnonzero(counts)}


def _judge_crs(inspection):
    try:
        crs = check_projected(inspection.files, inspection.crs)
        note = crs_note(inspection.files, "", crs) if crs else "The point clouds carry no CRS: set the parameter CRS, so that the results carry one."
        inspection.notes += [note] if note else []
    except RoadExtractionError as problem:
        inspection.notes.append(str(problem))


def _judge_trajectory(inspection, wkt, has_time, progress):
    """Overlap in space and time; what is wrong goes to the notes."""
    try:
        trajectory = clean_trajectory(reproject_trajectory(inspection.trajectory, wkt))
        inspection.notes += [note for note in (*trajectory.notes, *trajectory.doubts) if note not in inspection.notes]
        if has_time:
            trajectory, note, has_time, _ = match_clocks(inspection.files, trajectory, SurveySettings(), progress)
            inspection.notes += [note] if note else []
        inspection.trajectory = trajectory
    except RoadExtractionError as problem:
        inspection.notes.append(str(problem))
        return
    if has_time and trajectory.has_time:
        first, last = inspection.time_span
        shared = min(last, trajectory.time[-1]) - max(first, trajectory.time[0])
        inspection.in_time_share = float(np.clip(shared / (last - first), 0.0, 1.0))
    if not inspection.near_share:
        inspection.notes.append(f"No point lies within {NEAR_TRAJECTORY:.0f} m of the trajectory. Check that both belong to one survey and use one "
                                "CRS.")


@dataclass(frozen=True)
class _InspectedDrive:
    """Findings about a trajectory; metres and seconds."""

    roads: list[float]   # length of each road
    passes: list[tuple]   # rows of (number, road, direction, first station, last station, first time, last time)
    driven: float   # metres driven, without the position noise at standstills
    sensor_height: float | None   # metres from the trajectory down to the road, None where too few points lie on the track
    profile: np.ndarray   # (M, 3) metres driven, map height of the trajectory, map height of the road (NaN where unseen)


def _inspect_drive(trajectory: Trajectory, rows: np.ndarray, heights: np.ndarray) -> _InspectedDrive:
    """Roads, passes and sensor height of a trajectory, cleaned and in the clouds' CRS.

    rows, heights : (N,) of points on the track of the vehicle: the nearest trajectory row and the map height in m
    """
    frame = build_frame(trajectory)
    passes = [(p.number, p.road, p.direction, *(p.span if p.direction > 0 else p.span[::-1]), float(p.time[0]), float(p.time[-1]))
              for p in frame.passes]
    driven = np.r_[0.0, np.cumsum(np.hypot(np.diff(trajectory.x), np.diff(trajectory.y)))]
    drops = trajectory.z[rows] - heights
    height = sensor_height_of(drops)
    profile = _profile(driven, trajectory.z, driven[rows], heights, drops, height)
    return _InspectedDrive([road.length for road in frame.roads], passes,
                          float(sum(abs(last - first) for *_, first, last, _, _ in passes)), height, profile)


def _profile(driven, track_z, at, heights, drops, height):
    """Heights of track and road every PROFILE_STEP of driving."""
    places = np.arange(0.0, driven[-1] + PROFILE_STEP, PROFILE_STEP)
    road = np.full(len(places), np.nan)
    if height is not None:
        near = np.abs(drops - height) < READING.height_peak_reach
        cell = np.rint(at[near] / PROFILE_STEP).astype(np.int64)
        seen = np.unique(cell)
        road[seen] = ndimage.median(heights[near], cell, seen) if len(seen) else np.nan
    return np.c_[places, np.interp(places, driven, track_z), road]


def write_density(inspection: Inspection, path: str | Path) -> None:
    """Write the density of an Inspection to a GeoTIFF: float32 points per m², NaN where no point lies."""
    density, (west, north) = inspection.density
    height, width = density.shape
    cell = inspection.settings.cell_size
    with new_geotiff(path, width, height, (west, cell, 0.0, north, 0.0, -cell), inspection.crs, nodata=np.nan, description="Points per m²") as raster:
        raster.write(0, 0, density)
