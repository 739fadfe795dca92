"""The ways to count GPS time, and how a trajectory is brought to the cloud's."""

import numpy as np

from ..errors import RoadExtractionError

WEEK, DAY, ADJUSTED = 604800.0, 86400.0, 1e9
SYSTEMS = ("automatic", "gps", "adjusted", "week", "day")


def align_time(time, cloud_span, system="automatic", adjusted=True):
    """Seconds to add to a trajectory's time to bring it to the cloud's.

    Parameters
    ----------
    time : (N,) the trajectory's time
    cloud_span : (first, last) gps_time of the cloud
    system : how the trajectory counts: "gps" (seconds since 1980), "adjusted"
        (the same minus 1e9), "week", "day", or "automatic"
    adjusted : whether the cloud says it is in adjusted standard time

    Returns
    -------
    (offset, note for the user; "" where nothing was changed)

    Raises
    ------
    RoadExtractionError
        If no way of counting makes the two overlap.

    Notes
    -----
    Leap seconds are never guessed: an offset of 18 s is for the user to settle.
    """
    first, last = float(np.min(time)), float(np.max(time))
    middle = (cloud_span[0] + cloud_span[1]) / 2
    options = {"as it is": 0.0, "adjusted": 0.0, "gps": -ADJUSTED if middle < ADJUSTED else 0.0}
    if middle < WEEK * 1.5 and first > WEEK * 1.5:
        # the cloud counts in the week, the trajectory absolutely
        for name, shift in (("gps", 0.0), ("adjusted", ADJUSTED)):
            options[name] = -(np.floor((first + shift) / WEEK) * WEEK - shift)
    elif middle > WEEK * 1.5:
        shift = ADJUSTED if middle < ADJUSTED else 0.0
        options["week"] = np.floor((middle + shift) / WEEK) * WEEK - shift
        options["day"] = np.floor((middle + shift) / DAY) * DAY - shift
        if first > ADJUSTED > middle:
            options["gps"] = -ADJUSTED
        if middle > ADJUSTED > first:
            options["adjusted"] = ADJUSTED
    else:
        options["week"] = 0.0
        options["day"] = np.floor(middle / DAY) * DAY
    if system != "automatic":
        options = {system: options.get(system, 0.0)}

    def overlap(offset):
        return min(last + offset, cloud_span[1]) - max(first + offset, cloud_span[0])

    name = max(options, key=lambda key: (overlap(options[key]) > 0, key == "as it is", overlap(options[key])))
    if overlap(options[name]) <= -1.0:
        raise RoadExtractionError(
            f"The trajectory does not cover the scan in time. The scan was recorded from {cloud_span[0]:.1f} s to "
            f"{cloud_span[1]:.1f} s, the trajectory runs from {first:.1f} s to {last:.1f} s. One of them may count "
            "another way: set the trajectory's time system (gps, adjusted, week or day) and run again.")
    if not options[name]:
        return 0.0, ""
    return options[name], (f"The trajectory counts time as {name!r}; {options[name]:+.0f} s bring it to the cloud's time.")
