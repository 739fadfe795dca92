"""The scan lattice of a survey: the scan line of every point and its place on the line, from LAS fields alone.

The angle of a point about the trajectory turns with the scanner's mirror. The frequency at which angle and time fit best is found in short windows;
then the phase is tracked along the pass, which allows for a varying rotation rate, tunnels, clipped clouds and missing points. Where the angles do
not show the rotation, the gap that the sky leaves in every turn may still show in the times.

.. [1] Kohira and Masuda (2017), ISPRS Annals: points as pixels by time and scanner parameters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from ...common.arrays import RADIX_BITS
from ...common.progress import Progress
from ...execution.in_step import Asked, Work, in_step
from ...execution.phase import Phase
from ..store.records import COORDINATE_SCALE
from ..weights import LATTICE

TIME_SORT_TICK = 2.0**-22      # derived: s: finer than the resolution of any clock
# why a scanner has no regular lines
COARSE_TIMES = "neighbouring points share one time and so have no order"
AT_ONCE = "points at one time lie far apart as those of many beams do or where times are very coarse"
DISORDER = "the times do not give the order of the points on a line"
TO_AND_FRO = "points that follow each other in time lie to and fro over the road as those of many beams do or of several scanners without a field"
TOO_THIN = "the points of a line lie too far apart as in a thinned cloud"
NO_TURNING = "no mirror is seen to turn steadily"


@dataclass
class ScanLattice:
    """The mirror phases of a survey."""

    mirror_phases: dict[tuple[int, int], MirrorPhase] = field(default_factory=dict)   # {(pass number, scanner): MirrorPhase}
    without: dict[tuple[int, int], str] = field(default_factory=dict)   # (pass number, scanner) that have no regular scan lines, and why
    notes: list[str] = field(default_factory=list)   # sentences for the user about these


def find_lattice(survey: Any, rotation_frequency: float = 0.0, progress: Progress = Progress()) -> ScanLattice:
    """The scan lattice of every pass and scanner of a Survey. rotation_frequency : Hz, turns of the mirror per second; 0 = from the data"""
    return in_step([lattice_of(survey, rotation_frequency, progress)], survey.executor, progress)[0]


def lattice_of(survey: Any, rotation_frequency: float, progress: Progress) -> Work:
    """The work of `find_lattice`; `progress` is told what was found."""
    lattice = ScanLattice()
    if not survey.has_time:
        lattice.notes.append("Without gps_time in the cloud and time in the trajectory scan lines cannot be distinguished; "
                             "scanlines are made of the points near each section plane.")
    roads = survey.store.roads() if survey.has_time else []
    # the samples of all roads together would take much memory
    for i, road in enumerate(roads):
        samples = yield from _sample_windows(survey, road, (i + 0.3) / len(roads))
        rotations = {}
        for key, windows in samples.items():
            rotation = _rotation(windows, rotation_frequency)
            if rotation is None:
                lattice.without[key] = _why_none(windows)
            else:
                rotations[key] = rotation
        phases = yield from _mirror_phases(survey, road, rotations, samples, (i + 1) / len(roads))
        lattice.mirror_phases.update(phases)
        lattice.without.update({key: NO_TURNING for key in rotations if key not in phases})
    _report_lattice(lattice, progress)
    return lattice


def _report_lattice(lattice, progress):
    phases, missing = lattice.mirror_phases, lattice.without
    if phases:
        rates = sorted({f"{abs(mirror.frequency) / mirror.spacing:.2f}" for mirror in phases.values()}, key=float)
        progress.info(f"Scan lattice found for {len(phases)} run(s) of a scanner: {', '.join(rates)} lines per second.")
    if missing:
        reasons = ", ".join(sorted(set(missing.values())))
        lattice.notes.append(f"There are no regular scan lines in {len(missing)} of {len(phases) + len(missing)} run(s) of a scanner ({reasons}); "
                             "there scanlines are made of the points near each section plane.")
    elif not phases and not lattice.notes:
        lattice.notes.append(f"There are too few points to distinguish scan lines (fewer than {LATTICE.min_window_points} in "
                             f"{LATTICE.rotation_window:g} s of each scanner); scanlines are made of the points near each section plane.")
    progress.warn_all(lattice.notes)


@dataclass
class _RotationWindow:
    """A short time of one scanner's points: (N,) seconds, exp(i angle) and offsets in metres."""

    time: np.ndarray
    phasor: np.ndarray
    offset: np.ndarray


def scanner_runs(records: Any) -> list[tuple[tuple[int, int], Any]]:
    """[((pass number, scanner), records of its first returns)] of (N,) records, ascending."""
    if not len(records):
        return []
    passes, scanner = records["pass_number"], records["scanner"]
    number = int(passes[0])
    # Most sections have one pass and few scanners: then comparing bytes is enough.
    if (passes == number).all():
        values = [number * 256 + value for value in range(int(scanner.min()), int(scanner.max()) + 1) if (scanner == value).any()]
        key = scanner
    else:
        key = passes.astype(np.uint32) * np.uint32(256) + scanner
        values, number = np.flatnonzero(np.bincount(key)).tolist(), 0
    first = (records["returns"] & 15) <= 1
    if len(values) == 1 and first.all():
        return [(divmod(values[0], 256), records)]
    return [(divmod(value, 256), records[(key == value - 256 * number) & first]) for value in values]


def _phasors(survey, number, records):
    """(N,) times and exp(i angle about the trajectory) of records of one pass."""
    p = survey.frame.passes[number]
    time = np.ascontiguousarray(records["time"])
    raised = max(LATTICE.min_axis_height - survey.sensor_height.get(number, LATTICE.min_axis_height), 0.0)
    across = records["d"] * COORDINATE_SCALE - np.interp(time, p.time, p.d)
    above = records["z"] * COORDINATE_SCALE - np.interp(time, p.time, p.z) - raised
    size = np.hypot(across, above)
    return time, (above + 1j * across) / np.where(size > 0, size, 1.0)


def _sample_windows(survey, road, until):
    """Part of a work: {(pass number, scanner): list of _RotationWindow} at places spread along each pass."""
    places = []
    for p in survey.frame.passes_of(road):
        first, last = p.span
        count = int(np.clip((last - first) / LATTICE.rotation_sample_length, 1, LATTICE.rotation_samples))
        places += [(p.number, middle) for middle in first + (np.arange(count) + 0.5) * (last - first) / count]

    samples: dict[tuple[int, int], list[_RotationWindow]] = {}
    phase = Phase(_windows_at, survey, (road,), **survey.along(lambda place: (road, place[1], place[1])))
    for windows in (yield Asked(phase, places, until)):
        for key, window in windows.items():
            samples.setdefault(key, []).append(window)
    return samples


def _windows_at(survey: Any, place: tuple[int, float], road: int) -> dict[tuple[int, int], _RotationWindow]:
    """The phase that looks at half a second of a pass, by its number, about a station: {(pass number, scanner): its points} of those that measured
    enough then."""
    number, middle = place
    columns: dict = {}
    bounds = np.linspace(middle - LATTICE.rotation_sample_length / 2, middle + LATTICE.rotation_sample_length / 2, LATTICE.rotation_sample_pieces + 1)
    for start, end in zip(bounds[:-1], bounds[1:]):   # all at once would be too many
        for key, records in scanner_runs(survey.window(road, start, end).records):
            if key[0] == number:
                columns.setdefault(key, []).append([np.array(records[name]) for name in ("time", "d", "z")])
    windows = {}
    for key, parts in columns.items():
        near = _near_in_time([time for time, *_ in parts])
        if sum(map(len, near)) >= LATTICE.min_window_points:
            time, d, z = (np.concatenate([values[rows] for values, rows in zip(column, near)]) for column in zip(*parts))
            order = time_order(time)
            time, phasor = _phasors(survey, number, dict(time=time[order], d=d[order], z=z[order]))
            windows[key] = _RotationWindow(time, phasor, d[order] * COORDINATE_SCALE)
    return windows


def _near_in_time(parts):
    """Of every part of the times of a scanner, the indices of those about the middle one."""
    begins = np.cumsum([0] + [len(time) for time in parts[:-1]])
    middle = np.median(np.concatenate([time[-begin % LATTICE.median_time_stride::LATTICE.median_time_stride] for time, begin in zip(parts, begins)]))
    return [np.flatnonzero(np.abs(time - middle) <= LATTICE.rotation_window / 2) for time in parts]


def time_order(time: np.ndarray) -> np.ndarray:
    """(N,) indices that sort (N,) times in seconds: by radix, in linear time unless the times span days."""
    ticks = ((time - time.min()) / TIME_SORT_TICK).astype(np.int64)
    order = np.argsort(ticks.astype(np.uint16), kind="stable")
    for shift in range(RADIX_BITS, int(ticks.max()).bit_length(), RADIX_BITS):
        order = order.take(np.argsort((ticks >> shift).astype(np.uint16).take(order), kind="stable"))
    return order


def _rotation(windows, given):
    """(frequency, "angle" or "gap") of one scanner's windows, None where there is no lattice."""
    frequency, peak = strongest_rotation([rotation_spectrum(w.time, w.phasor) for w in windows], given)
    if peak >= LATTICE.min_rotation_peak and _on_lines(windows):
        return frequency, "angle"
    times_only = [rotation_spectrum(w.time, np.ones(len(w.time), complex)) for w in windows]
    frequency, peak = strongest_rotation(times_only, given, signed=False)
    if peak >= LATTICE.min_rotation_peak and _on_lines(windows):
        return frequency, "gap"
    return None


def _on_lines(windows):
    """Whether successive points have different times and lie side by side, mostly one way, as on a scan line."""
    distinct, step, one_way = _steps(windows)
    return bool(distinct >= LATTICE.min_distinct_times and step < LATTICE.max_point_step and one_way > LATTICE.min_one_way_share)


def _steps(windows):
    """Share of points with a time of their own, median m across from point to point in time, and share of these steps that go the same way.

    The last two are infinite and 0 for too few steps.
    """
    later = np.concatenate([np.diff(w.time) > 0 for w in windows])
    steps = np.concatenate([np.diff(w.offset) for w in windows])[later]
    if len(steps) < LATTICE.min_window_points:
        return float(np.mean(later)), np.inf, 0.0
    onward = float(np.mean(steps > 0))
    return float(np.mean(later)), float(np.median(np.abs(steps))), max(onward, 1 - onward)


def _spread_at_once(window):
    """(K,) m across between the outermost points of each time that several share."""
    first = np.r_[0, np.flatnonzero(np.diff(window.time)) + 1]
    spread = np.maximum.reduceat(window.offset, first) - np.minimum.reduceat(window.offset, first)
    return spread[np.diff(np.r_[first, len(window.time)]) > 1]


def _why_none(windows):
    """What the points of a scanner without regular lines show of the reason."""
    distinct, step, one_way = _steps(windows)
    if distinct < LATTICE.min_distinct_times:
        return COARSE_TIMES if np.median(np.concatenate([_spread_at_once(w) for w in windows])) < LATTICE.max_point_step else AT_ONCE
    if one_way <= LATTICE.min_one_way_share:
        return DISORDER if step < LATTICE.same_place_step else TO_AND_FRO
    return TOO_THIN if step >= LATTICE.max_point_step else NO_TURNING


def _mirror_phases(survey, road, rotations, samples, until):
    """Part of a work: the mirror phases of the scanners whose frequency is known, from the points of a whole road."""
    if not rotations:
        return {}
    bins = _bins_of(survey, rotations)
    per_turn = min(np.median([len(w.time) / (np.ptp(w.time) * abs(frequency)) for w in samples[key]]) for key, (frequency, _) in rotations.items())
    stride = 2 * int(max(per_turn / LATTICE.max_points_per_turn, 1.0) / 2) + 1   # every how many points one is used; odd
    mounts = {key: _mounting(samples[key], frequency) for key, (frequency, origin) in rotations.items() if origin == "angle"}

    first, last = survey.store.span(road)
    # A length of its own, so that the points that are used do not depend on the length of sections.
    stretches = range(int(first // LATTICE.phase_stretch), int(last // LATTICE.phase_stretch) + 1)
    phase = Phase(_phasors_of_stretches, survey, (road, stride, rotations, mounts), listed=LATTICE.stretches_together, **survey.along(
        lambda numbers: (road, numbers[0] * LATTICE.phase_stretch, (numbers[-1] + 1) * LATTICE.phase_stretch)))
    for gathered in (yield Asked(phase, stretches, until)):
        for key, sums in gathered:
            bins[key].add(*sums)
    phases = {}
    for key, (frequency, origin) in rotations.items():
        b = bins[key]
        mirror = _mirror_phase_from_phasors(frequency, b.since, b.phasor, b.count, b.length, b.start, origin=origin)
        if mirror is not None:
            phases[key] = replace(mirror, **_line_properties(samples[key], mirror))
    return phases


def _bins_of(survey, rotations):
    return {key: _PhasorBins(survey.frame.passes[key[0]], LATTICE.turns_per_bin / abs(frequency)) for key, (frequency, _) in rotations.items()}


def _phasors_of_stretches(survey: Any, numbers: Sequence[int], road: int, stride: int, rotations: dict[tuple[int, int], tuple[float, str]],
                         mounts: dict[tuple[int, int], np.ndarray]) -> list[list[tuple[tuple[int, int], tuple[Any, ...]]]]:
    """The phase that sums phasors over time: of each stretch of `phase_stretch`, by its number, those of each scanner, as of `_PhasorBins`."""
    bins, result = _bins_of(survey, rotations), []
    for number in numbers:
        records = survey.window(road, number * LATTICE.phase_stretch, (number + 1) * LATTICE.phase_stretch).records[::stride]
        result.append([(key, _phasor_sums(survey, key[0], first_returns, rotations[key], mounts.get(key), bins[key]))
                       for key, first_returns in scanner_runs(records) if key in rotations and len(first_returns)])
    return result


def _phasor_sums(survey, number, records, rotation, mounting, bins):
    """Sums over the bins of the phasors of one scanner's records, relative to its even rotation."""
    frequency, origin = rotation
    time, phasor = _phasors(survey, number, records)
    # With the gap of the sky in every turn, the points' times alone have a mean phase half a turn from the zenith.
    phasor = np.full(len(time), -1.0 + 0j) if origin == "gap" else phasor * mounting[_direction_number(phasor)]
    since = time - bins.start
    return bins.sums_of(since, phasor * np.exp(-2j * np.pi * frequency * since))


def _direction_number(phasor):
    return ((np.angle(phasor) / (2 * np.pi) + 0.5) * LATTICE.mounting_directions).astype(np.int64) % LATTICE.mounting_directions


def _mounting(windows, frequency):
    """(`mounting_directions`,) complex: the mirror's phase minus the angle at which its points are seen, as phasors.

    For a scanner that is rotated, tilted or mounted beside the trajectory, the angles are not proportional to the
    mirror's phase; with this correction every point gives the same phase, wherever it lies.
    """
    total = np.zeros(LATTICE.mounting_directions, complex)
    length = LATTICE.turns_per_bin / abs(frequency)
    for w in windows:
        rows = slice(None, None, max(len(w.time) // LATTICE.max_mounting_points, 1))
        time, directions = w.time[rows], w.phasor[rows]
        bins = _PhasorBins(w, length)
        first, count, since, phasor = bins.sums_of(time - bins.start, directions * np.exp(-2j * np.pi * frequency * (time - bins.start)))
        mirror = _mirror_phase_from_phasors(frequency, since, phasor, count, length, bins.start)
        if mirror is not None:
            ahead = np.exp(2j * np.pi * np.sign(frequency) * mirror.turns_at(time)) * np.conj(directions)
            real, imaginary = (np.bincount(_direction_number(directions), part, LATTICE.mounting_directions) for part in (ahead.real, ahead.imag))
            total += real + 1j * imaginary
    # directions without points take the value of their neighbours
    near = np.array([total, np.roll(total, 1), np.roll(total, -1), np.roll(total, 2), np.roll(total, -2)]).sum(axis=0)
    return np.where(near == 0, 1.0, near / np.maximum(np.abs(near), 1e-12))


class _PhasorBins:
    """Sums over the points of short bins of time, from a second before the first time of a pass or window."""

    def __init__(self, p, length):
        self.start, self.length = float(p.time[0]) - 1.0, length
        size = int((p.time[-1] + 1.0 - self.start) / length) + 2
        self.count, self.since, self.phasor = np.zeros(size), np.zeros(size), np.zeros(size, complex)

    def sums_of(self, since, phasor):
        """First bin of some points and, from it on, their counts, times and phasors."""
        bin_of = np.clip((since / self.length).astype(np.int64), 0, len(self.count) - 1)
        first = int(bin_of.min())
        bin_of -= first
        return (first, np.bincount(bin_of), np.bincount(bin_of, since),
                np.bincount(bin_of, phasor.real) + 1j * np.bincount(bin_of, phasor.imag))

    def add(self, first, count, since, phasor):
        bins = slice(first, first + len(count))
        self.count[bins] += count
        self.since[bins] += since
        self.phasor[bins] += phasor


def _turns_between_lines(line, phase):
    """(K,) turns from one line to the next in the same sector of a turn; half turns may remain of a cloud that was thinned by its times."""
    line = line - line.min()
    turns = int(line.max()) + 1
    lines = np.unique((phase * LATTICE.line_sectors).astype(np.int64) * turns + line)
    return np.diff(lines)[np.diff(lines // turns) == 0]


def _line_properties(windows, mirror):
    """`pulse`, `spacing` and `leftward` of a MirrorPhase, from the points of the windows."""
    gaps, turn_parts, onward = [], [], 0
    for w in windows:
        step = np.diff(w.time)
        usual = np.median(step[step > 0])
        # the mean, since a coarse clock counts in steps as long as the pulse interval
        gaps.append(np.mean(step[(step > 0) & (step < 1.5 * usual)]))
        turn_parts.append(_turns_between_lines(*mirror.lines_and_phase(w.time)))
        onward += np.sign(np.diff(w.offset)).sum()
    turns = np.concatenate(turn_parts)
    return dict(pulse=float(np.median(gaps) * abs(mirror.frequency)), spacing=int(np.median(turns)) if len(turns) else 1,
                leftward=bool(mirror.frequency < 0 if mirror.origin == "angle" else onward > 0))


# The phase of a scanner's mirror: turns as a function of time.


@dataclass(frozen=True)
class MirrorPhase:
    """The turns of one scanner's mirror during one pass; a scan line is a turn."""

    frequency: float   # Hz, the mean; negative where the mirror turns clockwise seen in the direction of the road
    time: np.ndarray   # time, turns: (K,) seconds and turns of nodes between which the mirror turns evenly; turns increase
    turns: np.ndarray
    pulse: float = 0.0   # usual share of a turn between neighbouring points of a line
    spacing: int = 1   # turns between neighbouring lines, more than 1 where lines were left out of the cloud
    leftward: bool = False   # whether the lines run to the left, offset increasing with time
    origin: str = "angle"   # "angle" where the phase follows from the points' angles, "gap" where it follows from gaps in their times

    def turns_at(self, time: np.ndarray) -> np.ndarray:
        """(N,) turns since the pass began, at (N,) times in seconds: whole turns count lines, the fraction is the mirror phase."""
        time = np.asarray(time, float)
        return _interpolate(time, self.time, self.turns, abs(self.frequency))

    def times_at(self, turns: np.ndarray) -> np.ndarray:
        """(N,) seconds at which the mirror had made (N,) turns."""
        turns = np.asarray(turns, float)
        return _interpolate(turns, self.turns, self.time, 1.0 / abs(self.frequency))

    def lines_and_phase(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Line number (N,) int64 and mirror phase (N,) in turns of points at (N,) seconds: 0 at the zenith, 0.5 below."""
        turns = self.turns_at(time)
        line = np.floor(turns)
        return line.astype(np.int64), turns - line


def _interpolate(x, nodes, values, rate):
    """Values at x between nodes, extrapolated linearly beyond them (at `rate` where there is one node)."""
    inside = np.interp(x, nodes, values)
    before, behind = np.minimum(x - nodes[0], 0.0), np.maximum(x - nodes[-1], 0.0)
    if len(nodes) < 2:
        return inside + rate * (before + behind)
    first, last = np.diff(values[:2]) / np.diff(nodes[:2]), np.diff(values[-2:]) / np.diff(nodes[-2:])
    return inside + first * before + last * behind


def _mirror_phase_from_phasors(frequency: float, time: np.ndarray, phasor: np.ndarray, count: np.ndarray, bin_length: float,
                              start: float = 0.0, **fields: Any) -> MirrorPhase | None:
    """The mirror phase of a pass from the mean phase of its bins; None where no bin has a phase.

    frequency : Hz, signed, near the truth
    time : (B,) seconds since the start, sums over the points of each bin
    phasor : (B,) complex, sums of exp(i (angle - 2 pi frequency t)) over the points of each bin
    count : (B,) points
    bin_length, start : seconds
    fields : further attributes of the MirrorPhase
    """
    usable = np.flatnonzero((count >= LATTICE.min_phase_bin_points) & (np.abs(phasor) >= LATTICE.min_phase_coherence * count))
    if not len(usable):
        return None
    usable = usable[count[usable] >= LATTICE.min_phase_bin_share * np.median(count[usable])]
    time = time[usable] / count[usable]
    # even rotation, and what the mirror was ahead of it
    turns = np.sign(frequency) * (frequency * time + _unwrap(time, np.angle(phasor[usable]), bin_length) / (2 * np.pi))
    rising = np.r_[True, np.diff(np.maximum.accumulate(turns)) > 0]
    time, turns = time[rising], turns[rising]
    mean = (turns[-1] - turns[0]) / (time[-1] - time[0]) if len(time) > 1 else abs(frequency)
    time, turns = _smooth_nodes(time, turns, bin_length)
    return MirrorPhase(float(np.sign(frequency) * mean), start + time, turns - np.floor(turns[0]), **fields)


def _smooth_nodes(time, turns, bin_length):
    """`nodes_per_bin` nodes per bin on a cubic spline: with linear pieces the points of neighbouring lines would not line up."""
    if len(time) < 4:
        return time, turns
    steps = np.minimum(np.ceil(np.diff(time) / bin_length * LATTICE.nodes_per_bin), LATTICE.nodes_per_bin).astype(np.int64)
    share = np.concatenate([np.arange(n) / n for n in steps])
    piece = np.repeat(np.arange(len(steps)), steps)
    fine = np.r_[time[piece] + share * np.diff(time)[piece], time[-1]]
    smooth = CubicSpline(time, turns)(fine)
    return (fine, smooth) if (np.diff(smooth) > 0).all() else (time, turns)


def _unwrap(time, phase, bin_length):
    """(K,) phases, each within half a turn of the one that the rate before it predicts."""
    gaps = np.diff(time)
    step = (np.diff(phase) + np.pi) % (2 * np.pi) - np.pi
    near = gaps < LATTICE.max_phase_bin_gap * bin_length
    if near.any() and not near.all():
        before = np.maximum.accumulate(np.where(near, np.arange(len(near)), -1))
        rate = np.where(before >= 0, (step / gaps)[before], 0.0)
        predicted = rate * gaps
        step = np.where(near, step, predicted + (np.diff(phase) - predicted + np.pi) % (2 * np.pi) - np.pi)
    return phase[0] + np.r_[0.0, np.cumsum(step)]


# The rotation rate of a scanner's mirror, from the times and angles of its points.

SPECTRUM_CELL = 1.0 / 2048.0    # cost: s
SPECTRUM_SIZE = 8192            # cost: cells, zero-padded: a step of 0.25 Hz


def rotation_spectrum(time: np.ndarray, phasor: np.ndarray) -> np.ndarray:
    """How well (N,) points fit each rotation frequency: |mean(exp(i (angle - 2 pi f t)))| (our own), as (SPECTRUM_SIZE,) from 0 to 1.

    The times, (N,) seconds, span at most `rotation_window`; phasors are exp(i angle). The order is that of `numpy.fft.fftfreq`.
    """
    cell = ((time - time.min()) / SPECTRUM_CELL).astype(np.int64)
    size = int(cell.max()) + 1
    total = np.bincount(cell, phasor.real, size) + 1j * np.bincount(cell, phasor.imag, size)
    # averaging over a cell attenuates high frequencies by sinc
    return np.abs(np.fft.fft(total, SPECTRUM_SIZE)) / len(time) / np.sinc(np.fft.fftfreq(SPECTRUM_SIZE, 1.0))


def strongest_rotation(spectra: Sequence[np.ndarray], given: float = 0.0, signed: bool = True) -> tuple[float, float]:
    """The frequency (Hz) that all windows of one scanner fit best, and its peak: the median of the windows' peaks, 0 to 1.

    The peak is 0 where the opposite rotation fits nearly as well, as for scanners that spin about the vertical.

    spectra : (SPECTRUM_SIZE,) of each window
    given : Hz, where the user knows it; 0 = not known
    signed : whether the direction of rotation shows; otherwise the frequency is positive
    """
    f = np.fft.fftfreq(SPECTRUM_SIZE, SPECTRUM_CELL)
    allowed = (np.abs(f) >= LATTICE.min_rotation) & (np.abs(f) <= LATTICE.max_rotation)
    if given:
        allowed &= np.abs(np.abs(f) - given) <= LATTICE.rotation_tolerance * given + 0.25
    if not signed:
        allowed &= f > 0
    mean = np.mean(spectra, axis=0)
    best = int(np.argmax(np.where(allowed, mean, -1.0)))
    near = np.abs(f - f[best]) <= LATTICE.rotation_tolerance * abs(f[best]) + 0.5
    opposite = np.abs(f + f[best]) <= LATTICE.rotation_tolerance * abs(f[best]) + 0.5
    peak = float(np.median([spectrum[near].max() for spectrum in spectra]))
    if signed and peak < LATTICE.min_direction_ratio * float(np.median([spectrum[opposite].max() for spectrum in spectra])):
        return float(f[best]), 0.0
    return float(f[best]), peak
