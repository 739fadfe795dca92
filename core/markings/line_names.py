"""Markings called what the line is that they make: a dash alone does not know whether it parts lanes or directions."""

import numpy as np
import shapely

from .classes import LINES

ON_LINE = 0.15   # m between a marking and the line along it


def named_by_lines(markings, lines):
    """Give markings of lines (use keep) the `kind` of the marking line that runs along them.

    Parameters
    ----------
    markings : Features MARKINGS, whose rows are changed
    lines : Features MARKING_LINES fitted to them

    Returns
    -------
    how many rows have another class now
    """
    rows = [k for k, row in enumerate(markings.rows) if row["class"] in LINES and row["use"] == "keep"]
    if not rows or not len(lines):
        return 0
    places = shapely.point_on_surface(np.array([markings.geometries[k] for k in rows], object))
    tree = shapely.STRtree(np.array(lines.geometries, object))
    of, line = tree.query_nearest(places, max_distance=ON_LINE, all_matches=False)
    changed = 0
    for k, j in zip(of.tolist(), line.tolist()):
        row, found = markings.rows[rows[k]], lines.rows[j]
        if row["road"] == found["road"] and row["class"] != found["kind"]:
            row["class"] = found["kind"]
            changed += 1
    return changed
