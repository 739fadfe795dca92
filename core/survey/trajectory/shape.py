"""Whether a trajectory can be the way of a vehicle: as smooth as one drives, and with vertices as near to each other as its bends need.

Between two vertices the vehicle is taken to be on the straight line between them. In a bend of radius R it was off it by up to the sagitta
L²/8R of vertices L apart; at each vertex the line turns by about L/R, so the sagitta is L/8 times that turn. A spline through the vertices
passes such bends; how far it is off shows where every second vertex is left out, and falls with the fourth power of the spacing (de Boor, A
Practical Guide to Splines, ch. V). Every number below has where it comes from: see adjustment/trajectory_fit.py.

Positions of a receiver that nobody filtered scatter from row to row by more than any vehicle shakes. A cubic over a second follows the vehicle
to centimetres (see `vehicle_jerk`), so what is left beyond that is the noise.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from ...curves.robust import MAD_TO_SIGMA
from ..weights import TRAJECTORY
from .trajectory import Trajectory
from .unnamed_columns import angle_between

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
    jump, said = _jump(smooth.trajectory)
    curved = _curved_track(smooth.trajectory)
    return _TrackShape(curved.trajectory, float(np.linalg.norm([smooth.sigma, jump, curved.sigma])), smooth.said + said + curved.said)


def _jump(trajectory: Trajectory) -> tuple[float, tuple[str, ...]]:
    """m that a trajectory jumps to the side or up from one row to the next, at most, and the warning; 0 and none where a vehicle can have driven it."""
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
    return worst[0], (f"The trajectory jumps by {worst[0]:.2f} m at {trajectory.time[k]:.1f} s (near x {trajectory.x[k]:.0f}, y {trajectory.y[k]:.0f}), "
                      "as no vehicle moves: two solutions seem to be joined there. Export all of the drive from one solution.",)


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
