"""The trajectory of a survey from its points alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from scipy.ndimage import median_filter

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...io.crs import check_projected, crs_note, unit_note
from ..las.reader import read_headers
from ..las.samples import without_copies
from ..trajectory.trajectory import Trajectory
from ..weights import ESTIMATE, HEAD, MIRROR, RAYS, TRACK
from .adjustment import Adjusted, Returns, ScannerSplitter, grown_poses, lines_of_each, scan_line_directions, steps_of, told_apart
from .poses import YAW, HeadTrack, Poses, Spinning, first_poses, head_heights, known_intervals, spinning_scanners, turning_heads
from .samples import UNKNOWN_SCANNER, FirstTrack, Samples, first_track, read_samples, ridge_of, rounding_of, thinned

WAYS = {"rays": "the rays of the mirrors", "turns": "the turns of a many-beam head", "density": "the density of the points, which is rough"}


@dataclass
class EstimatedTrajectory:
    """A trajectory of the middle of the scanners, and how well it is known.

    scanners, adjusted : that took part, and the adjustment of their poses; none with density alone
    notes, cloud_notes : sentences for the user, the latter on the point clouds, which whoever reads them with this trajectory says too
    """

    trajectory: Trajectory
    sigma: np.ndarray   # sigma, sigma_height: (N,) m, standard deviation of the place on the map and of the height
    sigma_height: np.ndarray
    method: str   # "rays" of mirrors, "turns" of a many-beam head, or "density" of points alone, which is rough
    scanners: list[Spinning] = field(default_factory=list)
    adjusted: Adjusted | None = None
    above_road: float = np.nan   # m, median height above the road where it was measured, NaN where it was not
    notes: list[str] = field(default_factory=list)
    cloud_notes: list[str] = field(default_factory=list)

    def summary(self) -> str:
        """One sentence on how it was estimated and how well it is known."""
        return (f"Trajectory estimated from {WAYS[self.method]}: {len(self.trajectory):,} positions over {self.length:.0f} m, place known to "
                f"{np.median(self.sigma):.3f} m, height to {np.median(self.sigma_height):.3f} m (median, one sigma).")

    @property
    def length(self) -> float:
        """Metres driven, gaps between drives left out."""
        track = self.trajectory
        step = np.hypot(np.diff(track.x), np.diff(track.y))
        return float(step[np.diff(track.time) <= TRACK.max_gap_in_drive].sum())


def estimate_trajectory(paths: Sequence[str | Path], crs: str = "", scanner_field: str = "automatic",
                        progress: Progress = Progress()) -> EstimatedTrajectory:
    """Estimate where the scanners of a survey were.

    With times, and a mirror that turns, every return must lie on the ray that the mirror had at its time: an adjustment of all
    of them gives place and attitude. Without, the track is the ridge of the points' density, which is rough.

    paths : LAS, LAZ or COPC files in any order
    crs : WKT for clouds that carry none
    scanner_field : "automatic", "scanner_channel" or "point_source_id"
    Returns EstimatedTrajectory, on the clock of the points
    Raises RoadExtractionError if a file cannot be read, the CRS is geographic or not in metres, or the cloud was not measured from a vehicle on a
    road.
    """
    copies: list[str] = []
    files = without_copies(read_headers(paths, copies.append, crs), copies.append)
    wkt = check_projected(files, crs)
    estimate = _estimated(files, scanner_field, wkt, progress)
    estimate.cloud_notes = copies + [note for note in (crs_note(files, crs, wkt), unit_note(estimate.above_road, wkt)) if note]
    return estimate


def _estimated(files, scanner_field, wkt, progress):
    """The trajectory from the points, of a CRS in metres or none."""
    samples = read_samples(files, scanner_field, progress.part(0.0, ESTIMATE.read_progress))
    if not samples.has_time:
        return _without_time(samples, wkt)
    if not samples.drives:
        raise RoadExtractionError("The points come in pieces too short to tell a drive: no stretch of time without gaps of a second holds enough of "
                                  "them. Give the whole survey.")
    tracks = []
    for number, drive in enumerate(samples.drives):
        tracks.append(first_track(samples.time[drive], samples.place[drive]))
        progress.report(ESTIMATE.read_progress + (ESTIMATE.tracked_progress - ESTIMATE.read_progress) * (number + 1) / len(samples.drives))
    _refuse_clocks_that_overlap(samples, tracks)
    _refuse_airborne(tracks)
    heads = turning_heads(samples, tracks)
    if heads is not None:
        _refuse_terrestrial(tracks, [head.place for head in heads])
        refuse_handheld(tracks, [], heads)
        return _of_heads(samples, tracks, heads, wkt)
    scanners = spinning_scanners(samples, tracks)
    _refuse_terrestrial(tracks, [fixes.place for scanner in scanners for fixes in scanner.fixes])
    return _of_mirrors(samples, tracks, scanners, wkt, progress.part(ESTIMATE.tracked_progress, 1.0))


def _of_mirrors(samples, tracks, scanners, wkt, progress):
    """The trajectory by the rays of the scanners that a field distinguishes or, where those explain too little, that the scan lines do."""
    adjusted = None
    taking_part = np.count_nonzero(np.isin(samples.scanner, [scanner.number for scanner in scanners]))
    if by_field := samples.scanners > 1 and taking_part >= ESTIMATE.min_taking_part * len(samples):
        adjusted = _adjusted(samples, tracks, scanners, progress)
    if not _explains(adjusted):
        # a field may have numbered tiles or files
        if (separation := separated(samples, tracks, progress)) is not None:
            result = _of_rays(separation[0], tracks, *separation[1:], wkt)
            result.notes.append(told_apart(len(separation[1])))
            return result
        if not by_field:
            refuse_handheld(tracks, scanners)
            adjusted = _adjusted(samples, tracks, scanners, progress) if scanners else None
    if _explains(adjusted):
        return _of_rays(samples, tracks, scanners, adjusted, wkt)
    refuse_handheld(tracks, [])
    if adjusted is None or not _could_be_driven(adjusted):
        _refuse_without_road(tracks)
        return _by_density(samples, tracks, wkt)
    # tilted heads of many beams turn, too, and the mean of their beams is nearly the ray of a mirror
    result = _of_rays(samples, tracks, scanners, adjusted, wkt)
    least = ESTIMATE.share_of_unexplained * adjusted.unexplained
    result.sigma, result.sigma_height = np.maximum(result.sigma, least), np.maximum(result.sigma_height, least)
    result.notes.append(f"Returns lie {adjusted.unexplained:.2f} m off the rays of a mirror (median), which makes the trajectory less certain.")
    return result


def _explains(adjusted):
    """Whether returns lie on the rays of adjusted poses, None for none."""
    return adjusted is not None and adjusted.unexplained <= RAYS.max_unexplained


def _could_be_driven(adjusted):
    """Whether a vehicle can have moved as the poses say."""
    tracks = [adjusted.poses.control[drive.first:drive.first + drive.count, :2] for drive in adjusted.poses.drives]
    return _usual_acceleration(tracks, MIRROR.knot_spacing) <= ESTIMATE.max_acceleration


def _adjusted(samples, tracks, scanners, progress):
    poses = first_poses(samples, tracks, scanners)
    return grown_poses(poses, known_intervals(poses, scanners), _returns(samples, poses, scanners), progress)


def separated(samples: Samples, tracks: list[FirstTrack], progress: Progress = Progress()) -> tuple[Samples, list[Spinning], Adjusted] | None:
    """The samples with scanners that no field distinguishes, these, and the poses; None for one scanner, or where they cannot be distinguished."""
    steps = [steps_of(samples.place[drive], track, samples.time[drive]) for drive, track in zip(samples.drives, tracks)]
    ways = scan_line_directions(np.concatenate([direction for _, direction in steps]))
    if len(ways) < 2:
        return None
    scanner = np.full(len(samples), UNKNOWN_SCANNER, np.uint8)
    for drive, (row, direction) in zip(samples.drives, steps):
        number = lines_of_each(direction, row, drive.stop - drive.start, ways)
        scanner[drive] = np.where(number < 0, UNKNOWN_SCANNER, number)
    relabelled = replace(samples, scanner=scanner)
    scanners = spinning_scanners(relabelled, tracks)
    if len(scanners) < 2:
        return None
    adjusted = _adjusted(relabelled, tracks, scanners, progress.part(0.0, 0.6))
    if not _explains(adjusted):
        return None
    # the rays distinguish the other points, too, and the few that were wrong
    splitter = ScannerSplitter(adjusted.poses, 0.0, np.zeros(3))
    relabelled = replace(samples, scanner=splitter.numbers(samples.time, samples.place))
    scanners = [replace(spinning, number=number) for number, spinning in enumerate(scanners)]
    adjusted = grown_poses(adjusted.poses, np.isfinite(adjusted.misfit), _returns(relabelled, adjusted.poses, scanners), progress.part(0.6, 1.0))
    return (relabelled, scanners, adjusted) if _explains(adjusted) else None


def splitter_of(samples: Samples, progress: Progress = Progress()) -> ScannerSplitter | None:
    """What distinguishes scanners whose points no field distinguishes; None where there is one, or they cannot be distinguished."""
    if not samples.drives:
        return None
    tracks = [first_track(samples.time[drive], samples.place[drive]) for drive in samples.drives]
    separation = separated(samples, tracks, progress)
    return None if separation is None else ScannerSplitter(separation[2].poses, samples.start, samples.origin)


def _returns(samples: Samples, poses: Poses, scanners: list[Spinning]) -> Returns:
    """Up to `per_interval` returns of every interval and scanner."""
    order = np.full(256, -1)
    order[[spinning.number for spinning in scanners]] = np.arange(len(scanners))
    parts = []
    for drive, knots in zip(samples.drives, poses.drives):
        scanner = order[samples.scanner[drive]]
        interval, share = knots.interval(samples.time[drive])
        key = (interval - knots.first) * (poses.scanners + 1) + scanner + 1
        by_key = np.argsort(key, kind="stable")
        rows = np.sort(by_key[thinned(key[by_key], RAYS.per_interval) & (scanner[by_key] >= 0)])
        parts.append((interval[rows], share[rows], samples.time[drive][rows], samples.place[drive][rows], scanner[rows]))
    interval, share, time, place, scanner = (np.concatenate(column) for column in zip(*parts))
    return Returns(interval, share, time, place, scanner, rounding_of(samples.time, samples.start))


def _of_rays(samples, tracks, scanners, adjusted, crs):
    """The poses at even times, as far as they are known well enough."""
    rows, lost = [], 0.0
    for drive, knots in zip(samples.drives, adjusted.poses.drives):
        first, last = float(samples.time[drive.start]), float(samples.time[drive.stop - 1])
        time = np.append(np.arange(first, last, ESTIMATE.row_spacing), last)
        interval, share = knots.interval(time)
        covariance = adjusted.place_covariance[interval + 1 + (share > 0.5)]
        flat = np.sqrt(covariance[:, 0, 0] + covariance[:, 1, 1] + ESTIMATE.least_sigma**2)
        kept = flat <= ESTIMATE.max_sigma
        lost += np.count_nonzero(~kept) * ESTIMATE.row_spacing
        up = np.sqrt(covariance[:, 2, 2] + ESTIMATE.least_sigma**2)
        rows.append(np.column_stack([time, adjusted.poses.at(interval, share)[:, :YAW + 1], flat, up])[kept])
    time, x, y, z, roll, pitch, yaw, flat, up = np.concatenate(rows).T
    if not len(time):
        raise RoadExtractionError(f"The places of the scanner could not be told to {ESTIMATE.max_sigma:g} m anywhere. Give the cloud as the "
                                  "scanner's own program writes it, or a trajectory.")
    ox, oy, oz = samples.origin
    trajectory = Trajectory(time + samples.start, x + ox, y + oy, z + oz, np.degrees(roll), np.degrees(pitch), (90.0 - np.degrees(yaw)) % 360.0, crs)
    ground = np.interp(time, *(np.concatenate(column) for column in zip(*((track.time, track.foot[:, 2]) for track in tracks))))
    result = EstimatedTrajectory(trajectory, flat, up, "rays", scanners, adjusted, float(np.median(z - ground)))
    left_out = samples.scanners - len(scanners)
    if left_out:
        result.notes.append(f"{left_out} of {samples.scanners} scanners show no steadily turning mirror and took no part.")
    if lost >= 1.0:
        result.notes.append(f"For {lost:.0f} s of the survey the place is not known to {ESTIMATE.max_sigma:g} m and was left out; "
                            "points measured then will be, too.")
    if samples.left_out:
        result.notes.append(f"{samples.left_out:,} points came in short pieces between gaps of time and were left out.")
    return result


def _of_heads(samples, tracks, heads, crs):
    """The places of a many-beam head, one a turn."""
    time, heading, sigma = (np.concatenate([getattr(head, name) for head in heads]) for name in ("time", "heading", "sigma"))
    ground, height, height_sigma = head_heights(samples, tracks, heads)
    height_note = (f"the elevations of its beams give its height above the road, {height:.2f} m, known to {height_sigma:.2f} m" if height is not None
                   else f"its height above the road, known to {HEAD.usual_height_sigma:g} m, is a usual one")
    if height is None:
        height, height_sigma = HEAD.usual_height, HEAD.usual_height_sigma
    place = np.column_stack([np.concatenate([head.place for head in heads]), np.concatenate(ground) + height])
    kept = sigma <= ESTIMATE.max_sigma
    trajectory = _rough(time[kept] + samples.start, place[kept], heading[kept], samples.origin, crs, True)
    return EstimatedTrajectory(trajectory, sigma[kept], np.full(int(kept.sum()), height_sigma), "turns", notes=[
        f"The points are those of a head of many beams that turns {abs(heads[0].rate):.1f} times a second; {height_note}. Roll and pitch are not "
        "known."])


def _by_density(samples, tracks, crs):
    """The first track as the trajectory, where no mirror was seen to turn."""
    time, place, heading = (np.concatenate(column) for column in zip(*((track.time, track.foot, track.heading) for track in tracks)))
    trajectory = _rough(time + samples.start, place + [0.0, 0.0, TRACK.usual_height], heading, samples.origin, crs, True)
    return _with_density_sigma(trajectory, [
        f"No mirror was seen to turn, so the track follows the density of the points: its place is known to about {ESTIMATE.density_sigma:g} m, its "
        f"height above the road to {ESTIMATE.density_height_sigma:g} m."])


def _without_time(samples, crs):
    """The ridge of density of a cloud without times."""
    place = ridge_of(samples.place)
    step = np.gradient(place[:, :2], axis=0)
    trajectory = _rough(np.arange(len(place), dtype=float), place, np.arctan2(step[:, 1], step[:, 0]), samples.origin, crs, False)
    trajectory = replace(trajectory, way_known=False)
    notes = [f"The points have no times, so the track is the rough ridge of their density: its place is known to about {ESTIMATE.density_sigma:g} "
             f"m, its height above the road to {ESTIMATE.density_height_sigma:g} m, and which way was driven is not known."]
    return _with_density_sigma(trajectory, notes)


def _with_density_sigma(trajectory, notes):
    sigma, sigma_height = (np.full(len(trajectory), sigma) for sigma in (ESTIMATE.density_sigma, ESTIMATE.density_height_sigma))
    return EstimatedTrajectory(trajectory, sigma, sigma_height, "density", notes=notes)


def _rough(time, place, yaw, origin, crs, has_time):
    return Trajectory(time, *(place + origin).T, heading=(90.0 - np.degrees(yaw)) % 360.0, crs=crs, has_time=has_time)


# Clouds that no vehicle on a road has measured are refused by name.


def _refuse_airborne(tracks: list[FirstTrack]) -> None:
    """Refuse a cloud whose points are spread so wide at any time that they were measured from high above."""
    reach = float(np.nanmedian(np.concatenate([track.reach for track in tracks])))
    if reach > ESTIMATE.farthest_median:
        raise RoadExtractionError(f"This looks like an airborne survey: half of its points lie more than {reach:.0f} m from where they are densest, "
                                  f"and {ESTIMATE.farthest_median:.0f} m is what a vehicle on the road sees. Give a survey measured from the road.")


def _refuse_clocks_that_overlap(samples: Samples, tracks: list[FirstTrack]) -> None:
    """Refuse points that were measured in two places at most of the times: drives whose clocks overlap."""
    distances = np.concatenate([_places_apart(samples.time[drive], samples.place[drive, :2], track) for drive, track in zip(samples.drives, tracks)])
    if len(distances) and np.mean(np.isfinite(distances)) > 0.5:
        raise RoadExtractionError(
            f"At most times the points lie in two places {np.nanmedian(distances):.0f} m apart, as of drives whose clocks overlap. Estimate the "
            "trajectory of each drive from its own files.")


def _places_apart(time, flat, track):
    """(W,) m between the two places in which the points of a window lie; NaN where they lie in one, or spread."""
    size = len(track.time)
    window = np.clip(((time - track.time[0] + TRACK.window / 2) / TRACK.window).astype(np.int64), 0, size - 1)
    # one place about the densest of the window, and what lies farthest from it
    offsets = flat - track.foot[window, :2]
    order = np.lexsort((np.hypot(*offsets.T), window))
    held = np.bincount(window, minlength=size)
    last = np.maximum(np.cumsum(held) - 1, 0)
    middles = np.stack([np.zeros((size, 2)), offsets[order[last]]])
    for _ in range(ESTIMATE.split_rounds):
        far = np.stack([np.hypot(*(offsets - middle[window]).T) for middle in middles])
        second = far[1] < far[0]
        for number, members in enumerate((~second, second)):
            count = np.maximum(np.bincount(window[members], minlength=size), 1)
            middles[number] = np.stack([np.bincount(window[members], column, size) / count for column in offsets[members].T], axis=1)
    share = np.bincount(window, second, size) / np.maximum(held, 1)
    near = np.bincount(window, far.min(axis=0) < ESTIMATE.place_radius, size) / np.maximum(held, 1)
    between = np.hypot(*(middles[1] - middles[0]).T)
    two = (np.minimum(share, 1.0 - share) >= ESTIMATE.min_share_elsewhere) & (between > ESTIMATE.min_far_apart) & (near > 0.5)
    return np.where(two, between, np.nan)[held >= TRACK.min_window_samples]


def _usual_acceleration(tracks: list[np.ndarray], spacing: float) -> float:
    """m/s^2 that nine tenths of the tracks keep below, (N, 2 or more) m each, at times `spacing` (s) apart."""
    bends = np.concatenate([np.hypot(*np.diff(track[:, :2], 2, axis=0).T) for track in tracks])
    return float(np.quantile(bends, ESTIMATE.drivable_share)) / spacing**2 if len(bends) else 0.0


def _refuse_without_road(tracks: list[FirstTrack]) -> None:
    """Refuse points of which most lie far from where they are densest, or where that place moves as no vehicle does."""
    reach = float(np.nanmedian(np.concatenate([track.reach for track in tracks])))
    sharp = _usual_acceleration([track.foot for track in tracks], TRACK.window)
    if reach > ESTIMATE.max_road_reach or sharp > ESTIMATE.max_acceleration:
        raise RoadExtractionError("No mirror is seen to turn, and the points' density does not show the way: half lie more than "
                                  f"{reach:.1f} m from where they are densest, which accelerates by {sharp:.0f} m/s². Give a trajectory.")


def _refuse_terrestrial(tracks: list[FirstTrack], places: list[np.ndarray]) -> None:
    """Refuse a cloud that was measured from one place.

    places : (N, 2 or more) m, where scanners were seen, in order of time, some of them wrong; none where that is not known
    """
    if places := [place[:, :2] for place in places if len(place)]:
        # a vehicle may stand most of the time, but where it drives, it is seen several times
        steady = np.concatenate([median_filter(place, (ESTIMATE.steady_places, 1), mode="nearest") for place in places])
        low, high = steady.min(axis=0), steady.max(axis=0)
    else:
        feet = np.concatenate([track.foot[:, :2] for track in tracks])
        low, high = np.quantile(feet, 0.05, axis=0), np.quantile(feet, 0.95, axis=0)
    seconds = sum(float(np.ptp(track.time)) for track in tracks)
    if np.hypot(*(high - low)) < ESTIMATE.min_path and seconds > ESTIMATE.min_standing_time:
        raise RoadExtractionError(
            f"This looks like a terrestrial scan: in {seconds:.0f} s the scanner stayed within {np.hypot(*(high - low)):.1f} m. Give a cloud "
            "measured while driving, or the scanner's position as a trajectory.")


def refuse_handheld(tracks: list[FirstTrack], scanners: list[Spinning], heads: Sequence[HeadTrack] = ()) -> None:
    """Raise RoadExtractionError for a cloud measured at walking pace by a scanner without a steadily mounted mirror.

    scanners : whose mirrors turn steadily; where there is one, nobody carries it
    heads : of many beams; their places are sharper than the first track
    """
    if scanners:
        return
    if heads:
        # a vehicle may stand most of the time, but where it drives, it is faster than anybody walks
        pace = np.concatenate([_paces_of(head) for head in heads])
        at_walking_pace = len(pace) > 0 and pace.max() < ESTIMATE.walking_pace
    else:
        # between places some seconds apart: the track swings from window to window by more than anybody walks meanwhile
        windows = round(ESTIMATE.pace_time / TRACK.window)
        pace = np.concatenate([np.hypot(*(track.foot[windows:, :2] - track.foot[:-windows, :2]).T) / ESTIMATE.pace_time for track in tracks])
        at_walking_pace = len(pace) > 0 and np.quantile(pace, 0.9) < ESTIMATE.walking_pace
    if at_walking_pace:
        raise RoadExtractionError(
            f"This looks like a handheld or backpack survey: it moved at {np.median(pace):.1f} m/s, and no mirror turns steadily. Give the "
            "trajectory that the scanner's own program has computed.")


def _paces_of(head):
    """m/s over `pace_time`, from the places of a head without single wrong ones."""
    place = median_filter(head.place, (ESTIMATE.steady_places, 1), mode="nearest")
    start = np.flatnonzero(head.time <= head.time[-1] - ESTIMATE.pace_time)
    end = np.searchsorted(head.time, head.time[start] + ESTIMATE.pace_time)
    return np.hypot(*(place[end] - place[start]).T) / (head.time[end] - head.time[start])
