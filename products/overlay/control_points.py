"""Ground control points: places known in the image and on the map, from a table.

Columns are recognised by their names or, without names, by the size of the image; where the rows name images, only those of the image in hand are
used. Pixel and line count from the outer corner of the first pixel, whose middle is 0.5, 0.5. The QGIS georeferencer counts lines upward, as negative
numbers; this is recognised and converted.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path, PurePath
from typing import Any

import numpy as np

from ...core.common.errors import RoadExtractionError
from ...core.io.crs import NO_PLACE, in_metres, parse_crs, place_of_raster
from ...core.io.local_files import gdal_exceptions, open_raster
from ...core.io.text_table import as_number
from ...core.lazy import gdal

MAX_DEPARTURE = 0.1  # of the image's size: what a tilted camera over hilly ground differs from an image that is turned and scaled
CONTROL, CHECK, DISABLED = "control", "check", "disabled"  # roles of a point
_FALSE_TEXTS = ("0", "false", "no", "off", "n", "f")
_CHECK_TEXTS = ("check", "checkpoint", "check point", "chk", "cp", "test")
# what a column holds: its names, in plain small letters
COLUMN_ALIASES = {meaning: names.split() for meaning, names in re.findall(
    "(.+): (.+)", Path(__file__).with_name("column_names.txt").read_text(encoding="utf-8"))}
REQUIRED_COLUMNS = ("pixel", "line", "easting", "northing")
IMAGE_FILE = re.compile(r".\.(jpe?g|jp2|tiff?|png|dng|bmp|webp|img|vrt|raw|arw|cr2|nef)$", re.IGNORECASE)
# Orders of numbers in tables without a header: QGIS, ENVI and ERDAS keep four, OpenDroneMap has the height between them
NUMBER_ORDERS = (("pixel", "line", "easting", "northing"), ("easting", "northing", "pixel", "line"),
                 ("easting", "northing", "height", "pixel", "line"), ("pixel", "line", "easting", "northing", "height"))


@dataclass(frozen=True)
class ControlPoints:
    """N control points."""

    pixel: np.ndarray   # pixel, line: (N,) in the image, lines counted downward
    line: np.ndarray
    easting: np.ndarray   # easting, northing, height: (N,) m; height is NaN where it is unknown
    northing: np.ndarray
    height: np.ndarray
    names: tuple[str, ...]   # N texts
    roles: np.ndarray   # (N,) texts: "control" (used in the fit), "check" (compared with it) or "disabled"
    crs: str = ""   # WKT of the map coordinates, "" where unknown
    left_out: int = 0   # count of rows of the table without numbers

    def __len__(self) -> int:
        return len(self.pixel)

    def having(self, role: str) -> np.ndarray:
        """(M,) int, indices of the points with a role."""
        return np.flatnonzero(self.roles == role)

    def with_disabled_as_checks(self) -> ControlPoints:
        """The points, with the disabled ones as check points."""
        return replace(self, roles=np.where(self.roles == DISABLED, CHECK, self.roles))


def control_points(names: Sequence[Any] | None, rows: Sequence[Sequence[Any]], image: SourceImage, what: str,
                   crs: str = "") -> ControlPoints:
    """Control points of the rows of a table, texts or numbers, that belong to an image; `what` is the table's name for error messages.

    names : of the columns, or None where the table has no header
    crs : WKT of the map coordinates in the table, "" where unknown
    Raises RoadExtractionError if a needed column is missing, no row is of this image or has numbers, or the points lie outside the image.
    """
    if not rows:
        raise RoadExtractionError(f"{what} holds no control points. It needs a row for each: pixel, line, easting, northing.")
    rows = _rows_of_image(rows, image, None if names is None else _columns_named(names).get("image"), what)
    columns = _guess_columns(rows, image, what) if names is None else _find_columns(names, what)
    table = {key: _numbers(rows, columns.get(key)) for key in ("pixel", "line", "easting", "northing", "height")}
    complete = np.isfinite([table[key] for key in ("pixel", "line", "easting", "northing")]).all(axis=0)
    if not complete.any():
        raise RoadExtractionError(f"{what} holds no row with numbers for pixel, line, easting and northing. Write numbers with a decimal point (or a "
                                  "comma, where semicolons separate the columns).")
    usable = [row for row, good in zip(rows, complete) if good]
    roles = _roles(usable, columns)
    pixel, line = _in_the_image(table["pixel"][complete], table["line"][complete], roles != DISABLED, image, what)
    crs, units = in_metres(crs)
    easting, northing, height = units.in_metres(np.stack([table[key][complete] for key in ("easting", "northing", "height")], axis=1)).T
    names = tuple("name" in columns and _text(row, columns["name"]) or str(number) for number, row in enumerate(usable, 1))
    return ControlPoints(pixel, line, easting, northing, height, names, roles, crs, int((~complete).sum()))


def _plain(names):
    """Names of columns in small letters alone, without what stands in brackets."""
    return [re.sub(r"[^a-z]", "", re.sub(r"\(.*?\)|\[.*?\]", "", str(name).lower())) for name in names]


def _columns_named(names):
    """{meaning: column} by the names alone; the first alias that a table has is used."""
    plain = _plain(names)
    return {key: plain.index(alias) for key, aliases in reversed(COLUMN_ALIASES.items()) for alias in reversed(aliases) if alias in plain}


def _names_columns(fields: Sequence[str], least: int) -> bool:
    """Whether so many fields of a line are names of columns, which tells a header from other lines."""
    return len(set(_columns_named(fields)) - {"name", "role", "check", "enable", "image"}) >= least


def _rows_of_image(rows, image, column, what):
    """The rows that belong to the image in hand; all where no column names images."""
    def text(row, k):
        return str(row[k]).strip() if k < len(row) and row[k] is not None else ""

    # a name of a column is a hint; only names of files say that rows belong to several images
    widest = max(len(row) for row in rows)
    columns = range(widest) if column is None else [column]
    column = next((k for k in columns if 2 * sum(bool(IMAGE_FILE.search(text(row, k))) for row in rows) > len(rows)), None)
    if column is None:
        return rows
    wanted = PurePath(image.path)
    paths = [PurePath(text(row, column).replace("\\", "/")) for row in rows]
    for same in (lambda path: path.name == wanted.name,
                 lambda path: path.name.lower() == wanted.name.lower(), lambda path: path.stem.lower() == wanted.stem.lower()):
        kept = [row for row, path in zip(rows, paths) if same(path)]
        if kept:
            return kept
    images = sorted({path.name for path in paths})
    raise RoadExtractionError(
        f"{what} has no control point of {wanted.name}: its rows are of {', '.join(images[:3])}{' and others' if len(images) > 3 else ''}. "
        "Give the image under its own name, or the table of this image.")


def _find_columns(names: Sequence[Any], what: str) -> dict[str, int]:
    """Columns of a table with a header; those named only `x` and `y` are map coordinates, unless other columns have the names of these."""
    columns = _columns_named(names)
    plain = _plain(names)
    for bare, keys in (("x", ("easting", "pixel")), ("y", ("northing", "line"))):
        free = [key for key in keys if key not in columns]
        if bare in plain and free:
            columns[free[0]] = plain.index(bare)
    missing = [key for key in REQUIRED_COLUMNS if key not in columns]
    if missing:
        raise RoadExtractionError(f"{what} has the columns {', '.join(map(str, names))}; none of them was recognised as {' or '.join(missing)}. Name "
                                  "the columns pixel, line, easting, northing.")
    return columns


def _guess_columns(rows: Sequence[Sequence[Any]], image: SourceImage, what: str) -> dict[str, int]:
    """Columns of a table without a header: two columns lie in the image, and the two beside them do not."""
    width = min(len(row) for row in rows)
    values = np.array([[as_number(field) for field in row[:width]] for row in rows])
    texts = [{str(row[k]).strip() for row in rows} for k in range(width)]
    words = [k for k in range(width) if not np.isfinite(values[:, k]).any() and not texts[k] <= {"nan", "NaN", "-", ""}]
    numeric = [k for k in range(width) if k not in words]
    files = [k for k in words if any(map(IMAGE_FILE.search, texts[k]))]
    labels = [k for k in words if k not in files] or [k + 1 for k in files if k + 1 not in numeric and any(len(row) > k + 1 for row in rows)]
    fits = []
    for start, order in product((0, 1), NUMBER_ORDERS):  # a point's number may come first
        columns = dict(zip(order, numeric[start:]))
        if len(columns) < len(order) or not np.isfinite(values[:, [columns[key] for key in REQUIRED_COLUMNS]]).all():
            continue
        inside = image.holds(values[:, columns["pixel"]], np.abs(values[:, columns["line"]]), 1.0).all()
        outside = not image.holds(values[:, columns["easting"]], np.abs(values[:, columns["northing"]]), 1.0).all()
        if inside and outside:
            last = max(columns.values())
            further = {**({"name": labels[0]} if labels else {"name": numeric[0]} if start else {}),
                       **(_enable(values, last + 1) if last + 1 in numeric else {})}
            fits.append({**columns, **further})
    if len(fits) > 1:
        fits = _that_lies_like_an_image(fits, values, image)
    if len(fits) != 1:
        raise RoadExtractionError(f"The columns of {what} have no names, and their numbers do not show which are pixel and line in an image of "
                                  f"{image.width} by {image.height}. Put a line above them: pixel,line,easting,northing.")
    return fits[0]


def _that_lies_like_an_image(fits, values, image):
    """Of several readings of a table those that an image turned, scaled and sheared explains, the one with heights where they agree."""
    misses = []
    for fit in fits:
        pixel, line, easting, northing = (values[:, fit[key]] for key in REQUIRED_COLUMNS)
        ground = np.c_[np.ones(len(values)), easting - easting.mean(), northing - northing.mean()]
        positions = np.c_[pixel, line]
        misses.append(np.sqrt(np.mean((positions - ground @ np.linalg.lstsq(ground, positions, rcond=None)[0])**2)))
    near = [fit for fit, distance in zip(fits, misses) if distance <= min(misses) + 1e-6]
    # three points lie like an image in any order of the columns
    clear = len(values) > 3 and min(misses) < MAX_DEPARTURE * max(image.width, image.height)
    alike = all(fit[key] == near[0][key] for fit in near for key in REQUIRED_COLUMNS)
    return [max(near, key=len)] if alike and (clear or len(near) == len(fits)) else near if clear else fits


def _enable(values, column):
    """The fifth column of the QGIS georeferencer, zeros and ones, where there is one."""
    return {"enable": column} if column < values.shape[1] and np.isin(values[:, column], (0, 1)).all() else {}


def _numbers(rows, column):
    return np.array([np.nan if column is None else as_number(row[column] if column < len(row) else None) for row in rows])


def _in_the_image(pixel, line, used, image, what):
    """Pixel and line, with lines counted downward; source coordinates of an image with a position become pixels.

    Disabled points may lie anywhere, unless all points are disabled.
    """
    used = used if used.any() else np.ones(len(pixel), dtype=bool)
    margin = 1.0 + 0.02 * max(image.width, image.height)
    forms = [(pixel, -line) if np.median(line[used]) < 0 else (pixel, line)]
    if image.geotransform is not None:
        # QGIS writes map coordinates of the source where its image had a position
        forms.append(image.pixel_of(pixel, line))
    for columns, lines in forms:
        if image.holds(columns, lines, margin)[used].all():
            return columns, lines
    columns, lines = (axis[used] for axis in max(forms, key=lambda form: image.holds(*form, margin)[used].sum()))
    outside = int((~image.holds(columns, lines, margin)).sum())
    raise RoadExtractionError(f"{outside} of {len(columns)} points of {what} lie outside the image: pixels run from {columns.min():.0f} to "
                              f"{columns.max():.0f} and lines from {lines.min():.0f} to {lines.max():.0f}, the image has {image.width} by "
                              f"{image.height}. Do they belong to another image or to another size of it, or are pixel and line swapped?")


def _text(row, column):
    value = row[column] if column < len(row) else None
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    return "" if value is None else str(value).strip()


def _roles(rows, where):
    roles = np.full(len(rows), CONTROL, dtype="U8")
    for number, row in enumerate(rows):
        role = _text(row, where["role"]).lower() if "role" in where else ""
        check = _text(row, where["check"]).lower() if "check" in where else ""
        if role in _CHECK_TEXTS or (check and check not in _FALSE_TEXTS):
            roles[number] = CHECK
        if role.startswith(("disab", "off", "unused")) or ("enable" in where and _text(row, where["enable"]).lower() in _FALSE_TEXTS):
            roles[number] = DISABLED
    return roles


# Files of ground control points: where their table begins, and in which CRS it is.
#
# `.points` of the QGIS georeferencer in its old and new forms, `gcp_list.txt` of OpenDroneMap, ENVI's `.pts`, and CSV with any delimiter. A CRS may
# stand above the table, with or without a word before it.

MAX_TABLE_BYTES = 20_000_000  # a table of control points has a few thousand bytes
COMMENT = re.compile(r"^(#|//|%|;|!)+\s*")
CRS_LABEL = re.compile(r"^(crs|srs|coordinate\s?system|projection)\s*[:=]\s*", re.IGNORECASE)
# A CRS by its number, as PROJ text or as WKT
CRS_CODE = re.compile(r"^(epsg|esri|iau\w*|urn|https?)\s*:|^\+(proj|init)|^(proj|geog|geoc|comp|bound)(cs|d_cs|crs)\s*\[", re.IGNORECASE)
# A CRS by its name: a datum or projection that surveyors use
CRS_NAME = re.compile(r"\b(wgs|utm|etrs|nad|gda|jgd|cgcs|sirgas|dhdn|osgb|rgf|mgi|gauss|lambert|mercator|zone)", re.IGNORECASE)
UTM_WORDS = re.compile(r"^(?P<datum>[a-z]+[ _]?\d+)[\s_/,-]*utm[\s_/,-]*(zone)?[\s_/,-]*(?P<zone>\d{1,2})\s*(?P<half>[NS])\b", re.IGNORECASE)


def read_control_points(path: str | Path, image: SourceImage, crs: str = "") -> ControlPoints:
    """Control points of a file.

    path : `.points` of the QGIS georeferencer (with or without a line "#CRS: ..."; mapX, mapY, sourceX, sourceY or pixelX, pixelY; commas or, from
        QGIS 1, tabs), `gcp_list.txt` (the CRS in its first line, then x, y, z, pixel, line and image in each row), or a CSV or TXT table
    image : SourceImage that the points belong to; rows that name another image are passed over
    crs : WKT of the map coordinates where the file names none
    Raises RoadExtractionError if the file cannot be read, its columns or its CRS are not recognised, or no row is of this image.
    """
    lines, named = _lines(path)
    delimiter = _delimiter(lines)
    rows = [[field.strip() for field in row] for row in csv.reader(lines, delimiter=delimiter, skipinitialspace=True)]
    rows = [[field for field in row if field] if delimiter == " " else row for row in rows]
    rows = [row for row in rows if any(row)]
    header = None
    if rows and sum(as_number(field) == as_number(field) for field in rows[0]) < 2:
        header, rows = rows[0], rows[1:]
    return control_points(header, rows, image, str(path), _wkt(named, path) or crs)


def _lines(path):
    """The lines of the table, and the CRS given above it."""
    named, lines = "", []
    for line in _file_text(path).splitlines():
        bare = COMMENT.sub("", line.strip()).strip()
        labelled = CRS_LABEL.match(bare)
        if labelled:
            named = named or bare[labelled.end():].strip()
        elif not lines and not named and (CRS_CODE.match(bare) or bare == line.strip() and _is_named_crs(bare)):
            named = bare
        elif bare and (bare == line.strip() or (not lines and _delimiter([bare]) != " " and _names_columns(re.split("[;\t,]", bare), 3))):
            lines.append(bare)  # a header may be written as a comment
    return lines, named


def _file_text(path):
    try:
        if Path(path).stat().st_size > MAX_TABLE_BYTES:
            raise RoadExtractionError(f"{path} is too large for a table of control points. Was the image given instead?")
        data = Path(path).read_bytes()
    except OSError as problem:
        raise RoadExtractionError(f"{path} cannot be read ({problem.strerror or problem}). Check the path and the rights to read it.") from problem
    if b"\0" in data and data[:2] not in (b"\xff\xfe", b"\xfe\xff"):
        raise RoadExtractionError(f"{path} is no text. Control points are read from a .points or CSV file.")
    return data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig", "replace")


def _is_named_crs(line):
    """Whether a line above the table is the name of a CRS and neither a row nor a header."""
    fields = re.split(r"[;\t,\s]+", line)
    return bool(CRS_NAME.search(line)) and not _names_columns(fields, 2) and sum(as_number(field) == as_number(field) for field in fields) < 3


def _delimiter(lines):
    """Delimiter of the first line; a comma beside semicolons or tabs is a decimal comma."""
    first = next(iter(lines), "")
    return next((mark for mark in (";", "\t", ",") if mark in first), " ")


def _wkt(named, path):
    """WKT of the CRS that a file names, "" where it names none."""
    if not named:
        return ""
    # OpenDroneMap writes "WGS84 UTM 32N" for what EPSG calls "WGS 84 / UTM zone 32N"
    words = UTM_WORDS.match(named)
    try:
        crs: Any = parse_crs(f"{words['datum'].replace('_', ' ')} / UTM zone {int(words['zone'])}{words['half'].upper()}" if words else named)
        return crs.to_wkt()
    except RoadExtractionError as problem:
        raise RoadExtractionError(f"{path} names a CRS that is not understood: {named[:60]!r}. Correct that line (EPSG:number) or remove it "
                                  "and give the CRS.") from problem


# The image to be georeferenced: any raster that GDAL reads, with or without a position on the map.

@dataclass(frozen=True)
class SourceImage:
    """What is known about an image without reading its pixels."""

    path: str   # of the file
    width: int   # width, height: pixels
    height: int
    geotransform: tuple[float, ...] | None = None   # six numbers as in GDAL, or None where the image has no position on the map
    crs: str = ""   # WKT, "" where the image has none
    bands: int = 1   # count, including an alpha band
    has_alpha: bool = False   # whether the last band is an alpha band
    palette: bool = False   # whether the values are indices of a colour table
    kind: str = "byte"   # "byte", "integer" or "real", type of the values
    nodata: float | None = None   # value of pixels without data, or None

    def pixel_of(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pixel and line, (N,) each, of map coordinates (N,) m, by the position of the image itself; ValueError if it has none."""
        if self.geotransform is None:
            raise ValueError("the image has no position")
        x0, xp, xl, y0, yp, yl = self.geotransform
        turn = np.linalg.inv(np.array([[xp, xl], [yp, yl]]))
        pixel, line = turn @ np.stack([np.asarray(x, float) - x0, np.asarray(y, float) - y0])
        return pixel, line

    def holds(self, pixel: np.ndarray, line: np.ndarray, margin: float = 0.0) -> np.ndarray:
        """(N,) bool, whether (N,) places lie in the image or at most `margin` pixels beside it."""
        return (pixel >= -margin) & (pixel <= self.width + margin) & (line >= -margin) & (line <= self.height + margin)


@gdal_exceptions()
def open_image(path: str | Path) -> SourceImage:
    """The description of an image file that GDAL reads; RoadExtractionError if there is none, or it is no raster with bands."""
    if not Path(path).is_file():
        raise RoadExtractionError(f"There is no file {path}. Give the image itself (TIFF, JPEG or PNG).")
    dataset = open_raster(path)
    if dataset.RasterCount == 0:
        raise RoadExtractionError(f"{path} is a container of several images. Give one of them, or export it as a TIFF.")
    transform, crs = place_of_raster(dataset)
    transform = None if transform == NO_PLACE else transform
    first, last = dataset.GetRasterBand(1), dataset.GetRasterBand(dataset.RasterCount)
    kind = ("byte" if first.DataType == gdal.GDT_Byte else
            "real" if first.DataType in (gdal.GDT_Float32, gdal.GDT_Float64) else "integer")
    return SourceImage(
        str(path), dataset.RasterXSize, dataset.RasterYSize, transform, crs, dataset.RasterCount,
        dataset.RasterCount > 1 and last.GetColorInterpretation() == gdal.GCI_AlphaBand,
        first.GetColorTable() is not None and dataset.RasterCount == 1, kind, first.GetNoDataValue())
