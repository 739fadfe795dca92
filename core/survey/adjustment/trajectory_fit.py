"""Whether a trajectory is that of the scanners: its own shape, and where the scanners rode beside, above and below it.

What can be mended safely is mended before any point is read, and said; what cannot goes into the uncertainty of everything that is drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from ...common.progress import Progress
from ...curves.robust import MAD_TO_SIGMA
from ...io.crs import FOOT
from ..estimation.poses import resected, vehicle_axes
from ..estimation.samples import SAMPLED_LAYERS, thinned
from ..frame.road_frame import decimate_by_distance, runs_through
from ..las.parallel_reader import ParallelCloudReader
from ..las.point_fields import SCANNER_FIELDS, first_returns, scanners_of
from ..las.reader import CloudHeader
from ..lattice.scan_lattice import rotation_spectrum, strongest_rotation
from ..trajectory.trajectory import Trajectory, clean_trajectory, shaped_trajectory
from ..weights import ADJUST, ESTIMATE, FRAME, LAS, LATTICE, MIRROR, RAYS, READING, TRACK, VEHICLE


@dataclass(frozen=True)
class _FittedTrajectory:
    """A trajectory as the scanners were carried."""

    trajectory: Trajectory   # the one given where everything fits
    sigma: float   # m across, one sigma that is left of what did not
    seen: bool   # whether the rays of the scanners show where they rode


def fitted_trajectory(files: Sequence[CloudHeader], trajectory: Trajectory, scanner_field: str | None = "automatic",
                      progress: Progress = Progress()) -> _FittedTrajectory:
    """The trajectory as the scanners were carried, where the one given is not.

    files : headers of the clouds
    trajectory : Trajectory in their CRS and, where it has times, in their time system
    scanner_field : as of `ScannerCensus.choose`
    progress : Progress, which hears one warning for each thing that does not fit
    """
    shape = shaped_trajectory(clean_trajectory(trajectory))
    progress.warn_all(shape.said)
    unmoved = shape.trajectory if shape.said else trajectory
    sample = _sample_along(files, shape.trajectory, scanner_field)
    if sample is None:
        return _FittedTrajectory(unmoved, shape.sigma, False)
    if (far := _far_away(sample, shape.trajectory)) > ESTIMATE.farthest_median:
        progress.warn(f"Half of the points lie more than {far:.0f} m from the trajectory; a vehicle on the road sees half within "
                      f"{ESTIMATE.farthest_median:.0f} m. Check that cloud and trajectory are of one drive, and neither is flown nor mirrored.")
        return _FittedTrajectory(unmoved, float(np.hypot(shape.sigma, far)), False)
    mountings = _near(scanner_mountings(sample, shape.trajectory))
    if not mountings:   # places of one scanner at a time do not show that there are several
        sample = replace(sample, scanner=sample.source)
        mountings = _near(scanner_mountings(sample, shape.trajectory))
    if mountings and _other_heights(sample, shape.trajectory, mountings, progress):
        return _FittedTrajectory(unmoved, float(np.hypot(shape.sigma, SIGMA_OF_OTHER_HEIGHTS)), True)
    if not (mountings := _met(mountings)):
        return _FittedTrajectory(unmoved, shape.sigma, False)
    level = _at_height(shape.trajectory, mountings, progress)
    if level is not shape.trajectory:   # a trajectory far above its scanners swings over them, as the vehicle rolls
        mountings = _met(scanner_mountings(sample, level))
    moved, left = _on_way(level, mountings, progress)
    return _FittedTrajectory(unmoved if moved is shape.trajectory else moved, float(np.hypot(shape.sigma, left)), True)


def _sample_along(files, trajectory, scanner_field):
    """The points of `read_places` of the files that a trajectory runs through; None where there are none, or not all have times."""
    near = [file for file in files if file.count and runs_through(file.minimum, file.maximum, trajectory.x, trajectory.y, FRAME.corridor)]
    return read_places(near, scanner_field) if trajectory.has_time and near and all(file.has_time for file in near) else None


def _far_away(sample, trajectory):
    """m from the nearest place of the trajectory, of half of the points that were measured while it was driven; 0 without any."""
    track = np.c_[trajectory.x, trajectory.y]
    places = sample.place[(sample.time >= trajectory.time[0]) & (sample.time <= trajectory.time[-1]), :2]
    distance = cKDTree(track[decimate_by_distance(*track.T, FRAME.track_step)]).query(places)[0]
    return float(np.median(distance)) if len(distance) else 0.0


def _near(mountings):
    """Those of the mountings that lie within reach of the trajectory."""
    return [mounting for mounting in mountings if np.hypot(*_usual_lever([mounting])[:2]) < FRAME.corridor]


def _met(mountings):
    """Those of the mountings whose rays meet in one place."""
    return [mounting for mounting in mountings if mounting.misfit <= RAYS.max_unexplained]


def _other_heights(sample, trajectory, mountings, progress):
    """Whether heights are in another unit than places, or upside down; it is said."""
    if not _met(mountings):
        for stretch, phrase in ((FOOT, "in feet where x and y are in metres"), (1.0 / FOOT, "in metres where x and y are in feet")):
            stretched = scanner_mountings(sample, trajectory, stretch)
            if len(stretched) >= len(mountings) and len(_met(stretched)) == len(stretched):
                up, height = float(_usual_lever(stretched)[2]), float(np.median(trajectory.z))
                # from a trajectory that is stretched alike the scanners lie where they ride on the vehicle
                cloud_alone = abs(up) > max(VEHICLE_HEIGHT, abs(up - (1.0 - stretch) * height))
                of = "the cloud alone" if cloud_alone else "cloud and trajectory"
                progress.warn(f"The heights of {of} seem to be {phrase}: the laser beams meet in the scanner only if heights are multiplied by "
                              f"{stretch:.4g}. Convert these heights, and run again.")
                return True
    if all(mounting.ground > 0 for mounting in mountings):
        progress.warn(f"The road lies {np.mean([mounting.ground for mounting in mountings]):.1f} m above the scanners, as if heights were upside "
                      "down. Export cloud and trajectory with heights that rise upwards.")
        return True
    return False


def _at_height(trajectory: Trajectory, mountings: Sequence[_Mounting], progress: Progress) -> Trajectory:
    """The trajectory moved to the height of the scanners where it runs below the road or higher than vehicles are; else the same."""
    times, lever = _places(mountings)
    above_road = -float(np.mean([mounting.ground for mounting in mountings]))
    up = lever[:, 2]
    far = (np.abs(up) > VEHICLE_HEIGHT) | (up > above_road + VEHICLE.lowest_sensor)
    if not far.any():
        return trajectory
    worst = float(up[np.argmax(np.abs(up))])
    extent = "" if far.all() else f" at {np.count_nonzero(far)} of {len(far)} places looked at"
    progress.warn(f"The trajectory lies {abs(worst):.2f} m {'below' if worst > 0 else 'above'} the scanners{extent}, as their laser beams "
                  f"show: {'below the road' if worst > 0 else 'no vehicle is so high'}. It was moved to their height. Export both with one kind of "
                  "heights (ellipsoid or sea level).")
    metres = np.full(len(trajectory), np.median(up)) if np.ptp(up) < VEHICLE.one_move * abs(worst) else np.interp(trajectory.time, times, up)
    return replace(trajectory, z=trajectory.z + metres)


def _on_way(trajectory: Trajectory, mountings: Sequence[_Mounting], progress: Progress) -> tuple[Trajectory, float]:
    """The trajectory moved to the way of the scanners where no vehicle is so wide, else the same, and m by which it fits the scanners worse."""
    if not mountings:
        return trajectory, 0.0
    times, lever = _places(mountings)
    far = np.abs(lever[:, 1]) > HALF_VEHICLE
    if not far.any():
        return trajectory, _jump(trajectory, times, lever, progress)
    worst = float(lever[np.argmax(np.abs(lever[:, 1])), 1])
    x, y = (np.interp(times[np.argmax(far)], trajectory.time, getattr(trajectory, name)) for name in "xy")
    extent = "" if far.all() else f" at {np.count_nonzero(far)} of {len(far)} places looked at"
    progress.warn(f"The trajectory runs {abs(worst):.2f} m to the {'right' if worst > 0 else 'left'} of the way that the scanners took{extent} "
                  f"(first near x {x:.0f}, y {y:.0f}). It was moved there; it may be of another lane or in another datum.")
    return _moved_aside(trajectory, mountings, times, lever[:, 1])


def _jump(trajectory, times, lever, progress):
    """m by which the scanners ride elsewhere on the vehicle at one place than at the one before in one drive, at most; 0 where they do not."""
    pauses = trajectory.time[:-1][np.diff(trajectory.time) > ADJUST.max_seam]
    one_drive = np.diff(np.searchsorted(pauses, times)) == 0
    speed = np.interp(times, trajectory.time, np.hypot(*(np.gradient(axis, trajectory.time) for axis in (trajectory.x, trajectory.y))))
    moved, faster = np.diff(lever, axis=0) * one_drive[:, None], np.diff(speed) * one_drive
    # a clock that lags moves the scanners along, the farther the faster; of all lags the one that leaves least leaves a jump as it is
    lags = np.clip(np.r_[0.0, moved[:, 0] / np.where(faster == 0.0, np.inf, faster)], -VEHICLE.largest_lag, VEHICLE.largest_lag)
    moved[:, 0] -= faster * lags[np.abs(moved[:, 0] - lags[:, None] * faster).sum(axis=1).argmin()]
    metres = np.linalg.norm(moved, axis=1)
    turned = VEHICLE.attitude_noise if np.isfinite([trajectory.roll, trajectory.pitch, trajectory.heading]).all() else VEHICLE.course_noise
    arm = np.linalg.norm(lever, axis=1)
    arm = np.maximum(arm[1:], arm[:-1])   # longer ones are those of a clock, which is told of by itself
    jumps = np.flatnonzero((metres > VEHICLE.least_jump + turned * arm) & (arm < 2 * VEHICLE.usual_ahead))
    if not len(jumps):
        return 0.0
    k = int(jumps[0])
    progress.warn(f"The scanners ride {metres[k]:.2g} m elsewhere beside the trajectory at {times[k + 1]:.1f} s than at {times[k]:.1f} s. Files of "
                  "one drive seem to be in two datums, or its angles are wrong: export all of them and the trajectory from one solution.")
    return float(metres[jumps].max())


def _windows(mountings):
    """(W,) s of the windows of all scanners, in order, and (W, 3) m from the trajectory to the middle of the scanners then."""
    time = np.concatenate([mounting.time for mounting in mountings])
    lever = np.concatenate([mounting.lever - np.median(mounting.lever, axis=0) for mounting in mountings]) + _usual_lever(mountings)
    order = np.argsort(time, kind="stable")
    return time[order], lever[order]


def _places(mountings):
    """(P,) s of places that were looked at, and (P, 3) m from the trajectory to the middle of the scanners there."""
    time, lever = _windows(mountings)
    cuts = [0, *(np.flatnonzero(np.diff(time) > PLACE_GAP) + 1).tolist(), len(time)]
    places = [slice(i, j) for i, j in zip(cuts[:-1], cuts[1:]) if j - i > PLACE_WINDOWS / 2] or [slice(0, len(time))]
    return np.array([time[part].mean() for part in places]), np.array([np.median(lever[part], axis=0) for part in places])


def _moved_aside(trajectory, mountings, at, beside):
    """The trajectory moved to where the scanners were, and m that are unknown between places; `beside` (P,) m to the left at (P,) times of places.

    What is the same in the vehicle (another lane) or on the map (another datum) is one move, of which the one is taken that leaves less. Where
    neither fits, as with several drives of which one is wrong, the trajectory is moved to the left evenly between the places.
    """
    time, lever = _windows(mountings)
    yaw = _vehicle_angles(trajectory)[2]
    heading = np.interp(time, trajectory.time, yaw)
    cos, sin, ones, zeros = np.cos(heading), np.sin(heading), np.ones(len(heading)), np.zeros(len(heading))
    measured = np.r_[lever[:, 0], lever[:, 1]]
    in_vehicle = np.median(lever[:, 1])
    rows = np.r_[np.c_[cos, sin, ones], np.c_[-sin, cos, zeros]]
    on_map = np.linalg.lstsq(np.r_[rows, [[0.0, 0.0, 1.0 / VEHICLE.usual_ahead]]], np.r_[measured, 0.0], rcond=None)[0]
    left_over = [float(np.quantile(np.abs(off), VEHICLE.moved_share)) for off in (lever[:, 1] - in_vehicle, measured - rows @ on_map)]
    east, north, metres = 0.0, 0.0, in_vehicle
    if left_over[1] < VEHICLE.clearly_better * left_over[0]:
        (east, north), metres = on_map[:2], 0.0
    unknown = 0.0
    if min(left_over) > VEHICLE.one_move:
        east, north, metres, unknown = 0.0, 0.0, np.interp(trajectory.time, at, beside), min(left_over)
    return replace(trajectory, x=trajectory.x + east - np.sin(yaw) * metres, y=trajectory.y + north + np.cos(yaw) * metres), unknown


# Where the scanners rode, seen from the trajectory: by the rays of their mirrors, whatever the trajectory says.
#
# In the frame of the vehicle all points of one mirror lie in one plane, all along the survey. In this plane two directions are as far apart as the
# mirror turned between their times, so that the points of some turns fix the place of the scanner (see estimation/poses.py). It is the lever arm
# from the trajectory to the scanner, as it is in the files. A trajectory of another lane, of another datum, or with heights of another kind shows
# as a lever arm that no vehicle has; coordinates that are stretched, as heights in feet, as rays that do not meet.

@dataclass(frozen=True)
class _Mounting:
    """A scanner in the frame of the vehicle, whose origin is the trajectory."""

    scanner: int   # its number
    time: np.ndarray   # (W,) s, middles of windows
    lever: np.ndarray   # (W, 3) m ahead, left and up
    ground: float   # m of the ground above the scanner; negative where the scanner rides above it
    misfit: float   # m, median distance of points from their rays


@dataclass(frozen=True)
class _Sample:
    """First returns in order of time: s, (N, 3) map coordinates, number of the scanner and point_source_id, if few."""

    time: np.ndarray
    place: np.ndarray
    scanner: np.ndarray
    source: np.ndarray


def read_places(files: Sequence[CloudHeader], scanner_field: str | None = "automatic") -> _Sample:
    """First returns of PLACE_WINDOWS of time, or more, at each of PLACES_READ places spread evenly over the points of the files.

    files : headers of the clouds
    scanner_field : as of `ScannerCensus.choose`
    """
    ends, parts, starts, reader = np.cumsum([file.count for file in files]), [], set(), ParallelCloudReader(SAMPLED_LAYERS)
    for row in ((np.arange(PLACES_READ) + 0.5) / PLACES_READ * ends[-1]).astype(np.int64).tolist():
        number = int(np.searchsorted(ends, row, side="right"))
        starts.add((number, reader.chunk_start(files[number], row - int(ends[number] - files[number].count))))
    for number, start in sorted(starts):
        parts += _read_place(reader, files[number], start, -(-PLACES_READ * PLACE_WINDOWS // len(starts)))
    time, place, numbers = (np.concatenate(column) for column in zip(*parts))
    order = np.argsort(time, kind="stable")
    source = numbers[order, SCANNER_FIELDS.index("point_source_id")]
    source = source if len(np.unique(source)) <= LAS.max_scanners else np.zeros(len(source), np.uint8)
    return _Sample(time[order], place[order], scanners_of(numbers, time, scanner_field)[order], source)


def _read_place(reader, file, start, windows):
    """[`first_returns`] of points of a file from the beginning of a chunk on, as many as some windows hold."""
    parts, counts = [], {}
    for block in reader.following(file, start, PLACE_POINTS // 10):
        parts.append(first_returns(block))
        for window, count in zip(*np.unique(np.floor(parts[-1][0] / VEHICLE.turns_window), return_counts=True)):
            counts[window] = counts.get(window, 0) + count
        if sum(count >= MIN_TURNS_POINTS for count in counts.values()) >= windows or sum(len(part[0]) for part in parts) >= PLACE_POINTS:
            break
    return parts


def scanner_mountings(sample: _Sample, trajectory: Trajectory, stretch: float = 1.0) -> list[_Mounting]:
    """The _Mounting of every scanner whose mirror is seen to turn.

    sample : of `read_places`
    trajectory : Trajectory with times, in the CRS and time system of the sample
    stretch : by which heights of points and trajectory are multiplied before, to try other units of them
    """
    points = _in_vehicle_frame(sample, trajectory, stretch)
    mountings = (_mounting_of(number, *(column[points[2] == number] for column in points[:2])) for number in np.unique(points[2]).tolist())
    return [mounting for mounting in mountings if mounting is not None]


def _in_vehicle_frame(sample, trajectory, stretch):
    """(N,) s, (N, 3) m ahead, left and up, and (N,) scanner of points evenly chosen from windows of time."""
    driven = np.flatnonzero((sample.time >= trajectory.time[0]) & (sample.time <= trajectory.time[-1]))
    # by scanner, then by time, as the sample is
    driven = driven[np.argsort(sample.scanner[driven], kind="stable")]
    windows = np.stack([sample.scanner[driven], np.floor(sample.time[driven] / VEHICLE.turns_window)])
    group = np.cumsum((np.diff(windows, axis=1, prepend=windows[:, :1]) != 0).any(axis=0))
    used = (np.bincount(group)[group] >= MIN_TURNS_POINTS) & thinned(group, MAX_TURNS_POINTS)
    rows = np.sort(driven[used])
    time, place = sample.time[rows], sample.place[rows]
    rays = place - np.stack([np.interp(time, trajectory.time, getattr(trajectory, name)) for name in "xyz"], axis=1)
    rays[:, 2] *= stretch
    axes = vehicle_axes(*(np.interp(time, trajectory.time, angle) for angle in _vehicle_angles(trajectory, stretch)))
    return time, np.stack([(axis * rays).sum(axis=1) for axis in axes], axis=1), sample.scanner[rows]


def _vehicle_angles(trajectory: Trajectory, stretch: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(N,) roll, pitch and yaw (counter-clockwise from east) in radians; from the way driven where the trajectory has none.

    stretch : by which heights are multiplied before
    """
    attitude = trajectory.attitude()
    if attitude is not None:
        return attitude[0], attitude[1], np.pi / 2 - attitude[2]
    dx, dy, dz = (np.gradient(getattr(trajectory, name), trajectory.time) for name in "xyz")
    return np.zeros(len(trajectory)), np.arctan2(stretch * dz, np.maximum(np.hypot(dx, dy), 0.1)), np.unwrap(np.arctan2(dy, dx))


def _mounting_of(number, time, place):
    """The _Mounting of one scanner from the points that it saw, (N,) s and (N, 3) m in the frame of the vehicle; None where they do not show it."""
    if len(time) < VEHICLE.min_windows * MIN_TURNS_POINTS:
        return None
    _, window = np.unique(np.floor(time / VEHICLE.turns_window), return_inverse=True)
    size = int(window[-1]) + 1
    middle, normal, off = _scan_plane(place, window, size)
    # points of several mirrors, or of many beams, lie in no plane
    if abs(normal[2]) > VEHICLE.max_upright or MAD_TO_SIGMA * np.median(np.abs(off)) > SIGNIFICANT:
        return None
    across = np.cross([0.0, 0.0, 1.0], normal)
    across /= np.linalg.norm(across)
    upright = np.cross(normal, across)
    a, b = ((place - middle[window]) @ axis for axis in (across, upright))
    rate = _rate(time, a, b, window, size)
    if rate is None:
        return None
    middles = np.bincount(window, time, size) / np.bincount(window, minlength=size)
    best = max((_resected_places(a, b, time - middles[window], window, middles, sign * rate) for sign in (1, -1)),
               key=lambda one: (one[2].sum(), -one[3]))
    u, v, good, misfit = best
    if good.sum() < max(VEHICLE.min_windows, size / 2):
        return None
    lever = middle + u[:, None] * across + v[:, None] * upright
    rays = place - lever[window]
    near = rays[(np.hypot(*rays.T[:2]) < TRACK.usual_height) & good[window], 2]
    under = near[near < -VEHICLE.lowest_sensor]
    below = under if len(under) > READING.least_road_share * len(near) else near   # in a tunnel as much lies above
    return _Mounting(number, middles[good], lever[good], float(np.median(below)) if len(below) else np.nan, misfit)


def _scan_plane(place, window, size):
    """(W, 3) middles of the windows of places, the unit normal of the planes through them, and (N,) sigma off these, outliers weighted down.

    Each window has a plane of its own, parallel to the others: trajectories may wander against the scanner.
    """

    def means(weight, values):
        return np.stack([np.bincount(window, weight * column, size) for column in values.T], axis=1) / np.bincount(window, weight, size)[:, None]

    far = np.linalg.norm(place - means(np.ones(len(place)), place)[window], axis=1)
    variance = RAYS.max_ray_misfit**2 + (VEHICLE.attitude_noise * far) ** 2
    weight = 1.0 / variance
    for _ in range(TRACK.density_rounds):
        middle = means(weight, place)
        centred = place - middle[window]
        normal = np.linalg.eigh((weight[:, None] * centred).T @ centred)[1][:, 0]
        off = centred @ normal / np.sqrt(variance)
        weight = 1.0 / variance / (1.0 + off**2 / 4.0)
    return middle, normal if normal[0] >= 0 else -normal, off


def _rate(time, a, b, window, size):
    """Turns of the mirror per second, from places in the planes of windows; None where they show none."""
    foot, ground = np.zeros(size), np.zeros(size)
    order = np.lexsort((b, window))
    held = np.bincount(window, minlength=size)
    ground = b[order][np.cumsum(held) - held + (held * TRACK.lowest_share).astype(int)]
    for _ in range(TRACK.density_rounds):
        weight = 1.0 / ((1.0 + ((a - foot[window]) / TRACK.density_width) ** 2) * (1.0 + ((b - ground[window]) / TRACK.ground_weight_depth) ** 2))
        foot, ground = (np.bincount(window, weight * values, size) / np.bincount(window, weight, size) for values in (a, b))
    phasor = b - ground[window] - TRACK.usual_height + 1j * (a - foot[window])
    phasor /= np.maximum(np.abs(phasor), 1e-9)
    piece = np.floor((time - time[0]) / LATTICE.rotation_window)
    cuts = np.flatnonzero(np.r_[True, np.diff(piece) > 0, True])
    spectra = [rotation_spectrum(time[i:j], phasor[i:j]) for i, j in zip(cuts[:-1], cuts[1:]) if j - i >= MIN_TURNS_POINTS]
    rate, peak = strongest_rotation(spectra) if spectra else (0.0, 0.0)
    return abs(rate) if peak >= LATTICE.min_rotation_peak else None


def _resected_places(a, b, since, window, middles, rate):
    """(W,) m of the scanner along and up its plane, (W,) bool of good windows, and m of their misfit, by a rate that is made better."""
    for _ in range(MIRROR.resection_rounds):
        angle = 2 * np.pi * rate * since
        u, v, phase, misfit, in_front = resected(a, b, angle, window, len(middles))
        # points that all lie in one direction, as at the end of a tile, do not show where they were seen from
        one_way = np.hypot(*(np.bincount(window, part) for part in (np.cos(angle), np.sin(angle)))) / np.bincount(window)
        good = (in_front >= MIRROR.min_share_in_front) & (one_way < VEHICLE.max_one_way)
        seconds = np.diff(middles)
        step = np.diff(phase) - 2 * np.pi * rate * seconds
        step = (step + np.pi) % (2 * np.pi) - np.pi
        near = good[1:] & good[:-1] & (seconds < 1.5 * VEHICLE.turns_window)
        if near.sum() >= VEHICLE.min_windows:
            rate += float(np.median(step[near] / seconds[near])) / (2 * np.pi)
    return u, v, good, float(np.median(misfit[good])) if good.any() else np.inf


def _usual_lever(mountings: Sequence[_Mounting]) -> np.ndarray:
    """(3,) m ahead, left and up of the middle of the scanners from the trajectory."""
    return np.mean([np.median(mounting.lever, axis=0) for mounting in mountings], axis=0)


# The numbers by which a survey is told to fit itself, each with where it comes from.
#
# source: a standard or the law; derived: follows from another number or from how the thing is built; weight: our own estimate, rounded, with what
# it stands for beside it; cost: decides how long the work takes, not what it says

# Vehicles
HALF_VEHICLE = 1.275     # source: m; no vehicle on the road is wider than 2.55 m (Directive 96/53/EC), so no scanner rides farther beside its middle
VEHICLE_HEIGHT = 4.0     # source: m (the same), so no scanner rides farther above or below a trajectory that is on the vehicle

# Points from which places of scanners are found
PLACES_READ = 12         # cost: places in the files that are looked at, and
PLACE_WINDOWS = 5        # cost: windows that points are read of at a place; the first and the last of them are not whole
PLACE_GAP = 0.5          # derived: s between windows, from which they are of another place, as PLACE_WINDOWS take less
PLACE_POINTS = 50_000    # cost: that are read at a place, at most
MIN_TURNS_POINTS, MAX_TURNS_POINTS = 60, 200   # weight: of a window, with which four unknowns are found well; cost: those that are used

# What one move of a trajectory may leave

# Where heights are in another unit or upside down, curbs are looked for at heights that they do not have. Their edges are then drawn along
# another line of the curb: its top, the back of its stone, the rim of its gutter. Nothing in such a survey says which, so that any place within
# the stone (15 cm: DIN 483, HB 15 × 30) and its gutter (30 cm are usual) is as likely
SIGMA_OF_OTHER_HEIGHTS = (0.15 + 0.30) / 12.0**0.5   # derived: m

# Scanners against each other
# cost: windows of the survey in which scanners are looked at, and measured, as an error of a mounting is the same in all
LOOK_WINDOWS, SCANNER_WINDOWS = 3, 16
# derived: m ahead, left and up that scanners may differ by without a move, as passes may; along lines nothing is drawn sharply
MAX_SCANNER_OFFSETS = 2 * ADJUST.agreement_plan, ADJUST.agreement_plan, ADJUST.agreement_plan / 2
SIGNIFICANT = 3.0        # derived: sigma; of a normal error one in 370 is larger
