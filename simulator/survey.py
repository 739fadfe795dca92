"""A simulated mobile laser scanning survey with known truth, for the demo, the tests and for trying settings.

The street, the vehicle and the scanners are simulated: every pulse of two rotating line scanners is traced to the first
object it meets. Accuracy measured on such a survey is accuracy on simulated data.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from datetime import date, datetime, timedelta

import numpy as np

from ..core.common.errors import RoadExtractionError
from ..core.common.progress import Progress
from ..core.common.setting import check_limits, setting
from ..core.survey.trajectory.trajectory import Trajectory
from .camera import camera_over
from .parts.materials import LABEL
from .parts.scanner import OBSTACLE, Scanner, brightness_of, butterfly, cast, label_hits, received
from .parts.scene import Followed
from .parts.vehicle import Drive
from .scenes import AnyScene, build_scene, length_of
from .streets.street import Scene

_SURVEY_DAY = datetime(2025, 5, 14, 2, 30)
# Adjusted standard GPS time: seconds since 1980-01-06, leap seconds (18) not taken out, minus 1e9.
_START_TIME = (_SURVEY_DAY - datetime(1980, 1, 6)) / timedelta(seconds=1) + 18.0 - 1e9
_PAUSE = 55.0        # s between two passes
_PULSES = 50_000     # in a block
_RANGE_NOISE = 0.005  # m, standard deviation
_VERGE_NOISE = 0.02  # m, standard deviation of the height of grass
_LOST, _STRAY = 0.004, 0.00015  # of the pulses: without a return, and with a wrong range
_WEAK_SIGNAL = 150.0  # counts: at 0 half of the pulses are lost, at each such step half as many
_SPECKLE, _COUNT_NOISE = 0.07, 25.0  # standard deviation of the intensity: share of it, and counts
_LAS_ANGLE = 0.006    # degrees, unit of the scan angle in LAS 1.4

SAMPLE_POINT = np.dtype([("x", "f8"), ("y", "f8"), ("z", "f8"), ("time", "f8"), ("intensity", "u2"), ("scanner", "u1"),
                  ("scan_angle", "f4"), ("label", "u1"), ("pass", "u1"), ("range", "f4"), ("station", "f8"), ("offset", "f8")])


@dataclass(frozen=True)
class SampleSettings:
    """What is surveyed, and how densely.

    mount_yaw : degrees, rotation of the planes of the scanners from straight across, one either way
    """

    scene: str = "street"   # one of SCENES
    length: float = setting(0.0, 0.0, 20000.0, "Sample survey: length", "m")   # m of road; 0 becomes the usual length of the scene
    seed: int = setting(1, 0, 2**31 - 1, "Sample survey: seed")   # of all random numbers
    speed_kmh: float = setting(50.0, 5.0, 120.0, "Sample survey: speed", "km/h")   # km/h, of the vehicle
    pulse_rate: float = setting(300_000.0, 5000.0, 2000000.0, "Sample survey: pulse rate", "Hz")   # Hz, pulses per second of each scanner
    rotation_rate: float = setting(200.0, 10.0, 400.0, "Sample survey: rotation rate", "Hz")   # Hz, scan lines per second of each scanner
    mount_yaw: float = setting(45.0, 0.0, 60.0, "Sample survey: mount yaw", "°")
    radius: float = setting(120.0, 60.0, 5000.0, "Sample survey: radius", "m")   # m, of the bends
    curb_height: float = setting(0.13, 0.04, 0.3, "Sample survey: curb height", "m")   # m
    gutter: float = setting(0.0, 0.0, 1.0, "Sample survey: gutter", "m")   # m, width of a concrete gutter along the curbs
    reach: float = setting(18.0, 12.0, 24.0, "Sample survey: reach", "m")   # m; points farther from the axis of the road are left out
    crs: str = "EPSG:32650"   # of the map
    origin: tuple[float, float, float] = (610400.0, 2710200.0, 20.0)   # map coordinates of the beginning of the road, whole metres

    def __post_init__(self):
        check_limits(self)
        object.__setattr__(self, "length", length_of(self.scene, self.length))


def make_sample_survey(settings: SampleSettings | None = None, progress: Progress | None = None) -> SampleSurvey:
    """Simulate a street and its truth, points on demand; RoadExtractionError if the CRS is not recognised, is geographic or not in metres."""
    from ..core.io.crs import as_in_file, check_metric, parse_crs

    settings = settings or SampleSettings()
    crs = parse_crs(as_in_file(settings.crs)[0])   # a survey is made in metres
    if crs is not None:
        check_metric(crs, "The sample survey")
    return SampleSurvey(settings, "" if crs is None else crs.to_wkt("WKT1_GDAL"), progress or Progress())


class SampleSurvey:
    """The simulated survey.

    crs : WKT
    scene : Scene, in local coordinates (map minus settings.origin)
    camera : Camera of the UAV image, in local coordinates; None where there is no single axis
    scanners, drives : lists of Scanner and Drive
    trajectory : Trajectory of all passes at 200 Hz, 2.6 m above the road
    truth_boundaries, truth_markings, truth_driving_lines, truth_surface, truth_lanes, truth_roadside :
        Features in map coordinates
    """

    def __init__(self, settings: SampleSettings, crs: str, progress: Progress):
        self.settings, self.crs = settings, crs
        self.scene: AnyScene = build_scene(settings.scene, float(settings.length), settings.seed, settings.radius,
                                           settings.curb_height, settings.gutter)
        self.camera = camera_over(self.scene) if isinstance(self.scene, Scene) else None
        self.scanners = butterfly(settings.rotation_rate, settings.pulse_rate, settings.mount_yaw)
        passes: list[tuple[Followed, int, float, float]] = [*self.scene.passes_driven()]
        phases = np.random.default_rng([settings.seed, 2]).uniform(0, 2 * np.pi, len(passes))
        self.drives: list[Drive] = []
        start = _START_TIME
        for (way, direction, offset, haste), phase in zip(passes, phases):
            drive = Drive(way, direction, offset, settings.speed_kmh / 3.6 * haste, start, float(phase))
            self.drives.append(drive)
            start = np.ceil(start + drive.duration + _PAUSE)
        self.trajectory = self._trajectory()
        progress.report(0.3)
        truth = self.scene.truth(settings.origin, crs)
        self.truth_boundaries, self.truth_markings = truth.boundaries, truth.markings
        self.truth_driving_lines, self.truth_surface, self.truth_lanes = truth.driving_lines, truth.surface, truth.lanes
        self.truth_roadside = truth.roadside
        progress.report(1.0)

    def _trajectory(self):
        """Trajectory of all passes, in map coordinates and degrees."""
        columns = []
        for drive in self.drives:
            t = np.arange(int(round(drive.duration * 200)) + 1) / 200.0
            x, y, z, roll, pitch, heading = drive.pose(t)
            columns.append(np.stack([drive.start_time + t, x + self.settings.origin[0], y + self.settings.origin[1],
                                     z + self.settings.origin[2], *np.degrees([roll, pitch, heading])]))
        return Trajectory(*np.concatenate(columns, axis=1), crs=self.crs)

    def _blocks(self) -> Iterator[tuple[int, Drive, Scanner, np.ndarray]]:
        """Pass, drive, scanner and turns of each block, in the order of writing."""
        turns = max(1, int(_PULSES * self.settings.rotation_rate / self.settings.pulse_rate))
        for number, drive in enumerate(self.drives):
            lines = np.arange(int(drive.duration * self.settings.rotation_rate))
            for start in range(0, len(lines), turns):
                for scanner in self.scanners:
                    yield number, drive, scanner, lines[start:start + turns]

    def blocks(self, noise: bool = True, progress: Progress | None = None) -> Iterator[np.ndarray]:
        """Points in blocks of time and scanner, SAMPLE_POINT arrays in map coordinates, some of them empty.

        noise : whether ranges and intensities are noisy and pulses are lost; else every point lies where its pulse met the street
        """
        progress = progress or Progress()
        jobs = list(self._blocks())
        with ThreadPoolExecutor(max_workers=min(4, os.cpu_count() or 1)) as pool:
            waiting: deque[Future[np.ndarray]] = deque()
            try:
                for done, job in enumerate(jobs):
                    waiting.append(pool.submit(self._measure, *job, noise))
                    if len(waiting) > 4:
                        yield waiting.popleft().result()
                        progress.report(done / len(jobs))
                while waiting:
                    yield waiting.popleft().result()
            finally:
                for future in waiting:
                    future.cancel()

    def points(self, noise: bool = True, progress: Progress | None = None) -> np.ndarray:
        """All points at once, as in `blocks`: a SAMPLE_POINT array with labels (see street.LABELS), true range, station and offset."""
        return np.concatenate(list(self.blocks(noise, progress)))

    def _measure(self, number, drive, scanner, lines, noise):
        """The points of some turns of one scanner."""
        settings, scene = self.settings, self.scene
        rng = np.random.default_rng([settings.seed, 3, number, scanner.number, int(lines[0])])
        origin, direction, times, angles = scanner.pulses(drive, lines)
        station = float(drive.station(times[len(times) // 2]))
        hits = cast(scene, origin, direction, station, rng, settings.reach)
        returns = np.flatnonzero(np.isfinite(hits.distance) & (hits.cosine > 0))
        label = label_hits(scene, hits, returns)
        distance, cosine = hits.distance[returns], hits.cosine[returns]
        start, way = origin[:, returns], direction[:, returns]
        s, d = hits.station[returns], hits.offset[returns]
        standing = np.flatnonzero(hits.strip[returns] == OBSTACLE)
        xyz = start[:, standing] + distance[standing] * way[:, standing]
        s[standing], d[standing] = scene.located(xyz[0], xyz[1], station)
        strength = received(brightness_of(scene, label, s, d, hits.brightness[returns]), distance, cosine, scanner.gain)
        inside = scene.surveyed(s, d, settings.reach)
        true_range = distance
        if noise:
            normal = rng.standard_normal((3, len(returns)), dtype=np.float32)
            chance = rng.random((3, len(returns)), dtype=np.float32)
            distance = distance + _RANGE_NOISE * normal[0]
            stray = chance[0] < _STRAY
            distance[stray] = 1.5 + (distance[stray] - 1.5) * chance[2][stray]
            label[stray] = LABEL["stray"]
            strength = strength * (1.0 + _SPECKLE * normal[1]) + _COUNT_NOISE * normal[2]
            inside &= chance[1] > _LOST + 0.5 * np.exp2(-np.maximum(strength, 0.0) / _WEAK_SIGNAL)
        xyz = start + distance * way
        if noise:
            grass = np.flatnonzero(label == LABEL["verge"])
            xyz[2, grass] += _VERGE_NOISE * np.abs(normal[2, grass])
        points = np.zeros(int(inside.sum()), dtype=SAMPLE_POINT)
        for axis, name in enumerate("xyz"):
            points[name] = xyz[axis, inside] + settings.origin[axis]
        points["time"] = drive.start_time + times[returns][inside]
        points["intensity"] = np.clip(np.rint(strength[inside]), 1, 65535)
        points["scan_angle"] = angles[returns][inside]
        points["scanner"], points["pass"] = scanner.number, number + 1
        points["label"], points["range"] = label[inside], true_range[inside]
        points["station"], points["offset"] = s[inside], d[inside]
        return points

    def write_cloud(self, path: str | os.PathLike[str], progress: Progress | None = None, noise: bool = True) -> int:
        """Write the survey, with noise as in `blocks`, as LAS 1.4, LAZ by its ending, point format 6; the number of points.

        The file appears when it is complete; RoadExtractionError if it cannot be written.
        """
        import laspy

        progress = progress or Progress()
        path = os.fspath(path)
        part = f"{path}.part"
        header = self._header(laspy)
        count = 0
        try:
            with open(part, "wb") as stream, laspy.open(
                    stream, mode="w", header=header, do_compress=path.lower().endswith(".laz"), closefd=False) as writer:
                for points in self.blocks(noise, progress):
                    if len(points):
                        writer.write_points(_las_record(laspy, points, header))
                        count += len(points)
            os.replace(part, path)
        except OSError as problem:
            raise RoadExtractionError(f"The sample survey could not be written to {path}: {problem.strerror or problem}. "
                                      "Choose a folder that exists and is not full.") from problem
        finally:
            if os.path.exists(part):
                os.remove(part)
        progress.report(1.0)
        return count

    def _header(self, laspy):
        header = laspy.LasHeader(version="1.4", point_format=6)
        header.scales, header.offsets = np.full(3, 0.001), np.array(self.settings.origin)
        header.creation_date = date(_SURVEY_DAY.year, _SURVEY_DAY.month, _SURVEY_DAY.day)
        header.system_identifier, header.generating_software = "simulated survey", "Lanewright"
        header.global_encoding.gps_time_type = laspy.header.GpsTimeType.STANDARD
        if self.crs:
            header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(self.crs))
            header.global_encoding.wkt = True
        return header


def _las_record(laspy, points, header):
    record = laspy.ScaleAwarePointRecord.zeros(len(points), header=header)
    for axis, name in enumerate("xyz"):
        record[name.upper()] = np.rint((points[name] - header.offsets[axis]) / 0.001).astype(np.int32)
    record["intensity"], record["gps_time"] = points["intensity"], points["time"]
    record["point_source_id"] = points["scanner"]
    record["scan_angle"] = np.rint(points["scan_angle"] / _LAS_ANGLE).astype(np.int16)
    record["return_number"] = record["number_of_returns"] = np.ones(len(points), dtype=np.uint8)
    return record
