"""Ground control points: places known in the image and on the map, from a table or a file.

Files are `.points` of the QGIS georeferencer, in its old and new forms, and CSV with any delimiter. Columns are recognised
by their names or, without names, by the size of the image. Pixel and line count from the outer corner of the
first pixel, whose middle is 0.5, 0.5. The QGIS georeferencer counts lines upward, as negative numbers; this
is recognised and converted.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..common.errors import RoadExtractionError
from ..io.units import in_metres
from .source_image import SourceImage

MAX_TABLE_BYTES = 20_000_000  # a table of control points has a few thousand bytes
CONTROL, CHECK, DISABLED = "control", "check", "disabled"  # roles of a point
_FALSE_TEXTS = ("0", "false", "no", "off", "n", "f")
_CHECK_TEXTS = ("check", "checkpoint", "check point", "chk", "cp", "test")
COLUMN_ALIASES = {
    "pixel": "pixel pixelx sourcex srcx column col sample px imagex imgx imx xpixel ximage xsource u".split(),
    "line": "line pixely sourcey srcy row py imagey imgy imy ypixel yimage ysource v".split(),
    "easting": "mapx easting east e geox worldx utme xmap xworld rechtswert rw".split(),
    "northing": "mapy northing north n geoy worldy utmn ymap yworld hochwert hw".split(),
    "height": "mapz z h geoz height elevation elev altitude alt".split(),
    "name": "name point id pointid label gcp gcpname gcpid number no nr".split(),
    "enable": "enable enabled active use used accepted".split(),
    "role": "role type".split(),
    "check": "check ischeck checkpoint".split(),
}
REQUIRED_COLUMNS = ("pixel", "line", "easting", "northing")


@dataclass(frozen=True)
class ControlPoints:
    """N control points.

    Attributes
    ----------
    pixel, line : (N,) in the image, lines counted downward
    easting, northing, height : (N,) m; height is NaN where it is unknown
    names : N texts
    roles : (N,) texts: "control" (used in the fit), "check" (compared with it) or "disabled"
    crs : WKT of the map coordinates, "" where unknown
    left_out : count of rows of the table without numbers
    """

    pixel: np.ndarray
    line: np.ndarray
    easting: np.ndarray
    northing: np.ndarray
    height: np.ndarray
    names: tuple[str, ...]
    roles: np.ndarray
    crs: str = ""
    left_out: int = 0

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
    """Control points of a table.

    Parameters
    ----------
    names : of the columns, or None where the table has no header
    rows : of texts or numbers
    image : SourceImage that the points belong to
    what : name of the table for error messages
    crs : WKT of the map coordinates in the table, "" where unknown

    Returns
    -------
    ControlPoints

    Raises
    ------
    RoadExtractionError
        If a needed column is missing, no row has numbers, or the points lie outside the image.
    """
    if not rows:
        raise RoadExtractionError(f"{what} holds no control points. It needs a row for each: pixel, line, easting, northing.")
    where = guess_columns(rows, image, what) if names is None else find_columns(names, what)
    table = {key: _numbers(rows, where.get(key)) for key in ("pixel", "line", "easting", "northing", "height")}
    known = np.isfinite([table[key] for key in ("pixel", "line", "easting", "northing")]).all(axis=0)
    if not known.any():
        raise RoadExtractionError(
            f"{what} holds no row with numbers for pixel, line, easting and northing. "
            "Write numbers with a decimal point (or a comma, where semicolons separate the columns).")
    usable = [row for row, good in zip(rows, known) if good]
    roles = _roles(usable, where)
    pixel, line = _in_the_image(table["pixel"][known], table["line"][known], roles != DISABLED, image, what)
    crs, units = in_metres(crs)
    easting, northing, height = units.in_metres(np.stack([table[key][known] for key in ("easting", "northing", "height")], axis=1)).T
    return ControlPoints(pixel, line, easting, northing, height, _names(usable, where.get("name")), roles, crs, int((~known).sum()))


def read_control_points(path: str | Path, image: SourceImage, crs: str = "") -> ControlPoints:
    """Control points of a file.

    Parameters
    ----------
    path : `.points` of the QGIS georeferencer (with or without a line "#CRS: ..."; mapX, mapY, sourceX, sourceY or
        pixelX, pixelY; commas or, from QGIS 1, tabs), or a CSV or TXT table
    image : SourceImage that the points belong to
    crs : WKT of the map coordinates where the file names none

    Returns
    -------
    ControlPoints

    Raises
    ------
    RoadExtractionError
        If the file cannot be read, or its columns or its CRS are not recognised.
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
    try:
        if Path(path).stat().st_size > MAX_TABLE_BYTES:
            raise RoadExtractionError(f"{path} is too large for a table of control points. Was the image given instead?")
        data = Path(path).read_bytes()
    except OSError as problem:
        raise RoadExtractionError(
            f"{path} cannot be read ({problem.strerror or problem}). Check the path and the rights to read it.") from problem
    if b"\0" in data and data[:2] not in (b"\xff\xfe", b"\xfe\xff"):
        raise RoadExtractionError(f"{path} is no text. Control points are read from a .points or CSV file.")
    text = data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig", "replace")
    named, lines = "", []
    for line in text.splitlines():
        bare = line.strip()
        if bare.startswith("#"):
            words = bare.lstrip("# ")
            if words.lower().startswith("crs:"):
                named = words[4:].strip()
                continue
            # A header may be written as a comment
            if _delimiter([words]) == " " or not any(word.strip().lower().replace("_", "") in COLUMN_ALIASES["easting"] + COLUMN_ALIASES["pixel"]
                                                     for word in words.split(_delimiter([words]))):
                continue
            bare = words
        if bare:
            lines.append(bare)
    return lines, named


def _delimiter(lines):
    """Delimiter of the first line; a comma beside semicolons or tabs is a decimal comma."""
    first = next(iter(lines), "")
    return next((mark for mark in (";", "\t", ",") if mark in first), " ")


def _wkt(named, path):
    """WKT of the CRS that a file names, "" where it names none."""
    from ..io.crs import parse_crs

    if not named:
        return ""
    try:
        return parse_crs(named).to_wkt()
    except RoadExtractionError as problem:
        raise RoadExtractionError(f"{path} names a CRS that is not understood: {named[:60]!r}. "
                                  "Correct its first line (#CRS: EPSG:number) or remove it and give the CRS.") from problem


def find_columns(names: Sequence[Any], what: str) -> dict[str, int]:
    """Columns of a table with a header.

    Columns named only `x` and `y` are map coordinates, unless other columns have the names of these.

    Parameters
    ----------
    names : of the columns
    what : name of the table for error messages

    Returns
    -------
    dict of meaning (a key of COLUMN_ALIASES) to index of the column

    Raises
    ------
    RoadExtractionError
        If pixel, line, easting or northing has no column.
    """
    plain = [re.sub(r"[^a-z]", "", re.sub(r"\(.*?\)|\[.*?\]", "", str(name).lower())) for name in names]
    found = {}
    for key, aliases in COLUMN_ALIASES.items():
        places = [plain.index(alias) for alias in aliases if alias in plain]
        if places:
            found[key] = places[0]
    for bare, keys in (("x", ("easting", "pixel")), ("y", ("northing", "line"))):
        free = [key for key in keys if key not in found]
        if bare in plain and free:
            found[free[0]] = plain.index(bare)
    missing = [key for key in REQUIRED_COLUMNS if key not in found]
    if missing:
        raise RoadExtractionError(
            f"{what} has the columns {', '.join(map(str, names))}; none of them was recognised as {' or '.join(missing)}. "
            "Name the columns pixel, line, easting, northing.")
    return found


def guess_columns(rows: Sequence[Sequence[Any]], image: SourceImage, what: str) -> dict[str, int]:
    """Columns of a table without a header: two columns lie in the image, and the two beside them do not.

    Parameters
    ----------
    rows : of the table
    image : SourceImage
    what : name of the table for error messages

    Returns
    -------
    dict of meaning (a key of COLUMN_ALIASES) to index of the column

    Raises
    ------
    RoadExtractionError
        If both orders are possible, or neither.
    """
    width = min(len(row) for row in rows)
    values = np.array([[as_number(field) for field in row[:width]] for row in rows])
    fits = []
    for start in (0, 1):  # a point's name may come first
        if start + 4 > width or not np.isfinite(values[:, start:start + 4]).all():
            continue
        first, second = values[:, start:start + 2], values[:, start + 2:start + 4]
        for order, pair, other in ((("pixel", "line", "easting", "northing"), first, second),
                                   (("easting", "northing", "pixel", "line"), second, first)):
            inside, elsewhere = (image.holds(p[:, 0], np.abs(p[:, 1]), 1.0).all() for p in (pair, other))
            if inside and not elsewhere:
                fits.append({**{key: start + k for k, key in enumerate(order)}, **({"name": 0} if start else {}),
                             **_enable(values, start + 4)})
    if len(fits) != 1:
        raise RoadExtractionError(
            f"The columns of {what} have no names, and their numbers do not show which are pixel and line in an image of "
            f"{image.width} by {image.height}. Put a line above them: pixel,line,easting,northing.")
    return fits[0]


def _enable(values, column):
    """The fifth column of the QGIS georeferencer, zeros and ones, where there is one."""
    return {"enable": column} if column < values.shape[1] and np.isin(values[:, column], (0, 1)).all() else {}


def as_number(value: Any) -> float:
    """The number in a field, with a decimal point or comma; NaN where it holds none."""
    try:
        return float(str(value).strip().replace(",", "."))
    except ValueError:
        return np.nan


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
    raise RoadExtractionError(
        f"{outside} of {len(columns)} points of {what} lie outside the image: pixels run from {columns.min():.0f} to {columns.max():.0f} "
        f"and lines from {lines.min():.0f} to {lines.max():.0f}, the image has {image.width} by {image.height}. "
        "Do they belong to another image or to another size of it, or are pixel and line swapped?")


def _names(rows, column):
    if column is None:
        return tuple(str(number) for number in range(1, len(rows) + 1))
    return tuple(_text(row, column) or str(number) for number, row in enumerate(rows, 1))


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
