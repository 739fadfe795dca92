"""The values of fields in the user's words. In English they are shown as they stand in the layers."""

from __future__ import annotations

from typing import Any

from .texts import language, tr


def word(value: Any, field: str = "") -> str:
    """A value of a field in the user's words; a dash for none.

    Parameters
    ----------
    value : of any type; a word of the vocabulary below, or a name or number, which stay as they are
    field : which one, where a word means different things in different fields
    """
    if value is None or value == "":
        return "–"
    if language() == "en":
        return str(value)
    words = _words()
    return words.get(f"{field}.{value}") or words.get(str(value)) or str(value)


def _words():
    return {
        # of any field
        "left": tr("left"), "right": tr("right"), "measured": tr("measured"), "bridged": tr("bridged"), "inferred": tr("inferred"),
        "occluded": tr("hidden"), "grown": tr("grown"), "accepted": tr("accepted"), "drawn": tr("drawn"), "unknown": tr("unknown"),
        "together": tr("together"), "carriageway": tr("carriageway"), "lane": tr("lane"),
        # road edges
        "curb": tr("curb"), "dropped": tr("dropped curb"), "pavement": tr("edge of the pavement"), "main": tr("main carriageway"),
        "corner": tr("corner of a curb"), "side_street": tr("side street"), "island": tr("island"),
        "profiles": tr("profiles"), "scanlines": tr("scanlines"),
        # markings and lines
        **{f"{field}.{value}": text for field in ("class", "kind") for value, text in (
            ("edge", tr("Edge line")), ("lane", tr("Lane line")), ("centre", tr("Centre line")))}, "zebra": tr("Zebra crossing"),
        "stop": tr("Stop line"), "give_way": tr("Give-way line"), "zigzag": tr("Zigzag line"),
        "arrow": tr("Arrow"), "symbol": tr("Symbol"), "hatch": tr("Hatching"), "class.bicycle": tr("Bicycle symbol"), "bus": tr("Word BUS"),
        "use.keep": tr("marking"), "use.other": tr("other paint"),
        "solid": tr("solid"), "dashed": tr("dashed"), "double-solid": tr("double, solid"), "double-dashed": tr("double, dashed"),
        "solid-dashed": tr("solid and dashed"), "dashed-solid": tr("dashed and solid"),
        # lanes
        "pair": tr("between two lines"), "offset": tr("beside one line"), "driving": tr("Driving lane"), "shoulder": tr("Shoulder"),
        "parking": tr("Parking"), "bicycle": tr("Bicycle lane"), "hatched": tr("Hatched area"), "median": tr("Median"),
        "connector": tr("Connector over a junction"),
        # corrections
        "accept": tr("accept"), "delete": tr("delete"), "move": tr("move"), "draw": tr("draw"), "target.edge": tr("road edge"),
        "marking": tr("marking"),
        # where scanners lie
        "ahead": tr("ahead"), "behind": tr("behind"), "above": tr("above"), "below": tr("below"),
        # the roadside
        "guard_rail": tr("guard rail"), "barrier": tr("barrier"), "wall": tr("Wall"), "fence": tr("fence"), "hedge": tr("hedge"),
        "gutter": tr("Gutter"), "pole": tr("pole"), "sign": tr("sign"), "trunk": tr("Tree trunk"),
        # cross-sections
        "rut": tr("rut depth"), "crossfall": tr("crossfall"), "grade": tr("grade"), "width": tr("width"), "clearance": tr("clearance"),
        # assessment
        "correct": tr("correct"), "missed": tr("missed"), "false": tr("false"), "excluded": tr("excluded"),
        # control points
        "control": tr("Control point"), "check": tr("Check point"), "disabled": tr("Disabled point"),
        # ends of a road, elements of its reference line
        "start": tr("start"), "end": tr("end"),
        "element.line": tr("line"), "arc": tr("arc"), "spiral": tr("clothoid"), "paramPoly3": tr("parametric cubic"),
    }
