"""Reports on the inventory: cross-sections against their limits, and what stands beside the road."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from typing import Any

import numpy as np

from ...core.common.features import Features
from ...core.common.texts import language, tr, word
from ..inventory.cross_sections import RoadSections
from ..inventory.roadside.find import Roadside
from .page import Chart, html_page

LANE_COLOURS = ("#2b6ca3", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#56b4e9", "#7f3fbf", "#444444")
EXCEEDED_COLOUR, KEPT_COLOUR, LIMIT_COLOUR = "#f6c6c6", "#cfe3cf", "#b00020"
PLAN_EXCEEDED_COLOUR = "#d43d51"
MAX_TABLE_ROWS = 200
KIND_COLOURS = dict(guard_rail="#5b6b8c", barrier="#b08a3e", wall="#8c4b3c", fence="#e08020", hedge="#3f8f3a", gutter="#2b8cbe",
                    pole="#7f7f7f", sign="#c9a400", trunk="#6b4a2b")
EDGE_COLOUR = "#444444"
MARK_SIZE = 0.004, 0.02   # of the plan's length and width


def _charts():
    """Of each chart: title, y label, fields drawn, of lanes or the carriageway, limits drawn (name, sign), name of the limit that colours."""
    return (
        (tr("Crossfall of the lanes"), "%", ("crossf_pct",), "lane",
         (("max_crossfall", 1), ("max_crossfall", -1), ("min_crossfall", 1), ("min_crossfall", -1)), "crossfall"),
        (tr("Rut depth of the lanes, the deeper wheel path"), "mm", ("rut_l_mm", "rut_r_mm"), "lane", (("max_rut", 1),), "rut"),
        (tr("Width of the lanes"), "m", ("width_m",), "lane", (("min_width", 1),), "width"),
        (tr("Width of the carriageway"), "m", ("width_m",), "carriageway", (), ""),
        (tr("Grade"), "%", ("grade_pct",), "carriageway", (("max_grade", 1), ("max_grade", -1)), "grade"),
        (tr("Height of the left curb"), "m", ("curb_l_m",), "carriageway", (), ""),
        (tr("Height of the right curb"), "m", ("curb_r_m",), "carriageway", (), ""),
        (tr("Clearance"), "m", ("clear_m",), "carriageway", (("min_clearance", 1),), "clearance"),
    )


def _limit_titles():
    return dict(max_rut=tr("Rut depth, at most (mm)"), min_crossfall=tr("Crossfall, at least (%)"), max_crossfall=tr("Crossfall, at most (%)"),
                max_grade=tr("Grade, at most (%)"), min_width=tr("Width of a lane, at least (m)"), min_clearance=tr("Clearance, at least (m)"))


def cross_section_report(sections: RoadSections, table: Features) -> str:
    """The report as HTML. `table`: Features of `sections_to_features`, the rows of all sections."""
    limits, interval = sections.settings.limits(), sections.settings.interval
    exceeded = _exceeded(table.rows)
    by_road = defaultdict(list)
    for row in table.rows:
        by_road[row["road"]].append(row)
    roads = []
    for road, rows in by_road.items():
        station = (min(row["station_m"] for row in rows) - interval / 2, max(row["station_m"] for row in rows) + interval / 2)
        charts = [_chart(rows, station, interval, limits, chart) for chart in _charts()]
        roads.append((road, [_summary(name, part) for name, part in _parts(rows).items()], _plan(rows, station, interval), filter(None, charts)))
    return html_page("cross_sections", notes=sections.notes, limits=limits, limit_titles=_limit_titles(), exceeded=exceeded[:MAX_TABLE_ROWS],
                  more=len(exceeded) - MAX_TABLE_ROWS, roads=roads)


def _exceeded(rows):
    """(road, lane, from, to, the worst) of stretches that exceed a limit."""
    runs: dict[Any, list[list[dict]]] = defaultdict(list)
    for row in rows:
        for name in (row["exceeds"] or "").split(", ") if row["exceeds"] else ():
            key = row["road"], row["lane"] or 0, name
            if runs[key] and row["section"] - runs[key][-1][-1]["section"] <= 1:
                runs[key][-1].append(row)
            else:
                runs[key].append([row])
    result = [(road, str(lane or word("carriageway")), run[0]["station_m"], run[-1]["station_m"], _worst(run, name))
              for (road, lane, name), group in runs.items() for run in group]
    return sorted(result, key=lambda one: (one[0], one[2]))


def _worst(run, name):
    """What the layer says of the section that misses the limit by most."""
    def missed(reason):
        value, limit = (float(number) for number in re.findall(r" ([\d.]+) [<>] ([\d.]+) ", reason)[0])
        return abs(value - limit)

    place = [row["exceeds"].split(", ").index(name) for row in run]
    return max((row["why"].split("; ")[k] for row, k in zip(run, place)), key=missed)


def _parts(rows):
    parts = defaultdict(list)
    for row in sorted(rows, key=lambda one: (one["lane"] or 0)):
        parts[tr("lane {number}", number=row["lane"]) if row["lane"] else word("carriageway")].append(row)
    return parts


def _summary(name, rows):
    def median(field):
        values = [row[field] for row in rows if row[field] is not None]
        return float(np.median(values)) if values else None

    clear = [row["clear_m"] for row in rows if row["clear_m"] is not None]
    return (name, len(rows), *(median(field) for field in ("width_m", "crossf_pct", "crossf_sig", "grade_pct", "rut_l_mm", "rut_r_mm")),
            min(clear) if clear else None)


def _plan(rows, station, interval):
    """The sections from above, straightened: the same height on the page whatever way the road runs."""
    reach = [row["offset_m"] + side * row["width_m"] / 2 for row in rows for side in (-1, 1)]
    chart = Chart(station, (min(reach) - 0.5, max(reach) + 0.5), tr("Station (m)"), tr("Offset (m)"))
    for over, colour in ((False, KEPT_COLOUR), (True, PLAN_EXCEEDED_COLOUR)):
        drawn = [row for row in rows if bool(row["exceeds"]) == over and (row["lane"] or over or not any(section["lane"] for section in rows))]
        if drawn:
            middle = np.array([row["station_m"] for row in drawn])
            width = np.array([row["width_m"] for row in drawn])
            chart.bars(middle - 0.35 * interval, middle + 0.35 * interval, width, colour, np.array([row["offset_m"] for row in drawn]) - width / 2)
    return chart.svg()


def _chart(rows, station, interval, limits, what):
    """(title, SVG, (colour, name) of its curves), None where nothing of it was measured."""
    title, unit, names, part, lines, limit = what
    levels = [(name, sign * getattr(limits, name)) for name, sign in lines if getattr(limits, name) is not None]
    series = _parts([row for row in rows if row["part"] == part])
    values = {name: [_value(row, names) for row in members] for name, members in series.items()}
    measured = [value for members in values.values() for value in members if value is not None]
    if not measured:
        return None
    # limits far off would flatten what was measured
    near = [level for _, level in levels if min(measured) - np.ptp(measured) - 1 < level < max(measured) + np.ptp(measured) + 1]
    low, high = min([*measured, *near]), max([*measured, *near])
    room = max(0.08 * (high - low), 0.02)
    chart = Chart(station, (low - room, high + room), tr("Station (m)"), unit, 200)
    over = sorted({row["station_m"] for row in rows if row["part"] == part and limit and limit in (row["exceeds"] or "").split(", ")})
    if over:
        middle, height = np.array(over), np.full(len(over), high - low + 2 * room)
        chart.bars(middle - interval / 2, middle + interval / 2, height, EXCEEDED_COLOUR, low - room)
    for name, level in levels:
        if level in near:
            chart.level(level, LIMIT_COLOUR, _limit_titles()[name])
    drawn = []
    for k, (name, members) in enumerate(series.items()):
        colour = LANE_COLOURS[k % len(LANE_COLOURS)]
        s, y = _with_gaps([row["station_m"] for row in members], values[name], interval)
        chart.curve(s, y, colour, name, 2.0)
        drawn.append((colour, name))
    return title, chart.svg(), drawn


def _value(row, names):
    values = [row[name] for name in names if row[name] is not None]
    return max(values) if values else None


def _with_gaps(stations, values, interval):
    """Stations and values of a curve; a value that stands alone is drawn as a short dash, a missing section as a gap."""
    s, y = [], []
    for station, value in zip(stations, values):
        if s and station - s[-1] > 1.2 * interval:
            s.append(station)
            y.append(np.nan)
        s += [station - 0.2 * interval, station + 0.2 * interval]
        y += [np.nan if value is None else value] * 2
    return np.array(s), np.array(y)


def roadside_report(roadside: Roadside, lines: Features, points: Features) -> str:
    """The report as HTML. `lines`, `points`: Features of `roadside_to_features`."""
    lengths: dict[tuple[str, str], float] = defaultdict(float)
    for row in lines.rows:
        lengths[row["kind"], row["side"]] += row["length_m"]
    roads = [(road, *_roadside_plan(roadside, road, edges, [row for row in points.rows if row["road"] == road]),
              [row for row in lines.rows if row["road"] == road]) for road, edges in roadside.edges.items()]
    return html_page("roadside", notes=roadside.notes, lengths=lengths, counts=Counter((row["kind"], row["side"]) for row in points.rows),
                  name_of=_kind_name, roads=roads)


def _kind_name(kind):
    return kind.replace("_", " ") if language() == "en" else word(kind)


def _roadside_plan(roadside, road, edges, points):
    """SVG of a road from above, straightened, the same height on the page whatever way it runs; (colour, kind) of what stands there."""
    lines = [line for line in roadside.lines if line.chain.road == road]
    reach = np.concatenate([edges.left, edges.right, *(line.chain.d for line in lines), [row["offset_m"] for row in points]])
    chart = Chart((float(edges.s[0]), float(edges.s[-1])), (float(reach.min()) - 0.5, float(reach.max()) + 0.5),
                  tr("Station (m)"), tr("Offset (m)"), 260)
    chart.curve(edges.s, edges.left, EDGE_COLOUR, tr("edge of the carriageway"), 1.0)
    chart.curve(edges.s, edges.right, EDGE_COLOUR, tr("edge of the carriageway"), 1.0)
    for line in lines:
        chart.curve(line.chain.s, line.chain.d, KIND_COLOURS[line.kind], _kind_name(line.kind), 2.4)
    along, across = MARK_SIZE[0] * np.ptp(edges.s), MARK_SIZE[1] * np.ptp(reach)
    for row in points:
        station = np.array([row["station_m"]])
        chart.bars(station - along / 2, station + along / 2, np.array([across]), KIND_COLOURS[row["kind"]], np.array([row["offset_m"] - across / 2]),
                   f"{_kind_name(row['kind'])}, {row['height_m']:.1f} m")
    kinds = {line.kind for line in lines} | {row["kind"] for row in points}
    return chart.svg(), [(colour, _kind_name(kind)) for kind, colour in KIND_COLOURS.items() if kind in kinds]
