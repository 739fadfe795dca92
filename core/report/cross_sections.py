"""The report on cross-sections: charts along every road, the stretches that exceed a limit, and what could not be known."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

import numpy as np

from ..common.texts import told, tr, word
from .figures import Chart
from .page import Page

if TYPE_CHECKING:
    from ..common.features import Features
    from ..inventory.cross_sections import RoadSections

LANE_COLOURS = ("#2b6ca3", "#d55e00", "#009e73", "#cc79a7", "#8a6d00", "#56b4e9", "#7f3fbf", "#444444")
EXCEEDED_COLOUR, KEPT_COLOUR, LIMIT_COLOUR = "#f6c6c6", "#cfe3cf", "#b00020"
PLAN_EXCEEDED_COLOUR = "#d43d51"
MAX_TABLE_ROWS = 200
VALUE_OF_LIMIT = dict(rut="rut_l_mm", crossfall="crossf_pct", grade="grade_pct", width="width_m", clearance="clear_m")


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
    """The report as HTML.

    Parameters
    ----------
    sections : RoadSections
    table : Features of `sections_to_features`, the rows of all sections
    """
    page = Page(tr("Cross-sections"), tr(
        "Stations count along the road, offsets to its left. Crossfall is positive where the road falls to the right, "
        "seen along the road; left and right are seen that way too."))
    for note in sections.notes:
        page.warning(told(note))
    limits = sections.settings.limits()
    page.heading(tr("Limits"))
    page.facts([(title, getattr(limits, name) if getattr(limits, name) is not None else tr("no limit")) for name, title in _limit_titles().items()])
    page.note(tr("Of the country: {sources}").format(sources=" ".join(map(told, limits.sources))) if limits.sources
              else tr("The country of the catalogue sets no limits."))
    _exceeded(page, table.rows)
    by_road = defaultdict(list)
    for row in table.rows:
        by_road[row["road"]].append(row)
    for road, rows in by_road.items():
        _road(page, road, rows, limits, sections.settings.interval)
    return page.html()


def _exceeded(page, rows):
    page.heading(tr("What exceeds the limits"))
    runs: dict[Any, list[list[dict]]] = defaultdict(list)
    for row in rows:
        for name in (row["exceeds"] or "").split(", ") if row["exceeds"] else ():
            key = row["road"], row["lane"] or 0, name
            if runs[key] and row["section"] - runs[key][-1][-1]["section"] <= 1:
                runs[key][-1].append(row)
            else:
                runs[key].append([row])
    found = [(road, lane or word("carriageway"), word(name), run[0]["station_m"], run[-1]["station_m"], _worst(run, name))
             for (road, lane, name), some in runs.items() for run in some]
    if not found:
        page.text(tr("No section exceeds a limit."))
        return
    found.sort(key=lambda one: (one[0], one[3]))
    page.table((tr("Road"), tr("Lane"), tr("Limit"), tr("From (m)"), tr("To (m)"), tr("Worst")),
               [(road, str(lane), *rest) for road, lane, *rest in found[:MAX_TABLE_ROWS]],
               (0, None, None, 1, 1, 2))
    if len(found) > MAX_TABLE_ROWS:
        page.note(tr("{count} more are in the layer (field exceeds).").format(count=len(found) - MAX_TABLE_ROWS))


def _worst(run, name):
    if name == "rut":
        return max(value for row in run for value in (row["rut_l_mm"], row["rut_r_mm"]) if value is not None)
    values = [row[VALUE_OF_LIMIT[name]] for row in run]
    return min(values, key=abs) if name in ("width", "clearance") else max(values, key=abs)


def _road(page, road, rows, limits, interval):
    page.heading(tr("Road {road}").format(road=road))
    page.table((tr("Part"), tr("Sections"), tr("Width (m)"), tr("Crossfall (%)"), "± (%)", tr("Grade (%)"), tr("Rut left (mm)"), tr("Rut right (mm)"),
                tr("Least clearance (m)")),
               [_summary(name, part) for name, part in _parts(rows).items()], (None, 0, 2, 2, 2, 2, 1, 1, 2))
    page.note(tr("Medians along the road. ± is the standard deviation of a crossfall, with what roll leaves unknown."))
    station = (min(row["station_m"] for row in rows) - interval / 2, max(row["station_m"] for row in rows) + interval / 2)
    _plan(page, rows, station, interval)
    for title, unit, names, part, levels, limit in _charts():
        _chart(page, rows, station, interval, (title, unit, names, part, [(name, sign * getattr(limits, name)) for name, sign in levels
                                                                             if getattr(limits, name) is not None], limit))


def _parts(rows):
    found = defaultdict(list)
    for row in sorted(rows, key=lambda one: (one["lane"] or 0)):
        found[tr("lane {number}").format(number=row["lane"]) if row["lane"] else word("carriageway")].append(row)
    return found


def _summary(name, rows):
    def median(field):
        values = [row[field] for row in rows if row[field] is not None]
        return float(np.median(values)) if values else None

    clear = [row["clear_m"] for row in rows if row["clear_m"] is not None]
    return (name, len(rows), *(median(field) for field in ("width_m", "crossf_pct", "crossf_sig", "grade_pct", "rut_l_mm", "rut_r_mm")),
            min(clear) if clear else None)


def _plan(page, rows, station, interval):
    """The sections from above, straightened: the same height on the page whatever way the road runs."""
    reach = [row["offset_m"] + side * row["width_m"] / 2 for row in rows for side in (-1, 1)]
    chart = Chart(station, (min(reach) - 0.5, max(reach) + 0.5), tr("Station (m)"), tr("Offset (m)"))
    for over, colour in ((False, KEPT_COLOUR), (True, PLAN_EXCEEDED_COLOUR)):
        own = [row for row in rows if bool(row["exceeds"]) == over and (row["lane"] or over or not any(one["lane"] for one in rows))]
        if own:
            middle = np.array([row["station_m"] for row in own])
            width = np.array([row["width_m"] for row in own])
            chart.bars(middle - 0.35 * interval, middle + 0.35 * interval, width, colour, np.array([row["offset_m"] for row in own]) - width / 2)
    page.drawing(chart.svg(), tr("The lanes from above, straightened. Red: a limit is exceeded."))


def _chart(page, rows, station, interval, what):
    title, unit, names, part, levels, limit = what
    series = {name: some for name, some in _parts([row for row in rows if row["part"] == part]).items()}
    values = {name: [_value(row, names) for row in some] for name, some in series.items()}
    known = [value for some in values.values() for value in some if value is not None]
    if not known:
        return
    # limits far off would flatten what was measured
    near = [level for _, level in levels if min(known) - np.ptp(known) - 1 < level < max(known) + np.ptp(known) + 1]
    low, high = min([*known, *near]), max([*known, *near])
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
    for k, (name, some) in enumerate(series.items()):
        colour = LANE_COLOURS[k % len(LANE_COLOURS)]
        s, y = _with_gaps([row["station_m"] for row in some], values[name], interval)
        chart.curve(s, y, colour, name, 2.0)
        drawn.append((colour, name))
    page.drawing(chart.svg(), title)
    if len(drawn) > 1:
        page.colour_key(drawn)


def _value(row, names):
    values = [row[name] for name in names if row[name] is not None]
    return max(values) if values else None


def _with_gaps(stations, values, interval):
    """Stations and values of a curve; a value that stands alone is drawn as a short dash, a missing section as a gap."""
    s, y = [], []
    for at, value in zip(stations, values):
        if s and at - s[-1] > 1.2 * interval:
            s.append(at)
            y.append(np.nan)
        s += [at - 0.2 * interval, at + 0.2 * interval]
        y += [np.nan if value is None else value] * 2
    return np.array(s), np.array(y)
