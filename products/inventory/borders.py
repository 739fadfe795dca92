"""Where the carriageway and its lanes end, at every section, from the layers of the road map; the settings of the inventory."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import shapely

from ...core.common.errors import RoadExtractionError
from ...core.common.features import Features
from ...core.common.setting import Limited, check_limits, choice, setting
from ...core.countries.catalogue import COUNTRIES, NEUTRAL, Country, SectionLimits, country
from ...core.driving.layers import Lanes
from ...core.survey.frame.placement import FrameLines, line_parts, lines_in_frame
from ...core.survey.frame.road_frame import RoadFrame

MAX_BORDER_OBLIQUITY = np.tan(np.radians(25.0))  # a line that runs more across the road than this is no border of it
BORDER_REACH = 0.8       # m beyond half a lane's width within which a painted line is its border
MIN_DRIVEN_PART = 0.5    # of the width of a strip between two lines that a driving line or lane must not have taken before


@dataclass(frozen=True)
class BorderLayers:
    """The layers of a road map as Features in map coordinates; None where not given."""

    edges: Features | None = None
    marking_lines: Features | None = None
    driving_lines: Features | None = None
    lanes: Features | None = None


@dataclass(frozen=True)
class Strip:
    """A lane or the carriageway at one section.

    curbs : whether its right and left border may be a curb: road edges that are not said to be the edge of a pavement without one
    """

    right: float   # right, left: m, offsets of its borders
    left: float
    lane: int   # number of the lane, 0 for the carriageway
    type: str   # as in LANES; "carriageway" for the carriageway
    direction: int   # of travel, 1 along the road, -1 against it, 0 where unknown
    borders: str   # what they were taken from: lanes, lines, edges or track
    curbs: tuple[bool, bool] = (False, False)

    @property
    def width(self) -> float:
        """m"""
        return self.left - self.right


@dataclass
class _Pieces:
    """Lines of one layer in the road frame with what their rows say, and the stations between which each runs."""

    lines: FrameLines
    rows: list[dict[str, Any]] = field(default_factory=list)

    def __post_init__(self) -> None:
        ends = [(np.nanmin(part), np.nanmax(part)) if np.isfinite(part).any() else (np.inf, -np.inf)
                for part in (self.lines.s[self.lines.line(k)] for k in range(len(self.lines)))]
        self.low, self.high = np.array(ends).reshape(-1, 2).T


class RoadBorders:
    """Borders of carriageway and lanes, station by station. country : whose lanes tell two lines that bound a lane"""

    def __init__(self, layers: BorderLayers, frame: RoadFrame, country: Country):
        self.frame, self.country = frame, country
        self.edges = _pieces(layers.edges, frame, lambda row: (row.get("kind") or "main") == "main" and (row.get("part") or "bottom") == "bottom")
        self.lines = _pieces(layers.marking_lines, frame)
        self.driving = _pieces(layers.driving_lines, frame)
        self.lane_borders = None if layers.lanes is None else _lane_borders(layers.lanes, frame)

    @property
    def given(self) -> bool:
        return any(layer is not None for layer in (self.edges, self.lines, self.driving, self.lane_borders))

    def outer(self, road: int, s: float) -> tuple[float, float]:
        """(right, left) offsets of the carriageway's edges, else of its outermost lanes or lines; NaN where there are none."""
        strips = self.at(road, s) if self.given else None
        if strips is not None:
            return strips[0].right, strips[0].left
        track = self._track(road, s)
        return _nearest_outside(_offsets(_crossings(self.edges, road, s)), float(track.min()), float(track.max()))

    def _track(self, road, s):
        """Offsets of the passes that drove a station; 0 where none did."""
        passes = [p for p in self.frame.passes_of(road) if p.span[0] - 1.0 <= s <= p.span[1] + 1.0]
        return np.array([p.at_station(np.array([s]))[0][0] for p in passes] or [0.0])

    def at(self, road: int, s: float) -> tuple[Strip, list[Strip]] | None:
        """The carriageway and its lanes, from right to left, at a station of a road; None where the layers know no carriageway."""
        track = self._track(road, s)
        lines = _offsets(_crossings(self.lines, road, s))
        lanes = self._lanes(road, s, lines)
        edges = _crossings(self.edges, road, s)
        # the track lies on the carriageway; edges are looked for beyond it and beyond the lanes that nobody doubts
        right, left = _nearest_outside(_offsets(edges), float(track.min()), float(track.max()))
        if not lanes and len(lines) > 1:
            lanes = self._between(lines, right, left)
        between_edges = bool(np.isfinite(right) and np.isfinite(left))
        if not lanes and not between_edges:
            if self.given:
                return None
            lanes = self._driven(track)
        borders = "edges" if between_edges or not lanes else lanes[0].borders
        if not np.isfinite(right):
            right = min([*(strip.right for strip in lanes), *lines])
        if not np.isfinite(left):
            left = max([*(strip.left for strip in lanes), *lines])
        if track.max() < right or track.min() > left:
            return None   # lanes beside the road that was driven, such as of a street that it joins
        curbs = {d for d, row, _ in edges if row.get("edge") != "pavement"}
        return Strip(float(right), float(left), 0, "carriageway", 0, borders, (right in curbs, left in curbs)), lanes

    def _lanes(self, road, s, lines):
        if self.lane_borders is not None and len(self.lane_borders.rows):
            strips = []
            crossed: dict[int, list[float]] = {}
            for d, _, k in _crossings(self.lane_borders, road, s):
                crossed.setdefault(k // 2, []).append(d)
            for lane, ds in crossed.items():
                row = self.lane_borders.rows[2 * lane]
                if len(ds) == 2 and row["type"] != "connector":
                    strips.append(Strip(min(ds), max(ds), int(row["lane"]), row["type"], int(row["direction"]), "lanes"))
            return _apart(strips)
        strips = []
        for d, row, _ in _crossings(self.driving, road, s):
            half = 0.5 * float(row.get("width_m") or self.country.usual_lane)
            right, left = _within(lines[lines < d], d - half), _within(lines[lines > d], d + half)
            strips.append(Strip(right, left, int(row.get("lane") or 0), "driving", int(row.get("direction") or 0), "lines"))
        return _apart(strips)

    def _between(self, lines, right, left):
        """Lanes between painted lines a lane's width apart."""
        low, high = (right if np.isfinite(right) else -np.inf), (left if np.isfinite(left) else np.inf)
        lines = lines[(lines > low) & (lines < high)]
        pairs = [(a, b) for a, b in zip(lines[:-1], lines[1:]) if self.country.narrowest_lane <= b - a <= self.country.widest_lane]
        return [Strip(float(a), float(b), k + 1, "driving", 0, "lines") for k, (a, b) in enumerate(pairs)]

    def _driven(self, track):
        """A lane of the country's usual width about every track: all that is known without a layer."""
        half = 0.5 * self.country.usual_lane
        middles = [float(d) for k, d in enumerate(np.sort(track)) if k == 0 or d - np.sort(track)[k - 1] > half]
        return _apart([Strip(d - half, d + half, k + 1, "driving", 0, "track") for k, d in enumerate(middles)])


def _within(candidates, wanted):
    """The painted line nearest to where a border is wanted, else that place itself."""
    if len(candidates):
        best = candidates[np.argmin(np.abs(candidates - wanted))]
        if abs(best - wanted) < BORDER_REACH:
            return float(best)
    return float(wanted)


def _apart(strips):
    """Strips from right to left; of two that lie over each other the wider one."""
    kept: list[Strip] = []
    for strip in sorted(strips, key=lambda one: -one.width):
        if all(min(strip.left, one.left) - max(strip.right, one.right) < MIN_DRIVEN_PART * strip.width for one in kept):
            kept.append(strip)
    return sorted(kept, key=lambda one: one.right)


def _nearest_outside(edges, low, high):
    """The nearest edge right of `low` and left of `high`; NaN where there is none."""
    right, left = edges[edges < low], edges[edges > high]
    return (float(right.max()) if len(right) else np.nan), (float(left.min()) if len(left) else np.nan)


def _pieces(features, frame, wanted=lambda row: True):
    """Lines of a layer in the road frame, with their rows."""
    if features is None:
        return None
    parts, row_of = line_parts(features.geometries)
    members = [k for k, row in enumerate(row_of) if wanted(features.rows[row])]
    rows = [features.rows[row_of[k]] for k in members]
    roads = [-1 if row.get("road") is None else int(row["road"]) for row in rows]
    return _Pieces(lines_in_frame([parts[k] for k in members], roads, frame), rows)


def _lane_borders(features, frame):
    """Both borders of every lane: lines 2 k and 2 k + 1 belong to lane k."""
    lanes = Lanes.from_features(features)
    shapes = [shapely.linestrings(border) for k in range(len(lanes)) for border in lanes.borders(k)]
    rows = [dict(lane=lanes.lane[k], type=lanes.type[k], direction=lanes.direction[k]) for k in range(len(lanes)) for _ in range(2)]
    return _Pieces(lines_in_frame(shapes, np.repeat(lanes.road, 2), frame), rows)


def _offsets(crossings):
    """(N,) offsets of crossings, ascending."""
    return np.sort(np.array([d for d, _, _ in crossings]))


def _crossings(pieces, road, s):
    """[(offset, row, number of the line)] where the lines of a layer, which may be None, cross the section at a station."""
    if pieces is None:
        return []
    crossings, lines = [], pieces.lines
    for k in np.flatnonzero((lines.road == road) & (pieces.low <= s) & (pieces.high >= s)).tolist():
        rows = lines.line(k)
        along, d = lines.s[rows], lines.d[rows]
        step = np.flatnonzero((np.minimum(along[:-1], along[1:]) <= s) & (np.maximum(along[:-1], along[1:]) > s))
        for j in step[:1].tolist():
            ahead = along[j + 1] - along[j]
            if abs(d[j + 1] - d[j]) <= MAX_BORDER_OBLIQUITY * abs(ahead):
                crossings.append((float(d[j] + (s - along[j]) / ahead * (d[j + 1] - d[j])), pieces.rows[k], k))
    return crossings


# Settings of cross-sections, their limits, and settings of the roadside.

@dataclass(frozen=True)
class CrossSectionSettings:
    """What is measured, and what is too much. A limit of 0 is that of the country, if it has one.

    min_crossfall, max_crossfall : % of a lane, whatever its direction
    """

    interval: float = setting(10.0, 1.0, 1000.0, "The interval", "m")   # m of station between sections
    country: str = choice(NEUTRAL.name, COUNTRIES, "The country")
    max_rut: float = setting(0.0, 1.0, 200.0, "The rut depth", "mm", "for the country's")   # mm, of the rut depth under a straight edge of 2 m
    min_crossfall: float = setting(0.0, 0.1, 20.0, "The least crossfall", "%", "for the country's")
    max_crossfall: float = setting(0.0, 0.1, 20.0, "The greatest crossfall", "%", "for the country's")
    max_grade: float = setting(0.0, 0.1, 50.0, "The greatest grade", "%", "for the country's")   # % along the road
    min_width: float = setting(0.0, 1.0, 10.0, "The least lane width", "m", "for the country's")   # m of a driving lane
    min_clearance: float = setting(0.0, 1.0, 10.0, "The least clearance", "m", "for the country's")   # m above the road

    def __post_init__(self) -> None:
        check_limits(self)
        limits = self.limits()
        if limits.min_crossfall is not None and limits.max_crossfall is not None and limits.min_crossfall > limits.max_crossfall:
            least, most = ("" if user_limit else f" in the rules of {self.country}" for user_limit in (self.min_crossfall, self.max_crossfall))
            raise RoadExtractionError(f"The least crossfall is {limits.min_crossfall:g} %{least}, the greatest {limits.max_crossfall:g} %{most}: no "
                                      "lane can keep both. Set both limits so that the least is below the greatest.")

    def limits(self) -> SectionLimits:
        """The limits that hold: the user's own, else the country's; None where neither has one."""
        national = country(self.country).section_limits
        chosen = {name: value for name in SectionLimits.NAMES if (value := getattr(self, name))}
        return replace(national, **chosen, rules={**national.rules, **dict.fromkeys(chosen, "limit set by the user")})


# Settings of the roadside.

@dataclass(frozen=True)
class RoadsideSettings(Limited):
    """What counts as standing beside the road."""

    interval: float = setting(10.0, 1.0, 1000.0, "The interval", "m")   # m of station between vertices of the lines at most
    country: str = choice(NEUTRAL.name, COUNTRIES, "The country")   # whose lanes tell two marking lines that bound one, without edges
    reach: float = setting(8.0, 0.5, 50.0, "The reach beyond the edge", "m")   # m beyond the carriageway's edge within which things are looked for
    min_length: float = setting(8.0, 2.0, 200.0, "The length of a line", "m")   # m of a rail, barrier, wall, fence or hedge
    min_height: float = setting(0.4, 0.2, 3.0, "The height of a line", "m")   # m of its top above the ground
    max_gap: float = setting(3.0, 0.5, 20.0, "The gap", "m")   # m along the road that such a line may be hidden or interrupted
    min_pole_height: float = setting(1.5, 0.8, 8.0, "The height of a pole", "m")   # m of a pole, sign or trunk
