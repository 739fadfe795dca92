"""Lanes of a long road: those of its stretches, for as much work and memory as these take one by one."""

from functools import wraps

import numpy as np
import pytest
from counted_calls import calls
from lanewright.core.common.features import ROAD_EDGES, Features
from lanewright.core.driving.alignment import LanesOfRoad, fitted_lanes, without_short_status
from lanewright.core.driving.driving_lines import DrivingSettings, make_driving_lines
from lanewright.core.driving.lane_areas import follow
from lanewright.core.driving.lane_track import LaneTrack, connect
from lanewright.core.driving.lanes import laid_out
from lanewright.core.execution.in_step import in_step
from lanewright.core.execution.keep import Keep
from lanewright.core.execution.phase import Threads
from lanewright.core.markings.cross_section import estimate
from lanewright.core.markings.cross_section.candidates import boundary_candidates, gather_boundaries
from lanewright.core.markings.cross_section.estimate import sections_of_stretch
from lanewright.core.markings.cross_section.evidence import driven_offsets, evidence_of
from lanewright.core.markings.cross_section.sections import sections_of_lines
from lanewright.core.markings.cross_section.weights import BARE, EstimateWeights
from lanewright.core.markings.lines.painted_lines import PaintedLines
from lanewright.core.road.edges.road_edges import RoadEdges
from lined_streets import EAST, HEIGHT, NORTH, Street
from shapely.geometry import LineString

BLOCK = 100.0   # m from one junction to the next
FEW, MANY = 20, 80


def street(blocks):
    """Two lanes with edge lines that end before every junction, and dashes between them."""
    found = Street(length=BLOCK * blocks)
    for at in BLOCK * np.arange(blocks):
        found.paint(3.5, at + 5.0, at + 60.0, kind="edge").paint(-3.5, at + 5.0, at + 60.0, kind="edge")
        found.paint(0.0, at + 5.0, at + 60.0, kind="centre", pattern="dashed")
    return found


def painted(blocks):
    made = street(blocks)
    return PaintedLines.from_features(made.lines, made.frame), made.frame


def lanes_of(blocks):
    """Two lanes of each block, and one that opens beside them."""
    found = []
    for at in (200 * np.arange(blocks)).tolist():
        for first, count, d in ((at, 120, -1.75), (at, 120, 1.75), (at + 60, 60, -5.25)):
            values = dict(d=np.full(count, d), width=np.full(count, 3.5), status=np.zeros(count, int), offset=np.zeros(count, bool),
                          **{name: np.full(count, -1) for name in ("left", "right", "left_use", "right_use")},
                          **{name: np.ones(count) for name in ("probability", "confidence")})
            found.append(LaneTrack(first, direction=1 if d < 0 else -1, **values))
    return found


def test_two_streets_end_to_end_give_the_lanes_of_each():
    def lanes(blocks):
        driving, _, _ = make_driving_lines(*painted(blocks), DrivingSettings(max_bridge=0.0))
        return np.array(sorted(zip(driving.station, driving.end, driving.direction)))

    one, two = lanes(1), lanes(2)
    assert len(one) == 2
    # grids of stations are cut half a metre apart
    np.testing.assert_allclose(two, np.concatenate([one, one + [BLOCK, BLOCK, 0]]), atol=0.51)


def beside_curbs(moved):
    """Least and greatest offsets of all borders of lanes on the last 300 m of a street of 1.8 km.

    Only its middle is painted, cars park on the left, where nobody drove, and the right curb is moved near its start.
    """
    made = Street(length=1800.0).paint(0.0, kind="centre", pattern="dashed")
    s, layer = np.arange(5.0, 1795.5, 0.5), Features("LineStringZ", ROAD_EDGES)
    for side, d in (("left", np.full(len(s), 5.8)), ("right", np.where((s > 100.0) & (s < 400.0), moved, 0.0) - 3.5)):
        layer.add(LineString(np.c_[made.places(s, d), np.full(len(s), HEIGHT)]), road=0, side=side, status="measured", kind="main", edge="curb")
    lines, edges = PaintedLines.from_features(made.lines, made.frame), RoadEdges.from_features(layer, made.frame)
    _, _, lanes = make_driving_lines(lines, made.frame, edges=edges)
    borders = [border[:, :2] + made.frame.origin[:2] - [EAST, NORTH] for k in range(len(lanes)) for border in lanes.borders(k)]
    return sorted([limit(y[x > 1500.0]) for x, y in (border.T for border in borders) if (x > 1500.0).any() for limit in (np.min, np.max)])


def test_a_curb_that_is_corrected_moves_no_lane_a_kilometre_farther_on():
    as_measured, corrected = (beside_curbs(moved) for moved in (0.0, -0.6))
    assert len(as_measured) == 8
    np.testing.assert_allclose(corrected, as_measured, atol=1e-4)


def test_a_correction_leaves_the_cross_sections_of_other_stretches_known(monkeypatch):
    """Of five kilometres less than one is looked at again, also where the first line then begins earlier."""
    def road(begin, end):
        made = street(50).paint(6.5, begin, end, kind="edge")
        of_lines = sections_of_lines(PaintedLines.from_features(made.lines, made.frame))[0]
        candidates = boundary_candidates(gather_boundaries(of_lines), EstimateWeights())
        return candidates, evidence_of(candidates, of_lines.s, *driven_offsets(made.frame, 0, of_lines.s)), -1, round(of_lines.s[0] / 0.5)

    looked_at = []
    monkeypatch.setattr(estimate, "sections_of_stretch", wraps(estimate.sections_of_stretch)(
        lambda source, item, *settings: looked_at.append(item[0].length.sum()) or sections_of_stretch(source, item, *settings)))
    executor, lengths = Keep(Threads(1)), []
    for line in ((1010.0, 1090.0), (1010.0, 1140.0), (1.0, 90.0)):
        found, = estimate.estimates_of_roads([road(*line)], 3.5, EstimateWeights(), executor)
        assert np.isfinite(found.total)
        lengths.append(sum(looked_at))
        looked_at.clear()
    assert lengths[0] > 1000.0 > max(lengths[1:])


def test_a_line_that_is_corrected_moves_no_border_on_bare_asphalt_two_kilometres_before():
    def bare(moved):
        made = Street(length=3000.0, vehicle=0.0).paint(5.0, 5.0, 400.0, kind="edge").paint(-5.0, 5.0, 400.0, kind="edge")
        made.paint(0.0, 2000.0, 2990.0).paint(3.5, 2000.0, 2990.0, kind="edge")
        made.paint(lambda s: -3.5 - moved * ((s > 2500.0) & (s < 2600.0)), 2000.0, 2990.0, kind="edge")
        lines = sections_of_lines(PaintedLines.from_features(made.lines, made.frame))[0]
        found = gather_boundaries(lines)
        return np.concatenate([found.d[row, :][(lines.s > 100.0) & (lines.s < 300.0)] for row in np.flatnonzero(found.made_of == BARE).tolist()])

    as_measured = bare(0.0)
    assert np.unique(np.round(as_measured[np.isfinite(as_measured)], 3)).tolist() == [-1.5, 1.5]
    np.testing.assert_array_equal(bare(-0.3), as_measured)


def test_tables_hold_the_stations_at_which_a_line_is():
    """Not all stations of the road for every line."""
    for blocks in (FEW, MANY):
        lines = sections_of_lines(painted(blocks)[0])[0]
        ends = np.array([lines.s[[0, -1]]] * 2) * [[0.0], [0.0]] + [[3.6], [-3.6]]
        found = gather_boundaries(lines, surface=np.repeat(ends[:, :1], len(lines.s), axis=1))
        assert lines.d.values.size < 3 * blocks * (60.0 + 2 * 9.5) / 0.5
        assert found.d.values.size == lines.d.values.size + 2 * len(lines.s)
        assert len(boundary_candidates(found, EstimateWeights()).first) < 20 * blocks


def test_lanes_are_compared_with_those_beside_them():
    """Four times the lanes take four times the calls."""
    lines, frame = painted(MANY)
    sections = sections_of_lines(lines)[0]
    work = dict(
        joined=lambda tracks: connect(tracks, 20.0), tapers=laid_out,
        curves=lambda tracks: in_step([fitted_lanes([LanesOfRoad(tracks, sections.s, frame.roads[0])])], Threads(1)))
    for name, function in work.items():
        few, many = (calls(lambda tracks=lanes_of(blocks): function(tracks)) for blocks in (FEW // 2, MANY // 2))
        assert many < 1.2 * MANY / FEW * few, name


@pytest.mark.parametrize("way", [1, -1])
def test_what_follows_a_lane_is_looked_for_where_it_ends(way):
    def rows(count):
        return [dict(lane_id=f"0.{k}.1", direction=way, station=50.0 * k, end=50.0 * (k + 1), first=0.0, last=0.0, width=3.5) for k in range(count)]

    few, many = rows(FEW), rows(MANY)
    assert calls(lambda: follow(many)) < 1.2 * MANY / FEW * calls(lambda: follow(few))
    ahead = [row["successors"] for row in many][::way]
    assert ahead == [(many[k + way]["lane_id"],) for k in range(MANY)[::way][:-1]] + [()]


def merged_one_by_one(status, shortest):
    """The shortest of the short pieces, of equal ones the first, takes the worse of its neighbours, again and again."""
    while True:
        cuts = np.r_[0, np.flatnonzero(np.diff(status)) + 1, len(status)]
        k = int(np.argmin(np.diff(cuts)))
        if len(cuts) == 2 or cuts[k + 1] - cuts[k] >= shortest:
            return status
        beside = [status[i] for i in (cuts[k] - 1, cuts[k + 1]) if 0 <= i < len(status)]
        status[cuts[k]:cuts[k + 1]] = max(beside)


@pytest.mark.parametrize("seed", range(20))
def test_short_changes_of_status_take_the_worse_of_their_neighbours(seed):
    rng = np.random.default_rng(seed)
    status = np.repeat(rng.integers(0, 3, 40), rng.integers(1, 25, 40))
    assert without_short_status(status).tolist() == merged_one_by_one(status.copy(), 10).tolist()
