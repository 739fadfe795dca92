"""The report on the roadside: lengths by kind, every line, and a straightened plan of every road."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

import numpy as np

from ..common.texts import language, told, tr, word
from .figures import Chart
from .page import Page

if TYPE_CHECKING:
    from ..common.features import Features
    from ..inventory.roadside.shared import Roadside

KIND_COLOURS = dict(guard_rail="#5b6b8c", barrier="#b08a3e", wall="#8c4b3c", fence="#e08020", hedge="#3f8f3a", gutter="#2b8cbe",
                    pole="#7f7f7f", sign="#c9a400", trunk="#6b4a2b")
EDGE_COLOUR = "#444444"
MARK_SIZE = 0.004, 0.02   # of the plan's length and width


def roadside_report(found: Roadside, lines: Features, points: Features) -> str:
    """The report as HTML.

    Parameters
    ----------
    found : Roadside
    lines, points : Features of `roadside_to_features`
    """
    page = Page(tr("Roadside"), tr("What stands beside the road. Heights are those above the ground at its foot; distances count outward from the "
                                   "carriageway's edge."))
    for note in found.notes:
        page.warning(told(note))
    page.heading(tr("Together"))
    lengths: dict[tuple[str, str], float] = defaultdict(float)
    counts: dict[tuple[str, str], int] = defaultdict(int)
    for row in lines.rows:
        lengths[row["kind"], row["side"]] += row["length_m"]
    for row in points.rows:
        counts[row["kind"], row["side"]] += 1
    if lengths:
        page.table((tr("Line"), tr("Side"), tr("Length (m)")),
                   [(_name(kind), word(side), length) for (kind, side), length in sorted(lengths.items())])
    if counts:
        page.table((tr("Single"), tr("Side"), tr("Number")), [(_name(kind), word(side), number) for (kind, side), number in sorted(counts.items())])
    if not lengths and not counts:
        page.text(tr("Nothing was found within the reach."))
    for road, edges in found.edges.items():
        own = [row for row in lines.rows if row["road"] == road]
        page.heading(tr("Road {road}").format(road=road))
        _plan(page, found, road, edges, points)
        if own:
            page.table((tr("Kind"), tr("Side"), tr("From (m)"), tr("To (m)"), tr("Length (m)"), tr("From the edge (m)"), tr("Height (m)"),
                        tr("Foot (m)")),
                       [(_name(row["kind"]), word(row["side"]), *(row[name] for name in (
                           "station_m", "end_m", "length_m", "edge_m", "height_m", "foot_m")))
                        for row in own], (None, None, 1, 1, 1, 2, 2, 2))
    return page.html()


def _name(kind):
    return kind.replace("_", " ") if language() == "en" else word(kind)


def _plan(page, found, road, edges, points):
    """The road from above, straightened: the same height on the page whatever way it runs."""
    lines = [line for line in found.lines if line.chain.road == road]
    own = [row for row in points.rows if row["road"] == road]
    reach = np.concatenate([edges.left, edges.right, *(line.chain.d for line in lines), [row["offset_m"] for row in own]])
    chart = Chart((float(edges.s[0]), float(edges.s[-1])), (float(reach.min()) - 0.5, float(reach.max()) + 0.5),
                  tr("Station (m)"), tr("Offset (m)"), 260)
    chart.curve(edges.s, edges.left, EDGE_COLOUR, tr("edge of the carriageway"), 1.0)
    chart.curve(edges.s, edges.right, EDGE_COLOUR, tr("edge of the carriageway"), 1.0)
    for line in lines:
        chart.curve(line.chain.s, line.chain.d, KIND_COLOURS[line.kind], _name(line.kind), 2.4)
    along, across = MARK_SIZE[0] * np.ptp(edges.s), MARK_SIZE[1] * np.ptp(reach)
    for row in own:
        at = np.array([row["station_m"]])
        chart.bars(at - along / 2, at + along / 2, np.array([across]), KIND_COLOURS[row["kind"]], np.array([row["offset_m"] - across / 2]),
                   f"{_name(row['kind'])}, {row['height_m']:.1f} m")
    page.drawing(chart.svg(), tr("The roadside from above, straightened; black are the edges of the carriageway."))
    kinds = {line.kind for line in lines} | {row["kind"] for row in own}
    page.colour_key([(colour, _name(kind)) for kind, colour in KIND_COLOURS.items() if kind in kinds])
