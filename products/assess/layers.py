"""The layers of an assessment: what comes in, in one metric CRS and of the right kind, and the outcome of every object on its way out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import shapely

from ...core.common.errors import RoadExtractionError
from ...core.common.features import ASSESSED_BOUNDARIES, ASSESSED_DRIVING_LINES, ASSESSED_MARKINGS, Features
from ...core.common.progress import Progress
from ...core.curves.line_segments import single_lines
from ...core.io.crs import check_extent, check_metric, horizontal_part, in_other_crs, parse_crs, same_crs
from ...core.io.local_files import gdal_exceptions, gdal_work, open_raster, reading
from ...core.lazy import gdal, ogr
from ...core.survey.weights import TRAJECTORY
from .lines import MAX_MATCH_DISTANCE, SIDE_NAMES, BoundaryAccuracy, LineAccuracySettings, LineMatch, interval_lines
from .markings import MarkingAccuracy
from .matching import MAX_ROAD_DISTANCE, TrajectoryStationing, sample_lines

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


# Input layers of an assessment: one metric CRS, the right kind of geometry, a common area, a reference to judge by.

MAX_LAYER_DISTANCE = 100.0  # m between the extents of two layers of one road
PAVEMENT, CURBS = "pavement", ("curb", "dropped")   # values of the field `edge`
TRANSVERSE_KINDS = ("corner", "side_street", "island")  # values of the field `kind` of curbs that do not run along the road


@dataclass
class AssessedLayer:
    """A layer with its attributes."""

    label: str   # its name in messages
    geometries: list[Any]   # list of shapely geometries
    rows: list[dict[str, Any]] = field(default_factory=list)   # list of dict, field name to value, one per geometry
    crs: str = ""   # WKT, "" if unknown
    excluded: list[str | None] = field(default_factory=list)   # of a reference: why a row is not judged, None of those that are

    def column(self, name: str) -> list[Any]:
        """Values of a field, None where the layer or the row has none; the case of the name is ignored."""
        field = next((key for row in self.rows[:1] for key in row if key.lower() == name.lower()), None)
        return [None if field is None else row.get(field) for row in self.rows]

    def subset(self, mask: np.ndarray) -> AssessedLayer:
        """The rows of a (N,) bool mask."""
        rows = np.flatnonzero(mask)
        geometries, values, excluded = ([column[k] for k in rows] if column else [] for column in (self.geometries, self.rows, self.excluded))
        return replace(self, geometries=geometries, rows=values, excluded=excluded)


def check_kind(layer: AssessedLayer, kinds: Sequence[str], needed: str) -> None:
    """Refuse, with RoadExtractionError, a layer with other geometries than these kinds, such as "LineString"; `needed` says what they are."""
    names = {"Point": "points", "LineString": "lines", "Polygon": "polygons"}
    present = {g.geom_type.removeprefix("Multi") for g in layer.geometries}
    wrong = sorted(names.get(kind, kind) for kind in present - set(kinds))
    if wrong:
        raise RoadExtractionError(f"{layer.label} holds {', '.join(wrong)}; {needed} are needed. Choose another layer.")


def common_crs(layers: Sequence[AssessedLayer]) -> str:
    """WKT of the CRS to work in: that of the first layer with one in metres and true to scale; "" if no layer has a CRS.

    Raises RoadExtractionError if no layer is in metres, by its CRS or, where it has none, by its coordinates.
    """
    refused = None
    for layer in layers:
        crs = parse_crs(layer.crs)
        if crs is None:
            continue
        try:
            check_metric(crs, layer.label)
            if len(layer.geometries):
                check_extent(layer.crs, shapely.total_bounds(layer.geometries).reshape(2, 2), layer.label)
            return layer.crs
        except RoadExtractionError as problem:
            refused = refused or problem
    if refused is not None:
        raise refused
    for layer in layers:
        if len(layer.geometries) and _looks_like_degrees(layer.geometries):
            raise RoadExtractionError(f"{layer.label} has no CRS and coordinates that look like degrees. Distances need metres: set the layer's CRS "
                                      "and reproject it to a projected one.")
    return ""


def in_crs(layer: AssessedLayer, wkt: str, warn: Callable[[str], None]) -> AssessedLayer:
    """The layer in a CRS, as it is for ""; without a CRS it is assumed to be in this one, with a warning.

    Raises RoadExtractionError if it has no CRS but coordinates in degrees, or cannot be transformed.
    """
    source, target = parse_crs(layer.crs), parse_crs(wkt)
    if target is None or not len(layer.geometries):
        return layer
    if source is None:
        if _looks_like_degrees(layer.geometries):
            raise RoadExtractionError(f"{layer.label} has no CRS and coordinates that look like degrees, while the others are in "
                                      f"{horizontal_part(target).name}. Set the layer's CRS and run again.")
        warn(f"{layer.label} has no CRS; its coordinates are taken to be in {horizontal_part(target).name}.")
        return replace(layer, crs=wkt)
    if same_crs(source, target):
        return replace(layer, crs=wkt)

    moved = in_other_crs(layer.geometries, source, target)
    if not np.isfinite(shapely.get_coordinates(moved)).all():
        raise RoadExtractionError(
            f"{layer.label} is in {horizontal_part(source).name} and cannot be brought to {horizontal_part(target).name}. Check its CRS.")
    return replace(layer, geometries=moved, crs=wkt)


def without_stray_vertices(layer: AssessedLayer, warn: Callable[[str], None]) -> AssessedLayer:
    """A layer of lines, m, without the vertices that lie on another continent than most: the work goes with the length of lines."""
    places = shapely.get_coordinates(layer.geometries)
    middle = np.median(places, axis=0) if len(places) else np.zeros(2)
    far = np.hypot(*(places - middle).T) > TRAJECTORY.longest_step
    if not far.any():
        return layer
    x, y = places[int(np.argmax(far))]
    warn(f"{layer.label}: {np.count_nonzero(far):,} of {len(far):,} vertices lie more than {TRAJECTORY.longest_step / 1000:.0f} km from the others, "
         f"the first at {x:.1f}, {y:.1f}. They were left out.")
    return replace(layer, geometries=[_lines_near(shape, middle) for shape in layer.geometries])


def _lines_near(shape, middle):
    """The lines of a shape, without the vertices that are far from a place."""
    lines, _ = single_lines([shape])
    near = [places[np.hypot(*(places[:, :2] - middle).T) <= TRAJECTORY.longest_step]
            for places in (shapely.get_coordinates(line, include_z=bool(shape.has_z)) for line in lines)]
    return shapely.multilinestrings([shapely.linestrings(places) for places in near if len(places) > 1])


def check_overlap(result: AssessedLayer, reference: AssessedLayer) -> None:
    """Refuse, with RoadExtractionError, a result whose extent is more than 100 m from that of the reference."""
    if not result.geometries or not reference.geometries:
        return
    a, b = (shapely.total_bounds(np.asarray(layer.geometries, object)) for layer in (result, reference))
    gap = np.maximum(np.maximum(a[:2] - b[2:], b[:2] - a[2:]), 0.0)
    if np.hypot(*gap) > MAX_LAYER_DISTANCE:
        def extent(box):
            return f"x {box[0]:.0f} to {box[2]:.0f}, y {box[1]:.0f} to {box[3]:.0f}"

        raise RoadExtractionError(f"{result.label} and {reference.label} lie {np.hypot(*gap):.0f} m apart ({extent(a)} against {extent(b)}), so "
                                  "nothing can be compared. Check that both show the same road and that their CRSs are right.")


def _looks_like_degrees(geometries):
    x0, y0, x1, y1 = shapely.total_bounds(np.asarray(geometries, object))
    return bool(max(abs(x0), abs(x1)) <= 180 and max(abs(y0), abs(y1)) <= 90 and max(x1 - x0, y1 - y0) < 1.0)


def bottoms_only(layer: AssessedLayer, warn: Callable[[str], None]) -> AssessedLayer:
    """The layer without the tops of curbs if it has bottoms too."""
    parts = np.array([str(part).lower() if part is not None else "" for part in layer.column("part")], object)
    if "bottom" not in parts or "top" not in parts:
        return layer
    warn(f"{layer.label} holds tops and bottoms of curbs; the bottoms are assessed.")
    return layer.subset(parts != "top")


def along_the_road_only(layer: AssessedLayer, warn: Callable[[str], None]) -> AssessedLayer:
    """The layer without corners, side streets and islands, which intervals along a road cannot judge."""
    transverse = np.array([str(kind).lower() in TRANSVERSE_KINDS for kind in layer.column("kind")], bool)
    if not transverse.any() or transverse.all():
        return layer
    warn(f"{layer.label} holds {_length(layer, transverse):.0f} m of corners, side streets and islands; they are not judged.")
    return layer.subset(~transverse)


def edges_that_compare(result: AssessedLayer, reference: AssessedLayer, edges: str,
                       warn: Callable[[str], None]) -> tuple[AssessedLayer, AssessedLayer]:
    """(the result, the reference) with edges of the same kinds: curbs are not judged by edges of the pavement.

    The field `edge`, else `kind`, says what a line is. Edges "all" keeps both layers as they are; "curbs" leaves edges of the pavement out of
    both; "automatic" leaves them out of the result where the reference says of its lines that they are curbs, and of none that it is an edge
    of the pavement.
    """
    named = [_what_edges_are(layer) for layer in (result, reference)]
    pavement = [names == PAVEMENT for names in named]
    curbs_alone = bool(np.isin(named[1], CURBS).any() and not pavement[1].any())
    if edges == "all" or not (pavement[0].any() or pavement[1].any()):
        return result, reference
    if edges == "automatic" and not curbs_alone:
        if not np.isin(named[1], (*CURBS, PAVEMENT)).any():
            warn(f"{result.label} holds {_length(result, pavement[0]):.0f} m of edges of the pavement without a curb, and {reference.label} does "
                 "not say what its lines are. If it holds curbs alone, choose curbs as the edges to judge.")
        return result, reference
    if pavement[0].any():
        warn(f"{result.label} holds {_length(result, pavement[0]):.0f} m of edges of the pavement without a curb; they are not judged, as the curbs "
             f"of {reference.label} cannot tell whether they are right.")
    if pavement[1].any():
        warn(f"{reference.label} holds {_length(reference, pavement[1]):.0f} m of edges of the pavement without a curb; they are left out.")
    return result.subset(~pavement[0]), reference.subset(~pavement[1])


def _what_edges_are(layer):
    """(N,) what each line is: `edge` says it, and in layers without that field `kind`."""
    edge, kind = layer.column("edge"), layer.column("kind")
    return np.array([str(b if a is None else a).lower() if a is not None or b is not None else "" for a, b in zip(edge, kind)], object)


def _length(layer, mask):
    return float(sum(layer.geometries[k].length for k in np.flatnonzero(mask)))


def check_reference(reference: AssessedLayer, result: AssessedLayer, frame: Any, area: Any, warn: Callable[[str], None],
                    corridor: float = MAX_ROAD_DISTANCE) -> None:
    """Refuse, with RoadExtractionError, reference lines of which none lies in the area, a polygon or None, or within `corridor` metres of the
    trajectory, whose RoadFrame is given or None; warn if the result has no line.
    """
    lines, _ = single_lines(reference.geometries)
    if not lines:
        raise RoadExtractionError(
            f"{reference.label} has no lines to judge by. Choose the layer of reference lines, and see that not all of its rows are excluded.")
    points = sample_lines(lines, 1.0)
    inside = points.inside(area)
    if not len(inside):
        raise RoadExtractionError(f"{reference.label} has no lines inside the area. Check that the area covers the road, or leave it empty.")
    if frame is not None and (TrajectoryStationing(frame, corridor).of_reference(inside).unit < 0).all():
        raise RoadExtractionError(f"The trajectory does not pass {reference.label}: none of it lies within {corridor:g} m. Check that both show the "
                                  "same road, and their CRSs, or leave the trajectory empty to measure along the reference.")
    if not single_lines(result.geometries)[0]:
        warn(f"{result.label} has no lines: everything is missed.")


def check_marking_reference(reference: AssessedLayer, result: AssessedLayer, area: Any, warn: Callable[[str], None]) -> None:
    """Refuse, with RoadExtractionError, reference polygons of which none has an area or lies in the area given; warn if the result has none."""
    shapes = np.asarray(reference.geometries, object)
    if not len(shapes) or not (shapely.area(shapes) > 0).any():
        raise RoadExtractionError(f"{reference.label} has no polygons, lines or cells that are painted. Choose the layer of reference markings.")
    if area is not None and not shapely.intersects(area, shapes).any():
        raise RoadExtractionError(f"{reference.label} has nothing inside the area. Check that the area covers the road, or leave it empty.")
    if not len(result.geometries):
        warn(f"{result.label} shows no paint: everything is missed.")


def widened_lines(lines: Sequence[Any], widths: Sequence[float] | np.ndarray) -> list[Any]:
    """Polygons of lines with a width, (N,) metres from side to side, cut square at the ends of the lines."""
    return list(shapely.buffer(np.asarray(lines, object), np.asarray(widths, float) / 2, cap_style="flat", join_style="mitre"))


def marking_polygons(layer: AssessedLayer, line_width: float) -> AssessedLayer:
    """The layer with its lines widened to polygons, to `line_width` metres where they have no field `width_m` or `width`.

    Raises RoadExtractionError if it holds points.
    """
    check_kind(layer, ("LineString", "Polygon", "GeometryCollection"), "polygons, lines or a mask")
    shapes = list(layer.geometries)
    lines = [k for k, shape in enumerate(shapes) if "LineString" in shape.geom_type]
    named, plain = layer.column("width_m"), layer.column("width")
    widths = [_width(named[k], plain[k], line_width) for k in lines]
    for k, strip in zip(lines, widened_lines([shapes[k] for k in lines], widths)):
        shapes[k] = strip
    return replace(layer, geometries=list(shapely.make_valid(shapely.force_2d(np.asarray(shapes, object)))))


def _width(*candidates):
    for value in candidates:
        try:
            if value is not None and 0.01 <= float(value) <= 10:
                return float(value)
        except (TypeError, ValueError):
            continue
    return candidates[-1]


def classes_of(layer: AssessedLayer, name: str) -> list[Any] | None:
    """The class of every row, from the field of this name, or mark_class, or kind; None without any."""
    for candidate in (name, "mark_class", "kind"):
        values = layer.column(candidate) if candidate else []
        if any(value is not None for value in values):
            return values
    return None


# Polygons of the painted patches of a raster.

RASTER_READ_SIZE = 2048  # pixels, side of the pieces in which a raster is read


@gdal_exceptions()
def polygons_of_raster(path: str, progress: Progress = Progress()) -> tuple[list[shapely.Geometry], np.ndarray, str]:
    """(polygons in the raster's CRS, (N,) int values, WKT or "") of its painted patches: 8-connected cells of one value, neither 0 nor no-data.

    Values outside 1 to 65534 and fractions below 1 count as 1. Raises RoadExtractionError if GDAL cannot read the file.
    """
    raster = open_raster(path)
    copy = f"/vsimem/lanewright_{id(raster)}.tif"
    try:
        with reading(path):
            values = _values(raster, copy, progress.part(0.0, 0.7))
        source = ogr.GetDriverByName("Memory").CreateDataSource("painted")
        layer = source.CreateLayer("painted", None, ogr.wkbPolygon)
        layer.CreateField(ogr.FieldDefn("value", ogr.OFTInteger))
        band = values.GetRasterBand(1)
        gdal_work(lambda report: gdal.Polygonize(band, band, layer, 0, ["8CONNECTED=8"], callback=report), progress.part(0.7, 1.0))
        polygons, kinds = [], []
        for feature in layer:
            polygons.append(shapely.from_wkb(bytes(feature.GetGeometryRef().ExportToWkb())))
            kinds.append(feature.GetField(0))
        values = band = None
    finally:
        gdal.Unlink(copy)
    crs = raster.GetProjection()
    # patches that touch themselves at a corner are no valid polygons
    return list(shapely.make_valid(np.asarray(polygons, object))) if polygons else [], np.array(kinds, int), crs


def _values(raster, path, progress):
    """A copy of the raster with whole numbers, 0 where nothing is painted."""
    width, height = raster.RasterXSize, raster.RasterYSize
    copy = gdal.GetDriverByName("GTiff").Create(path, width, height, 1, gdal.GDT_UInt16, ["TILED=YES", "COMPRESS=LZW", "SPARSE_OK=TRUE"])
    copy.SetGeoTransform(raster.GetGeoTransform())
    band, target = raster.GetRasterBand(1), copy.GetRasterBand(1)
    nodata = band.GetNoDataValue()
    for row in range(0, height, RASTER_READ_SIZE):
        progress.report(row / height)
        for column in range(0, width, RASTER_READ_SIZE):
            wide, high = min(RASTER_READ_SIZE, width - column), min(RASTER_READ_SIZE, height - row)
            data = np.frombuffer(band.ReadRaster(column, row, wide, high, buf_type=gdal.GDT_Float64), np.float64)
            painted = np.isfinite(data) & (data != 0)
            if nodata is not None:
                painted &= data != nodata
            if painted.any():
                value = np.where(painted & (data >= 1) & (data < 65535), np.nan_to_num(data), painted).astype(np.uint16)
                target.WriteRaster(column, row, wide, high, value.tobytes())
    return copy
