"""China: city roads."""

from __future__ import annotations

from .model import Country, Dashes, SectionLimits
from .neutral import NEUTRAL

CHINA = Country(
    name="china",
    narrowest_lane=2.75,
    widest_lane=5.0,
    usual_lane=3.5,
    longest_dash=7.5,
    line_widths=(0.10, 0.15, 0.20),
    dash_patterns=(Dashes(2.0, 4.0, "below 60 km/h"), Dashes(6.0, 9.0, "60 km/h and more")),
    design_code=NEUTRAL.design_code,
    design_speeds=NEUTRAL.design_speeds,
    sources=(
        "Dashes and widths of lane lines: GB 51038-2015, 12.3.2 (6 m and 9 m, 15 cm wide, at 60 km/h and more; 2 m and 4 m, 10 cm, below).",
        "Design code: CJJ 37-2012 as printed in the driving-line thesis (University of Waterloo, 2018), table 4.11.",
    ),
    section_limits=SectionLimits(
        max_rut=15.0, min_crossfall=1.0, max_crossfall=6.0, min_width=3.25, min_clearance=4.5,
        rules={"max_rut": "JTG 5210-2018, heavy rutting", "min_crossfall": "CJJ 37-2012", "max_crossfall": "CJJ 37-2012, superelevation",
               "min_width": "CJJ 37-2012", "min_clearance": "CJJ 37-2012"},
    ),
)
