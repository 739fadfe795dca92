"""Collects the paint, lanes and objects of a plan."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Union

import numpy as np
import shapely

from ..parts.materials import Texture
from ..parts.obstacles import Rail, standing
from ..parts.sides import Side
from .ground import Ground, curb_heights, rings_of, terrain_over
from .marks import Mark, PlanPaint, line_mark, stations_between
from .path import Path
from .scene import PlanLane, PlanScene, Track

Offset = Union[float, Callable[[np.ndarray], np.ndarray]]   # m from a path, left positive; the same everywhere, or a function of stations
_FRAME = 10.0     # m of ground around the surveyed area
_DROPPED = 0.05   # m: lower curbs are dropped


def _offsets(offset, s):
    return np.broadcast_to(offset(s) if callable(offset) else offset, s.shape).astype(float)


def strip(path: Path, start: float, end: float, right: Offset, left: Offset) -> shapely.Polygon:
    """The area along a path between two offsets and two stations, m."""
    s = stations_between(start, end)
    return shapely.make_valid(shapely.Polygon(np.concatenate([path.at(s, _offsets(right, s)), path.at(s, _offsets(left, s))[::-1]])))


class PlanBuilder:
    """Collects markings, lanes and objects; everything random follows from the seed.

    area : the surveyed area, m, local; paint, lanes and truth end at its border
    """

    def __init__(self, name: str, seed: int, area: shapely.Polygon):
        self.name, self.area = name, area
        self.random = np.random.default_rng([seed, 1])
        self.texture = Texture(seed)
        self.markings: list[Mark] = []
        self.lanes: list[PlanLane] = []
        self.objects: list[tuple[str, np.ndarray, float, tuple[float, ...]]] = []
        self.patches: list[np.ndarray] = []
        self.factors: list[float] = []
        self.manholes: list[tuple[float, float, float]] = []
        self.rails: list[tuple[np.ndarray, float, float]] = []
        shapely.prepare(area)

    def _within(self, path, start, end, offset):
        """Stretches of a line beside a path that lie in the surveyed area, (start, end) stations, m."""
        s = stations_between(start, end)
        inside = np.concatenate([[False], shapely.contains_xy(self.area, path.at(s, _offsets(offset, s))), [False]])
        turns = np.flatnonzero(np.diff(inside.astype(int)))
        return [(float(s[a]), float(s[b - 1])) for a, b in zip(turns[::2], turns[1::2]) if b - a > 4]

    def line(self, kind: str, path: Path, start: float, end: float, offset: Offset, width: float = 0.12,
             dash: tuple[float, float] | None = None) -> None:
        """Add a line along a path between two stations; `dash` is (painted, gap) in m."""
        number = 1 + max((mark.line or 0 for mark in self.markings), default=0)
        spans = self._within(path, start, end, offset)
        if dash is not None:
            starts = [s for low, high in spans for s in np.arange(start, high, sum(dash)) if s >= low]
            spans = [(s, s + dash[0]) for s in starts if any(s + dash[0] <= high for low, high in spans if low <= s)]
        if spans:
            offsets = [_offsets(offset, stations_between(*span)) for span in spans]
            self.markings.append(line_mark(kind, number, path, spans, offsets, width, dash is not None, self.random.uniform(0.05, 0.22)))

    def figure(self, kind: str, outlines: Sequence[np.ndarray], path: Path | None = None) -> None:
        """Add a marking of polygons, in local metres or, with a path, in stations and offsets."""
        if path is not None:
            outlines = [path.at(outline[:, 0], outline[:, 1]) for outline in outlines]
        inside = tuple(outline for outline in outlines if shapely.contains(self.area, shapely.Polygon(outline)))
        if inside:
            self.markings.append(Mark(kind, None, None, None, inside, inside, self.random.uniform(0.08, 0.25)))

    def lane(self, road: int, number: int, path: Path, start: float, end: float, right: Offset, left: Offset, direction: int = 1) -> None:
        """Add a lane between two offsets of a path; `direction` 1 is along it."""
        def middle(s):
            return (_offsets(right, s) + _offsets(left, s)) / 2

        for low, high in self._within(path, start, end, middle):
            s = stations_between(low, high)
            self.lanes.append(PlanLane(number, road, path, direction, s, _offsets(left, s), _offsets(right, s)))

    def car(self, place: np.ndarray, heading: float, size: tuple[float, float, float] | None = None) -> None:
        """Add a standing car at (2,) m; size: length, width, height."""
        size = size or (self.random.uniform(3.9, 4.8), self.random.uniform(1.70, 1.86), self.random.uniform(1.42, 1.62))
        self.objects.append(("car", place, heading, (*size, self.random.uniform(0.10, 0.55))))

    def tree(self, place: np.ndarray) -> None:
        """Add a tree at (2,) m."""
        shape = (self.random.uniform(0.10, 0.17), self.random.uniform(1.5, 2.2), self.random.uniform(1.2, 1.7), self.random.uniform(3.6, 4.4))
        self.objects.append(("tree", place, 0.0, shape))

    def pole(self, place: np.ndarray, height: float = 6.0, radius: float = 0.09) -> None:
        """Add a pole at (2,) m."""
        self.objects.append(("pole", place, 0.0, (radius, height)))

    def along(self, path: Path, start: float, end: float, spacing: float, offset: Offset) -> np.ndarray:
        """(N, 2) places along a path."""
        s = np.arange(start, end, spacing)
        return path.at(s, _offsets(offset, s))

    def rail(self, path: Path, start: float, end: float, offset: Offset, length: float = 4.0) -> None:
        """Add a guard rail with posts, in lengths of the path; where the offset jumps to the other side, the rail is interrupted."""
        ends = self.along(path, start, end, length, offset)
        apart = np.hypot(*np.diff(ends, axis=0).T) > 2 * length
        self.rails += [(part, Rail.high, Rail.low) for part in np.split(ends, np.flatnonzero(apart) + 1) if len(part) > 1]
        for a, b in zip(ends[:-1], ends[1:]):
            if np.hypot(*(b - a)) > 2 * length:
                continue
            heading = float(np.arctan2(*(b - a)[::-1]))
            self.objects.append(("rail", (a + b) / 2, heading, (float(np.hypot(*(b - a))),)))
            self.pole(a, 0.75, 0.05)

    def patch(self, path: Path, start: float, end: float, right: float, left: float, factor: float) -> None:
        """Add repaired asphalt, so many times as bright."""
        s = stations_between(start, end)
        self.patches.append(np.concatenate([path.at(s, right), path.at(s, left)[::-1]]))
        self.factors.append(factor)

    def scene(self, carriageway: shapely.Polygon, height: Callable[[np.ndarray], np.ndarray], profiles: Sequence[Side],
              profile_at: Callable[[np.ndarray, int], np.ndarray], where_at: Callable[[np.ndarray, int], np.ndarray],
              passes: Sequence[tuple[Path, float]], curb_height: float = 0.0, lowered: Sequence[shapely.Polygon] = (),
              gutter: float = 0.0) -> PlanScene:
        """The PlanScene of what was collected.

        carriageway : polygon, m, local, its ends outside of the surveyed area
        height : of the terrain at (N, 2) places, m
        profiles : strips beyond the edges, each a Side whose first border is 0
        profile_at, where_at : number of the profile, and where the edge runs (main, side_street, corner, island), at the (K, 2)
            vertices of a ring and its number, 0 for the outer one
        passes : (path, factor of the speed) of each
        curb_height : m
        lowered : areas in which curbs are lowered
        gutter : m, width of a concrete gutter
        """
        west, south, east, north = shapely.buffer(self.area, _FRAME).bounds
        rings = rings_of(carriageway)
        numbers = [np.asarray(profile_at(ring, k)) for k, ring in enumerate(rings)]
        has_curb = np.array([profile.curb_height > 0 for profile in profiles])
        heights = [np.where(has_curb[number], curb_heights(ring, curb_height, lowered), 0.0) for ring, number in zip(rings, numbers)]
        ground = Ground(terrain_over((west, south, east, north), height), rings, heights, profiles, numbers, shapely.buffer(self.area, _FRAME))
        edges = [np.where(has_curb[number], np.where(tall < _DROPPED, "dropped", "curb"), "pavement") for tall, number in zip(heights, numbers)]
        kinds = [np.asarray(where_at(ring, k)) for k, ring in enumerate(rings)]
        scene = PlanScene(self.name, ground, carriageway, self.area, kinds, edges, PlanPaint(self.markings, self.texture), self.texture,
                          self.lanes, [(Track(path, ground), haste) for path, haste in passes], [], self.patches, self.factors,
                          np.array(self.manholes).reshape(-1, 3), gutter, self.rails)
        for kind, place, heading, shape in self.objects:
            surface = ground.at(place[:1], place[1:])
            x, y, z = float(place[0]), float(place[1]), float(surface.z[0])
            if kind == "rail":
                slope = float(surface.slope_x[0] * np.cos(heading) + surface.slope_y[0] * np.sin(heading))
                scene.obstacles.append(Rail(x, y, z, heading, shape[0], slope))
            else:
                scene.obstacles += standing(kind, x, y, z, heading, shape)
        return scene
