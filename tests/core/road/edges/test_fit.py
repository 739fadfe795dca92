"""Road edges fitted through curb points of known streets."""

import curbed_streets as streets
import numpy as np
import pytest
import shapely
from curbed_streets import EAST, NORTH, length_of, parked_car, street, survey_of
from heard import Heard
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import CURB_POINTS, Features
from lanewright.core.road.edges.fit import EdgeSettings
from lanewright.core.survey.frame.road_frame import build_frame
from lanewright.core.survey.trajectory.trajectory import Trajectory
from road_layers import detect_curbs, fit_road_edges


def straight_frame(length=60.0):
    time, x, y, z = streets.driven(length)
    return build_frame(Trajectory(time, x + EAST, y + NORTH, z + 100))


def curb_points(stations, offset=lambda s: 3.5, hidden=(), noise=0.0, seed=2):
    """Curb points of the left side of a straight street, at given stations; `hidden` are stations of hidden curb."""
    rng = np.random.default_rng(seed)
    points = Features("PointZ", list(CURB_POINTS))
    for s in stations:
        d = offset(s) + rng.normal(0, noise)
        points.add(shapely.Point(EAST + s, NORTH + d, 100.0), road=0, side="left", status="measured", part="bottom",
                   station_m=float(s), offset_m=float(d), height_m=0.12, chain=0)
    for s in hidden:
        points.add(shapely.Point(EAST + s, NORTH + offset(s), 100.0), road=0, side="left", status="occluded", part="bottom",
                   station_m=float(s), offset_m=float(offset(s)))
    return points


def places(edges):
    return np.concatenate([shapely.get_coordinates(g) for g in edges.geometries]) - [EAST, NORTH]


def test_the_edge_runs_along_the_curb_and_along_the_road():
    edges = fit_road_edges(curb_points(np.arange(0, 60, 1.0), noise=0.01), straight_frame())
    assert [(r["side"], r["status"], r["part"]) for r in edges.rows] == [("left", "measured", "bottom")]
    vertices = places(edges)
    assert (np.diff(vertices[:, 0]) > 0).all()
    np.testing.assert_allclose(vertices[:, 1], 3.5, atol=0.015)


def test_both_edges_of_a_scanned_bend_are_arcs_about_its_centre():
    radius = 40.0
    surveyed = survey_of(street(radius=radius), drive=streets.driven(radius=radius))
    edges = fit_road_edges(detect_curbs(surveyed), surveyed.frame)
    assert [r["side"] for r in edges.rows] == ["left", "right"]
    for (line, _row), offset in zip(edges, (3.5, -3.5)):
        x, y = (shapely.get_coordinates(line) - [EAST, NORTH]).T
        np.testing.assert_allclose(np.hypot(x, y - radius), radius - offset, atol=0.012)


def test_a_single_stray_point_does_not_bend_the_edge():
    edges = fit_road_edges(curb_points(np.arange(0, 60, 1.0), lambda s: 3.5 + 0.3 * (s == 30)), straight_frame())
    np.testing.assert_allclose(places(edges)[:, 1], 3.5, atol=0.01)


def test_the_edge_stays_at_the_curb_where_the_ends_of_two_chains_disagree():
    points = curb_points(np.sort(np.r_[np.arange(0, 40, 2.0), 11.95]), lambda s: 3.5 + 0.002 * (s // 2 % 2) + 0.1 * (s == 11.95))
    points.rows[6]["chain"] = 1
    np.testing.assert_allclose(places(fit_road_edges(points, straight_frame()))[:, 1], 3.5, atol=0.5)


def test_a_corner_that_turns_away_is_followed():
    def corner(s):
        return 3.5 if s < 40 else 3.5 + 8.0 - np.sqrt(64.0 - (s - 40.0) ** 2)

    vertices = places(fit_road_edges(curb_points(np.arange(0, 45, 0.5), corner), straight_frame()))
    assert vertices[:, 0].max() == pytest.approx(44.5, abs=0.1)
    np.testing.assert_allclose(vertices[:, 1], [corner(s) for s in vertices[:, 0]], atol=0.04)


def test_a_hidden_gap_is_bridged_and_says_so():
    stations = np.r_[np.arange(0, 20, 1.0), np.arange(30, 60, 1.0)]
    edges = fit_road_edges(curb_points(stations, hidden=np.arange(20, 29.5, 0.5)), straight_frame())
    assert [r["status"] for r in edges.rows] == ["measured", "bridged", "measured"]
    assert len({r["chain"] for r in edges.rows}) == 1
    first, bridge, last = edges.geometries
    assert first.coords[-1] == bridge.coords[0] and bridge.coords[-1] == last.coords[0]
    assert bridge.length == pytest.approx(11.0, abs=0.05)
    np.testing.assert_allclose(places(edges)[:, 1], 3.5, atol=0.01)


@pytest.mark.parametrize(("length", "bridged"), [(4.0, 1), (1.0, 0)], ids=["two fifths", "a tenth"])
def test_a_gap_of_which_two_fifths_are_hidden_is_bridged(length, bridged):
    stations = np.r_[np.arange(0, 20, 1.0), np.arange(29, 60, 1.0)]
    edges = fit_road_edges(curb_points(stations, hidden=20.25 + np.arange(0, length, 0.5)), straight_frame())
    assert sum(r["status"] == "bridged" for r in edges.rows) == bridged


@pytest.mark.parametrize("hidden, gap", [(False, 10.0), (True, 46.0)], ids=["open", "too long"])
def test_an_opening_and_a_gap_that_is_too_long_break_the_edge(hidden, gap):
    stations = np.r_[np.arange(0, 20, 1.0), np.arange(19 + gap, 90, 1.0)]
    edges = fit_road_edges(curb_points(stations, hidden=np.arange(19.5, 19 + gap, 0.5) if hidden else ()), straight_frame())
    assert [r["status"] for r in edges.rows] == ["measured", "measured"]
    assert edges.rows[0]["end_m"] == pytest.approx(19) and edges.rows[1]["station_m"] == pytest.approx(19 + gap)


@pytest.mark.parametrize(("between", "pieces"), [
    ("bridged", [("curb", "measured"), ("dropped", "bridged"), ("curb", "measured")]),
    ("measured", [("curb", "measured"), ("dropped", "measured"), ("curb", "measured")]), (None, [("curb", "measured"), ("curb", "measured")])],
    ids=["the ground steps", "low curb", "a curb that sinks and is not seen to go on"])
def test_a_curb_that_is_lowered_goes_on_as_a_dropped_one_where_it_is_seen(between, pieces):
    stations, low = np.r_[np.arange(0, 20, 1.0), np.arange(28, 60, 1.0)], np.arange(20, 28, 0.5)
    points = curb_points(np.sort(np.r_[stations, low]) if between else stations)
    for row in points.rows:
        if row["station_m"] in low:
            row.update(status=between, height_m=0.03)
    points.rows[19]["height_m"] = 0.05
    edges = fit_road_edges(points, straight_frame())
    assert [(row["edge"], row["status"]) for row in edges.rows] == pieces
    np.testing.assert_allclose(places(edges)[:, 1], 3.5, atol=0.01)


def test_a_low_curb_without_higher_ones_on_both_sides_is_no_dropped_one():
    points = curb_points(np.arange(0, 60, 1.0))
    for row in points.rows[30:]:
        row["height_m"] = 0.04
    assert {row["edge"] for row in fit_road_edges(points, straight_frame()).rows} == {"curb"}


def test_places_on_the_line_across_a_lowered_curb_do_not_make_its_points_surer():
    """They lie on one line, and the points beside them scatter as much as others."""
    low = np.arange(22.0, 38.0, 0.5)
    points = curb_points(np.r_[np.arange(0, 22, 1.0), np.arange(38, 60, 1.0)], noise=0.02)
    for s in low:
        points.add(shapely.Point(EAST + s, NORTH + 3.5, 100.0), road=0, side="left", status="bridged", part="bottom",
                   station_m=float(s), offset_m=3.5, height_m=0.03)
    alone = fit_road_edges(curb_points(np.arange(0, 60, 1.0), noise=0.02), straight_frame())
    vertices = places(fit_road_edges(points, straight_frame()))
    np.testing.assert_allclose(vertices[:, 1], 3.5, atol=max(np.abs(places(alone)[:, 1] - 3.5).max(), 0.02))


@pytest.mark.parametrize("end", [42.0, 60.0])
@pytest.mark.parametrize(("aside", "bridged"), [(0.0, 1), (0.6, 0)], ids=["in line", "aside"])
def test_a_gap_longer_than_usual_is_bridged_where_both_parts_lie_in_one_line(aside, bridged, end):
    stations = np.r_[np.arange(0, 20, 1.0), np.arange(end, 90, 1.0)]
    points = curb_points(stations, lambda s: 3.5 + aside * (s > 30), hidden=np.arange(20, end - 0.5, 0.5), noise=0.003)
    edges = fit_road_edges(points, straight_frame())
    assert sum(r["status"] == "bridged" for r in edges.rows) == bridged


@pytest.mark.parametrize("cars", [14.0, 16.0, 18.0])
def test_the_curb_of_a_bay_is_bridged_behind_the_cars_in_it(cars):
    """The bay is 2 m wide; before and behind the cars 3 m of its curb are seen, and beyond these its ends, at 45°."""
    def bay(s):
        return 3.5 + np.clip(min(s - 15.0, 25.0 + cars - s), 0.0, 2.0)

    stations = np.r_[np.arange(0.0, 20.1, 0.5), np.arange(20.0 + cars, 60.0, 0.5)]
    hidden = np.arange(20.25, 20.0 + cars, 0.5)
    edges = fit_road_edges(curb_points(stations, bay, hidden=hidden, noise=0.003), straight_frame())
    (line, row), = [(line, row) for line, row in edges if row["status"] == "bridged"]
    assert row["end_m"] - row["station_m"] == pytest.approx(cars, abs=0.6)
    np.testing.assert_allclose(shapely.get_coordinates(line)[:, 1] - NORTH, 5.5, atol=0.05)


def test_the_line_behind_the_cars_in_a_bay_on_a_bend_does_not_depend_on_where_its_points_lie():
    """Of the curb of the bay 3 m are seen beside the cars, and beyond these its ends, which turn aside by a metre or two."""
    radius, depth, first, last = 60.0, 2.0, 15.0, 44.0
    s = np.arange(0.0, 70.0, 0.25)
    frame = build_frame(Trajectory(s / 10.0, radius * np.sin(s / radius) + EAST, radius * (1 - np.cos(s / radius)) + NORTH, np.full(len(s), 102.5)))
    errors = []
    for shift, noise in [(k / 11, seed) for k in range(11) for seed in range(3)]:
        rng, points = np.random.default_rng(noise), Features("PointZ", list(CURB_POINTS))
        at = np.r_[np.arange(2.0, 21.0, 0.5), np.arange(38.0, 66.0, 0.5)] + 0.5 * shift
        for status, stations in (("measured", at), ("occluded", np.arange(21.5, 38.0, 0.5))):
            for place in stations:
                smooth = np.clip([(place - first) / 3.0 + 0.2, (last - place) / 3.0 + 0.2], 0.0, 1.0).min()
                d = 3.5 + depth * smooth**2 * (3 - 2 * smooth) + rng.normal(0.0, 0.003)
                x, y = (radius - d) * np.sin(place / radius), radius - (radius - d) * np.cos(place / radius)
                points.add(shapely.Point(x + EAST, y + NORTH, 100.0), road=0, side="left", status=status, part="bottom", station_m=float(place),
                           offset_m=float(d), height_m=0.12, chain=0)
        bridge, = [shapely.get_coordinates(line) for line, row in fit_road_edges(points, frame) if row["status"] == "bridged"]
        errors.append(np.abs(radius - 3.5 - depth - np.hypot(bridge[:, 0] - EAST, bridge[:, 1] - NORTH - radius)).max())
    assert max(errors) < 0.05 and np.ptp(errors) < 0.02


@pytest.mark.parametrize(("aside", "bridged"), [(0.0, 1), (0.6, 0)], ids=["with the road", "aside"])
def test_a_long_gap_in_which_a_bend_begins_is_bridged_where_the_curb_goes_on_beside_the_road(aside, bridged):
    s = np.arange(0.0, 90.0, 0.25)
    heading = np.clip(s - 40.0, 0.0, None) / 60.0
    x, y = (np.cumsum(0.25 * f(heading)) for f in (np.cos, np.sin))
    frame = build_frame(Trajectory(s / 10.0, x + EAST, y + NORTH, np.full(len(s), 102.5)))
    rng, points = np.random.default_rng(2), Features("PointZ", list(CURB_POINTS))
    for status, stations in (("measured", np.r_[np.arange(10, 30, 1.0), np.arange(51, 70, 1.0)]), ("occluded", np.arange(30.0, 50.5, 0.5))):
        for at in stations:
            k, d = int(4 * at), 3.5 + rng.normal(0.0, 0.003) + aside * (at > 40)
            place = np.array([x[k] - d * np.sin(heading[k]), y[k] + d * np.cos(heading[k])])
            station, offset = frame.road(0).locate(*(place + [EAST, NORTH] - frame.origin[:2])[:, None])
            points.add(shapely.Point(*(place + [EAST, NORTH]), 100.0), road=0, side="left", status=status, part="bottom",
                       station_m=float(station[0]), offset_m=float(offset[0]), height_m=0.12, chain=0)
    edges = fit_road_edges(points, frame)
    assert sum(row["status"] == "bridged" for row in edges.rows) == bridged
    if bridged:
        found = shapely.linestrings(places(edges)[:, :2])
        true = np.column_stack([x - 3.5 * np.sin(heading), y + 3.5 * np.cos(heading)])[60:260]
        assert shapely.distance(shapely.points(true), found).max() < 0.12


@pytest.mark.parametrize("mouth, bus", [(22.0, 9.0), (35.0, 14.0)])
def test_the_mouth_of_a_street_is_not_bridged_where_a_bus_hides_a_part_of_it(mouth, bus):
    stations = np.r_[np.arange(0, 20, 1.0), np.arange(19 + mouth, 90, 1.0)]
    edges = fit_road_edges(curb_points(stations, hidden=np.arange(19.5 + (mouth - bus) / 2, 19 + (mouth + bus) / 2, 0.5)), straight_frame())
    assert [r["status"] for r in edges.rows] == ["measured", "measured"]


def test_a_short_piece_of_curb_does_not_bend_the_line_across_a_long_gap():
    # its three points lie oblique by centimetres, which would be decimetres within the gap
    stations = np.r_[np.arange(0, 20, 1.0), 23.0, 23.3, 23.6, np.arange(40, 60, 1.0)]
    oblique = {23.0: -0.015, 23.6: 0.03}
    points = curb_points(stations, lambda s: 3.5 + oblique.get(round(float(s), 1), 0.0), hidden=np.arange(24.0, 39.6, 0.5), noise=0.003)
    edges = fit_road_edges(points, straight_frame())
    assert "bridged" in {row["status"] for row in edges.rows}
    np.testing.assert_allclose(places(edges)[:, 1], 3.5, atol=0.05)


def test_the_user_says_how_long_a_gap_may_be():
    points = curb_points(np.r_[np.arange(0, 20, 1.0), np.arange(30, 60, 1.0)], hidden=np.arange(20, 29.5, 0.5))
    for longest, bridged in ((3.5, 0), (12.0, 1)):
        edges = fit_road_edges(points, straight_frame(), EdgeSettings(max_gap=longest))
        assert sum(r["status"] == "bridged" for r in edges.rows) == bridged


def test_a_row_of_parked_cars_is_bridged_where_the_curb_was():
    points = street()
    for start in (15.0, 21.0, 38.0):
        points = parked_car(points, start)
    surveyed = survey_of(points)
    edges = fit_road_edges(detect_curbs(surveyed), surveyed.frame)
    assert length_of(edges, "left", "bridged") > 10.0
    for line, row in edges:
        offset = 3.5 if row["side"] == "left" else -3.5
        np.testing.assert_allclose(shapely.get_coordinates(line)[:, 1] - NORTH, offset, atol=0.03)


def test_without_curbs_nothing_is_drawn_unless_a_width_is_asked_for():
    nothing = Features("PointZ", list(CURB_POINTS))
    assert len(fit_road_edges(nothing, straight_frame())) == 0
    edges = fit_road_edges(nothing, straight_frame(), EdgeSettings(fallback_width=7.0))
    assert {(r["side"], r["status"]) for r in edges.rows} == {("left", "inferred"), ("right", "inferred")}
    for line, _row in edges:
        np.testing.assert_allclose(np.abs(shapely.get_coordinates(line)[:, 1] - NORTH), 3.5, atol=1e-3)


def test_a_layer_without_edges_comes_with_a_word():
    heard = Heard()
    fit_road_edges(curb_points(np.arange(0, 30, 1.0)), straight_frame(), progress=heard)
    assert not heard.warned
    fit_road_edges(Features("PointZ", list(CURB_POINTS)), straight_frame(), progress=heard)
    assert len(heard.warned) == 1 and "no road edges" in heard.warned[0]


def test_the_fallback_fills_only_what_has_no_curb():
    edges = fit_road_edges(curb_points(np.arange(0, 30, 1.0)), straight_frame(), EdgeSettings(fallback_width=7.0))
    left = [(r["status"], r["station_m"], r["end_m"]) for r in edges.rows if r["side"] == "left"]
    assert [status for status, _, _ in left] == ["measured", "inferred"]
    assert left[1][1] == pytest.approx(29.0) and left[1][2] == pytest.approx(60.0)


def test_the_order_of_curb_points_changes_nothing():
    points = curb_points(np.arange(0, 60, 1.0), noise=0.01)
    order = np.random.default_rng(0).permutation(len(points))
    shuffled = Features("PointZ", points.schema, [points.geometries[k] for k in order], [points.rows[k] for k in order])
    lines = [fit_road_edges(p, straight_frame()).geometries for p in (points, shuffled)]
    assert [g.wkb for g in lines[0]] == [g.wkb for g in lines[1]]


@pytest.mark.parametrize("wrong, word", [(dict(max_gap=-1.0), "gap"), (dict(fallback_width=1.0), "fallback width")])
def test_settings_that_make_no_sense_are_refused(wrong, word):
    with pytest.raises(RoadExtractionError, match=word):
        EdgeSettings(**wrong)


def test_curb_points_and_edges_name_the_pass_that_drove_nearest():
    """There on the right, back on the left: each side's curb is best looked at in the drive beside it."""
    time, x, y, z = streets.driven(60.0)
    back = time[-1] + 100.0 + time
    both = Trajectory(np.r_[time, back], np.r_[x, x[::-1]] + EAST, np.r_[y - 1.75, y + 1.75] + NORTH, np.r_[z, z] + 100)
    frame = build_frame(both)
    points = Features("PointZ", list(CURB_POINTS))
    for side, north in (("left", 3.5), ("right", -3.5)):
        for s in np.arange(0, 60, 1.0):
            points.add(shapely.Point(EAST + s, NORTH + north, 100.0), road=0, side=side, status="measured", part="bottom",
                       station_m=float(s), offset_m=north + 1.75, height_m=0.12, chain=0)  # offsets count from the first drive
    assert [(row["side"], row["pass"]) for row in fit_road_edges(points, frame).rows] == [("left", 1), ("right", 0)]
