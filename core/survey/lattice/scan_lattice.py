"""The scan lattice of a survey: which line and which place in it every point has, from LAS fields alone.

The angle of a point about the trajectory turns with the scanner's mirror. The frequency that makes
angle and time agree best is sought in short windows, then the phase is tracked along the pass, so that
a wandering rotation, tunnels, clipped clouds and lost points do no harm. Where the angles say nothing the
gap that the sky leaves in every turn may still show in the times.

References
----------
.. [1] Kohira and Masuda (2017), ISPRS Annals: points as pixels by time and scanner parameters.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from ...common.order_statistics import BITS
from ...common.parallel import in_order
from ...common.progress import Progress
from ..store.records import COORDINATE_SCALE, take_rows
from .mirror_phase import mirror_phase_from_phasors
from .rotation_rate import LEAST_PEAK, WINDOW, clearest_rotation, spectrum

SAMPLES = 6           # places along a pass at which the frequency is sought
SAMPLE_LENGTH = 30.0  # m of road about them: lines slant, and of a short piece of road see little each
FEWEST = 200          # points of a scanner in a window
LEAST_TIMED = 0.7     # of the points: where more share their times, these do not tell their order on the line
NEAR, ONE_WAY = 0.5, 0.75  # m across from point to point of a line, and the share of steps that go one way
SPARSE = 15           # every how manieth point tells when a place was scanned
TICK = 2.0**-22       # s: finer than any clock's steps
BIN_TURNS = 10        # turns whose points tell one phase
STRETCH = 20.0        # m of road looked at in one go
POINTS_PER_TURN = 40  # looked at for it; more tell no more
LOWEST_AXIS = 1.5     # m above the road: from below, angles of road points tell nothing
SECTORS = 36          # of a turn, in each of which lines are counted
ENOUGH = 10_000       # points of a window that tell the mounting of a scanner
DIRECTIONS = 360      # about the trajectory, for which the mounting of a scanner is told


@dataclass
class ScanLattice:
    """The mirror clocks of a survey, by (pass number, scanner); those without a lattice are not there.

    `without` lists the (pass number, scanner) that were looked at in vain, `notes` says so in words.
    """

    mirror_phases: dict = field(default_factory=dict)
    without: list = field(default_factory=list)
    notes: list = field(default_factory=list)


def find_lattice(survey, rotation_frequency=0.0, progress=Progress()):
    """The scan lattice of every pass and scanner of a survey.

    Parameters
    ----------
    survey : Survey
    rotation_frequency : Hz, turns of the mirror per second; 0 = from the data

    Returns
    -------
    ScanLattice
    """
    lattice = ScanLattice()
    if not survey.has_time:
        lattice.notes.append("The points have no gps_time, so there are no scan lines to tell apart; "
                             "scanlines are made of the points near each section plane.")
        progress.warn(lattice.notes[0])
        return lattice
    roads = survey.store.roads()
    for i, road in enumerate(roads):
        samples = _samples(survey, road)
        found = {}
        for key, windows in samples.items():
            rotation = _rotation(windows, rotation_frequency)
            if rotation is None:
                lattice.without.append(key)
            else:
                found[key] = rotation
        clocks = _clocks(survey, road, found, samples, progress.part(i / len(roads), (i + 1) / len(roads)))
        lattice.mirror_phases.update(clocks)
        lattice.without += [key for key in found if key not in clocks]
    _tell(lattice, survey, progress)
    return lattice


def _tell(lattice, survey, progress):
    if lattice.mirror_phases:
        rates = sorted({f"{abs(clock.frequency) / clock.spacing:.2f}" for clock in lattice.mirror_phases.values()}, key=float)
        progress.say(f"Scan lattice found for {len(lattice.mirror_phases)} run(s) of a scanner: {', '.join(rates)} lines per second.")
    if not lattice.mirror_phases and not lattice.without:
        lattice.notes.append(f"There are too few points to tell scan lines apart (fewer than {FEWEST} in {WINDOW:g} s of each scanner); "
                             "scanlines are made of the points near each section plane.")
        progress.warn(lattice.notes[-1])
    if lattice.without:
        note = (f"There are no regular scan lines in {len(lattice.without)} of {len(lattice.mirror_phases) + len(lattice.without)} run(s) "
                "of a scanner (a head with many beams, a thinned cloud, or times too coarse); "
                "there scanlines are made of the points near each section plane.")
        lattice.notes.append(note)
        progress.warn(note)


@dataclass
class _Window:
    """Some time of one scanner's points: seconds, exp(i angle), offsets (m)."""

    time: np.ndarray
    phasor: np.ndarray
    offset: np.ndarray


def scanner_runs(records):
    """[((pass number, scanner), records of first returns)] of a section's records."""
    if not len(records):
        return []
    passes, scanner = records["pass_number"], records["scanner"]
    number = int(passes[0])
    # of one pass and few scanners, as most sections are, comparing bytes is all that is needed
    if (passes == number).all():
        values = [number * 256 + value for value in range(int(scanner.min()), int(scanner.max()) + 1) if (scanner == value).any()]
        key = scanner
    else:
        key = passes.astype(np.uint32) * np.uint32(256) + scanner
        values, number = np.flatnonzero(np.bincount(key)).tolist(), 0
    first = (records["returns"] & 15) <= 1
    if len(values) == 1 and first.all():
        return [(divmod(values[0], 256), records)]
    return [(divmod(value, 256), take_rows(records, (key == value - 256 * number) & first)) for value in values]


def phasors(survey, number, records):
    """(N,) times and exp(i angle about the trajectory) of records of one pass."""
    p = survey.frame.passes[number]
    time = np.ascontiguousarray(records["time"])
    raised = max(LOWEST_AXIS - survey.sensor_height.get(number, LOWEST_AXIS), 0.0)
    across = records["d"] * COORDINATE_SCALE - np.interp(time, p.time, p.d)
    above = records["z"] * COORDINATE_SCALE - np.interp(time, p.time, p.z) - raised
    size = np.hypot(across, above)
    return time, (above + 1j * across) / np.where(size > 0, size, 1.0)


def _samples(survey, road):
    """{(pass number, scanner): list of _Window} at places spread along each pass."""
    places = []
    for p in survey.frame.passes_of(road):
        first, last = p.span
        count = int(np.clip((last - first) / SAMPLE_LENGTH, 1, SAMPLES))
        places += [(p.number, middle) for middle in first + (np.arange(count) + 0.5) * (last - first) / count]

    def look(place):
        number, middle = place
        records = survey.window(road, middle - SAMPLE_LENGTH / 2, middle + SAMPLE_LENGTH / 2).records
        seen = {}
        for key, own in scanner_runs(records):
            if key[0] != number:
                continue
            time = own["time"]
            near = np.flatnonzero(np.abs(time - np.median(time[::SPARSE])) <= WINDOW / 2)
            if len(near) >= FEWEST:
                own = take_rows(own, near[time_order(time[near])])
                seen[key] = _Window(*phasors(survey, number, own), own["d"] * COORDINATE_SCALE)
        return seen

    samples = {}
    for seen in in_order(look, places):
        for key, window in seen.items():
            samples.setdefault(key, []).append(window)
    return samples


def time_order(time):
    """(N,) indices that sort times: by their digits, in linear time, unless the times span days."""
    ticks = ((time - time.min()) / TICK).astype(np.int64)
    order = np.argsort(ticks.astype(np.uint16), kind="stable")
    for shift in range(BITS, int(ticks.max()).bit_length(), BITS):
        order = order[np.argsort((ticks >> shift).astype(np.uint16)[order], kind="stable")]
    return order


def _rotation(windows, given):
    """(frequency, peak, "angle" or "gap") of one scanner's windows, None where there is no lattice."""
    frequency, peak = clearest_rotation([spectrum(w.time, w.phasor) for w in windows], given)
    if peak >= LEAST_PEAK and _in_order(windows):
        return frequency, peak, "angle"
    alone = [spectrum(w.time, np.ones(len(w.time), complex)) for w in windows]
    frequency, peak = clearest_rotation(alone, given, signed=False)
    if peak >= LEAST_PEAK and _in_order(windows):
        return frequency, peak, "gap"
    return None


def _in_order(windows):
    """Whether points that follow on each other have times of their own and lie side by side, as on a line, mostly one way."""
    later = np.concatenate([np.diff(w.time) > 0 for w in windows])
    steps = np.concatenate([np.diff(w.offset) for w in windows])[later]
    if len(steps) < FEWEST or np.mean(later) < LEAST_TIMED:
        return False
    onward = np.mean(steps > 0)
    return bool(np.median(np.abs(steps)) < NEAR and max(onward, 1 - onward) > ONE_WAY)


def _clocks(survey, road, rotations, samples, progress):
    """The clocks of the scanners whose frequency is known, from the points of a whole road."""
    if not rotations:
        return {}
    bins = {key: _Bins(survey.frame.passes[key[0]], BIN_TURNS / abs(frequency)) for key, (frequency, _, _) in rotations.items()}
    stride = min(_stride(samples[key], frequency) for key, (frequency, _, _) in rotations.items())
    mounts = {key: _mounting(samples[key], frequency) for key, (frequency, _, origin) in rotations.items() if origin == "angle"}

    first, last = survey.store.span(road)
    # of its own, so that which points are looked at does not depend on where sections are cut
    stretches = range(int(first // STRETCH), int(last // STRETCH) + 1)

    def work(number):
        gathered = []
        for key, own in scanner_runs(survey.window(road, number * STRETCH, (number + 1) * STRETCH).records[::stride]):
            if key not in rotations or not len(own):
                continue
            frequency, _, origin = rotations[key]
            time, phasor = phasors(survey, key[0], own)
            # points crowd about the middle of a turn where its gap is in the sky
            phasor = np.full(len(time), -1.0 + 0j) if origin == "gap" else phasor * mounts[key][_direction(phasor)]
            since = time - bins[key].start
            gathered.append((key, bins[key].sums_of(since, phasor * np.exp(-2j * np.pi * frequency * since))))
        return gathered

    for gathered in in_order(work, stretches, progress):
        for key, sums in gathered:
            bins[key].add(*sums)
    clocks = {}
    for key, (frequency, peak, origin) in rotations.items():
        b = bins[key]
        clock = mirror_phase_from_phasors(frequency, b.since, b.phasor, b.count, b.length, b.start, peak=peak, origin=origin)
        if clock is not None:
            clocks[key] = replace(clock, **_usual(samples[key], clock))
    return clocks


def _direction(phasor):
    """(N,) number of the direction of phasors among DIRECTIONS."""
    return ((np.angle(phasor) / (2 * np.pi) + 0.5) * DIRECTIONS).astype(np.int64) % DIRECTIONS


def _mounting(windows, frequency):
    """(DIRECTIONS,) complex: by what the mirror is ahead of the angle at which its points are seen.

    A scanner that is turned, leans or sits beside the trajectory sees angles stretched here and pressed
    together there; without that every point tells the mirror's phase alike, wherever it lies.
    """
    total = np.zeros(DIRECTIONS, complex)
    length = BIN_TURNS / abs(frequency)
    for w in windows:
        some = slice(None, None, max(len(w.time) // ENOUGH, 1))
        time, seen = w.time[some], w.phasor[some]
        bins = _Bins(w, length)
        first, count, since, phasor = bins.sums_of(time - bins.start, seen * np.exp(-2j * np.pi * frequency * (time - bins.start)))
        clock = mirror_phase_from_phasors(frequency, since, phasor, count, length, bins.start)
        if clock is not None:
            ahead = np.exp(2j * np.pi * np.sign(frequency) * clock.turns_at(time)) * np.conj(seen)
            of = _direction(seen)
            total += np.bincount(of, ahead.real, DIRECTIONS) + 1j * np.bincount(of, ahead.imag, DIRECTIONS)
    # unseen directions take after their neighbours
    near = np.array([total, np.roll(total, 1), np.roll(total, -1), np.roll(total, 2), np.roll(total, -2)]).sum(axis=0)
    return np.where(near == 0, 1.0, near / np.maximum(np.abs(near), 1e-12))


class _Bins:
    """Sums over the points of short stretches of a pass, from a second before its start."""

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
        own = slice(first, first + len(count))
        self.count[own] += count
        self.since[own] += since
        self.phasor[own] += phasor


def _stride(windows, frequency):
    """Every how manieth point is enough to tell a phase."""
    per_turn = np.median([len(w.time) / (np.ptp(w.time) * abs(frequency)) for w in windows])
    return 2 * int(max(per_turn / POINTS_PER_TURN, 1.0) / 2) + 1


def _lines_apart(line, phase):
    """(K,) turns from one line to the next that shows the same sector of a turn: of a cloud thinned by its times half a turn may be there."""
    line = line - line.min()
    turns = int(line.max()) + 1
    seen = np.unique((phase * SECTORS).astype(np.int64) * turns + line)
    return np.diff(seen)[np.diff(seen // turns) == 0]


def _usual(windows, clock):
    """What is usual on the lines of a scanner: the fields of a MirrorPhase that only looking at points tells."""
    gaps, apart, onward = [], [], 0
    for w in windows:
        step = np.diff(w.time)
        usual = np.median(step[step > 0])
        # the mean, for clocks that count in steps as long as the pulses are apart
        gaps.append(np.mean(step[(step > 0) & (step < 1.5 * usual)]))
        apart.append(_lines_apart(*clock.lines_and_phase(w.time)))
        onward += np.sign(np.diff(w.offset)).sum()
    apart = np.concatenate(apart)
    return dict(pulse=float(np.median(gaps) * abs(clock.frequency)), spacing=int(np.median(apart)) if len(apart) else 1,
                leftward=bool(clock.frequency < 0 if clock.origin == "angle" else onward > 0))
