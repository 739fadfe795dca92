"""How right a road map is on streets of every kind: by length, corners, islands and edges of the pavement included.

A figure is a pair: how much is right, of how much; pairs of several streets are pooled by adding them up.
"""

import numpy as np
import shapely

STEP = 0.1          # m between the places at which lines are judged
CURB, PAVEMENT = 0.10, 0.20   # m from the true line
NARROW, BROAD = 0.05, 0.15    # m from the true driving line
DRIVEN = 1.2        # m between a driven lane's middle and the track
APART = 2.5         # m: what is drawn on the track but this far from every true lane runs where the truth has no lanes
SAME = 0.5          # m, between lines whose directions are compared


def judged(case, track, edges, paint, lanes):
    """All figures of one road map.

    Parameters
    ----------
    case : Case
    track : (N, 2) m, the trajectory
    edges, lanes : [(shapely line, row), ...], road edges and driving lines
    paint : rates of the markings, as judge.paint gives them with one cell of tolerance, or None

    Returns
    -------
    dict of name -> (right, of how much); figures of which the survey has no truth are left out
    """
    found = {}
    if "boundaries" in case.truth.has:
        found.update(_boundaries(case.truth, [line for line, row in edges if row.get("part") in (None, "bottom")]))
        curbs = [line for line, edge, _ in case.truth.edges if edge not in ("pavement", "none")]
        found["edges_sigma"] = _within_sigma(edges, curbs, CURB, case.truth.area)
    if paint is not None:
        found.update(paint=(paint["found"], paint["found"] + paint["missed"]), paint_right=(paint["right"], paint["right"] + paint["false"]))
    if "driving_lines" in case.truth.has:
        found.update(driving_figures(case.truth, track, [line for line, _ in lanes]))
        found["lanes_sigma"] = _within_sigma(lanes, case.truth.driving, BROAD, case.truth.area)
    return {name: tuple(map(float, pair)) for name, pair in found.items() if pair[1]}


def percent(figures, name):
    """A figure in per cent, None where there is none."""
    pair = figures.get(name)
    return None if pair is None else 100.0 * pair[0] / pair[1]


def pooled(cases):
    """The sum of figures of several streets."""
    total = {}
    for figures in cases:
        for name, pair in figures.items():
            total[name] = tuple(np.add(total.get(name, (0.0,) * len(pair)), pair).tolist())
    return total


def harmonic(figures, found, right):
    """F1 in per cent of a figure found and a figure right."""
    recall, precision = percent(figures, found), percent(figures, right)
    if recall is None or precision is None:
        return None
    return 2 * recall * precision / max(recall + precision, 1e-9)


def _boundaries(truth, lines):
    curbs = [line for line, edge, _ in truth.edges if edge == "curb"]
    corners = [line for line, edge, where in truth.edges if edge == "curb" and where in ("corner", "island")]
    pavement = [line for line, edge, _ in truth.edges if edge in ("pavement", "none")]
    found = {"curbs": _near(curbs, lines, CURB, truth.area), "corners": _near(corners, lines, CURB, truth.area),
             "pavement": _near(pavement, lines, PAVEMENT, truth.area)}
    places, _ = sampled(lines, truth.area)
    by_curb = distance(places, [line for line, edge, _ in truth.edges if edge not in ("pavement", "none")]) <= CURB
    found["curbs_right"] = (by_curb | (distance(places, pavement) <= PAVEMENT)).sum(), len(places)
    return found


def _near(true, lines, tolerance, area):
    places, _ = sampled(true, area)
    return (distance(places, lines) <= tolerance).sum(), len(places)


def driving_figures(truth, track, lines):
    """The figures of driving lines (shapely lines) that `judged` gives."""
    road = shapely.LineString(track)
    found = {name: np.zeros(2) for name in ("lanes_5", "lanes", "driven_5", "driven")}
    for lane in truth.driving:
        places, _ = sampled([lane], truth.area)
        if len(places) == 0:
            continue
        off = distance(places, lines)
        driven = np.mean(shapely.distance(shapely.points(places), road) < DRIVEN) >= 0.5
        for name in ("lanes", "driven") if driven else ("lanes",):
            found[name] += (off <= BROAD).sum(), len(off)
            found[f"{name}_5"] += (off <= NARROW).sum(), len(off)
    places, ahead = sampled(lines, truth.area)
    off = distance(places, truth.driving)
    counted = in_a_true_lane(places, off, truth.driving, road)
    found["lanes_right"] = (off[counted] <= BROAD).sum(), counted.sum()
    close = off < SAME
    found["directions"] = (_agree(places[close], ahead[close], truth.driving) > 0).sum(), close.sum()
    return {name: tuple(map(float, pair)) for name, pair in found.items() if pair[1]}


def in_a_true_lane(places, off, true, road):
    """(N,) bool, False for places on the track (a shapely line) where the truth has no lane: `off` m lies the nearest `true` driving line, and no
    farther than BROAD what is beside it and not beyond its end."""
    ends = shapely.get_coordinates([shapely.get_point(line, k) for line in true for k in (0, -1)])
    beside = (off <= BROAD) | (off < distance(places, list(shapely.points(ends))) - 1e-6)
    return (off <= APART) & beside | (shapely.distance(shapely.points(places), road) >= APART)


def _within_sigma(rows, true, near, area):
    """Places within the sigma that their own line says, and places of lines that say one; only those near a true line count."""
    inside = count = 0
    for line, row in rows:
        if row.get("sigma_m") is not None:
            off = distance(sampled([line], area)[0], true)
            inside, count = inside + (off <= min(row["sigma_m"], near)).sum(), count + (off <= near).sum()
    return inside, count


def _agree(places, ahead, lines):
    """Cosine of the angle between directions at places and that of the nearest line."""
    true, direction = sampled(lines, None)
    if len(places) == 0:
        return np.zeros(0)
    nearest = shapely.STRtree(shapely.points(true)).nearest(shapely.points(places))
    return (ahead * direction[nearest]).sum(axis=1)


def sampled(lines, area):
    """Places every 10 cm along lines, (N, 2) m, with the direction of the line there, within an area (None: everywhere)."""
    places, ahead = [np.zeros((0, 2))], [np.zeros((0, 2))]
    for line in lines:
        line = shapely.force_2d(line)
        if line.length < STEP:
            continue
        along = np.arange(STEP / 2, line.length, STEP)
        ends = [shapely.get_coordinates(shapely.line_interpolate_point(line, along + shift)) for shift in (-STEP / 2, STEP / 2)]
        way = ends[1] - ends[0]
        places.append((ends[0] + ends[1]) / 2)
        ahead.append(way / np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)[:, None])
    places, ahead = np.concatenate(places), np.concatenate(ahead)
    if area is not None and len(places):
        shapely.prepare(area)
        inside = shapely.contains_xy(area, places)
        places, ahead = places[inside], ahead[inside]
    return places, ahead


def distance(places, lines):
    """Distance of (N, 2) places from the nearest line, m; inf without lines."""
    result = np.full(len(places), np.inf)
    if len(places) and len(lines):
        (which, _), apart = shapely.STRtree([shapely.force_2d(line) for line in lines]).query_nearest(
            shapely.points(places), all_matches=False, return_distance=True)
        result[which] = apart
    return result
