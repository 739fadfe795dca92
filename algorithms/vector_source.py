"""Vector layers as the algorithms read them, whatever program opens them."""

from dataclasses import replace

from ..core.common.errors import RoadExtractionError
from ..core.common.features import Features
from ..core.lazy import np, shapely
from .rooms import core
from .texts import tr

POINT, LINE, POLYGON, TABLE, UNKNOWN = "point", "line", "polygon", "table", "unknown"
KIND_OF = {"PointZ": POINT, "LineStringZ": LINE, "LineStringZM": LINE, "PolygonZ": POLYGON, "MultiLineStringZ": LINE,
           "MultiPolygonZ": POLYGON, "None": TABLE}
KIND_LABELS = {POINT: "Point", LINE: "Line", POLYGON: "Polygon", TABLE: "No geometry", UNKNOWN: "Unknown geometry"}
POINT_KIND, POLYGON_KIND = 1, 3  # of WKB; what is higher is made of parts
FARTHEST_ON_EARTH = 1e8   # m or feet: coordinates of a map, some times around the earth


class VectorSource:
    """A layer that is open for reading; every program that runs the algorithms has its own.

    label : what messages call it
    names : list of str, its fields
    kind : POINT, LINE, POLYGON, TABLE or UNKNOWN
    has_z, has_m : whether its geometries carry heights and measures
    stored_crs : WKT of what is stored, "" where unknown
    feature_id : of the row that `stored_rows` gave last
    """

    label, names, kind, has_z, has_m, stored_crs, feature_id = "", [], UNKNOWN, False, False, "", 0

    def stored_rows(self, measures=False, check_validity=True):
        """(WKB or None where there is no geometry, b"" where it is none, list of values with None for NULL) of every row, as it is stored.

        measures : keep M in the WKB
        check_validity : refuse or skip invalid geometries where the program does so
        """
        raise NotImplementedError

    @property
    def crs(self):
        """WKT, metric, of the CRS of `rows`; "" where unknown."""
        return core.io.crs.in_metres(self.stored_crs)[0]

    def rows(self, measures=False, check_validity=True):
        """The rows as `stored_rows` gives them, coordinates in metres; RoadExtractionError where a geometry cannot be that of a place."""
        units, rows = core.io.crs.in_metres(self.stored_crs)[1], _checked(self, self.stored_rows(measures, check_validity))
        return rows if units.metric else ((wkb and scaled_wkb(wkb, units.across, units.up), values) for wkb, values in rows)

    def kind_label(self, kind):
        """A kind of geometry as the program calls it."""
        return KIND_LABELS[kind]


def _checked(source, rows):
    """The rows of a layer whose geometries have vertices enough, and coordinates that are numbers and lie on earth."""
    read, ids = [], []
    for row in rows:
        read.append(row)
        ids.append(source.feature_id)
    drawn = [k for k, (wkb, _) in enumerate(read) if wkb is not None]
    shapes = shapely.from_wkb(np.array([read[k][0] for k in drawn], object), on_invalid="ignore")
    places, owner = shapely.get_coordinates(shapes, include_z=True, return_index=True)
    # heights may be missing, which NaN says
    wrong = ~(np.isfinite(places[:, :2]).all(axis=1) & ~(np.abs(places) > FARTHEST_ON_EARTH).any(axis=1))
    problems = {drawn[k]: tr("too few vertices") for k in np.flatnonzero(shapely.is_missing(shapes)).tolist()}
    problems.update((drawn[k], tr("coordinates that lie nowhere on earth")) for k in np.unique(owner[wrong]).tolist())
    if problems:
        first = min(problems)
        raise RoadExtractionError(tr("{label} cannot be used: {count} of its {total} features have {problem}, the first of them feature {id}. Repair "
                                     "or delete them.", label=source.label, count=len(problems), total=len(read), problem=problems[first],
                                     id=ids[first]))
    return iter(read)


def _value(column, value, label):
    """A value of a field in the type that is needed."""
    try:
        return column.type(value)
    except (TypeError, ValueError, OverflowError):
        raise RoadExtractionError(tr("{label} has {value!r} in its field {field}, where a number is needed. Use the layer that Lanewright wrote.",
                                     label=label, value=value, field=column.name)) from None


def read_features(source, schema, geometry_type):
    """A layer as Features; fields are matched by name, the layer's further fields are left out.

    Multi-part geometries become one row a part. Raises RoadExtractionError where a
    field that is needed is missing, the geometry is of another kind, or carries no heights.
    """
    indices = _columns(source, schema)
    needed = KIND_OF[geometry_type]
    if geometry_type != "None" and source.kind != needed:   # a layer that another stage made
        raise RoadExtractionError(tr("{label} holds geometries of the kind {found}; {needed} is needed. Use the layer that Lanewright wrote.",
                                     label=source.label, found=source.kind_label(source.kind), needed=source.kind_label(needed)))
    measured = geometry_type.endswith("ZM")
    result = Features(geometry_type, list(schema), crs=source.crs)
    # scanlines run straight up a wall, which seen from above is no valid line
    for wkb, values in source.rows(measures=measured, check_validity=not measured):
        row = {column.name: None if k is None or values[k] is None else _value(column, values[k], source.label)
               for column, k in zip(schema, indices)}
        if geometry_type == "None":
            result.add(None, **row)
            continue
        if wkb is None:
            continue
        if measured:
            for part in _measured_parts(wkb, source.label):
                result.add(part, **row)
            continue
        for part in shapely.get_parts(shapely.from_wkb(wkb)):
            if not part.has_z or np.isnan(shapely.get_coordinates(part, include_z=True)).any():
                raise RoadExtractionError(tr("{label} has geometries without heights (Z). Use the layer that Lanewright wrote.", label=source.label))
            result.add(part, **row)
    return result


def _columns(source, schema):
    """Places of the schema's fields among those of the layer, None for a field that is not needed; the case of names does not matter."""
    index_by_name = {name.lower(): k for k, name in reversed(list(enumerate(source.names)))}
    index_by_name.update({name: k for k, name in enumerate(source.names)})
    indices = [index_by_name.get(column.name, index_by_name.get(column.name.lower())) for column in schema]
    missing = [column.name for column, k in zip(schema, indices) if k is None and column.needed]
    if missing:
        raise RoadExtractionError(tr("{label} lacks the field(s) {fields}. Use the layer that Lanewright wrote.", label=source.label,
                                     fields=", ".join(missing)))
    return indices


def _measured_parts(wkb, label):
    """WKB of every part of a line geometry with Z and M: shapely before 2.1 would lose the M."""
    _, has_z, has_m = _type_of(wkb, 0)
    if not (has_z and has_m):
        raise RoadExtractionError(tr("{label} has geometries without heights (Z) or measures (M). Use the layer that Lanewright wrote.", label=label))
    for first_byte, count, *_ in _runs(wkb):
        yield wkb[first_byte - 9:first_byte + 32 * count]   # with its byte order, type and count


def vertices_of(wkb):
    """(V, 4) x, y, z and m of all vertices of points or lines, in one part or many; NaN where there is no z or m."""
    runs = [np.empty((0, 4))]
    for first_byte, count, has_z, has_m in _runs(wkb):
        runs.append(np.full((count, 4), np.nan))
        runs[-1][:, [0, 1, *[2] * has_z, *[3] * has_m]] = np.frombuffer(wkb, "<f8", count * (2 + has_z + has_m), first_byte).reshape(count, -1)
    return np.concatenate(runs)


def scaled_wkb(wkb, across, up):
    """Little endian WKB with x and y times `across` and z times `up`; measures stay."""
    data = bytearray(wkb)
    for first_byte, count, has_z, has_m in _runs(data):
        values = np.frombuffer(data, "<f8", count * (2 + has_z + has_m), first_byte).reshape(count, -1)
        values *= [across, across, *[up] * has_z, *[1.0] * has_m]
    return bytes(data)


def _runs(wkb, at=0):
    """(byte, number of vertices, has Z, has M) of each run of vertices of the geometry that begins at a byte; returns the byte where it ends."""
    kind, has_z, has_m = _type_of(wkb, at)
    at += 5
    if kind > POLYGON_KIND:
        parts, at = _uint(wkb, at), at + 4
        for _ in range(parts):
            at = yield from _runs(wkb, at)
        return at
    rings, at = (_uint(wkb, at), at + 4) if kind == POLYGON_KIND else (1, at)
    for _ in range(rings):
        count, at = (1, at) if kind == POINT_KIND else (_uint(wkb, at), at + 4)
        yield at, count, has_z, has_m
        at += 8 * count * (2 + has_z + has_m)
    return at


def in_file_units(features):
    """A layer that is to be written, in the units of the survey's own CRS."""
    wkt, units = core.io.crs.as_in_file(features.crs)
    if units.metric:
        return features
    if features.geometry_type.endswith("ZM"):
        return MeasuredInFileUnits(features, wkt, units)

    moved = [geometry if geometry is None else shapely.transform(geometry, units.in_file, include_z=True) for geometry in features.geometries]
    on_map = [field.name for field in features.schema if field.on_map]
    rows = [{**row, **{name: row[name] / units.across for name in on_map if row.get(name) is not None}} for row in features.rows]
    return replace(features, geometries=moved, rows=rows, crs=wkt)


class MeasuredInFileUnits:
    """Lines with measures, (WKB, row) one after the other, in the units of a file; otherwise as a Features layer."""

    def __init__(self, lines, crs, units):
        self.geometry_type, self.schema, self.crs = lines.geometry_type, lines.schema, crs
        self._lines, self._units = lines, units

    def __len__(self):
        return len(self._lines)

    def __iter__(self):
        return ((scaled_wkb(wkb, 1 / self._units.across, 1 / self._units.up), row) for wkb, row in self._lines)


def _type_of(wkb, at):
    """(kind without dimensions, has Z, has M) of little endian WKB, ISO or extended."""
    number = _uint(wkb, at + 1)
    flags, number = number >> 28, number & 0x0FFFFFFF
    return number % 1000, bool(flags & 8) or number // 1000 in (1, 3), bool(flags & 4) or number // 1000 in (2, 3)


def _uint(wkb, at):
    return int.from_bytes(wkb[at:at + 4], "little")


def crs_to_write(features, driver):
    """WKT of the CRS that a file of an OGR driver gets; "" for none, for which a GeoPackage has an entry that is not geographic."""
    return features.crs or (core.io.crs.UNDEFINED_CARTESIAN if driver == "GPKG" and features.geometry_type != "None" else "")


def plain_value(value):
    """A Python value that a file can store: numpy scalars unpacked, NaN as NULL."""
    if hasattr(value, "item"):
        value = value.item()
    return None if value != value else value
