"""Layers of any origin brought together: one CRS in metres, the right kind of geometry, a place in common."""

from dataclasses import dataclass, field

import numpy as np
import shapely

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from ..io.crs import check_metric, horizontal_part, parse_crs, same_crs
from ..io.gdal_errors import gdal_exceptions
from .matching import AlongTrajectory, places_along, single_lines

# Polygons of whatever paint is given as: lines with a width, or a raster of cells.

BLOCK = 2048  # pixels


def strips(lines, widths):
    """Lines widened to polygons: (N,) metres from side to side, square ends that do not stick out."""
    return list(shapely.buffer(np.asarray(lines, object), np.asarray(widths, float) / 2, cap_style="flat", join_style="mitre"))


@gdal_exceptions()
def polygons_of_raster(path, progress=Progress()):
    """The painted patches of a raster: cells that touch, corners included, and have the same value other than 0 and no-data.

    Parameters
    ----------
    path : a raster file; values beyond 1 to 65534 and broken ones count as 1

    Returns
    -------
    polygons : list in the raster's CRS
    values : (N,) int
    crs : WKT, "" where it says none
    """
    from osgeo import gdal, ogr

    try:
        raster = gdal.Open(str(path))
    except RuntimeError as problem:
        raise RoadExtractionError(f"{path} cannot be read as a raster ({problem}).") from problem
    copy = f"/vsimem/lanewright_{id(raster)}.tif"
    try:
        values = _values(raster, copy, progress.part(0.0, 0.7))
        source = ogr.GetDriverByName("Memory").CreateDataSource("painted")
        layer = source.CreateLayer("painted", None, ogr.wkbPolygon)
        layer.CreateField(ogr.FieldDefn("value", ogr.OFTInteger))
        band = values.GetRasterBand(1)
        _polygonize(band, layer, progress.part(0.7, 1.0))
        found, kinds = [], []
        for feature in layer:
            found.append(shapely.from_wkb(bytes(feature.GetGeometryRef().ExportToWkb())))
            kinds.append(feature.GetField(0))
        values = band = None
    finally:
        gdal.Unlink(copy)
    crs = raster.GetProjection()
    # patches that touch themselves at a corner are no valid polygons
    return list(shapely.make_valid(np.asarray(found, object))) if found else [], np.array(kinds, int), crs


def _polygonize(band, layer, progress):
    """GDAL cannot pass an exception through its own code: what Cancel raises is kept and raised again."""
    from osgeo import gdal

    stopped = []

    def tell(share, *_):
        try:
            progress.report(share)
        except Exception as reason:
            stopped.append(reason)
            return 0
        return 1

    try:
        gdal.Polygonize(band, band, layer, 0, ["8CONNECTED=8"], callback=tell)
    except RuntimeError:
        if not stopped:
            raise
    if stopped:
        raise stopped[0]


def _values(raster, path, progress):
    """A copy with whole numbers: 0 where nothing is painted."""
    from osgeo import gdal

    width, height = raster.RasterXSize, raster.RasterYSize
    copy = gdal.GetDriverByName("GTiff").Create(path, width, height, 1, gdal.GDT_UInt16, ["TILED=YES", "COMPRESS=LZW", "SPARSE_OK=TRUE"])
    copy.SetGeoTransform(raster.GetGeoTransform())
    band, target = raster.GetRasterBand(1), copy.GetRasterBand(1)
    nodata = band.GetNoDataValue()
    for row in range(0, height, BLOCK):
        progress.report(row / height)
        for column in range(0, width, BLOCK):
            wide, high = min(BLOCK, width - column), min(BLOCK, height - row)
            data = np.frombuffer(band.ReadRaster(column, row, wide, high, buf_type=gdal.GDT_Float64), np.float64)
            painted = np.isfinite(data) & (data != 0)
            if nodata is not None:
                painted &= data != nodata
            if painted.any():
                value = np.where(painted & (data >= 1) & (data < 65535), np.nan_to_num(data), painted).astype(np.uint16)
                target.WriteRaster(column, row, wide, high, value.tobytes())
    return copy


def painted_polygons(layer, line_width):
    """The AssessedLayer with its lines widened to `width_m` or `width` of their row, or to `line_width` metres.

    Raises
    ------
    RoadExtractionError
        If it holds points.
    """
    check_kind(layer, ("LineString", "Polygon", "GeometryCollection"), "polygons, lines or a mask")
    shapes = list(layer.geometries)
    lines = [k for k, shape in enumerate(shapes) if "LineString" in shape.geom_type]
    named, plain = layer.column("width_m"), layer.column("width")
    widths = [_width(named[k], plain[k], line_width) for k in lines]
    for k, strip in zip(lines, strips([shapes[k] for k in lines], widths)):
        shapes[k] = strip
    valid = shapely.make_valid(shapely.force_2d(np.asarray(shapes, object))) if shapes else []
    return AssessedLayer(layer.label, list(valid), layer.rows, layer.crs)


def _width(*candidates):
    for value in candidates:
        try:
            if value is not None and 0.01 <= float(value) <= 10:
                return float(value)
        except (TypeError, ValueError):
            continue
    return candidates[-1]


def classes_of(layer, name):
    """The class of every row by the field of this name, or mark_class, or kind; None where the layer has none."""
    for candidate in (name, "mark_class", "kind"):
        found = layer.column(candidate) if candidate else []
        if any(value is not None for value in found):
            return found
    return None

APART = 100.0  # m between the extents of two layers of one road


@dataclass
class AssessedLayer:
    """Geometries of a layer with its attributes; `label` is how messages call it, `crs` WKT or ""."""

    label: str
    geometries: list
    rows: list = field(default_factory=list)
    crs: str = ""

    def column(self, name):
        """Values of a field whatever the case of its name, None where the layer or the row has none."""
        found = next((key for row in self.rows[:1] for key in row if key.lower() == name.lower()), None)
        return [None if found is None else row.get(found) for row in self.rows]

    def only(self, mask):
        kept = np.flatnonzero(mask)
        return AssessedLayer(self.label, [self.geometries[k] for k in kept], [self.rows[k] for k in kept] if self.rows else [], self.crs)


def check_kind(layer, kinds, needed):
    """Refuse a layer that holds none of the wanted geometries, and one that holds others.

    Raises
    ------
    RoadExtractionError
        If the layer holds geometries of another kind.
    """
    names = {"Point": "points", "LineString": "lines", "Polygon": "polygons"}
    found = {g.geom_type.removeprefix("Multi") for g in layer.geometries}
    wrong = sorted(names.get(kind, kind) for kind in found - set(kinds))
    if wrong:
        raise RoadExtractionError(f"{layer.label} holds {', '.join(wrong)}; {needed} are needed. Choose another layer.")


def common_crs(layers):
    """WKT of the CRS to work in: of the first layer that has one in metres; "" where no layer tells any.

    Raises
    ------
    RoadExtractionError
        If no layer is in metres, by its CRS or, where it has none, by its coordinates.
    """
    refused = None
    for layer in layers:
        crs = parse_crs(layer.crs)
        if crs is None:
            continue
        try:
            check_metric(crs, layer.label)
            return layer.crs
        except RoadExtractionError as problem:
            refused = refused or problem
    if refused is not None:
        raise refused
    for layer in layers:
        if len(layer.geometries) and _looks_like_degrees(layer.geometries):
            raise RoadExtractionError(
                f"{layer.label} has no CRS and coordinates that look like degrees. Distances need metres: set the layer's CRS and "
                "reproject it to a projected one.")
    return ""


def in_crs(layer, wkt, warn=lambda text: None):
    """The layer in the CRS; one that tells none is taken to lie in it already, and that is said.

    Raises
    ------
    RoadExtractionError
        If it has no CRS but coordinates in degrees, or cannot be brought there.
    """
    source, target = parse_crs(layer.crs), parse_crs(wkt)
    if target is None or not len(layer.geometries):
        return layer
    if source is None:
        if _looks_like_degrees(layer.geometries):
            raise RoadExtractionError(
                f"{layer.label} has no CRS and coordinates that look like degrees, while the others are in {horizontal_part(target).name}. "
                "Set the layer's CRS and run again.")
        warn(f"{layer.label} has no CRS; its coordinates are taken to be in {horizontal_part(target).name}.")
        return AssessedLayer(layer.label, layer.geometries, layer.rows, wkt)
    if same_crs(source, target):
        return AssessedLayer(layer.label, layer.geometries, layer.rows, wkt)
    from pyproj import Transformer

    move = Transformer.from_crs(horizontal_part(source), horizontal_part(target), always_xy=True)
    moved = shapely.transform(np.asarray(layer.geometries, object), lambda xy: np.column_stack(move.transform(*xy.T)))
    moved = [_with_heights_of(old, new) for old, new in zip(layer.geometries, moved)]
    if not np.isfinite(shapely.get_coordinates(moved)).all():
        raise RoadExtractionError(
            f"{layer.label} is in {horizontal_part(source).name} and cannot be brought to {horizontal_part(target).name}. Check its CRS.")
    return AssessedLayer(layer.label, moved, layer.rows, wkt)


def check_overlap(result, reference):
    """Refuse a result that lies nowhere near the reference.

    Raises
    ------
    RoadExtractionError
        If their extents are more than 100 m apart.
    """
    if not result.geometries or not reference.geometries:
        return
    a, b = (shapely.total_bounds(np.asarray(layer.geometries, object)) for layer in (result, reference))
    gap = np.maximum(np.maximum(a[:2] - b[2:], b[:2] - a[2:]), 0.0)
    if np.hypot(*gap) > APART:
        def place(box):
            return f"x {box[0]:.0f} to {box[2]:.0f}, y {box[1]:.0f} to {box[3]:.0f}"

        raise RoadExtractionError(
            f"{result.label} and {reference.label} lie {np.hypot(*gap):.0f} m apart ({place(a)} against {place(b)}), so nothing can be "
            "compared. Check that both show the same road and that their CRSs are right.")


def _with_heights_of(old, new):
    """`shapely.transform` of x and y drops the heights: put them back."""
    if not old.has_z:
        return new
    z = shapely.get_coordinates(old, include_z=True)[:, 2]
    return shapely.transform(shapely.force_3d(new), lambda xyz: np.column_stack([xyz[:, :2], z]), include_z=True)


def _looks_like_degrees(geometries):
    x0, y0, x1, y1 = shapely.total_bounds(np.asarray(geometries, object))
    return bool(max(abs(x0), abs(x1)) <= 180 and max(abs(y0), abs(y1)) <= 90 and max(x1 - x0, y1 - y0) < 1.0)


# What a reference must have to be judged against.

TURNED = ("corner", "side_street", "island")  # values of the field `kind` of curbs that do not run along the road


def bottoms_only(layer, warn=lambda text: None):
    """(the layer without the tops of curbs where it has bottoms too, rows kept)."""
    parts = [str(part).lower() if part is not None else "" for part in layer.column("part")]
    if "bottom" not in parts or "top" not in parts:
        return layer, list(range(len(layer.geometries)))
    kept = [k for k, part in enumerate(parts) if part != "top"]
    warn(f"{layer.label} holds tops and bottoms of curbs; the bottoms are assessed.")
    mask = np.zeros(len(parts), bool)
    mask[kept] = True
    return layer.only(mask), kept


def along_the_road_only(layer, warn=lambda text: None):
    """(the layer without corners, side streets and islands, rows kept): intervals along a road do not tell of them."""
    turned = np.array([str(kind).lower() in TURNED for kind in layer.column("kind")], bool)
    if not turned.any() or turned.all():
        return layer, list(range(len(layer.geometries)))
    length = sum(layer.geometries[k].length for k in np.flatnonzero(turned))
    warn(f"{layer.label} holds {length:.0f} m of corners, side streets and islands; they are not judged.")
    return layer.only(~turned), list(np.flatnonzero(~turned))


def check_reference(reference, result, frame=None, area=None, corridor=30.0, warn=lambda text: None):
    """Refuse a reference with nothing to judge; say where the result has nothing.

    Raises
    ------
    RoadExtractionError
        If the reference has no line, none in the area, or none beside the trajectory.
    """
    lines, _ = single_lines(reference.geometries)
    if not lines:
        raise RoadExtractionError(
            f"{reference.label} has no lines to judge by. Choose the layer of reference lines, and see that not all of its rows are excluded.")
    places = places_along(lines, 1.0)
    inside = places.inside(area)
    if not len(inside):
        raise RoadExtractionError(f"{reference.label} has no lines inside the area. Check that the area covers the road, or leave it empty.")
    if frame is not None and (AlongTrajectory(frame, corridor).of_reference(inside).unit < 0).all():
        raise RoadExtractionError(
            f"The trajectory does not pass {reference.label}: none of it lies within {corridor:g} m. Check that both show the same road, and their "
            "CRSs, or leave the trajectory empty to measure along the reference.")
    if not single_lines(result.geometries)[0]:
        warn(f"{result.label} has no lines: everything is missed.")


def check_paint(reference, result, area=None, warn=lambda text: None):
    """The same for polygons.

    Raises
    ------
    RoadExtractionError
        If the reference has no area, or none inside the area given.
    """
    shapes = np.asarray(reference.geometries, object)
    if not len(shapes) or not (shapely.area(shapes) > 0).any():
        raise RoadExtractionError(
            f"{reference.label} has no polygons, lines or cells that are painted. Choose the layer of reference markings.")
    if area is not None and not shapely.intersects(area, shapes).any():
        raise RoadExtractionError(f"{reference.label} has nothing inside the area. Check that the area covers the road, or leave it empty.")
    if not len(result.geometries):
        warn(f"{result.label} shows no paint: everything is missed.")
