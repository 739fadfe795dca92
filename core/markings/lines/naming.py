"""Lines named by the estimate of their road, and markings after the lines that they make: a dash alone does not show what it separates."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import shapely

from ...common.progress import Progress
from ..cross_section.estimate import boundary_uses
from ..cross_section.roads import estimate_roads
from ..cross_section.sections import sections_of_edges, sections_of_lines, sections_of_pavement
from ..cross_section.sequence import separated_kinds
from ..cross_section.weights import CENTRE_LINE, EDGE_LINE, LANE_LINE, EstimateWeights
from ..objects.classify import LINE_KINDS
from ..objects.marking_objects import MarkingObjects
from .linking import with_paint_between_tracks
from .painted_lines import PaintedLines

if TYPE_CHECKING:
    from ...road.edges.road_edges import RoadEdges
    from ...survey.frame.road_frame import RoadFrame
    from ...survey.store.road_points import RoadPoints
    from ..cross_section.weights import TakenReading

KINDS = {EDGE_LINE: "edge", LANE_LINE: "lane", CENTRE_LINE: "centre"}
CONFIRMED = "accepted"        # status of a line that an analyst looked at
MAX_DISTANCE_TO_LINE = 0.15   # m between a marking and the line along it


def named_by_estimate(lines: PaintedLines, frame: RoadFrame, usual_width: float, markings: MarkingObjects | None = None,
                      edges: RoadEdges | None = None, road_points: RoadPoints | None = None, paint: RoadPoints | None = None,
                      progress: Progress = Progress(), taken: Sequence[TakenReading] = ()) -> PaintedLines:
    """Lines with the `kind` that the estimate of their road gives them; one that bounds no lane is called by how it is drawn.

    Parameters
    ----------
    lines : PaintedLines
    frame : RoadFrame
    usual_width : metres, of lanes where the lines do not tell
    markings, edges, road_points : what else the estimate is made from, or None
    paint : points of markings, which serve where there are no road points, or None
    progress : Progress
    taken : second readings that an analyst took

    Returns
    -------
    PaintedLines, the same with the new names
    """
    if not len(lines):
        return lines
    curbs, pavement = (sections_of_edges(edges), sections_of_pavement(edges)) if edges is not None else (None, None)
    estimates = estimate_roads(sections_of_lines(lines), frame, usual_width, curbs=curbs, markings=markings, road_points=road_points,
                                      paint=paint, pavement=pavement, progress=progress, taken=taken)
    found, second = _line_kinds(estimates), _second_kinds(estimates)
    drawn = np.where([pattern.startswith("double") for pattern in lines.pattern], "centre",
                     np.where(lines.pattern == "dashed", "lane", "edge")).astype(object)
    kind = np.array([found.get(number, own) for number, own in zip(lines.line.tolist(), drawn)], object)
    # what an analyst confirmed keeps its name
    confirmed = lines.status == CONFIRMED
    kind[confirmed] = lines.kind[confirmed]
    other = np.array(["" if done else second.get(number, "") for number, done in zip(lines.line.tolist(), confirmed.tolist())], object)
    return replace(lines, kind=kind, other=other)


def named_by_lines(markings: MarkingObjects, lines: PaintedLines) -> MarkingObjects:
    """Markings of lines (`keep`) with the `kind` of the marking line that runs along them, and paint between tracks of the scan.

    Parameters
    ----------
    markings : MarkingObjects
    lines : PaintedLines fitted to them

    Returns
    -------
    MarkingObjects, the same with the new names, and what `with_paint_between_tracks` adds
    """
    rows = np.flatnonzero(markings.keep & np.isin(markings.kind.astype(str), LINE_KINDS))
    if not len(rows) or not len(lines):
        return markings
    places = shapely.point_on_surface(markings.outlines.polygons()[rows])
    found, line = shapely.STRtree(lines.course.linestrings()).query_nearest(places, max_distance=MAX_DISTANCE_TO_LINE, all_matches=False)
    same_road = markings.road[rows[found]] == lines.course.road[line]
    kind = markings.kind.copy()
    kind[rows[found][same_road]] = lines.kind[line[same_road]]
    return with_paint_between_tracks(markings.with_kinds(kind), lines)


def _line_kinds(estimates):
    """{number of a marking line: edge, lane or centre}, by what most of it separates; lines that bound no lane are not in it."""
    votes: dict[int, np.ndarray] = {}
    for road in estimates.roads.values():
        c, uses = road.estimate.candidates, boundary_uses(road.estimate)
        for i, m in zip(*np.nonzero((uses >= 0) & np.isin(uses, list(KINDS)))):
            for row in set(c.rows[i, m].tolist()) - {-1}:
                if not road.boundaries.painted[row]:
                    continue
                numbers = road.lines.number[row, c.first[i]:c.last[i] + 1]
                for number, count in zip(*np.unique(numbers[numbers >= 0], return_counts=True)):
                    votes.setdefault(int(number), np.zeros(len(KINDS)))[uses[i, m]] += count
    return {number: KINDS[int(np.argmax(found))] for number, found in votes.items()}


def _second_kinds(estimates):
    """{number of a marking line: its second kind as JSON}, of lines that are almost as probable to separate something else along most of them."""
    behind: dict[int, list[tuple[float, np.ndarray]]] = {}
    for road in estimates.roads.values():
        c, estimate = road.estimate.candidates, road.estimate
        uses, kinds = boundary_uses(estimate), separated_kinds(estimate.sections)
        nats = np.stack([np.where(kinds == use, estimate.second[:, :, None], np.inf).min(axis=1) for use in KINDS])
        for i, m in zip(*np.nonzero(np.isin(uses, list(KINDS)) & c.painted)):
            own = list(KINDS).index(uses[i, m])
            others = np.where(np.arange(len(KINDS)) == own, np.inf, nats[:, i, m] - nats[own, i, m])
            for row in set(c.rows[i, m].tolist()) - {-1}:
                numbers = road.lines.number[row, c.first[i]:c.last[i] + 1]
                for number, count in zip(*np.unique(numbers[numbers >= 0], return_counts=True)):
                    behind.setdefault(int(number), []).append((float(count), others))
    found, doubt = {}, EstimateWeights().doubt
    for number, parts in behind.items():
        count, others = (np.array(values) for values in zip(*parts))
        share = (count[:, None] * (others < doubt)).sum(axis=0) / count.sum()
        second = int(np.argmax(share))
        if share[second] > 0.5:
            near = others[:, second][others[:, second] < doubt]
            found[number] = json.dumps({"nats": round(max(float(np.median(near)), 0.0), 2), "kind": list(KINDS.values())[second]})
    return found
