"""Markings named after the lines that they make: a dash alone does not show whether it separates lanes or directions."""

from __future__ import annotations

import numpy as np
import shapely

from ..objects.classify import LINE_KINDS
from ..objects.marking_objects import MarkingObjects
from .painted_lines import PaintedLines

MAX_DISTANCE_TO_LINE = 0.15   # m between a marking and the line along it


def named_by_lines(markings: MarkingObjects, lines: PaintedLines) -> MarkingObjects:
    """Markings of lines (`keep`) with the `kind` of the marking line that runs along them.

    Parameters
    ----------
    markings : MarkingObjects
    lines : PaintedLines fitted to them

    Returns
    -------
    MarkingObjects, the same with the new names
    """
    rows = np.flatnonzero(markings.keep & np.isin(markings.kind.astype(str), LINE_KINDS))
    if not len(rows) or not len(lines):
        return markings
    places = shapely.point_on_surface(markings.outlines.polygons()[rows])
    found, line = shapely.STRtree(lines.course.linestrings()).query_nearest(places, max_distance=MAX_DISTANCE_TO_LINE, all_matches=False)
    same_road = markings.road[rows[found]] == lines.course.road[line]
    kind = markings.kind.copy()
    kind[rows[found][same_road]] = lines.kind[line[same_road]]
    return markings.with_kinds(kind)
