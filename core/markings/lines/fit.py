"""Marking lines: the painted lines of a road as curves, dashes linked, gaps told."""

import json
from dataclasses import dataclass
from functools import partial

import numpy as np
import shapely
from shapely.geometry import LineString

from ...common.errors import RoadExtractionError
from ...common.features import Features
from ...common.progress import Progress
from ...common.schemas import MARKING_LINES
from ...common.setting import check_limits, setting
from ...curves.model_selection import CURVES
from ...survey.store.records import join_columns
from ..lines import labelling as line_choice
from ..objects.classify import LINES
from .dash_pattern import same_rhythm
from .geometry import shapes_of
from .linking import Drift, Line, link, link_far, without_strays
from .strands import line_paint, trace

# Markings called what the line is that they make: a dash alone does not know whether it parts lanes or directions.

ON_LINE = 0.15   # m between a marking and the line along it


def named_by_lines(markings, lines, frame):
    """Markings of lines (use keep) with the `kind` of the marking line that runs along them.

    Parameters
    ----------
    markings : MarkingObjects
    lines : Features MARKING_LINES fitted to them
    frame : RoadFrame

    Returns
    -------
    MarkingObjects, the same with the new names
    """
    rows = np.flatnonzero(markings.keep & np.isin(markings.kind.astype(str), LINES))
    if not len(rows) or not len(lines):
        return markings
    places = shapely.point_on_surface(markings.outlines.polygons(frame.origin)[rows])
    tree = shapely.STRtree(np.array(lines.geometries, object))
    of, line = tree.query_nearest(places, max_distance=ON_LINE, all_matches=False)
    kind = markings.kind.copy()
    for k, j in zip(rows[of].tolist(), line.tolist()):
        if markings.road[k] == lines.rows[j]["road"]:
            kind[k] = lines.rows[j]["kind"]
    return markings.with_kinds(kind)

@dataclass(frozen=True)
class LineSettings:
    """How marking lines are linked and which curve is fitted.

    curve : one of core.curves.model_selection.CURVES; degree : of the polynomial
    max_gap : m along the road over which paint of one line is linked
    max_bridge : m over which it is linked where the line's own rhythm or a neighbouring line carries over
    min_paint : m of paint without which there is no line (unless it fits another one's dashes)
    """

    curve: str = "automatic"
    degree: int = setting(2, 0, 9, "The polynomial's degree")
    max_gap: float = setting(13.0, 0.1, 100.0, "The longest gap that is linked", "m")
    max_bridge: float = setting(30.0, 0.1, 200.0, "The longest gap that is bridged", "m")
    min_paint: float = setting(4.0, 0.0, 100.0, "The least paint of a line", "m")

    def __post_init__(self):
        check_limits(self)
        if self.curve not in CURVES:
            raise RoadExtractionError(f"There is no curve called {self.curve!r}. Choose one of {', '.join(CURVES)}.")
        if self.max_gap > self.max_bridge:
            raise RoadExtractionError(
                f"Gaps are linked up to {self.max_gap} m and bridged up to {self.max_bridge} m; the second must not "
                "be below the first.")


def fit_marking_lines(clustered_points, markings, frame, settings=LineSettings(), progress=Progress()):
    """Trace, link and fit the painted lines of all roads.

    Parameters
    ----------
    clustered_points : RoadPoints with `cluster`
    markings : MarkingObjects of the same clusters
    frame : RoadFrame

    Returns
    -------
    Features MARKING_LINES: a line that is partly bridged, or changes between dashed and
    solid, comes in touching pieces with one `line` number. Every piece is drawn on the
    line's one curve, whose numbers (map coordinates, and the arc lengths `from` and
    `to` of the piece) are in `params`. `rmse_m` is NULL on bridged pieces.

    Raises
    ------
    RoadExtractionError
        If the points were not clustered.
    """
    if not clustered_points.has_cluster:
        raise RoadExtractionError(
            "The points have no field “cluster”. Give the file that “Cluster markings” wrote, together with its layer.")
    found = Features("LineStringZ", MARKING_LINES, crs=clustered_points.crs)
    number, replaced, dropped = 0, 0, 0
    roads = clustered_points.roads()
    for k, road in enumerate(roads):
        part = progress.part(k / len(roads), (k + 1) / len(roads))
        records, rank = line_paint(_records_of(clustered_points, road), markings, road)
        part.at(0.1)
        strands = trace(records, rank)
        part.at(0.4)
        hatched = line_choice.bars(markings, road)
        lines, drift = _linked(strands, settings)
        # a line that leads up to a hatched area may be taken for its border: linked anew without that, it goes on behind the area
        while borders := line_choice.hatching_borders(lines, hatched):
            strands = [strand for strand in strands if not any(strand is border for border in borders)]
            lines, drift = _linked(strands, settings)
        part.at(0.5)
        chosen = line_choice.choose(lines, drift, line_choice.crossings(markings, road), settings.min_paint,
                                    hatched, frame.passes_of(road))
        dropped += len(lines) - len(chosen)
        shapes, unwanted = shapes_of([one.line for one in chosen], [one.span for one in chosen], frame.road(road), drift,
                                     partial(frame.track_height, road), settings)
        part.at(0.8)
        replaced += unwanted
        for j, (one, shape) in enumerate(zip(chosen, shapes)):
            number += 1
            _add(found, one, shape, number, road, frame.origin)
            part.at(0.8 + 0.2 * (j + 1) / len(chosen))
    progress.say(f"Marking lines: {number}; {dropped} fragments were left out.")
    if replaced:
        progress.warn(f"{replaced} of {number} lines cannot take the curve “{settings.curve}”; "
                      "the automatic curve was used for them.")
    return found


def _linked(strands, settings):
    """Lines of strands, and the Drift they have in common."""
    drift = Drift(strands)
    lines = link([Line([strand]) for strand in strands], drift, settings.max_gap)
    lines = link_far(lines, drift, settings.max_gap, settings.max_bridge, same_rhythm)
    return [without_strays(line, drift) for line in lines], drift


def _records_of(points, road):
    parts = [points.store.section(road, section) for section in points.sections(road)]
    return join_columns(parts, points.store.dtype)


def _add(found, one, shape, number, road, origin):
    curve = shape.fit.curve.moved(*origin[:2])
    numbers = json.dumps(_rounded(curve.params()))[:-1]  # once for all pieces: those of long splines are long
    s, d, *_ = one.line.places()
    for piece in one.pieces:
        places = shape.draw(piece.first, piece.last) + origin
        geometry = LineString(places)
        if not geometry.length > 0:
            continue
        inside = (shape.s >= piece.first) & (shape.s <= piece.last)
        residuals = shape.fit.residuals[inside]
        measured = piece.status == "measured" and len(residuals)
        start, end = shape.u(np.array([piece.first, piece.last]))
        near = (s >= piece.first - 2.0) & (s <= piece.last + 2.0)
        found.add(
            geometry, road=int(road), line=number, kind=one.kind,
            pattern=f"double-{piece.pattern}" if one.double else piece.pattern, status=piece.status,
            curve=curve.kind, radius_m=float(curve.radius) if curve.kind == "circle" else None,
            rmse_m=float(np.sqrt(np.mean(residuals**2))) if measured else None,
            station_m=float(piece.first), end_m=float(piece.last),
            offset_m=float(np.median(d[near])) if near.any() else None,
            length_m=float(geometry.length), width_m=float(one.width),
            params=f'{numbers}, {json.dumps({"from": round(float(start), 4), "to": round(float(end), 4)})[1:]}')


def _rounded(numbers):
    """Long lists to 0.1 mm: a spline of a long road stays readable."""
    long = ("knots", "control_x", "control_y")
    return {key: [round(v, 4) for v in value] if key in long else value for key, value in numbers.items()}
