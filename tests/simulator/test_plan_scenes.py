"""Motorway, serpentine, crossing and roundabout: the points and the truth of each agree, and the road is what its name says."""

from dataclasses import replace
from functools import cached_property

import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.simulator.orthophoto import uav_control_points
from lanewright.simulator.parts.materials import CARRIAGEWAY_LABELS, LABEL
from lanewright.simulator.parts.obstacles import Rail
from lanewright.simulator.plan.trace import trace
from lanewright.simulator.survey import SampleSettings, make_sample_survey

PLANS = ("motorway", "serpentine", "crossing", "roundabout")
CURBED = ("crossing", "roundabout")
GROUND = [LABEL[name] for name in ("road", "paint", "worn paint", "manhole", "gutter", "curb face", "curb stone", "sidewalk", "shoulder", "verge")]


class Surveyed:
    """A thin survey of a scene; its points without noise are made when first asked for."""

    made = {}

    def __init__(self, scene):
        self.sample = make_sample_survey(SampleSettings(scene=scene, pulse_rate=10_000.0, rotation_rate=50.0))
        self.origin = np.array(self.sample.settings.origin)

    @cached_property
    def true(self):
        return self.sample.points(noise=False)

    @classmethod
    def of(cls, scene):
        if scene not in cls.made:
            cls.made[scene] = cls(scene)
        return cls.made[scene]

    def flat(self, layer):
        return [shapely.force_2d(geometry) for geometry in layer.geometries]


@pytest.fixture(params=PLANS)
def plan(request):
    return Surveyed.of(request.param)


@pytest.fixture(params=CURBED)
def curbed(request):
    return Surveyed.of(request.param)


def labelled(points, *names):
    return points[np.isin(points["label"], [LABEL[name] for name in names])]


@pytest.mark.slow
def test_without_noise_every_ground_point_lies_on_the_true_surface(plan):
    ground = plan.true[np.isin(plan.true["label"], GROUND)]
    x, y, z = (ground[axis] - plan.origin[k] for k, axis in enumerate("xyz"))
    assert len(ground) > 30_000
    off = np.abs(z - plan.sample.scene.height(x, y))
    # halfway between two edges, the strips of both meet with a step of some millimetres
    assert np.quantile(off, 0.9999) < 1e-3 and off.max() < 0.02


@pytest.mark.slow
def test_a_pulse_meets_the_first_ground_on_its_way(plan):
    """Against steps of 1 cm along the pulses."""
    drive, scene = plan.sample.drives[0], plan.sample.scene
    origin, direction, _, _ = plan.sample.scanners[0].pulses(drive, np.arange(300, 360))
    random = np.random.default_rng(1)
    some = random.choice(np.flatnonzero(direction[2] < -0.12), 400, replace=False)
    origin, direction = origin[:, some], direction[:, some]
    found = trace(scene.ground, origin, direction, 24.0)
    t = np.arange(1.0, 26.0, 0.01)
    x, y, z = origin[:, :, None] + direction[:, :, None] * t
    below = z < scene.height(x.ravel(), y.ravel()).reshape(z.shape)
    met = below.any(axis=1) & (found < 20.0)
    first = t[below.argmax(axis=1)]
    assert met.sum() > 200
    # a step may pass over an edge of a curb by less than its length
    assert np.mean(np.abs(found - first)[met] < 0.011) > 0.995


@pytest.mark.slow
def test_paint_is_brighter_inside_true_markings_than_beside_them(plan):
    road = labelled(plan.true, "road", "paint", "worn paint")
    painted = shapely.union_all(plan.flat(plan.sample.truth_markings))
    inside = shapely.contains_xy(shapely.buffer(painted, -0.03), road["x"], road["y"])
    beside = shapely.contains_xy(shapely.buffer(painted, 0.3), road["x"], road["y"]) & ~shapely.contains_xy(
        shapely.buffer(painted, 0.03), road["x"], road["y"])
    for low, high in ((3, 5), (5, 7), (7, 10)):
        near = (road["range"] > low) & (road["range"] < high)
        assert np.median(road["intensity"][near & inside]) > 2.5 * np.median(road["intensity"][near & beside])


@pytest.mark.slow
def test_painted_points_lie_in_the_true_markings(plan):
    painted = shapely.union_all(plan.flat(plan.sample.truth_markings))
    paint, road = labelled(plan.true, "paint", "worn paint"), labelled(plan.true, "road")
    assert shapely.contains_xy(shapely.buffer(painted, 0.005), paint["x"], paint["y"]).all()
    assert not shapely.contains_xy(shapely.buffer(painted, -0.005), road["x"], road["y"]).any()


@pytest.mark.slow
def test_the_ground_steps_up_at_true_curbs_by_the_true_height(curbed):
    road, stone = labelled(curbed.true, *("road", "paint", "gutter", "worn paint")), labelled(curbed.true, "curb stone")
    stones, roads = (shapely.STRtree(shapely.points(part["x"], part["y"])) for part in (stone, road))
    seen = 0
    for geometry, row in curbed.sample.truth_boundaries:
        if row["part"] == "top" or row["edge"] != "curb" or geometry.length < 4.0:
            continue
        line = shapely.force_2d(geometry)
        above = stone[stones.query(line, predicate="dwithin", distance=0.12)]
        near = road[roads.query(line, predicate="dwithin", distance=0.10)]
        if len(above) < 30 or len(near) < 30:
            continue
        # neighbours along the curb, so that neither slope nor ramp counts
        along = [shapely.line_locate_point(line, shapely.points(part["x"], part["y"])) for part in (above, near)]
        order = np.argsort(along[1])
        step = above["z"] - np.interp(along[0], along[1][order], near["z"][order])
        assert np.median(step) == pytest.approx(row["height_m"], abs=0.012)
        seen += 1
    assert seen > 4


@pytest.mark.slow
def test_curb_faces_are_hit_where_the_true_curbs_are(curbed):
    face = labelled(curbed.true, "curb face")
    bottoms = shapely.union_all([shapely.force_2d(g) for g, row in curbed.sample.truth_boundaries if row["part"] == "bottom"])
    distance = shapely.distance(shapely.points(face["x"], face["y"]), bottoms)
    inside = distance < 2.0   # the truth ends at the border of the survey a little before the points
    assert len(face) > 1000 and np.mean(distance[inside] < 0.03) > 0.99


@pytest.mark.slow
def test_the_true_surface_holds_the_carriageway_and_nothing_else(plan):
    surface = shapely.union_all(plan.flat(plan.sample.truth_surface))
    area = shapely.transform(plan.sample.scene.area, lambda places: places + plan.origin[:2])
    points = plan.true[np.isin(plan.true["label"], GROUND)]
    points = points[shapely.contains_xy(area, points["x"], points["y"])]
    inside = shapely.contains_xy(surface, points["x"], points["y"])
    assert np.mean(inside == np.isin(points["label"], CARRIAGEWAY_LABELS)) > 0.998


def test_edges_of_the_carriageway_bound_the_true_surface(plan):
    surface = shapely.union_all(plan.flat(plan.sample.truth_surface))
    for geometry, row in plan.sample.truth_boundaries:
        if row["part"] == "bottom":
            places = shapely.points(shapely.get_coordinates(geometry))
            assert shapely.distance(places, surface.boundary).max() < 0.01


def test_a_driven_lane_runs_where_and_in_the_direction_in_which_it_was_driven(plan):
    track = plan.sample.trajectory
    tree = shapely.STRtree(shapely.points(track.x, track.y))
    heading = np.radians(90.0 - track.heading)
    driven = 0
    for geometry, _ in plan.sample.truth_driving_lines:
        places = shapely.get_coordinates(geometry)
        ahead = np.diff(places, axis=0)
        nearest = tree.nearest(shapely.points(places[:-1]))
        beside = np.hypot(*(places[:-1] - np.column_stack([track.x, track.y])[nearest]).T) < 1.0
        if beside.mean() < 0.5:
            continue
        driven += 1
        along = ahead[:, 0] * np.cos(heading[nearest]) + ahead[:, 1] * np.sin(heading[nearest])
        assert np.all(along[beside] > 0)
    assert driven == {"motorway": 2, "serpentine": 1, "crossing": 4, "roundabout": 4}[plan.sample.settings.scene]


def test_a_driving_line_is_the_middle_between_the_borders_of_its_lane(plan):
    for lane, (geometry, row) in zip(plan.sample.scene.lanes, plan.sample.truth_driving_lines):
        places = shapely.get_coordinates(geometry)[::row["direction"]] - plan.origin[:2]
        left, right = lane.path.at(lane.stations, lane.left), lane.path.at(lane.stations, lane.right)
        np.testing.assert_allclose(places, (left + right) / 2, atol=1e-6)
        assert np.all(lane.left - lane.right > 1.8)


def test_neighbouring_lanes_of_opposite_directions_pass_each_other_on_the_left(plan):
    """Right-hand traffic."""
    for lane in plan.sample.scene.lanes:
        opposite = [other for other in plan.sample.scene.lanes if other.path is lane.path and other.direction == -lane.direction]
        assert all(lane.direction * (np.median(other.left) - np.median(lane.left)) > 0 for other in opposite)


def test_true_shapes_are_valid_and_carry_heights(plan):
    sample = plan.sample
    for layer in (sample.truth_markings, sample.truth_surface, sample.truth_boundaries, sample.truth_driving_lines, sample.truth_lanes):
        names = {field.name for field in layer.schema}
        assert len(layer)
        for geometry, row in layer:
            assert geometry.is_valid and geometry.has_z and set(row) <= names


def test_the_trajectory_rides_at_sensor_height_and_looks_ahead(plan):
    t = plan.sample.trajectory
    height = t.z - plan.origin[2] - plan.sample.scene.ground.terrain.at(t.x - plan.origin[0], t.y - plan.origin[1])[0]
    on = shapely.contains_xy(plan.sample.scene.area, t.x - plan.origin[0], t.y - plan.origin[1])
    np.testing.assert_allclose(height[on], 2.6, atol=0.02)
    steps = np.hypot(np.diff(t.x), np.diff(t.y))
    off = (t.heading[:-1] - np.degrees(np.arctan2(np.diff(t.x), np.diff(t.y))) + 180) % 360 - 180
    assert np.abs(off[steps < 1.0]).max() < 1.0


@pytest.mark.slow
def test_the_same_seed_makes_the_same_survey():
    settings = SampleSettings(scene="serpentine", length=30.0, seed=5, pulse_rate=5_000.0, rotation_rate=25.0)
    one, same, other = (make_sample_survey(replace(settings, seed=seed)).points() for seed in (5, 5, 6))
    assert one.tobytes() == same.tobytes()
    assert len(other) != len(one) or not np.array_equal(other["x"], one["x"])


@pytest.mark.slow
@pytest.mark.parametrize("scene, metres", [("motorway", 700.0), ("serpentine", 180.0)])
def test_where_there_is_no_curb_the_truth_is_edges_of_the_pavement_and_rails_beside_it(scene, metres):
    plan = Surveyed.of(scene)
    rows = plan.sample.truth_roadside.rows
    assert {row["kind"] for row in rows} == {"guard_rail"} and sum(row["length_m"] for row in rows) > metres
    assert set(plan.sample.truth_boundaries.column("edge")) == {"pavement"}
    assert len(labelled(plan.true, "curb face", "curb stone", "sidewalk")) == 0


@pytest.mark.slow
def test_a_motorway_has_broad_edge_lines_a_median_rails_and_a_hatched_gore():
    plan = Surveyed.of("motorway")
    lines = [row for _, row in plan.sample.truth_markings if row["class"] == "edge line"]
    assert {row["width_m"] for row in lines} == {0.30}
    assert "hatching" in plan.sample.truth_markings.column("class")
    assert "island" in plan.sample.truth_boundaries.column("kind")
    assert len(labelled(plan.true, "rail")) > 500
    assert len({row["lane"] for _, row in plan.sample.truth_driving_lines}) == 5


def test_the_exit_leaves_the_motorway_on_the_right_and_nobody_drives_in_the_gore():
    plan = Surveyed.of("motorway")
    exits = next(geometry for geometry, row in plan.sample.truth_driving_lines if row["lane"] == 5)
    through = next(geometry for geometry, row in plan.sample.truth_driving_lines if row["lane"] == 4)
    places = shapely.get_coordinates(exits)
    apart = shapely.distance(shapely.points(places), shapely.force_2d(through))
    assert apart[-1] > apart[0] + 3.0 and np.all(np.diff(apart) > -0.05)
    gore = shapely.convex_hull(shapely.union_all([shapely.force_2d(g) for g, row in plan.sample.truth_markings if row["class"] == "hatching"]))
    assert not any(shapely.force_2d(geometry).intersects(gore) for geometry, _ in plan.sample.truth_driving_lines)


def test_hairpins_have_a_radius_of_12_m_are_wider_and_lean_inward():
    scene = Surveyed.of("serpentine").sample.scene
    axis = scene.lanes[0].path
    s = np.arange(0.0, 200.0, 0.5)
    bend = axis.curvature(s)
    assert np.abs(bend).max() == pytest.approx(1 / 12, rel=0.02)
    hairpin, straight = np.abs(bend) > 0.99 / 12, np.abs(bend) < 1e-4
    upward, downward = scene.lanes[1], scene.lanes[0]
    left, right = np.interp(s, downward.stations, downward.left), np.interp(s, upward.stations, upward.right)
    assert (left - right)[hairpin].mean() == pytest.approx((left - right)[straight].mean() + 1.8, abs=0.15)
    sign = np.sign(bend[hairpin])
    inner, outer = (scene.height(*axis.at(s[hairpin], way * sign * 2.0).T) for way in (1, -1))
    np.testing.assert_allclose((outer - inner) / 4.0, 0.06, atol=0.008)


@pytest.mark.parametrize("scene", ["motorway", "serpentine"])
def test_no_rail_stands_on_the_carriageway(scene):
    scene = Surveyed.of(scene).sample.scene
    rails = [thing for thing in scene.obstacles if isinstance(thing, Rail)]
    assert len(rails) > 20
    for rail in rails:
        along = np.linspace(-rail.length / 2, rail.length / 2, 20)
        assert not shapely.contains_xy(scene.carriageway, rail.x + along * np.cos(rail.heading), rail.y + along * np.sin(rail.heading)).any()


def test_curbs_are_dropped_at_the_zebra_crossings_and_the_truth_says_so(curbed):
    zebras = shapely.union_all([shapely.force_2d(g) for g, row in curbed.sample.truth_markings if row["class"] == "zebra crossing"])
    dropped = [shapely.force_2d(g) for g, row in curbed.sample.truth_boundaries if row["edge"] == "dropped" and row["part"] == "bottom"]
    assert sum(shapely.distance(line, zebras) < 1.2 for line in dropped) >= 6   # those of the arm where nobody drove have no paint here
    assert all(line.length < 8.0 for line in dropped)
    assert all(row["height_m"] < 0.05 for _, row in curbed.sample.truth_boundaries if row["edge"] == "dropped")


def test_corners_bend_between_the_curbs_of_neighbouring_arms():
    sample = Surveyed.of("crossing").sample
    corners = [g for g, row in sample.truth_boundaries if row["kind"] == "corner" and row["part"] == "bottom" and row["edge"] == "curb"]
    assert len(corners) >= 3
    longest = shapely.get_coordinates(max(corners, key=lambda line: line.length))
    x, y = (longest - longest.mean(axis=0)).T
    arc = slice(len(x) // 4, 3 * len(x) // 4)
    solution = np.linalg.lstsq(np.column_stack([x, y, np.ones(len(x))])[arc], (x**2 + y**2)[arc], rcond=None)[0]
    assert np.sqrt(solution[2] + (solution[:2] / 2) @ (solution[:2] / 2)) == pytest.approx(8.0, abs=0.1)
    assert {"main", "side_street", "corner"} == set(sample.truth_boundaries.column("kind"))
    assert {"arrow", "stop line", "zebra crossing", "lane line", "centre line", "edge line"} == set(sample.truth_markings.column("class"))


def test_a_roundabout_is_a_ring_about_an_island_with_two_splitter_islands_in_each_driven_arm():
    sample = Surveyed.of("roundabout").sample
    surface = shapely.force_2d(max(sample.truth_surface.geometries, key=lambda part: part.area))
    areas = sorted(shapely.Polygon(ring).area for ring in surface.interiors)
    assert areas[-1] == pytest.approx(np.pi * 7.5**2, rel=0.01)
    assert len(areas) >= 7
    blocks = [g for g, row in sample.truth_markings if row["class"] == "stop line"]
    assert len(blocks) >= 12 and all(g.area == pytest.approx(0.25, abs=0.01) for g in blocks)


@pytest.mark.slow
@pytest.mark.parametrize("scene, length", [("motorway", 90.0), ("crossing", 140.0)])
def test_a_plan_of_another_length_has_truth_too(scene, length):
    """Shorter and longer than usual."""
    sample = make_sample_survey(SampleSettings(scene=scene, length=length))
    for layer in (sample.truth_markings, sample.truth_surface, sample.truth_boundaries, sample.truth_driving_lines, sample.truth_lanes):
        assert len(layer) and all(geometry.is_valid for geometry in layer.geometries)


def test_a_scene_that_cannot_be_so_long_is_refused_with_what_can_be():
    with pytest.raises(RoadExtractionError, match="crossing cannot be 4000 m long. Choose from 20 to 300 m, or 0 for the usual 110 m"):
        SampleSettings(scene="crossing", length=4000.0)
    with pytest.raises(RoadExtractionError, match="street cannot be 5 m long"):
        SampleSettings(length=5.0)
    assert SampleSettings(scene="motorway").length == 240.0


def test_a_plan_has_no_uav_image_and_says_so():
    with pytest.raises(RoadExtractionError, match="no UAV image of the scene crossing"):
        uav_control_points(Surveyed.of("crossing").sample)


@pytest.mark.parametrize("scene", PLANS)
def test_a_true_lane_lies_about_its_driving_line_between_its_borders_left_one_first(scene):
    sample = Surveyed.of(scene).sample
    assert len(sample.truth_lanes) == len(sample.truth_driving_lines)
    for (lane, row), (line, same) in zip(sample.truth_lanes, sample.truth_driving_lines):
        assert (row["lane"], row["direction"], row["station_m"]) == (same["lane"], same["direction"], same["station_m"])
        ring, middle = shapely.get_coordinates(lane.exterior)[:-1], shapely.get_coordinates(line)
        left, right = ring[:len(middle)], ring[len(middle):][::-1]
        np.testing.assert_allclose((left + right) / 2, middle, atol=1e-6)
        ahead = np.gradient(middle, axis=0)
        assert np.all(ahead[:, 0] * (left - right)[:, 1] - ahead[:, 1] * (left - right)[:, 0] > 0)
        assert np.median(np.hypot(*(left - right).T)) == pytest.approx(row["width_m"])
