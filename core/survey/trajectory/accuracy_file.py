"""The accuracy of a trajectory as Applanix POSPac writes it beside an SBET: smrmsg_MISSION.out for sbet_MISSION.out."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

SMRMSG_DOUBLES = 10   # time, RMS north, east, down (m), of three velocities (m/s), roll, pitch, heading (arc minutes)
WORST = 100.0         # m: a position that is known worse than this is none, and the file another one


def accuracy_across(sbet: Path, time: np.ndarray, x: np.ndarray, y: np.ndarray) -> tuple[float, str]:
    """One sigma of a trajectory across its way, from the file beside it.

    Parameters
    ----------
    sbet : path of the SBET
    time : (N,) s, as it stands in the SBET
    x, y : (N,) longitude and latitude, degrees

    Returns
    -------
    sigma : m, the root of the mean square over the way driven, so that waiting does not count; 0 where nothing is known
    note : a sentence on it, "" where there is no such file
    """
    try:
        path = _beside(sbet)
        rows = None if path is None else _records(path)
    except OSError:   # what may not be read was not given
        return 0.0, ""
    if path is None:
        return 0.0, ""
    if rows is None or not (rows[0, 0] < time[-1] and time[0] < rows[-1, 0]):
        return 0.0, f"{path.name} is no accuracy file of {sbet.name} and is not used."
    east, north = np.diff(x) * np.cos(np.radians(y[:-1])), np.diff(y)
    step, middle = np.hypot(east, north), (time[1:] + time[:-1]) / 2
    driven = (step > 0) & (middle >= rows[0, 0]) & (middle <= rows[-1, 0])
    if not driven.any():
        return 0.0, f"{path.name} is no accuracy file of {sbet.name} and is not used."
    step, east, north, middle = (values[driven] for values in (step, east, north, middle))
    rms_north, rms_east = (np.interp(middle, rows[:, 0], rows[:, k]) for k in (1, 2))
    # across the way; how the errors in both directions hang together is not in the file
    square = (rms_north * east / step)**2 + (rms_east * north / step)**2
    sigma = float(np.sqrt(np.average(square, weights=step)))
    return sigma, f"{path.name} gives the accuracy of the trajectory: {sigma:.3f} m across, over the way driven."


def _beside(sbet):
    """The accuracy file beside an SBET, by its name; None where there is none."""
    named = re.fullmatch(r"sbet(.*)", sbet.name, re.IGNORECASE)
    wanted = f"smrmsg{named[1]}".lower() if named else ""
    return next((path for path in sorted(sbet.parent.iterdir()) if path.name.lower() == wanted and path.is_file()), None) if wanted else None


def _records(path):
    """(N, 10) float64; None where the file holds something else."""
    data = np.fromfile(path, "<f8")
    rows = data[:len(data) // SMRMSG_DOUBLES * SMRMSG_DOUBLES].reshape(-1, SMRMSG_DOUBLES)
    if len(rows) < 2 or len(data) != rows.size:
        return None
    with np.errstate(invalid="ignore"):
        usable = np.isfinite(rows).all() and (np.diff(rows[:, 0]) > 0).all() and (rows[:, 1:4] >= 0).all() and (rows[:, 1:4] < WORST).all()
    return rows if usable else None
