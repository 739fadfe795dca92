"""The report of the check of an HD map."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..export.check.findings import FAULTS, Findings
from .page import Page

MOST_ROWS = 200   # findings that the report lists; the layer has all


def map_check_report(found: Findings, path: str, notes: Sequence[str] = ()) -> str:
    """The findings of a map as HTML.

    Parameters
    ----------
    found : Findings
    path : of the file
    notes : further sentences
    """
    page = Page("Check of an HD map", f"{Path(path).name}.")
    for note in notes:
        page.warning(note)
    page.facts([("Driven lanes and pieces", found.lanes), ("Links from one lane to the next", found.successors),
                ("Pairs of lanes side by side", found.neighbours), ("Findings", len(found.found))])
    if not found.found:
        page.text("Nothing was found.")
        return page.html()
    page.heading("Faults")
    page.table(("Fault", "Count", "What it means"), [(fault, count, FAULTS[fault]) for fault, count in sorted(found.counts().items())])
    page.heading("Findings")
    page.table(("Fault", "Where", "What was seen", "x", "y"),
               [(one.fault, one.element, one.text, one.place[0], one.place[1]) for one in found.found[:MOST_ROWS]], (None, None, None, 2, 2))
    if len(found.found) > MOST_ROWS:
        page.note(f"The first {MOST_ROWS} of {len(found.found)}; the layer has all of them.")
    return page.html()
