"""The systems of GPS time, and the conversion of a trajectory's time to that of the point cloud."""

from __future__ import annotations

import time

import numpy as np

from ...common.errors import RoadExtractionError
from .written_values import LEAP_DAYS, SECONDS_PER_DAY, SECONDS_PER_WEEK, UNIX_EPOCH, leap_seconds

ADJUSTED_OFFSET = 1e9  # s by which adjusted standard GPS time is less than GPS time (ASPRS LAS 1.4)
TIME_SYSTEMS = ("automatic", "gps", "adjusted", "week", "day")
TIME_SYSTEM_NAMES = {"as it is": "the cloud's own seconds", "gps": "GPS seconds since 1980", "adjusted": "adjusted GPS seconds (GPS less 1e9)",
                     "week": "seconds of the week", "day": "seconds of the day"}
TIME_TOLERANCE = 1.0  # s between the ends of the times of cloud and trajectory, which may be rounded
TAI_TO_GPS = 19.0     # source: s by which TAI is ahead of GPS time (IS-GPS-200)
LARGEST_SHIFT = TAI_TO_GPS + len(LEAP_DAYS)   # derived: s between two clocks, TAI and UTC


def unwrap_time(time: np.ndarray) -> np.ndarray:
    """Seconds of the week or day, continued past midnight or the end of the week.

    Parameters
    ----------
    time : (N,) seconds, in driving order

    Returns
    -------
    (N,) float64 seconds; the same values where the count does not start again
    """
    time = np.asarray(time, float)
    known = np.flatnonzero(np.isfinite(time))
    if len(known) < 2:
        return time
    values = time[known]
    step = np.diff(values)
    for period in (SECONDS_PER_WEEK, SECONDS_PER_DAY):
        # A new start from zero is a single step back by nearly the whole period, while time increases otherwise.
        back = step < -0.9 * period
        if back.any() and back.sum() * 20 < len(step) + 20 and values.max() <= period * 1.001 and values.min() >= 0 \
                and (step[~back] >= 0).mean() > 0.95:
            carried = time.copy()
            carried[known] = values + period * np.r_[0.0, np.cumsum(back)]
            return carried
    return time


def wrapped_week(span: tuple[float, float]) -> bool:
    """Whether a cloud's (first, last) gps_time in seconds shows that a GPS week ended during the drive."""
    return 0 <= span[0] and span[1] <= SECONDS_PER_WEEK * 1.001 and span[1] - span[0] > 0.75 * SECONDS_PER_WEEK


def align_time(time: np.ndarray, cloud_span: tuple[float, float], system: str = "automatic", adjusted: bool = True) -> tuple[float, str]:
    """Seconds to add to a trajectory's time to convert it to the cloud's.

    Parameters
    ----------
    time : (N,) seconds of the trajectory, in driving order where the count starts again from zero
    cloud_span : (first, last) gps_time of the cloud, seconds
    system : the time system of the trajectory: "gps" (seconds since 1980), "adjusted"
        (the same minus 1e9), "week", "day", or "automatic"
    adjusted : whether the header of the cloud states adjusted standard GPS time

    Returns
    -------
    offset : seconds
    note : a sentence for the user; "" where nothing was changed and nothing is doubtful

    Raises
    ------
    RoadExtractionError
        If the time system is not known, the trajectory has no times, or cloud and trajectory overlap in no time system.

    Notes
    -----
    Leap seconds are never guessed: where a shift of 18 s (or 17, 37 ...) would
    make the two agree, the note or the message says so, and the user decides.
    """
    if system not in TIME_SYSTEMS:
        raise RoadExtractionError(f"The time system {system!r} is not known; choose one of {', '.join(TIME_SYSTEMS)}.")
    if not np.isfinite(time).any():
        raise RoadExtractionError("The trajectory holds no position with a time. Check the file, or export it again.")
    time = unwrap_time(time)
    first, last = float(np.nanmin(time)), float(np.nanmax(time))
    cloud_first, cloud_last = map(float, cloud_span)
    options = _offsets(first, last, (cloud_first + cloud_last) / 2, system)

    def overlap(offset):
        return min(last + offset, cloud_last) - max(first + offset, cloud_first)

    name, offset = max(options, key=lambda option: (overlap(option[1]) > -TIME_TOLERANCE and option[0] == "as it is", overlap(option[1])))
    hint = _leap_hint(first + offset, last + offset, cloud_first, cloud_last)
    if overlap(offset) <= -TIME_TOLERANCE:
        tried = "One of them may use another time system: set the trajectory's time system (gps, adjusted, week or day) and run again." \
            if system == "automatic" else \
            f"The trajectory was taken to count {TIME_SYSTEM_NAMES[system]}: set its time system to automatic and run again."
        hint = hint or _unix_hint(first, last, cloud_first, cloud_last)
        raise RoadExtractionError(
            f"The trajectory does not cover the scan in time. The scan was recorded from {cloud_first:.1f} s to {cloud_last:.1f} s"
            f"{'' if not adjusted or cloud_last > SECONDS_PER_WEEK else ' (adjusted GPS time according to its header)'}, "
            f"the trajectory runs from {first:.1f} s to {last:.1f} s. {hint or tried}")
    if not offset:
        return 0.0, hint
    said = f"The trajectory counts {TIME_SYSTEM_NAMES[name]}; {offset:+.0f} s convert it to the time of the cloud."
    return offset, f"{said} {hint}".strip()


def _offsets(first, last, cloud, system):
    """[(system, offset)]: the offsets that may convert each time system to the cloud's."""
    absolute_cloud = cloud + ADJUSTED_OFFSET if cloud < ADJUSTED_OFFSET else cloud
    absolute = cloud > 1.5 * SECONDS_PER_WEEK  # the count of the cloud does not start again every week
    options = []
    for name, shift in (("adjusted", ADJUSTED_OFFSET), ("gps", 0.0)):
        if absolute:
            options.append((name, shift + cloud - absolute_cloud))
        elif system == name or first > 2 * SECONDS_PER_WEEK or first < 0:
            start = first + shift
            options += [(name, -np.floor(start / period) * period + shift + turn * period)
                        for period in ((SECONDS_PER_WEEK, SECONDS_PER_DAY) if cloud < 1.5 * SECONDS_PER_DAY else (SECONDS_PER_WEEK,))
                        for turn in (0, -1, 1)]
    for name, period in (("week", SECONDS_PER_WEEK), ("day", SECONDS_PER_DAY)):
        if last > 2 * period and system != name:
            continue
        if absolute:
            start = np.floor(absolute_cloud / period) * period - absolute_cloud + cloud
        else:
            start = np.floor(cloud / period) * period
        options += [(name, start + turn * period) for turn in (0, -1, 1)]
    if cloud < 1.5 * SECONDS_PER_DAY <= first and last <= 2 * SECONDS_PER_WEEK:
        options += [("week", -np.floor(first / SECONDS_PER_DAY) * SECONDS_PER_DAY)]
    if system == "automatic":
        return [("as it is", 0.0), *((name, float(offset)) for name, offset in options)]
    return [(name, float(offset)) for name, offset in options if name == system]


def is_to_come(seconds: float) -> bool:
    """Whether GPS seconds lie in the future: then they count from 1970, ten years before GPS time."""
    return seconds > time.time() - UNIX_EPOCH + SECONDS_PER_DAY


def unix_time_found(seconds: float, what: str) -> str:
    """The sentence on a time that counts from 1970; `what` is its beginning, on who counts."""
    utc = seconds - UNIX_EPOCH
    leap = float(leap_seconds(np.array([utc]))[0])
    return (f"{what} Unix time: {seconds:.0f} s since 1970 are GPS {utc + leap:.0f} s where they count UTC, which differs from GPS time by "
            f"{leap:.0f} s, and {utc:.0f} s where they do not. Export GPS time in seconds, or write utc in place of time in Columns of Import "
            "trajectory.")


def _unix_hint(first, last, cloud_first, cloud_last):
    """A sentence where the trajectory would cover the scan if it counted from 1970; otherwise ""."""
    for shift in (0.0, -ADJUSTED_OFFSET):
        if min(last - UNIX_EPOCH + shift, cloud_last) - max(first - UNIX_EPOCH + shift, cloud_first) > -LARGEST_SHIFT:
            return unix_time_found(first, "Its times seem to count")
    return ""


def _leap_hint(first, last, cloud_first, cloud_last):
    """A sentence where a shift by leap seconds would cover a scan that is not covered now; otherwise ""."""
    early, late = first - cloud_first, cloud_last - last
    if max(early, late) <= TIME_TOLERANCE or max(early, late) > LARGEST_SHIFT + TIME_TOLERANCE:
        return ""
    gps_to_utc = [float(len(LEAP_DAYS) - years) for years in range(5)]   # since the last leap second, and before each of the last four
    for leap in (*gps_to_utc, *(TAI_TO_GPS + shift for shift in gps_to_utc[:3]), TAI_TO_GPS):
        for shift in (leap, -leap):
            if first + shift - cloud_first <= 0.1 and cloud_last - last - shift <= 0.1:
                said = f"The scan begins {early:.1f} s before the trajectory" if early > late else f"The scan ends {late:.1f} s after the trajectory"
                return (f"{said}, and {leap:.0f} s would make them agree, which is what leap seconds come to (UTC against GPS is 18 s since 2017): "
                        "if the trajectory is in UTC, export it in GPS time.")
    return ""
