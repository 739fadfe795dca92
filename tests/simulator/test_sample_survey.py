"""The made survey: its points lie where the street is, and nothing is seen through a car."""

import numpy as np
import pytest
import shapely
from lanewright.simulator.parts.materials import CARRIAGEWAY_LABELS, LABEL
from lanewright.simulator.scenes import SCENES
from lanewright.simulator.survey import SampleSettings, make_sample_survey

GROUND = [LABEL[name] for name in ("road", "paint", "worn paint", "manhole", "gutter", "curb face", "curb stone",
                                   "sidewalk", "shoulder", "verge")]


STREETS = [scene for scene in SCENES if scene not in ("motorway", "serpentine", "crossing", "roundabout")]   # along one axis


def survey(scene="street", length=40.0, **settings):
    """A thin survey, quick to make: a tenth of the pulses of the demo's."""
    return make_sample_survey(SampleSettings(**{
        "scene": scene, "length": length, "pulse_rate": 60_000.0, "rotation_rate": 100.0, **settings}))


@pytest.fixture(scope="module")
def street():
    return survey(length=80.0)


@pytest.fixture(scope="module")
def true_points(street):
    return street.points(noise=False)


@pytest.fixture(scope="module")
def noisy_points(street):
    return street.points()


def labelled(points, *names):
    return points[np.isin(points["label"], [LABEL[name] for name in names])]


def above_ground(sample, points):
    """Height of points over the true ground at their true station and offset."""
    return points["z"] - sample.settings.origin[2] - sample.scene.height(points["station"], points["offset"])


@pytest.mark.slow
@pytest.mark.parametrize("scene", STREETS)
def test_without_noise_every_ground_point_lies_on_the_true_surface(scene):
    sample = survey(scene, length=130.0, pulse_rate=8_000.0, rotation_rate=50.0)
    points = sample.points(noise=False)
    ground = points[np.isin(points["label"], GROUND)]
    assert len(ground) > 12_000
    assert np.abs(above_ground(sample, ground)).max() < 1e-3
    x, y, _ = sample.scene.to_map(points["station"], points["offset"])
    x0, y0, _ = sample.settings.origin
    assert np.hypot(points["x"] - x0 - x, points["y"] - y0 - y).max() < 1e-3


def test_every_point_lies_on_the_pulse_of_its_scanner(street, true_points):
    """The range given is the distance to the scanner, within 3 m of the trajectory's point at that moment."""
    t = street.trajectory
    here = np.stack([np.interp(true_points["time"], t.time, axis) for axis in (t.x, t.y, t.z)])
    distance = np.linalg.norm(here - np.stack([true_points[axis] for axis in "xyz"]), axis=0)
    arm = np.hypot(2.45, 0.32)
    assert np.abs(distance - true_points["range"]).max() < arm + 0.01


def test_the_road_surface_is_where_the_axis_says_in_a_bend():
    sample = survey(length=100.0)
    axis = sample.scene.axis
    assert axis.curvature(np.array([70.0]))[0] == pytest.approx(1 / 120)
    s, d = np.meshgrid(np.linspace(-20, 120, 300), np.linspace(-18, 18, 40))
    x, y = axis.to_map(s.ravel(), d.ravel())
    found_s, found_d, *_ = axis.locate(x, y, s.ravel() + 10.0, steps=3)
    np.testing.assert_allclose(found_s, s.ravel(), atol=1e-4)
    np.testing.assert_allclose(found_d, d.ravel(), atol=1e-4)


def test_an_arc_is_a_circle_of_the_stated_radius():
    axis = survey(length=100.0).scene.axis
    x, y = axis.to_map(np.linspace(52.0, 93.0, 200), np.zeros(200))
    solution = np.linalg.lstsq(np.column_stack([x, y, np.ones(200)]), x**2 + y**2, rcond=None)[0]
    centre = solution[:2] / 2
    radius = np.sqrt(solution[2] + centre @ centre)
    assert radius == pytest.approx(120.0, abs=1e-3)


@pytest.mark.parametrize("side", ["left", "right"])
def test_curb_faces_are_hit_from_bottom_to_top_where_they_are(street, true_points, side):
    face = labelled(true_points, "curb face")
    sign, edge = (1, street.scene.left.edge) if side == "left" else (-1, street.scene.right.edge)
    face = face[sign * face["offset"] > 0]
    away = sign * face["offset"] - edge
    assert len(face) > 200
    assert away.min() >= -1e-6 and away.max() <= 0.025 + 1e-6
    height = face["z"] - street.settings.origin[2] - street.scene.height(face["station"], np.full(len(face), sign * edge))
    assert height.min() < 0.02 and height.max() > 0.10


def test_the_truth_of_a_curb_is_its_height_in_the_points(street, true_points):
    for _geometry, row in street.truth_boundaries:
        if row["part"] == "top" or row["end_m"] - row["station_m"] < 8.0:
            continue
        sign, edge = (1, street.scene.left.edge) if row["side"] == "left" else (-1, street.scene.right.edge)
        along = (true_points["station"] > row["station_m"] + 2) & (true_points["station"] < row["end_m"] - 2)
        away = sign * true_points["offset"] - edge
        below = true_points[along & (away > -0.05) & (away < 0) & np.isin(true_points["label"], CARRIAGEWAY_LABELS)]
        above = true_points[along & (away > 0.025) & (away < 0.175) & (true_points["label"] == LABEL["curb stone"])]
        assert len(below) > 5 and len(above) > 5
        level = [np.median(part["z"] - street.settings.origin[2] - street.scene.grade_line(part["station"]))
                 for part in (below, above)]
        assert level[1] - level[0] == pytest.approx(row["height_m"], abs=0.005)


def test_curbs_are_lowered_at_the_driveway_and_the_truth_says_so(street):
    dropped = [(row["station_m"], row["end_m"]) for _, row in street.truth_boundaries
               if row["side"] == "left" and row["part"] == "bottom" and row["edge"] == "dropped"]
    assert any(start < 43 and end > 46 for start, end in dropped)
    height = street.scene.left.curb(np.array([44.5, 60.0]))
    np.testing.assert_allclose(height, [0.02, 0.12])


def test_curb_truth_runs_along_bottoms_at_the_ground(street):
    x0, y0, z0 = street.settings.origin
    for geometry, row in street.truth_boundaries:
        x, y, z = np.array(geometry.coords).T
        side = street.scene.left if row["side"] == "left" else street.scene.right
        s, d, *_ = street.scene.axis.locate(x - x0, y - y0, np.linspace(row["station_m"], row["end_m"], len(x)), steps=3)
        expected = side.edge if row["part"] == "bottom" else side.edge + 0.025
        np.testing.assert_allclose(side.sign * d, expected, atol=1e-3)
        rise = 0.0 if row["part"] == "bottom" else side.curb(s)
        np.testing.assert_allclose(z - z0 - street.scene.edge_height(side, s), rise, atol=1e-3)


def test_a_country_road_has_no_curb():
    sample = survey("rural")
    assert sample.truth_boundaries.column("edge") == ["pavement", "pavement"]
    assert len(labelled(sample.points(noise=False), "curb face", "curb stone", "sidewalk")) == 0


@pytest.mark.slow
def test_parked_cars_hide_the_curb_and_open_kerbside_shows_it():
    sample = survey(length=80.0, pulse_rate=120_000.0)
    points = sample.points(noise=False)
    cars = labelled(points, "car")
    assert len(cars) > 500
    near = np.zeros(800, dtype=bool)
    near[np.unique((cars["station"][cars["offset"] < 0] * 10).astype(int))] = True
    face = labelled(points, "curb face")
    seen = np.bincount((face["station"][face["offset"] < 0] * 10).astype(int), minlength=800)[:800] > 0
    # Pulses come aslant, so a car hides the curb behind its middle, and hides none 4 m away from it.
    behind = np.convolve(near, np.ones(25), "same") == 25
    far = np.convolve(near, np.ones(80), "same") == 0
    assert behind.sum() > 20 and far.sum() > 100
    assert seen[behind].mean() < 0.1
    assert seen[far].mean() > 0.95


def test_no_pulse_goes_through_a_car(street, true_points):
    """Between the scanner and each point the way is free: no body holds its middle points."""
    cars = [thing for thing in street.scene.obstacles if thing.label == LABEL["car"]]
    t = street.trajectory
    points = true_points[np.isin(true_points["label"], GROUND)][::7]
    # The scanner from the trajectory: level enough that 0.1 m of the body's own size covers roll and pitch.
    heading = np.radians(np.interp(points["time"], t.time, np.unwrap(t.heading, period=360)))
    side = np.where(points["scanner"] == 1, 0.32, -0.32)
    start = np.stack([
        np.interp(points["time"], t.time, t.x) - 2.45 * np.sin(heading) - side * np.cos(heading),
        np.interp(points["time"], t.time, t.y) - 2.45 * np.cos(heading) + side * np.sin(heading),
        np.interp(points["time"], t.time, t.z)])
    end = np.stack([points[axis] for axis in "xyz"])
    inside = 0
    for car in cars:
        cos, sin = np.cos(car.heading), np.sin(car.heading)
        turn = np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
        middle = np.array([[car.x], [car.y], [car.z]]) + np.array(street.settings.origin)[:, None]
        shell = car.bodies[0]
        for share in np.linspace(0.6, 0.99, 60):
            place = turn @ (start + share * (end - start) - middle)
            inside += np.count_nonzero(np.all(shell.normals @ place < shell.limits[:, None] - 0.15, axis=0))
    assert inside == 0


def test_a_thing_in_the_way_takes_the_pulse_from_the_ground_behind_it(street):
    from lanewright.simulator.parts.scanner import OBSTACLE, cast

    drive = street.drives[0]
    origin, direction, times, _ = street.scanners[0].pulses(drive, np.arange(200, 240))
    station = float(drive.station(times.mean()))
    bare = street.scene.meet(origin, direction, station, 18.0)
    full = cast(street.scene, origin, direction, station, np.random.default_rng(1), 18.0)
    caught = full.strip == OBSTACLE
    assert np.count_nonzero(caught & np.isfinite(bare.distance)) > 100
    assert np.all(full.distance[caught] < bare.distance[caught])
    np.testing.assert_array_equal(full.distance[~caught], bare.distance[~caught])


def test_trees_and_poles_stand_on_the_ground(street, true_points):
    for name, least in (("tree", 2000), ("pole", 100)):
        things = labelled(true_points, name)
        height = above_ground(street, things)
        assert len(things) > least
        assert height.min() > -0.05 and height.max() > 3.0


def test_points_get_rarer_away_from_the_vehicle(true_points):
    """Per square metre, on the left, where nothing is parked."""
    count, _ = np.histogram(true_points["offset"][np.isin(true_points["label"], GROUND)], bins=[0, 3, 6, 9, 12, 15])
    assert np.all(np.diff(count) < 0)


def test_paint_is_brighter_than_asphalt_at_the_same_range(noisy_points):
    for low, high in ((3, 4), (5, 6), (7, 9)):
        at = noisy_points[(noisy_points["range"] > low) & (noisy_points["range"] < high)]
        paint, asphalt = (np.median(labelled(at, name)["intensity"]) for name in ("paint", "road"))
        assert paint > 2.5 * asphalt


def test_asphalt_darkens_with_range(noisy_points):
    road = labelled(noisy_points, "road")
    median = [np.median(road["intensity"][(road["range"] > low) & (road["range"] < low + 1)]) for low in (3, 5, 7)]
    assert median[0] > median[1] > median[2]


def test_worn_paint_is_gone_in_the_share_the_truth_states():
    sample = survey("rural", length=80.0)
    points = sample.points(noise=False)
    for number, (_, row) in enumerate(sample.truth_markings):
        marking = sample.scene.paint.markings[number]
        on = points[np.abs(points["offset"] - marking.places[0][1]) < 0.05]
        worn = np.count_nonzero(on["label"] == LABEL["worn paint"])
        assert len(on) > 500
        assert worn / len(on) == pytest.approx(row["wear"], abs=0.08)


def test_painted_points_lie_in_the_true_markings(street, true_points):
    import shapely

    paint = labelled(true_points, "paint", "worn paint")
    union = shapely.union_all([shapely.force_2d(geometry) for geometry in street.truth_markings.geometries])
    inside = shapely.contains_xy(shapely.buffer(union, 0.005), paint["x"], paint["y"])
    assert inside.all()
    road = labelled(true_points, "road")
    assert not shapely.contains_xy(shapely.buffer(union, -0.005), road["x"], road["y"]).any()


@pytest.mark.parametrize("scene", STREETS)
def test_true_shapes_are_valid_and_carry_heights(scene):
    sample = survey(scene, length=130.0)
    for layer in (sample.truth_markings, sample.truth_surface, sample.truth_boundaries, sample.truth_driving_lines, sample.truth_lanes):
        names = {field.name for field in layer.schema}
        for geometry, row in layer:
            assert geometry.is_valid and geometry.has_z
            assert set(row) <= names


def test_the_street_has_every_kind_of_marking():
    kinds = set(survey(length=120.0).truth_markings.column("class"))
    assert kinds == {"edge line", "centre line", "lane line", "stop line", "zebra crossing", "arrow"}
    assert "hatching" in survey("urban", length=120.0).truth_markings.column("class")


@pytest.mark.parametrize("yaw, slant", [(0.0, 0.0), (30.0, 0.577), (45.0, 1.0)])
def test_a_turned_scanner_looks_ahead_on_one_side_and_back_on_the_other(yaw, slant):
    points = survey(length=40.0, mount_yaw=yaw).points(noise=False)
    # out of one turn the points of one scanner on the road
    own = points[(points["scanner"] == 1) & (points["time"] - points["time"][0] > 1.5) & np.isin(points["label"], GROUND)]
    own = own[own["time"] - own["time"][0] < 0.01]
    right, left = own["offset"].argmin(), own["offset"].argmax()
    apart = (own["station"][left] - own["station"][right]) / (own["offset"][left] - own["offset"][right])
    assert abs(abs(apart) - slant) < 0.12


@pytest.mark.parametrize("scene", ["street", "rural", "urban"])
def test_driving_lines_run_in_the_direction_of_travel_on_the_right_side(scene):
    sample = survey(scene, length=120.0)
    x0, y0, z0 = sample.settings.origin
    for geometry, row in sample.truth_driving_lines:
        x, y, z = np.array(geometry.coords).T
        ends = [row["station_m"], row["end_m"]][::row["direction"]]
        s, d, *_ = sample.scene.axis.locate(x - x0, y - y0, np.linspace(*ends, len(x)), steps=3)
        assert np.all(np.diff(s) * row["direction"] > 0)
        assert np.all(d * row["direction"] < 0)
        np.testing.assert_allclose(z - z0, sample.scene.height(s, d), atol=1e-3)


def test_the_left_lane_runs_on_through_the_crossing_to_the_end():
    lines = [row for _, row in survey(length=250.0).truth_driving_lines if row["direction"] == -1]
    assert [(row["station_m"], row["end_m"]) for row in lines] == [(0.0, 250.0)]


def test_the_true_surface_holds_the_carriageway_and_nothing_else(street, true_points):
    import shapely

    polygon = shapely.force_2d(street.truth_surface.geometries[0])
    inside = shapely.contains_xy(polygon, true_points["x"], true_points["y"])
    ground = np.isin(true_points["label"], GROUND)
    on_road = np.isin(true_points["label"], CARRIAGEWAY_LABELS)
    assert np.mean(inside[ground] == on_road[ground]) > 0.9995


def test_the_same_seed_makes_the_same_survey_and_another_one_another():
    one, same, other = (survey(length=20.0, seed=seed, pulse_rate=10_000.0).points() for seed in (5, 5, 6))
    assert one.tobytes() == same.tobytes()
    assert len(other) != len(one) or not np.array_equal(other["x"], one["x"])


def test_range_noise_is_five_millimetres():
    sample = survey(length=20.0)
    points = labelled(sample.points(), "road")
    steep = points[np.abs(points["offset"] + 1.8) < 1.5]
    x, y, z0 = sample.settings.origin
    s, d, *_ = sample.scene.axis.locate(steep["x"] - x, steep["y"] - y, steep["station"])
    error = steep["z"] - z0 - sample.scene.height(s, d)
    assert 0.003 < error.std() < 0.006 and abs(error.mean()) < 0.0005


def test_the_trajectory_rides_at_sensor_height_and_looks_ahead(street):
    t = street.trajectory
    x0, y0, z0 = street.settings.origin
    s, d, *_ = street.scene.axis.locate(t.x - x0, t.y - y0, np.linspace(-15, 95, len(t)), steps=3)
    height = t.z - z0 - street.scene.height(s, d)
    np.testing.assert_allclose(height, 2.6, atol=0.02)
    np.testing.assert_allclose(np.diff(t.time), 0.005, atol=1e-6)
    driven = np.degrees(np.arctan2(np.diff(t.x), np.diff(t.y)))
    off = (t.heading[:-1] - driven + 180) % 360 - 180
    assert np.abs(off).max() < 0.5
    assert s[0] < 0 and s[-1] > 80


def test_a_city_street_is_driven_in_both_directions():
    sample = survey("urban", length=20.0, pulse_rate=10_000.0)
    t = sample.trajectory
    pause = np.flatnonzero(np.diff(t.time) > 10)
    assert len(pause) == 1
    turned = (t.heading[pause[0]] - t.heading[-1]) % 360
    assert 150 < turned < 210
    assert set(np.unique(sample.points()["pass"])) == {1, 2}


def test_a_concrete_gutter_lies_along_the_curb_and_shines_brighter_than_asphalt():
    sample = survey("urban", length=20.0, gutter=0.30)
    points = sample.points()
    gutter, road = labelled(points, "gutter"), labelled(points, "road")
    side = np.where(gutter["offset"] > 0, sample.scene.left.edge, sample.scene.right.edge)
    assert len(gutter) > 1000
    assert np.all((np.abs(gutter["offset"]) > side - 0.30) & (np.abs(gutter["offset"]) <= side))
    at = [part[(part["range"] > 3) & (part["range"] < 4)]["intensity"] for part in (gutter, road)]
    assert np.median(at[0]) > 1.5 * np.median(at[1])


@pytest.mark.parametrize("scene", STREETS)
def test_a_true_lane_lies_about_its_driving_line_between_its_borders_left_one_first(scene):
    sample = survey(scene, length=130.0)
    assert len(sample.truth_lanes) == len(sample.truth_driving_lines)
    for (lane, row), (line, same) in zip(sample.truth_lanes, sample.truth_driving_lines):
        assert (row["lane"], row["direction"], row["station_m"]) == (same["lane"], same["direction"], same["station_m"])
        ring, middle = shapely.get_coordinates(lane.exterior)[:-1], shapely.get_coordinates(line)
        left, right = ring[:len(middle)], ring[len(middle):][::-1]
        np.testing.assert_allclose((left + right) / 2, middle, atol=1e-6)
        ahead = np.gradient(middle, axis=0)
        assert np.all(ahead[:, 0] * (left - right)[:, 1] - ahead[:, 1] * (left - right)[:, 0] > 0)
        assert np.median(np.hypot(*(left - right).T)) == pytest.approx(row["width_m"])
