"""Where the scanners rode, seen from the trajectory: by the rays of their mirrors, whatever the trajectory says.

In the frame of the vehicle all points of one mirror lie in one plane, all along the survey. In this plane two directions are as far apart as
the mirror turned between their times, so that the points of some turns fix the place of the scanner (see estimation/poses.py). It is the
lever arm from the trajectory to the scanner, as it is in the files. A trajectory of another lane, of another datum, or with heights of another
kind shows as a lever arm that no vehicle has; coordinates that are stretched, as heights in feet, as rays that do not meet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...curves.robust import MAD_TO_SIGMA
from ..estimation.adjustment import MAX_RAY_MISFIT
from ..estimation.first_track import DENSITY_ROUNDS, DENSITY_WIDTH, GROUND_WEIGHT_DEPTH, LOWEST_SHARE
from ..estimation.poses import EXPECTED_HEIGHT, MIN_SHARE_IN_FRONT, RESECTION_ROUNDS, resected, vehicle_axes
from ..estimation.samples import SAMPLED_LAYERS
from ..las.parallel_reader import ParallelCloudReader
from ..las.point_fields import ScannerCensus, numbers_by_value, times_by_value, valid_points
from ..las.reader import CloudHeader
from ..lattice.scan_lattice import MIN_ROTATION_PEAK, ROTATION_WINDOW, rotation_spectrum, strongest_rotation
from ..trajectory.trajectory import Trajectory
from .limits import (
    ATTITUDE_NOISE,
    MAX_TURNS_POINTS,
    MAX_UPRIGHT,
    MIN_TURNS_POINTS,
    MIN_WINDOWS,
    PLACE_POINTS,
    PLACE_WINDOWS,
    PLACES_READ,
    SIGNIFICANT,
    TURNS_WINDOW,
)


@dataclass(frozen=True)
class Mounting:
    """A scanner in the frame of the vehicle, whose origin is the trajectory.

    scanner : its number
    time : (W,) s, middles of windows
    lever : (W, 3) m ahead, left and up
    ground : m of the ground above the scanner; negative where the scanner rides above it
    misfit : m, median distance of points from their rays
    """

    scanner: int
    time: np.ndarray
    lever: np.ndarray
    ground: float
    misfit: float


@dataclass(frozen=True)
class _Sample:
    """First returns in order of time: s, (N, 3) map coordinates, number of the scanner."""

    time: np.ndarray
    place: np.ndarray
    scanner: np.ndarray


def read_places(files: Sequence[CloudHeader], scanner_field: str | None = "automatic") -> _Sample:
    """First returns of PLACE_WINDOWS of time, or more, at each of PLACES_READ places spread evenly over the points of the files.

    Parameters
    ----------
    files : headers of the clouds
    scanner_field : as of `ScannerCensus.choose`
    """
    ends = np.cumsum([file.count for file in files])
    census, parts = ScannerCensus(), []
    with ParallelCloudReader(SAMPLED_LAYERS) as reader:
        starts = set()
        for at in ((np.arange(PLACES_READ) + 0.5) / PLACES_READ * ends[-1]).astype(np.int64).tolist():
            number = int(np.searchsorted(ends, at, side="right"))
            starts.add((number, reader.chunk_start(files[number], at - int(ends[number] - files[number].count))))
        for number, start in sorted(starts):
            parts += _read_place(reader, files[number], start, -(-PLACES_READ * PLACE_WINDOWS // len(starts)))
    time, place, source, channel = (np.concatenate(column) for column in zip(*parts))
    for name, values in (("point_source_id", source), ("scanner_channel", channel)):
        census.take(name, times_by_value(values, time))
    field, values = census.choose(scanner_field)
    scanner = np.zeros(len(time), np.uint8)
    if field is not None:
        column = source if field == "point_source_id" else channel
        scanner = numbers_by_value(values, int(column.max(initial=0)) + 1)[column]
    order = np.argsort(time, kind="stable")
    return _Sample(time[order], place[order], scanner[order])


def _read_place(reader, file, start, windows):
    """[`_first_returns`] of points of a file from the beginning of a chunk on, as many as some windows hold."""
    parts, seen = [], {}
    for block in reader.following(file, start, PLACE_POINTS // 10):
        parts.append(_first_returns(block))
        for window, count in zip(*np.unique(np.floor(parts[-1][0] / TURNS_WINDOW), return_counts=True)):
            seen[window] = seen.get(window, 0) + count
        if sum(count >= MIN_TURNS_POINTS for count in seen.values()) >= windows or sum(len(part[0]) for part in parts) >= PLACE_POINTS:
            break
    return parts


def _first_returns(block):
    """(N,) gps_time, (N, 3) map coordinates, point source and scanner channel of the usable first returns of a block."""
    raw, names = block.array, set(block.point_format.dimension_names)
    own = np.asarray(block["return_number"]) <= 1
    time = raw["gps_time"].astype(float)
    own &= np.isfinite(time)
    if (valid := valid_points(block)) is not None:
        own &= valid
    place = np.stack([raw[name][own] * scale + offset for name, scale, offset in zip("XYZ", block.scales, block.offsets)], axis=1)
    channel = np.asarray(block["scanner_channel"]) if "scanner_channel" in names else np.zeros(len(raw), np.int64)
    return time[own], place, raw["point_source_id"][own].astype(np.int64), channel[own].astype(np.int64)


def scanner_mountings(sample: _Sample, trajectory: Trajectory, stretch: float = 1.0) -> list[Mounting]:
    """The Mounting of every scanner whose mirror is seen to turn.

    Parameters
    ----------
    sample : of `read_places`
    trajectory : Trajectory with times, in the CRS and time system of the sample
    stretch : by which heights of points and trajectory are multiplied before, to try other units of them
    """
    seen = _in_vehicle_frame(sample, trajectory, stretch)
    found = (_mounting_of(number, *(column[seen[2] == number] for column in seen[:2])) for number in np.unique(seen[2]).tolist())
    return [one for one in found if one is not None]


def _in_vehicle_frame(sample, trajectory, stretch):
    """(N,) s, (N, 3) m ahead, left and up, and (N,) scanner of points evenly chosen from windows of time."""
    driven = np.flatnonzero((sample.time >= trajectory.time[0]) & (sample.time <= trajectory.time[-1]))
    # by scanner, then by time, as the sample is
    driven = driven[np.argsort(sample.scanner[driven], kind="stable")]
    windows = np.stack([sample.scanner[driven], np.floor(sample.time[driven] / TURNS_WINDOW)])
    begin = np.flatnonzero((np.diff(windows, axis=1, prepend=np.nan) != 0).any(axis=0))
    size = np.diff(np.append(begin, len(driven)))
    rank = np.arange(len(driven)) - np.repeat(begin, size)
    used = np.repeat(size >= MIN_TURNS_POINTS, size) & (rank % np.repeat(-(-size // MAX_TURNS_POINTS), size) == 0)
    rows = np.sort(driven[used])
    time, place = sample.time[rows], sample.place[rows]
    away = place - np.stack([np.interp(time, trajectory.time, getattr(trajectory, name)) for name in "xyz"], axis=1)
    away[:, 2] *= stretch
    axes = vehicle_axes(*(np.interp(time, trajectory.time, angle) for angle in vehicle_angles(trajectory, stretch)))
    return time, np.stack([(axis * away).sum(axis=1) for axis in axes], axis=1), sample.scanner[rows]


def vehicle_angles(trajectory: Trajectory, stretch: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(N,) roll, pitch and yaw (counter-clockwise from east) in radians; from the way driven where the trajectory has none.

    Parameters
    ----------
    trajectory : Trajectory
    stretch : by which heights are multiplied before
    """
    attitude = trajectory.attitude()
    if attitude is not None:
        return attitude[0], attitude[1], np.pi / 2 - attitude[2]
    dx, dy, dz = (np.gradient(getattr(trajectory, name), trajectory.time) for name in "xyz")
    return np.zeros(len(trajectory)), np.arctan2(stretch * dz, np.maximum(np.hypot(dx, dy), 0.1)), np.unwrap(np.arctan2(dy, dx))


def _mounting_of(number, time, place):
    """The Mounting of one scanner from the points that it saw, (N,) s and (N, 3) m in the frame of the vehicle; None where they do not show it."""
    if len(time) < MIN_WINDOWS * MIN_TURNS_POINTS:
        return None
    _, window = np.unique(np.floor(time / TURNS_WINDOW), return_inverse=True)
    size = int(window[-1]) + 1
    middle, normal, off = _scan_plane(place, window, size)
    # points of several mirrors, or of many beams, lie in no plane
    if abs(normal[2]) > MAX_UPRIGHT or MAD_TO_SIGMA * np.median(np.abs(off)) > SIGNIFICANT:
        return None
    across = np.cross([0.0, 0.0, 1.0], normal)
    across /= np.linalg.norm(across)
    upright = np.cross(normal, across)
    a, b = ((place - middle[window]) @ axis for axis in (across, upright))
    rate = _rate(time, a, b, window, size)
    if rate is None:
        return None
    middles = np.bincount(window, time, size) / np.bincount(window, minlength=size)
    found = max((_places(a, b, time - middles[window], window, middles, sign * rate) for sign in (1, -1)), key=lambda one: (one[2].sum(), -one[3]))
    u, v, good, misfit = found
    if good.sum() < max(MIN_WINDOWS, size / 2):
        return None
    lever = middle + u[:, None] * across + v[:, None] * upright
    away = place - lever[window]
    below = away[(np.hypot(*away.T[:2]) < EXPECTED_HEIGHT) & good[window], 2]
    return Mounting(number, middles[good], lever[good], float(np.median(below)) if len(below) else np.nan, misfit)


def _scan_plane(place, window, size):
    """(W, 3) middles of the windows of places, the unit normal of the planes through them, and (N,) sigma off these, outliers weighted down.

    Each window has a plane of its own, parallel to the others: trajectories may wander against the scanner.
    """

    def means(weight, values):
        return np.stack([np.bincount(window, weight * column, size) for column in values.T], axis=1) / np.bincount(window, weight, size)[:, None]

    far = np.linalg.norm(place - means(np.ones(len(place)), place)[window], axis=1)
    variance = MAX_RAY_MISFIT**2 + (ATTITUDE_NOISE * far) ** 2
    weight = 1.0 / variance
    for _ in range(DENSITY_ROUNDS):
        middle = means(weight, place)
        away = place - middle[window]
        normal = np.linalg.eigh((weight[:, None] * away).T @ away)[1][:, 0]
        off = away @ normal / np.sqrt(variance)
        weight = 1.0 / variance / (1.0 + off**2 / 4.0)
    return middle, normal if normal[0] >= 0 else -normal, off


def _rate(time, a, b, window, size):
    """Turns of the mirror per second, from places in the planes of windows; None where they show none."""
    foot, ground = np.zeros(size), np.zeros(size)
    order = np.lexsort((b, window))
    held = np.bincount(window, minlength=size)
    ground = b[order][np.cumsum(held) - held + (held * LOWEST_SHARE).astype(int)]
    for _ in range(DENSITY_ROUNDS):
        weight = 1.0 / ((1.0 + ((a - foot[window]) / DENSITY_WIDTH) ** 2) * (1.0 + ((b - ground[window]) / GROUND_WEIGHT_DEPTH) ** 2))
        foot, ground = (np.bincount(window, weight * values, size) / np.bincount(window, weight, size) for values in (a, b))
    phasor = b - ground[window] - EXPECTED_HEIGHT + 1j * (a - foot[window])
    phasor /= np.maximum(np.abs(phasor), 1e-9)
    piece = np.floor((time - time[0]) / ROTATION_WINDOW)
    cuts = np.flatnonzero(np.r_[True, np.diff(piece) > 0, True])
    spectra = [rotation_spectrum(time[i:j], phasor[i:j]) for i, j in zip(cuts[:-1], cuts[1:]) if j - i >= MIN_TURNS_POINTS]
    rate, peak = strongest_rotation(spectra) if spectra else (0.0, 0.0)
    return abs(rate) if peak >= MIN_ROTATION_PEAK else None


def _places(a, b, since, window, middles, rate):
    """(W,) m of the scanner along and up its plane, (W,) bool of good windows, and m of their misfit, by a rate that is made better."""
    for _ in range(RESECTION_ROUNDS):
        u, v, phase, misfit, in_front = resected(a, b, 2 * np.pi * rate * since, window, len(middles))
        good = in_front >= MIN_SHARE_IN_FRONT
        apart = np.diff(middles)
        step = np.diff(phase) - 2 * np.pi * rate * apart
        step = (step + np.pi) % (2 * np.pi) - np.pi
        near = good[1:] & good[:-1] & (apart < 1.5 * TURNS_WINDOW)
        if near.sum() >= MIN_WINDOWS:
            rate += float(np.median(step[near] / apart[near])) / (2 * np.pi)
    return u, v, good, float(np.median(misfit[good])) if good.any() else np.inf


def usual_lever(mountings: Sequence[Mounting]) -> np.ndarray:
    """(3,) m ahead, left and up of the middle of the scanners from the trajectory."""
    return np.mean([np.median(one.lever, axis=0) for one in mountings], axis=0)
