"""The layer CORRECTIONS, read and checked."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import shapely

from ..common.errors import RoadExtractionError
from ..common.features import Features
from ..io.crs import in_other_crs, parse_crs, same_crs
from ..markings.cross_section.weights import TakenReading
from ..survey.frame.placement import LINE_VERTEX_SPACING
from ..survey.frame.road_frame import RoadFrame

ACTIONS = ("accept", "delete", "move", "draw", "take", "seen")
SEEN = "seen"   # the action of a row that keeps a note of the review alone and asks for nothing
TARGETS = ("edge", "marking", "lane")
ACCEPTED, DRAWN = "accepted", "drawn"   # status of what an analyst confirmed, and of what an analyst drew


@dataclass(frozen=True)
class Correction:
    """One row of the layer.

    lanes : of a second reading that is taken, offset on the road and width, m, and direction of each lane that then lies there
    """

    row: int   # its number in the layer, from 1
    action: str   # one of ACTIONS
    target: str   # one of TARGETS
    places: np.ndarray   # (V, 3) local metres, z is NaN where the row has none; one place for a point
    road: int = -1   # number of the road that it lies on in this run, -1 for none
    station: float = np.nan   # metres of its middle on that road, NaN for none
    offset: float = np.nan
    kind: str = ""   # of a marking line that is drawn, "" where not said
    pattern: str = ""
    note: str = ""   # the analyst's words
    lanes: tuple[tuple[float, float, int], ...] = ()
    width: float = np.nan   # m of a lane that is drawn, NaN where not said
    height: float = np.nan   # m of a curb that is drawn, NaN where not said

    @property
    def draws(self) -> bool:
        """Whether it brings a line of its own."""
        return self.action in ("move", "draw")

    @property
    def on_a_road(self) -> bool:
        return self.road >= 0

    def described(self) -> str:
        """What it asks for and where, in a few words."""
        site = f"road {self.road}, station {self.station:.1f} m, offset {self.offset:+.1f} m" if self.on_a_road else "off the roads of this survey"
        return f"row {self.row}, {self.action} {self.target}, {site}" + (f" ({self.note})" if self.note else "")


@dataclass
class Corrections:
    """All corrections of a run; `matched` holds the rows of those that something was found for."""

    rows: list[Correction] = field(default_factory=list)
    matched: set[int] = field(default_factory=set)

    def __len__(self) -> int:
        return len(self.rows)

    def of(self, target: str) -> list[Correction]:
        """Those of one target, in the order of the layer."""
        return [row for row in self.rows if row.target == target]

    def asked(self, target: str, actions: Sequence[str] = ACTIONS) -> list[Correction]:
        """What is asked for one target by some actions, whatever else the layer holds and says: plain values that tell requests apart."""
        return [replace(row, row=0, note="") for row in self.of(target) if row.action in actions]

    def taken(self, frame: RoadFrame) -> list[TakenReading]:
        """The second readings of lanes that were taken, for the estimate of lines and lanes."""
        readings = []
        for row in self.of("lane"):
            if row.action == "take" and row.on_a_road:
                s, d = frame.roads[row.road].locate(*row.places[:, :2].T)
                order = np.argsort(s)
                order = order[np.isfinite(s[order])]
                if len(order):
                    middle = float(np.median(d[order]))
                    readings.append(TakenReading(row.road, s[order], d[order],
                                                 tuple((offset - middle, width, way) for offset, width, way in row.lanes)))
        return readings

    @property
    def unmatched(self) -> list[Correction]:
        """Those for which this run has nothing at their place."""
        return [row for row in self.rows if row.row not in self.matched]


def corrections_from_features(features: Features, frame: RoadFrame, crs: str = "") -> Corrections:
    """Read the layer CORRECTIONS.

    features : Features of points, lines or rows without geometry, in map coordinates. `action` and `target` are needed; a row without
        geometry lies at its `road`, `station_m` and `offset_m`; `note`, `kind`, `pattern` and `height_m` are used where they are
    crs : WKT of the survey; corrections in another CRS are brought there, those that say none are taken to be in it
    Returns Corrections
    Raises RoadExtractionError if an action or target is unknown, a row has no place, what is moved or drawn has no line, or a height is no number.
    """
    result = Corrections()
    geometries, source, survey = features.geometries, parse_crs(features.crs), parse_crs(crs)
    if source is not None and survey is not None and not same_crs(source, survey):
        geometries = in_other_crs(geometries, source, survey)
    for number, (geometry, row) in enumerate(zip(geometries, features.rows), start=1):
        action, target = (str(row.get(name) or "").strip().lower() for name in ("action", "target"))
        if action == SEEN:
            continue
        for name, value, allowed in (("action", action, ACTIONS), ("target", target, TARGETS)):
            if value not in allowed:
                raise RoadExtractionError(f"Row {number} of the corrections has the {name} {value!r}; it must be one of {', '.join(allowed)}.")
        parts = [places for places in _parts_of(geometry, row, frame, number) if len(places)]
        if action in ("move", "draw") and any(len(places) < 2 for places in parts):
            raise RoadExtractionError(f"Row {number} of the corrections is to {action} something, which takes a line; it has a point. "
                                      "Draw the line where it belongs.")
        kind, pattern, note = (str(row.get(name) or "").strip() for name in ("kind", "pattern", "note"))
        try:
            height = float(row.get("height_m") or np.nan)
        except (TypeError, ValueError) as error:
            raise RoadExtractionError(f"Row {number} of the corrections has the height {row['height_m']!r}; it must be a number (m).") from error
        lanes: tuple[tuple[float, float, int], ...] = ()
        if action == "take":
            lanes, kind = _second_reading(row.get("other"), target, number)
        for places in parts:
            (road,), (station,), (offset,) = frame.locate_nearest(*places[len(places) // 2, :2, None])
            result.rows.append(Correction(number, action, target, places, int(road), float(station), float(offset), kind, pattern, note, lanes,
                                          height=height))
    return result


def taken_reading(row: dict[str, Any], target: str) -> dict[str, str] | None:
    """The fields of a correction that takes the second reading of a piece, in its field `other`, in place of the first; None where it has none."""
    reading = str(row.get("other") or "")
    return {"action": "take", "target": target, "other": reading} if reading.startswith("{") else None


def _second_reading(text: Any, target: str, number: int) -> tuple[tuple[tuple[float, float, int], ...], str]:
    """The lanes, and the kind of line, of a second reading in JSON."""
    with suppress(ValueError, KeyError, TypeError):
        reading = json.loads(text or "")
        if target == "lane":
            lanes = tuple((float(lane["offset_m"]), float(lane["width_m"]), int(lane["direction"])) for lane in reading["lanes"])
            if all(np.isfinite(lane).all() and lane[1] > 0 and lane[2] in (-1, 1) for lane in lanes):
                return lanes, ""
        elif target == "marking":
            return (), str(reading["kind"])
    raise RoadExtractionError(f"Row {number} of the corrections is to take a second reading of a {target}, but its field other holds none. "
                              "Copy the field other of that lane or marking line.")


def _parts_of(geometry: Any, row: dict[str, Any], frame: RoadFrame, number: int) -> Iterable[np.ndarray]:
    """Local places of each part of a row."""
    if geometry is None or geometry.is_empty:
        yield np.array([_place_of(row, frame, number)])
        return
    for part in shapely.get_parts(geometry):
        if part.geom_type not in ("Point", "LineString"):
            raise RoadExtractionError(f"Row {number} of the corrections is a {part.geom_type}; a point or a line is needed.")
        if part.geom_type == "LineString":
            part = shapely.segmentize(part, LINE_VERTEX_SPACING)
        places = shapely.get_coordinates(part, include_z=True)
        x, y = frame.to_local(places[:, 0], places[:, 1])
        # a line that was drawn in a map window has heights of 0, which are none
        z = places[:, 2] - frame.origin[2] if places[:, 2].any() else np.full(len(places), np.nan)
        yield np.c_[x, y, z]


def _place_of(row, frame, number):
    """Local x, y and no z of a row without geometry."""
    values = [row.get(name) for name in ("road", "station_m", "offset_m")]
    if any(value is None for value in values) or not 0 <= int(values[0]) < len(frame.roads):
        raise RoadExtractionError(f"Row {number} of the corrections has neither a geometry nor a road of this survey with station_m and offset_m. "
                                  "Draw it as a point or line.")
    x, y = frame.roads[int(values[0])].to_map(np.array([float(values[1])]), np.array([float(values[2])]))
    return float(x[0]), float(y[0]), np.nan
