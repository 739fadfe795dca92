"""Control points from a file: QGIS's `.points` in its old and new forms, or CSV with any delimiter."""

import csv
from pathlib import Path

from ..errors import RoadExtractionError
from .columns import NAMES, as_number
from .control_points import control_points

LARGEST = 20_000_000  # bytes; a table of control points is a few thousand


def read_control_points(path, image, crs=""):
    """ControlPoints of a file.

    Parameters
    ----------
    path : `.points` of QGIS's georeferencer (a line "#CRS: ..." or none; mapX, mapY, sourceX,
        sourceY or pixelX, pixelY; commas or, from QGIS 1, tabs), or a CSV or TXT table
    image : SourceImage that the points belong to
    crs : WKT of the map coordinates where the file names none

    Raises
    ------
    RoadExtractionError
        If the file cannot be read or its columns cannot be told.
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
    """The lines of the table, and the CRS named above it."""
    try:
        if Path(path).stat().st_size > LARGEST:
            raise RoadExtractionError(f"{path} is too large for a table of control points. Was the image chosen in its place?")
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
            if _delimiter([words]) == " " or not any(word.strip().lower().replace("_", "") in NAMES["easting"] + NAMES["pixel"]
                                                     for word in words.split(_delimiter([words]))):
                continue
            bare = words
        if bare:
            lines.append(bare)
    return lines, named


def _delimiter(lines):
    """Of the first line that has one; a comma beside semicolons or tabs is a decimal sign."""
    first = next(iter(lines), "")
    return next((mark for mark in (";", "\t", ",") if mark in first), " ")


def _wkt(named, path):
    from ..survey.crs import parse_crs

    if not named:
        return ""
    try:
        return parse_crs(named).to_wkt()
    except RoadExtractionError as problem:
        raise RoadExtractionError(f"{path} names a CRS that is not understood: {named[:60]!r}. "
                                  "Correct its first line (#CRS: EPSG:number) or remove it and give the CRS.") from problem
