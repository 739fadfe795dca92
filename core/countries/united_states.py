"""United States of America."""

from __future__ import annotations

from .model import Country, Dashes, DesignSpeed, SectionLimits

FOOT = 0.3048            # source: m, international foot (1959)
INCH = 25.4              # source: mm
MILE = 1.609344          # source: km
SUPERELEVATION = 0.08    # source: greatest crossfall in curves
# source: (as the rest of this file) design speed, miles per hour, and the greatest side friction at it
SIDE_FRICTION = ((20, 0.27), (30, 0.20), (40, 0.16), (50, 0.14), (60, 0.12), (70, 0.10))

UNITED_STATES = Country(
    name="united-states",
    narrowest_lane=2.7,
    widest_lane=5.0,
    usual_lane=12 * FOOT,
    longest_dash=4.5,
    line_widths=(4 * FOOT / 12, 6 * FOOT / 12, 8 * FOOT / 12, 12 * FOOT / 12),
    dash_patterns=(Dashes(10 * FOOT, 30 * FOOT, "lane and centre lines"), Dashes(3 * FOOT, 9 * FOOT, "line extensions")),
    design_code="AASHTO Green Book, 8 % superelevation",
    design_speeds=tuple(DesignSpeed(round(speed * MILE), speed**2 / (15 * (SUPERELEVATION + friction)) * FOOT)
                        for speed, friction in SIDE_FRICTION),
    sources=(
        "Lines and dashes: MUTCD 3A.06: dashes of 10 ft, gaps of 30 ft; a normal line is 4 to 6 in wide, a wide line at least twice as much.",
        "Design code: AASHTO, A Policy on Geometric Design of Highways and Streets: R = V^2 / (15 (e + f)), V in mph, R in ft, "
        "with the side friction factors of its 2004 edition.",
    ),
    section_limits=SectionLimits(
        max_rut=0.40 * INCH, min_crossfall=1.5, max_crossfall=100 * SUPERELEVATION, min_width=9 * FOOT, min_clearance=14 * FOOT,
        rules={"max_rut": "23 CFR 490.313, poor above 0.40 in",
               **dict.fromkeys(("min_crossfall", "max_crossfall", "min_width", "min_clearance"), "AASHTO Green Book")},
    ),
)
