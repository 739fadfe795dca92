"""The trajectory: where the vehicle was, and its cleaning."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from ...common.errors import RoadExtractionError
from ...curves.robust import MAD_TO_SIGMA
from ...io.crs import FOOT, check_metric, horizontal_part, in_metres, parse_crs, plane_wkt, same_crs
from ...lazy import pyproj
from ..weights import TRAJECTORY
from .columns import angle_between
from .time_systems import unwrap_time


@dataclass(frozen=True)
class Trajectory:
    """Positions of the vehicle in driving order.

    roll, pitch, heading : (N,) degrees (heading clockwise from grid north), NaN where unknown, which is the default
    stated_units : (role, unit) of x, y and z as their columns state them, while the CRS, and with it the units of the others, is unknown
    """

    time: np.ndarray   # (N,) seconds, strictly increasing once cleaned; the index of the position where the source has no time
    x: np.ndarray   # x, y, z: (N,) map coordinates, metres
    y: np.ndarray
    z: np.ndarray
    roll: np.ndarray = None  # type: ignore[assignment]  # filled with NaN on construction
    pitch: np.ndarray = None  # type: ignore[assignment]
    heading: np.ndarray = None  # type: ignore[assignment]
    crs: str = ""   # WKT, "" where unknown
    has_time: bool = True   # False where the source has no time
    notes: tuple[str, ...] = field(default=())   # sentences for the user about what was recognised and changed
    sigma_across: float = 0.0   # m, one sigma across the way as its processing tells; 0 where unknown
    stated_units: tuple[tuple[str, str], ...] = ()
    doubts: tuple[str, ...] = ()   # those that are warnings
    way_known: bool = True   # False where the order of the positions is not known to be that of the drive

    def __post_init__(self) -> None:
        for name in ("roll", "pitch", "heading"):
            if getattr(self, name) is None:
                object.__setattr__(self, name, np.full(len(self.time), np.nan))

    def __len__(self) -> int:
        return len(self.time)

    def rows(self, which: Any) -> Trajectory:
        """The positions of a mask, slice or index array."""
        return replace(self, **{name: getattr(self, name)[which] for name in ("time", "x", "y", "z", "roll", "pitch", "heading")})

    def attitude(self) -> np.ndarray | None:
        """(3, N) roll, pitch and heading in radians, the heading unwrapped, unknown roll and pitch as 0; None where a heading is unknown."""
        if not np.isfinite(self.heading).all():
            return None
        return np.stack([np.radians(np.nan_to_num(self.roll)), np.radians(np.nan_to_num(self.pitch)), np.unwrap(np.radians(self.heading))])

    def shifted(self, seconds: float) -> Trajectory:
        """The same drive with `seconds` added to its time, which is unwrapped first (`unwrap_time`)."""
        return replace(self, time=unwrap_time(self.time) + seconds)


def clean_trajectory(trajectory: Trajectory) -> Trajectory:
    """The trajectory sorted by time, without repeated times, outliers and rows that have no position; its notes say what was changed.

    Standstills remain, since time goes on while the vehicle waits; the road's reference line, which is sampled by distance, does not contain them.

    Raises RoadExtractionError if fewer than two different positions remain, they are in degrees, or there are two drives at the same time.
    """
    notes = list(trajectory.notes)
    _refuse_degrees(trajectory)
    unwrapped = unwrap_time(trajectory.time)
    if unwrapped is not trajectory.time and (unwrapped != trajectory.time)[np.isfinite(unwrapped)].any():
        notes.append("The trajectory's time starts again from zero during the drive; it was continued.")
        trajectory = replace(trajectory, time=unwrapped)
    good = np.isfinite(trajectory.time) & np.isfinite(trajectory.x) & np.isfinite(trajectory.y) & np.isfinite(trajectory.z)
    good &= ~_zero_rows(trajectory, good)
    rows = np.flatnonzero(good)   # of the source, to be named
    if not good.all():
        notes.append(f"{np.count_nonzero(~good)} of {len(good)} trajectory rows had no usable time or position and were dropped.")
        trajectory = trajectory.rows(good)
    if (np.diff(trajectory.time) < 0).any():
        notes.append("The trajectory was not in order of time; it was sorted.")
        order = np.lexsort((trajectory.y, trajectory.x, trajectory.time))
        trajectory, rows = trajectory.rows(order), rows[order]
    _refuse_two_drives(trajectory, rows)
    repeated = np.r_[False, np.diff(trajectory.time) <= 0]
    if repeated.any():
        _refuse_coarse_times(trajectory, repeated)
        notes.append(f"{np.count_nonzero(repeated)} trajectory rows repeated an earlier time and were dropped.")
        trajectory = trajectory.rows(~repeated)
    jumps = _outlier_rows(trajectory)
    if jumps.any():
        notes.append(f"{np.count_nonzero(jumps)} trajectory rows lay farther from the drive than a vehicle can get, and were dropped.")
        trajectory = trajectory.rows(~jumps)
    refuse_standstill(trajectory)
    step = np.hypot(np.diff(trajectory.x), np.diff(trajectory.y))
    if not trajectory.has_time and step.max() > TRAJECTORY.longest_step:
        raise RoadExtractionError(f"The trajectory has no time and leaps {step.max() / 1000:,.0f} km from one position to the next. Give each drive "
                                  "by itself.")
    return replace(trajectory, notes=tuple(notes))


def refuse_standstill(trajectory: Trajectory) -> None:
    """Raise RoadExtractionError where fewer than two positions are given, or they are less than a metre of driving."""
    usable = np.isfinite(trajectory.x) & np.isfinite(trajectory.y)
    x, y = trajectory.x[usable], trajectory.y[usable]
    length = float(np.hypot(np.diff(x), np.diff(y)).sum())
    if len(x) < 2 or length < 1.0:
        raise RoadExtractionError(f"The trajectory has {len(x)} usable position(s) over {length:.1f} m. At least two positions and 1 m of driving "
                                  "are needed; check the time and coordinate columns of the file.")


def _refuse_two_drives(trajectory, rows):
    """Refuse positions, sorted by time, of which many are at once at two places."""
    steps = np.hypot(np.diff(trajectory.x), np.diff(trajectory.y))
    at_once = np.r_[False, (np.diff(trajectory.time) <= 0) & (steps > TRAJECTORY.min_position_jump)] | _outlier_rows(trajectory)
    if not trajectory.has_time or at_once.sum() <= max(TRAJECTORY.most_outliers[0], TRAJECTORY.most_outliers[1] * len(rows)):
        return
    second = int(np.argmax(at_once))
    first = second - 1
    raise RoadExtractionError(
        f"The trajectory is at two places at once: row {rows[first] + 1} at {trajectory.time[first]:.3f} s and row {rows[second] + 1} at "
        f"{trajectory.time[second]:.3f} s lie {steps[first]:.0f} m apart, as do {at_once.sum():,} of {len(rows):,}. Give each drive by itself.")


def _refuse_coarse_times(trajectory, repeated):
    """Refuse positions, sorted by time, far from each other at one time; `repeated` : (N,) bool, whose time is that of the row before."""
    first = np.flatnonzero(~repeated)
    steps = np.r_[0.0, np.hypot(np.diff(trajectory.x), np.diff(trajectory.y))]
    driven = np.add.reduceat(np.where(repeated, steps, 0.0), first)
    k = int(driven.argmax())
    if trajectory.has_time and driven[k] > TRAJECTORY.most_at_once:
        raise RoadExtractionError(f"The trajectory drives {driven[k]:.0f} m at one time, {trajectory.time[first[k]]:.3f} s: its times have too few "
                                  "digits, as programs with 32-bit numbers save them. Export them with three decimals or more.")


def _zero_rows(trajectory, good):
    """(N,) bool: rows at exactly (0, 0), as receivers write a missing position, unless other usable rows are near."""
    zero = (trajectory.x == 0) & (trajectory.y == 0)
    distance = np.hypot(trajectory.x[good & ~zero], trajectory.y[good & ~zero])
    return zero & bool(len(distance) and distance.min() > TRAJECTORY.min_origin_distance)


def _outlier_rows(trajectory):
    """(N,) bool: single rows that a vehicle could neither reach from the row before nor leave for the row after; without time, far ones."""
    outlier = np.zeros(len(trajectory), bool)
    if len(trajectory) < 3:
        return outlier
    if not trajectory.has_time:
        far = np.hypot(np.diff(trajectory.x), np.diff(trajectory.y)) > TRAJECTORY.longest_step
        outlier[1:-1] = far[:-1] & far[1:]
        outlier[[0, -1]] = far[0] and not far[1], far[-1] and not far[-2]
        return outlier
    seconds, dx, dy = (np.diff(a) for a in (trajectory.time, trajectory.x, trajectory.y))
    step = np.hypot(dx, dy)
    jump = (step > TRAJECTORY.max_vehicle_speed * seconds) & (step > TRAJECTORY.min_position_jump)
    reachable = np.hypot(dx[:-1] + dx[1:], dy[:-1] + dy[1:]) <= TRAJECTORY.max_vehicle_speed * (seconds[:-1] + seconds[1:])
    outlier[1:-1] = jump[:-1] & jump[1:] & reachable
    return outlier


def _refuse_degrees(trajectory):
    crs = parse_crs(trajectory.crs)
    if crs is not None and horizontal_part(crs).is_geographic:
        raise RoadExtractionError(f"The trajectory is in {horizontal_part(crs).name} (degrees), and the point cloud carries no CRS. Give the "
                                  "projected CRS of the survey.")


# A trajectory in another coordinate reference system.


def reproject_trajectory(trajectory: Trajectory, target_wkt: str) -> Trajectory:
    """The trajectory in another CRS, WKT or "EPSG:n": its positions, and its heading from the target's grid north.

    It is unchanged where its CRS or the target is unknown. Heights stay as they are; whether they are ellipsoidal or orthometric is absorbed by the
    estimated height of the sensor.

    Raises RoadExtractionError if the target is not projected, the source is of a kind that has no map coordinates, units contradict the CRS, or
    positions cannot be brought to the target.
    """
    if not trajectory.crs:
        return taken_to_be_in(trajectory, target_wkt)
    target_wkt = in_metres(target_wkt)[0]
    source, target = parse_crs(trajectory.crs), parse_crs(target_wkt)
    if target is None:
        return trajectory
    if same_crs(source, target):
        return replace(trajectory, crs=target.to_wkt())
    check_metric(target, "The target of the trajectory")
    if not horizontal_part(source).is_geographic:
        check_metric(source, "The trajectory")
    target_wkt = plane_wkt(target_wkt)
    source, target = (horizontal_part(crs) for crs in (source, parse_crs(target_wkt)))
    try:
        transformer = pyproj.Transformer.from_crs(source, target, always_xy=True)
        x, y = transformer.transform(trajectory.x, trajectory.y)
        finite = np.isfinite(trajectory.x) & np.isfinite(trajectory.y)
        if not (np.isfinite(x[finite]) & np.isfinite(y[finite])).all():
            raise pyproj.exceptions.ProjError("some positions lie where the projection is not defined")
    except pyproj.exceptions.ProjError as problem:
        raise RoadExtractionError(
            f"The trajectory is in {source.name} and cannot be brought to {target.name} ({problem}). Check the CRS of the trajectory"
            f"{', and that its longitude and latitude are not exchanged' if source.is_geographic else ''}.") from problem
    x, y = np.where(finite, x, np.nan), np.where(finite, y, np.nan)
    heading = _reproject_heading(trajectory, source, transformer, x, y)
    note = f"The trajectory was reprojected from {source.name} to {target.name}."
    return replace(trajectory, x=x, y=y, heading=heading, crs=target_wkt, notes=(*trajectory.notes, note))


def taken_to_be_in(trajectory: Trajectory, wkt: str) -> Trajectory:
    """A trajectory without a CRS, its coordinates taken to be those of another file's CRS; it is unchanged where they are in metres.

    RoadExtractionError if its columns say feet, and the CRS does not.
    """
    crs, (x, y, z), left = lengths_in_metres(wkt, (trajectory.x, trajectory.y, trajectory.z), trajectory.stated_units, "The trajectory")
    if "feet" in dict(left).values():
        raise RoadExtractionError("The trajectory gives positions in feet, and neither it nor the point cloud carries a CRS. Give the CRS in feet "
                                  "that they are in.")
    moved = x is not trajectory.x or z is not trajectory.z
    return replace(trajectory, x=x, y=y, z=z, crs=crs, stated_units=()) if moved else replace(trajectory, stated_units=())


def lengths_in_metres(crs: str, places: tuple[np.ndarray, np.ndarray, np.ndarray], stated: Sequence[tuple[str, str]],
                      label: str) -> tuple[str, tuple[np.ndarray, ...], Sequence[tuple[str, str]]]:
    """Coordinates of a trajectory in metres: the WKT of their metric CRS, x, y and z, and what is still to be looked at once the CRS is known.

    crs : WKT, "" where unknown: then they stay as they were; places : x, y and z, (N,) each, in its units, or where `stated` says one, in that
    stated : (role, "feet" or "metres") of x, y and z. RoadExtractionError if x or y are stated in feet, and the CRS is in another unit.
    """
    units_by_role = dict(stated)
    if not crs:
        return crs, places, stated
    wkt, units = in_metres(crs)
    factors = []
    for role, unit in (("x", units.across), ("y", units.across), ("z", units.up)):
        if units_by_role.get(role) == "feet" and unit == 1.0:
            if role != "z":
                raise RoadExtractionError(f"{label} gives positions in feet, and its CRS {horizontal_part(parse_crs(crs)).name} is not in feet. "
                                          "Give the CRS in feet that they are in: Import trajectory takes it.")
            unit = FOOT   # which one is not said; they differ by 2 mm in a kilometre of height
        factors.append(1.0 if units_by_role.get(role) == "metres" else unit)
    return wkt, tuple(values if factor == 1.0 else values * factor for values, factor in zip(places, factors)), ()


def _reproject_heading(trajectory, source, transformer, x, y):
    """Headings from the target's grid north: of each position, a point `heading_step` ahead is reprojected too."""
    finite = np.isfinite(trajectory.heading) & np.isfinite(x)
    heading = np.full(len(x), np.nan)
    if not finite.any():
        return heading
    x0, y0, ahead = (values[finite] for values in (trajectory.x, trajectory.y, trajectory.heading))
    if source.is_geographic:
        further = source.get_geod().fwd(x0, y0, ahead, np.full(len(x0), TRAJECTORY.heading_step))[:2]
    else:
        further = x0 + TRAJECTORY.heading_step * np.sin(np.radians(ahead)), y0 + TRAJECTORY.heading_step * np.cos(np.radians(ahead))
    to_x, to_y = transformer.transform(*further)
    heading[finite] = np.degrees(np.arctan2(to_x - x[finite], to_y - y[finite])) % 360.0
    return heading


# Whether a trajectory can be the way of a vehicle: as smooth as one drives, and with vertices as near to each other as its bends need.
#
# Between two vertices the vehicle is taken to be on the straight line between them. In a bend of radius R it was off it by up to the sagitta
# L²/8R of vertices L apart; at each vertex the line turns by about L/R, so the sagitta is L/8 times that turn. A spline through the vertices
# passes such bends; how far it is off shows where every second vertex is left out, and falls with the fourth power of the spacing (de Boor, A
# Practical Guide to Splines, ch. V). Every number below has where it comes from: see adjustment/trajectory_fit.py.
#
# Positions of a receiver that nobody filtered scatter from row to row by more than any vehicle shakes. A cubic over a second follows the vehicle
# to centimetres (see `vehicle_jerk`), so what is left beyond that is the noise.

LEFT_SAGITTA = TRAJECTORY.max_sagitta / 5   # derived: m that the curved trajectory still misses, which is nothing beside what is tolerated
LEAST_RADIUS = 6.4      # source: m of the middle of a car that turns as sharply as it can (AASHTO, design vehicle P, 21 ft)
MIN_SPACING = float(np.sqrt(8 * LEAST_RADIUS * TRAJECTORY.max_sagitta))   # derived: m between vertices that miss such a bend by that
SHARPEST_TURN = np.radians(90.0) / 2   # derived: from vertex to vertex; every second one, which tells the error, then turns by a right angle
SPLINE_ORDER_SHARE = 1.0 / 16.0   # derived: of the error with every second vertex that is left with all, (1/2)^4
MIN_CUBIC_ROWS = 7      # derived: in `noise_time`; a cubic through four of them leaves three to tell the noise by
# derived: m, root mean square of a motion with that jerk that turns once in `noise_time`; a cubic over that time leaves most of it
MAX_NOISE = float(TRAJECTORY.vehicle_jerk * (TRAJECTORY.noise_time / (2 * np.pi)) ** 3 / np.sqrt(2.0))


@dataclass(frozen=True)
class _TrackShape:
    """A trajectory with curved bends, or smoothed; one sigma of its place that stays unknown for that (m), and the warnings."""

    trajectory: Trajectory
    sigma: float = 0.0
    said: tuple[str, ...] = ()


def shaped_trajectory(trajectory: Trajectory) -> _TrackShape:
    """A cleaned trajectory without noise that no vehicle can have caused, and with curves where its vertices are too far apart for its bends."""
    smooth = _smoothed_track(trajectory)
    jump, warnings = _jump(smooth.trajectory)
    curved = _curved_track(smooth.trajectory)
    return _TrackShape(curved.trajectory, float(np.linalg.norm([smooth.sigma, jump, curved.sigma])), smooth.said + warnings + curved.said)


def _jump(trajectory: Trajectory) -> tuple[float, tuple[str, ...]]:
    """m that a trajectory jumps to the side or up from one row to the next, at most, and the warning; 0 and none where vehicles can drive so."""
    worst = 0.0, 0
    for piece in _pieces(trajectory) if trajectory.has_time else ():
        time, place = trajectory.time[piece], np.stack([getattr(trajectory, name)[piece] for name in "xyz"], axis=1)
        if len(time) < 4 * MIN_CUBIC_ROWS:
            continue
        step = np.diff(time)
        speed = np.diff(place, axis=0) / step[:, None]
        usual = (speed[2:] + speed[:-2]) / 2
        way = usual / np.maximum(np.linalg.norm(usual, axis=1), 1e-9)[:, None]
        off = speed[1:-1] - usual
        off -= (off * way).sum(axis=1)[:, None] * way   # along it times may be rounded
        metres = np.linalg.norm(off, axis=1) * step[1:-1]
        k = int(np.argmax(metres))
        noise = _noise(trajectory, piece) if _even(time) else 0.0
        if metres[k] > max(worst[0], TRAJECTORY.least_jump, TRAJECTORY.jump_noise * noise, TRAJECTORY.jump_acceleration * step[k + 1] ** 2):
            worst = float(metres[k]), piece.start + k + 1
    if not worst[0]:
        return 0.0, ()
    k = worst[1]
    place = f"x {trajectory.x[k]:.0f}, y {trajectory.y[k]:.0f}"
    return worst[0], (f"The trajectory jumps by {worst[0]:.2f} m at {trajectory.time[k]:.1f} s (near {place}), as no vehicle moves: two solutions "
                      "seem to be joined there. Export all of the drive from one solution.",)


def _smoothed_track(trajectory: Trajectory) -> _TrackShape:
    """A trajectory without the noise that no vehicle can have caused; as it is where there is none."""
    if not trajectory.has_time:
        return _TrackShape(trajectory)
    pieces = [piece for piece in _pieces(trajectory) if _even(trajectory.time[piece])]
    noisy = [(piece, noise) for piece in pieces if (noise := _noise(trajectory, piece)) > MAX_NOISE]
    if not noisy:
        return _TrackShape(trajectory)
    columns = {name: getattr(trajectory, name).copy() for name in "xyz"}
    left = max(noise * _smooth(columns, piece, _step(trajectory.time[piece])) for piece, noise in noisy)
    rows = sum(piece.stop - piece.start for piece, _ in noisy)
    worst, share = max(noise for _, noise in noisy), 100.0 * rows / len(trajectory)
    first = trajectory.time[noisy[0][0].start]
    return _TrackShape(
        replace(trajectory, **columns), left,
        (f"The positions of the trajectory scatter by {100 * worst:.0f} cm from row to row ({share:.0f} % of the rows, from {first:.1f} s on). They "
         f"were smoothed, which leaves {100 * left:.1f} cm. Give the trajectory adjusted with the inertial unit.",))


def _smooth(columns, piece, step):
    """Smooth a piece of columns in place, with rows so many seconds apart; the share of the noise that is left."""
    from scipy.signal import savgol_filter  # slow to load, and noisy trajectories alone use it

    rows = min(_odd(TRAJECTORY.smooth_time / step), _odd(piece.stop - piece.start - 1))
    for values in columns.values():
        values[piece] = savgol_filter(values[piece], rows, 3)
    return float(np.sqrt(_cubic_weights(rows).max()))


def _curved_track(trajectory: Trajectory) -> _TrackShape:
    """A trajectory with curves through its vertices where they are too far apart for its bends; as it is where they are not."""
    pieces, worst, sigma, unsafe = [], (0.0, 0.0, 0), 0.0, 0
    for piece in _pieces(trajectory):
        rows = trajectory.rows(piece)
        pieces.append(rows)
        sagitta, turn, length = _sagittas(rows)
        far = (sagitta > TRAJECTORY.max_sagitta) & (length > MIN_SPACING)
        if not far.any():
            continue
        k = int(np.argmax(np.where(far, sagitta, 0.0)))
        worst = max(worst, (float(sagitta[k]), float(length[k]), piece.start + k))
        sharp = far & (turn > SHARPEST_TURN)
        unsafe += np.count_nonzero(sharp)
        pieces[-1], off = _through(rows, np.where(far, np.ceil(np.sqrt(sagitta / LEFT_SAGITTA)), 1).astype(int))
        sigma = max(sigma, off, float(sagitta[sharp].max(initial=0.0)) / 2)
    if not worst[0]:
        return _TrackShape(trajectory)
    names = ("time", "x", "y", "z", "roll", "pitch", "heading")
    joined = replace(trajectory, **{name: np.concatenate([getattr(rows, name) for rows in pieces]) for name in names})
    position = f"x {trajectory.x[worst[2]]:.0f}, y {trajectory.y[worst[2]]:.0f}"
    note = "Curves were laid through them" + (f", which is a guess in {unsafe} sharp turns" if unsafe else "")
    return _TrackShape(
        joined, sigma,
        (f"The vertices of the trajectory lie up to {worst[1]:.0f} m apart in bends, which lines between them miss by {worst[0]:.2f} m (near "
         f"{position}). {note}, which leaves {max(100 * sigma, 1):.0f} cm. Export ten positions a second.",))


def _pieces(trajectory):
    """Slices of the rows between gaps of time."""
    step = np.diff(trajectory.time)
    if not trajectory.has_time or not len(step):
        return [slice(0, len(trajectory))]
    cuts = np.flatnonzero(step > max(TRAJECTORY.gap_factor * np.median(step), TRAJECTORY.shortest_pause)) + 1
    return [slice(i, j) for i, j in zip([0, *cuts.tolist()], [*cuts.tolist(), len(trajectory)])]


def _step(time):
    return float(np.median(np.diff(time)))


def _odd(rows):
    return int(rows) // 2 * 2 + 1


def _even(time):
    """Whether times follow each other evenly, and so often that a cubic over `noise_time` can be told from noise."""
    if len(time) < 4 * MIN_CUBIC_ROWS:
        return False
    step = np.diff(time)
    usual = _step(time)
    return _odd(TRAJECTORY.noise_time / usual) >= MIN_CUBIC_ROWS and float(np.quantile(np.abs(step - usual), 0.95)) <= TRAJECTORY.even_steps * usual


def _cubic_weights(rows):
    """(rows,) weights by which the cubic through so many even rows gives its value in the middle (Savitzky & Golay 1964).

    That of the middle is the largest, and the share of the variance of a row's noise that is left there.
    """
    half = rows // 2
    offset = np.arange(-half, half + 1.0)
    return 3.0 * (3 * half**2 + 3 * half - 1 - 5 * offset**2) / ((2 * half - 1) * (2 * half + 1) * (2 * half + 3))


def _noise(trajectory, piece):
    """m, one sigma of a position of a piece along one axis on the map, against a cubic over `noise_time`."""
    rows = min(_odd(TRAJECTORY.noise_time / _step(trajectory.time[piece])), _odd(piece.stop - piece.start - 1))
    weights, inner = _cubic_weights(rows), slice(rows // 2, -(rows // 2))
    off = [values[inner] - np.convolve(values, weights, "valid") for values in (getattr(trajectory, name)[piece] for name in "xy")]
    return MAD_TO_SIGMA * float(np.median(np.abs(off))) / np.sqrt(1.0 - weights.max())


def _sagittas(rows):
    """(N - 1,) m by which a straight line to the next vertex misses the bend, the turn at its ends (radians), and its length (m)."""
    dx, dy = np.diff(rows.x), np.diff(rows.y)
    length = np.hypot(dx, dy)
    if len(length) < 2:
        return np.zeros(len(length)), np.zeros(len(length)), length
    way = np.arctan2(dy, dx)
    turn = np.abs((np.diff(way) + np.pi) % (2 * np.pi) - np.pi)
    # at an end, or where one side hardly moves, the other side's turn tells it; the smaller of two is that of the bend, not of one corner
    ends = np.r_[np.inf, turn], np.r_[turn, np.inf]
    bend = np.minimum(*ends)
    # bends begin and end between vertices: a turn at one end alone is half of a bend
    bend = np.maximum(bend, 0.5 * np.maximum(*(np.where(np.isfinite(end), end, 0.0) for end in ends)))
    return length * bend / 8.0, bend, length


def _through(rows, parts):
    """The trajectory with so many parts between each two vertices on a spline through all, and m that the spline may be off."""
    share = np.concatenate([k + np.arange(n) / n for k, n in enumerate(parts.tolist())] + [[len(rows) - 1.0]])
    vertices = np.arange(len(rows), dtype=float)
    knots = rows.time if rows.has_time else np.r_[0.0, np.cumsum(np.hypot(np.diff(rows.x), np.diff(rows.y)))]
    time = np.interp(share, vertices, knots)
    heading = np.degrees(np.unwrap(np.radians(rows.heading)))
    new = {name: np.interp(time, knots, getattr(rows, name)) for name in ("roll", "pitch")}
    new.update(time=np.interp(share, vertices, rows.time), heading=np.interp(time, knots, heading) % 360.0, z=CubicSpline(knots, rows.z)(time))
    new["x"], new["y"] = _plan(knots, rows)(time).T
    half = np.unique(np.r_[np.arange(0, len(rows), 2), len(rows) - 1])
    bend = _sagittas(rows)[0].max() / 2
    if len(half) == len(rows) or len(half) < 3:
        return replace(rows, **new), float(bend)
    off = np.hypot(*(_plan(knots[half], rows.rows(half))(knots) - np.c_[rows.x, rows.y]).T)
    return replace(rows, **new), float(min(SPLINE_ORDER_SHARE * off.max(), bend))


def _plan(knots, rows):
    """The spline through the positions on the map; in the directions of the headings where there are any."""
    places = np.c_[rows.x, rows.y]
    free = CubicSpline(knots, places)
    velocity, yaw = free(knots, 1), np.radians(90.0 - rows.heading)
    off = angle_between(90.0 - np.degrees(np.arctan2(velocity[:, 1], velocity[:, 0])), rows.heading)
    if not (off < TRAJECTORY.heading_tolerance).all():
        return free
    return CubicHermiteSpline(knots, places, np.hypot(*velocity.T)[:, None] * np.c_[np.cos(yaw), np.sin(yaw)])
