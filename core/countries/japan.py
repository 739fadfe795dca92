"""Japan."""

from __future__ import annotations

from .model import Country, Dashes, DesignSpeed, SectionLimits

JAPAN = Country(
    name="japan",
    narrowest_lane=2.5,
    widest_lane=5.0,
    usual_lane=3.25,
    longest_dash=9.0,
    line_widths=(0.15, 0.20),
    dash_patterns=(Dashes(5.0, 5.0, "ordinary road"), Dashes(8.0, 12.0, "expressway")),
    design_code="Road Structure Ordinance",
    design_speeds=(DesignSpeed(20, 15.0), DesignSpeed(30, 30.0), DesignSpeed(40, 60.0), DesignSpeed(50, 100.0), DesignSpeed(60, 150.0),
                   DesignSpeed(80, 280.0)),
    sources=(
        "Lanes of 2.75, 3.00, 3.25 and 3.50 m and least radii: Road Structure Ordinance (Cabinet Order 320 of 1970) with its commentary (2004).",
        "Dashes and widths: Order on Road Signs, Lane Lines and Road Surface Markings (5 m and 5 m; 8 m and 12 m at 80 km/h and more).",
    ),
    section_limits=SectionLimits(
        max_rut=40.0, min_crossfall=1.5, max_crossfall=10.0, max_grade=12.0, min_width=2.75, min_clearance=4.5,
        rules={"max_rut": "MLIT inspection guideline for road stock 2013, most damaged class",
               **dict.fromkeys(("min_crossfall", "max_crossfall", "max_grade", "min_width", "min_clearance"), "Road Structure Ordinance")},
    ),
)
