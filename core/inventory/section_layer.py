"""Cross-sections as a layer of lines, one for every lane and carriageway, and as a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import shapely

from ..common.features import CROSS_SECTIONS, Features
from ..countries.model import SectionLimits
from .cross_sections import RoadSection, StripMeasures

if TYPE_CHECKING:
    from .cross_sections import RoadSections

LINE_TOLERANCE = 0.003   # m of height to which the drawn profile is simplified
MIN_SECTION_VERTICES = 2


def sections_to_features(sections: RoadSections) -> tuple[Features, Features]:
    """The layer CROSS_SECTIONS, and its rows as a table.

    Parameters
    ----------
    sections : RoadSections

    Returns
    -------
    lines : Features of lines with Z from the left border to the right one, one row for every carriageway and lane of every section;
        a strip whose surface was not seen is drawn straight between the heights known
    table : the same rows without geometry
    """
    lines, table = Features("LineStringZ", CROSS_SECTIONS, crs=sections.crs), Features("None", CROSS_SECTIONS, crs=sections.crs)
    limits = sections.settings.limits()
    for number, section in enumerate(sections.sections):
        for part in section.parts:
            row = _row(number, section, part, limits)
            lines.add(_line(section, part, sections.frame), **row)
            table.add(None, **row)
    return lines, table


def exceeded(part: StripMeasures, width: float, limits: SectionLimits) -> list[str]:
    """Names of the limits that a lane or carriageway does not keep, in a fixed order.

    Crossfall and width are judged of driving lanes, the grade and the clearance of everything.
    """
    driven = part.strip.lane > 0 and part.strip.type == "driving"
    fall = abs(100 * part.crossfall)
    checks = (
        ("rut", driven and _above(1000 * np.fmax(*part.ruts), limits.max_rut)),
        ("crossfall", driven and (_above(fall, limits.max_crossfall) or _below(fall, limits.min_crossfall))),
        ("grade", _above(abs(100 * part.grade), limits.max_grade)),
        ("width", driven and part.strip.borders != "track" and _below(width, limits.min_width)),
        ("clearance", _below(part.clearance, limits.min_clearance)),
    )
    return [name for name, over in checks if over]


def _above(value, limit):
    return bool(limit is not None and value > limit)


def _below(value, limit):
    return bool(limit is not None and value < limit)


def _row(number: int, section: RoadSection, part: StripMeasures, limits: SectionLimits) -> dict[str, Any]:
    strip = part.strip
    width = strip.width / float(np.hypot(1.0, section.heading))
    return dict(
        road=section.road, section=number + 1, station_m=section.station, part="lane" if strip.lane else "carriageway",
        lane=strip.lane or None, type=strip.type, direction=strip.direction, offset_m=0.5 * (strip.left + strip.right), width_m=width,
        borders=strip.borders, crossf_pct=100 * part.crossfall, crossf_sig=100 * part.crossfall_sigma, grade_pct=100 * part.grade,
        rut_l_mm=1000 * part.ruts[1], rut_r_mm=1000 * part.ruts[0], curb_l_m=part.curbs[1], curb_r_m=part.curbs[0], clear_m=part.clearance,
        seen_pct=100 * part.seen, exceeds=", ".join(exceeded(part, width, limits)) or None)


def _line(section, part, frame):
    """The measured profile between the borders of a strip, from left to right."""
    known = np.isfinite(section.z)
    inside = known & (section.d > part.strip.right) & (section.d < part.strip.left)
    d = np.r_[part.strip.right, section.d[inside], part.strip.left]
    z = np.interp(d, section.d[known], section.z[known])
    if len(d) > MIN_SECTION_VERTICES:
        d, z = shapely.get_coordinates(shapely.simplify(shapely.linestrings(np.c_[d, z]), LINE_TOLERANCE)).T
    places = frame.to_map(section.road, np.full(len(d), section.station), d, z)
    return shapely.linestrings(np.stack(places, axis=1)[::-1])
