"""The report of the check of an HD map."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..common.texts import told, tr
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
    page = Page(tr("Check of an HD map"), f"{Path(path).name}.")
    for note in notes:
        page.warning(told(note))
    page.facts([(tr("Driven lanes and pieces"), found.lanes), (tr("Links from one lane to the next"), found.successors),
                (tr("Pairs of lanes side by side"), found.neighbours), (tr("Findings"), len(found.found))])
    if not found.found:
        page.text(tr("Nothing was found."))
        return page.html()
    page.heading(tr("Faults"))
    page.table((tr("Fault"), tr("Count"), tr("What it means")),
               [(told(fault), count, told(FAULTS[fault])) for fault, count in sorted(found.counts().items())])
    page.heading(tr("Findings"))
    page.table((tr("Fault"), tr("Where"), tr("What was seen"), "x", "y"),
               [(told(one.fault), told(one.element), told(one.text), one.place[0], one.place[1]) for one in found.found[:MOST_ROWS]],
               (None, None, None, 2, 2))
    if len(found.found) > MOST_ROWS:
        page.note(tr("The first {shown} of {count}; the layer has all of them.").format(shown=MOST_ROWS, count=len(found.found)))
    return page.html()
