"""The road surface: what belongs to it on streets whose road is known."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import ROAD_EDGES, Features
from lanewright.core.road.surface.extract import SurfaceSettings
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.open_survey import Survey
from lanewright.core.survey.store.records import SURVEY_POINT, to_units
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.trajectory.trajectory import Trajectory
from road_layers import extract_road_surface

LENGTH, SENSOR, REACH = 60.0, 2.0, 12.0
DENSITY = 150   # points per m²
EAST, NORTH = 500_000.0, 5_400_000.0


def survey(height, density=DENSITY, noise=0.004, roughness=None, intensity=None, section_length=20.0, seed=11, grade=0.0, keep=None, extra=None):
    """A straight street driven along y = 0 as seen by a scanner.

    height : function of s and d (metres) giving z about the road under the track
    roughness : function of d giving additional scatter of z; intensity : function of d
    keep : function of s and d, False where nothing was scanned; extra : (x, y, z) more points
    """
    rng = np.random.default_rng(seed)
    along = np.linspace(0, LENGTH, 601)
    frame = build_frame(Trajectory(1000 + along / 10, along + EAST, np.full(601, NORTH), 100 + SENSOR + grade * along))
    count = int(density * (LENGTH + 8) * 2 * REACH)
    x, y = rng.uniform(-4, LENGTH + 4, count), rng.uniform(-REACH, REACH, count)
    z = height(x, y) + grade * x + rng.normal(0, noise, count)
    if roughness:
        z += rng.normal(0, 1, count) * roughness(y)
    if keep:
        good = keep(x, y)
        x, y, z = x[good], y[good], z[good]
    if extra is not None:
        x, y, z = (np.r_[a, b] for a, b in zip((x, y, z), extra))
    z = z + 100 - frame.origin[2]
    records = np.zeros(len(x), SURVEY_POINT)
    s, d = frame.road(0).locate(x, y)
    records["x"], records["y"], records["z"], records["s"], records["d"] = map(to_units, (x, y, z, s, d))
    records["time"] = 1000 + np.clip(x, 0, LENGTH) / 10
    records["intensity"] = np.rint((intensity(y) if intensity else 1000.0) * rng.lognormal(0, 0.1, len(x)))
    store = SectionStore(SURVEY_POINT, section_length)
    store.append(0, records)
    return Survey([], frame, store, "", {0: SENSOR}, None, [0], True, True)


def curbs(half_width=4.0, curb=0.12):
    return lambda s, d: np.where(np.abs(d) > half_width, curb, 0.0)


def road_edges(left=((0, LENGTH),), right=((0, LENGTH),), half_width=4.0):
    """Edge lines in map coordinates; each side from station to station."""
    edges = Features("LineStringZ", list(ROAD_EDGES))
    for side, sign, pieces in (("left", 1, left), ("right", -1, right)):
        for a, b in pieces:
            s = np.arange(a, b + 0.25, 0.5)
            line = shapely.linestrings(np.c_[s + EAST, np.full(len(s), NORTH + sign * half_width), np.full(len(s), 100.0)])
            edges.add(line, road=0, side=side, status="measured", part="bottom", station_m=float(a), end_m=float(b))
    return edges


def taken(surveyed, edges=None, settings=SurfaceSettings()):
    points, surface = extract_road_surface(surveyed, edges, settings)
    return points.all_points(), surface


def height_of(points, surveyed):
    return points.z + surveyed.frame.origin[2] - 100


def width_seen(points, start, end):
    """(right, left) offsets that the points between two stations reach to, strays aside."""
    d = points.d[(points.s > start) & (points.s < end)]
    return np.percentile(d, 0.1), np.percentile(d, 99.9)


def test_between_two_curbs_every_point_of_the_road_is_taken_and_none_of_the_sidewalk():
    surveyed = survey(curbs())
    points, surface = taken(surveyed, road_edges())
    inside = np.abs(points.d) < 4.0
    assert inside.all() and np.abs(height_of(points, surveyed)).max() < 0.06
    everything = surveyed.store.window(0, 5, 55)
    assert len(points[(points.s >= 5) & (points.s < 55)]) > 0.995 * np.count_nonzero(np.abs(everything.d) < 4.0)
    assert [row["status"] for row in surface.rows] in (["measured"], ["grown", "measured", "grown"])


def test_the_outline_lies_on_the_edges_at_the_height_of_the_road():
    surveyed = survey(curbs(), grade=0.05)
    _, surface = taken(surveyed, road_edges())
    polygon = max(surface.geometries, key=lambda g: g.area)
    x, y, z = shapely.get_coordinates(polygon, include_z=True).T
    np.testing.assert_allclose(np.abs(y - NORTH), 4.0, atol=0.02)
    np.testing.assert_allclose(z, 100 + 0.05 * (x - EAST), atol=0.02)
    assert abs(polygon.area / np.ptp(x) - 8.0) < 0.05
    row = max(surface.rows, key=lambda r: r["area_m2"])
    assert row["points"] > 0.85 * DENSITY * row["area_m2"] and abs(row["area_m2"] - polygon.area) < 0.01


@pytest.mark.parametrize("edges", [None, road_edges()], ids=["grown", "between edges"])
def test_the_outline_ends_where_the_points_do_and_goes_on_across_a_short_gap(edges):
    surveyed = survey(curbs(), keep=lambda s, d: (s > 8.0) & (s < 47.0) & ~((s > 20.0) & (s < 23.0)))
    _, surface = extract_road_surface(surveyed, edges)
    x = np.concatenate([shapely.get_coordinates(polygon)[:, 0] for polygon in surface.geometries]) - surface.geometries[0].bounds[0]
    assert abs(np.ptp(x) - 39.0) < 1.0
    assert sum(row["area_m2"] for row in surface.rows) == pytest.approx(39.0 * 8.0, rel=0.04)


def test_a_road_of_which_four_metres_were_scanned_has_a_surface_of_four_metres():
    """All of it lies in one window, which ended the run before."""
    _, surface = taken(survey(curbs(), keep=lambda s, d: (s > 30.5) & (s < 34.5)), road_edges())
    assert sum(row["area_m2"] for row in surface.rows) == pytest.approx(4.0 * 8.0, rel=0.15)


def test_a_crowned_road_is_taken_to_both_edges():
    surveyed = survey(lambda s, d: curbs()(s, d) - 0.04 * np.abs(d))
    points, _ = taken(surveyed, road_edges())
    right, left = width_seen(points, 5, 55)
    assert left > 3.97 and right < -3.97
    everything = surveyed.store.window(0, 5, 55)
    assert len(points[(points.s >= 5) & (points.s < 55)]) > 0.99 * np.count_nonzero(np.abs(everything.d) < 4.0)


def test_a_banked_road_on_a_hill_is_taken_whole():
    surveyed = survey(lambda s, d: curbs()(s, d) + 0.06 * d, grade=-0.08)
    points, _ = taken(surveyed, road_edges())
    assert len(points[(points.s >= 5) & (points.s < 55)]) > 0.99 * np.count_nonzero(np.abs(surveyed.store.window(0, 5, 55).d) < 4.0)


def parked_car(length=4.5, start=25.0, side=3.0, seed=4):
    """Points of a car's body above y = 2.1 to 3.9, 0.2 to 1.4 m over the road."""
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(start, start + length, 20_000), rng.uniform(side - 0.9, side + 0.9, 20_000)
    return x, y, rng.uniform(0.2, 1.4, 20_000)


def test_a_parked_car_is_not_road_and_the_road_beside_it_is():
    hidden = lambda s, d: ~((s > 25.3) & (s < 29.2) & (d > 2.4) & (d < 6.0))
    surveyed = survey(curbs(), keep=hidden, extra=parked_car())
    points, _ = taken(surveyed, road_edges())
    assert height_of(points, surveyed).max() < 0.07
    beside = (points.s > 25) & (points.s < 29.5)
    assert width_seen(points[beside], 25, 29.5)[0] < -3.95
    assert np.count_nonzero(beside & (points.d < 2.0)) > 0.99 * DENSITY * 4.5 * 6.0 * 0.97


def test_road_beneath_a_parked_car_says_so_and_the_road_beside_it_does_not():
    # laser pulses reach all of the road beneath it here, as they do from the far side of the street
    surveyed = survey(curbs(), extra=parked_car())
    points, _ = taken(surveyed, road_edges())
    beneath = (points.s > 25.2) & (points.s < 29.3) & (points.d > 2.3) & (points.d < 3.7)
    away = (points.s < 24.5) | (points.s > 30.0) | (points.d < 1.6)
    assert points.covered[beneath].mean() > 0.98 and not points.covered[away].any()


def test_branches_high_above_a_road_do_not_cover_it():
    x, y, z = parked_car()
    points, _ = taken(survey(curbs(), extra=(x, y, z + 2.5)), road_edges())
    assert not points.covered.any()


def test_an_island_is_not_road_and_the_far_lane_behind_it_is():
    island = lambda s, d: np.where((s > 20) & (s < 40) & (d > 2) & (d < 3.6), 0.15, 0.0) + np.where(np.abs(d) > 7, 0.12, 0.0) - 0.02 * np.abs(d)
    surveyed = survey(island)
    points, _ = taken(surveyed, road_edges(half_width=7.0))
    there = (points.s > 21) & (points.s < 39)
    assert np.count_nonzero(there & (points.d > 2.05) & (points.d < 3.55)) < 20
    far = np.count_nonzero(there & (points.d > 3.8) & (points.d < 6.9))
    assert far > 0.97 * DENSITY * 18 * 3.1


def test_points_below_the_road_are_not_road():
    rng = np.random.default_rng(5)
    mirrored = rng.uniform(5, 55, 8000), rng.uniform(-4, 4, 8000), rng.uniform(-0.6, -0.25, 8000)
    surveyed = survey(curbs(), extra=mirrored)
    points, _ = taken(surveyed, road_edges())
    assert height_of(points, surveyed).min() > -0.07
    assert len(points[(points.s >= 5) & (points.s < 55)]) > 0.99 * DENSITY * 50 * 8 * 0.98


@pytest.mark.parametrize("verge", ["rough", "ditch", "curb", "low curb"])
def test_without_edges_the_surface_ends_where_the_road_does(verge):
    beyond = {"rough": lambda s, d: np.zeros(len(d)), "ditch": lambda s, d: -0.3 * np.maximum(np.abs(d) - 3.5, 0),
              "curb": curbs(3.5, 0.10), "low curb": curbs(3.5, 0.05)}[verge]
    rough = (lambda d: np.where(np.abs(d) > 3.5, 0.02, 0.0)) if verge == "rough" else None
    points, surface = taken(survey(beyond, roughness=rough, density=200))
    right, left = width_seen(points, 5, 55)
    # 7 cm from its edge a ditch is 2 cm deep
    assert 3.3 < left < 3.57 and -3.57 < right < -3.3
    assert {row["status"] for row in surface.rows} == {"grown"}


@pytest.mark.parametrize("mouth, reach", [((20.0, 35.0), 9.9), ((25.0, 30.0), 4.0)])
def test_a_side_street_belongs_to_a_junction_and_a_short_gap_in_the_verge_does_not(mouth, reach):
    def ground(s, d):
        street = (d > 0) & (s > mouth[0]) & (s < mouth[1])
        return np.where((np.abs(d) > 4.0) & ~street, 0.06 + 0.3 * (np.abs(d) - 4.0), 0.0)

    points, _ = taken(survey(ground, density=400), settings=SurfaceSettings(max_width=10.0))
    right, left = width_seen(points, mouth[0] + 2, mouth[1] - 2)
    assert left == pytest.approx(reach, abs=0.25) and right == pytest.approx(-4.0, abs=0.25)
    assert width_seen(points, 5, 15)[1] == pytest.approx(4.0, abs=0.25)


def test_a_strip_the_scanner_does_not_look_at_ends_no_road_but_a_yard_behind_a_wall_is_none():
    def bank(s, d):
        return np.where(np.abs(d) > 4.0, 0.35 * (np.abs(d) - 4.0), 0.0)

    points, _ = taken(survey(bank, keep=lambda s, d: np.abs(d - 2.3) > 0.35))
    right, left = width_seen(points, 10, 50)
    assert left == pytest.approx(4.0, abs=0.25) and right == pytest.approx(-4.0, abs=0.25)

    def yard(s, d):
        return np.where(d > 2.3, -0.10, bank(s, d))

    points, _ = taken(survey(yard, keep=lambda s, d: np.abs(d - 2.3) > 0.35))
    assert width_seen(points, 10, 50)[1] == pytest.approx(1.95, abs=0.25)


def test_gravel_beside_the_asphalt_is_told_by_its_brightness():
    rough = lambda d: np.where(np.abs(d) > 3.9, 0.02, 0.0)
    bright = lambda d: np.where(np.abs(d) > 3.5, 1150.0, 1000.0)
    points, _ = taken(survey(curbs(20.0), roughness=rough, intensity=bright))
    right, left = width_seen(points, 5, 55)
    assert 3.3 < left < 3.56 and -3.56 < right < -3.3


def test_gravel_twice_as_bright_as_the_asphalt_and_as_smooth_is_no_road_beside_an_edge_line():
    rough = lambda d: np.where(np.abs(d) > 3.8, 0.02, 0.0)
    seen = lambda d: np.select([np.abs(d) > 3.8, np.abs(d) > 3.5, (np.abs(d) > 3.0) & (np.abs(d) < 3.12)], [2600.0, 2000.0, 6000.0], 1000.0)
    points, _ = taken(survey(curbs(20.0), roughness=rough, intensity=seen))
    right, left = width_seen(points, 5, 55)
    assert 3.3 < left < 3.56 and -3.56 < right < -3.3


def test_where_the_road_widens_as_in_a_hairpin_its_edge_is_followed():
    half_width = lambda s: 3.5 + np.interp(s, [15, 30, 45], [0.0, 1.8, 0.0])
    bank = lambda s, d: np.where(np.abs(d) > half_width(s), 0.3 * (np.abs(d) - half_width(s)), 0.0)
    points, _ = taken(survey(bank, density=400))
    for start in np.arange(6, 54, 4.0):
        right, left = width_seen(points, start, start + 2)
        assert left == pytest.approx(half_width(start + 1), abs=0.25) and -right == pytest.approx(half_width(start + 1), abs=0.25)


def test_a_guard_rail_beside_the_road_does_not_pull_its_edge():
    rng = np.random.default_rng(8)
    rail = rng.uniform(0, 60, 30_000), 4.6 + rng.uniform(-0.05, 0.05, 30_000), rng.uniform(0.45, 0.75, 30_000)
    rough = lambda d: np.where(np.abs(d) > 4.0, 0.02, 0.0)
    shadowed = lambda s, d: (d < 4.65) | (rng.random(len(d)) < 0.2)
    points, _ = taken(survey(curbs(20.0), roughness=rough, keep=shadowed, extra=rail))
    right, left = width_seen(points, 5, 55)
    assert 3.75 < left < 4.1 and -4.1 < right < -3.75


def test_an_edge_line_painted_along_the_verge_stays_on_the_road():
    rough = lambda d: np.where(np.abs(d) > 3.5, 0.02, 0.0)
    painted = lambda d: np.where((np.abs(d) > 3.3) & (np.abs(d) < 3.5), 3000.0, 1000.0)
    points, _ = taken(survey(curbs(20.0), roughness=rough, intensity=painted))
    right, left = width_seen(points, 5, 55)
    assert left > 3.38 and right < -3.38


def test_asphalt_beyond_an_edge_line_is_no_strip_of_gravel_that_takes_the_line_along():
    rough = lambda d: np.where(np.abs(d) > 3.65, 0.02, 0.0)
    # what returns from farther is a little weaker
    seen = lambda d: np.select([(np.abs(d) > 3.28) & (np.abs(d) < 3.4), np.abs(d) > 3.4], [4000.0, 920.0], 1000.0)
    points, _ = taken(survey(curbs(20.0), roughness=rough, intensity=seen))
    right, left = width_seen(points, 5, 55)
    assert left > 3.44 and right < -3.44


def test_an_open_square_is_taken_no_farther_than_the_width_asked_for():
    points, _ = taken(survey(curbs(50.0)), settings=SurfaceSettings(max_width=8.0))
    right, left = width_seen(points, 5, 55)
    assert abs(left - 8.0) < 0.15 and abs(right + 8.0) < 0.15


def test_an_edge_on_one_side_only_bounds_that_side_and_the_other_is_grown():
    surveyed = survey(lambda s, d: np.where(d > 4, 0.12, 0.0), roughness=lambda d: np.where(d < -5, 0.02, 0.0))
    points, surface = taken(surveyed, road_edges(right=()))
    right, left = width_seen(points, 5, 55)
    assert 3.95 < left < 4.0 and -5.06 < right < -4.8
    assert {row["status"] for row in surface.rows} == {"grown"}


def mouth(width):
    """A curb opened over `width` metres about station 30 on the left; the ground goes on through it without a step."""
    return lambda s, d: np.where((np.abs(d) > 4) & ~((d > 4) & (np.abs(s - 30) < width / 2)), 0.12, 0.0)


def test_a_side_street_is_road_as_far_as_it_was_scanned_and_the_sidewalks_on_its_sides_are_not():
    points, surface = taken(survey(mouth(10)), road_edges(left=((0, 25), (35, LENGTH))))
    assert width_seen(points, 26, 34)[1] > 11.5
    assert not np.any((points.d > 4.05) & (np.abs(points.s - 30) > 5.3))
    middle = [row["status"] for row in surface.rows if row["station_m"] < 30 < row["end_m"]]
    assert middle == ["grown"]


def test_across_a_driveway_the_road_keeps_its_line():
    points, _ = taken(survey(mouth(5)), road_edges(left=((0, 27), (33, LENGTH))))
    assert 3.9 < width_seen(points, 28, 32)[1] < 4.01


@pytest.mark.parametrize("opening, after, reach", [
    ((27, 33), 4.0, 4.0),     # each edge holds for 5 m beyond its end
    ((15, 45), 4.0, 7.0),     # nobody saw an edge there: the ground decides
    ((27, 33), 7.0, 7.0),     # the second is the far side of a path, and no edge that the first one goes on as
])
def test_where_the_pavement_is_flush_with_a_path_the_road_keeps_its_line_between_two_edges_a_few_metres_apart(opening, after, reach):
    ground = survey(lambda s, d: np.where(d > 7, 0.12, curbs()(s, np.minimum(d, 0))))
    edges = road_edges(left=())
    for piece, offset in (((0, opening[0]), 4.0), ((opening[1], LENGTH), after)):
        part = road_edges(left=(piece,), right=(), half_width=offset)
        edges.add(part.geometries[0], **{**part.rows[0], "edge": "pavement"})
    points, _ = taken(ground, edges)
    assert width_seen(points, opening[0] + 2, opening[1] - 2)[1] == pytest.approx(reach, abs=0.2)


def test_every_point_says_how_far_the_road_reaches_on_its_side():
    points, _ = taken(survey(lambda s, d: np.where((d > 4) | (d < -4), 0.12, 0.0)), road_edges())
    inner = points[(points.s > 5) & (points.s < 55)]
    np.testing.assert_allclose(inner.half_width, 4.0, atol=0.01)
    assert (points.half_width >= np.abs(points.d) - 0.001).all()
    assert np.isnan(points.corrected).all() and (points.cluster == 0).all() and (points.pass_number == 0).all()


def test_the_length_of_sections_changes_nothing():
    height = lambda s, d: curbs(3.5, 0.08)(s, d) - 0.02 * np.abs(d)
    usual, first = taken(survey(height, density=80, extra=parked_car()))
    other, second = taken(survey(height, density=80, extra=parked_car(), section_length=7.0))
    order = [np.lexsort((p.records["z"], p.records["y"], p.records["x"])) for p in (usual, other)]
    for name in ("x", "y", "z", "half_width", "covered", "time"):
        np.testing.assert_array_equal(usual.records[name][order[0]], other.records[name][order[1]])
    assert [g.wkt for g in first.geometries] == [g.wkt for g in second.geometries]


def test_a_noisy_scanner_still_gives_the_whole_road():
    surveyed = survey(curbs(), noise=0.03)
    points, _ = taken(surveyed, road_edges())
    assert len(points[(points.s >= 5) & (points.s < 55)]) > 0.98 * np.count_nonzero(np.abs(surveyed.store.window(0, 5, 55).d) < 4.0)


def test_a_cloud_high_above_the_track_is_no_road():
    surveyed = survey(lambda s, d: np.full(len(d), 2.5))
    with pytest.raises(RoadExtractionError, match="No road surface was found"):
        extract_road_surface(surveyed)


@pytest.mark.parametrize("wrong", [dict(max_width=0.0), dict(height_tolerance=0.0)])
def test_settings_that_leave_no_road_are_refused(wrong):
    with pytest.raises(RoadExtractionError):
        SurfaceSettings(**wrong)


def test_an_edge_bridged_behind_parked_cars_bounds_the_road_and_one_drawn_by_guess_does_not_count_as_measured():
    edges = road_edges()
    edges.rows[0]["status"] = "bridged"
    assert "measured" in {row["status"] for row in taken(survey(curbs()), edges)[1].rows}
    edges.rows[0]["status"] = "inferred"
    assert {row["status"] for row in taken(survey(curbs()), edges)[1].rows} == {"grown"}
