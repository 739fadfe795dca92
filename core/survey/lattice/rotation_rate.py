"""The rotation frequency of a scanner's mirror, from when it measured at which angle."""

import numpy as np

SLOWEST, FASTEST = 5.0, 400.0  # Hz
WINDOW = 0.5                   # s of scanning whose points are compared
CELL = 1.0 / 2048.0            # s
PADDED = 8192                  # cells: a step of 0.25 Hz
NEAR = 0.02                    # share of a frequency within which it may wander
MIRROR_IMAGE = 1.5             # times as clear as the same frequency backwards
LEAST_PEAK = 0.5


def spectrum(time, phasor):
    """How clearly points turn with each frequency.

    Parameters
    ----------
    time : (N,) seconds, of WINDOW s at most
    phasor : (N,) complex, exp(i angle)

    Returns
    -------
    (PADDED,) float64 in the order of `frequencies`: |mean(exp(i (angle - 2 pi f t)))|
    """
    cell = ((time - time.min()) / CELL).astype(np.int64)
    size = int(cell.max()) + 1
    total = np.bincount(cell, phasor.real, size) + 1j * np.bincount(cell, phasor.imag, size)
    # a cell has a length, which dims high frequencies a little
    return np.abs(np.fft.fft(total, PADDED)) / len(time) / np.sinc(frequencies() * CELL)


def frequencies():
    """(PADDED,) Hz of a spectrum."""
    return np.fft.fftfreq(PADDED, CELL)


def clearest_rotation(spectra, given=0.0, signed=True):
    """The frequency that windows of one scanner agree on.

    Parameters
    ----------
    spectra : list of spectrum
    given : Hz, where the user knows it; 0 = not known
    signed : whether the direction of rotation shows; without it the frequency is positive

    Returns
    -------
    (frequency in Hz, peak): peak is the median over the windows, 0 where backwards is nearly as clear, as with
    heads that spin about the vertical
    """
    f = frequencies()
    allowed = (np.abs(f) >= SLOWEST) & (np.abs(f) <= FASTEST)
    if given:
        allowed &= np.abs(np.abs(f) - given) <= NEAR * given + 0.25
    if not signed:
        allowed &= f > 0
    mean = np.mean(spectra, axis=0)
    best = int(np.argmax(np.where(allowed, mean, -1.0)))
    near = np.abs(f - f[best]) <= NEAR * abs(f[best]) + 0.5
    back = np.abs(f + f[best]) <= NEAR * abs(f[best]) + 0.5
    peak = float(np.median([one[near].max() for one in spectra]))
    if signed and peak < MIRROR_IMAGE * float(np.median([one[back].max() for one in spectra])):
        return float(f[best]), 0.0
    return float(f[best]), peak
