"""What stands beside streets whose roadside is known."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.features import Features
from lanewright.products.inventory.borders import BorderLayers, RoadsideSettings
from lanewright.products.inventory.roadside import find as finding
from lanewright.products.inventory.roadside.chains import find_chains, things_of
from lanewright.products.inventory.roadside.find import find_roadside, roadside_to_features
from lanewright.products.inventory.roadside.uprights import TOP_BINS, Uprights, find_poles
from lanewright.products.report.inventory import roadside_report
from measured_streets import GROUND, SENSOR, Drive, edges_of, measured_road
from roadside_streets import BESIDE, HEIGHTS, LENGTH, Thing, hidden_by, points_of, pole_points, road_with, vans

KINDS = ("guard_rail", "barrier", "wall", "fence", "hedge")
# rails and barriers at the edge, walls, fences and hedges behind verge or sidewalk, with gaps between them
SCENES = {
    "town": (Thing("wall", 6.0, 5, 50), Thing("hedge", 6.2, 60, 115), Thing("fence", -5.8, 5, 70), Thing("wall", -6.0, 80, 115, 1.1),
             Thing("building", 9.5), Thing("building", -10.0)),
    "country": (Thing("guard_rail", 4.5, 5, 60), Thing("barrier", 4.4, 70, 115), Thing("guard_rail", -4.6, 20, 115), Thing("fence", -8.0, 10, 110)),
    "parking": (Thing("cars", 4.2, 60, 120), Thing("fence", 6.0, 5, 55), Thing("hedge", -6.5, 30, 90), Thing("cars", -4.3, 92, 118)),
}


def from_edge(found, line):
    """m of a line from the carriageway's edge, outward positive."""
    return found.edges[line.chain.road].beyond(line.chain.side, line.chain.s, line.chain.d)


def found_in(survey, edges, **settings):
    return find_roadside(survey, BorderLayers(edges=edges), RoadsideSettings(**settings))


def metres(things_or_lines):
    """{(kind, side, metre)} that things or lines cover."""
    covered = set()
    for one in things_or_lines:
        start, end, side = (one.start, one.end, one.side) if isinstance(one, Thing) else (one.chain.s[0], one.chain.s[-1], one.chain.side)
        covered |= {(one.kind, side, metre) for metre in range(int(np.ceil(start)), int(np.floor(end)))}
    return covered


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("face, density, noise", [(120.0, 250.0, 0.005), (500.0, 800.0, 0.015)])
def test_by_length_95_percent_are_right_and_90_percent_found(scene, face, density, noise):
    survey, edges = road_with(SCENES[scene], face=face, density=density, noise=noise)
    lines = [line for line in found_in(survey, edges).lines if line.kind != "gutter"]
    true, found = metres([thing for thing in SCENES[scene] if thing.kind in KINDS]), metres(lines)
    assert len(true & found) >= 0.95 * len(found)
    assert len(true & found) >= 0.90 * len(true)


@pytest.mark.parametrize("kind", KINDS)
def test_offset_height_and_foot_of_a_line(kind):
    survey, edges = road_with((Thing(kind, 4.7, 10, 100),))
    rows = [row for row in roadside_to_features(found_in(survey, edges))[0].rows if row["kind"] != "gutter"]
    assert [row["kind"] for row in rows] == [kind] and rows[0]["side"] == "left"
    # the middle of its face, which of a barrier leans back by 0.23 m
    assert rows[0]["edge_m"] == pytest.approx(1.2 + 0.2 * (kind == "barrier"), abs=0.1)
    assert rows[0]["height_m"] == pytest.approx(HEIGHTS[kind], abs=0.12)
    assert rows[0]["foot_m"] == pytest.approx(0.44 if kind == "guard_rail" else 0.0, abs=0.06)
    assert rows[0]["station_m"] == pytest.approx(10.0, abs=1.0) and rows[0]["end_m"] == pytest.approx(100.0, abs=1.0)


@pytest.mark.parametrize("form, top", [("double", 1.0), ("ropes", 0.95)])
def test_rails_of_two_beams_or_of_ropes_are_guard_rails(form, top):
    survey, edges = road_with((Thing("guard_rail", 4.7, 10, 100, top, form),))
    (rail,) = [line for line in found_in(survey, edges).lines if line.kind != "gutter"]
    assert rail.kind == "guard_rail" and rail.chain.length > 85 and np.median(rail.chain.top) == pytest.approx(top, abs=0.1)


@pytest.mark.parametrize("offset", [4.3, 4.45])
def test_a_barrier_before_a_slope_keeps_its_height(offset):
    """The ground that is seen beyond the barrier lies higher than that before it."""
    def bank(rng):
        x, y = rng.uniform(0, LENGTH, 150_000), rng.uniform(5.5, 10.0, 150_000)
        return x, y, BESIDE + 0.5 * (y - 5.5)

    barrier = Thing("barrier", offset, 10, 100)

    def above(rng):
        return tuple(np.concatenate(parts) for parts in zip(points_of(barrier, rng, 500.0), bank(rng)))

    survey = measured_road(length=LENGTH, density=800.0, reach=8.0, above=above, hides=hidden_by((barrier,)))
    (line,) = [line for line in found_in(survey, edges_of(LENGTH)).lines if line.kind != "gutter"]
    assert line.kind == "barrier" and np.median(line.chain.top) == pytest.approx(HEIGHTS["barrier"], abs=0.1)


def test_lines_run_along_the_foot_on_the_ground():
    survey, edges = road_with((Thing("wall", 5.0, 10, 100),), grade=0.05)
    line = next(g for g, row in roadside_to_features(found_in(survey, edges))[0] if row["kind"] == "wall")
    x, z = np.array(line.coords)[:, 0] - 500_000.0, np.array(line.coords)[:, 2]
    assert np.abs(z - (GROUND + BESIDE + 0.05 * x)).max() < 0.1


def test_a_rock_face_that_hides_what_lies_behind_it_is_one_wall():
    """Blasted rock: every 3 m it stands back or out, and its top lies at 2.6 to 5 m."""
    rng = np.random.default_rng(4)
    rock = tuple(Thing("wall", rng.uniform(5.0, 5.5), start, start + 3.0, rng.uniform(2.6, 5.0)) for start in range(12, 90, 3))
    survey, edges = road_with(rock)
    (wall,) = [line for line in found_in(survey, edges).lines if line.kind != "gutter"]
    assert wall.kind == "wall" and wall.chain.length > 0.95 * 78


def test_a_low_wall_on_the_inner_side_of_a_hairpin_that_climbs_is_a_wall():
    """A broad upper side and the ground behind are seen over it."""
    def behind(rng):
        x, y, over = rng.uniform(0, 60, 60_000), rng.uniform(4.7, 4.95, 60_000), rng.random(60_000) < 0.6
        return x, np.where(over, y, 4.7), np.where(over, 1.0, rng.uniform(0.0, 1.0, 60_000)) + BESIDE

    survey = measured_road(above=behind, grade=0.09, radius=18.0, reach=8.0, density=400.0, hides=hidden_by((Thing("wall", 4.7, 0, 60, 1.0),)))
    lines = [line for line in found_in(survey, edges_of(radius=18.0)).lines if line.kind != "gutter"]
    assert [line.kind for line in lines] == ["wall"] and np.median(lines[0].chain.top) == pytest.approx(1.0, abs=0.1)


def test_a_low_wall_before_a_house_is_a_wall_and_no_fence():
    """The house is seen over the wall, not through it."""
    survey, edges = road_with((Thing("wall", 6.0, 10, 100, 0.9), Thing("building", 6.9)))
    assert [line.kind for line in found_in(survey, edges).lines if line.kind != "gutter"] == ["wall"]


HEAD = 0.47  # m per m down: the lowest beam of a head of 64


def test_a_face_as_high_as_a_scanner_that_sees_hardly_higher_is_left_out_and_said_to_be():
    """The lower 2.6 m of a house front with climbers look like a hedge; a low wall beside it is known for what it is."""
    front, low = Thing("hedge", 8.0, 10, 100, SENSOR + 0.2), Thing("wall", -7.0, 10, 100, 0.9)
    survey, edges = road_with((front, low), steepest=HEAD)
    found = found_in(survey, edges)
    assert [line.kind for line in found.lines if line.kind != "gutter"] == ["wall"]
    assert any("as high as the scanner" in note for note in found.notes)


@pytest.mark.parametrize("others, steepest", [((), np.inf), ((Thing("building", -8.0),), HEAD)])
def test_a_face_as_high_as_the_scanner_is_told_where_the_scanner_sees_farther(others, steepest):
    """In open country nothing is higher, but the scanner sees the ground beside the vehicle, as mirrors do; or it sees a house."""
    survey, edges = road_with((Thing("wall", 7.5, 10, 100, SENSOR + 0.2), *others), steepest=steepest)
    found = found_in(survey, edges)
    assert [line.kind for line in found.lines if line.kind != "gutter"] == ["wall"] and not found.notes


def pieces_of(survey, edges):
    """[(kind, status, station, end)] of all pieces but gutters."""
    rows = roadside_to_features(found_in(survey, edges))[0].rows
    return [(row["kind"], row["status"], row["station_m"], row["end_m"]) for row in rows if row["kind"] != "gutter"]


def test_a_wall_behind_parked_vehicles_is_one_wall_and_bridged_where_they_hide_it():
    survey, edges = road_with((Thing("wall", 7.5, 10, 100, 0.8), *vans(4.3)))
    (wall,) = [line for line in found_in(survey, edges).lines if line.kind != "gutter"]
    assert wall.kind == "wall" and wall.chain.s[0] < 14 and wall.chain.s[-1] > 94
    assert np.median(wall.chain.top) == pytest.approx(0.8, abs=0.08)
    pieces = pieces_of(survey, edges)
    assert {status for _, status, *_ in pieces} == {"measured", "bridged"}
    for _, status, start, end in pieces:
        # stations count from the first point of the track
        hidden = (np.arange(start + 0.5, end, 0.25) % 6.0 < 3.5).mean()
        assert hidden > 0.7 if status == "bridged" else hidden < 0.3


def test_what_ends_behind_parked_vehicles_is_not_bridged_where_one_sees_past_them():
    survey, edges = road_with((Thing("wall", 7.5, 5, 46, 0.8), Thing("wall", 7.5, 74, 116, 0.8), *vans(4.3)))
    assert all(end < 52 or start > 68 for _, _, start, end in pieces_of(survey, edges))
    assert sum(end - start for _, _, start, end in pieces_of(survey, edges)) > 68


def test_a_driveway_through_a_hedge_is_left_open():
    survey, edges = road_with((Thing("hedge", 6.0, 10, 50), Thing("hedge", 6.0, 52.8, 100)))
    pieces = pieces_of(survey, edges)
    assert [(kind, status) for kind, status, *_ in pieces] == [("hedge", "measured")] * 2
    assert pieces[0][3] == pytest.approx(50.0, abs=0.5) and pieces[1][2] == pytest.approx(52.8, abs=0.5)


@pytest.mark.parametrize("face, seed", [(150.0, 1), (500.0, 4)])
def test_a_hedge_into_which_one_sees_is_one_line_along_its_face(face, seed):
    survey, edges = road_with((Thing("hedge", 5.8, 10, 110, form="loose"),), seed=seed, face=face, density=800.0)
    line, = (line for line in found_in(survey, edges).lines if line.kind != "gutter")
    assert line.kind == "hedge" and line.chain.length == pytest.approx(100.0, abs=1.5)
    assert line.chain.d.max() < 5.8 + 1.75 + 0.45   # counted from the driven line
    assert [status for status, _ in line.chain.pieces()] == ["measured"]


def test_a_row_of_cars_parked_across_is_no_line():
    survey, edges = road_with(vans(4.4, 1.8, 2.6, apart=0.25))
    assert not pieces_of(survey, edges)


def test_a_fence_on_a_low_wall_is_no_hedge():
    survey, edges = road_with((Thing("wall", 6.0, 10, 100, 0.5), Thing("fence", 6.12, 10, 100, 1.4)))
    assert {kind for kind, *_ in pieces_of(survey, edges)} == {"fence"}


def test_the_flat_ground_above_a_retaining_wall_is_no_line():
    """Few pulses graze it."""
    def terrace(rng):
        x, y = rng.uniform(0, LENGTH, 3000), rng.uniform(5.2, 11.0, 3000)
        return x, y, np.full(3000, 0.8 + BESIDE)

    wall = Thing("wall", 5.2, 0, LENGTH, 0.8)

    def above(rng):
        return tuple(np.concatenate(parts) for parts in zip(points_of(wall, rng), terrace(rng)))

    survey = measured_road(length=LENGTH, density=400.0, reach=5.2, above=above)
    (line,) = [line for line in found_in(survey, edges_of(LENGTH)).lines if line.kind != "gutter"]
    assert line.kind == "wall" and np.median(line.chain.top) == pytest.approx(0.8, abs=0.08)


def test_a_line_has_a_vertex_in_every_interval():
    survey, edges = road_with((Thing("wall", 5.0, 10, 100),))
    for interval in (5.0, 20.0):
        line = next(g for g, row in roadside_to_features(found_in(survey, edges, interval=interval))[0] if row["kind"] == "wall")
        assert np.diff(np.array(line.coords)[:, 0]).max() < interval + 1.0


@pytest.mark.parametrize("things", [(), (Thing("cars", 4.2), Thing("cars", -5.5), Thing("building", 9.0))], ids=["empty", "cars and a building"])
def test_nothing_is_invented_and_a_crowned_road_has_a_gutter_on_both_sides(things):
    survey, edges = road_with(things, crown=True)
    found = found_in(survey, edges)
    assert not [line.kind for line in found.lines if line.kind != "gutter"] and not sum(map(len, found.poles.values()))
    assert things or {line.chain.side for line in found.lines} == {1, -1}


def rail_of(d, thickness=0.05):
    """Uprights of a guard rail at (N,) offsets."""
    n = len(d)
    below_top = np.zeros((n, TOP_BINS))
    below_top[:, :6] = 30.0
    ones = np.ones(n)
    return Uprights(np.arange(n), d, 0 * ones, 0.78 * ones, 0.5 * ones, below_top, thickness * ones, 0 * ones, 200 * ones, 150 * ones, ones < 0,
                    0 * ones)


def test_a_rail_in_a_hairpin_runs_straight_from_kink_to_kink():
    """Beams of 3.5 m along the road, whose middles lie 21 cm nearer to it than their ends."""
    share = (0.5 * np.arange(60) % 3.5) / 3.5
    (chain,) = find_chains(rail_of(5.65 + 0.84 * (share - 0.5) ** 2), 0, 1, 3.0, 8.0)
    assert chain.wobble > 0.06 and [kind for kind, _ in things_of(chain, 8.0)] == ["guard_rail"]


def test_what_is_uneven_from_place_to_place_is_no_rail():
    (chain,) = find_chains(rail_of(np.random.default_rng(2).normal(5.65, 0.12, 60).clip(5.5, 5.8)), 0, 1, 3.0, 8.0)
    assert chain.wobble > 0.06 and not [kind for kind, _ in things_of(chain, 8.0) if kind == "guard_rail"]


def test_what_only_hangs_beside_the_road_is_no_line():
    edges = edges_of(LENGTH)
    hanging = Thing("wall", 6.0, 10, 100, 0.6)

    def above(rng):
        x, y, z = points_of(hanging, rng)
        return x, y, z + 1.5

    over = measured_road(length=LENGTH, density=300.0, reach=14.0, above=above)
    assert {line.kind for line in found_in(over, edges).lines} <= {"gutter"}


def test_a_gutter_lies_where_the_road_falls_to_and_not_on_its_higher_side():
    survey, edges = road_with((), crown=False, crossfall=0.03)
    found = found_in(survey, edges)
    gutters = [line for line in found.lines if line.kind == "gutter"]
    assert {line.chain.side for line in gutters} == {-1}
    assert sum(line.chain.length for line in gutters) > 0.9 * LENGTH
    assert abs(from_edge(found, gutters[0])) < 0.1 and np.median(gutters[0].chain.ground) + 100 - GROUND < 5


def test_poles_signs_and_trunks_with_diameter_and_height():
    poles = ((20.0, 5.0, 0.16, 6.0), (40.0, -5.0, 0.06, 3.0, 0.6), (60.0, 5.5, 0.35, 4.0, 0.0, 1.2), (80.0, -4.6, 0.11, 2.2))
    survey, edges = road_with((Thing("fence", 7.5, 5, 100),), poles)
    found = sorted(found_in(survey, edges).poles[0], key=lambda pole: pole.s)
    assert [pole.kind for pole in found] == ["pole", "sign", "trunk", "pole"]
    frame = survey.frame
    for pole, (x, y, diameter, height, *_) in zip(found, poles):
        east, north = frame.to_map(0, np.array([pole.s]), np.array([pole.d]))
        assert np.hypot(east[0] - 500_000.0 - x, north[0] - 5_400_000.0 - y) < 0.1
        assert pole.diameter == pytest.approx(diameter, abs=0.05)
        assert pole.kind == "trunk" or pole.height == pytest.approx(height, abs=0.15)


def test_a_plate_as_low_as_a_wall_and_a_wall_behind_a_pole_leave_each_what_it_is():
    """The lower edge of the plate is at 1.6 m; the walls stand 1.1 m behind the shafts and are higher than 2 m."""
    poles = ((20.0, 5.0, 0.06, 2.2, 0.6), (40.0, -5.0, 0.10, 4.0), (60.0, 5.0, 0.40, 6.0))
    survey, edges = road_with((Thing("wall", 6.1, 5, 100, 3.5), Thing("wall", -6.1, 5, 100, 3.5)), poles)
    found = sorted(found_in(survey, edges).poles[0], key=lambda pole: pole.s)
    assert [pole.kind for pole in found] == ["sign", "pole", "pole"]
    assert [pole.diameter for pole in found] == pytest.approx([0.06, 0.10, 0.40], abs=0.04)


def test_people_and_bushes_are_no_poles():
    """They are as high as low poles, but stout."""
    people = tuple((10.0 + 3.0 * k, 5.0 + 0.2 * (k % 3), 0.45, 1.6 + 0.05 * (k % 5)) for k in range(12))
    survey, edges = road_with((), people)
    assert not found_in(survey, edges).poles[0]


def test_a_person_whose_head_is_slender_is_no_pole_and_a_bollard_of_that_height_is():
    rng = np.random.default_rng(1)
    body, head, bollard = (pole_points(20.0, 5.0, *size, rng) for size in ((0.44, 1.45), (0.20, 1.85), (0.12, 1.85)))
    person = [np.concatenate([b, h[head[2] - BESIDE > 1.45]]) for b, h in zip(body, head)]
    for (x, y, z), heights in ((person, []), (bollard, [1.85])):
        found = find_poles(x, y, z - BESIDE, 0 * z, (0.0, 40.0), RoadsideSettings.min_pole_height)
        assert [pole.height for pole in found] == pytest.approx(heights, abs=0.1)


def test_a_verge_that_falls_on_to_the_foot_of_a_barrier_is_no_gutter():
    survey, edges = road_with((Thing("barrier", 3.95, 10, 110), ), curb=-0.02)
    assert not [line for line in found_in(survey, edges).lines if line.kind == "gutter" and line.chain.side > 0]


def test_windows_of_another_length_give_the_same(monkeypatch):
    survey, edges = road_with(SCENES["country"], poles=((39.9, 5.5, 0.2, 4.0),), density=800.0, face=500.0)
    one = roadside_to_features(found_in(survey, edges))
    monkeypatch.setattr(finding, "ROADSIDE_WINDOW", 60.0)
    other = roadside_to_features(found_in(survey, edges))
    assert len(one[0].rows) and len(one) == len(other)
    for layer, again in zip(one, other):
        assert [row["kind"] for row in layer.rows] == [row["kind"] for row in again.rows]
        assert all(shapely.hausdorff_distance(a, b) < 0.01 for a, b in zip(layer.geometries, again.geometries))


def test_driven_the_other_way_the_sides_are_swapped():
    things = (Thing("guard_rail", 4.5, 10, 100), Thing("wall", -6.0, 30, 110))
    kinds = []
    for direction in (1, -1):
        survey, edges = road_with(things, drives=(Drive(direction, -1.75),))
        kinds.append({(line.kind, line.chain.side * direction) for line in found_in(survey, edges).lines if line.kind != "gutter"})
    assert kinds[0] == kinds[1] == {("guard_rail", 1), ("wall", -1)}


def test_without_layers_it_says_that_parked_cars_are_not_known():
    survey, _ = road_with((Thing("wall", 5.0),))
    found = find_roadside(survey)
    assert any("parked cars too" in note for note in found.notes)
    assert {line.kind for line in found.lines} == {"wall"} and np.isnan(from_edge(found, found.lines[0]))
    assert roadside_to_features(found)[0].rows[0]["edge_m"] is None


def test_the_report_lists_every_line_and_is_no_higher_for_a_long_road():
    survey, edges = road_with(SCENES["country"], poles=((20.0, 5.5, 0.2, 4.0),))
    found = found_in(survey, edges)
    page = roadside_report(found, *roadside_to_features(found))
    assert page.count("guard rail") > 2 and "barrier" in page and page.count("<svg") == 1
    assert isinstance(roadside_to_features(found)[1], Features)
