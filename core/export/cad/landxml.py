"""Writes LandXML 1.2: alignments with their elements and profiles.

References
----------
LandXML-1.2 schema (landxml.org): CoordGeom, Profile. Places are northing, easting.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...io.crs import FOOT, SAME_UNIT, US_SURVEY_FOOT, as_in_file, horizontal_part, parse_crs
from ..opendrive.geometry import PlanElement
from ..xml_tree import XmlElement, xml_text
from .alignments import Alignment, elements_without_reversal

FEET_IN_LANDXML = {"USSurveyFoot": US_SURVEY_FOOT, "foot": FOOT}
NAMESPACE = "http://www.landxml.org/schema/LandXML-1.2"


def landxml_text(alignments: Sequence[Alignment], crs: str = "", name: str = "Road map", date: str = "2000-01-01", time: str = "00:00:00") -> str:
    """The file as text.

    Parameters
    ----------
    alignments : list of Alignment
    crs : WKT, metric, "" where unknown; where it is that of a survey in feet, so is the file, heights too
    name : of the project
    date, time : of the file, ISO 8601
    """
    root = XmlElement("LandXML", {"xmlns": NAMESPACE, "version": "1.2", "date": date, "time": time, "language": "English", "readOnly": "false"})
    file_wkt, units = as_in_file(crs)
    unit = next((name for name, foot in FEET_IN_LANDXML.items() if abs(units.across / foot - 1) < SAME_UNIT), "")
    if unit:
        crs = file_wkt
        root.add("Units").add("Imperial", areaUnit="squareFoot", linearUnit=unit, volumeUnit="cubicFeet", temperatureUnit="fahrenheit",
                              pressureUnit="inHG", angularUnit="decimal degrees", directionUnit="decimal degrees")
        alignments = [one.in_file(units) for one in alignments]
    else:
        root.add("Units").add("Metric", areaUnit="squareMeter", linearUnit="meter", volumeUnit="cubicMeter", temperatureUnit="celsius",
                              pressureUnit="milliBars", angularUnit="decimal degrees", directionUnit="decimal degrees")
    known = horizontal_part(parse_crs(crs))
    if known is not None:
        authority = known.to_authority()
        code = authority[1] if authority and authority[0] == "EPSG" else None
        root.add("CoordinateSystem", desc=known.name, epsgCode=code, ogcWktCode=known.to_wkt())
    root.add("Project", name=name)
    root.add("Application", name="Lanewright")
    group = root.add("Alignments", name=name)
    for one in alignments:
        element = group.add("Alignment", name=one.name, length=one.length, staStart=0.0, desc=one.description)
        geometry = element.add("CoordGeom")
        if one.plan is None:
            _irregular(geometry, one.places)
        else:
            for piece in elements_without_reversal(one.plan):
                _element(geometry, piece)
        profile = element.add("Profile", name=one.name).add("ProfAlign", name=one.name)
        for station, height in one.profile:
            profile.add("PVI", f"{station:.4f} {height:.4f}")
    return xml_text(root)


def _place(point: np.ndarray) -> str:
    return f"{point[1]:.5f} {point[0]:.5f}"


def _irregular(geometry, places):
    line = geometry.add("IrregularLine", length=float(np.hypot(*np.diff(places[:, :2], axis=0).T).sum()))
    line.add("Start", _place(places[0]))
    line.add("End", _place(places[-1]))
    line.add("PntList2D", " ".join(_place(place) for place in places))


def _element(geometry: XmlElement, piece: PlanElement) -> None:
    (start, end), headings, _ = piece.at(np.array([0.0, piece.length]))
    if piece.kind == "line":
        line = geometry.add("Line", length=piece.length, staStart=piece.s, dir=_azimuth(headings[0]))
        line.add("Start", _place(start))
        line.add("End", _place(end))
    elif piece.kind == "arc":
        bend = piece.values[0]
        centre = start + np.array([-np.sin(headings[0]), np.cos(headings[0])]) / bend
        curve = geometry.add("Curve", rot="ccw" if bend > 0 else "cw", crvType="arc", radius=abs(1 / bend), length=piece.length, staStart=piece.s,
                             chord=float(np.hypot(*(end - start))), delta=float(np.degrees(abs(bend) * piece.length)),
                             dirStart=_azimuth(headings[0]), dirEnd=_azimuth(headings[1]))
        for tag, point in (("Start", start), ("Center", centre), ("End", end)):
            curve.add(tag, _place(point))
    else:
        bends = piece.values
        turn = sum(bends)
        spiral = geometry.add("Spiral", length=piece.length, radiusStart=_radius(bends[0]), radiusEnd=_radius(bends[1]),
                              rot="ccw" if turn > 0 else "cw", spiType="clothoid", staStart=piece.s,
                              theta=float(np.degrees(abs(headings[1] - headings[0]))), dirStart=_azimuth(headings[0]), dirEnd=_azimuth(headings[1]))
        for tag, point in (("Start", start), ("PI", _intersection(start, headings[0], end, headings[1])), ("End", end)):
            spiral.add(tag, _place(point))


def _radius(bend: float) -> str:
    return "INF" if abs(bend) < 1e-9 else f"{abs(1 / bend):.6f}"


def _azimuth(heading: float) -> float:
    """Degrees clockwise from north."""
    return float((90.0 - np.degrees(heading)) % 360.0)


def _intersection(start, first, end, last):
    """Where the tangents at both ends meet; half-way where they are parallel."""
    turn = np.sin(last - first)
    if abs(turn) < 1e-9:
        return (start + end) / 2
    away = end - start
    return start + np.array([np.cos(first), np.sin(first)]) * (away[0] * np.sin(last) - away[1] * np.cos(last)) / turn
