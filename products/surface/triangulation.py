"""A triangulation of the ground that follows its breaklines, with the fewest vertices that keep to a tolerance."""

from __future__ import annotations

from collections import defaultdict
from itertools import groupby

import numpy as np
import shapely
from scipy.spatial import Delaunay, cKDTree

from ...core.common.arrays import order_by
from ...core.common.progress import Progress

NEAREST_VERTICES = 0.3  # m: nearer ones would follow the noise of the ground
MOST_ROUNDS = 60        # cost: of refinement; twenty are usual


class Triangulation:
    """Triangles between vertices of which some are joined by segments: a constrained Delaunay triangulation.

    Where a segment is no edge of the Delaunay triangulation, the triangles that it crosses make room for it. What they leave open on either
    side is filled with triangles whose circles hold no corner of it. A segment that crosses another one or passes through a vertex is left out.

    vertices : (V, 3) m, no two at one place in plan; segments : (S, 2) int of them; area : polygon that holds the middles of those that are kept
    faces : (F, 3) int, vertices of the triangles, counter-clockwise from above

    Source: Anglada (1997), An improved incremental algorithm for constructing restricted Delaunay triangulations, Computers & Graphics 21, 215-223.
    The Delaunay triangulation is Qhull's.
    """

    def __init__(self, vertices: np.ndarray, segments: np.ndarray, area: shapely.Geometry | None = None):
        self.vertices = vertices
        self._middle = vertices[:, :2].mean(axis=0)
        plan = vertices[:, :2] - self._middle
        self._whole = Delaunay(plan)
        corners = self._whole.simplices
        edges = np.sort(corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        size = len(vertices)
        segments = np.sort(segments, axis=1)
        missing = segments[~np.isin(segments[:, 0] * size + segments[:, 1], edges[:, 0] * size + edges[:, 1])]
        self._crossed, added = np.zeros(len(corners), bool), np.empty((0, 3), np.int64)
        if len(missing):
            self._crossed, added = _forced(plan, self._whole, segments, missing)
        self._faces = np.concatenate([corners, added])
        a, b, c = (plan[self._faces[:, k]] for k in range(3))
        turned = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] < 0
        self._faces[turned] = self._faces[turned][:, ::-1]
        self._tree = shapely.STRtree(shapely.polygons(plan[added]) if len(added) else [])
        self.kept = np.r_[~self._crossed, np.ones(len(added), bool)]
        if area is not None:
            self.kept &= shapely.contains_xy(area, *vertices[self._faces, :2].mean(axis=1).T)

    @property
    def faces(self) -> np.ndarray:
        return self._faces[self.kept]

    def locate(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(N,) numbers of the triangles in which (N,) places lie, -1 outside: those of all that there were, before any was left out."""
        places = np.stack([x, y], axis=1) - self._middle
        number = self._whole.find_simplex(places)
        moved = np.flatnonzero(self._crossed[number] & (number >= 0))
        if len(moved):
            points = shapely.points(places[moved])
            face = np.full(len(moved), -1)
            row, there = self._tree.query(points, predicate="intersects")
            face[row] = there
            lost = np.flatnonzero(face < 0)   # by rounding, a place on an edge lies in neither of its triangles
            face[lost] = self._tree.nearest(points[lost])
            number[moved] = face + len(self._crossed)
        return number

    def heights(self, x: np.ndarray, y: np.ndarray, number: np.ndarray | None = None) -> np.ndarray:
        """(N,) heights of the surface at (N,) places, m; NaN outside."""
        number = self.locate(x, y) if number is None else number
        a, b, c = (self.vertices[self._faces[number, k]] for k in range(3))
        u, v, p = b - a, c - a, np.stack([x, y], axis=1) - a[:, :2]
        with np.errstate(divide="ignore", invalid="ignore"):
            area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
            z = a[:, 2] + ((p[:, 0] * v[:, 1] - p[:, 1] * v[:, 0]) * u[:, 2] + (u[:, 0] * p[:, 1] - u[:, 1] * p[:, 0]) * v[:, 2]) / area
        return np.where((number >= 0) & self.kept[number], z, np.nan)


def _forced(plan, whole, segments, missing):
    """((T,) bool, the triangles that missing segments cross, (A, 3) vertices of those that take their place)."""
    corners, lines = whole.simplices, shapely.linestrings(plan[missing])
    shapes = shapely.polygons(plan[corners])
    triangle, line = shapely.STRtree(lines).query(shapes, predicate="intersects")
    through = shapely.relate_pattern(lines[line], shapes[triangle], "T********")
    crossed = np.zeros(len(corners), bool)
    crossed[triangle[through]] = True
    patch = _Patch(plan, corners[crossed], missing, {tuple(segment) for segment in segments.tolist()})
    for segment in missing.tolist():
        patch.force(*segment)
    return crossed, np.array(patch.triangles(), np.int64).reshape(-1, 3)


class _Patch:
    """Some triangles of a triangulation that can be replaced: `third[a, b]` is the third corner of the one to the left of a -> b."""

    def __init__(self, plan, corners, missing, kept):
        self.places = {k: (float(plan[k, 0]), float(plan[k, 1])) for k in np.unique(np.r_[corners.ravel(), missing.ravel()]).tolist()}
        self.third, self.around, self.kept = {}, defaultdict(set), kept
        for a, b, c in corners.tolist():
            self._add(*((a, b, c) if self._side(a, b, c) > 0 else (a, c, b)))

    def _side(self, a, b, c):
        """Twice the area of a triangle, positive where c lies to the left of a -> b."""
        (ax, ay), (bx, by), (cx, cy) = self.places[a], self.places[b], self.places[c]
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    def _add(self, *corners):
        for a, b, c in zip(corners, corners[1:] + corners[:1], corners[2:] + corners[:2]):
            self.third[a, b] = c
            self.around[a].add(b)

    def triangles(self):
        return sorted((a, b, c) for (a, b), c in self.third.items() if a < b and a < c)

    def force(self, a, b):
        """Make a segment an edge; nothing happens where it crosses an edge that is kept, or passes through a vertex."""
        crossed = self._between(a, b)
        # a corner that the segment passes twice stands twice
        right, left = ([corner for corner, _ in groupby(corners)] for corners in zip(*crossed)) if crossed else ([], [])
        for p, q in crossed:
            self._drop(p, q)
            self._drop(q, p)
        waiting = [(a, b, left), (b, a, right[::-1])]
        while waiting:
            p, q, corners = waiting.pop()
            if corners:
                best = 0
                for k in range(1, len(corners)):
                    if self._encircled(p, q, corners[best], corners[k]):
                        best = k
                self._add(p, q, corners[best])
                waiting += [(p, corners[best], corners[:best]), (corners[best], q, corners[best + 1:])]

    def _drop(self, p, q):
        """Take away the triangle to the left of p -> q, if it is still there."""
        corner = self.third.get((p, q))
        if corner is not None:
            for edge in ((p, q), (q, corner), (corner, p)):
                del self.third[edge]

    def _between(self, a, b):
        """The edges that a segment crosses, from a to b; none where it cannot be an edge."""
        first = next(((p, self.third[a, p]) for p in self.around[a] if (a, p) in self.third
                      and self._side(a, b, p) < 0 < self._side(a, b, self.third[a, p])), None)
        edges = [] if first is None else [first]
        while edges:
            p, q = edges[-1]
            corner = self.third.get((q, p))
            if corner == b:
                return edges
            side = 0.0 if corner is None or (min(p, q), max(p, q)) in self.kept else self._side(a, b, corner)
            if not side:
                return []
            edges.append((p, corner) if side > 0 else (corner, q))
        return edges

    def _encircled(self, p, q, corner, other):
        """Whether the circle through a triangle, whose corners turn counter-clockwise, holds another vertex."""
        x, y = self.places[other]
        (ax, ay), (bx, by), (cx, cy) = ((self.places[k][0] - x, self.places[k][1] - y) for k in (p, q, corner))
        a, b, c = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
        return ax * (by * c - b * cy) - ay * (bx * c - b * cx) + a * (bx * cy - by * cx) > 0.0


def thinned(cells: np.ndarray, judged: np.ndarray, fixed: np.ndarray, segments: np.ndarray, area: shapely.Geometry, tolerance: float,
            progress: Progress = Progress()) -> Triangulation:
    """The triangulation with the fewest vertices of the ground that misses it by no more than a tolerance.

    Greedy insertion: of every triangle, the cell that it misses most becomes a vertex, in the first rounds only where it is missed by more than
    half of the most, so that few vertices do.

    cells : (N, 3) m, the ground
    judged : (N,) bool, the cells whose misses count for the tolerance
    fixed : (V, 3) m, vertices that are there from the beginning
    segments : (S, 2) int, pairs of them that are joined
    area : polygon that is covered
    tolerance : m, root mean square of the misses of the cells that are judged

    Source: Garland and Heckbert (1995), Fast polygonal approximation of terrains and height fields, CMU-CS-95-181: algorithm II, in rounds.
    """
    vertices, last, limit = fixed, 2 * tolerance, np.inf
    shapely.prepare(area)
    x, y, z = cells.T
    along = shapely.get_coordinates(shapely.segmentize(shapely.linestrings(fixed[segments][:, :, :2]), NEAREST_VERTICES / 2))
    free = cKDTree(along).query(cells[:, :2], distance_upper_bound=NEAREST_VERTICES / 2)[0] == np.inf
    for turn in range(MOST_ROUNDS):
        surface = Triangulation(vertices, segments, area)
        number = surface.locate(x, y)
        miss = np.abs(np.nan_to_num(surface.heights(x, y, number) - z))
        free &= cKDTree(vertices[:, :2]).query(cells[:, :2], distance_upper_bound=NEAREST_VERTICES)[0] == np.inf
        limit = max(min(limit, float(miss[free].max(initial=0.0))) / 2, last)
        wrong = np.flatnonzero(free & (miss > limit))
        progress.report((turn + 1) / MOST_ROUNDS)
        if not len(wrong) and limit <= last:
            if not judged.any() or np.mean(miss[judged] ** 2) <= tolerance**2 or last <= tolerance:
                break
            last = max(0.7 * last, tolerance)
        if len(wrong):
            order = wrong[order_by(np.rint(-miss[wrong] * 1e5).astype(np.int64), number[wrong])]
            vertices = np.concatenate([vertices, cells[order[np.r_[True, np.diff(number[order]) > 0]]]])
    progress.report(1.0)
    return surface
