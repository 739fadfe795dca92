"""The results of an assessment as layers with the outcome of every object."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely

from ...core.common.features import ASSESSED_BOUNDARIES, ASSESSED_DRIVING_LINES, ASSESSED_MARKINGS, Features
from ...core.common.progress import Progress
from .boundaries import SIDE_NAMES, BoundaryAccuracy, interval_lines
from .driving_lines import MAX_MATCH_DISTANCE, LineAccuracySettings, LineMatch
from .markings import MarkingAccuracy

ROWS_PER_REPORT = 100  # rows between two reports of progress


def boundary_layer(accuracy: BoundaryAccuracy, crs: str, progress: Progress = Progress()) -> Features:
    """Features with one row per interval and outcome, as many as the report's table counts. `crs`: WKT."""
    settings, table = accuracy.settings, accuracy.intervals
    layer = Features("MultiLineStringZ", ASSESSED_BOUNDARIES, crs=crs)
    step, k = settings.interval, settings.tolerances.index(settings.tolerance)
    for number, (outcome, row, geometry) in enumerate(interval_lines(accuracy, settings.tolerance)):
        if number % ROWS_PER_REPORT == 0:
            progress.report(row / len(table.unit))
        measured = outcome in ("correct", "false") and table.judged[row]
        errors = dict(lateral_m=table.lateral[row], max_m=table.largest[row], height_m=table.height[row]) if measured else {}
        layer.add(
            geometry, outcome=outcome, why=_why_interval(table, row, outcome, k, settings), side=SIDE_NAMES[int(table.side[row])] or None,
            road=table.unit[row], station_m=table.station[row], end_m=table.station[row] + step, covered_m=table.covered[row],
            length_m=geometry.length, **errors)
    layer.geometries = _multi(layer.geometries)
    return layer


def _why_interval(table, row, outcome, k, settings):
    limit = f"{100 * settings.tolerance:g} cm"
    if outcome == "excluded":
        return str(table.excluded[row])
    if outcome == "correct":
        return f"within {limit} of the reference"
    if not table.judged[row]:
        return "a line where the reference has none"
    if table.covered[row] == 0:
        return "no line"
    if table.covered[row] < settings.coverage * settings.interval:
        return f"a line over {table.covered[row]:.1f} m only"
    return f"a line up to {100 * table.largest[row]:.0f} cm beside the reference"


def driving_line_layer(match: LineMatch, settings: LineAccuracySettings, crs: str, progress: Progress = Progress()) -> Features:
    """Features of the correct and false pieces of the result, and of the missed pieces of the reference. `crs`: WKT."""
    layer = Features("MultiLineStringZ", ASSESSED_DRIVING_LINES, crs=crs)
    for number, (outcome, owner, geometry, first, last) in enumerate(match.pieces(settings.tolerance)):
        if number % ROWS_PER_REPORT == 0:
            share = first / max(len(match.reference_points), 1) + 1 if outcome == "missed" else first / len(match.result_points)
            progress.report(0.5 * share)
        rows = slice(first, last + 1)
        points = match.reference_points if outcome == "missed" else match.result_points
        distance = (match.to_result if outcome == "missed" else match.to_reference)[rows]
        near = distance[distance <= MAX_MATCH_DISTANCE]
        layer.add(
            geometry, outcome=outcome, why=_why_piece(outcome, distance, settings), line=owner,
            station_m=points.station[first] - points.length[first] / 2, end_m=points.station[last] + points.length[last] / 2,
            length_m=geometry.length, **(dict(lateral_m=near.mean(), max_m=near.max()) if len(near) else {}))
    layer.geometries = _multi(layer.geometries)
    return layer


def _why_piece(outcome, distance, settings):
    limit = f"{100 * settings.tolerance:g} cm"
    if outcome == "correct":
        return f"within {limit} of the reference"
    counterpart = "result" if outcome == "missed" else "reference"
    if not (distance <= MAX_MATCH_DISTANCE).any():
        return f"no line of the {counterpart} within {100 * MAX_MATCH_DISTANCE:.0f} cm that runs the same way"
    return f"the {counterpart} is up to {100 * distance[distance <= MAX_MATCH_DISTANCE].max():.0f} cm away"


def marking_layer(accuracy: MarkingAccuracy, result: Sequence[Any], reference: Sequence[Any], result_classes: Sequence[Any] | None,
                  reference_classes: Sequence[Any] | None, crs: str) -> Features:
    """All objects of the reference (correct or missed) and the false objects of the result, as given to `assess_markings`. `crs`: WKT."""
    layer = Features("MultiPolygonZ", ASSESSED_MARKINGS, crs=crs)
    of_reference, of_result = accuracy.outcomes()
    size = accuracy.settings.cell_size**2
    groups = (("reference", of_reference, reference, reference_classes, accuracy.reference_cells, accuracy.reference_found, None),
              ("result", of_result, result, result_classes, accuracy.result_cells, accuracy.result_right, "correct"))
    for source, outcomes, shapes, classes, cells, good, left_out in groups:
        for k, (outcome, shape) in enumerate(zip(outcomes, shapes)):
            polygon = _polygons(shape)
            if outcome == left_out or polygon is None:
                continue
            share = 100.0 * good[k] / cells[k] if cells[k] else None
            layer.add(polygon, outcome=outcome, why=_why_object(outcome, source, share), source=source, share_pct=share, area_m2=cells[k] * size,
                      **{"class": None if classes is None else classes[k]})
    layer.geometries = _with_z(layer.geometries) if len(layer) else []
    return layer


def _why_object(outcome, source, share):
    if outcome == "excluded":
        return "outside the area, or nothing was scanned there, or hidden under another object"
    if source == "reference":
        return f"{share:.0f} % of it is painted in the result"
    return f"{share:.0f} % of it is painted in the reference"


def _multi(lines):
    """Lines of one part or many as multi-lines."""
    parts, owner = shapely.get_parts(np.asarray(lines, object), return_index=True)
    return _with_z(shapely.multilinestrings(parts, indices=owner)) if len(lines) else []


def _polygons(shape):
    """The areas of a shape as one multi-polygon; None where it has none."""
    parts = shapely.get_parts(shapely.get_parts(shape))
    parts = parts[shapely.get_type_id(parts) == shapely.GeometryType.POLYGON]
    return shapely.multipolygons(parts) if len(parts) else None


def _with_z(geometries):
    """A list with heights where there are any, 0 where there are none: layers of other software may be flat."""
    lifted = shapely.force_3d(np.asarray(geometries, object))
    return list(shapely.transform(lifted, np.nan_to_num, include_z=True))
