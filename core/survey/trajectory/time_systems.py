"""The ways to count GPS time, and how a trajectory is brought to the cloud's."""

import numpy as np

from ...common.errors import RoadExtractionError

WEEK, DAY, ADJUSTED = 604800.0, 86400.0, 1e9
SYSTEMS = ("automatic", "gps", "adjusted", "week", "day")
NAMES = {"as it is": "the cloud's own seconds", "gps": "GPS seconds since 1980", "adjusted": "adjusted GPS seconds (GPS less 1e9)",
         "week": "seconds of the week", "day": "seconds of the day"}
SLACK = 1.0  # s that two clocks may miss each other by, as nominal times do
# s between GPS and UTC now and in earlier years, between TAI and UTC, and between TAI and GPS
LEAPS = (18.0, 17.0, 16.0, 15.0, 14.0, 37.0, 36.0, 35.0, 19.0)


def unwrap_time(time):
    """Seconds of the week or day, in driving order, carried on past midnight or the week's end.

    Returns
    -------
    (N,) float64: the same values where the count does not start again.
    """
    time = np.asarray(time, float)
    known = np.flatnonzero(np.isfinite(time))
    if len(known) < 2:
        return time
    values = time[known]
    step = np.diff(values)
    for period in (WEEK, DAY):
        # A start from zero again is one step back by nearly the whole period, with time going on around it
        back = step < -0.9 * period
        if back.any() and back.sum() * 20 < len(step) + 20 and values.max() <= period * 1.001 and values.min() >= 0 \
                and (step[~back] >= 0).mean() > 0.95:
            carried = time.copy()
            carried[known] = values + period * np.r_[0.0, np.cumsum(back)]
            return carried
    return time


def wrapped_week(span):
    """Whether a cloud's (first, last) gps_time can only be a week that ended during the drive."""
    return 0 <= span[0] and span[1] <= WEEK * 1.001 and span[1] - span[0] > 0.75 * WEEK


def align_time(time, cloud_span, system="automatic", adjusted=True):
    """Seconds to add to a trajectory's time to bring it to the cloud's.

    Parameters
    ----------
    time : (N,) the trajectory's time, in driving order where it starts again from zero
    cloud_span : (first, last) gps_time of the cloud
    system : how the trajectory counts: "gps" (seconds since 1980), "adjusted"
        (the same minus 1e9), "week", "day", or "automatic"
    adjusted : whether the cloud says it is in adjusted standard time

    Returns
    -------
    (offset, note for the user; "" where nothing was changed and nothing is doubtful)

    Raises
    ------
    RoadExtractionError
        If no way of counting makes the two overlap.

    Notes
    -----
    Leap seconds are never guessed: where a shift of 18 s (or 17, 37 ...) would
    make the two agree, the note or the message says so, and the user settles it.
    """
    if system not in SYSTEMS:
        raise RoadExtractionError(f"The time system {system!r} is not known; choose one of {', '.join(SYSTEMS)}.")
    if not np.isfinite(time).any():
        raise RoadExtractionError("The trajectory holds no position with a time. Check the file, or export it again.")
    time = unwrap_time(time)
    first, last = float(np.nanmin(time)), float(np.nanmax(time))
    cloud_first, cloud_last = map(float, cloud_span)
    options = _offsets(first, last, (cloud_first + cloud_last) / 2, system)

    def overlap(offset):
        return min(last + offset, cloud_last) - max(first + offset, cloud_first)

    name, offset = max(options, key=lambda option: (overlap(option[1]) > -SLACK and option[0] == "as it is", overlap(option[1])))
    hint = _leap_hint(first + offset, last + offset, cloud_first, cloud_last)
    if overlap(offset) <= -SLACK:
        tried = "One of them may count another way: set the trajectory's time system (gps, adjusted, week or day)" \
            if system == "automatic" else f"The trajectory was taken to count {NAMES[system]}: set its time system to automatic"
        raise RoadExtractionError(
            f"The trajectory does not cover the scan in time. The scan was recorded from {cloud_first:.1f} s to {cloud_last:.1f} s"
            f"{'' if not adjusted or cloud_last > WEEK else ' (said to be adjusted GPS time)'}, "
            f"the trajectory runs from {first:.1f} s to {last:.1f} s. {hint or tried + ' and run again.'}")
    if not offset:
        return 0.0, hint
    return offset, (f"The trajectory counts {NAMES[name]}; {offset:+.0f} s bring it to the cloud's time. {hint}").strip()


def _offsets(first, last, cloud, system):
    """[(system, offset)]: what would bring each way of counting to the cloud's."""
    absolute_cloud = cloud + ADJUSTED if cloud < ADJUSTED else cloud
    counts_on = cloud > 1.5 * WEEK  # the cloud does not start again every week
    options = []
    for name, shift in (("adjusted", ADJUSTED), ("gps", 0.0)):
        if counts_on:
            options.append((name, shift + cloud - absolute_cloud))
        elif system == name or first > 2 * WEEK or first < 0:
            start = first + shift
            options += [(name, -np.floor(start / period) * period + shift + turn * period)
                        for period in ((WEEK, DAY) if cloud < 1.5 * DAY else (WEEK,)) for turn in (0, -1, 1)]
    for name, period in (("week", WEEK), ("day", DAY)):
        if last > 2 * period and system != name:
            continue
        if counts_on:
            start = np.floor(absolute_cloud / period) * period - absolute_cloud + cloud
        else:
            start = np.floor(cloud / period) * period
        options += [(name, start + turn * period) for turn in (0, -1, 1)]
    if cloud < 1.5 * DAY <= first and last <= 2 * WEEK:
        options += [("week", -np.floor(first / DAY) * DAY)]
    if system == "automatic":
        return [("as it is", 0.0), *((name, float(offset)) for name, offset in options)]
    return [(name, float(offset)) for name, offset in options if name == system]


def _leap_hint(first, last, cloud_first, cloud_last):
    """A sentence where shifting by leap seconds would cover a scan that is not covered now, else ""."""
    early, late = first - cloud_first, cloud_last - last
    if max(early, late) <= SLACK or max(early, late) > LEAPS[5] + SLACK:
        return ""
    for leap in LEAPS:
        for shift in (leap, -leap):
            if first + shift - cloud_first <= 0.1 and cloud_last - last - shift <= 0.1:
                side = "begins" if early > late else "ends"
                return (f"The scan {side} {max(early, late):.1f} s {'before' if early > late else 'after'} the trajectory, and {leap:.0f} s would "
                        f"make them agree, which is what leap seconds come to (UTC against GPS is 18 s since 2017): if the "
                        "trajectory is in UTC, export it in GPS time.")
    return ""
