"""Runs of True in a mask, stretches of ascending places, and the greatest of neighbours in a row of cells."""

from __future__ import annotations

import numpy as np


def mask_runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """(first, last + 1) of every run of True in (N,) bool."""
    change = np.flatnonzero(np.diff(np.r_[False, mask, False].astype(np.int8)))
    return list(zip(change[::2].tolist(), change[1::2].tolist()))


def stretch_of(places: np.ndarray, start: float, end: float) -> slice:
    """Those of (N,) ascending places that lie from `start` to `end`, both included: looked up, since a long road has many stretches."""
    return slice(int(np.searchsorted(places, start, side="left")), int(np.searchsorted(places, end, side="right")))


def best_within(place: np.ndarray, row: np.ndarray, score: np.ndarray, span: int) -> np.ndarray:
    """Which scores are the greatest of their surroundings; equal ones all are.

    Parameters
    ----------
    place : (N,) cells, counted row by row, ascending
    row : (N,) rows of cells
    score : (N,)
    span : cells of a row on either side that are compared

    Returns
    -------
    (N,) bool
    """
    best = np.ones(len(place), bool)
    for lag in range(1, min(span, len(place) - 1) + 1):
        near = (place[lag:] - place[:-lag] <= span) & (row[lag:] == row[:-lag])
        best[:-lag] &= ~near | (score[:-lag] >= score[lag:])
        best[lag:] &= ~near | (score[lag:] >= score[:-lag])
    return best
