"""The layers of a road map under the names, codes, fields and units of whoever ordered it, by a table that says what becomes what."""

from __future__ import annotations

import csv
import operator
import os
import re
import sqlite3
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import closing, contextmanager
from difflib import get_close_matches
from itertools import zip_longest
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely

from ..core.common.errors import RoadExtractionError
from ..core.common.features import Features, Field
from ..core.common.texts import vocabulary
from ..core.io.crs import FOOT, UNDEFINED_CARTESIAN, US_SURVEY_FOOT, as_in_file, parse_crs, same_crs
from ..core.io.local_files import gdal_exceptions
from ..core.lazy import gdal, ogr, osr

OWN_COLUMNS = "from", "where", "layer", "geometry"   # of the table; all others are the client's fields
TYPES: dict[str, type] = {"text": str, "int": int, "real": float}
GEOMETRIES = {"point": "PointZ", "line": "LineStringZ", "polygon": "PolygonZ"}
IN_WORDS = "class", "kind", "pattern", "edge", "status", "side", "use", "type", "part"   # fields whose values are words that are known
REFERENCE = re.compile(r"\{([^{}]*)\}")
WHOLE = re.compile(r"-?(0|[1-9]\d*)")   # a number, and no code such as 007
CONDITION = re.compile(r"\s*(\w+)\s*(<=|>=|!=|=|<|>)\s*(.*?)\s*")
COMPARISONS = {"=": operator.eq, "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
NOT_DRAWN = '<>/\\":;?*|=,`'   # source: what AutoCAD refuses in names of layers
NOT_WANTED = "-"   # as the client's layer, of what is left out on purpose
NUMBER = "number"   # what a template calls the number of a feature in its layer, from 1


class _Reference(NamedTuple):
    """A field of ours within a cell: as it is, in another unit, or by a list of values."""

    name: str
    kind: type   # of what it gives
    factor: float | None = None   # of the unit
    words: Mapping[str, str] | None = None   # our value to the client's

    def value(self, row: Mapping[str, Any]) -> Any:
        value = row.get(self.name)
        if value is None or self.factor is None and self.words is None:
            return value
        return value * self.factor if self.words is None else self.words.get(str(value))


class _Rule(NamedTuple):
    """A row of a template: features of one of our layers on which all conditions hold become features of a layer of the client."""

    line: int   # of the table, from 1
    source: str   # name of our layer
    conditions: Sequence[tuple[str, str, Sequence[Any]]]   # field, how it compares, with which values
    layer: str   # the client's
    geometry: str   # of it, a key of GEOMETRIES
    cells: Mapping[str, Sequence[str | _Reference]]   # field of the client to texts and references, one after the other

    def holds(self, row: Mapping[str, Any]) -> bool:
        return all(_compared(row.get(field), how, values) for field, how, values in self.conditions)


class _Template(NamedTuple):
    """A template that was checked."""

    path: str
    rules: Sequence[_Rule]
    types: Mapping[str, type | None]   # of the client's fields; None where the table does not say it

    def layer_of(self, name: str) -> list[_Rule]:
        """The rules that fill a layer of the client, in their order."""
        return [rule for rule in self.rules if rule.layer == name]


def read_template(path: str | os.PathLike[str], sources: Mapping[str, tuple[Sequence[Field], str]], mixed: bool = False) -> _Template:
    """Read and check a template.

    path : table in UTF-8 with commas, semicolons or tabs. Its columns are `from` (name of our layer), `where` (conditions, may be empty),
        `layer` (of the client, or - for what is left out on purpose), `geometry` (point, line or polygon; empty as it is), and the client's
        fields, such as `WIDTH` or `WIDTH:int`. Lines that begin with # say what people should know
    sources : fields and geometry type of our layers, by name
    mixed : whether a layer may hold geometries of several kinds, as in a drawing

    Raises RoadExtractionError, with the line of the table, for what is not known: a layer, field, value, unit, type or geometry.
    """
    lines = _rows_of(path)
    number, header = lines[0]
    rules: list[_Rule] = []
    try:
        fields, types = _columns(header)
        for number, cells in lines[1:]:
            rule = _rule(number, fields, cells, sources)
            first = next((other for other in rules if other.layer.lower() == rule.layer.lower()), rule)
            if first.layer != rule.layer:
                raise ValueError(f"layer {rule.layer} is called {first.layer} in line {first.line}. Write capitals alike.")
            if mixed and (sign := next((sign for sign in rule.layer if sign in NOT_DRAWN), "")):
                raise ValueError(f"a drawing has no layer {rule.layer}: none of its names holds a {sign} sign.")
            if first.geometry != rule.geometry and not mixed and rule.layer != NOT_WANTED:
                raise ValueError(f"layer {rule.layer} would hold a {rule.geometry} and, from line {first.line}, a {first.geometry}. Give it another "
                                 "layer, or say in the column geometry what it becomes.")
            rules.append(rule)
    except ValueError as problem:
        raise RoadExtractionError(f"{path}, line {number}: {problem}") from problem
    return _Template(str(path), rules, types)


def _columns(header):
    """Names of all columns, "" for those without one, and {field of the client: its type}; ValueError, in one sentence, for what is not known."""
    fields, kinds = zip(*((name.strip(), kind.strip().lower()) for name, _, kind in (cell.partition(":") for cell in header)))
    fields = [field.lower() if field.lower() in OWN_COLUMNS else field for field in fields]
    for needed in ("from", "layer"):
        if needed not in fields:
            raise ValueError(f"there is no column “{needed}”. The first line names the columns: from, where, layer, geometry, and the fields of the "
                             "client.")
    for k, (field, kind) in enumerate(zip(fields, kinds)):
        if kind and kind not in TYPES:
            raise ValueError(f"{field} is to be of the type “{kind}”; known are {', '.join(TYPES)}.")
        if field and field.lower() in map(str.lower, fields[:k]):
            raise ValueError(f"two columns are called {field.lower()}.")
    return fields, {field: TYPES.get(kind) for field, kind in zip(fields, kinds) if field}


def _rows_of(path):
    """(number, cells) of the lines of a table that say something; the first names the columns."""
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as problem:
        raise RoadExtractionError(f"{path} cannot be read as a table in UTF-8 ({problem}). Save it as “CSV UTF-8”.") from problem
    filled = [(number, line) for number, line in enumerate(lines, 1) if line.strip(" ;,\t") and not line.lstrip(' "').startswith("#")]
    if len(filled) < 2:
        raise RoadExtractionError(f"{path} holds no rows. Its first line names the columns, and each further one says what becomes what.")
    delimiter = max(";,\t", key=filled[0][1].count)
    return [(number, next(csv.reader([line], delimiter=delimiter))) for number, line in filled]


def _rule(line, fields, texts, sources):
    """The rule of a row; ValueError, in one sentence, for what is not known."""
    named = [(name, text.strip()) for name, text in zip_longest(fields, texts, fillvalue="") if text.strip()]
    unnamed = next((text for name, text in named if not name), "")
    if unnamed:
        raise ValueError(f"“{unnamed}” stands in a column without a name. Put cells that hold the delimiter between quotes.")
    cells = dict(named)
    source, layer, geometry = cells.get("from", "").upper(), cells.get("layer", ""), cells.get("geometry", "").lower()
    if source not in sources:
        raise ValueError(f"there is no layer {source or 'without a name'}{_like(source, sources)}.")
    if not layer:
        raise ValueError("the client's layer has no name.")
    schema, of = sources[source]
    given = next(name for name, kind in GEOMETRIES.items() if kind == of)
    order = list(GEOMETRIES)
    if geometry and (geometry not in order or order.index(geometry) > order.index(given)):
        raise ValueError(f"a {given} of {source} cannot become a “{geometry}”; it may become {' or '.join(order[:order.index(given) + 1])}.")
    known = {field.name: field for field in schema}
    return _Rule(line, source, [_condition(text, known, source) for text in cells.get("where", "").split("&") if text.strip()], layer,
                 geometry or given, {name: _cell(text, known, source) for name, text in cells.items() if name not in OWN_COLUMNS})


def _condition(text, known, source):
    parts = CONDITION.fullmatch(text)
    if parts is None:
        raise ValueError(f"“{text.strip()}” is no condition. Write a field, one of = != < <= > >=, and values with commas between them.")
    name, how, values = parts[1], parts[2], [value.strip() for value in parts[3].split(",")]
    _check_field(name, known, source)
    equal = how in ("=", "!=")
    if known[name].type is str:
        if not equal:
            raise ValueError(f"{name} is a text, which is compared by = or != alone.")
        _check_words(name, values)
        return name, how, values
    if len(values) > 1 and not equal:
        raise ValueError(f"“{text.strip()}” compares {name} with {len(values)} numbers. Write one, with a decimal point.")
    try:
        return name, how, [float(value) for value in values]
    except ValueError:
        raise ValueError(f"{name} is a number, and “{parts[3]}” is none.") from None


def _compared(value, how, values):
    """Whether the value of a row is, or compares with, one of several."""
    return value not in values if how == "!=" else value is not None and any(COMPARISONS[how](value, other) for other in values)


def _cell(text, known, source):
    """The texts and references of a cell of the client, one after the other."""
    parts = REFERENCE.split(text)
    if any(sign in part for part in parts[::2] for sign in "{}"):
        raise ValueError(f"“{text}” has a brace without its partner. Write {{width_m}} for one of our fields.")
    return [_reference(part, known, source) if k % 2 else part for k, part in enumerate(parts) if part or k % 2]


def _reference(text, known, source):
    name, _, option = (part.strip() for part in text.partition(":"))
    if name == NUMBER and not option:
        return _Reference(NUMBER, int)
    _check_field(name, known, source)
    if not option:
        return _Reference(name, known[name].type)
    if "=" in option:
        pairs = [pair.partition("=") for pair in option.split(",")]
        if single := next((ours.strip() for ours, sign, _ in pairs if not sign), ""):
            raise ValueError(f"“{single}” in the list of {name} is no pair such as left=L.")
        words = {ours.strip(): theirs.strip() for ours, _, theirs in pairs}
        _check_words(name, words)
        return _Reference(name, str, words=words)
    units = _units_of(name)
    if option not in units:
        raise ValueError(f"{name} cannot be given in “{option}”" + (f"; known are {', '.join(units)}." if units else ", since it has no unit."))
    return _Reference(name, float, units[option])


def _units_of(name):
    """{unit: how many of it make one of the field's own}, which the end of its name tells."""
    units = {"m": {"m": 1.0, "dm": 10.0, "cm": 100.0, "mm": 1000.0, "km": 0.001, "ft": 1 / FOOT, "ftUS": 1 / US_SURVEY_FOOT},
             "cm": {"m": 0.01, "cm": 1.0, "mm": 10.0}, "mm": {"m": 0.001, "cm": 0.1, "mm": 1.0},
             "m2": {"m2": 1.0, "cm2": 1e4, "ft2": 1 / FOOT**2}, "pct": {"%": 1.0, "1": 0.01}, "deg": {"deg": 1.0, "gon": 10 / 9, "rad": np.pi / 180}}
    return units.get(name.rpartition("_")[2] if "_" in name else "", {})


def _check_field(name, known, source):
    if name not in known:
        raise ValueError(f"{source} has no field {name}{_like(name, known)}.")


def _check_words(name, values):
    words = {key.removeprefix(f"{name}.") for key in vocabulary() if "." not in key or key.startswith(f"{name}.")}
    for value in values:
        if name in IN_WORDS and value not in words:
            raise ValueError(f"{value} is no {name} that Lanewright writes{_like(value, words)}.")


def _like(name, known):
    """The known name that is most like another, or else all of them."""
    names = {str(other).lower(): other for other in known}
    near = get_close_matches(name.lower(), names, 1)
    return f" (is {names[near[0]]} meant?)" if near else f"; known are {', '.join(sorted(known))}"


# The features of a map as the template has them.


class _ClientMap(NamedTuple):
    """What is handed over."""

    layers: Mapping[str, Features]   # the client's, by name, in the order of the template
    left_out: Mapping[str, int]   # features of our layers that no row takes, by layer and what they are


def apply_template(template: _Template, layers: Mapping[str, Features],
                   office: Mapping[str, tuple[str, Mapping[str, type]]] | None = None, whole: bool = True) -> _ClientMap:
    """The layers of the client. In each of them a feature of ours becomes what the first row that fits says.

    layers : ours, by name, in map coordinates in metres; rows about layers that are not given are passed over
    office : geometry and fields of the layers that the client's own file or database has, see `layers_of_client`; None where there is none
    whole : whether all layers must be there; otherwise those that are not are as the template says

    Raises RoadExtractionError if the client's file or database lacks a layer or field, or a value is none of its type.
    """
    taken: dict[str, set[int]] = {name: set() for name in layers}
    result: dict[str, Features] = {}
    for name in dict.fromkeys(rule.layer for rule in template.rules if rule.layer != NOT_WANTED):
        rules = [rule for rule in template.layer_of(name) if rule.source in layers]
        if not rules:
            continue
        types = _types(template, name, office if whole or name in (office or ()) else None)
        made = Features(GEOMETRIES[template.layer_of(name)[0].geometry], [Field(field, kind) for field, kind in types.items()])
        for source in dict.fromkeys(rule.source for rule in rules):
            made.crs = made.crs or layers[source].crs
            for k, (shape, row) in enumerate(layers[source]):
                rule = next((rule for rule in rules if rule.source == source and rule.holds(row)), None)
                if rule is not None:
                    taken[source].add(k)
                    row = {**row, NUMBER: len(made) + 1}
                    made.add(_as(rule.geometry, shape), **{field: _filled(template, rule, field, row, types[field]) for field in rule.cells})
        result[name] = made
    left: Counter[str] = Counter()
    for source in {rule.source: None for rule in template.rules if rule.source in layers}:
        unwanted = [rule for rule in template.layer_of(NOT_WANTED) if rule.source == source]
        for k, row in enumerate(layers[source].rows):
            if k not in taken[source] and not any(rule.holds(row) for rule in unwanted):
                left[" ".join(filter(None, (source, row.get("class") or row.get("kind") or row.get("type"), row.get("pattern"))))] += 1
    return _ClientMap(result, left)


def _types(template, name, office):
    """{field: type} of a layer of the client, its file's or else as the template says or its values are."""
    rules = template.layer_of(name)
    used = [field for field in template.types if any(field in rule.cells for rule in rules)]
    if office is None:
        return {field: template.types.get(field) or _type_of([rule.cells[field] for rule in rules if field in rule.cells]) for field in used}
    kind, fields = office.get(name, ("", {}))
    lacking = next((field for field in used if field not in fields), "")
    problem = ""
    if name not in office:
        problem = f"the client has no layer {name}{_like(name, office)}"
    elif kind not in ("", rules[0].geometry):
        problem = f"layer {name} of the client holds a {kind}, and a {rules[0].geometry} is to be written"
    elif lacking:
        problem = f"layer {name} of the client has no field {lacking}{_like(lacking, fields)}"
    if problem:
        raise RoadExtractionError(f"{template.path}, line {rules[0].line}: {problem}.")
    return {field: fields[field] for field in used}


def _type_of(cells):
    """The type that holds all values of cells: whole numbers, numbers or texts."""
    kinds = {str if len(cell) > 1 else cell[0].kind if isinstance(cell[0], _Reference) else int if WHOLE.fullmatch(cell[0]) else str
             for cell in cells}
    return int if kinds == {int} else float if kinds <= {int, float} else str


def _filled(template, rule, field, row, kind):
    """The value of a field of the client; None where ours has none."""
    values = [part.value(row) if isinstance(part, _Reference) else part for part in rule.cells[field]]
    value = values[0] if len(values) == 1 else "".join(map(_written, values))
    if value is None or kind is str:
        return None if value is None else _written(value)
    try:
        return round(float(value)) if kind is int else float(value)
    except ValueError:
        raise RoadExtractionError(f"{template.path}, line {rule.line}: {field} of {rule.layer} holds numbers, and “{value}” is none.") from None


def _written(value):
    """A value within a text: lengths to the millimetre."""
    return "" if value is None else f"{value:.3f}".rstrip("0").rstrip(".") if isinstance(value, float) else str(value)


def _as(kind, shape):
    """A shape as a point, line or polygon: the outline of an area, the middle of a line or area."""
    given = shape.geom_type
    if kind == "line" and given == "Polygon":
        return shapely.LineString(shape.exterior.coords)
    if kind == "point" and given != "Point":
        if given == "LineString":
            return shapely.line_interpolate_point(shape, 0.5, normalized=True)
        middle, heights = shapely.point_on_surface(shape), shapely.get_coordinates(shape, include_z=True)[:, 2]
        return shapely.Point(middle.x, middle.y, float(heights.mean()))
    return shape


# Files and databases with layers of their own.


class Database(NamedTuple):
    """A schema of a PostgreSQL database with PostGIS."""

    connection: str   # as libpq takes it; it may hold a password, so nobody is shown it
    schema: str
    name: str   # of the connection, for people

    def __str__(self):
        return f"{self.name}, schema {self.schema}"


@contextmanager
def _used(path, reading=False):
    """A context in which the client's layers are read or written; RoadExtractionError where they cannot be."""
    try:
        with gdal_exceptions():
            yield
    except ImportError as problem:
        raise RoadExtractionError("The GeoPackage of a client needs GDAL's Python module (osgeo), which is not installed. Install "
                                  "lanewright[gdal] with pip, or write a DXF drawing.") from problem
    except (RuntimeError, sqlite3.Error) as problem:
        reason = " ".join(str(problem).split())
        raise RoadExtractionError(f"{path} could not be read ({reason})." if reading else f"{path} could not be written ({reason}).") from problem


def _opened(path, flags=0):
    """The dataset of a GeoPackage or Database."""
    if not isinstance(path, Database):
        return gdal.OpenEx(str(path), gdal.OF_VECTOR | flags, allowed_drivers=["GPKG"])
    if gdal.GetDriverByName("PostgreSQL") is None:   # else GDAL would repeat the connection, password and all
        raise RuntimeError("GDAL is built without PostgreSQL")
    dataset = gdal.OpenEx(f"PG:{path.connection}", gdal.OF_VECTOR | flags, allowed_drivers=["PostgreSQL"], open_options=[
        f"SCHEMAS={path.schema}", f"ACTIVE_SCHEMA={path.schema}", "LIST_ALL_TABLES=YES"])
    schemas = dataset.ExecuteSQL("SELECT nspname FROM pg_namespace")
    if path.schema not in [row.GetField(0) for row in schemas]:
        raise RuntimeError(f"there is no schema {path.schema}")
    return dataset


def layers_of_client(path: str | os.PathLike[str] | Database, crs: str, template: _Template) -> dict[str, tuple[str, dict[str, type]]]:
    """{layer: (geometry, {field: type})} of the client's GeoPackage or database; the geometry is "" where the layer takes any.

    crs : WKT, metric, of the map; "" where unknown
    RoadExtractionError if it cannot be read, or a layer that the template fills is in another CRS.
    """
    ours, result = parse_crs(as_in_file(crs)[0]) if crs else None, {}
    with _used(path, reading=True):
        kinds = {ogr.wkbPoint: "point", ogr.wkbLineString: "line", ogr.wkbPolygon: "polygon", ogr.wkbMultiPoint: "point",
                 ogr.wkbMultiLineString: "line", ogr.wkbMultiPolygon: "polygon", ogr.wkbNone: "row without a place"}
        types = {ogr.OFTInteger: int, ogr.OFTInteger64: int, ogr.OFTReal: float}
        dataset = _opened(path)
        for k in range(dataset.GetLayerCount()):
            layer = dataset.GetLayer(k)
            theirs = layer.GetSpatialRef()
            if template.layer_of(layer.GetName()) and ours is not None and theirs is not None and not same_crs(parse_crs(theirs.ExportToWkt()), ours):
                raise RoadExtractionError(f"Layer {layer.GetName()} of {path} is in {theirs.GetName()}, and the map in {ours.name}. Give the "
                                          "client's layer the CRS of the map, or bring the map's layers to its CRS.")
            result[layer.GetName()] = kinds.get(ogr.GT_Flatten(layer.GetGeomType()), ""), {
                field.GetName(): types.get(field.GetType(), str) for field in layer.schema}
    return result


def write_client_layers(layers: Mapping[str, Features], path: str | Database, office: str = "") -> None:
    """Write a GeoPackage, in the units of the survey's own CRS; into a copy of the client's file, whose layers are filled, where there is one.

    Of a database, tables that are there are filled and others made: all of them, or none.
    RoadExtractionError if there is no GDAL that writes it, or the client's file or database does not take the features.
    """
    with _used(path):
        if office:
            # what a program that has it open keeps in a journal beside it is copied too
            with closing(sqlite3.connect(office)) as database, closing(sqlite3.connect(str(path))) as copy:
                database.backup(copy)
        dataset = _opened(path, gdal.OF_UPDATE) if office or isinstance(path, Database) \
            else gdal.GetDriverByName("GPKG").Create(path, 0, 0, 0, gdal.GDT_Unknown)
        there = {dataset.GetLayer(k).GetName() for k in range(dataset.GetLayerCount())}
        dataset.StartTransaction()
        try:
            for name, features in layers.items():
                layer = dataset.GetLayerByName(name) if name in there else _new_layer(dataset, name, features)
                _fill(layer, features)
            dataset.CommitTransaction()
        except (RoadExtractionError, RuntimeError):
            dataset.RollbackTransaction()   # at once: the error may keep the dataset alive
            raise
        dataset.FlushCache()   # what cannot be written when a dataset is let go, nobody is told
        layer = dataset = None


def _new_layer(dataset, name, features):
    package = dataset.GetDriver().ShortName == "GPKG"
    crs = osr.SpatialReference(as_in_file(features.crs)[0] if features.crs else UNDEFINED_CARTESIAN) if features.crs or package else None
    kinds = {"PointZ": ogr.wkbPoint25D, "LineStringZ": ogr.wkbLineString25D, "PolygonZ": ogr.wkbPolygon25D}
    # columns of the table itself, also where the client calls a field so
    taken = {field.name.lower() for field in features.schema}
    options = [f"{option}={'lanewright_' * (column in taken)}{column}" for option, column in (("FID", "fid"), ("GEOMETRY_NAME", "geom"))]
    as_they_are = [] if package else ["LAUNDER=NO", "EXTRACT_SCHEMA_FROM_LAYER_NAME=NO"]   # the client's names, with capitals and points
    layer = dataset.CreateLayer(name, crs, kinds[features.geometry_type], options + as_they_are)
    types = {int: ogr.OFTInteger64, float: ogr.OFTReal, str: ogr.OFTString}
    for field in features.schema:
        layer.CreateField(ogr.FieldDefn(field.name, types[field.type]))
    return layer


def _fill(layer, features):
    """Add features to a layer of an open file, as its kind of geometry has them: flat, or of one part in a layer of several."""
    units = as_in_file(features.crs)[1]
    kind = layer.GetGeomType()
    for shape, row in features:
        if not units.metric:
            shape = shapely.transform(shape, units.in_file, include_z=True)
        made = ogr.CreateGeometryFromWkb(shapely.to_wkb(shape, output_dimension=3, flavor="iso"))
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetGeometry(made if kind == ogr.wkbUnknown else ogr.ForceTo(made, kind))
        for name, value in row.items():
            if value is not None and not _stored(feature, name, value):
                raise RoadExtractionError(f"The field {name} of layer {layer.GetName()} does not take “{value}”: it is too long or large, or of "
                                          "another kind than the field. Change the template or the field.")
        layer.CreateFeature(feature)


def _stored(feature, name, value):
    """Set a field of a feature; whether it has the whole value then."""
    width = feature.GetFieldDefnRef(name).GetWidth()
    if isinstance(value, int) and abs(value) >= 2**63 or isinstance(value, str) and 0 < width < len(value):
        return False
    feature.SetField(name, value)
    stored = feature.GetField(name)
    return stored is not None and (stored == value or not isinstance(value, int))
