"""The beams of a spinning scanner, told apart by their elevation, and brought to one brightness.

Each laser of such a scanner has a gain and a threshold of its own, so that asphalt
looks like a pattern of bright and dark arcs. Seen from the scanner, a laser
always points at the same elevation: points gather there in rings, and the asphalt of
each ring tells what the laser makes of asphalt.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from ..common.parallel import ordered_map
from ..common.progress import Progress
from ..survey.store.columns import Columns
from ..survey.store.records import Points
from .asphalt_model import FEWEST, LEVELS, asphalt_of, is_logarithmic, to_level, weighted_median

LOWEST, STEP, STEPS = -45.0, 0.05, 900   # degrees: elevations of road from -45 to 0 in steps of 0.05
RINGS = 1.5          # how much fuller than the mean of a degree about them rings must be to be beams
UNEQUAL = 0.05       # of asphalt's level: beams that differ less from those beside them are alike
BESIDE = 3           # beams either side
WINDOWS, WINDOW = 12, 5.0   # how many windows of a road are looked at to tell whether there are beams; m
MOST = 8_000         # points of a window that are looked at
LONGEST_FRAME = 1.0  # s that a turn of a spinning scanner may last
SIGHTED = "time", "x", "y", "z", "source", "pass_number"   # columns by which points are seen from the vehicle
TILTS = ((0, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))  # signs in which roll and pitch are told


@dataclass
class Frames:
    """Turns of a spinning scanner, counted in point_source_id; a cloud without such a count has none.

    middle : (65536,) s, the time in the middle of each turn; NaN where the number is no turn
    """

    middle: np.ndarray

    @classmethod
    def of(cls, road_points):
        first, last = np.full(65536, np.inf), np.full(65536, -np.inf)
        for key in road_points.all_sections():
            points = road_points.section(*key)
            source, time = points.source, points.time
            if not len(source):
                continue
            order = np.argsort(source, kind="stable")
            source, time = source[order], time[order]
            begins = np.flatnonzero(np.r_[True, source[1:] != source[:-1]])
            first[source[begins]] = np.minimum(first[source[begins]], np.minimum.reduceat(time, begins))
            last[source[begins]] = np.maximum(last[source[begins]], np.maximum.reduceat(time, begins))
        number = np.flatnonzero(np.isfinite(first))
        number = number[np.argsort(first[number], kind="stable")]
        begin, end = first[number], last[number]
        # not every turn begins and ends over the road: where two follow on each other they share the time between
        follows = begin[1:] - end[:-1] < LONGEST_FRAME / 2
        between = (end[:-1] + begin[1:]) / 2
        begin[1:][follows], end[:-1][follows] = between[follows], between[follows]
        # and one that none follows, or that follows none, is as long as the others
        turn = np.r_[False, follows] & np.r_[follows, False]
        if turn.any():
            length = float(np.median((end - begin)[turn]))
            begin = np.where(np.r_[False, follows] | ~np.r_[follows, False], begin, end - length)
            end = np.where(np.r_[follows, False] | ~np.r_[False, follows], end, begin + length)
        middle = np.full(65536, np.nan)
        turn = (end - begin < LONGEST_FRAME) & (end > begin)
        middle[number[turn]] = (begin[turn] + end[turn]) / 2
        return cls(middle)

    @classmethod
    def none(cls):
        return cls(np.full(65536, np.nan))

    @property
    def known(self):
        return bool(np.isfinite(self.middle).any())


def _may_be_turns(samples):
    """Whether any point_source_id of some points from all over the road was there for no longer than a turn."""
    source, time = (np.concatenate([getattr(points, name) for points in samples]) for name in ("source", "time"))
    order = np.argsort(source, kind="stable")
    source, time = source[order], time[order]
    begins = np.flatnonzero(np.r_[True, source[1:] != source[:-1]])
    return bool((np.maximum.reduceat(time, begins) - np.minimum.reduceat(time, begins) < LONGEST_FRAME).any())


@dataclass
class View:
    """How the elevation of a point is seen: at the point's own time, or where its whole turn was brought to
    the turn's middle; with the signs of roll and pitch."""

    passes: list
    frames: Frames
    by_frame: bool = False
    tilt: tuple = (0, 0)

    def elevation_bin(self, points):
        """(N,) int, the bin of elevation; -1 where no pass drove at the point's time."""
        found = np.full(len(points), -1)
        for rows, sight in self.sights(points):
            found[rows] = sight.elevation_bin(self.tilt)
        return found

    def sights(self, points):
        """(indices, Sight) of the points of each pass, the same for all tilts."""
        time, number = points.time, points.pass_number
        if self.by_frame:
            middle = self.frames.middle[points.source]
            time = np.where(np.isfinite(middle), middle, time)
        for p in self.passes:
            rows = np.flatnonzero((number == p.number) & (time >= p.time[0] - 1.0) & (time <= p.time[-1] + 1.0))
            if len(rows):
                yield rows, Sight.of(p, points[rows], time[rows])


@dataclass(frozen=True)
class Sight:
    """How points lie from the vehicle.

    reach, rise : (N,) m, horizontally and up; lean, nod : (N,) m that roll and pitch raise them by, 0 where neither is known
    """

    reach: np.ndarray
    rise: np.ndarray
    lean: np.ndarray
    nod: np.ndarray

    @classmethod
    def of(cls, p, points, time):
        px, py, pz = p.position(time)
        dx, dy = points.x - px, points.y - py
        if p.attitude is None:
            lean = nod = 0.0
        else:
            roll, pitch, heading = (np.interp(time, p.time, angle) for angle in p.attitude)
            c, n = np.cos(heading), np.sin(heading)
            lean, nod = roll * (dx * c - dy * n), pitch * (dx * n + dy * c)
        return cls(np.hypot(dx, dy), points.z - pz, lean, nod)

    def elevation_bin(self, tilt):
        """(N,) int; `tilt` are the signs of roll and pitch."""
        elevation = np.degrees(np.arctan2(self.rise + tilt[0] * self.lean + tilt[1] * self.nod, self.reach))
        return np.clip(np.floor((elevation - LOWEST) / STEP), -1, STEPS - 1).astype(int)


@dataclass
class Beams:
    """Beams of the scanners that have several.

    views : dict of scanner to View; beam : dict of scanner to (STEPS,) number of the beam by elevation
    shift : dict of scanner to (beams,) what is added to a beam's intensities, or what they are multiplied by
    added : dict of scanner to whether it is added
    """

    views: dict
    beam: dict
    shift: dict
    added: dict

    @classmethod
    def of(cls, road_points, frame, scanners, progress=Progress()):
        """Beams of a survey's scanners; None where every scanner has one, or all of one brightness."""
        samples = _samples(road_points, frame, scanners)
        if not samples:
            return None
        frames = Frames.of(road_points) if _may_be_turns([points for found in samples.values() for points in found]) else Frames.none()
        views = {scanner: view for scanner, found in samples.items() if (view := _sharpest(found, frame.passes, frames)) is not None}
        if not views:
            return None
        found = cls(views, {}, {}, {})
        counts = 0
        for section in ordered_map(lambda key: found._count(road_points.section(*key)), road_points.all_sections(), progress):
            counts = counts + section
        for scanner, levels in zip(views, counts):
            found._learn(scanner, levels)
        return found if found.shift else None

    def _count(self, points):
        """(scanners with beams, STEPS, LEVELS) how many points have each level at each elevation."""
        counts = np.zeros((len(self.views), STEPS, LEVELS), np.int64)
        for k, (scanner, view) in enumerate(self.views.items()):
            rows = np.flatnonzero(points.scanner == scanner)
            place = view.elevation_bin(points[rows])
            known = place >= 0
            flat = place[known] * LEVELS + to_level(points.intensity[rows][known])
            counts[k] = np.bincount(flat, minlength=STEPS * LEVELS).reshape(STEPS, LEVELS)
        return counts

    def _learn(self, scanner, levels):
        """What brings each beam's asphalt to the level of all, from (STEPS, LEVELS) counts."""
        smooth = gaussian_filter1d(levels.sum(axis=1).astype(float), 1.0)
        valleys = np.flatnonzero((smooth[1:-1] <= smooth[:-2]) & (smooth[1:-1] < smooth[2:])) + 1
        starts = np.r_[0, valleys]
        median, lower = asphalt_of(np.add.reduceat(levels, starts, axis=0))
        weight = np.add.reduceat(levels.sum(axis=1), starts)
        known = np.flatnonzero(np.isfinite(median) & (median > 0))
        if len(known) < 2 * BESIDE:
            return
        reference = weighted_median(median[known], weight[known])
        padded = np.pad(median[known], BESIDE, mode="edge")
        beside = np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * BESIDE + 1), axis=1)
        if weighted_median(np.abs(median[known] - beside), weight[known]) < UNEQUAL * reference:
            return
        # a beam that hardly met the road is taken for its neighbour
        median = np.interp(np.arange(len(median)), known, median[known])
        self.beam[scanner] = np.searchsorted(starts, np.arange(STEPS), side="right") - 1
        self.added[scanner] = is_logarithmic(median[known], lower[known], weight[known])
        self.shift[scanner] = reference - median if self.added[scanner] else reference / median

    def even(self, points):
        """(N,) float intensity as if all beams were alike."""
        value = points.intensity.astype(float)
        for scanner, shift in self.shift.items():
            rows = np.flatnonzero(points.scanner == scanner)
            place = self.views[scanner].elevation_bin(points[rows])
            rows, place = rows[place >= 0], place[place >= 0]
            by = shift[self.beam[scanner][place]]
            value[rows] = np.maximum(value[rows] + by, 0.0) if self.added[scanner] else value[rows] * by
        return value

    @property
    def count(self):
        """How many beams were evened."""
        return sum(len(shift) for shift in self.shift.values())


def _samples(road_points, frame, scanners):
    """{scanner: [Points]} of a few windows of each road, at the same stations however the sections are cut; scanners without are left out."""
    samples = {}
    for road in road_points.roads():
        start, end = frame.road(road).start, frame.road(road).end
        for s in np.linspace(start, max(end - WINDOW, start), WINDOWS):
            points = road_points.window(road, s, s + WINDOW)
            of = points.scanner
            for scanner in range(scanners):
                rows = np.flatnonzero(of == scanner)
                if len(rows) >= FEWEST:
                    some = points[rows[::-(-len(rows) // MOST)]].records
                    # on their own, so that the sections they come from are let go
                    alone = Columns({name: some[name] for name in SIGHTED}, np.dtype([(name, some.dtype[name]) for name in SIGHTED]))
                    samples.setdefault(scanner, []).append(Points(alone))
    return {scanner: samples[scanner] for scanner in sorted(samples)}


def _sharpest(samples, passes, frames):
    """The view in which points gather most clearly in rings; None where they do in no view."""
    tilts = TILTS if any(p.attitude is not None for p in passes) else TILTS[:1]
    best, sharpest = RINGS, None
    for by_frame in (False, True) if frames.known else (False,):
        view = View(passes, frames, by_frame)
        sights = [sight for points in samples for _, sight in view.sights(points)]
        for tilt in tilts:
            found = sharpness(sum((_histogram(sight.elevation_bin(tilt)) for sight in sights), np.zeros(STEPS)))
            if found > best:
                best, sharpest = found, replace(view, tilt=tilt)
    return sharpest


def _histogram(place):
    return np.bincount(place[place >= 0], minlength=STEPS).astype(float)


def sharpness(counts):
    """How much fuller than the mean of a degree about it the elevation of a point is on average: 1 where they lie evenly."""
    total = counts.sum()
    if total < STEPS:
        return 0.0
    # a point is no company for itself
    return float((counts * (counts - 1)).sum() / max((counts * gaussian_filter1d(counts, 0.5 / STEP)).sum(), 1e-9))
