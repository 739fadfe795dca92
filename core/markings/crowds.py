"""Which of many points cannot be far from their neighbours: told by the cells they lie in, before any neighbour is looked for."""

import math

import cv2
import numpy as np

from ..survey.points import UNIT

SIDE = 1.5     # times the usual distance: cells so large that three by three of them hold three times the neighbours asked for
NOWHERE = 1e9  # m, where no distance is known
ABOUT = 9      # cells about a point: where others are looked at to tell what is usual there
CELLS = 8      # for every point at most about so many, however near to each other rounded or repeated points lie


def may_be_lonely(records, k, looked, distances, limit, lonelier):
    """The points that may lie farther from their k nearest others than a limit, and than is usual about them by a factor.

    Parameters
    ----------
    records : Columns of N points
    k : neighbours
    looked : (M,) indices of points, evenly strewn
    distances : (M,) m, their mean distances to their k nearest others
    limit : m
    lonelier : times the least of the distances known in the decimetres about a point

    Returns
    -------
    ascending indices; of all other points it is certain that their mean distance is no more than the greater of both

    Notes
    -----
    The mean distance to the k nearest is at most that to any k others or more, and so at most
    the root of the mean square of these, which sums over cells give for every point::

        n |p|² - 2 p · sum(q) + sum(|q|²)

    This holds for cells of any size. They follow the usual distance down to a size that
    leaves no more than `CELLS` of them for every point.
    """
    side = max(int(SIDE * np.median(distances) / UNIT), _least_side(records["s"], records["d"]))
    (row, rows), (column, columns) = (_cells(records[name], side) for name in "sd")
    cell = row * np.int32(columns) + column
    places = [(records[name] - records[name][0]).astype(float) for name in "xyz"]
    own = sum(place * place for place in places)

    def about(values):
        sums = np.bincount(cell, values, rows * columns).reshape(rows, columns)
        return cv2.boxFilter(sums, -1, (3, 3), normalize=False, borderType=cv2.BORDER_CONSTANT).ravel().take(cell)

    count = about(None)
    squares = count * own + about(own)
    for place in places:
        squares -= 2.0 * place * about(place)
    usual = np.full((rows, columns), NOWHERE, np.float32)
    farthest_first = np.argsort(-distances, kind="stable")
    usual.ravel()[cell[looked[farthest_first]]] = distances[farthest_first]
    usual = cv2.erode(usual, np.ones((ABOUT, ABOUT), np.uint8), borderType=cv2.BORDER_CONSTANT, borderValue=NOWHERE).ravel().take(cell)
    most = np.maximum(np.where(usual < NOWHERE, lonelier * usual, 0.0), limit) / UNIT
    return np.flatnonzero((count <= k) | (squares > (count - 1) * most**2))


def _least_side(s, d):
    """The smallest side of cells, in units, of which there are at most about `CELLS` for every point."""
    along, across = (int(units.max()) - int(units.min()) for units in (s, d))
    most = CELLS * len(s)
    return max(math.ceil(math.sqrt(along * across / most)), math.ceil(max(along, across) / most), 1)


def _cells(units, side):
    """(N,) int32 number of the cell of each coordinate, from 0, and how many cells there are."""
    number = units // np.int32(side)
    number -= number.min()
    return number, int(number.max()) + 1
