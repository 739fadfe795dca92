"""Concrete gutters along the road's rim: as bright as paint, and not paint.

A gutter begins at the very rim of the road (a curb, an island, a wall) and is
two decimetres wide or more over metres of rim. An edge line stands off the rim
or is narrower, and a stop line or zebra stripe that reaches the rim takes up
little of its length. Where an edge line is painted right beside the gutter, it is
the brighter of the two.
"""

import cv2
import numpy as np

from ..objects.road_grid import CELL_SIZE
from ..objects.shape import fill_gaps

BAND = 2             # cells: 8 cm bands inwards from the rim
BANDS = 9            # 0.72 m: no gutter is wider
COARSE = 5           # cells: shares are counted in squares of 20 cm
REACH = 2.5          # m of rim either way that a gutter must be bright on
SHARE = 0.65         # of the cells of a band
NARROWEST = 3        # bands
BRIGHT = 1.5         # spreads above asphalt
PAINTED = 1.8        # times as bright as what lies between it and the rim: paint beside the gutter
GAP_ALONG, GAP_ACROSS = 15, 10   # cells: smaller gaps between points are road all the same


def rim_distance(occupied):
    """(rows, columns) float32 metres from each cell of road inwards from its rim; 0 outside the road.

    `occupied` are the cells that road points lie in. Where the points end along the road, the road goes on.
    """
    rows = np.flatnonzero(occupied.any(axis=1))
    occupied = occupied.copy()
    if len(rows):
        occupied[:rows[0]] = occupied[rows[0]:rows[0] + GAP_ALONG].any(axis=0)
        occupied[rows[-1] + 1:] = occupied[max(rows[-1] + 1 - GAP_ALONG, 0):rows[-1] + 1].any(axis=0)
    road = fill_gaps(fill_gaps(occupied, GAP_ACROSS, 1), GAP_ALONG, 0)
    return cv2.distanceTransform(road.view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE) * np.float32(CELL_SIZE)


def edge_distance(half_width, offsets):
    """(rows, columns) float32 metres from each cell inwards from the road's edge on its side, past whatever hides road.

    The rim of a shadow is no rim of the road: beside it nothing tells a gutter, and it
    outnumbers what is seen of the gutter between parked vehicles.

    Parameters
    ----------
    half_width : (2, rows) mm from the reference to the road's edge on the left and on the right, 0 where it is not known
    offsets : (columns,) m
    """
    distance = np.full((half_width.shape[1], len(offsets)), np.inf, np.float32)
    for side, widest in zip((1, -1), half_width):
        columns, known = np.flatnonzero(offsets * side > 0), np.flatnonzero(widest)
        if len(columns) and len(known):
            edge = np.interp(np.arange(len(distance)), known, widest[known] * 1e-3)
            distance[:, columns[0]:columns[-1] + 1] = np.maximum(edge[:, None] - np.abs(offsets[columns]) + CELL_SIZE / 2, CELL_SIZE)
    return distance


def gutter_cells(z, distance):
    """Cells of gutters.

    Parameters
    ----------
    z : (rows, columns) brightness in spreads above asphalt, NaN where nothing was scanned
    distance : (rows, columns) of `rim_distance` or `edge_distance`

    Returns
    -------
    (rows, columns) bool
    """
    near = (distance > 0) & (distance < np.float32((BANDS * BAND + 0.5) * CELL_SIZE)) & np.isfinite(z)
    row, column = np.nonzero(near)
    if not len(row):
        return np.zeros(z.shape, bool)
    value = z[row, column]
    band = np.minimum(((distance[row, column] / np.float32(CELL_SIZE) - np.float32(0.5)) / np.float32(BAND)).astype(np.int32), BANDS - 1)
    coarse = tuple(-(-n // COARSE) for n in z.shape)
    coarse_row, coarse_column = row.astype(np.int32) // np.int32(COARSE), column.astype(np.int32) // np.int32(COARSE)
    place = (coarse_row * np.int32(coarse[1]) + coarse_column) * np.int32(BANDS) + band
    size = BANDS * coarse[0] * coarse[1]
    bright = value > BRIGHT
    # in whole 64ths, which sum exactly in any order
    height = np.rint(64 * np.clip(value, 0.0, 100.0))
    box = 2 * int(round(REACH / CELL_SIZE / COARSE)) + 1

    def around(counts):
        sums = cv2.boxFilter(counts.reshape(*coarse, BANDS), -1, (box, box), normalize=False, borderType=cv2.BORDER_CONSTANT)
        return np.ascontiguousarray(np.moveaxis(sums, 2, 0))

    seen = around(np.bincount(place, minlength=size).astype(float))
    share = around(np.bincount(place, bright, size)) / np.maximum(seen, 1e-9)
    # at the very rim a cell is half curb: the first band may be anything
    full = (share >= SHARE) & (seen > 20)
    full[0] |= full[1]
    level = around(np.bincount(place, height, size) / 64) / np.maximum(seen, 1e-9)
    inner = np.minimum.accumulate(level[1:], axis=0)
    painted = np.zeros(full.shape, bool)
    painted[2:] = level[2:] > PAINTED * inner[:-1]
    width = np.cumprod(full & ~painted, axis=0).sum(axis=0)
    # the band in which it ends is half gutter, unless it is paint
    ends = np.take_along_axis(painted, np.minimum(width, BANDS - 1)[None], axis=0)[0]
    width = np.where(width >= NARROWEST, width + ~ends, 0)
    found = np.zeros(z.shape, bool)
    found[row, column] = band < width[coarse_row, coarse_column]
    return found
