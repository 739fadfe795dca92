"""Where the vehicle was: the cleaned trajectory."""

from dataclasses import dataclass, field, replace

import numpy as np

from ..errors import RoadExtractionError
from .time_systems import unwrap_time


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
    length = float(np.hypot(np.diff(trajectory.x), np.diff(trajectory.y)).sum()) if len(trajectory) > 1 else 0.0
    if len(trajectory) < 2 or length < 1.0:
        raise RoadExtractionError(
            f"The trajectory has {len(trajectory)} usable positions over {length:.1f} m. At least two positions and "
            "1 m of driving are needed; check the time and coordinate columns of the file.")
    return replace(trajectory, notes=tuple(notes))


def _refuse_degrees(trajectory):
    from .crs import horizontal, parse_crs

    crs = parse_crs(trajectory.crs)
    if crs is not None and horizontal(crs).is_geographic:
        raise RoadExtractionError(
            f"The trajectory is in {horizontal(crs).name} (degrees) and it is not known what to bring it to: the point cloud "
            "carries no CRS. Give the projected CRS of the survey, or run Import trajectory with it as the target.")
