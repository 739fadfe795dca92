"""Outlines of markings: the cells that a cluster's points lie in, closed along the road.

Points lie in scan lines a decimetre or more apart along the road and close
together across it, and paint is worn through in places. So gaps are closed
along the road, and much less across it, where the next stripe may begin.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import shapely
from scipy import ndimage
from scipy.spatial import cKDTree

from ...curves.robust import row_medians
from ...survey.store.records import COORDINATE_SCALE
from ..road_grid import CELL_SIZE, fill_gaps, filled_between_tracks, track_reach
from .shape import middle_line

if TYPE_CHECKING:
    from ...survey.frame.road import Road
    from .shape import Shape

CLOSE_ALONG = 0.40            # m of station over which a gap is closed
CLOSE_ACROSS = 0.04           # m of offset likewise
MIN_HOLE_AREA = 0.02          # m2: smaller holes are wear, not shape
END_STRETCH, MAX_END_GAP = 20000, 5000   # 0.1 mm: 2 m at an end, whose gaps tell how far it goes on, and half a metre: what is longer is worn
STRIP_TOLERANCE = 0.004       # m by which the outline of a strip may leave its middle line's curve
MIN_PART_AREA = 0.005         # m2: three cells
OUTLINE_TOLERANCE = 0.025     # m by which a simplified outline may leave the cells
OUTLINE_VERTEX_SPACING = 1.0  # m of station between vertices: 2 mm of sagitta at R = 60 m
OUTLINE_HEIGHT_NEIGHBOURS = 8


def band(s: np.ndarray, d: np.ndarray, shape: Shape) -> shapely.Polygon:
    """Outline of a strip: its middle line, as wide as the whole of it is.

    Parameters
    ----------
    s, d : (N,) int, units of 0.1 mm
    shape : Shape of an elongated cluster along the road, or in any straight direction

    Returns
    -------
    shapely Polygon in (s, d)
    """
    c, n = (1.0, 0.0) if shape.along else (np.cos(shape.direction), np.sin(shape.direction))
    u, v = (s, d) if shape.along else (np.rint(s * c + d * n).astype(np.int64), np.rint(d * c - s * n).astype(np.int64))
    nodes, offsets = middle_line(u, v, shape.spacing)
    # the last node lies in the middle of a step that the strip may fill to a small part
    along = np.sort(u)
    first, last = along[0] - _beyond_the_last(along), along[-1] + _beyond_the_last(-along[::-1])
    all_nodes = np.concatenate([[first], nodes[nodes < last], [last]])
    offsets, nodes = np.interp(all_nodes, nodes, offsets) * COORDINATE_SCALE, all_nodes * COORDINATE_SCALE
    keep = np.append(True, np.diff(nodes) > 1e-6)
    nodes, offsets = nodes[keep], offsets[keep]
    ring = np.stack([np.concatenate([nodes, nodes[::-1]]),
                     np.concatenate([offsets - shape.width / 2, offsets[::-1] + shape.width / 2])], axis=1)
    return shapely.simplify(shapely.Polygon(ring @ np.array([[c, n], [-n, c]])), STRIP_TOLERANCE)


def _beyond_the_last(along):
    """How far a strip goes on beyond its first point on average: half the gap that any place of it falls into.

    along : (N,) int, ascending; a gap of length g is met by a share of places that grows with g, and half of it lies beyond
    """
    gaps = np.diff(along[:np.searchsorted(along, along[0] + END_STRETCH)])
    gaps = gaps[gaps <= MAX_END_GAP].astype(float)
    return int(round((gaps * gaps).sum() / (2.0 * gaps.sum()))) if gaps.any() else 0


def painted_cells(s: np.ndarray, d: np.ndarray, spacing: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Cells covered by a cluster.

    Parameters
    ----------
    s, d : (N,) metres
    spacing : (N,) int, mm across the road between the tracks of the scan; None where it is not known

    Returns
    -------
    mask : (A, B) bool, first axis along the road, second across it
    first : (2,) int, the cell number of mask[0, 0]: it begins at first * CELL
    """
    cells = np.floor(np.c_[s, d] / CELL_SIZE).astype(np.int64)
    mask, first = filled_between_tracks(cells, track_reach(spacing if spacing is not None else np.zeros(len(cells))))
    mask = fill_gaps(mask, int(round(CLOSE_ALONG / CELL_SIZE)), 0)
    mask = fill_gaps(mask, int(round(CLOSE_ACROSS / CELL_SIZE)), 1)
    return _without_small_holes(mask), first


def _without_small_holes(mask):
    holes, count = ndimage.label(~mask)
    if count > 1:
        sizes = np.bincount(holes.ravel())
        small = sizes * CELL_SIZE**2 < MIN_HOLE_AREA
        small[0] = False
        mask = mask | small[holes]
    return mask


def cell_outline(mask: np.ndarray, first: np.ndarray) -> shapely.Geometry:
    """Shapely polygon or multipolygon in (s, d) of the cells that are on, its staircase smoothed."""
    edges = np.diff(np.pad(mask, ((1, 1), (0, 0))).astype(np.int8), axis=0)
    column, start = np.nonzero(edges.T == 1)
    _, end = np.nonzero(edges.T == -1)
    boxes = shapely.box((first[0] + start) * CELL_SIZE, (first[1] + column) * CELL_SIZE,
                        (first[0] + end) * CELL_SIZE, (first[1] + column + 1) * CELL_SIZE)
    # cells that touch at a corner only make one polygon after a hair of widening
    shape = shapely.union_all(boxes, grid_size=0.001)
    return shape.simplify(OUTLINE_TOLERANCE, preserve_topology=True)


def parts(shape: shapely.Geometry) -> list[shapely.Polygon]:
    """The polygons of an outline that are large enough to be drawn, from the road's start on."""
    pieces = [piece for piece in getattr(shape, "geoms", [shape]) if piece.area >= MIN_PART_AREA]
    return sorted(pieces, key=lambda piece: piece.bounds)


def drawn_outline(columns: Sequence[np.ndarray], shape: Shape, strip: bool, road: Road) -> list[shapely.Polygon]:
    """The polygons of one marking in local coordinates, from the road's start on.

    Parameters
    ----------
    columns : s, d, x, y, z, units of 0.1 mm, and spacing, mm between the tracks of the scan: (N,) int each of its points
    shape : Shape
    strip : whether it is drawn as an even strip, else cell by cell
    road : Road
    """
    s, d, x, y, z, spacing = columns
    drawn = band(s, d, shape) if strip else cell_outline(*painted_cells(s * COORDINATE_SCALE, d * COORDINATE_SCALE, spacing))
    places = np.stack([x, y, z], axis=1) * COORDINATE_SCALE
    return [to_local(part, road, places) for part in parts(drawn)]


def to_local(shape: shapely.Polygon, road: Road, places: np.ndarray) -> shapely.Polygon:
    """The outline in local coordinates with Z.

    Parameters
    ----------
    shape : polygon in (s, d)
    road : Road
    places : (N, 3) local x, y, z of the cluster's points

    Returns
    -------
    shapely Polygon with Z: each vertex at the median height of the points nearest to it
    """
    shape = shapely.segmentize(shape, OUTLINE_VERTEX_SPACING)
    vertices = shapely.get_coordinates(shape)
    return lifted(shapely.set_coordinates(shape, np.column_stack(road.to_map(vertices[:, 0], vertices[:, 1]))), places)


def lifted(shape: shapely.Polygon, places: np.ndarray) -> shapely.Polygon:
    """An outline in local coordinates, each vertex at the median height of the points (N, 3) nearest to it."""
    k = min(OUTLINE_HEIGHT_NEIGHBOURS, len(places))
    vertices = shapely.get_coordinates(shape)
    _, nearest = cKDTree(places[:, :2], balanced_tree=False, compact_nodes=False).query(vertices, k)
    z = row_medians(places[:, 2][nearest.reshape(len(vertices), k)])[:, 0]
    return shapely.set_coordinates(shapely.force_3d(shape), np.c_[vertices, z])
