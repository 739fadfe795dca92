"""Which lines part the two directions of traffic, and which bound the road: what lines say of each other."""

import numpy as np

from .linking import TWIN

TWO_LANES = 5.0      # m between the outer lines of a road of two lanes
SAME_OFFSET = 0.25   # m: a lone dash this near the course of a dashed line is one of its dashes
GOES_ON = 40.0       # m: over a junction, between a double line and the dashes that take its place
ONE_LANE = 2.2, 5.5  # m of carriageway on either side of a line that is alone: a lane, with a gutter or a cycle lane


def outer_lines_alone(chosen):
    """Two solid lines with room for two lanes and no line between them are the road's edge lines.

    The road's own edge is no help there: where there is no curb, a smooth verge may pass for carriageway.
    """
    solid = [one for one in chosen if not one.double and all(piece.pattern == "solid" for piece in one.pieces)]
    pairs = [(one, other) for one in solid for other in solid
             if TWO_LANES <= other.level - one.level and max(_shared(one, [other]), _shared(other, [one])) > 0.5]
    for one, other in pairs:
        between = [inner for inner in chosen if one.level + TWIN[1] < inner.level < other.level - TWIN[1]]
        if not _shared(one, between) and not _shared(other, between):
            one.kind = other.kind = "edge"


def one_centre(chosen):
    """A road has one centre line at a place.

    Where it is double, solid lines beside it are lane lines; of two solid lines the
    one nearer the middle of what is painted is the centre line. A dashed line on the
    course of a centre line is that line's dashed part.
    """
    inner = [one for one in chosen if one.kind == "centre" and not one.double]
    for one in inner:
        if _shared(one, [other for other in chosen if other.double]) > 0.5:
            one.kind = "lane"
    rest = [one for one in inner if one.kind == "centre"]
    for one in sorted(rest, key=lambda one: -_off_centre(one, chosen)):
        if _shared(one, [other for other in rest if other is not one and other.kind == "centre"]) > 0.5:
            one.kind = "lane"
    central = [one for one in chosen if one.kind == "centre"]
    for one in chosen:
        if one.kind == "lane" and any(_on_course(one, other, central) for other in central) and not _shared(one, central):
            one.kind = "centre"


def _on_course(one, other, central):
    """Whether a line lies where a centre line would go on; of a double line its middle counts, and only near its ends."""
    if not other.double:
        return abs(other.level - one.level) <= SAME_OFFSET
    twins = [twin.level for twin in central if twin.double and abs(twin.level - other.level) <= TWIN[1] and _shared(other, [twin])]
    apart = max(one.span[0] - other.span[1], other.span[0] - one.span[1])
    return abs(float(np.mean(twins)) - one.level) <= SAME_OFFSET and apart <= GOES_ON


def _shared(one, others):
    """Share of a line's stations beside any of the others."""
    first, last = one.span
    together = max((min(last, other.span[1]) - max(first, other.span[0]) for other in others), default=0.0)
    return max(together, 0.0) / max(last - first, 1e-6)


def _off_centre(one, chosen):
    """Metres between a line and the middle of the outermost lines beside it."""
    beside = [other.level for other in chosen if _shared(one, [other]) > 0.3]
    return abs(one.level - (max(beside) + min(beside)) / 2) if beside else 0.0


def lone_centre(chosen, passes):
    """A dashed line alone on its road, with room for one lane on either side, parts the two directions.

    The lane that was driven is taken to reach as far beyond the vehicle as the line lies on
    its other side; beyond the line the road's edge says how much room there is. Not
    where one direction was driven on both sides: those are two lanes of a one-way road.

    passes : the Passes of the road
    """
    for one in chosen:
        others = [other for other in chosen if other is not one]
        if one.kind != "lane" or _shared(one, others) > 0.5 or not ONE_LANE[0] <= one.room <= ONE_LANE[1]:
            continue
        beside = _driven_beside(one, passes)
        driven = {way: {side for direction, side, _ in beside if direction == way} for way in (1, -1)}
        if any(ONE_LANE[0] <= 2 * away <= ONE_LANE[1] for _, _, away in beside) and max(map(len, driven.values())) < 2:
            one.kind = "centre"


def _driven_beside(one, passes):
    """[(direction, side of the line, metres away)] of the passes along a line."""
    s, d, *_ = one.line.places()
    found = []
    for drive in passes:
        there = (s >= drive.span[0]) & (s <= drive.span[1])
        if there.mean() > 0.5:
            away = float(np.median(drive.at_station(s[there])[0] - d[there]))
            found.append((int(drive.direction), bool(away > 0), abs(away)))
    return found
