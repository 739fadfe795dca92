"""Reports on HD maps: what an export wrote and how well it fits, and what a check of a file found."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from ...core.common.texts import told, tr, word
from ..export.check.findings import FAULTS, Findings, SameFindings
from ..export.sources import RoadMapSource
from .page import html_page

COLOUR_OF_LANE = {"driving": "#8a9299", "connector": "#c9b27c", "shoulder": "#b7bfc5", "bicycle": "#c47f6a", "parking": "#9fb4c9"}
PICTURE_WIDTH, PICTURE_HEIGHT = 900, 520   # pixels
MOST_ROWS = 200   # of findings that the report lists; the layer has all
Table = tuple[str, Sequence[str], Sequence[Sequence[Any]]]


def map_export_report(title: str, subtitle: str, facts: Iterable[tuple[str, Any]], tables: Sequence[Table] = (), notes: Sequence[str] = (),
                      shown: RoadMapSource | None = None) -> str:
    """An HTML page with (name, value) facts, and tables of (heading, names of the columns, rows).

    `shown`: what the file holds as our own reader sees it, for a picture; None for none.
    """
    types = set() if shown is None else set(shown.lanes.type)
    return html_page("map_export", title=title, subtitle=subtitle, notes=notes, rows=list(facts), tables=tables,
                  drawn=_lanes_and_lines(shown) if shown is not None and types else None,
                  colours=[(COLOUR_OF_LANE[kind], word(kind)) for kind in COLOUR_OF_LANE if kind in types])


def _lanes_and_lines(shown: RoadMapSource) -> dict[str, Any]:
    """What an SVG of lanes and lines is made of: its size, (points, colour) of the lanes, (points, colour, dashed or not) of the lines."""
    lanes = shown.lanes
    vertices = np.concatenate([lanes.left, lanes.right])[:, :2]
    low, high = vertices.min(0), vertices.max(0)
    scale = min(PICTURE_WIDTH / max(high[0] - low[0], 1.0), PICTURE_HEIGHT / max(high[1] - low[1], 1.0))
    size = (high - low) * scale + 20

    def path(points):
        placed = (points[:, :2] - low) * scale + 10
        return " ".join(f"{x:.1f},{size[1] - y:.1f}" for x, y in placed)

    areas = [(path(np.concatenate([left, right[::-1]])), COLOUR_OF_LANE.get(kind, "#d5d9dc"))
             for kind, (left, right) in zip(lanes.type, map(lanes.borders, range(len(lanes))))]
    lines = [(path(shapely.get_coordinates(shape)), colour, "dashed" in str(row.get("pattern")))
             for layer, colour in ((shown.road_edges, "#5a4632"), (shown.marking_lines, "#1f2a33")) for shape, row in layer or ()]
    return dict(width=f"{size[0]:.0f}", height=f"{size[1]:.0f}", areas=areas, lines=lines)


def map_check_report(findings: Findings, path: str, notes: Sequence[str] = ()) -> str:
    """The findings of a map in the file of a path, as HTML."""
    groups, _ = findings.groups()
    return html_page("map_check", findings=findings, file=Path(path).name, notes=notes, faults=FAULTS, count=len(groups),
                  groups=[(row, places_of_findings(group, MOST_ROWS // 10), group) for row, group in enumerate(groups[:MOST_ROWS], start=1)])


def places_of_findings(one: SameFindings, most: int) -> str:
    """The names of the first elements with a finding, and how many more there are."""
    named = "; ".join(told(name) for name in one.elements[:most])
    rest = len(one.elements) - most
    return tr("{named}; and {rest} more", named=named, rest=rest) if rest > 0 else named
