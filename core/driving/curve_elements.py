"""Elements of the curves along driving lines, in metres and feet, and their check against the design code."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..countries.model import Country
from ..countries.neutral import NEUTRAL
from ..curves.base import Arc
from ..io.crs import FOOT

MAX_CURVE_RADIUS = 5000.0    # m: flatter arcs are straights to any driver
MIN_TURN = np.radians(1.0)
MAX_TURN = np.pi * 0.95   # the tangents of a half circle do not meet


def circular_curve_elements(radius: float, delta: float) -> dict[str, float]:
    """The elements of a circular curve.

    ::

        L = R delta              T = R tan(delta/2)      LC = 2 R sin(delta/2)
        M = R (1 - cos(delta/2)) E = R (sec(delta/2) - 1)
        D = 5729.578 / R         (arc definition: degrees per 100 m or per 100 ft)

    so that M = E cos(delta/2) < E.

    Parameters
    ----------
    radius : metres, > 0
    delta : deflection angle, radians, 0 < delta < pi

    Returns
    -------
    dict of the fields of CURVE_ELEMENTS that follow from them
    """
    half = delta / 2
    lengths = dict(radius=radius, length=radius * delta, tangent=radius * np.tan(half),
                   middle=radius * (1 - np.cos(half)), chord=2 * radius * np.sin(half),
                   ext=radius * (1 / np.cos(half) - 1))
    found = {}
    for name, metres in lengths.items():
        found[f"{name}_m"], found[f"{name}_ft"] = float(metres), float(metres / FOOT)
    found["delta_deg"] = float(np.degrees(delta))
    found["degree_m"] = float(np.degrees(100.0 / radius))
    found["degree_ft"] = float(np.degrees(100.0 / (radius / FOOT)))
    return found


def curve_points(start: Sequence[float], heading: float, radius: float, delta: float, left: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points of curvature, of intersection and of tangency of a circular curve.

    Parameters
    ----------
    start : (2,) metres, where the curve begins
    heading : radians counter-clockwise from east, its direction there
    radius : metres
    delta : radians, its deflection angle
    left : whether it turns left

    Returns
    -------
    PC, PI, PT : (2,) metres each
    """
    turn = delta if left else -delta
    tangent = radius * np.tan(delta / 2)
    pc = np.asarray(start, float)
    pi = pc + tangent * np.array([np.cos(heading), np.sin(heading)])
    pt = pi + tangent * np.array([np.cos(heading + turn), np.sin(heading + turn)])
    return pc, pi, pt


def design_check(radius: float, length: float, complete: bool = True, code: Country = NEUTRAL) -> tuple[int | None, str]:
    """Check a curve against the design code of a country.

    Parameters
    ----------
    radius, length : metres
    complete : False where the arc runs on beyond the line, so that its length is not known
    code : Country, whose `design_speeds` are asked, slowest first

    Returns
    -------
    speed : the highest design speed that the code allows, km/h; None where it allows none
    text : a sentence that names the code
    """
    slowest = code.design_speeds[0]
    by_radius = max((row.speed for row in code.design_speeds if radius >= row.radius), default=0)
    by_length = max((row.speed for row in code.design_speeds if length >= row.length), default=0)
    speed = min(by_radius, by_length) if complete else by_radius
    if not by_radius:
        return None, f"{code.design_code}: radius {radius:.0f} m is below {slowest.radius:.0f} m, the least for {slowest.speed} km/h"
    text = f"{code.design_code}: radius allows {by_radius} km/h"
    if not complete:
        return speed, text + "; the curve goes on beyond the line"
    if not any(row.length for row in code.design_speeds):
        return speed, text
    if not by_length:
        return None, text + f", length {length:.0f} m is below {slowest.length:.0f} m, the least for {slowest.speed} km/h"
    return speed, text + f", length {by_length} km/h"


def is_curve(arc: Arc) -> bool:
    """Whether an arc is a curve with elements: no straight, and no turn so small or so large that its elements mean nothing."""
    return bool(arc.bend and arc.radius <= MAX_CURVE_RADIUS and MIN_TURN < abs(arc.bend) * arc.length < MAX_TURN)


def element_row(arc: Arc, complete: bool, rmse: float, origin: np.ndarray, code: Country = NEUTRAL) -> dict[str, Any]:
    """Fields of CURVE_ELEMENTS of an arc.

    Parameters
    ----------
    arc : Arc for which `is_curve` holds, local metres, in the direction of travel
    complete : False where the arc runs on beyond the line
    rmse : metres, of the line from the arc
    origin : (2,) or (3,) map coordinates of the local origin
    code : Country, whose design code the curve is checked against

    Returns
    -------
    dict of field name to value
    """
    delta, left = abs(arc.bend) * arc.length, arc.bend > 0
    pc, pi, pt = curve_points((arc.x + origin[0], arc.y + origin[1]), arc.direction, arc.radius, delta, left)
    speed, text = design_check(arc.radius, arc.length, complete, code)
    return dict(circular_curve_elements(arc.radius, delta), turn="left" if left else "right", pc_x=float(pc[0]), pc_y=float(pc[1]),
                pi_x=float(pi[0]), pi_y=float(pi[1]), pt_x=float(pt[0]), pt_y=float(pt[1]), rmse_m=float(rmse),
                speed_kmh=speed, code=text)
