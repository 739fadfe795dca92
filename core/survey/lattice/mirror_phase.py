"""When the mirror of a scanner stood where: turns as a function of time."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

FEWEST_IN_BIN = 8     # points that tell a phase
LEAST_SHARE = 0.3     # of the usual number: bins that are cut off tell a phase of their own
LEAST_COHERENT = 0.3  # of the mean phasor of a bin
PER_BIN = 5           # nodes of the smooth curve through the bins' phases
JUMP_IN_BINS = 1.5    # of the usual step: farther apart, the phase between is foretold from the rate before


@dataclass(frozen=True)
class MirrorPhase:
    """The turns of one scanner during one pass; a scan line is a turn.

    Attributes
    ----------
    frequency : Hz, the mean; negative where the mirror turns clockwise seen in the direction of the road
    time, turns : (K,) nodes between which the mirror turns evenly; turns increase
    pulse : usual share of a turn between neighbouring points of a line
    spacing : turns between neighbouring lines, more than 1 where lines were left out of the cloud
    leftward : whether the lines run to the left, offset increasing with time
    peak : 0 to 1, how clearly the cloud shows this frequency
    origin : "angle" where the points' angles told the phase, "gap" where the times alone did
    """

    frequency: float
    time: np.ndarray
    turns: np.ndarray
    pulse: float = 0.0
    spacing: int = 1
    leftward: bool = False
    peak: float = 1.0
    origin: str = "angle"

    def turns_at(self, time):
        """(N,) turns since the pass began, at times in seconds; line and mirror phase in one number."""
        time = np.asarray(time, float)
        return _beyond(time, self.time, self.turns, abs(self.frequency))

    def times_at(self, turns):
        """(N,) seconds at which the mirror had turned so far."""
        turns = np.asarray(turns, float)
        return _beyond(turns, self.turns, self.time, 1.0 / abs(self.frequency))

    def lines_and_phase(self, time, angle=None):
        """Line number and mirror phase of points.

        Parameters
        ----------
        time : (N,) seconds
        angle : (N,) radians about the trajectory, 0 at the zenith; given, it decides on which side of the
            zenith a point lies, so that a ceiling is parted exactly above the vehicle whatever the phase's error

        Returns
        -------
        (N,) int64 line, (N,) float64 phase in turns: 0 at the zenith, 0.5 below, in [0, 1) unless an angle moved it
        """
        turns = self.turns_at(time)
        line = np.floor(turns)
        if angle is not None:
            share = np.sign(self.frequency) * np.asarray(angle) / (2 * np.pi)
            line = np.round(turns - np.where(share < 0, share + 1.0, share))
        return line.astype(np.int64), turns - line

    def columns(self, phase):
        """(N,) int64 place in the line of points of a mirror phase; neighbours in neighbouring lines share it."""
        return np.floor(np.asarray(phase) / self.pulse).astype(np.int64)


def _beyond(x, nodes, values, rate):
    """Values at x between nodes, and straight on beyond them as they go there (at `rate` where there is one node)."""
    found = np.interp(x, nodes, values)
    before, behind = np.minimum(x - nodes[0], 0.0), np.maximum(x - nodes[-1], 0.0)
    if len(nodes) < 2:
        return found + rate * (before + behind)
    first, last = np.diff(values[:2]) / np.diff(nodes[:2]), np.diff(values[-2:]) / np.diff(nodes[-2:])
    return found + first * before + last * behind


def mirror_phase_from_phasors(frequency, time, phasor, count, bin_length, start=0.0, **more):
    """A clock from what the bins of a pass say about the phase.

    Parameters
    ----------
    frequency : Hz, signed, near the truth
    time : (B,) seconds since the start, sums over the points of each bin
    phasor : (B,) complex, sums of exp(i (angle - 2 pi frequency t)) over the points of each bin
    count : (B,) points
    bin_length, start : seconds

    Returns
    -------
    MirrorPhase, or None where no bin tells a phase
    """
    told = np.flatnonzero((count >= FEWEST_IN_BIN) & (np.abs(phasor) >= LEAST_COHERENT * count))
    if not len(told):
        return None
    told = told[count[told] >= LEAST_SHARE * np.median(count[told])]
    time = time[told] / count[told]
    # the rotation as found, and what it was ahead of that
    turns = np.sign(frequency) * (frequency * time + _unwrapped(time, np.angle(phasor[told]), bin_length) / (2 * np.pi))
    rising = np.r_[True, np.diff(np.maximum.accumulate(turns)) > 0]
    time, turns = time[rising], turns[rising]
    mean = (turns[-1] - turns[0]) / (time[-1] - time[0]) if len(time) > 1 else abs(frequency)
    time, turns = _smooth(time, turns, bin_length)
    return MirrorPhase(float(np.sign(frequency) * mean), start + time, turns - np.floor(turns[0]), **more)


def _smooth(time, turns, bin_length):
    """Nodes PER_BIN a bin on a smooth curve through those given: between straight pieces lines would not line up."""
    if len(time) < 4:
        return time, turns
    steps = np.minimum(np.ceil(np.diff(time) / bin_length * PER_BIN), PER_BIN).astype(np.int64)
    share = np.concatenate([np.arange(n) / n for n in steps])
    piece = np.repeat(np.arange(len(steps)), steps)
    fine = np.r_[time[piece] + share * np.diff(time)[piece], time[-1]]
    found = CubicSpline(time, turns)(fine)
    return (fine, found) if (np.diff(found) > 0).all() else (time, turns)


def _unwrapped(time, phase, bin_length):
    """(K,) phases in which neighbours differ by less than half a turn from what the rate before foretold."""
    apart = np.diff(time)
    step = (np.diff(phase) + np.pi) % (2 * np.pi) - np.pi
    near = apart < JUMP_IN_BINS * bin_length
    if near.any() and not near.all():
        before = np.maximum.accumulate(np.where(near, np.arange(len(near)), -1))
        rate = np.where(before >= 0, (step / apart)[before], 0.0)
        foretold = rate * apart
        step = np.where(near, step, foretold + (np.diff(phase) - foretold + np.pi) % (2 * np.pi) - np.pi)
    return phase[0] + np.r_[0.0, np.cumsum(step)]
