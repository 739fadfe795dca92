"""The rotation rate of a scanner's mirror, from the times and angles of its points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

MIN_ROTATION, MAX_ROTATION = 5.0, 400.0  # Hz
ROTATION_WINDOW = 0.5           # s of scanning whose points are compared
SPECTRUM_CELL = 1.0 / 2048.0    # s
SPECTRUM_SIZE = 8192            # cells, zero-padded: a step of 0.25 Hz
ROTATION_TOLERANCE = 0.02       # share of a frequency within which it may vary
MIN_DIRECTION_RATIO = 1.5       # of the peak against that of the opposite rotation
MIN_ROTATION_PEAK = 0.5


def rotation_spectrum(time: np.ndarray, phasor: np.ndarray) -> np.ndarray:
    """How well points fit each rotation frequency: |mean(exp(i (angle - 2 pi f t)))| (our own).

    Parameters
    ----------
    time : (N,) seconds, spanning at most ROTATION_WINDOW
    phasor : (N,) complex, exp(i angle)

    Returns
    -------
    (SPECTRUM_SIZE,) float64, 0 to 1, in the order of `spectrum_frequencies`
    """
    cell = ((time - time.min()) / SPECTRUM_CELL).astype(np.int64)
    size = int(cell.max()) + 1
    total = np.bincount(cell, phasor.real, size) + 1j * np.bincount(cell, phasor.imag, size)
    # averaging over a cell attenuates high frequencies by sinc
    return np.abs(np.fft.fft(total, SPECTRUM_SIZE)) / len(time) / np.sinc(spectrum_frequencies() * SPECTRUM_CELL)


def spectrum_frequencies() -> np.ndarray:
    """(SPECTRUM_SIZE,) frequencies of a spectrum, Hz."""
    return np.fft.fftfreq(SPECTRUM_SIZE, SPECTRUM_CELL)


def strongest_rotation(spectra: Sequence[np.ndarray], given: float = 0.0, signed: bool = True) -> tuple[float, float]:
    """The frequency that all windows of one scanner fit best.

    Parameters
    ----------
    spectra : (SPECTRUM_SIZE,) of each window
    given : Hz, where the user knows it; 0 = not known
    signed : whether the direction of rotation shows; otherwise the frequency is positive

    Returns
    -------
    frequency : Hz
    peak : median of the windows' peaks, 0 to 1; 0 where the opposite rotation fits nearly as well, as for
        scanners that spin about the vertical
    """
    f = spectrum_frequencies()
    allowed = (np.abs(f) >= MIN_ROTATION) & (np.abs(f) <= MAX_ROTATION)
    if given:
        allowed &= np.abs(np.abs(f) - given) <= ROTATION_TOLERANCE * given + 0.25
    if not signed:
        allowed &= f > 0
    mean = np.mean(spectra, axis=0)
    best = int(np.argmax(np.where(allowed, mean, -1.0)))
    near = np.abs(f - f[best]) <= ROTATION_TOLERANCE * abs(f[best]) + 0.5
    opposite = np.abs(f + f[best]) <= ROTATION_TOLERANCE * abs(f[best]) + 0.5
    peak = float(np.median([one[near].max() for one in spectra]))
    if signed and peak < MIN_DIRECTION_RATIO * float(np.median([one[opposite].max() for one in spectra])):
        return float(f[best]), 0.0
    return float(f[best]), peak
