"""The phase of a scanner's mirror: turns as a function of time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

MIN_PHASE_BIN_POINTS = 8     # points of a bin, or it gives no phase
MIN_PHASE_BIN_SHARE = 0.3    # of the median number of points: bins that are cut off have a biased phase
MIN_PHASE_COHERENCE = 0.3    # length of the mean phasor of a bin
NODES_PER_BIN = 5            # of the smooth curve through the phases of the bins
MAX_PHASE_BIN_GAP = 1.5           # bins between two phases; farther apart, the phase in between is extrapolated from the rate before


@dataclass(frozen=True)
class MirrorPhase:
    """The turns of one scanner's mirror during one pass; a scan line is a turn.

    Attributes
    ----------
    frequency : Hz, the mean; negative where the mirror turns clockwise seen in the direction of the road
    time, turns : (K,) seconds and turns of nodes between which the mirror turns evenly; turns increase
    pulse : usual share of a turn between neighbouring points of a line
    spacing : turns between neighbouring lines, more than 1 where lines were left out of the cloud
    leftward : whether the lines run to the left, offset increasing with time
    peak : 0 to 1, how well the points fit this frequency
    origin : "angle" where the phase follows from the points' angles, "gap" where it follows from gaps in their times
    """

    frequency: float
    time: np.ndarray
    turns: np.ndarray
    pulse: float = 0.0
    spacing: int = 1
    leftward: bool = False
    peak: float = 1.0
    origin: str = "angle"

    def turns_at(self, time: np.ndarray) -> np.ndarray:
        """(N,) turns since the pass began, at (N,) times in seconds: whole turns count lines, the fraction is the mirror phase."""
        time = np.asarray(time, float)
        return _interpolate(time, self.time, self.turns, abs(self.frequency))

    def times_at(self, turns: np.ndarray) -> np.ndarray:
        """(N,) seconds at which the mirror had made (N,) turns."""
        turns = np.asarray(turns, float)
        return _interpolate(turns, self.turns, self.time, 1.0 / abs(self.frequency))

    def lines_and_phase(self, time: np.ndarray, angle: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Line number and mirror phase of points.

        Parameters
        ----------
        time : (N,) seconds
        angle : (N,) radians about the trajectory, 0 at the zenith. If given, it decides on which side of the
            zenith a point lies, so that a ceiling is split exactly above the vehicle whatever the error of the phase

        Returns
        -------
        line : (N,) int64
        phase : (N,) float64, turns: 0 at the zenith, 0.5 below; in [0, 1) unless an angle changed the line
        """
        turns = self.turns_at(time)
        line = np.floor(turns)
        if angle is not None:
            share = np.sign(self.frequency) * np.asarray(angle) / (2 * np.pi)
            line = np.round(turns - np.where(share < 0, share + 1.0, share))
        return line.astype(np.int64), turns - line


def _interpolate(x, nodes, values, rate):
    """Values at x between nodes, extrapolated linearly beyond them (at `rate` where there is one node)."""
    found = np.interp(x, nodes, values)
    before, behind = np.minimum(x - nodes[0], 0.0), np.maximum(x - nodes[-1], 0.0)
    if len(nodes) < 2:
        return found + rate * (before + behind)
    first, last = np.diff(values[:2]) / np.diff(nodes[:2]), np.diff(values[-2:]) / np.diff(nodes[-2:])
    return found + first * before + last * behind


def mirror_phase_from_phasors(frequency: float, time: np.ndarray, phasor: np.ndarray, count: np.ndarray, bin_length: float,
                              start: float = 0.0, **fields: Any) -> MirrorPhase | None:
    """The mirror phase of a pass from the mean phase of its bins.

    Parameters
    ----------
    frequency : Hz, signed, near the truth
    time : (B,) seconds since the start, sums over the points of each bin
    phasor : (B,) complex, sums of exp(i (angle - 2 pi frequency t)) over the points of each bin
    count : (B,) points
    bin_length, start : seconds
    fields : further attributes of the MirrorPhase

    Returns
    -------
    MirrorPhase, or None where no bin has a phase
    """
    usable = np.flatnonzero((count >= MIN_PHASE_BIN_POINTS) & (np.abs(phasor) >= MIN_PHASE_COHERENCE * count))
    if not len(usable):
        return None
    usable = usable[count[usable] >= MIN_PHASE_BIN_SHARE * np.median(count[usable])]
    time = time[usable] / count[usable]
    # even rotation, and what the mirror was ahead of it
    turns = np.sign(frequency) * (frequency * time + _unwrap(time, np.angle(phasor[usable]), bin_length) / (2 * np.pi))
    rising = np.r_[True, np.diff(np.maximum.accumulate(turns)) > 0]
    time, turns = time[rising], turns[rising]
    mean = (turns[-1] - turns[0]) / (time[-1] - time[0]) if len(time) > 1 else abs(frequency)
    time, turns = _smooth_nodes(time, turns, bin_length)
    return MirrorPhase(float(np.sign(frequency) * mean), start + time, turns - np.floor(turns[0]), **fields)


def _smooth_nodes(time, turns, bin_length):
    """NODES_PER_BIN nodes per bin on a cubic spline: with linear pieces the points of neighbouring lines would not line up."""
    if len(time) < 4:
        return time, turns
    steps = np.minimum(np.ceil(np.diff(time) / bin_length * NODES_PER_BIN), NODES_PER_BIN).astype(np.int64)
    share = np.concatenate([np.arange(n) / n for n in steps])
    piece = np.repeat(np.arange(len(steps)), steps)
    fine = np.r_[time[piece] + share * np.diff(time)[piece], time[-1]]
    found = CubicSpline(time, turns)(fine)
    return (fine, found) if (np.diff(found) > 0).all() else (time, turns)


def _unwrap(time, phase, bin_length):
    """(K,) phases, each within half a turn of the one that the rate before it predicts."""
    apart = np.diff(time)
    step = (np.diff(phase) + np.pi) % (2 * np.pi) - np.pi
    near = apart < MAX_PHASE_BIN_GAP * bin_length
    if near.any() and not near.all():
        before = np.maximum.accumulate(np.where(near, np.arange(len(near)), -1))
        rate = np.where(before >= 0, (step / apart)[before], 0.0)
        predicted = rate * apart
        step = np.where(near, step, predicted + (np.diff(phase) - predicted + np.pi) % (2 * np.pi) - np.pi)
    return phase[0] + np.r_[0.0, np.cumsum(step)]
