"""The report on an intensity correction."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..common.texts import told, tr
from .page import Page

if TYPE_CHECKING:
    from ..intensity.correction import IntensityReport


def _scanner_columns():
    """Title of each column and the key of a scanner's row that it shows."""
    return (
        (tr("Scanner"), "scanner"), (tr("Points"), "points"), (tr("From (m)"), "nearest"), (tr("To (m)"), "farthest"),
        (tr("Asphalt before"), "asphalt_before"), (tr("Asphalt after"), "asphalt_after"),
        (tr("Variation before (%)"), "spread_before"), (tr("Variation after (%)"), "spread_after"),
        (tr("Highest/lowest before"), "fall_before"), (tr("Highest/lowest after"), "fall_after"))


def intensity_correction_report(found: IntensityReport) -> str:
    """HTML page of an IntensityReport."""
    page = Page(tr("Intensity correction"), tr("Asphalt's intensity by scanner, before and after. Distances are from the track of the vehicle."))
    for line in [*found.lines()[:1], found.saturation_warning]:
        if line:
            page.text(told(line))
    if found.scanners:
        columns = _scanner_columns()
        page.table([title for title, _ in columns], [[row[key] for _, key in columns] for row in found.scanners])
    return page.html()
