"""What hangs together: groups of things of which pairs are linked."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


def linked_groups(first: np.ndarray, second: np.ndarray, count: int) -> np.ndarray:
    """The group of each thing: those that links lead to from each other, in either direction, over any others.

    Parameters
    ----------
    first, second : (P,) int, the two things of each link; links may be told twice
    count : number of things

    Returns
    -------
    (count,) int32, groups numbered from 0 in the order of their first things
    """
    graph = coo_matrix((np.ones(len(first), bool), (first, second)), shape=(count, count))
    return connected_components(graph, directed=False)[1]


def members_of(number: np.ndarray) -> Iterator[tuple[int, np.ndarray]]:
    """The members of all groups, found by sorting: a search of its members for every group compares everything with everything.

    Parameters
    ----------
    number : (N,) int, the group of each thing; below 0 where it is of none

    Yields
    ------
    number of a group, ascending, and (M,) its members, ascending
    """
    known = np.flatnonzero(number >= 0)
    order = known[np.argsort(number[known], kind="stable")]
    starts = np.flatnonzero(np.diff(number[order], prepend=-1))
    for begin, end in zip(starts.tolist(), [*starts[1:].tolist(), len(order)]):
        yield int(number[order[begin]]), order[begin:end]
