"""The report of the check of an HD map."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..common.texts import told, tr
from ..export.check.findings import FAULTS, Findings, SameFindings
from .page import Page

MOST_ROWS = 200   # of findings that the report lists; the layer has all


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
    groups, _ = found.groups()
    page.heading(tr("Findings"))
    page.note(tr("One row for the same finding at many places, those at the fewest places first; what was seen is the largest. The layer has a "
                 "point for each place, with its row."))
    page.table((tr("Row"), tr("Fault"), tr("Places"), tr("Where"), tr("What was seen"), "x", "y"),
               [(row, told(one.worst.fault), one.count, places_of_findings(one, MOST_ROWS // 10), told(one.worst.text), *one.worst.place[:2])
                for row, one in enumerate(groups[:MOST_ROWS], start=1)], (0, None, 0, None, None, 2, 2))
    if len(groups) > MOST_ROWS:
        page.note(tr("The first {shown} of {count}; the layer has all of them.").format(shown=MOST_ROWS, count=len(groups)))
    return page.html()


def places_of_findings(one: SameFindings, most: int) -> str:
    """The names of the first elements with a finding, and how many more there are."""
    named = "; ".join(told(name) for name in one.elements[:most])
    rest = len(one.elements) - most
    return tr("{named}; and {rest} more").format(named=named, rest=rest) if rest > 0 else named
