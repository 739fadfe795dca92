"""Are two folders of results the same? For example those of tools/survey_results.sh before and after a change of the code.

Compared are all files in both folders and the folders within:

    .gpkg        every layer: CRS, fields, number and order of the features, every coordinate, every attribute
    .tif         size, bands, geotransform, CRS, nodata value, every cell
    .laz, .las   version, point format, scale, offset, CRS, every dimension of every point
    .html, .txt  reports and logs, which hold times and dates: only that they are there
    .qml         styles, and those within a GeoPackage: only that they are there, since QGIS writes random ids and colours into them
    others       every byte

One line a file; what differs is named, with the largest difference and the first places. The exit code is 0 when all is the same,
1 when something differs and 2 when there is nothing to compare.
"""

import argparse
import re
import sys
from collections import Counter
from pathlib import Path

import laspy
import lazrs
import numpy as np
import shapely
from osgeo import gdal, ogr

gdal.UseExceptions()
ogr.UseExceptions()

# Written beside a file by whoever opens it
SIDECARS = (".aux.xml", ".gpkg-wal", ".gpkg-shm", ".gpkg-journal")
NEVER_TWICE_THE_SAME = (".html", ".txt", ".qml")
STYLES = "layer_styles"
DAMAGED = (OSError, RuntimeError, laspy.errors.LaspyException, lazrs.LazrsError)
NAMED = 3           # places that are named
AT_ONCE = 1_000_000  # points or cells
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def compare_folders(first, second, tolerance=0.0, only=()):
    """What differs between the files of two folders.

    Parameters
    ----------
    tolerance : float; coordinates (m), cells, attributes and dimensions may differ by so much and count as the same
    only : names of folders within the two; nothing else is compared. Empty: everything

    Returns
    -------
    dict : path within the folders to a list of differences in words, empty for a file that is the same
    """
    first, second = Path(first), Path(second)
    found = {}
    for path in sorted(_files(first) | _files(second)):
        if only and path.parts[0] not in only:
            continue
        if not (second / path).exists():
            found[path] = ["only in the first folder"]
        elif not (first / path).exists():
            found[path] = ["only in the second folder"]
        else:
            found[path] = compare_files(first / path, second / path, tolerance)
    return found


def _files(folder):
    return {path.relative_to(folder) for path in folder.rglob("*") if path.is_file() and not path.name.endswith(SIDECARS)}


def compare_files(first, second, tolerance=0.0):
    """What differs between two files of one kind: a list of differences in words, empty when they are the same."""
    kind = first.suffix.lower()
    if kind in NEVER_TWICE_THE_SAME:
        return []
    compare = {".gpkg": _geopackages, ".tif": _rasters, ".laz": _clouds, ".las": _clouds}.get(kind)
    if compare is None:
        return [] if first.read_bytes() == second.read_bytes() else ["other bytes"]
    opened = {".gpkg": _open_vector, ".tif": gdal.Open}.get(kind, laspy.open)
    try:
        return compare(*(opened(str(path)) for path in (first, second)), tolerance)
    except DAMAGED as error:
        return [f"one of them cannot be read: {error}"]


def _unlike(what, first, second):
    return [] if first == second else [f"{what} {first} and {second}"]


def _by(largest, unit=""):
    """The largest difference in words; nothing where there is none in numbers."""
    return f" by up to {largest:.6g}{unit}" if np.isfinite(largest) and largest > 0 else ""


def _places(places, total):
    named = ", ".join(map(str, places[:NAMED]))
    return named + (" and others" if total > NAMED else "")


# Vectors

def _open_vector(path):
    return gdal.OpenEx(path, gdal.OF_VECTOR)


def _geopackages(first, second, tolerance):
    names = [[source.GetLayer(k).GetName() for k in range(source.GetLayerCount())] for source in (first, second)]
    told = []
    for name in dict.fromkeys(names[0] + names[1]):
        if name not in names[1] or name not in names[0]:
            told.append(f"layer {name} only in the {'first' if name in names[0] else 'second'}")
        elif name != STYLES:
            layers = [source.GetLayerByName(name) for source in (first, second)]
            told += [f"layer {name}: {what}" for what in _layers(*layers, tolerance)]
    return told


def _layers(first, second, tolerance):
    layers = (first, second)
    told = _unlike("geometry type", *(ogr.GeometryTypeToName(layer.GetGeomType()) for layer in layers))
    told += _same_crs(*(layer.GetSpatialRef() for layer in layers))
    fields = [{field.GetName(): field.GetTypeName() for field in layer.schema} for layer in layers]
    for name in dict.fromkeys([*fields[0], *fields[1]]):
        if name not in fields[0] or name not in fields[1]:
            told.append(f"field {name} only in the {'first' if name in fields[0] else 'second'}")
        else:
            told += _unlike(f"field {name} is", fields[0][name], fields[1][name])
    common = [name for name in fields[0] if name in fields[1]]
    if not told:
        told += _unlike("order of fields", *(", ".join(names) for names in fields))
    features = [[_feature(feature, common) for feature in layer] for layer in layers]
    return told + _features(*features, common, tolerance)


def _same_crs(first, second):
    if (first is None) != (second is None):
        return [f"CRS only in the {'second' if first is None else 'first'}"]
    if first is None or first.IsSame(second) and first.ExportToWkt() == second.ExportToWkt():
        return []
    return _unlike("CRS", first.GetName(), second.GetName()) or [f"CRS {first.GetName()} in other words"]


def _feature(feature, fields):
    """(ISO WKB or None, values of the fields): alike for features that are alike."""
    geometry = feature.GetGeometryRef()
    values = (feature.GetField(name) for name in fields)
    return (None if geometry is None else bytes(geometry.ExportToIsoWkb()),
            tuple(tuple(value) if isinstance(value, list) else bytes(value) if isinstance(value, bytearray) else value for value in values))


def _features(first, second, fields, tolerance):
    if len(first) != len(second):
        told = [f"{len(first)} and {len(second)} features"]
        for which, features, others in (("first", first, second), ("second", second, first)):
            places = _without_partner(features, others)
            if places:
                told.append(f"{len(places)} only in the {which}: feature {_places(places, len(places))}")
        return told
    unlike, largest, told = {}, {}, {}
    for number, (one, other) in enumerate(zip(first, second), 1):
        if one == other:
            continue
        for what, difference, words in _pair(one, other, fields, tolerance):
            unlike.setdefault(what, []).append(number)
            largest[what] = max(largest.get(what, 0.0), difference)
            told.setdefault(what, words)
    if unlike and Counter(map(repr, first)) == Counter(map(repr, second)):
        return [f"the same features in another order, from feature {min(map(min, unlike.values()))} on"]
    return [f"{what} of {len(places)} of {len(first)} features differ{_by(largest[what], ' m' if what == 'coordinates' else '')}"
            f" (feature {_places(places, len(places))}{told[what]})" for what, places in unlike.items()]


def _without_partner(features, others):
    """Numbers, from 1, of the features that are not among the others; of several alike the last ones."""
    left = Counter(map(repr, others))
    places = []
    for number, feature in enumerate(map(repr, features), 1):
        left[feature] -= 1
        if left[feature] < 0:
            places.append(number)
    return places


def _pair(one, other, fields, tolerance):
    """(what, largest difference, words) for everything that differs between two features in one place."""
    if one[0] != other[0]:
        difference, words = _geometries(one[0], other[0])
        if words or not difference <= tolerance:
            yield "coordinates", difference, words
    for name, a, b in zip(fields, one[1], other[1]):
        difference = _values(a, b)
        if not difference <= tolerance:
            yield name, difference, "" if np.isfinite(difference) else f": {_short(a)} and {_short(b)}"


def _geometries(one, other):
    """Largest distance (m) between vertices in one place, or how the geometries are built otherwise, in words."""
    if one is None or other is None:
        return np.inf, f": no geometry in the {'first' if one is None else 'second'}"
    one, other = shapely.from_wkb([one, other])
    if _structure(one) != _structure(other):
        counts = [shapely.get_num_coordinates(geometry) for geometry in (one, other)]
        words = f": {counts[0]} and {counts[1]} vertices" if counts[0] != counts[1] else ": other parts"
        return float(np.nan_to_num(shapely.hausdorff_distance(one, other), nan=np.inf)), words
    a, b = (shapely.get_coordinates(geometry, include_z=True) for geometry in (one, other))
    apart = np.where((a == b) | np.isnan(a) & np.isnan(b), 0.0, np.abs(a - b))
    return float(np.nan_to_num(np.sqrt((apart**2).sum(axis=1)), nan=np.inf).max(initial=0.0)), ""


def _structure(geometry):
    """The geometry without the values of its coordinates: type, parts, rings, numbers of vertices."""
    return shapely.transform(geometry, np.zeros_like, include_z=bool(shapely.has_z(geometry))).wkb


def _values(a, b):
    """How far two attributes are apart: 0 when they are the same, infinite when they are no numbers.

    Texts that differ in numbers only, such as parameters of a curve in JSON, are as far apart as the numbers.
    """
    if a == b or a != a and b != b:
        return 0.0
    if isinstance(a, (int, float)) and isinstance(b, (int, float)):
        return float(np.nan_to_num(abs(a - b), nan=np.inf))
    if isinstance(a, str) and isinstance(b, str) and NUMBER.split(a) == NUMBER.split(b):
        apart = [abs(float(x) - float(y)) for x, y in zip(NUMBER.findall(a), NUMBER.findall(b))]
        return max(apart) or np.inf
    return np.inf


def _short(value):
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "…"


# Rasters

def _rasters(first, second, tolerance):
    both = (first, second)
    told = _unlike("size", *(f"{r.RasterXSize} x {r.RasterYSize}" for r in both))
    told += _unlike("number of bands", *(r.RasterCount for r in both))
    alike = not told
    told += _unlike("geotransform", *(r.GetGeoTransform(can_return_null=True) for r in both))
    told += _same_crs(*(r.GetSpatialRef() for r in both))
    if alike:
        for number in range(1, first.RasterCount + 1):
            told += _bands(*(r.GetRasterBand(number) for r in both), number, tolerance)
    return told


def _bands(first, second, number, tolerance):
    told, nodata = [], [band.GetNoDataValue() for band in (first, second)]
    if not _values(*nodata) == 0:
        told.append(f"nodata value of band {number} {nodata[0]} and {nodata[1]}")
    told += _unlike(f"data type of band {number}", *(gdal.GetDataTypeName(band.DataType) for band in (first, second)))
    rows, count, largest, places = max(1, AT_ONCE // first.XSize), 0, 0.0, []
    for top in range(0, first.YSize, rows):
        height = min(rows, first.YSize - top)
        a, b = (band.ReadAsArray(0, top, first.XSize, height) for band in (first, second))
        unlike, apart = _apart(a, b, tolerance)
        # a cell with a value in one and none in the other: how far it is from -9999 says nothing
        empty = [cells == value if value is not None else np.zeros(cells.shape, bool) for cells, value in zip((a, b), nodata)]
        apart = np.where(empty[0] != empty[1], 0.0, apart)
        if unlike.any():
            count, largest = count + int(unlike.sum()), max(largest, float(apart[unlike].max()))
            row, column = np.nonzero(unlike)
            places += [f"column {c}, row {r + top}" for c, r in zip(column[:NAMED], row[:NAMED])]
    if count:
        told.append(f"{count} of {first.XSize * first.YSize} cells of band {number} differ{_by(largest)} ({'; '.join(places[:NAMED])})")
    return told


def _apart(a, b, tolerance):
    """Where two arrays differ by more than the tolerance, and by how much (0 where one of the two is no number)."""
    unlike = (a != b) & ~((a != a) & (b != b))
    with np.errstate(invalid="ignore"):
        apart = np.abs(np.asarray(a, np.float64) - np.asarray(b, np.float64))
        if tolerance > 0:
            unlike &= ~(apart <= tolerance)
    return unlike, np.where(np.isfinite(apart), apart, 0.0)


# Point clouds

def _clouds(first, second, tolerance):
    with first, second:
        headers = [reader.header for reader in (first, second)]
        told = _unlike("version", *(str(h.version) for h in headers))
        told += _unlike("point format", *(h.point_format.id for h in headers))
        told += _unlike("scale", *(tuple(map(float, h.scales)) for h in headers))
        told += _unlike("offset", *(tuple(map(float, h.offsets)) for h in headers))
        told += _same_cloud_crs(*(h.parse_crs() for h in headers))
        names = [list(h.point_format.dimension_names) for h in headers]
        for name in dict.fromkeys(names[0] + names[1]):
            if name not in names[0] or name not in names[1]:
                told.append(f"dimension {name} only in the {'first' if name in names[0] else 'second'}")
        if headers[0].point_count != headers[1].point_count:
            return [*told, f"{headers[0].point_count} and {headers[1].point_count} points"]
        return told + _points(first, second, [name for name in names[0] if name in names[1]], tolerance)


def _same_cloud_crs(first, second):
    wkt = ["no" if crs is None else crs.to_wkt() for crs in (first, second)]
    if wkt[0] == wkt[1]:
        return []
    return _unlike("CRS", *("none" if crs is None else crs.name for crs in (first, second))) or ["CRS in other words"]


def _points(first, second, dimensions, tolerance):
    counts, largest, places, begin = Counter(), Counter(), {}, 0
    for one, other in zip(first.chunk_iterator(AT_ONCE), second.chunk_iterator(AT_ONCE)):
        for name in dimensions:
            unlike, apart = _coordinates(one, other, name, tolerance) if name in "XYZ" else \
                _apart(np.asarray(one[name]), np.asarray(other[name]), tolerance)
            if unlike.ndim > 1:
                unlike, apart = unlike.any(axis=1), apart.max(axis=1)
            if unlike.any():
                counts[name] += int(unlike.sum())
                largest[name] = max(largest[name], float(apart[unlike].max()))
                places.setdefault(name, []).extend((begin + 1 + np.flatnonzero(unlike)[:NAMED]).tolist())
        begin += len(one)
    return [f"{name.lower() if name in 'XYZ' else name} of {counts[name]} of {begin} points differ"
            f"{_by(largest[name], ' m' if name in 'XYZ' else '')} (point {_places(places[name], counts[name])})" for name in counts]


def _coordinates(one, other, name, tolerance):
    """As _apart, in metres. Whole steps of the scale are compared where both have the same one: they are exact."""
    axis = "XYZ".index(name)
    scale, offset = ([float(getattr(points, what)[axis]) for points in (one, other)] for what in ("scales", "offsets"))
    if scale[0] == scale[1] and offset[0] == offset[1]:
        steps = np.abs(np.asarray(one[name], np.int64) - np.asarray(other[name], np.int64))
        apart = steps * scale[0]
        return (steps > 0) & ~(apart <= tolerance), apart
    return _apart(np.asarray(one[name.lower()]), np.asarray(other[name.lower()]), tolerance)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="tools/compare_results.sh", description="Are two folders of results the same?")
    parser.add_argument("first", type=Path)
    parser.add_argument("second", type=Path)
    parser.add_argument("--tolerance", type=float, default=0.0,
                        help="coordinates (m), cells, attributes and dimensions may differ by so much (default: 0, all must be the same)")
    parser.add_argument("--only", default="", metavar="NAME,NAME", help="these folders within the two alone, such as those of some surveys")
    options = parser.parse_args(arguments)
    for folder in (options.first, options.second):
        if not folder.is_dir():
            parser.error(f"{folder} is not a folder.")
    if not options.tolerance >= 0:
        parser.error(f"--tolerance is {options.tolerance}; it must be 0 or more.")
    only = [name for name in options.only.split(",") if name]
    found = compare_folders(options.first, options.second, options.tolerance, only)
    for name in only:
        if not any(path.parts[0] == name for path in found):
            parser.error(f"Neither {options.first} nor {options.second} holds results in a folder {name}.")
    if not found:
        parser.error(f"{options.first} and {options.second} hold no files.")
    words = Counter()
    for path, told in found.items():
        word = "different" if told else "present" if path.suffix.lower() in NEVER_TWICE_THE_SAME else "same"
        words[word] += 1
        print(f"{word:<10} {path}" + ": " * bool(told) + "; ".join(told))
    different = words["different"]
    print(f"{words['same']} files are the same, {different} differ; of {words['present']} only the presence was checked.")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
