"""What an assessment found, as layers coloured by outcome."""

import numpy as np
import shapely

from ..common.features import Features
from ..common.progress import Progress
from ..common.schemas import ASSESSED_BOUNDARIES, ASSESSED_DRIVING_LINES, ASSESSED_MARKINGS
from .boundaries import SIDES, interval_lines
from .driving_lines import ASSOCIATED

TOLD = 100  # rows between two looks at Cancel


def boundary_layer(accuracy, crs, progress=Progress()):
    """One row an interval and outcome: as many correct, missed and false ones as the table of the report counts."""
    settings, table = accuracy.settings, accuracy.intervals
    layer = Features("MultiLineStringZ", ASSESSED_BOUNDARIES, crs=crs)
    step, k = settings.interval, settings.tolerances.index(settings.tolerance)
    for number, (outcome, row, geometry) in enumerate(interval_lines(accuracy, settings.tolerance)):
        if number % TOLD == 0:
            progress.report(row / len(table.unit))
        largest, lateral = table.largest[row], table.lateral[row]
        measured = outcome in ("correct", "false") and table.judged[row]
        layer.add(
            geometry, outcome=outcome, why=_why_interval(table, row, outcome, k, settings), side=SIDES[int(table.side[row])] or None,
            road=int(table.unit[row]), station_m=float(table.station[row]), end_m=float(table.station[row] + step),
            covered_m=float(table.covered[row]), lateral_m=float(lateral) if measured else None,
            max_m=float(largest) if measured else None, height_m=float(table.height[row]) if measured else None,
            length_m=float(geometry.length))
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


def driving_line_layer(match, settings, crs, progress=Progress()):
    """The result's lines cut into correct and false pieces, and the pieces of the reference that were missed."""
    layer = Features("MultiLineStringZ", ASSESSED_DRIVING_LINES, crs=crs)
    for number, (outcome, owner, geometry, first, last) in enumerate(match.pieces(settings.tolerance)):
        if number % TOLD == 0:
            progress.report(0.5 * (first / max(len(match.theirs), 1) + 1) if outcome == "missed" else 0.5 * first / len(match.mine))
        rows = slice(first, last + 1)
        places = match.theirs if outcome == "missed" else match.mine
        distance = (match.to_result if outcome == "missed" else match.to_reference)[rows]
        near = distance[distance <= ASSOCIATED]
        layer.add(
            geometry, outcome=outcome, why=_why_piece(outcome, distance, settings), line=int(owner),
            station_m=float(places.station[first] - places.length[first] / 2), end_m=float(places.station[last] + places.length[last] / 2),
            length_m=float(geometry.length), lateral_m=float(near.mean()) if len(near) else None, max_m=float(near.max()) if len(near) else None)
    layer.geometries = _multi(layer.geometries)
    return layer


def _why_piece(outcome, distance, settings):
    limit = f"{100 * settings.tolerance:g} cm"
    if outcome == "correct":
        return f"within {limit} of the reference"
    other = "result" if outcome == "missed" else "reference"
    if not (distance <= ASSOCIATED).any():
        return f"no line of the {other} within {100 * ASSOCIATED:.0f} cm that runs the same way"
    return f"the {other} is up to {100 * distance[distance <= ASSOCIATED].max():.0f} cm away"


def marking_layer(accuracy, result, reference, result_classes, reference_classes, crs):
    """Every object of the reference (correct or missed) and every object of the result that is false."""
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
            layer.add(polygon, outcome=str(outcome), why=_why_object(outcome, source, share), source=source,
                      **{"class": None if classes is None or classes[k] is None else str(classes[k])},
                      share_pct=share, area_m2=float(cells[k] * size))
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
