"""Work on the rows of long tables, some at a time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

ROWS_AT_ONCE = 1024   # rows of some hundred cells: a megabyte of each array


def by_rows(function: Callable[[slice], np.ndarray], count: int, at_once: int = ROWS_AT_ONCE) -> np.ndarray:
    """What a function gives for rows that do not depend on each other, computed some at a time, so that what it needs meanwhile stays small.

    Parameters
    ----------
    function : of a slice of the rows; an array with one entry for each of them
    count : of rows
    at_once : rows in a slice

    Returns
    -------
    (count, ...) array
    """
    found = function(slice(0, min(at_once, count)))
    if count <= at_once:
        return found
    whole = np.empty((count, *found.shape[1:]), found.dtype)
    whole[:at_once] = found
    for first in range(at_once, count, at_once):
        some = slice(first, min(first + at_once, count))
        whole[some] = function(some)
    return whole
