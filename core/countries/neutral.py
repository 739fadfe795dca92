"""The default: limits that lanes and markings of all countries at hand keep, and the design code of the driving-line thesis."""

from __future__ import annotations

from .model import Country, Dashes, DesignSpeed

NEUTRAL = Country(
    name="neutral",
    narrowest_lane=2.2,
    widest_lane=5.0,
    usual_lane=3.5,
    longest_dash=10.5,
    line_widths=(0.10, 0.12, 0.15, 0.20, 0.25, 0.30),
    dash_patterns=(Dashes(3.0, 6.0, "town"), Dashes(6.0, 9.0, "country road"), Dashes(6.0, 12.0, "motorway")),
    design_code="CJJ 37-2012",
    design_speeds=(DesignSpeed(30, 85.0, 25.0), DesignSpeed(40, 150.0, 35.0), DesignSpeed(50, 200.0, 40.0),
                   DesignSpeed(60, 300.0, 50.0), DesignSpeed(80, 400.0, 70.0)),
    sources=(
        "Widths of lanes: our own limits, which hold those of all files of the catalogue (narrowest lane 2.5 m).",
        "Line widths and dashes: those of the other files of the catalogue.",
        "Design code: CJJ 37-2012 as printed in the driving-line thesis (University of Waterloo, 2018), table 4.11.",
    ),
)
