"""Where the vehicle was: the cleaned trajectory."""

from dataclasses import dataclass, field, replace

import numpy as np

from ...common.errors import RoadExtractionError
from .time_systems import unwrap_time

FASTEST = 70.0  # m/s that a survey vehicle may drive
FAR_FROM_ZERO = 1000.0  # m from the origin of the coordinates beyond which no drive passes it


@dataclass(frozen=True)
class Trajectory:
    """Positions of the vehicle in driving order.

    Attributes
    ----------
    time : (N,) seconds, strictly increasing; the running number where the source has no time
    x, y, z : (N,) map coordinates, metres
    roll, pitch, heading : (N,) degrees (heading clockwise from grid north), NaN where unknown
    crs : WKT or ""
    has_time : False where the source gave no time
    """

    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    roll: np.ndarray = None
    pitch: np.ndarray = None
    heading: np.ndarray = None
    crs: str = ""
    has_time: bool = True
    notes: tuple = field(default=())

    def __post_init__(self):
        for name in ("roll", "pitch", "heading"):
            if getattr(self, name) is None:
                object.__setattr__(self, name, np.full(len(self.time), np.nan))

    def __len__(self):
        return len(self.time)

    def rows(self, which):
        """The trajectory of a mask, slice or index array."""
        return replace(self, **{name: getattr(self, name)[which]
                                for name in ("time", "x", "y", "z", "roll", "pitch", "heading")})

    def attitude(self):
        """(3, N) roll, pitch and heading in radians, the heading without leaps; unknown roll and pitch as 0. None without heading."""
        if not np.isfinite(self.heading).all():
            return None
        return np.stack([np.radians(np.nan_to_num(self.roll)), np.radians(np.nan_to_num(self.pitch)), np.unwrap(np.radians(self.heading))])

    def shifted(self, seconds):
        """The same drive with another zero of time, carried on where its count starts again."""
        return replace(self, time=unwrap_time(self.time) + seconds)


def clean_trajectory(trajectory):
    """Sort by time, drop rows without a position and repeated times, and say what was done.

    Standstills stay (time goes on while the vehicle waits); they only vanish
    from the road's reference line, which is thinned by distance.

    Raises
    ------
    RoadExtractionError
        If fewer than two different positions remain, or they are in degrees.
    """
    notes = list(trajectory.notes)
    _refuse_degrees(trajectory)
    carried = unwrap_time(trajectory.time)
    if carried is not trajectory.time and (carried != trajectory.time)[np.isfinite(carried)].any():
        notes.append("The trajectory's time starts again from zero during the drive; it was carried on.")
        trajectory = replace(trajectory, time=carried)
    good = np.isfinite(trajectory.time) & np.isfinite(trajectory.x) & np.isfinite(trajectory.y) & np.isfinite(trajectory.z)
    good &= ~_zero_rows(trajectory, good)
    if not good.all():
        notes.append(f"{np.count_nonzero(~good)} of {len(good)} trajectory rows had no usable time or position and were dropped.")
        trajectory = trajectory.rows(good)
    if (np.diff(trajectory.time) < 0).any():
        notes.append("The trajectory was not in order of time; it was sorted.")
        trajectory = trajectory.rows(np.lexsort((trajectory.y, trajectory.x, trajectory.time)))
    repeated = np.r_[False, np.diff(trajectory.time) <= 0]
    if repeated.any():
        notes.append(f"{np.count_nonzero(repeated)} trajectory rows repeated an earlier time and were dropped.")
        trajectory = trajectory.rows(~repeated)
    jumps = _stray_rows(trajectory)
    if jumps.any():
        notes.append(f"{np.count_nonzero(jumps)} trajectory rows lay aside of the drive, farther than a vehicle gets, and were dropped.")
        trajectory = trajectory.rows(~jumps)
    length = float(np.hypot(np.diff(trajectory.x), np.diff(trajectory.y)).sum()) if len(trajectory) > 1 else 0.0
    if len(trajectory) < 2 or length < 1.0:
        raise RoadExtractionError(
            f"The trajectory has {len(trajectory)} usable positions over {length:.1f} m. At least two positions and "
            "1 m of driving are needed; check the time and coordinate columns of the file.")
    return replace(trajectory, notes=tuple(notes))


def _zero_rows(trajectory, good):
    """Mask of rows at exactly (0, 0) where no other usable row is near: how receivers write that they had no position."""
    zero = (trajectory.x == 0) & (trajectory.y == 0)
    away = np.hypot(trajectory.x[good & ~zero], trajectory.y[good & ~zero])
    return zero & bool(len(away) and away.min() > FAR_FROM_ZERO)


def _stray_rows(trajectory):
    """Mask of single rows that no vehicle could reach from the row before nor leave for the row after."""
    stray = np.zeros(len(trajectory), bool)
    if len(trajectory) < 3 or not trajectory.has_time:
        return stray
    seconds, dx, dy = (np.diff(a) for a in (trajectory.time, trajectory.x, trajectory.y))
    step = np.hypot(dx, dy)
    leap = (step > FASTEST * seconds) & (step > 2.0)
    on = np.hypot(dx[:-1] + dx[1:], dy[:-1] + dy[1:]) <= FASTEST * (seconds[:-1] + seconds[1:])
    stray[1:-1] = leap[:-1] & leap[1:] & on
    return stray


def _refuse_degrees(trajectory):
    from ...io.crs import horizontal_part, parse_crs

    crs = parse_crs(trajectory.crs)
    if crs is not None and horizontal_part(crs).is_geographic:
        raise RoadExtractionError(
            f"The trajectory is in {horizontal_part(crs).name} (degrees) and it is not known what to bring it to: the point cloud "
            "carries no CRS. Give the projected CRS of the survey, or run Import trajectory with it as the target.")
