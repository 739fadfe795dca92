"""Clouds that no vehicle on a road has measured are refused by name."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import median_filter

from ...common.errors import RoadExtractionError
from .first_poses import Spinning
from .rough.first_track import WINDOW, FirstTrack

FARTHEST_MEDIAN = 15.0     # m: half of what a vehicle on a road sees at a time is nearer; an aircraft's swath is wider
MIN_PATH = 5.0           # m between the outermost places: less is no drive
WALKING_PACE = 2.0       # m/s: nobody surveys a road by car at that pace all the time
PACE_TIME = 3.0          # s over which a pace is told
STEADY_PLACES = 7        # of some tenths of a second together: fewer than half of them may be wrong
MIN_STANDING_TIME = 2.0  # s of measuring before standing still means anything


def refuse_airborne(tracks: list[FirstTrack]) -> None:
    """Refuse a cloud whose points are spread so wide at any time that they were measured from high above.

    Raises
    ------
    RoadExtractionError
        If it is one.
    """
    reach = float(np.nanmedian(np.concatenate([track.reach for track in tracks])))
    if reach > FARTHEST_MEDIAN:
        raise RoadExtractionError(
            f"This looks like an airborne survey: at any moment half of its points lie more than {reach:.0f} m from where they are densest, and "
            f"a vehicle on the road sees half of them within {FARTHEST_MEDIAN:.0f} m. A trajectory is estimated for mobile laser scanning from "
            "the road alone.")


def refuse_terrestrial(tracks: list[FirstTrack], places: list[np.ndarray]) -> None:
    """Refuse a cloud that was measured from one place.

    Parameters
    ----------
    tracks : FirstTrack of each drive
    places : (N, 2 or more) m, where scanners were seen, in order of time, some of them wrong; none where that is not known

    Raises
    ------
    RoadExtractionError
        If it is one.
    """
    if places := [place[:, :2] for place in places if len(place)]:
        # a vehicle may stand most of the time, but where it drives, it is seen several times
        steady = np.concatenate([median_filter(place, (STEADY_PLACES, 1), mode="nearest") for place in places])
        low, high = steady.min(axis=0), steady.max(axis=0)
    else:
        feet = np.concatenate([track.foot[:, :2] for track in tracks])
        low, high = np.quantile(feet, 0.05, axis=0), np.quantile(feet, 0.95, axis=0)
    seconds = sum(float(np.ptp(track.time)) for track in tracks)
    if np.hypot(*(high - low)) < MIN_PATH and seconds > MIN_STANDING_TIME:
        raise RoadExtractionError(
            f"This looks like a terrestrial scan: in {seconds:.0f} s the scanner stayed within {np.hypot(*(high - low)):.1f} m. A trajectory is "
            "estimated for clouds measured while driving; give those, or the scanner's position as a trajectory where a map is wanted from here.")


def refuse_handheld(tracks: list[FirstTrack], scanners: list[Spinning]) -> None:
    """Refuse a cloud measured at walking pace by a scanner without a steadily mounted mirror.

    Raises
    ------
    RoadExtractionError
        If it is one.
    """
    if scanners:
        return
    # between places PACE_TIME apart: the track swings from window to window by more than anybody walks meanwhile
    apart = round(PACE_TIME / WINDOW)
    pace = np.concatenate([np.hypot(*(track.foot[apart:, :2] - track.foot[:-apart, :2]).T) / PACE_TIME for track in tracks])
    if len(pace) and np.quantile(pace, 0.9) < WALKING_PACE:
        raise RoadExtractionError(
            f"This looks like a handheld or backpack survey: it moved at {np.median(pace):.1f} m/s, at walking pace, and no mirror turns steadily "
            "in it. A trajectory is estimated for scanners on vehicles; give the trajectory that the scanner's own program has computed.")
