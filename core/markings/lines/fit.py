"""Marking lines: the painted lines of a road traced, linked over gaps and fitted with curves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...common.errors import RoadExtractionError
from ...common.progress import Progress
from ...countries.catalogue import country
from ...survey.store.road_points import columns_of_roads
from ..objects.marking_objects import MarkingObjects
from .edges_beside import edges_beside
from .few_tracks import painted_strands
from .geometry import LineShape, MarkingLineSettings, fit_line_shapes
from .linking import CommonTrend, link_lines, link_over_long_gaps, with_unseen_paint, without_strays
from .naming import named_by_estimate
from .painted_lines import PaintedLines, painted_lines_of
from .selection import SelectedLine, crossings, hatching_bars, hatching_borders, same_dash_pattern, select_lines
from .strands import LinkedLine, line_paint

if TYPE_CHECKING:
    from ...road.edges.road_edges import RoadEdges
    from ...survey.frame.road_frame import RoadFrame
    from ...survey.store.road_points import RoadPoints
    from ..cross_section.weights import TakenReading
    from .strands import Strand

LINES_SHARE = 0.65         # of the work; the rest is the estimate that names the lines
PAINT_BESIDE_PIECE = 2.0   # m of station before and after a piece whose paint counts for its offset


def fit_marking_lines(clustered_points: RoadPoints, markings: MarkingObjects, frame: RoadFrame,
                      settings: MarkingLineSettings = MarkingLineSettings(), progress: Progress = Progress(), edges: RoadEdges | None = None,
                      road_points: RoadPoints | None = None, taken: Sequence[TakenReading] = ()) -> PaintedLines:
    """Trace, link and fit the painted lines of all roads.

    Parameters
    ----------
    clustered_points : RoadPoints with `cluster`
    markings : MarkingObjects of the same clusters
    frame : RoadFrame
    settings : MarkingLineSettings
    progress : Progress
    edges, road_points : RoadEdges and RoadPoints, or None: what the lines separate is told better with them
    taken : second readings that an analyst took

    Returns
    -------
    PaintedLines with `fitted`: a line that is partly bridged, or changes between dashed and
    solid, comes in touching pieces with one `line` number. Every piece is drawn on the
    line's one curve.

    Raises
    ------
    RoadExtractionError
        If the points were not clustered.
    """
    if not clustered_points.has_cluster:
        raise RoadExtractionError(
            "The points have no field “cluster”. Give the file that “Cluster markings” wrote, together with its layer.")
    rows: list[dict[str, Any]] = []
    number, replaced, dropped = 0, 0, 0
    roads = clustered_points.roads()
    beside = edges_beside(edges, roads)
    for k, road in enumerate(roads):
        part = progress.part(LINES_SHARE * k / len(roads), LINES_SHARE * (k + 1) / len(roads))
        records, rank = line_paint(columns_of_roads(clustered_points.store, [road]), markings, road)
        part.report(0.1)
        strands = painted_strands(records, rank)
        part.report(0.2)
        hatched = hatching_bars(markings, road)
        lines, trend = _linked(strands, beside[road], settings)
        # a line that leads up to a hatched area may be taken for its border: linked anew without that, it goes on behind the area
        framing: list[Strand] = []
        while borders := hatching_borders(lines, hatched, framing):
            framing += borders
            known = set(map(id, borders))
            strands = [strand for strand in strands if id(strand) not in known]
            lines, trend = _linked(strands, beside[road], settings)
        part.report(0.4)
        selected = select_lines(lines, trend, crossings(markings, road), settings.min_paint, hatched, country(settings.country).longest_dash)
        dropped += len(lines) - len(selected)
        shapes, unwanted = fit_line_shapes([one.line for one in selected], [one.span for one in selected], frame.road(road), trend, beside[road],
                                     partial(frame.track_height, road), settings, part.part(0.45, 0.9))
        replaced += unwanted
        for j, (one, shape) in enumerate(zip(selected, shapes)):
            number += 1
            rows += [dict(row, line=number, road=int(road)) for row in _drawn_pieces(one, shape, frame.origin)]
            part.report(0.9 + 0.1 * (j + 1) / len(selected))
    progress.info(f"Marking lines: {number}; {dropped} fragments were left out.")
    if replaced:
        progress.warn(f"{replaced} of {number} lines cannot take the curve “{settings.curve}”; "
                      "the automatic curve was used for them.")
    drawn = painted_lines_of(rows, frame, clustered_points.crs)
    if road_points is not None:
        drawn = with_unseen_paint(drawn, markings, clustered_points, road_points)
    return named_by_estimate(drawn, frame, country(settings.country).usual_lane, markings, edges, road_points, clustered_points,
                             progress.part(LINES_SHARE, 1.0), taken)


def _linked(strands, edges, settings):
    """Lines of strands, and the CommonTrend they have in common."""
    trend = CommonTrend(strands)
    lines = link_lines([LinkedLine([strand]) for strand in strands], trend, edges, settings.max_gap)
    lines = link_over_long_gaps(lines, trend, edges, settings.max_gap, settings.max_bridge,
                                 partial(same_dash_pattern, longest_dash=country(settings.country).longest_dash))
    return [without_strays(line, trend, edges) for line in lines], trend


def _drawn_pieces(one: SelectedLine, shape: LineShape, origin: np.ndarray) -> Iterator[dict[str, Any]]:
    """The pieces of one line that have a length on the map."""
    for piece in one.pieces:
        places = shape.draw(piece.first, piece.last)
        if not np.ptp(places[:, :2] + origin[:2], axis=0).any():
            continue
        residuals = shape.fit.residuals[slice(np.searchsorted(shape.s, piece.first), np.searchsorted(shape.s, piece.last, side="right"))]
        measured = piece.status == "measured" and len(residuals)
        _, near = one.line.near(piece.first - PAINT_BESIDE_PIECE, piece.last + PAINT_BESIDE_PIECE)
        yield dict(
            kind="", pattern=f"double-{piece.pattern}" if one.double else piece.pattern, status=piece.status,
            curve=shape.fit.curve, arc=shape.u(np.array([piece.first, piece.last])), places=places,
            station=piece.first, end=piece.last, offset=np.median(near) if len(near) else np.nan, width=one.width(piece),
            rmse=np.sqrt(np.mean(residuals**2)) if measured else np.nan)

