"""Vector layers in memory: geometries in map coordinates with their fields.

A layer read from a file and a result passed on in memory have the same type, so every stage takes either.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from math import isfinite
from typing import Any


@dataclass(frozen=True)
class Field:
    """A column of a layer."""

    name: str   # at most 10 characters
    type: type   # int, float or str
    alias: str = ""   # the name spelled out, with its unit
    needed: bool = True   # False where a layer that is read may lack it, such as one that an earlier version wrote; its values are None then
    on_map: bool = False   # True for a map coordinate, which is written in the units of the layer's CRS

    def value(self, value: Any) -> Any:
        """A value as a row holds it: a Python number or text of the field's type, None (NULL) for a number that is NaN or infinite."""
        return None if value is None or self.type is not str and not isfinite(value) else self.type(value)


@dataclass
class Features:
    """A vector layer in memory."""

    geometry_type: str   # "PointZ", "LineStringZ", "PolygonZ" or "None" (a table)
    schema: list[Field]
    geometries: list[Any] = field(default_factory=list)   # shapely geometries with Z in map coordinates (None in a table)
    rows: list[dict[str, Any]] = field(default_factory=list)   # field name to value; a missing name is NULL
    crs: str = ""   # WKT, "" where unknown
    description: str = ""   # what made the layer, which a GeoPackage keeps

    def add(self, geometry: Any, **row: Any) -> None:
        """Append a feature with its field values, numpy's or Python's, see `Field.value`."""
        self.geometries.append(geometry)
        self.rows.append({name: self._fields[name].value(value) if name in self._fields else value for name, value in row.items()})

    @cached_property
    def _fields(self) -> dict[str, Field]:
        return {attribute.name: attribute for attribute in self.schema}

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[tuple[Any, dict[str, Any]]]:
        return iter(zip(self.geometries, self.rows))

    def column(self, name: str, default: Any = None) -> list[Any]:
        """The values of one field in row order, `default` where NULL."""
        return [default if row.get(name) is None else row[name] for row in self.rows]


# The fields of all layers: names of at most 10 characters, spelled out in the alias.

ROAD = Field("road", int, "Road")
PASS = Field("pass", int, "Pass")
NEAREST_PASS = Field("pass", int, "Pass that drove nearest")
SIDE = Field("side", str, "Side (left/right)")
STATUS = Field("status", str, "Status")
CONFIDENCE = Field("confidence", float, "Confidence (0 to 1)", needed=False)
# JSON: {"nats": by how much it is less probable, "lanes": [{"offset_m", "width_m", "direction"}, ...]}, of a marking line {"nats", "kind"}
OTHER = Field("other", str, "Second reading that is almost as probable (JSON)", needed=False)
STATION = Field("station_m", float, "Station (m)")
OFFSET = Field("offset_m", float, "Offset, left positive (m)")
HEIGHT = Field("height_m", float, "Height (m)")
PART = Field("part", str, "Part (bottom/top)")
AGREE = Field("agree_cm", float, "Agreement of the two methods (cm)")
LENGTH = Field("length_m", float, "Length (m)")
WIDTH = Field("width_m", float, "Width (m)")
RADIUS = Field("radius_m", float, "Radius (m)")
# main: along the road; corner, side_street: leads away from it; island: stands in it
CURB_KIND = Field("kind", str, "Kind (main/corner/side_street/island)")
RMSE = Field("rmse_m", float, "RMSE of the fit (m)")
SIGMA = Field("sigma_m", float, "Uncertainty across, one sigma (m)", needed=False)
PASS_SIGMA = Field("pass_sig_m", float, "Part of the uncertainty across that all lines of the road share, from trajectory and passes (m)",
                   needed=False)

# curb: a step; dropped: a low one where one drives over; pavement: where asphalt ends without a curb
EDGE = Field("edge", str, "Edge (curb/dropped/pavement)", needed=False)

# station_m of a line is where it starts, end_m where it ends, along the road
END = Field("end_m", float, "End station (m)")

CURB_POINTS = [ROAD, NEAREST_PASS, SIDE, STATUS, STATION, OFFSET, HEIGHT, PART,
               CURB_KIND, Field("chain", int, "Chain along the curb"), Field("along_m", float, "Distance along the chain (m)"),
               Field("residual_m", float, "Residual (m)"), SIGMA,
               Field("support", int, "Supporting points"), PASS_SIGMA]
ROAD_EDGES = [ROAD, NEAREST_PASS, SIDE, STATUS, STATION, END, HEIGHT, PART, AGREE, LENGTH, RMSE, SIGMA,
              CURB_KIND, EDGE, Field("chain", int, "Chain along the curb")]
SCANLINES = [ROAD, PASS, Field("scanner", int, "Scanner"), STATION, LENGTH, Field("interval_m", float, "Interval of the planes (m)"),
             PASS_SIGMA]
ROAD_SURFACE = [ROAD, STATUS, STATION, END, Field("area_m2", float, "Area (m²)"), Field("points", int, "Road points")]
MARKINGS = [ROAD, Field("cluster", int, "Cluster"), Field("class", str, "Class"), Field("use", str, "Use (keep/other)"),
            STATION, OFFSET, LENGTH, WIDTH, Field("elongation", float, "Elongation"),
            Field("scan_m", float, "Scanning distance (m)"), Field("area_m2", float, "Area (m²)"),
            Field("points", int, "Points")]
MARKING_LINES = [ROAD, Field("line", int, "Line"), Field("kind", str, "Kind (edge/lane/centre)"),
                 Field("pattern", str, "Pattern"), STATUS, OTHER, Field("curve", str, "Curve"), RADIUS, RMSE,
                 STATION, END, OFFSET, LENGTH, WIDTH, PASS_SIGMA, Field("params", str, "Fitted function (JSON)")]
DRIVING_LINES = [ROAD, Field("lane", int, "Lane"), Field("kind", str, "Kind"), Field("pattern", str, "Lines to its left|right"),
                 Field("direction", int, "Direction (1 along, -1 against the road)"),
                 Field("source", str, "Source (pair/offset)"), STATUS, CONFIDENCE, OTHER, Field("curve", str, "Curve"), RADIUS, RMSE, SIGMA,
                 STATION, END, OFFSET, LENGTH, WIDTH, Field("design_kmh", int, "Highest design speed that its curve allows (km/h)", needed=False),
                 Field("params", str, "Fitted function (JSON)")]
# left and right as seen in the direction of travel; along the road where nobody drives
LANES = [ROAD, Field("lane", int, "Lane"), Field("lane_id", str, "Lane and piece (road.lane.piece)"),
         Field("type", str, "Type (driving/shoulder/parking/bicycle/hatched/median/connector)"),
         Field("direction", int, "Direction (1 along, -1 against the road, 0 not driven)"),
         Field("left_line", str, "What its left border is (line N of the marking lines, edge N: chain of the road edges)"),
         Field("right_line", str, "What its right border is (line N of the marking lines, edge N: chain of the road edges)"),
         Field("left_kind", str, "Kind of its left border"), Field("right_kind", str, "Kind of its right border"),
         Field("left_patt", str, "Pattern of its left border"), Field("right_patt", str, "Pattern of its right border"),
         Field("successors", str, "Lanes that follow, by lane_id"), STATUS, CONFIDENCE, OTHER,
         STATION, END, WIDTH, LENGTH]
# of markings and marking lines, beside their other fields
COLOUR = Field("colour", str, "Colour of the paint (white/yellow)", needed=False)
CURVE_ELEMENTS = [ROAD, Field("lane", int, "Lane"), STATION, END, Field("turn", str, "Turn (left/right)"),
                  Field("radius_m", float, "R (m)"), Field("radius_ft", float, "R (ft)"),
                  Field("delta_deg", float, "Δ (°)"), Field("degree_ft", float, "D (° per 100 ft)"),
                  Field("degree_m", float, "D (° per 100 m)"),
                  Field("length_m", float, "L (m)"), Field("length_ft", float, "L (ft)"),
                  Field("tangent_m", float, "T (m)"), Field("tangent_ft", float, "T (ft)"),
                  Field("middle_m", float, "M (m)"), Field("middle_ft", float, "M (ft)"),
                  Field("chord_m", float, "LC (m)"), Field("chord_ft", float, "LC (ft)"),
                  Field("ext_m", float, "E (m)"), Field("ext_ft", float, "E (ft)"),
                  *(Field(f"{point}_{axis}", float, f"{point.upper()} {axis}", on_map=True) for point in ("pc", "pt", "pi") for axis in "xy"),
                  Field("rmse_m", float, "RMSE of the arc (m)"),
                  Field("speed_kmh", int, "Highest design speed allowed (km/h)"), Field("code", str, "Design code check")]
CORRECTIONS = [Field("action", str, "Action (accept/delete/move/draw/take/seen)"),
               Field("target", str, "What is meant (edge/marking/lane)"), ROAD,
               STATION, OFFSET, Field("note", str, "Note"), Field("kind", str, "Kind of a line that is drawn (edge/lane/centre)"),
               Field("pattern", str, "Pattern of a line that is drawn (solid/dashed)"),
               Field("height_m", float, "Height of a curb that is drawn (m)"),
               Field("other", str, "Second reading that is taken (JSON)"), Field("author", str, "Decided by"),
               Field("decided_at", str, "Decided at (UTC)")]
MAP_FINDINGS = [Field("fault", str, "Fault"), Field("element", str, "Road, lane, way or relation"), Field("text", str, "What was seen"),
                Field("row", int, "Row of the report"), Field("places", int, "Places with the same finding")]
CROSS_SECTIONS = [ROAD, Field("section", int, "Section"), STATION, Field("part", str, "Part (carriageway/lane)"), Field("lane", int, "Lane"),
                  Field("type", str, "Type of the lane"), Field("direction", int, "Direction (1 along, -1 against the road, 0 not known)"),
                  Field("offset_m", float, "Offset of its middle, left positive (m)"), WIDTH,
                  Field("borders", str, "Borders taken from (lanes/lines/edges/track)"),
                  Field("crossf_pct", float, "Crossfall, positive falls to the right along the road (%)"),
                  Field("crossf_sig", float, "Sigma of the crossfall, roll included (%)"),
                  Field("grade_pct", float, "Grade, positive climbs along the road (%)"),
                  Field("rut_l_mm", float, "Rut depth, left wheel path (mm)"), Field("rut_r_mm", float, "Rut depth, right wheel path (mm)"),
                  Field("curb_l_m", float, "Height of the left curb (m)"), Field("curb_r_m", float, "Height of the right curb (m)"),
                  Field("clear_m", float, "Clearance above (m)"), Field("seen_pct", float, "Surface seen (%)"),
                  Field("exceeds", str, "Limits not kept"), Field("why", str, "Value, limit and rule of each")]
BREAKLINES = [ROAD, Field("kind", str, "Kind (crown/lane_border/edge_bottom/edge_top/gutter_flow_line)"), STATION, END, LENGTH,
              Field("height_m", float, "Height of the top of an edge above its bottom (m)"),
              Field("sigma_z_m", float, "Uncertainty of the height, one sigma (m)")]
SURFACE_FACES = [STATUS, Field("slope_pct", float, "Slope (%)"), Field("area_m2", float, "Area (m²)")]
EDGE_DISTANCE = Field("edge_m", float, "Distance from the carriageway's edge (m)")
ROADSIDE = [ROAD, SIDE, Field("line", int, "Line"), Field("kind", str, "Kind (guard_rail/barrier/wall/fence/hedge/gutter)"), STATUS, STATION, END,
            OFFSET, EDGE_DISTANCE,
            Field("height_m", float, "Height of its top above the ground, of a gutter its depth (m)"),
            Field("foot_m", float, "Height of its lower edge above the ground (m)"), LENGTH]
ROADSIDE_OBJECTS = [ROAD, SIDE, Field("kind", str, "Kind (pole/sign/trunk)"), STATION, OFFSET, EDGE_DISTANCE,
                    Field("height_m", float, "Height of its top above the ground (m)"), Field("diam_m", float, "Diameter of its shaft (m)")]
# of the roads of other maps and of OpenStreetMap, which lanes may carry beside the fields of a survey
ROAD_ATTRIBUTES = [Field("speed_kmh", float, "Speed limit (km/h)", needed=False), Field("name", str, "Name of the road", needed=False),
                   Field("ref", str, "Number of the road", needed=False), Field("surface", str, "Surface", needed=False),
                   Field("lanes", int, "Lanes of the road", needed=False), Field("oneway", str, "One-way road (yes/no)", needed=False),
                   Field("yields_to", str, "Lanes that go first, by lane_id", needed=False)]
# the point of a signal is the middle of its lower edge, that of a pole its foot
SIGNALS = [Field("kind", str, "Kind (traffic_light/sign/pole)"),
           Field("country", str, "Country of its code, two letters", needed=False),
           Field("code", str, "Code of the country's catalogue", needed=False), Field("subcode", str, "Second part of the code", needed=False),
           Field("value", float, "Value", needed=False), Field("unit", str, "Unit of the value", needed=False),
           Field("text", str, "Name or text", needed=False), Field("lanes", str, "Lanes it holds for, by lane_id", needed=False),
           Field("heading", float, "Travel of the traffic it is for (°, clockwise from grid north)", needed=False),
           Field("height_m", float, "Height from its lower edge to its top (m)", needed=False), Field("width_m", float, "Width (m)", needed=False)]
RESIDUALS = [Field("point", str, "Point"), Field("role", str, "Role (control/check/disabled)"),
             Field("pixel", float, "Pixel"), Field("line", float, "Line, downwards"),
             Field("dx_m", float, "Residual east (m)"), Field("dy_m", float, "Residual north (m)"),
             Field("resid_m", float, "Residual (m)"), Field("loo_m", float, "Residual without this point (m)"),
             Field("leverage", float, "Leverage (0 to 1)")]
CONTROL_POINTS = [Field("point", str, "Point"), Field("role", str, "Role (control/check)"),
                  Field("pixel", float, "Pixel"), Field("line", float, "Line, downwards"),
                  Field("kind", str, "What was pointed at")]
PROPOSED_POINTS = [Field("point", str, "Point"), Field("accepted", int, "Accepted (1/0)"),
                   Field("score", float, "Likeness of the two cut-outs (0 to 1)"),
                   Field("residual", float, "Distance from where the other pairs place it (m)"), Field("why", str, "Why it is not accepted"),
                   Field("pixel", float, "Pixel"), Field("line", float, "Line, downwards"), Field("role", str, "Role (control/check)")]
TRAJECTORY = [Field("time", float, "Time (s)"), Field("roll", float, "Roll (°)"), Field("pitch", float, "Pitch (°)"),
              Field("heading", float, "Heading (°, clockwise from grid north)"), PASS, ROAD, STATION]
ESTIMATED_TRAJECTORY = [*TRAJECTORY, Field("sigma_m", float, "Uncertainty of the place, one sigma (m)"),
                        Field("sigma_z_m", float, "Uncertainty of the height, one sigma (m)")]
PASSES = [PASS, ROAD, Field("direction", int, "Direction (1 along, -1 against the road)"), STATION, END, LENGTH,
          Field("begin_s", float, "Begins (s, clock of the point clouds)"), Field("finish_s", float, "Ends (s, clock of the point clouds)")]
OUTCOME = Field("outcome", str, "Outcome (correct/missed/false/excluded)")
WHY = Field("why", str, "Why")
ASSESSED_BOUNDARIES = [OUTCOME, WHY, Field("road", int, "Road, or line of the reference"), SIDE, STATION, END,
                       Field("covered_m", float, "Covered by the result (m)"), Field("lateral_m", float, "Mean lateral error (m)"),
                       Field("max_m", float, "Largest lateral error (m)"), Field("height_m", float, "Mean height error (m)"), LENGTH]
ASSESSED_DRIVING_LINES = [OUTCOME, WHY, Field("line", int, "Row of the line in its layer"), Field("station_m", float, "From, along the line (m)"),
                          Field("end_m", float, "To, along the line (m)"), LENGTH, Field("lateral_m", float, "Mean distance (m)"),
                          Field("max_m", float, "Largest distance (m)")]
ASSESSED_MARKINGS = [OUTCOME, WHY, Field("source", str, "Of (reference/result)"), Field("class", str, "Class"),
                     Field("share_pct", float, "Share of it in the other layer (%)"), Field("area_m2", float, "Judged area (m²)")]
