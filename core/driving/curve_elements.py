"""Elements of the curves along driving lines, in metres and feet, and the design code's word on them."""

import numpy as np

FOOT = 0.3048
# CJJ 37-2012 as printed in the driving-line thesis, table 4.11:
# design speed km/h, least radius m, least length of a curve m
DESIGN_CODE = ((30, 85.0, 25.0), (40, 150.0, 35.0), (50, 200.0, 40.0), (60, 300.0, 50.0), (80, 400.0, 70.0))
STRAIGHT = 5000.0    # m: flatter arcs are straights to any driver
LEAST_TURN = np.radians(1.0)


def curve_elements(radius, delta):
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


def curve_points(start, heading, radius, delta, left):
    """PC, PI and PT of a curve that begins at `start` in direction `heading` (radians), (2,) each."""
    turn = delta if left else -delta
    tangent = radius * np.tan(delta / 2)
    pc = np.asarray(start, float)
    pi = pc + tangent * np.array([np.cos(heading), np.sin(heading)])
    pt = pi + tangent * np.array([np.cos(heading + turn), np.sin(heading + turn)])
    return pc, pi, pt


def design_check(radius, length, complete=True):
    """The highest design speed that CJJ 37-2012 allows for a curve, km/h (None below all), and a sentence.

    complete : False where the arc runs on beyond the line, so that its length is not known
    """
    by_radius = max((speed for speed, least, _ in DESIGN_CODE if radius >= least), default=0)
    by_length = max((speed for speed, _, least in DESIGN_CODE if length >= least), default=0)
    speed = min(by_radius, by_length) if complete else by_radius
    if not by_radius:
        return None, f"CJJ 37-2012: radius {radius:.0f} m is below {DESIGN_CODE[0][1]:.0f} m, the least for 30 km/h"
    text = f"CJJ 37-2012: radius allows {by_radius} km/h"
    if not complete:
        return speed, text + "; the curve goes on beyond the line"
    if not by_length:
        return None, text + f", length {length:.0f} m is below {DESIGN_CODE[0][2]:.0f} m, the least for 30 km/h"
    return speed, text + f", length {by_length} km/h"


def element_row(arc, complete, rmse, origin):
    """One row of CURVE_ELEMENTS for an Arc (local metres) in the direction of travel; None for a straight."""
    if not arc.bend or arc.radius > STRAIGHT:
        return None
    delta, left = abs(arc.bend) * arc.length, arc.bend > 0
    if not LEAST_TURN < delta < np.pi * 0.95:
        return None
    pc, pi, pt = curve_points((arc.x + origin[0], arc.y + origin[1]), arc.direction, arc.radius, delta, left)
    speed, code = design_check(arc.radius, arc.length, complete)
    return dict(curve_elements(arc.radius, delta), turn="left" if left else "right", pc_x=float(pc[0]), pc_y=float(pc[1]),
                pi_x=float(pi[0]), pi_y=float(pi[1]), pt_x=float(pt[0]), pt_y=float(pt[1]), rmse_m=float(rmse),
                speed_kmh=speed, code=code)
