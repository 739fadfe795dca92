"""Which column of a table of control points is which, by their names or, without names, by the image's size."""

import re

import numpy as np

from ..errors import RoadExtractionError

NAMES = {
    "pixel": "pixel pixelx sourcex srcx column col sample px imagex imgx imx xpixel ximage xsource u".split(),
    "line": "line pixely sourcey srcy row py imagey imgy imy ypixel yimage ysource v".split(),
    "easting": "mapx easting east e geox worldx utme xmap xworld rechtswert rw".split(),
    "northing": "mapy northing north n geoy worldy utmn ymap yworld hochwert hw".split(),
    "height": "mapz z h geoz height elevation elev altitude alt".split(),
    "name": "name point id pointid label gcp gcpname gcpid number no nr".split(),
    "enable": "enable enabled active use used".split(),
    "role": "role type".split(),
    "check": "check ischeck checkpoint".split(),
}
NEEDED = ("pixel", "line", "easting", "northing")


def find_columns(names, what):
    """{meaning: index} of the columns of a table with a header.

    Bare `x`, `y` are map coordinates, unless those have names of their own.

    Raises
    ------
    RoadExtractionError
        If one of pixel, line, easting, northing has no column.
    """
    plain = [re.sub(r"[^a-z]", "", re.sub(r"\(.*?\)|\[.*?\]", "", str(name).lower())) for name in names]
    found = {}
    for key, aliases in NAMES.items():
        places = [plain.index(alias) for alias in aliases if alias in plain]
        if places:
            found[key] = places[0]
    for bare, keys in (("x", ("easting", "pixel")), ("y", ("northing", "line"))):
        free = [key for key in keys if key not in found]
        if bare in plain and free:
            found[free[0]] = plain.index(bare)
    missing = [key for key in NEEDED if key not in found]
    if missing:
        raise RoadExtractionError(
            f"{what} has the columns {', '.join(map(str, names))}; {' and '.join(missing)} cannot be told among them. "
            "Name the columns pixel, line, easting, northing.")
    return found


def guess_columns(rows, image, what):
    """{meaning: index} of a table without names: two columns lie in the image, two beside them on the map.

    Raises
    ------
    RoadExtractionError
        If both orders, or none, would do.
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
            f"The columns of {what} have no names, and their numbers do not tell which are pixel and line in an image of "
            f"{image.width} by {image.height}. Put a line above them: pixel,line,easting,northing.")
    return fits[0]


def _enable(values, column):
    """The georeferencer's fifth column where there is one, of zeros and ones."""
    return {"enable": column} if column < values.shape[1] and np.isin(values[:, column], (0, 1)).all() else {}


def as_number(value):
    """The number that a field holds, NaN where it is none."""
    try:
        return float(str(value).strip().replace(",", "."))
    except ValueError:
        return np.nan
