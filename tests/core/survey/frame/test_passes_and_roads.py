"""How a drive becomes passes and roads."""

from dataclasses import replace

import numpy as np
import pytest
from drives import EAST, NORTH, ahead, bend, chain, drive, joined, standing
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.trajectory.trajectory import Trajectory, clean_trajectory
from scipy.ndimage import gaussian_filter1d

STREET = chain(ahead(300))


def spans(frame):
    """[(road, direction, first and last station to the metre)] of every pass."""
    return [(p.road, p.direction, round(p.span[0]), round(p.span[1])) for p in frame.passes]


def test_a_plain_drive_is_one_pass_over_one_road():
    frame = build_frame(drive(STREET))
    assert spans(frame) == [(0, 1, 0, 300)]
    assert frame.roads[0].length == pytest.approx(299.8, abs=0.2)


def test_a_turn_on_the_street_gives_two_passes_of_opposite_direction_over_one_road():
    frame = build_frame(drive(chain(ahead(150), bend(2.5, 180), ahead(150)), speed=5))
    assert [(p.road, p.direction) for p in frame.passes] == [(0, 1), (0, -1)]
    np.testing.assert_allclose(np.median(frame.passes[1].d), 5.0, atol=0.05)
    assert np.abs(frame.roads[0].curvature(np.arange(0.0, 150.0))).max() < 0.01, "the turn bends the vehicle, not the road"


@pytest.mark.parametrize("radius, turn", [(8, 180), (10, 180), (15, 175), (6, 160)])
def test_a_hairpin_is_one_road(radius, turn):
    frame = build_frame(drive(chain(ahead(150), bend(radius, turn), ahead(150)), speed=5))
    assert len(frame.roads) == len(frame.passes) == 1
    assert frame.roads[0].length == pytest.approx(300 + radius * np.radians(turn), abs=1.5)


def test_a_serpentine_of_five_hairpins_is_one_road():
    turns = [piece for k in range(5) for piece in (ahead(60), bend(12, 170 if k % 2 else -170))]
    frame = build_frame(drive(chain(*turns), speed=5))
    assert len(frame.roads) == len(frame.passes) == 1


def test_a_roundabout_driven_straight_through_is_one_road():
    path = chain(ahead(100), bend(15, -60), bend(12, 120), bend(15, -60), ahead(100))
    frame = build_frame(drive(path, speed=5))
    assert len(frame.roads) == len(frame.passes) == 1


def ring(radius, first, last):
    angles = np.radians(np.linspace(first, last, int(abs(last - first)) + 1))
    return radius * np.c_[np.cos(angles), np.sin(angles)]


def arm(radius, angle, aside):
    u, (cos, sin) = np.arange(60.0, radius + 5.0, -1.0)[:, None], (np.cos(np.radians(angle)), np.sin(np.radians(angle)))
    return u * [cos, sin] + aside * np.array([-sin, cos])


def smooth(*pieces):
    """A path through the pieces, with a position for every 0.1 m, as a vehicle can drive it."""
    path = np.concatenate(pieces)
    way = np.r_[0.0, np.cumsum(np.hypot(*np.diff(path, axis=0).T))]
    path = np.column_stack([np.interp(np.arange(0.0, way[-1], 0.1), way, axis) for axis in path.T])
    return gaussian_filter1d(path, 15, axis=0, mode="nearest")


@pytest.mark.parametrize("radius", [5, 8, 9, 10])
def test_who_drives_straight_over_a_small_roundabout_does_not_leap_to_the_arm_that_another_drive_came_from(radius):
    """The first drive crosses from the west to the east, the second one comes from the south and goes round to the west."""
    over = smooth(arm(radius, 180, 3.0), ring(radius, 205, 305), arm(radius, 0, -3.0)[::-1])
    round_it = smooth(arm(radius, 270, 3.0), ring(radius, 285, 500), arm(radius, 180, -3.0)[::-1])
    frame = build_frame(joined(drive(over, speed=5), drive(round_it, speed=5, start=2000.0)))
    assert max(np.abs(np.diff(p.s)).max() for p in frame.passes) < 1.0
    assert sum(np.hypot(np.diff(p.x), np.diff(p.y)).sum() for p in frame.passes) > 0.97 * 0.1 * (len(over) + len(round_it)), "all of both drives"


@pytest.mark.parametrize("radius", [5, 6, 8, 10])
def test_who_turns_back_round_a_roundabout_drives_there_and_back_over_one_straight_road(radius):
    frame = build_frame(drive(smooth(arm(radius, 180, 3.0), ring(radius, 205, 515), arm(radius, 180, -3.0)[::-1]), speed=5))
    road, (out, back) = frame.roads[0], frame.passes
    assert len(frame.roads) == 1 and out.direction == -back.direction
    assert np.abs(road.curvature(np.arange(0.0, road.length))).max() < 1 / 30, "the road goes straight over the island, not round it"
    for p in (out, back):
        assert np.abs(np.diff(p.s)).max() < 1.0
        np.testing.assert_allclose(np.column_stack(road.to_map(p.s, p.d)), np.c_[p.x, p.y], atol=0.01)


@pytest.mark.parametrize("aside, way", [(0.5, 1), (3.5, -1), (-3.5, 1)])
def test_a_street_driven_twice_is_one_road_with_two_passes(aside, way):
    again = STREET[::way] + [0.0, aside]
    frame = build_frame(joined(drive(STREET), drive(again, start=2000.0)))
    assert [(p.road, p.direction) for p in frame.passes] == [(0, 1), (0, way)]
    np.testing.assert_allclose(frame.passes[1].d, aside, atol=0.01)


@pytest.mark.parametrize("speed", [15, 25, 45])
def test_a_motorway_driven_there_and_back_with_one_position_a_second_has_one_pass_each_way(speed):
    """Its positions lie as far apart as stations leap between the arms of a roundabout."""
    path = chain(ahead(700), bend(500, 40), ahead(700))
    frame = build_frame(joined(drive(path, speed, rate=1.0), drive(path[::-1] + [0.0, 8.0], speed, rate=1.0, start=2000.0)))
    assert [p.road for p in frame.passes] == [0, 0] and frame.passes[0].direction == -frame.passes[1].direction
    assert all(np.ptp(p.s) > 1749 - 2 * speed for p in frame.passes)


def test_where_a_pass_in_a_higher_lane_turns_off_the_height_of_the_road_makes_no_step():
    """On a crossfall the lanes lie 15 cm apart in height; a step of half of that across the road would be a curb."""
    beside = drive(STREET[:1500] + [0.0, 5.0], start=2000.0, height=2.15)
    frame = build_frame(joined(drive(STREET), beside))
    heights = frame.track_height(0, np.arange(0.0, 300.0, 0.25)) + frame.origin[2]
    assert np.abs(np.diff(heights)).max() < 0.002
    assert heights[300] == pytest.approx(102.075, abs=0.001) and heights[-1] == pytest.approx(102.0, abs=0.001)


def test_a_block_driven_round_twice_gives_two_passes_in_the_same_direction():
    block = chain(ahead(100), bend(10, 90), ahead(60), bend(10, 90), ahead(100), bend(10, 90), ahead(60), bend(10, 90))
    frame = build_frame(drive(np.concatenate([block, block]), speed=5))
    assert len(frame.roads) == 1
    assert [p.direction for p in frame.passes] == [1, 1]
    for p in frame.passes:
        assert (np.diff(p.s) > -0.01).all(), "the station never leaps back within a pass"


def test_a_figure_of_eight_is_cut_where_it_crosses_itself():
    frame = build_frame(drive(chain(bend(40, 360), bend(40, -360))))
    assert len(frame.roads) == 2
    for road in frame.roads:
        assert road.length == pytest.approx(2 * np.pi * 40, abs=15)


@pytest.mark.parametrize("climb", [0.0, 6.0])
def test_a_road_that_crosses_itself_has_one_station_at_the_crossing(climb):
    path = chain(ahead(160), bend(40, -270), ahead(160))
    loop = drive(path)
    share = np.linspace(0.0, 1.0, len(loop))
    loop = Trajectory(loop.time, loop.x, loop.y, loop.z + climb * np.clip(3 * share - 1, 0, 1))
    frame = build_frame(loop)
    assert len(frame.passes) == len(frame.roads) == 2
    crossing = path[1200]
    x, y = frame.to_local(EAST + crossing[0], NORTH + crossing[1])
    for road in frame.roads:
        away = np.hypot(road.x - x, road.y - y)
        near = np.flatnonzero(away < 20.0)
        assert len(near) and (np.diff(near) == 1).all(), "the road passes the crossing once"
        assert near[0] > 100 and near[-1] < len(road.x) - 100, "and goes on beyond it both ways"


def test_parallel_carriageways_fifteen_metres_apart_are_two_roads():
    frame = build_frame(joined(drive(STREET), drive(STREET[::-1] + [0.0, 15.0], start=2000.0)))
    assert sorted(p.road for p in frame.passes) == [0, 1]


def test_a_ramp_that_winds_up_over_itself_is_not_a_street_driven_twice():
    path = chain(ahead(60), bend(15, 720), ahead(60))
    climbing = drive(path, speed=5)
    share = np.linspace(0.0, 1.0, len(climbing))
    climbing = Trajectory(climbing.time, climbing.x, climbing.y, climbing.z + 12.0 * share)
    for p in build_frame(climbing).passes:
        others = [q for q in build_frame(climbing).passes if q.road == p.road and q.number != p.number]
        for q in others:
            s = np.linspace(max(p.span[0], q.span[0]), min(p.span[1], q.span[1]), 20)
            if s[-1] > s[0]:
                assert np.abs(p.at_station(s)[1] - q.at_station(s)[1]).max() < 3.0


@pytest.mark.parametrize("jitter", [0.0, 0.005, 0.05])
def test_waiting_at_a_light_neither_cuts_nor_lengthens_the_road(jitter):
    first = drive(STREET[:1500])
    wait = standing(first, 60.0, jitter=jitter)
    on = drive(STREET[1500:], start=wait.time[-1] + 0.02)
    frame = build_frame(joined(first, wait, on))
    assert len(frame.roads) == len(frame.passes) == 1
    assert frame.roads[0].length == pytest.approx(299.7, abs=0.6)
    assert np.abs(frame.roads[0].curvature(np.arange(130.0, 170.0))).max() < 0.05


def test_a_pause_while_standing_cuts_the_pass_but_not_the_road():
    first, on = drive(STREET[:1500]), drive(STREET[1500:], start=1060.0)
    frame = build_frame(joined(first, on))
    assert len(frame.roads) == 1
    assert spans(frame) == [(0, 1, 0, 150), (0, 1, 150, 300)]


def test_a_second_drive_that_goes_further_lengthens_the_road():
    frame = build_frame(joined(drive(STREET[:2000]), drive(STREET[800:] + [0.0, 3.0], start=2000.0)))
    assert len(frame.roads) == 1
    assert frame.roads[0].length == pytest.approx(300.0, abs=1.0)
    assert np.abs(frame.roads[0].curvature(np.arange(0.0, 300.0))).max() < 0.03, "led over to the other lane gently"


def test_reversing_twenty_metres_leaves_one_road():
    path = np.concatenate([STREET[:1500], STREET[1500:1300:-1], STREET[1300:]])
    frame = build_frame(drive(path, speed=3))
    assert len(frame.roads) == 1
    assert [p.direction for p in frame.passes] == [1, -1, 1]
    assert frame.roads[0].length == pytest.approx(300.0, abs=1.0)


def test_no_row_of_a_drive_is_lost_between_passes():
    path = np.concatenate([STREET[:1500], STREET[1500:1300:-1], STREET[1300:]])
    trajectory = drive(path, speed=3)
    covered = np.zeros(len(trajectory), bool)
    for p in build_frame(trajectory).passes:
        covered |= (trajectory.time >= p.time[0]) & (trajectory.time <= p.time[-1])
    assert covered.mean() > 0.999


def test_one_position_a_second_gives_the_bend_its_radius():
    path = chain(ahead(100), bend(60, 90), ahead(100))
    frames = [build_frame(drive(path, rate=rate)) for rate in (1.0, 100.0)]
    middle = np.arange(120.0, 175.0)
    np.testing.assert_allclose(frames[0].roads[0].curvature(middle), 1 / 60, rtol=0.12)
    sparse, dense = (np.transpose(frame.roads[0].to_map(middle, 0.0)) + frame.origin[:2] for frame in frames)
    np.testing.assert_allclose(sparse, dense, rtol=0, atol=0.1)


@pytest.mark.parametrize("east, north", [(500_000.0, 500_000.0), (-3_000.0, 7_000_000.0)])
def test_moving_the_survey_moves_the_road_and_nothing_else(east, north):
    path = chain(ahead(100), bend(80, 60), ahead(100))
    here, there = build_frame(drive(path)), build_frame(drive(path, east=EAST + east, north=NORTH + north))
    np.testing.assert_array_equal(there.origin - here.origin, [east, north, 0.0])
    np.testing.assert_allclose(there.roads[0].x, here.roads[0].x, atol=1e-6)
    np.testing.assert_allclose(there.passes[0].d, here.passes[0].d, atol=1e-6)


def test_driving_a_street_the_other_way_mirrors_station_and_offset():
    path = chain(ahead(100), bend(80, 60), ahead(100))
    along, against = build_frame(drive(path)).roads[0], build_frame(drive(path[::-1])).roads[0]
    x, y = along.to_map(np.linspace(20, 240, 50), np.linspace(-8, 8, 50))
    origin_shift = build_frame(drive(path)).origin - build_frame(drive(path[::-1])).origin
    s, d = along.locate(x, y)
    t, e = against.locate(x + origin_shift[0], y + origin_shift[1])
    np.testing.assert_allclose(e, -d, atol=0.01)
    np.testing.assert_allclose(s + t, np.median(s + t), atol=0.05)


def test_rows_in_any_order_give_the_same_road():
    trajectory = drive(chain(ahead(100), bend(80, 60), ahead(100)))
    mixed = trajectory.rows(np.random.default_rng(3).permutation(len(trajectory)))
    np.testing.assert_array_equal(build_frame(mixed).roads[0].x, build_frame(trajectory).roads[0].x)


def test_a_vehicle_that_never_moved_is_refused_in_one_sentence():
    trajectory = drive(STREET).rows(slice(0, 1))
    with pytest.raises(RoadExtractionError, match=r"1 usable position\(s\) over 0.0 m"):
        build_frame(trajectory)


def test_times_that_lost_their_digits_are_refused_as_such():
    trajectory = drive(STREET)
    adjusted = trajectory.time + 318_204_000.0
    with pytest.raises(RoadExtractionError, match="m at one time.*too few digits"):
        build_frame(replace(trajectory, time=adjusted.astype(np.float32).astype(float)))
    # whole seconds are coarse, and tell the order
    assert build_frame(replace(trajectory, time=np.floor(adjusted))).roads


def test_rows_without_a_position_are_dropped_and_counted():
    trajectory = drive(STREET)
    trajectory.x[10:15] = np.nan
    cleaned = clean_trajectory(trajectory)
    assert len(cleaned) == len(trajectory) - 5
    assert cleaned.notes == (f"5 of {len(trajectory)} trajectory rows had no usable time or position and were dropped.",)


def test_rows_of_zeros_are_no_positions_unless_the_drive_passes_there():
    lost = drive(STREET)
    for name in ("x", "y", "z"):
        getattr(lost, name)[np.r_[100:110, -20:0]] = 0.0
    kept = clean_trajectory(lost)
    assert len(kept) == len(lost) - 30
    assert any("30 of" in note and "no usable time or position" in note for note in kept.notes)
    local = drive(STREET, east=0.0, north=0.0)
    assert len(clean_trajectory(local)) == len(local)


def test_repeated_times_keep_one_row():
    trajectory = drive(STREET[:500])
    doubled = joined(trajectory, trajectory)
    cleaned = clean_trajectory(doubled)
    assert len(cleaned) == len(trajectory)
    assert (np.diff(cleaned.time) > 0).all()


def test_a_trajectory_in_degrees_is_refused_before_it_counts_as_standing_still():
    trajectory = Trajectory(np.arange(100.0), np.linspace(8.40, 8.41, 100), np.full(100, 49.0), np.full(100, 100.0), crs="EPSG:4326")
    with pytest.raises(RoadExtractionError, match="degrees"):
        clean_trajectory(trajectory)


def test_a_vehicle_that_only_trembled_is_refused():
    with pytest.raises(RoadExtractionError, match="does not move"):
        build_frame(standing(drive(STREET[:20]), 60.0, jitter=0.02))


def test_a_stray_position_is_dropped_and_counted():
    trajectory = drive(STREET)
    trajectory.y[700] += 35.0
    cleaned = clean_trajectory(trajectory)
    assert len(cleaned) == len(trajectory) - 1 and "1 trajectory rows lay farther" in cleaned.notes[0]
    assert np.abs(build_frame(trajectory).roads[0].curvature(np.arange(0.0, 299.0))).max() < 1e-6


def test_a_drive_through_a_whole_town_keeps_every_row_on_some_road():
    """400 blocks driven at random: streets are met again, crossed, and driven from either side."""
    rng = np.random.default_rng(0)
    corners, way = [np.zeros(2)], np.array([1.0, 0.0])
    for _ in range(400):
        turns = [t for t in (way, way[::-1] * [1, -1], way[::-1] * [-1, 1]) if (corners[-1] + t >= 0).all() and (corners[-1] + t < 12).all()]
        way = turns[rng.integers(len(turns))]
        corners.append(corners[-1] + way)
    corners = np.array(corners) * 100.0
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(corners, axis=0).T))]
    path = np.c_[[gaussian_filter1d(np.interp(np.arange(0.0, along[-1], 0.5), along, c), 8) for c in corners.T]].T
    trajectory = drive(path, rate=10.0)
    frame = build_frame(trajectory)
    covered = np.zeros(len(trajectory), bool)
    for p in frame.passes:
        covered |= (trajectory.time >= p.time[0]) & (trajectory.time <= p.time[-1])
        assert (np.diff(p.s) * p.direction > -0.5).all() and np.abs(p.d).max() < 15.0
    assert covered.mean() > 0.995
    streets = len({tuple(sorted((tuple(a), tuple(b)))) for a, b in zip(corners[:-1].tolist(), corners[1:].tolist())})
    assert sum(road.length for road in frame.roads) == pytest.approx(100.0 * streets, rel=0.15), "each street is one road's, however often driven"
