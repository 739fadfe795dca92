"""Files of ground control points: where their table begins, and in which CRS it is.

`.points` of the QGIS georeferencer in its old and new forms, `gcp_list.txt` of OpenDroneMap, ENVI's `.pts`, and CSV with any
delimiter. A CRS may stand above the table, with or without a word before it.
"""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import Any

from ..common.errors import RoadExtractionError
from ..io.text_table import as_number
from .control_points import ControlPoints, control_points, names_columns
from .source_image import SourceImage

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

    Parameters
    ----------
    path : `.points` of the QGIS georeferencer (with or without a line "#CRS: ..."; mapX, mapY, sourceX, sourceY or
        pixelX, pixelY; commas or, from QGIS 1, tabs), `gcp_list.txt` (the CRS in its first line, then x, y, z, pixel, line and
        image in each row), or a CSV or TXT table
    image : SourceImage that the points belong to; rows that name another image are passed over
    crs : WKT of the map coordinates where the file names none

    Returns
    -------
    ControlPoints

    Raises
    ------
    RoadExtractionError
        If the file cannot be read, its columns or its CRS are not recognised, or no row is of this image.
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
    for line in _text(path).splitlines():
        bare = COMMENT.sub("", line.strip()).strip()
        labelled = CRS_LABEL.match(bare)
        if labelled:
            named = named or bare[labelled.end():].strip()
        elif not lines and not named and (CRS_CODE.match(bare) or bare == line.strip() and _is_named_crs(bare)):
            named = bare
        elif bare and (bare == line.strip() or (not lines and _delimiter([bare]) != " " and names_columns(re.split("[;\t,]", bare), 3))):
            lines.append(bare)  # a header may be written as a comment
    return lines, named


def _text(path):
    try:
        if Path(path).stat().st_size > MAX_TABLE_BYTES:
            raise RoadExtractionError(f"{path} is too large for a table of control points. Was the image given instead?")
        data = Path(path).read_bytes()
    except OSError as problem:
        raise RoadExtractionError(
            f"{path} cannot be read ({problem.strerror or problem}). Check the path and the rights to read it.") from problem
    if b"\0" in data and data[:2] not in (b"\xff\xfe", b"\xfe\xff"):
        raise RoadExtractionError(f"{path} is no text. Control points are read from a .points or CSV file.")
    return data.decode("utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig", "replace")


def _is_named_crs(line):
    """Whether a line above the table is the name of a CRS and neither a row nor a header."""
    fields = re.split(r"[;\t,\s]+", line)
    return bool(CRS_NAME.search(line)) and not names_columns(fields, 2) and sum(as_number(field) == as_number(field) for field in fields) < 3


def _delimiter(lines):
    """Delimiter of the first line; a comma beside semicolons or tabs is a decimal comma."""
    first = next(iter(lines), "")
    return next((mark for mark in (";", "\t", ",") if mark in first), " ")


def _wkt(named, path):
    """WKT of the CRS that a file names, "" where it names none."""
    from ..io.crs import parse_crs

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
