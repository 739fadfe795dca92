"""Ground control points: places known both in the image and on the map, from a table in any usual form.

Pixel and line count from the outer corner of the first pixel, whose middle is
0.5, 0.5. QGIS's georeferencer counts lines upwards, so that they are negative;
that is recognised and turned.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..errors import RoadExtractionError
from .columns import as_number, find_columns, guess_columns

CONTROL, CHECK, DISABLED = "control", "check", "disabled"
_OFF = ("0", "false", "no", "off", "n", "f")
_CHECK = ("check", "checkpoint", "check point", "chk", "cp", "test")


@dataclass(frozen=True)
class ControlPoints:
    """N points.

    Attributes
    ----------
    pixel, line : (N,) in the image, lines counted downwards
    easting, northing, height : (N,) on the map, m; height NaN where it is not known
    names : N texts
    roles : (N,) of "control" (they place the image), "check" (they only judge it), "disabled"
    crs : WKT of the map coordinates, "" where unknown
    left_out : rows of the table that held no numbers
    """

    pixel: np.ndarray
    line: np.ndarray
    easting: np.ndarray
    northing: np.ndarray
    height: np.ndarray
    names: tuple
    roles: np.ndarray
    crs: str = ""
    left_out: int = 0

    def __len__(self):
        return len(self.pixel)

    def having(self, role):
        """Indices of the points of one role."""
        return np.flatnonzero(self.roles == role)

    def with_disabled_as_checks(self):
        return replace(self, roles=np.where(self.roles == DISABLED, CHECK, self.roles))


def control_points(names, rows, image, what, crs=""):
    """The control points of a table.

    Parameters
    ----------
    names : list of column names, or None where the table has no header
    rows : list of rows, of texts or numbers
    image : SourceImage that the points belong to
    what : the table's name for messages
    crs : WKT of its map coordinates

    Raises
    ------
    RoadExtractionError
        If a needed column is missing, no row holds numbers, or the points lie outside the image.
    """
    if not rows:
        raise RoadExtractionError(f"{what} holds no control points. It needs a row for each: pixel, line, easting, northing.")
    where = guess_columns(rows, image, what) if names is None else find_columns(names, what)
    table = {key: _numbers(rows, where.get(key)) for key in ("pixel", "line", "easting", "northing", "height")}
    known = np.isfinite([table[key] for key in ("pixel", "line", "easting", "northing")]).all(axis=0)
    if not known.any():
        raise RoadExtractionError(
            f"{what} holds no row with numbers for pixel, line, easting and northing. "
            "Write numbers with a decimal point (a comma only where semicolons part the columns).")
    kept = [row for row, good in zip(rows, known) if good]
    roles = _roles(kept, where)
    pixel, line = _in_the_image(table["pixel"][known], table["line"][known], roles != DISABLED, image, what)
    return ControlPoints(pixel, line, *(table[key][known] for key in ("easting", "northing", "height")),
                         _names(kept, where.get("name")), roles, crs, int((~known).sum()))


def _numbers(rows, column):
    return np.array([np.nan if column is None else as_number(row[column] if column < len(row) else None) for row in rows])


def _in_the_image(pixel, line, used, image, what):
    """Pixel and line, lines downwards; source coordinates of an image that had a place become pixels.

    Where disabled points lie is their own affair, unless there are no others.
    """
    used = used if used.any() else np.ones(len(pixel), dtype=bool)
    margin = 1.0 + 0.02 * max(image.width, image.height)
    forms = [(pixel, -line) if np.median(line[used]) < 0 else (pixel, line)]
    if image.geotransform is not None:
        # QGIS writes these where the image it worked on had a place on the map
        forms.append(image.pixel_of(pixel, line))
    for columns, lines in forms:
        if image.holds(columns, lines, margin)[used].all():
            return columns, lines
    columns, lines = (axis[used] for axis in max(forms, key=lambda form: image.holds(*form, margin)[used].sum()))
    outside = int((~image.holds(columns, lines, margin)).sum())
    raise RoadExtractionError(
        f"{outside} of {len(columns)} points of {what} lie outside the image: pixels run from {columns.min():.0f} to {columns.max():.0f} "
        f"and lines from {lines.min():.0f} to {lines.max():.0f}, the image has {image.width} by {image.height}. "
        "Are they of another image, of one in another size, or are pixel and line swapped?")


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
        if role in _CHECK or (check and check not in _OFF):
            roles[number] = CHECK
        if role.startswith(("disab", "off", "unused")) or ("enable" in where and _text(row, where["enable"]).lower() in _OFF):
            roles[number] = DISABLED
    return roles
