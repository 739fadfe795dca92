"""Concrete gutters along the road's rim: as bright as paint, and not paint.

A gutter begins at the very rim of the road (a curb, an island, a wall) and is
two decimetres wide or more over metres of rim. An edge line stands off the rim
or is narrower, and a stop line or zebra stripe that reaches the rim takes up
little of its length. Where an edge line is painted right beside the gutter, it is
the brighter of the two.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...lazy import cv2
from ..road_grid import CELL_SIZE, fill_gaps
from .morphology import MAX_TRACK_GAP

BAND_CELLS = 2       # bands of 8 cm inwards from the rim
GUTTER_BANDS = 9     # 0.72 m: no gutter is wider
MIN_GUTTER_BANDS = 3
COARSE_CELLS = 5     # shares and levels are taken in squares of 20 cm
RIM_REACH = 2.5      # m of rim either way along which a gutter must be bright
MIN_BRIGHT_SHARE = 0.65      # of the cells of a band
MIN_CELLS_SEEN = 20          # of a band along RIM_REACH either way
GUTTER_BRIGHTNESS = 1.5      # spreads above asphalt
PAINT_TO_GUTTER = 1.8        # times as bright as the cells between it and the rim: paint beside the gutter
ROAD_GAP_ALONG = 15          # cells: smaller gaps between points belong to the road,
ROAD_GAP_ACROSS = int(MAX_TRACK_GAP / CELL_SIZE)   # and across it those between tracks of the scan


def rim_distance(occupied: np.ndarray) -> np.ndarray:
    """Distance of each cell of road from the road's rim.

    Where the points end along the road, the road is taken to continue.

    Parameters
    ----------
    occupied : (rows, columns) bool, cells that hold road points

    Returns
    -------
    (rows, columns) float32 metres; 0 outside the road
    """
    rows = np.flatnonzero(occupied.any(axis=1))
    occupied = occupied.copy()
    if len(rows):
        occupied[:rows[0]] = occupied[rows[0]:rows[0] + ROAD_GAP_ALONG].any(axis=0)
        occupied[rows[-1] + 1:] = occupied[max(rows[-1] + 1 - ROAD_GAP_ALONG, 0):rows[-1] + 1].any(axis=0)
    # along each track first: two tracks rarely have points at the same station
    tracks = fill_gaps(occupied, ROAD_GAP_ALONG, 0)
    road = fill_gaps(fill_gaps(tracks, ROAD_GAP_ACROSS, 1), ROAD_GAP_ALONG, 0)
    return cv2.distanceTransform(road.view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE) * np.float32(CELL_SIZE)


def edge_distance(half_width: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """Distance of each cell from the road's edge on its side, whatever hides the road between them.

    The rim of an occluded area is no rim of the road: beside parked vehicles it is longer
    than the rim at the gutter, and the gutter would not be recognised.

    Parameters
    ----------
    half_width : (2, rows) mm from the reference to the road's edge on the left and on the right, 0 where it is not known
    offsets : (columns,) m

    Returns
    -------
    (rows, columns) float32 metres; infinite where the edge is not known
    """
    distance = np.full((half_width.shape[1], len(offsets)), np.inf, np.float32)
    for side, widest in zip((1, -1), half_width):
        columns, known = np.flatnonzero(offsets * side > 0), np.flatnonzero(widest)
        if len(columns) and len(known):
            edge = np.interp(np.arange(len(distance)), known, widest[known] * 1e-3)
            distance[:, columns[0]:columns[-1] + 1] = np.maximum(edge[:, None] - np.abs(offsets[columns]) + CELL_SIZE / 2, CELL_SIZE)
    return distance


@dataclass(frozen=True)
class RimBands:
    """The cells along one rim, by bands inwards and squares along it; the same for whatever is measured in them.

    distance : (rows, columns) float32 metres from the rim, of `rim_distance` or `edge_distance`
    near : (N,) flat numbers of the cells that were scanned within the reach of gutters
    band : (N,) int32 band of each, from the rim inwards
    square : (N,) int32 flat number of the square of 20 cm that each lies in
    place : (N,) int, flat number of square and band
    seen : (bands, squares along, squares across) cells of a band that were scanned along RIM_REACH either way
    """

    distance: np.ndarray
    near: np.ndarray
    band: np.ndarray
    square: np.ndarray
    place: np.ndarray
    seen: np.ndarray

    @classmethod
    def of(cls, distance: np.ndarray, scanned: np.ndarray) -> RimBands:
        """The bands along a rim at a distance, (rows, columns) m, of the cells that were scanned, (rows, columns) bool."""
        near = np.flatnonzero((distance > 0) & (distance < np.float32((GUTTER_BANDS * BAND_CELLS + 0.5) * CELL_SIZE)) & scanned)
        band = ((distance.take(near) / np.float32(CELL_SIZE) - np.float32(0.5)) / np.float32(BAND_CELLS)).astype(np.int32)
        band = np.minimum(band, GUTTER_BANDS - 1)
        rows, columns = (-(-n // COARSE_CELLS) for n in distance.shape)
        cell = near.astype(np.int32)
        row = cell // np.int32(distance.shape[1])
        column = cell - row * np.int32(distance.shape[1])
        square = row // np.int32(COARSE_CELLS) * np.int32(columns) + column // np.int32(COARSE_CELLS)
        place = (square * np.int32(GUTTER_BANDS) + band).astype(np.intp)
        counts = np.bincount(place, minlength=GUTTER_BANDS * rows * columns).astype(float)
        return cls(distance, near, band, square, place, _around(counts.reshape(rows, columns, GUTTER_BANDS)))

    def sums(self, values: np.ndarray) -> np.ndarray:
        """(bands, squares along, squares across) sums of (N,) values at the cells along RIM_REACH either way."""
        return _around(np.bincount(self.place, values, self.seen.size).reshape(*self.seen.shape[1:], GUTTER_BANDS))


def _around(counts):
    """(bands, squares along, squares across) sums of (squares along, squares across, bands) along RIM_REACH either way."""
    box = 2 * int(round(RIM_REACH / CELL_SIZE / COARSE_CELLS)) + 1
    sums = cv2.boxFilter(counts, -1, (box, box), normalize=False, borderType=cv2.BORDER_CONSTANT)
    return np.ascontiguousarray(np.moveaxis(sums, 2, 0))


def gutter_cells(z: np.ndarray, rim: RimBands) -> np.ndarray:
    """Cells of concrete gutters, by our own rule.

    Parameters
    ----------
    z : (rows, columns) brightness in spreads above asphalt, NaN where nothing was scanned
    rim : RimBands

    Returns
    -------
    (rows, columns) bool
    """
    found = np.zeros(z.shape, bool)
    if not len(rim.near):
        return found
    value, seen = z.take(rim.near), rim.seen
    share = rim.sums(value > GUTTER_BRIGHTNESS) / np.maximum(seen, 1e-9)
    # a cell at the rim is half curb: the first band is not tested on its own
    full = (share >= MIN_BRIGHT_SHARE) & (seen > MIN_CELLS_SEEN)
    full[0] |= full[1]
    if not full[:MIN_GUTTER_BANDS].all(axis=0).any():
        return found
    # in whole 64ths: their sums are exact in any order
    height = np.rint(64 * np.clip(value, 0.0, 100.0))
    level = rim.sums(height / 64) / np.maximum(seen, 1e-9)
    inner = np.minimum.accumulate(level[1:], axis=0)
    painted = np.zeros(full.shape, bool)
    painted[2:] = level[2:] > PAINT_TO_GUTTER * inner[:-1]
    width = np.cumprod(full & ~painted, axis=0).sum(axis=0)
    # the band in which the gutter ends is half gutter, unless it is paint
    ends = np.take_along_axis(painted, np.minimum(width, GUTTER_BANDS - 1)[None], axis=0)[0]
    width = np.where(width >= MIN_GUTTER_BANDS, width + ~ends, 0)
    found.ravel()[rim.near] = rim.band < width.ravel().take(rim.square)
    return found
