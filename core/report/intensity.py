"""The report on an intensity correction."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .page import Page

if TYPE_CHECKING:
    from ..intensity.correction import IntensityReport

# title of a column and the key of a scanner's row that it shows
SCANNER_COLUMNS = (
    ("Scanner", "scanner"), ("Points", "points"), ("From (m)", "nearest"), ("To (m)", "farthest"),
    ("Asphalt before", "asphalt_before"), ("Asphalt after", "asphalt_after"),
    ("Variation before (%)", "spread_before"), ("Variation after (%)", "spread_after"),
    ("Highest/lowest before", "fall_before"), ("Highest/lowest after", "fall_after"))


def intensity_correction_report(found: IntensityReport) -> str:
    """HTML page of an IntensityReport."""
    page = Page("Intensity correction", "Asphalt's intensity by scanner, before and after. Distances are from the track of the vehicle.")
    for line in [*found.lines()[:1], found.saturation_warning]:
        if line:
            page.text(line)
    if found.scanners:
        page.table(tuple(title for title, _ in SCANNER_COLUMNS),
                   [[row[key] for _, key in SCANNER_COLUMNS] for row in found.scanners])
    return page.html()
