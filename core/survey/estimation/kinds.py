"""Clouds that no vehicle on a road has measured are refused by name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import median_filter

from ...common.errors import RoadExtractionError
from .poses import Spinning
from .rough.first_track import MIN_WINDOW_SAMPLES, WINDOW, FirstTrack
from .rough.samples import Samples

if TYPE_CHECKING:
    from .turning_head import HeadTrack

FARTHEST_MEDIAN = 15.0     # m: half of what a vehicle on a road sees at a time is nearer; an aircraft's swath is wider
MIN_SHARE_ELSEWHERE = 0.1  # of the points of a moment that lie in another place, where two drives have the same times
MIN_FAR_APART = 50.0       # m between two such places
PLACE_RADIUS = 15.0        # m: half of what lies in either is nearer to its middle
SPLIT_ROUNDS = 5
MAX_ROAD_REACH = 8.0       # m: half of the points are nearer where the road under the vehicle is among them
MAX_ACCELERATION = 8.0     # m/s^2, which road vehicles reach in an emergency stop
DRIVABLE_SHARE = 0.9         # of a track that keeps below it, if a vehicle drove it
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


def refuse_clocks_that_overlap(samples: Samples, tracks: list[FirstTrack]) -> None:
    """Refuse points that were measured in two places at the same times: drives whose clocks overlap.

    Raises
    ------
    RoadExtractionError
        If most moments of the survey show two such places.
    """
    apart = np.concatenate([_places_apart(samples.time[drive], samples.place[drive, :2], track) for drive, track in zip(samples.drives, tracks)])
    if len(apart) and np.mean(np.isfinite(apart)) > 0.5:
        raise RoadExtractionError(
            f"At most times the points lie in two places {np.nanmedian(apart):.0f} m apart: these are drives whose clocks overlap, as seconds of "
            "the day or of the week do on other days. Estimate the trajectory of each drive by itself, from its own files.")


def _places_apart(time, flat, track):
    """(W,) m between the two places in which the points of a window lie; NaN where they lie in one, or spread."""
    size = len(track.time)
    window = np.clip(((time - track.time[0] + WINDOW / 2) / WINDOW).astype(np.int64), 0, size - 1)
    # one place about the densest of the window, and what lies farthest from it
    away = flat - track.foot[window, :2]
    order = np.lexsort((np.hypot(*away.T), window))
    held = np.bincount(window, minlength=size)
    last = np.maximum(np.cumsum(held) - 1, 0)
    middles = np.stack([np.zeros((size, 2)), away[order[last]]])
    for _ in range(SPLIT_ROUNDS):
        far = np.stack([np.hypot(*(away - middle[window]).T) for middle in middles])
        second = far[1] < far[0]
        for number, own in enumerate((~second, second)):
            count = np.maximum(np.bincount(window[own], minlength=size), 1)
            middles[number] = np.stack([np.bincount(window[own], column, size) / count for column in away[own].T], axis=1)
    share = np.bincount(window, second, size) / np.maximum(held, 1)
    near = np.bincount(window, far.min(axis=0) < PLACE_RADIUS, size) / np.maximum(held, 1)
    between = np.hypot(*(middles[1] - middles[0]).T)
    two = (np.minimum(share, 1.0 - share) >= MIN_SHARE_ELSEWHERE) & (between > MIN_FAR_APART) & (near > 0.5)
    return np.where(two, between, np.nan)[held >= MIN_WINDOW_SAMPLES]


def usual_acceleration(tracks: list[np.ndarray], spacing: float) -> float:
    """m/s^2 that nine tenths of the tracks keep below.

    Parameters
    ----------
    tracks : (N, 2 or more) m each, at times `spacing` (s) apart
    """
    bends = np.concatenate([np.hypot(*np.diff(track[:, :2], 2, axis=0).T) for track in tracks])
    return float(np.quantile(bends, DRIVABLE_SHARE)) / spacing**2 if len(bends) else 0.0


def refuse_without_road(tracks: list[FirstTrack]) -> None:
    """Refuse to follow the density of points among which the road under the vehicle is not.

    Raises
    ------
    RoadExtractionError
        If most points lie far from where they are densest, or that place moves as no vehicle does.
    """
    reach = float(np.nanmedian(np.concatenate([track.reach for track in tracks])))
    sharp = usual_acceleration([track.foot for track in tracks], WINDOW)
    if reach > MAX_ROAD_REACH or sharp > MAX_ACCELERATION:
        raise RoadExtractionError(
            "No mirror is seen to turn in the points' times, and their density does not show the way either: half of the points lie more than "
            f"{reach:.1f} m from where they are densest, and that place moves with accelerations of {sharp:.0f} m/s². The road under the vehicle may "
            "be missing from the cloud, as when it was wet, or the times may be those of an export. Give the cloud as the scanner's own program "
            "writes it, or a trajectory.")


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


def refuse_handheld(tracks: list[FirstTrack], scanners: list[Spinning], heads: Sequence[HeadTrack] = ()) -> None:
    """Refuse a cloud measured at walking pace by a scanner without a steadily mounted mirror.

    Parameters
    ----------
    tracks : FirstTrack of each drive
    scanners : whose mirrors turn steadily; where there is one, nobody carries it
    heads : of many beams; their places are sharper than the first track

    Raises
    ------
    RoadExtractionError
        If it is one.
    """
    if scanners:
        return
    if heads:
        # a vehicle may stand most of the time, but where it drives, it is faster than anybody walks
        pace = np.concatenate([_paces_of(head) for head in heads])
        walks = len(pace) > 0 and pace.max() < WALKING_PACE
    else:
        # between places PACE_TIME apart: the track swings from window to window by more than anybody walks meanwhile
        apart = round(PACE_TIME / WINDOW)
        pace = np.concatenate([np.hypot(*(track.foot[apart:, :2] - track.foot[:-apart, :2]).T) / PACE_TIME for track in tracks])
        walks = len(pace) > 0 and np.quantile(pace, 0.9) < WALKING_PACE
    if walks:
        raise RoadExtractionError(
            f"This looks like a handheld or backpack survey: it moved at {np.median(pace):.1f} m/s, at walking pace, and no mirror turns steadily "
            "in it. A trajectory is estimated for scanners on vehicles; give the trajectory that the scanner's own program has computed.")


def _paces_of(head):
    """m/s over PACE_TIME, from the places of a head without single wrong ones."""
    place = median_filter(head.place, (STEADY_PLACES, 1), mode="nearest")
    start = np.flatnonzero(head.time <= head.time[-1] - PACE_TIME)
    end = np.searchsorted(head.time, head.time[start] + PACE_TIME)
    return np.hypot(*(place[end] - place[start]).T) / (head.time[end] - head.time[start])
