"""The road map in numbers, for batches and models: how much there is, and how much of it was measured."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from ...core.common.features import Features
from ..texts import tr

if TYPE_CHECKING:
    from ...core.corrections.corrections import Corrections

MEASURED = "measured"

NUMBERS = (
    ("ROADS", tr("Roads")),
    ("ROAD_LENGTH", tr("Length of the roads (m)")),
    ("EDGE_LENGTH", tr("Length of the road edges (m)")),
    ("EDGES_MEASURED", tr("Of the road edges measured (%)")),
    ("LINE_LENGTH", tr("Length of the marking lines (m)")),
    ("LINES_MEASURED", tr("Of the marking lines measured (%)")),
    ("LANE_COUNT", tr("Lanes")),
    ("LANE_LENGTH", tr("Length of the driving lines (m)")),
    ("LANES_MEASURED", tr("Of the driving lines measured (%)")),
    ("MARKING_COUNT", tr("Markings")),
    ("TRUST", tr("Confidence of the driving lines, mean along them (0 to 1)")),
    ("CORRECTIONS_MADE", tr("Corrections made")),
    ("CORRECTIONS_UNMATCHED", tr("Corrections that match nothing")),
)


def road_map_numbers(road_lengths: Iterable[float], edges: Features | None, marking_lines: Features | None, driving_lines: Features | None,
                     markings: Features | None, corrections: Corrections | None = None) -> dict[str, float]:
    """The values of NUMBERS to three decimals; a share or mean of nothing is left out.

    road_lengths : m of each road
    edges, marking_lines, driving_lines, markings : layers of the road map, None where there are none
    corrections : of an analyst, and which of them were made; None for none
    """
    lengths = list(road_lengths)
    numbers: dict[str, float | None] = {"ROADS": float(len(lengths)), "ROAD_LENGTH": float(sum(lengths))}
    for layer, length, share in ((edges, "EDGE_LENGTH", "EDGES_MEASURED"), (marking_lines, "LINE_LENGTH", "LINES_MEASURED"),
                                 (driving_lines, "LANE_LENGTH", "LANES_MEASURED")):
        numbers[length], numbers[share] = _measured(layer)
    lanes = [] if driving_lines is None else driving_lines.rows
    numbers["LANE_COUNT"] = float(len({(row.get("road"), row.get("lane")) for row in lanes}))
    numbers["MARKING_COUNT"] = float(0 if markings is None else len(markings))
    numbers["TRUST"] = _trust(driving_lines)
    unmatched = 0 if corrections is None else len({correction.row for correction in corrections.unmatched})
    made = 0 if corrections is None else len({correction.row for correction in corrections.rows}) - unmatched
    numbers["CORRECTIONS_MADE"], numbers["CORRECTIONS_UNMATCHED"] = float(made), float(unmatched)
    return {name: round(value, 3) for name, value in numbers.items() if value is not None}


def _trust(layer):
    """Mean confidence of lines by their lengths, None without lines."""
    pieces = [] if layer is None else [(geometry.length, row.get("confidence")) for geometry, row in layer]
    rated = [(length, sure) for length, sure in pieces if sure is not None]
    total = sum(length for length, _ in rated)
    return sum(length * sure for length, sure in rated) / total if total else None


def _measured(layer):
    """(m of all lines, percent of them measured or None)."""
    if layer is None:
        return 0.0, None
    lengths = [(geometry.length, row.get("status")) for geometry, row in layer]
    total = sum(length for length, _ in lengths)
    return total, 100.0 * sum(length for length, status in lengths if status == MEASURED) / total if total else None
