"""What hangs together: groups of things of which pairs are linked."""

from __future__ import annotations

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
