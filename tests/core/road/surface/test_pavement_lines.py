"""Edges of the pavement: on streets without a curb the known verge is found and drawn, and nothing where there is none."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.features import ROAD_EDGES, Features
from lanewright.core.common.progress import RememberedMessages
from lanewright.core.road.edges.fit import EdgeSettings
from lanewright.core.road.edges.road_edges import EdgePiece, RoadEdges, joined_pieces
from lanewright.core.road.surface import pavement_lines
from lanewright.core.road.surface.extract import extract_road_surface
from lanewright.core.road.surface.ground_grid import MeasuredGround, median_about, roughness_of_rows, sum_about
from lanewright.core.road.surface.pavement_lines import with_pavement_edges
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.open_survey import Survey
from lanewright.core.survey.store.records import SURVEY_POINT, to_units
from lanewright.core.survey.store.section_store import SectionStore
from lanewright.core.survey.trajectory.trajectory import Trajectory

LENGTH, SENSOR, REACH, EAST, NORTH = 60.0, 2.0, 9.0, 500_000.0, 5_400_000.0
HALF = 3.5     # m, half the asphalt
GRAVEL = 0.3   # m, strip of gravel between asphalt and grass


def half_of(s):
    """Half the asphalt of a street that stays as wide as it is."""
    return np.full_like(s, HALF)


def street(half=half_of, verge=True, keep=None, extra=None, backwards=False, shuffled=False, density=90, seed=5, gravel=GRAVEL, gain=None,
           grey_of=None, misfit=None, grade=0.0):
    """A straight street along y = 0 of asphalt up to `half` of the station, then a strip of gravel, then grass; or asphalt throughout.

    Scatter of heights and returned intensity are those of the three; `keep` : of s and d, False where nothing was scanned. With a `gain`, a
    function of d, half of the points are of a second scanner that returns so many times the intensity; with a `misfit`, a function of d, its
    points lie so many metres too high; `grey_of` s and d is times the intensity of the ground. The street rises by `grade`
    """
    rng = np.random.default_rng(seed)
    along = np.linspace(0.0, LENGTH, 601)
    east = (LENGTH - along if backwards else along) + EAST
    frame = build_frame(Trajectory(1000 + along / 10, east, np.full(601, NORTH), 100.0 + SENSOR + grade * (east - EAST)))
    count = int(density * (LENGTH + 8) * 2 * REACH)
    x, y = rng.uniform(-4, LENGTH + 4, count), rng.uniform(-REACH, REACH, count)
    beyond = np.abs(y) - half(x)
    ground = np.digitize(beyond, [0.0, gravel]) if verge else np.zeros(count, int)
    z = rng.normal(0.0, np.array([0.003, 0.006, 0.02])[ground])
    grey = np.array([1000.0, 1150.0, 1400.0])[ground] * rng.lognormal(0.0, 0.1, count)
    if grey_of is not None:
        grey = grey * grey_of(x, y)
    if keep is not None:
        seen = keep(x, y)
        x, y, z, grey = x[seen], y[seen], z[seen], grey[seen]
    if extra is not None:
        x, y, z, grey = (np.r_[a, b] for a, b in zip((x, y, z, grey), extra))
    if shuffled:
        order = rng.permutation(len(x))
        x, y, z, grey = x[order], y[order], z[order], grey[order]
    places = frame.to_local(x + EAST, y + NORTH)
    records = np.zeros(len(x), SURVEY_POINT)
    s, d = frame.road(0).locate(*places)
    second = np.zeros(len(x), int) if gain is None and misfit is None else rng.integers(0, 2, len(x))
    if misfit is not None:
        z = z + second * misfit(y)
    records["x"], records["y"], records["z"], records["s"], records["d"] = map(to_units, (*places, z + grade * x + 100 - frame.origin[2], s, d))
    records["time"] = 1000 + np.clip(LENGTH - x if backwards else x, 0, LENGTH) / 10
    records["scanner"], records["intensity"] = second, np.rint(np.where(second, grey * (1.0 if gain is None else gain(y)), grey))
    store = SectionStore(SURVEY_POINT, 20.0)
    store.append(0, records[np.argsort(s, kind="stable")] if not shuffled else records)
    return Survey([], frame, store, "", {0: SENSOR}, "scanner_channel", [0, 1], True, True)


def no_edges(survey):
    return RoadEdges.from_features(Features("LineStringZ", list(ROAD_EDGES)), survey.frame)


def found(survey, **settings):
    return with_pavement_edges(survey, no_edges(survey), EdgeSettings(**settings))


@pytest.fixture(scope="module")
def plain():
    """The usual street and its edges."""
    survey = street()
    return survey, found(survey)


def on_map(edges, survey):
    """[(status, (V, 2) m along and across the street)] of edges."""
    return [(edges.status[k], np.c_[edges.course.x[edges.course.line(k)] + survey.frame.origin[0] - EAST,
                                    edges.course.y[edges.course.line(k)] + survey.frame.origin[1] - NORTH]) for k in range(len(edges))]


def covered(edges, survey, side, half=half_of, within=0.2):
    """Share of the asphalt's edge on one side, 1 left of the street's direction or -1, along which a line lies within some metres."""
    s = np.arange(2.0, LENGTH - 2.0, 0.25)
    right = np.zeros(len(s), bool)
    for _, places in on_map(edges, survey):
        if np.sign(places[0, 1]) != side:
            continue
        order = np.argsort(places[:, 0])
        off = np.interp(s, places[order, 0], np.abs(places[order, 1]), left=np.nan, right=np.nan) - half(s)
        right |= np.abs(off) <= within
    return right.mean()


@pytest.mark.parametrize("options", [{}, {"backwards": True}, {"shuffled": True}, {"density": 400}, {"density": 15}])
def test_where_asphalt_ends_at_gravel_the_edge_of_the_pavement_is_drawn(options):
    survey = street(**options)
    edges = found(survey)
    assert set(edges.what) == {"pavement"} and set(edges.kind) == {"main"} and set(edges.status) == {"measured"}
    assert np.isnan(edges.height).all() and (edges.sigma > 0).all()
    assert min(covered(edges, survey, 1), covered(edges, survey, -1)) >= 0.95


def test_cells_with_few_points_lie_as_high_as_the_road_where_it_climbs():
    survey = street(density=12, grade=0.08)
    _, profiles = MeasuredGround(survey).windows(0, [40, 50, 60], [True] * 3)
    few = (profiles.count * 5 < 6) & (np.abs(profiles.offsets) < HALF - 0.1) & np.isfinite(profiles.height)
    assert few.sum() > 50 and np.abs(profiles.height[few]).max() < 0.012


def test_cells_of_four_points_are_as_rough_together_as_the_verge_and_the_road_on_which_they_lie():
    rng = np.random.default_rng(1)
    survey = street(density=400, gravel=0.0, keep=lambda s, d: (np.abs(d) < 2.2) | (rng.random(len(d)) < 0.1))
    _, profiles = MeasuredGround(survey).windows(0, [20, 30, 40, 50, 60, 70, 80, 90], [True] * 8)
    rows = profiles.side(1)
    rough = roughness_of_rows(rows.rough, rows.freedom, *(lambda values, over=over: over(values, 3) for over in (median_about, sum_about)))[3:-3]
    road, verge = ((rows.offsets > low) & (rows.offsets < high) for low, high in ((2.3, HALF - 0.1), (HALF + 0.1, 7.0)))
    assert rows.count[:, road | verge].mean() < 4.5 and np.isfinite(rough[:, road | verge]).mean() > 0.9
    of_road, of_verge = (values[np.isfinite(values)] for values in (rough[:, road], rough[:, verge]))
    assert np.median(of_road) == pytest.approx(0.003, rel=0.15) and np.median(of_verge) == pytest.approx(0.02, rel=0.15)
    assert np.mean(of_road < 0.0075) > 0.98 and np.mean(of_verge > 0.0075) > 0.95


def test_drawn_edges_lie_neither_inward_nor_outward_by_a_centimetre():
    off = []
    for seed in (5, 6, 7):
        survey = street(seed=seed)
        off += [np.abs(places[(places[:, 0] > 3) & (places[:, 0] < LENGTH - 3), 1]) - HALF for _, places in on_map(found(survey), survey)]
    assert abs(np.concatenate(off).mean()) < 0.008


@pytest.mark.parametrize("gain", [lambda d: 1.8 + 0 * d, lambda d: 1.3 + 0.1 * d, lambda d: np.where(d > 0, 0.6, 1.7)])
def test_between_scanners_of_different_gain_a_strip_of_gravel_is_no_road_on_either_side(gain):
    survey = street(gravel=0.8, gain=gain)
    edges = found(survey)
    assert set(edges.status) == {"measured"}
    assert min(covered(edges, survey, side, within=0.1) for side in (1, -1)) >= 0.95


@pytest.mark.parametrize("off", [0.02, 0.03])
def test_where_two_drives_disagree_in_height_the_road_goes_on_to_its_edge(off):
    survey = street(half=lambda s: np.full_like(s, 6.0), misfit=lambda d: np.where(np.abs(d) > 3.0, off, 0.0), density=300)
    edges = found(survey)
    assert min(covered(edges, survey, side, half=lambda s: np.full_like(s, 6.0)) for side in (1, -1)) >= 0.95


@pytest.mark.parametrize("strip, density", [((1.9, 2.9), 60), ((2.3, 3.0), 100)])
def test_behind_a_strip_with_few_points_that_looks_smooth_the_road_goes_on_to_its_edge(strip, density):
    rng, count = np.random.default_rng(3), int(density * 2 * (LENGTH + 8) * (strip[1] - strip[0]))
    few = (rng.uniform(-4, LENGTH + 4, count), rng.uniform(*strip, count) * rng.choice([-1, 1], count), rng.normal(0.0, 0.001, count),
           1000.0 * rng.lognormal(0.0, 0.1, count))
    survey = street(density=400, keep=lambda s, d: (np.abs(d) < strip[0]) | (np.abs(d) > strip[1]), extra=few, gravel=0.5)
    edges = found(survey)
    assert min(covered(edges, survey, side, within=0.1) for side in (1, -1)) >= 0.95


def test_where_one_scanner_stops_to_see_the_road_it_does_not_end():
    rng = np.random.default_rng(4)
    survey = street(gain=lambda d: np.where(np.abs(d) < 2.0 + 0.2 * rng.uniform(size=len(d)), 2.0, np.nan_to_num(1.0)), gravel=0.8)
    edges = found(survey)
    assert min(covered(edges, survey, side, within=0.1) for side in (1, -1)) >= 0.95


@pytest.mark.parametrize("paint", [4.0, 1.3])
def test_an_edge_line_fresh_or_worn_lies_on_the_pavement(paint):
    survey = street(gravel=0.8, grey_of=lambda s, d: np.where(np.abs(np.abs(d) - HALF + 0.36) < 0.06, paint, 1.0))
    edges = found(survey)
    assert min(covered(edges, survey, side, within=0.1) for side in (1, -1)) >= 0.95


@pytest.mark.parametrize("patch", [0.7, 1.35])
def test_a_patch_of_other_asphalt_does_not_move_the_edge(patch):
    survey = street(gravel=0.8, grey_of=lambda s, d: np.where((s > 20) & (s < 31) & (np.abs(d) < 2.4) & (np.abs(d) > 0.6), patch, 1.0))
    edges = found(survey)
    assert min(covered(edges, survey, side) for side in (1, -1)) >= 0.95


def test_behind_a_dark_patch_beside_the_edge_the_road_goes_on():
    survey = street(gravel=0.8, grey_of=lambda s, d: np.where((s > 20) & (s < 33) & (np.abs(d) < 2.9) & (np.abs(d) > 1.6), 0.82, 1.0))
    edges = found(survey)
    assert min(covered(edges, survey, side, within=0.1) for side in (1, -1)) >= 0.95


def test_behind_a_dark_patch_that_reaches_the_edge_gravel_as_bright_as_the_road_is_not_taken_for_road():
    survey = street(gravel=0.8, grey_of=lambda s, d: np.where((s > 20) & (s < 29) & (np.abs(d) < HALF) & (np.abs(d) > 2.4), 0.82, 1.0))
    edges = found(survey)
    assert min(covered(edges, survey, side) for side in (1, -1)) >= 0.95


def test_between_scan_lines_far_apart_the_edge_lies_in_the_middle_and_is_less_certain():
    apart = 0.3
    survey = street(gravel=0.8, density=1500, keep=lambda s, d: np.abs(d) % apart < 0.05)
    edges, dense = found(survey), found(street(gravel=0.8))
    assert min(covered(edges, survey, side) for side in (1, -1)) >= 0.95
    assert edges.sigma.min() > 1.5 * dense.sigma.max() and edges.sigma.max() < apart


def test_an_edge_does_not_depend_on_what_lies_far_along_it(plain):
    """The street becomes wider 30 m farther on."""
    def places(edges, survey):
        return np.concatenate([line for _, line in on_map(edges, survey)])

    wider = street(half=lambda s: HALF + np.where(s > 48.0, 0.35, 0.0))
    (x, y), (there, across) = places(found(wider), wider).T, places(*plain[::-1]).T
    near = x < 18.0
    np.testing.assert_array_equal(x[near], there[there < 18.0])
    np.testing.assert_allclose(y[near], across[there < 18.0], atol=0.001)


def test_asphalt_as_far_as_one_sees_has_no_edge():
    survey = street(verge=False)
    assert len(found(survey)) == 0


def test_where_the_road_widens_in_a_bend_its_edge_is_followed():
    def half(s):
        return HALF + np.interp(s, [10, 24, 36, 50], [0.0, 1.6, 1.6, 0.0])

    survey = street(half)
    edges = found(survey)
    assert min(covered(edges, survey, 1, half), covered(edges, survey, -1, half)) >= 0.95


@pytest.mark.parametrize("away", [0.5, 1.0])
def test_a_guard_rail_beyond_the_pavement_does_not_pull_its_edge(away):
    rng = np.random.default_rng(2)
    rail = rng.uniform(0, LENGTH, 6000), np.full(6000, HALF + away) + rng.normal(0, 0.01, 6000), rng.uniform(0.45, 0.75, 6000), np.full(6000, 4000.0)
    survey = street(extra=rail)
    assert covered(found(survey), survey, 1) >= 0.95


@pytest.mark.parametrize("foot", [3.0, HALF])
def test_the_foot_of_a_wall_and_a_row_of_parked_cars_are_no_edges_of_the_pavement(foot):
    rng = np.random.default_rng(3)
    wall = rng.uniform(0, LENGTH, 20000), np.full(20000, foot) + rng.normal(0, 0.01, 20000), rng.uniform(0.0, 2.0, 20000), np.full(20000, 1500.0)
    survey = street(verge=False, keep=lambda s, d: d < foot, extra=wall)
    assert "left" not in found(survey).side


def test_behind_a_vehicle_the_edge_is_bridged_and_says_so():
    hidden = 25.0, 35.0
    survey = street(keep=lambda s, d: ~((s > hidden[0]) & (s < hidden[1]) & (d > 2.6)))
    lines = on_map(found(survey), survey)
    bridged = [places for status, places in lines if status == "bridged"]
    assert len(bridged) == 1
    assert (bridged[0][:, 0].min(), bridged[0][:, 0].max()) == pytest.approx(hidden, abs=1.0)
    assert np.abs(bridged[0][:, 1] - HALF).max() <= 0.2
    assert "bridged" not in found(survey, max_gap=2.5).status


def test_behind_a_vehicle_it_is_bridged_too_where_a_curb_begins_soon_after():
    hidden, curb_from = (25.0, 35.0), 42.0
    survey = street(keep=lambda s, d: ~((s > hidden[0]) & (s < hidden[1]) & (d > 2.6)))
    whole = found(street())
    curb = whole[whole.side == "left"].to_features(survey.frame)
    for row in curb.rows:
        row["edge"] = "curb"
    curb.geometries = [shapely.LineString([place for place in line.coords if place[0] - EAST >= curb_from]) for line in curb.geometries]
    edges = with_pavement_edges(survey, RoadEdges.from_features(curb, survey.frame))
    drawn = [places for (_, places), what in zip(on_map(edges, survey), edges.what) if what == "pavement" and places[0, 1] > 0]
    assert max(places[:, 0].max() for places in drawn) == pytest.approx(curb_from - 5.0, abs=0.5), "as far as the curb is continued"


def test_a_single_row_seen_between_two_vehicles_joins_their_bridges(plain, monkeypatch):
    lines_of = pavement_lines._lines

    def with_gaps(*args):
        return [[(a, 100), (110, 111), (120, b)] for (a, b), in lines_of(*args)]

    monkeypatch.setattr(pavement_lines, "_lines", with_gaps)
    edges = found(plain[0])
    assert edges.length.min() > 0.0
    assert edges.status[edges.side == "left"].tolist() == ["measured", "bridged", "bridged", "measured"]
    assert len(edges.densified(plain[0].frame)) == len(edges)


def behind_a_lorry(half=half_of, **settings):
    """Lines of the left side of a street, half of it hidden by what drives beside the vehicle."""
    survey = street(half, keep=lambda s, d: ~((s > 19.0) & (s < 41.0) & (d > 1.0)))
    return [line for line in on_map(found(survey, **settings), survey) if line[1][0, 1] > 0]


@pytest.mark.parametrize("bend", [0.0, 0.001])
def test_a_longer_gap_is_bridged_where_both_sides_of_it_lie_in_one_line(bend):
    def half(s):
        return HALF + bend * (s - 30.0) ** 2

    lines = behind_a_lorry(half)
    bridge, = (places for status, places in lines if status == "bridged")
    assert np.ptp(bridge[:, 0]) > 18.0 and np.abs(bridge[:, 1] - half(bridge[:, 0])).max() <= 0.2
    assert "bridged" not in [status for status, _ in behind_a_lorry(half, max_gap=5.0)]


def test_a_longer_gap_in_which_the_road_widens_is_not_bridged():
    lines = behind_a_lorry(lambda s: HALF + np.where(s < 30.0, 0.0, 1.0))
    assert len(lines) == 2 and {status for status, _ in lines} == {"measured"}


def test_a_curb_stays_what_it_is_and_the_pavement_ends_on_the_other_side_alone(plain):
    survey, drawn = plain
    left = drawn[drawn.side == "left"].to_features(survey.frame)
    for row in left.rows:
        row["edge"] = "curb"
    curbs = RoadEdges.from_features(left, survey.frame)
    both = with_pavement_edges(survey, curbs)
    assert both.side[both.what == "curb"].tolist() == ["left"] * len(curbs) and set(both.side[both.what == "pavement"]) == {"right"}
    assert len(set(both.chain)) == 2


def test_the_surface_ends_at_the_edge_of_the_pavement_and_counts_as_measured(plain):
    points, surface = extract_road_surface(*plain)
    d = points.all_points().d
    assert (np.percentile(d, 0.1), np.percentile(d, 99.9)) == pytest.approx((-HALF, HALF), abs=0.08)
    assert surface.area[surface.status == "measured"].sum() > 0.8 * surface.area.sum()


def test_where_the_slope_of_the_ground_alone_ends_the_road_its_edge_is_inferred_and_as_uncertain_as_a_level_verge_is_wide():
    rng, level = np.random.default_rng(8), 5.5
    x, aside = rng.uniform(-4, LENGTH + 4, 20_000), rng.uniform(level, REACH, 20_000)
    slope = x, aside * rng.choice([-1, 1], len(x)), rng.normal(0.3 * (level - aside), 0.003), 1000.0 * rng.lognormal(0.0, 0.1, len(x))
    survey, progress = street(verge=False, keep=lambda s, d: np.abs(d) < level, extra=slope), RememberedMessages()
    edges = with_pavement_edges(survey, no_edges(survey), progress=progress)
    assert set(edges.status) == {"inferred"}
    assert min(covered(edges, survey, side, half=lambda s: np.full_like(s, level)) for side in (1, -1)) >= 0.9
    assert ((edges.sigma > level - HALF) & (edges.sigma < level)).all()
    (kind, message), = [one for one in progress.messages if one[0] == "warn"]
    assert "inferred" in message and f"{edges.length.sum():.0f} m" in message
    assert set(extract_road_surface(survey, edges)[1].status) == {"grown"}


def test_written_and_read_again_an_edge_of_the_pavement_is_one(plain):
    survey, edges = plain
    layer = edges.to_features(survey.frame)
    assert set(layer.column("edge")) == {"pavement"}
    assert RoadEdges.from_features(layer, survey.frame).what.tolist() == edges.what.tolist()
    for row in layer.rows:
        del row["edge"]
    assert set(RoadEdges.from_features(layer, survey.frame).what) == {"curb"}


def wide(s):
    """Where level ground ends beside a street that is half as wide: a sidewalk lies between, flush with the road."""
    return np.full_like(s, HALF + 2.6)


@pytest.mark.parametrize("falloff", [0.0, 0.06])
def test_the_road_ends_where_a_flush_sidewalk_twice_as_bright_begins(falloff):
    """The ground changes in height and roughness 2.6 m farther out; brightness falls off by so much per metre."""
    survey = street(half=wide, grey_of=lambda s, d: np.where(np.abs(d) > HALF, 2.0, 1.0) * np.exp(-falloff * np.abs(d)))
    edges = found(survey)
    assert min(covered(edges, survey, side) for side in (1, -1)) >= 0.9
    assert max(covered(edges, survey, side, half=wide, within=1.0) for side in (1, -1)) == 0.0


def test_a_flush_bicycle_path_is_no_road_where_its_far_side_is_as_dark_as_the_road():
    """Along 24 m of the street, the outer half of the path is no brighter than asphalt."""
    def path(s, d):
        return np.where((np.abs(d) < HALF) | (s > 18) & (s < 42) & (np.abs(d) > HALF + 1.3), 1.0, 2.0)

    survey = street(half=wide, grey_of=path)
    edges = found(survey)
    assert min(covered(edges, survey, side) for side in (1, -1)) >= 0.9


def test_a_short_edge_is_drawn_where_a_curb_goes_on_from_it(plain):
    """Up to 5 m before the curb, where the curb's line is continued."""
    survey = plain[0]
    curb = EdgePiece(np.c_[[8.0 + EAST, 59.0 + EAST], [NORTH + HALF] * 2, [100.0] * 2], 0, "left", "measured", 0, 8.0, 59.0, 51.0)
    drawn = with_pavement_edges(survey, joined_pieces([curb], survey.frame))
    left = [places[:, 0] for (_, places), side, what in zip(on_map(drawn, survey), drawn.side, drawn.what) if (side, what) == ("left", "pavement")]
    assert len(left) == 1 and (left[0].min(), left[0].max()) == pytest.approx((-4.5, 3.0), abs=1.0)


def bright_strip(s, d):
    return np.where((np.abs(d) > 1.5) & (np.abs(d) < 1.9), 4.0, 1.0)   # a double line


def older_lane(s, d):
    return np.where((np.abs(d) > 1.0) & (np.abs(d) < 2.4), 2.0, 1.0)


def dark_patch(s, d):
    return np.where((s > 20) & (s < 40) & (np.abs(d) < 2.5), 0.5, 1.0)


def falls_off(s, d):
    return np.exp(-0.15 * np.abs(d))


def rises(s, d):
    return np.exp(0.12 * np.abs(d))     # a scanner that sees less of what is near


@pytest.mark.parametrize("grey_of", [bright_strip, older_lane, dark_patch, falls_off, rises])
def test_paint_a_patch_and_the_range_are_no_other_ground(grey_of):
    survey = street(half=wide, grey_of=grey_of)
    edges = found(survey)
    assert min(covered(edges, survey, side, half=wide) for side in (1, -1)) >= 0.9
