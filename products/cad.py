"""The road map for CAD: DXF drawings of 3D polylines and faces, one layer a class; LandXML with alignments, profiles, sections and surfaces."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any, NamedTuple

import numpy as np
import shapely

from ..core.common.features import Features
from ..core.common.texts import word
from ..core.io.crs import FOOT, US_SURVEY_FOOT, FileUnits, as_in_file, horizontal_part, parse_crs
from ..core.io.weights import IO
from .export.opendrive.exporter import OpenDriveSettings, draft_opendrive
from .export.opendrive.geometry import PlanElement, PlanView
from .export.opendrive.reference_line import fit_reference
from .export.sources import RoadMapSource, plan_length, without_repeats
from .export.xml_tree import file_text
from .inventory.cross_sections import RoadSections, exceeded
from .surface.model import SurfaceModel

# source: AutoCAD Color Index, 7 white or black, 9 light grey
COLOURS = {"LANE_BORDER": 8, "DRIVING_LINE": 150, "MARKING_EDGE": 7, "MARKING_LANE": 254, "MARKING_CENTRE": 40, "ROAD_EDGE": 30, "MARKING_AREA": 2,
           "SECTION_EXCEEDED": 1, "SECTION_GROUND": 7, "SURFACE": 8, "BREAKLINE_EDGE": 30, "BREAKLINE_GUTTER": 150, "BREAKLINE_CROWN": 3,
           "BREAKLINE_LANE": 6}
LETTER = 0.25         # source: m of a text in a drawing of sections, 2.5 mm at 1 : 100 (ISO 3098)
SECTIONS_IN_COLUMN = 10   # cost: a column of sections more or less


class _DxfLine(NamedTuple):
    """layer : name; places : (N, 3); closed : whether the last place is joined with the first; text : written at the place, `turned` by degrees."""

    layer: str
    places: np.ndarray
    closed: bool = False
    text: str = ""
    turned: float = 0.0


def dxf_lines(source: RoadMapSource) -> list[_DxfLine]:
    """Lane borders, driving lines, marking lines by kind and pattern, road edges by what they are, outlines of markings by class."""
    lanes, borders = source.lanes, dict[bytes, _DxfLine]()
    for k in range(len(lanes)):
        for border in lanes.borders(k):
            if np.hypot(*(border[-1] - border[0])[:2]) > 0.01:   # neighbours have one between them
                borders.setdefault(min(border.tobytes(), border[::-1].tobytes()), _DxfLine(f"LANE_BORDER_{lanes.type[k].upper()}", border))
    lines = list(borders.values())
    lines += _of(source.driving_lines, lambda row: "DRIVING_LINE" + ("" if row.get("status") in (None, "measured") else f"_{row['status'].upper()}"))
    lines += _of(source.marking_lines, lambda row: "_".join(filter(None, ("MARKING", str(row.get("kind") or "line").upper(),
                                                                          str(row.get("pattern") or "").upper().replace("-", "_")))))
    lines += _of(source.road_edges, _edge_layer)
    lines += _of(source.markings, lambda row: f"MARKING_AREA_{str(row.get('class') or 'other').upper()}")
    return lines


def _on_map(sections, section):
    """(offsets, heights on the map) of what was seen of a section."""
    seen = np.isfinite(section.z)
    d = section.d[seen]
    return d, sections.frame.to_map(section.road, np.full(len(d), section.station), d, section.z[seen])[2]


def section_alignments(sections: RoadSections) -> list[Alignment]:
    """The reference line of every road with its sections."""
    alignments = []
    for road in sorted({section.road for section in sections.sections}):
        members = [section for section in sections.sections if section.road == road]
        length = sections.frame.road(road).length
        s = np.linspace(0.0, length, max(int(length / AXIS_STEP), 1) + 1)
        places = np.stack(sections.frame.to_map(road, s, 0.0 * s, 0.0 * s), axis=1)
        alignments.append(Alignment(f"Road {road}", "Reference line of the stations", None, places, np.empty((0, 2)),
                                    sections=[(section.station, np.stack(_on_map(sections, section), axis=1)) for section in members]))
    return alignments


def section_table(sections: RoadSections) -> str:
    """Stations, offsets, left positive, and heights of all sections as CSV, in metres, one place a line."""
    lines = ["road,station,offset,height"]
    for section in sections.sections:
        lines += [f"{section.road},{section.station:.3f},{offset:.3f},{height:.4f}" for offset, height in zip(*_on_map(sections, section))]
    return "\n".join(lines) + "\n"


def drawn_layers(layers: Mapping[str, Features]) -> list[_DxfLine]:
    """Lines and outlines of areas of layers under the names of these; a point is written as the first text of its row."""
    return [line for name, layer in layers.items() for line in _of(layer, lambda row, name=name: name)]  # type: ignore[misc]


def section_drawing(sections: RoadSections) -> list[_DxfLine]:
    """Every section as one sees it along the road, true to scale, one below the other, with stations, heights, slopes and limits that are not kept.

    Lengths are metres. The ground is drawn above a level line, whose height stands beside it.
    """
    limits, placed = sections.settings.limits(), []
    for section in sections.sections:
        d, height = _on_map(sections, section)
        placed.append((section, d, height, np.floor(height.min()) - 1.0))
    wide, lines, base = max(np.ptp(d) for _, d, _, _ in placed) + 40 * LETTER, [], 0.0
    for k, (section, d, height, datum) in enumerate(placed):
        left, top = k // SECTIONS_IN_COLUMN * wide, base if k % SECTIONS_IN_COLUMN else 0.0
        broken = [exceeded(part, part.strip.width / float(np.hypot(1.0, section.heading)), limits) for part in section.parts]
        reasons = [f"{part.strip.lane or word('carriageway')}: {text}" for part, texts in zip(section.parts, broken) for text in texts.values()]
        level = top - (6 + 1.6 * len(reasons)) * LETTER - height.max() + datum
        base = level - 12 * LETTER

        def at(offsets, heights, left=left, level=level, datum=datum):
            return np.c_[left - np.atleast_1d(offsets), level + np.atleast_1d(heights) - datum, np.zeros(np.size(offsets))]

        def write(layer, offset, z, text, turned=0.0, at=at):
            lines.append(_DxfLine(layer, at(offset, z), text=text, turned=turned))

        lines += [_DxfLine("SECTION_GROUND", at(d, height)), _DxfLine("SECTION_DATUM", at([d.max(), d.min()], [datum, datum]))]
        write("SECTION_TEXT", d.max() + 12 * LETTER, datum, f"{section.road}: {section.station:.2f} m, {datum:.2f} m")
        for part, texts in zip(section.parts, broken):
            strip, inside = part.strip, (d > part.strip.right) & (d < part.strip.left)
            if texts and inside.sum() > 1:
                lines.append(_DxfLine("SECTION_EXCEEDED", at(d[inside], height[inside])))
            if strip.lane and np.isfinite(part.crossfall):
                middle, width = 0.5 * (strip.left + strip.right), strip.width / float(np.hypot(1.0, section.heading))
                write("SECTION_TEXT", middle, np.interp(middle, d, height) + 2 * LETTER, f"{width:.2f} m  {100 * part.crossfall:+.1f} %")
        written = -np.inf
        for border in sorted({edge for part in section.parts for edge in (part.strip.left, part.strip.right)}):
            z = float(np.interp(border, d, height))
            lines.append(_DxfLine("SECTION_BORDER", at([border, border], [datum, z])))
            if border - written > 1.3 * LETTER:
                write("SECTION_TEXT", border, datum - 5 * LETTER, f"{border:+.2f}  {z:.3f}", 90.0)
                written = border
        for row, text in enumerate(reasons):
            write("SECTION_EXCEEDED", 0.5 * (d.min() + d.max()), height.max() + (4 + 1.6 * row) * LETTER, text)
    return lines


def _edge_layer(row: dict[str, Any]) -> str:
    """ROAD_EDGE_CURB, _DROPPED or _PAVEMENT; of layers that do not say what an edge is, ROAD_EDGE_CURB where it has a height, else ROAD_EDGE."""
    edge = row.get("edge") or ("curb" if row.get("height_m") else "")
    return f"ROAD_EDGE_{str(edge).upper()}" if edge else "ROAD_EDGE"


def _of(layer: Features | None, name_of: Callable[[dict[str, Any]], str]) -> list[_DxfLine]:
    lines = []
    for geometry, row in layer or ():
        for part in shapely.get_parts(geometry) if geometry is not None else ():
            closed = part.geom_type == "Polygon"
            places = shapely.get_coordinates(part.exterior if closed else part, include_z=True)
            text = next((str(value) for value in row.values() if value), "+") if part.geom_type == "Point" else ""
            lines.append(_DxfLine(name_of(row), places, closed, text))
    return lines


def write_dxf(lines: list[_DxfLine], path: str, crs: str = "", faces: np.ndarray | None = None) -> None:
    """Write lines, texts and the faces of a surface as a DXF of AutoCAD R12, which every CAD program reads.

    crs : WKT, metric; the file has the units of the survey's own CRS. "" for metres
    faces : (F, 3, 3) m, corners of triangles, in the layer SURFACE

    Source: AutoCAD R12 DXF reference; pairs of a group code and a value, a line each.
    """
    units = as_in_file(crs)[1]
    layers = sorted({line.layer for line in lines} | ({"SURFACE"} if faces is not None else set()))
    text = file_text(
        "dxf.txt", layers=[(_dxf_text(layer), next((colour for name, colour in COLOURS.items() if layer.startswith(name)), 9)) for layer in layers],
        lines=((_dxf_text(line.layer), units.in_file(line.places).tolist(), line.closed, _dxf_text(line.text), line.turned) for line in lines),
        faces=[] if faces is None else units.in_file(faces)[:, [0, 1, 2, 2]].tolist(),   # a triangle is a face whose last corner stands twice
        letter=LETTER / units.across)
    with open(path, "w", encoding="cp1252", newline="\r\n") as file:
        file.write(text)


def _dxf_text(text):
    """A text of which letters that the file's encoding lacks are written by their numbers, as AutoCAD does."""
    return "".join(letter if letter.encode("cp1252", "ignore") else f"\\U+{ord(letter):04X}" for letter in text)


# Writes LandXML 1.2: alignments with their elements and profiles.
#
# Reference: LandXML-1.2 schema (landxml.org), CoordGeom and Profile. Places are northing, easting.

FEET_IN_LANDXML = {"USSurveyFoot": US_SURVEY_FOOT, "foot": FOOT}
NAMESPACE = "http://www.landxml.org/schema/LandXML-1.2"


def landxml_text(alignments: Sequence[Alignment], crs: str = "", name: str = "Road map", moment: datetime = datetime(2000, 1, 1),
                 surface: SurfaceModel | None = None) -> str:
    """The file as text.

    `crs`: WKT, metric, "" where unknown; where it is that of a survey in feet, so is the file, heights too. `name`: of the project.
    `moment`: when it is written.
    """
    file_wkt, units = as_in_file(crs)
    unit = next((name for name, foot in FEET_IN_LANDXML.items() if abs(units.across / foot - 1) < IO.same_unit), "")
    if unit:
        crs, alignments = file_wkt, [alignment.in_file(units) for alignment in alignments]
    return file_text("landxml.xml", namespace=NAMESPACE, moment=moment, unit=unit, crs=horizontal_part(parse_crs(crs)), name=name,
                    surface=_surface(surface, units.across if unit else 1.0) if surface is not None else None, alignments=alignments,
                    elements_of=_elements)


def _surface(model, unit):
    """A surface of triangles with the breaklines that they follow, in units of so many m. Vertices are numbered from 1."""
    used, faces_of = np.unique(model.surface.faces, return_inverse=True)
    vertices = model.places[used] / unit
    return dict(lines=[(kind, (places + model.origin) / unit) for kind, places in model.followed], vertices=vertices, heights=vertices[:, 2],
                faces=(faces_of.reshape(-1, 3) + 1).tolist())


def _elements(plan):
    """Of each element of a line (itself, start, end, where its tangents meet or the centre of an arc, degrees clockwise from north at both ends,
    degrees by which it turns, its chord)."""
    for piece in elements_without_reversal(plan):
        (start, end), (first, last), _ = piece.at(np.array([0.0, piece.length]))
        chord, turn, turned, middle = end - start, np.sin(last - first), abs(last - first), (start + end) / 2   # half-way where they are parallel
        if piece.kind == "arc":
            middle, turned = start + np.array([-np.sin(first), np.cos(first)]) / piece.values[0], abs(piece.values[0]) * piece.length
        elif abs(turn) >= 1e-9:
            middle = start + np.array([np.cos(first), np.sin(first)]) * (chord[0] * np.sin(last) - chord[1] * np.cos(last)) / turn
        yield piece, start, end, middle, (90.0 - np.degrees([first, last])) % 360.0, np.degrees(turned), np.hypot(*chord)


def surface_lines(model: SurfaceModel) -> list[_DxfLine]:
    return [_DxfLine(f"BREAKLINE_{kind.upper()}", places + model.origin) for kind, places in model.followed]


# Axes of roads and driving lines as elements: lines, arcs and spirals, and a profile of tangents.

NEAREST_PLACES = 0.005   # m between places of a line
JOINT = 0.01             # m between pieces of one line that go on
AXIS_STEP = 1.0       # m between heights of an axis


@dataclass(frozen=True)
class Alignment:
    """A line for construction."""

    name: str   # of the road or lane
    description: str   # what it is
    plan: PlanView | None   # PlanView in map coordinates; None where no short elements follow the line: `places` then holds it
    places: np.ndarray   # (N, 3) map coordinates
    profile: np.ndarray   # (M, 2) station and height, metres, of the tangents' intersections
    missed: float = 0.0   # metres that a place lies beside the elements at most
    sections: Sequence[tuple[float, np.ndarray]] = ()   # (station, (N, 2) offset, left positive, and height on the map) of cross-sections, m

    def in_file(self, units: FileUnits) -> Alignment:
        """The same in the units of a file; its heights have those of x and y."""
        if units.metric:
            return self
        per_metre = 1.0 / units.across
        plan = None if self.plan is None else PlanView(tuple(
            replace(element, s=element.s * per_metre, x=element.x * per_metre, y=element.y * per_metre, length=element.length * per_metre,
                    values=tuple(bend / per_metre for bend in element.values)) for element in self.plan.elements))
        sections = [(station * per_metre, ground * per_metre) for station, ground in self.sections]
        return replace(self, plan=plan, places=self.places * per_metre, profile=self.profile * per_metre, sections=sections)

    @property
    def length(self) -> float:
        """In plan."""
        return self.plan.length if self.plan is not None else plan_length(self.places)


def alignments_of(source: RoadMapSource, tolerance: float) -> list[Alignment]:
    """The axis of every road, and every driving line or, without these, the middles of the lanes, within a tolerance in plan and height, m."""
    draft = draft_opendrive(source, OpenDriveSettings(tolerance))
    origin = np.array(draft.map.offset[:2])
    alignments = []
    for road in draft.map.roads:
        if road.junction != "-1":
            continue
        s = np.linspace(0.0, road.length, max(int(road.length / AXIS_STEP), 1) + 1)
        places = np.c_[road.plan.at(s)[0] + origin, road.elevation.at(s)]
        fitted = all(element.kind != "paramPoly3" for element in road.plan.elements)
        alignments.append(Alignment(f"Road {road.id}", f"Axis of {road.name.lower()}", _moved(road.plan, origin) if fitted else None, places,
                                    _tangents(s, places[:, 2], tolerance)))
    for name, places in _driven(source):
        alignments.append(_fitted(name, places, tolerance))
    return alignments


def _driven(source):
    """(name, (N, 3) places) of every driving line, its pieces joined."""
    layer, lanes = source.driving_lines, source.lanes
    if layer is None or not len(layer):
        for k in np.flatnonzero(np.isin(lanes.type.astype(str), ("driving", "connector"))):
            yield f"Lane {lanes.lane_id[k]}", sum(lanes.borders(k)) / 2
        return
    lines: dict[tuple[int, int], list[np.ndarray]] = {}
    for geometry, row in layer:
        pieces = lines.setdefault((row.get("road") or 0, row.get("lane") or 0), [])
        pieces += [] if geometry is None else [shapely.get_coordinates(geometry, include_z=True)]
    for (road, lane), pieces in sorted(lines.items()):
        for number, places in enumerate(_joined(pieces), start=1):
            yield f"Lane {road}.{lane}" + (f" part {number}" if number > 1 else ""), places


def _joined(pieces):
    """Pieces that go on end to end as one; rows of one lane may come in any order."""
    waiting = list(pieces)
    while waiting:
        line, k = waiting.pop(0), 0
        while k < len(waiting):
            ahead, behind = (np.hypot(*(waiting[k][end] - line[-1 - end])[:2]) < JOINT for end in (0, -1))
            if ahead or behind:
                piece = waiting.pop(k)
                line, k = np.concatenate([line, piece[1:]] if ahead else [piece, line[1:]]), 0
            else:
                k += 1
        yield line


def _fitted(name, places, tolerance):
    places = without_repeats(places, NEAREST_PLACES)
    origin = np.floor(places[0, :2])
    plan = fit_reference(places[:, :2] - origin, tolerance) if len(places) > 1 else None
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(places[:, :2], axis=0).T)))
    missed = 0.0
    if plan is not None:
        along = along * plan.length / along[-1]
        foot, heading, _ = plan.at(along)
        offsets = places[:, :2] - origin - foot
        missed = float(np.abs(offsets[:, 1] * np.cos(heading) - offsets[:, 0] * np.sin(heading)).max())
        plan = _moved(plan, origin)
    return Alignment(name, "Driving line", plan, places, _tangents(along, places[:, 2], tolerance), missed)


def _moved(plan, origin):
    return PlanView(tuple(replace(element, x=element.x + origin[0], y=element.y + origin[1]) for element in plan.elements))


def _tangents(s, z, tolerance):
    """(M, 2) the fewest of the heights whose polygon misses none by more than the tolerance."""
    line = shapely.simplify(shapely.linestrings(np.c_[s, z]), tolerance)
    return shapely.get_coordinates(line)


def elements_without_reversal(plan: PlanView) -> list[PlanElement]:
    """The elements, with spirals that turn from left to right cut where they are straight: formats of design know none such."""
    result = []
    for element in plan.elements:
        if element.kind != "spiral" or element.values[0] * element.values[1] >= 0:
            result.append(element)
            continue
        first, last = element.values
        cut = element.length * first / (first - last)
        place, heading, _ = element.at(np.array([cut]))
        result.append(replace(element, length=cut, values=(first, 0.0)))
        start = element.s + cut, float(place[0, 0]), float(place[0, 1]), float(heading[0])
        result.append(PlanElement(*start, element.length - cut, "spiral", (0.0, last)))
    return result
