"""Germany."""

from __future__ import annotations

from .model import Country, Dashes, DesignSpeed, SectionLimits

GERMANY = Country(
    name="germany",
    narrowest_lane=2.5,
    widest_lane=5.0,
    usual_lane=3.5,
    longest_dash=7.5,
    line_widths=(0.12, 0.15, 0.25, 0.30),
    dash_patterns=(Dashes(3.0, 6.0, "town"), Dashes(4.0, 8.0, "country road"), Dashes(6.0, 12.0, "motorway")),
    design_code="RAA 2008",
    design_speeds=(DesignSpeed(80, 280.0), DesignSpeed(100, 470.0), DesignSpeed(120, 720.0), DesignSpeed(130, 900.0)),
    sources=(
        "Lines and dashes: RMS-1 (1993) and RMS part A (2019): dash to gap 1 to 2, narrow and broad line 0.12 and 0.25 m, on motorways "
        "0.15 and 0.30 m.",
        "Lanes: 3.50 and 3.75 m on motorways, 3.25 m on city motorways (RAA 2008).",
        "Design code: least radii of RAA 2008 for its classes EKA 3, 2, 1B and 1A, at the speeds they are designed for.",
    ),
    section_limits=SectionLimits(
        max_rut=10.0, min_crossfall=2.5, max_crossfall=7.0, max_grade=8.0, min_width=2.75, min_clearance=4.5,
        rules={"max_rut": "ZTV ZEB-StB, warning value", "min_crossfall": "RAL 2012", "max_crossfall": "RAL 2012", "max_grade": "RAL 2012, EKL 4",
               "min_width": "RASt 06, lane in town with lorries", "min_clearance": "RAL 2012"},
    ),
)
